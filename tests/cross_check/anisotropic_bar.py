"""A clamped bar with fibres at 45 degrees, stretched by 30 %: it bends into an S."""

import sys

import felupe as fem
import numpy as np
import tensortrax.math as tm
from quadratic import Body, graded, moduli, study

SHEAR, BULK = moduli(3000, 0.45)
ETA, LENGTH, WIDTH, STRETCH = 2000, 0.1, 0.01, 0.03
DIRECTION = np.array([1, 0, 1]) / np.sqrt(2)


def isochoric(C):
    """Ψ = μ/2 (Ī₁ - 3) + η/2 (Ī₄ - 1)², differentiated automatically."""
    share = tm.linalg.det(C) ** (-1 / 3)
    along = sum(DIRECTION[i] * DIRECTION[j] * C[i, j] for i in (0, 2) for j in (0, 2))
    return SHEAR / 2 * (share * tm.trace(C) - 3) + ETA / 2 * (share * along - 1) ** 2


def place(s):
    # half of the bar: y = .005 is a plane of symmetry; cells shrink towards the clamps and the edges
    return np.stack([
        LENGTH * graded(s[:, 0], low=2, high=2), WIDTH / 2 * graded(s[:, 1], low=1.5), WIDTH * graded(s[:, 2], low=1.4, high=1.4)
    ], 1)


def run(n, coarser):
    body = Body((4 * n, n // 2, n), place, fem.NearlyIncompressible(fem.Hyperelastic(isochoric), bulk=BULK))
    body.hold(body.nodes(y=WIDTH / 2), "y")
    body.hold(body.nodes(x=0))
    end = body.nodes(x=LENGTH)
    body.hold(end, "yz")
    body.hold(end, "x", to=STRETCH)
    if coarser:
        body.start_from(coarser)
    body.solve(np.linspace(0.2, 1, 5))
    pull = 2 * body.reaction(end)
    # the four edges at a fifth of the length, two by symmetry
    at = sum(body.at([LENGTH / 5, 0, z]) for z in (0, WIDTH)) / 2
    return body, {"pull": pull[0], "shear_force": pull[2], "fifth_z": at[2]}


if __name__ == "__main__":
    levels = [int(n) for n in sys.argv[1:]] or [2, 4, 6]
    units = {"pull": "N", "shear_force": "N", "fifth_z": "m"}
    study("anisotropic_bar", levels, run, units, "half bar of 4n x n/2 x n graded cells, law by automatic differentiation")
