"""The pressurised thick cylinder in plane strain: a boundary value problem in one variable, the radius.

With r(R) the deformed radius the stretches are r' (radial), r/R (hoop) and 1 (axial); J = r' r/R. From the energy
Ψ = μ/2 (J^(-2/3) (r'² + r²/R² + 1) - 3) + κ/2 (J - 1)² the nominal stresses are P_k = ∂Ψ/∂λ_k, and equilibrium is
d(R P_r)/dR = P_θ. Written for (r, T = R P_r): r' solves P_r(r', r/R) = T/R at each radius; T' = P_θ. The wall inside is
moved or pressed: T = -p r there (the pressure p acts on the deformed wall); outside T = 0.
"""

import numpy as np
from quadratic import moduli, record
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import brentq

YOUNG, POISSON = 3000, 0.49
INNER, OUTER = 0.01, 0.02
SHEAR, BULK = moduli(YOUNG, POISSON)


def nominal(radial, hoop):
    """Nominal stresses (Pa), radial and hoop."""
    volume, trace = radial * hoop, radial**2 + hoop**2 + 1
    pressure = BULK * (volume - 1)
    share = SHEAR * volume ** (-2 / 3)
    return (share * (radial - trace / (3 * radial)) + pressure * hoop,
            share * (hoop - trace / (3 * hoop)) + pressure * radial)


def radial_stretch(stress, hoop):
    """The radial stretch whose nominal radial stress (Pa) is given, by Newton's method, vectorised."""
    stretch = 1 / hoop
    for _ in range(60):
        miss = nominal(stretch, hoop)[0] - stress
        slope = (nominal(stretch * (1 + 1e-6), hoop)[0] - nominal(stretch * (1 - 1e-6), hoop)[0]) / (2e-6 * stretch)
        stretch = stretch - miss / slope
        if np.max(abs(miss)) < 1e-11 * BULK:
            break
    return stretch


def by_collocation(inner, pressure=None, moved=None):
    """Solves with solve_bvp; returns the inner radius (m) and the pressure (Pa)."""
    def slopes(R, y):
        hoop = y[0] / R
        radial = radial_stretch(y[1] / R, hoop)
        return np.vstack([radial, nominal(radial, hoop)[1]])

    def ends(a, b):
        return np.array([a[0] - moved if moved else a[1] + pressure * a[0], b[1]])

    R = np.linspace(INNER, OUTER, 41)
    # incompressible tissue as a start: r² - R² is the same everywhere
    r = np.sqrt(R**2 + inner**2 - INNER**2)
    solution = solve_bvp(slopes, ends, R, np.vstack([r, np.zeros_like(R)]), tol=1e-10, max_nodes=100_000)
    assert solution.success, solution.message
    return solution.y[0, 0], -solution.y[1, 0] / solution.y[0, 0], solution


def by_shooting(inner):
    """The same from the inner wall outwards, the pressure sought so that the outer wall is free: a check."""
    def outer_force(pressure):
        def slopes(R, y):
            hoop = y[0] / R
            radial = radial_stretch(y[1] / R, hoop)
            return [radial, nominal(radial, hoop)[1]]
        end = solve_ivp(slopes, (INNER, OUTER), [inner, -pressure * inner], rtol=1e-11, atol=1e-14, method="DOP853")
        return end.y[1, -1]
    return brentq(outer_force, 10, 2000, xtol=1e-9, rtol=1e-13)


if __name__ == "__main__":
    how = "radial equilibrium in plane strain by collocation (scipy.integrate.solve_bvp, tolerance 1e-10); shooting agrees"
    inner, pressure, solution = by_collocation(0.014, moved=0.014)
    check = by_shooting(0.014)
    print(f"inner radius 14 mm: p = {pressure:.9f} Pa, by shooting {check:.9f}; outer {solution.y[0, -1]:.9g}")
    record("thick_cylinder_moved", "pressure", pressure, abs(pressure - check) + 1e-8 * pressure, "Pa", how)
    record("thick_cylinder_moved", "outer_displacement", solution.y[0, -1] - OUTER, 1e-10, "m", how)
    inner, pressure, solution = by_collocation(0.0145, pressure=400)
    check = by_shooting(inner)
    print(f"400 Pa: inner radius {inner:.10g} m, outer {solution.y[0, -1]:.10g} m; by shooting {check:.9f} Pa")
    # what the two differ by in pressure moves the wall by 0.02 mm/Pa at most
    doubt = 2e-5 * abs(check - 400) + 1e-11
    record("thick_cylinder", "inner_displacement", inner - INNER, doubt, "m", how)
    record("thick_cylinder", "outer_displacement", solution.y[0, -1] - OUTER, doubt, "m", how)
