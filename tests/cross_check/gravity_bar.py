"""The clamped bar under gravity at Poisson's ratio .49: how far its end sinks."""

import sys

import numpy as np
from quadratic import Body, bulk_of, graded, neo_hookean, study

SHEAR, POISSON, DENSITY, GRAVITY = 1e4, 0.49, 1000, 9.81
LENGTH, WIDTH = 0.1, 0.02


def place(s):
    # half of the bar: y = .01 is a plane of symmetry; cells shrink towards the clamp and the edges
    return np.stack([
        LENGTH * graded(s[:, 0], low=2.5), WIDTH / 2 * graded(s[:, 1], low=1.5), WIDTH * graded(s[:, 2], low=1.5, high=1.5)
    ], 1)


def run(n, coarser, mixed=True):
    body = Body((3 * n, n // 2, n), place, neo_hookean(SHEAR, bulk_of(SHEAR, POISSON), mixed), mixed)
    body.hold(body.nodes(y=WIDTH / 2), "y")
    body.hold(body.nodes(x=0))
    body.body_force([0, 0, -DENSITY * GRAVITY])
    if coarser:
        body.start_from(coarser)
    body.solve([0.25, 0.5, 0.75, 1])
    # the four corners of the free end, two by symmetry: nodes of every mesh
    tip = sum(body.displacement[body.nodes(x=LENGTH, y=0, z=z)[0]] for z in (0, WIDTH)) / 2
    return body, {"tip_x": tip[0], "tip_z": tip[2]}


if __name__ == "__main__":
    levels = [int(n) for n in sys.argv[1:]] or [3, 4, 6]
    study("gravity_bar", levels, run, {"tip_z": "m", "tip_x": "m"}, "half bar of 3n x n/2 x n graded cells")
