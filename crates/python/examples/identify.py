"""Young's modulus and Poisson's ratio of a sample, from the forces that it gave in a test.

A flat block of tissue is glued between two plates, pressed by a tenth of its height and then sheared. The force on the
upper plate is measured in both directions; here it is made up, with 1 % of noise. Pressing alone would not tell the two
numbers apart: what is stiff and what hardly changes its volume push back alike.

    python identify.py
"""

from __future__ import annotations

import time

import numpy as np
import sinew
from numpy.typing import NDArray
from scipy.optimize import least_squares

TEST = """(
    title: "A sample is pressed, then sheared",
    duration: 0.4, // s
    bodies: {
        "sample": (mesh: Box(size: (0.03, 0.03, 0.01), cells: (4, 4, 3), elements: Hex8), material: "tissue"), // m
    },
    materials: {"tissue": (density: 1000, damping: 100, neo_hookean: Young(young: 3000, poisson: 0.45))},
    constraints: [
        Fixed(on: Set("z0")),
        Prescribed(on: Set("z1"), displacement: (0, 0, -0.001), axes: [Z], curve: Smooth(end: 0.2)),
        Prescribed(on: Set("z1"), displacement: (0.003, 0, 0), axes: [X, Y], curve: Smooth(start: 0.2, end: 0.4)),
    ],
    probes: {"plate": (what: Reaction, on: Set("z1"))}, // N
)"""
TIMES = [0.08, 0.12, 0.16, 0.2, 0.28, 0.32, 0.36, 0.4]
LAW = "materials.tissue.neo_hookean"


def forces(scene: sinew.Scene, young: float, poisson: float) -> NDArray[np.float64]:
    """What the plate feels along x and z at each of the times (N)."""
    values = {f"{LAW}.young": float(young), f"{LAW}.poisson": float(poisson)}
    simulation = sinew.Simulation(scene.with_values(values), backend="cpu", threads=1)
    seen = []
    for moment in TIMES:
        simulation.advance_to(moment)
        seen.append(simulation.probe("plate")[[0, 2]])
    return np.array(seen)


def identify(measured: NDArray[np.float64], scene: sinew.Scene) -> tuple[float, float, int]:
    """Young's modulus (Pa), Poisson's ratio, and how many simulations it took.

    Minimises the sum of squares of what the forces differ. The logarithm of the modulus is sought, and the ratio.
    """
    runs = 0

    def differences(guess: NDArray[np.float64]) -> NDArray[np.float64]:
        nonlocal runs
        runs += 1
        return np.ravel(forces(scene, np.exp(guess[0]), guess[1]) - measured)

    # The time step follows the stiffness, and times are met within a step: forces are smooth in the two numbers down to
    # some 1e-3 of them. With differences over 1e-3 the search ends far off, with 1e-2 it arrives.
    bounds = ([np.log(100), 0.1], [np.log(1e6), 0.49])
    found = least_squares(differences, [np.log(10_000), 0.3], bounds=bounds, diff_step=1e-2, x_scale="jac")
    return float(np.exp(found.x[0])), float(found.x[1]), runs


def measurement(scene: sinew.Scene, young: float, poisson: float) -> NDArray[np.float64]:
    """Forces with noise of 1 % of the largest in each direction (N)."""
    exact = forces(scene, young, poisson)
    noise: NDArray[np.float64] = np.random.default_rng(1).normal(size=exact.shape)
    noise *= 0.01 * np.abs(exact).max(axis=0)
    return exact + noise


def main() -> None:
    """Makes a measurement up, and finds what it was made of."""
    scene = sinew.Scene.from_text(TEST)
    measured = measurement(scene, 3000, 0.45)
    started = time.perf_counter()
    young, poisson, runs = identify(measured, scene)
    took = time.perf_counter() - started
    print(f"E = {young:.0f} Pa, nu = {poisson:.4f} (3000 Pa, 0.45): {runs} simulations in {took:.1f} s")


if __name__ == "__main__":
    main()
