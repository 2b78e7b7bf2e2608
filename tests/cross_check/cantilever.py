"""A cantilever with a dead shear traction on its end: small, against Timoshenko's beam, and bent by a third of its length."""

import sys

import numpy as np
from quadratic import Body, graded, moduli, neo_hookean, record, study

YOUNG, POISSON, LENGTH, WIDTH = 3000, 0.45, 0.1, 0.01
LARGE, SMALL = 3.0, 0.03  # Pa


def place(s):
    # half of the bar: y = .005 is a plane of symmetry; cells shrink towards the clamp and the edges
    return np.stack([
        LENGTH * graded(s[:, 0], low=2.5), WIDTH / 2 * graded(s[:, 1], low=1.5), WIDTH * graded(s[:, 2], low=1.5, high=1.5)
    ], 1)


def run(n, coarser, traction):
    body = Body((4 * n, n // 2, n), place, neo_hookean(*moduli(YOUNG, POISSON)))
    body.hold(body.nodes(y=WIDTH / 2), "y")
    body.hold(body.nodes(x=0))
    body.traction(body.nodes(x=LENGTH), [0, 0, -traction])
    if coarser:
        body.start_from(coarser)
    body.solve([0.25, 0.5, 0.75, 1] if traction == LARGE else [1])
    # the four corners of the free end, two by symmetry: nodes of every mesh
    tip = sum(body.displacement[body.nodes(x=LENGTH, y=0, z=z)[0]] for z in (0, WIDTH)) / 2
    return body, {"tip_x": tip[0], "tip_z": tip[2]}


def timoshenko(traction):
    """Deflection (m) of the beam's end; the shear coefficient of a square is 10 (1 + ν)/(12 + 11 ν) (Cowper 1966)."""
    load, inertia = traction * WIDTH**2, WIDTH**4 / 12
    shear = moduli(YOUNG, POISSON)[0] * 10 * (1 + POISSON) / (12 + 11 * POISSON) * WIDTH**2
    return load * LENGTH**3 / (3 * YOUNG * inertia) + load * LENGTH / shear


if __name__ == "__main__":
    levels = [int(n) for n in sys.argv[1:]] or [2, 4, 6, 8]
    for name, traction in [("cantilever", LARGE), ("cantilever_small", SMALL)]:
        units = {"tip_x": "m", "tip_z": "m"}
        study(name, levels, lambda n, coarser: run(n, coarser, traction), units, "half bar of 4n x n/2 x n graded cells")
    how = "Timoshenko beam, shear coefficient of Cowper (1966): not the three-dimensional clamp"
    record("cantilever_small", "timoshenko_tip_z", -timoshenko(SMALL), 0.005 * timoshenko(SMALL), "m", how)
    print("Timoshenko:", -timoshenko(SMALL))
