"""Cook's panel at finite strain, nearly incompressible, 10 mm thick with free faces; and in plane strain.

Shape after R. D. Cook (1974), material and load as J. C. Simo and F. Armero (1992) have them: shear modulus 80.1938 MPa,
bulk modulus 400 942 MPa (E 240.565 MPa, Poisson's ratio .4999), 100 N on each millimetre of thickness of the 16 mm edge.
"""

import sys

import numpy as np
from quadratic import Body, graded, moduli, neo_hookean, study

YOUNG, POISSON, TRACTION, HALF = 240.565e6, 0.4999, 6.25e6, 0.005


def place(s, thickness=HALF):
    x, y = graded(s[:, 0], low=2), graded(s[:, 1], low=1.5, high=1.5)
    low, high = 0.044 * x, 0.044 + 0.016 * x
    # half of the panel: z = 0 is its middle
    return np.stack([0.048 * x, low + (high - low) * y, thickness * graded(s[:, 2], high=1.5)], 1)


def run(n, coarser, plane):
    cells = (2 * n, 2 * n, 1 if plane else max(n // 2, 1))
    body = Body(cells, place, neo_hookean(*moduli(YOUNG, POISSON)))
    everything = np.arange(len(body.mesh.points))
    body.hold(everything if plane else body.nodes(z=0), "z")
    body.hold(body.nodes(x=0))
    body.traction(body.nodes(x=0.048), [0, TRACTION, 0])
    if coarser:
        body.start_from(coarser)
    body.solve([0.25, 0.5, 0.75, 1])
    corner = body.displacement[body.nodes(x=0.048, y=0.06, z=0)[0]]
    return body, {"corner_x": corner[0], "corner_y": corner[1]}


if __name__ == "__main__":
    units = {"corner_x": "m", "corner_y": "m"}
    levels = [int(n) for n in sys.argv[1:]]
    for name, plane, usual in [("cook_plane_strain", True, [2, 4, 6, 8]), ("cook", False, [2, 4, 6, 8])]:
        how = "2n x 2n x 1 graded cells" if plane else "half panel of 2n x 2n x n/2 graded cells"
        study(name, levels or usual, lambda n, coarser: run(n, coarser, plane), units, how)
