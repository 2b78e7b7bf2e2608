"""A column whose ends stick to plates, twisted by half a turn at constant height, Poisson's ratio .49."""

import sys

import numpy as np
from quadratic import Body, graded, moduli, neo_hookean, study

YOUNG, POISSON, WIDTH, HEIGHT, TURN = 3000, 0.49, 0.04, 0.16, np.pi


def place(s):
    across = [WIDTH * graded(s[:, k], low=1.4, high=1.4) for k in range(2)]
    return np.stack([*across, HEIGHT * graded(s[:, 2], low=1.6, high=1.6)], 1)


def run(n, coarser):
    body = Body((n, n, 3 * n), place, neo_hookean(*moduli(YOUNG, POISSON)))
    body.hold(body.nodes(z=0))
    lid = body.nodes(z=HEIGHT)
    arm = body.mesh.points[lid] - [WIDTH / 2, WIDTH / 2, HEIGHT]

    def turned(share):
        sin, cos = np.sin(share * TURN), np.cos(share * TURN)
        return arm @ (np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]]) - np.eye(3))

    body.hold(lid, "xyz", to=turned)
    if coarser:
        body.start_from(coarser)
    body.solve(np.linspace(0.125, 1, 8))
    pull = body.internal()[: 3 * len(body.mesh.points)].reshape(-1, 3)[lid]
    where = arm + turned(1)
    corner = body.displacement[body.nodes(x=WIDTH, y=WIDTH, z=HEIGHT / 2)[0]]
    return body, {
        "axial_force": pull[:, 2].sum(),
        "torque": (where[:, 0] * pull[:, 1] - where[:, 1] * pull[:, 0]).sum(),
        "corner_x": corner[0],
        "energy": body.energy(*moduli(YOUNG, POISSON)),
    }


if __name__ == "__main__":
    levels = [int(n) for n in sys.argv[1:]] or [2, 4, 6]
    units = {"axial_force": "N", "torque": "N m", "corner_x": "m", "energy": "J"}
    study("twisted_column", levels, run, units, "n x n x 3n graded cells")
