"""A bar of one homogeneous state, stretched and held, its sides free: the force that relaxes.

The second Piola-Kirchhoff stress is S = S_iso - Υ + S_vol with Υ(t) = α ∫ (1 - e^(-(t - s)/τ)) dS_iso(s)/ds ds: with
H = ∫ e^(-(t - s)/τ) dS_iso, Υ = α (S_iso - H), and dH/dt = dS_iso/dt - H/τ. Uniaxial: the lateral stretch b solves
S_lateral = 0 at every time. As H follows S_iso and S_iso follows b, the rate of b comes from d S_lateral / dt = 0; the
ordinary differential equations for (b, H_axial, H_lateral) go to scipy's DOP853 with tolerance 1e-12.
"""

import numpy as np
from quadratic import moduli, record
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

SHEAR, BULK = moduli(3000, 0.45)
ALPHA, TAU = 0.5, 0.58
STRETCH, RISE, WIDTH = 0.5, 0.5, 0.01  # stretch less 1, s, m


def stretch(t):
    """The 3-4-5 polynomial up to RISE, then held."""
    s = min(t / RISE, 1)
    return 1 + STRETCH * s**3 * (10 - 15 * s + 6 * s * s)


def isochoric(a, b):
    """S_iso (Pa), axial and lateral, of stretches a and b, b."""
    share, trace = SHEAR * (a * b * b) ** (-2 / 3), a * a + 2 * b * b
    return np.array([share * (1 - trace / (3 * a * a)), share * (1 - trace / (3 * b * b))])


def volumetric(a, b):
    """S_vol (Pa), axial and lateral."""
    volume = a * b * b
    return BULK * volume * (volume - 1) / np.array([a * a, b * b])


def slope(f, x, h=1e-6):
    return (f(x - 2 * h) - 8 * f(x - h) + 8 * f(x + h) - f(x + 2 * h)) / (12 * h)


def rates(t, y):
    b, history = y[0], y[1:]
    a = stretch(t)
    rate = slope(stretch, t, 1e-5) if 2e-5 < t < RISE - 2e-5 else 0.0
    along_a, along_b = slope(lambda x: isochoric(x, b), a), slope(lambda x: isochoric(a, x), b)
    # S_lateral = (1 - α) S_iso + α H + S_vol stays 0; dH = dS_iso - H/τ dt
    steep_a = along_a[1] + slope(lambda x: volumetric(x, b), a)[1]
    steep_b = along_b[1] + slope(lambda x: volumetric(a, x), b)[1]
    lateral = (ALPHA * history[1] / TAU - steep_a * rate) / steep_b
    return [lateral, *(along_a * rate + along_b * lateral - history / TAU)]


def force(t, y):
    """The pull (N): nominal stress times the area at rest."""
    a, b = stretch(t), y[0]
    stress = (1 - ALPHA) * isochoric(a, b) + ALPHA * y[1:] + volumetric(a, b)
    return a * stress[0] * WIDTH**2


def elastic(factor, a):
    """Force (N) and lateral stretch of an elastic bar whose isochoric stress is multiplied by a factor: a check."""
    b = brentq(lambda b: factor * isochoric(a, b)[1] + volumetric(a, b)[1], 0.5, 1.5, xtol=1e-15)
    return a * (factor * isochoric(a, b) + volumetric(a, b))[0] * WIDTH**2, b


if __name__ == "__main__":
    times = [0.25, 0.5, 1.0, 2.0, 4.0]
    run = solve_ivp(rates, (0, 60), [1, 0, 0], method="DOP853", rtol=1e-11, atol=1e-13, max_step=0.02, dense_output=True)
    how = "differential equations of the homogeneous state (scipy DOP853, tolerance 1e-11)"
    for t in times:
        y = run.sol(t)
        print(f"t = {t:g} s: force {force(t, y):.10f} N, lateral stretch {y[0]:.9f}")
        record("viscous_relaxation", f"force_at_{t:g}", float(force(t, y)), 1e-8, "N", how)
        record("viscous_relaxation", f"lateral_stretch_at_{t:g}", float(y[0]), 1e-8, "1", how)
    print("after a minute", force(60, run.sol(60)), "against the elastic bar with what remains", elastic(1 - ALPHA, 1.5)[0])
    print("elastic bar with instantaneous moduli", elastic(1, 1.5))
