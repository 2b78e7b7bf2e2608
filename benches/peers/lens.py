"""The pressed lens that all programs run, and what is read off them: scene A of benches/solvers/run without damping,
under a load that does not follow. SI units throughout."""

import argparse
import json
import pathlib
import time

import meshio
import numpy as np

MESH = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "meshes" / "lens_814.msh"
YOUNG, POISSON, DENSITY = 3000.0, 0.45, 1000.0
SHEAR = YOUNG / (2 * (1 + POISSON))
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
BULK = LAME + 2 / 3 * SHEAR
TRACTION = (0.0, 0.0, -100.0)  # Pa, on the front, smooth within PRESSED
PRESSED, DURATION = 0.1, 0.2
EVERY = 0.01  # time between two looks


class Lens:
    """points (n, 3), tets (m, 4) of positive volume, volume (m), mass (n), lumped; held, indices of nodes; front,
    triangles (k, 3); force (n, 3), that of the whole load."""

    def __init__(self):
        mesh = meshio.read(MESH)
        self.points = mesh.points.astype(float)
        self.tets = mesh.cells_dict["tetra"].astype(np.int32)
        edges = self.points[self.tets[:, 1:]] - self.points[self.tets[:, :1]]
        self.volume = np.linalg.det(edges) / 6
        turned = self.volume < 0
        self.tets[turned] = self.tets[turned][:, [1, 0, 2, 3]]
        self.volume = np.abs(self.volume)
        self.mass = np.zeros(len(self.points))
        np.add.at(self.mass, self.tets.ravel(), np.repeat(self.volume * DENSITY / 4, 4))
        triangles = lambda name: mesh.cells_dict["triangle"][mesh.cell_sets_dict[name]["triangle"]]
        self.front, self.held = triangles("front"), np.unique(triangles("rim"))
        corner = self.points[self.front]
        area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2
        self.force = np.zeros_like(self.points)
        np.add.at(self.force, self.front.ravel(), np.repeat(area / 3, 3)[:, None] * TRACTION)
        self.force[self.held] = 0
        self.pressed = np.unique(self.front)


def share(t):
    """How much of the load there is (the 3-4-5 polynomial)."""
    s = min(t / PRESSED, 1.0)
    return s**3 * (10 - s * (15 - 6 * s))


def measure(program, version, build, schemes):
    """Runs the lens by a scheme and prints a line of JSON. `build(lens, step, scheme)` gives a body with
    `advance(force, steps)`, under nodal forces (N) of the end of each step, and `displacements()`."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--scheme", choices=schemes, default=next(iter(schemes)))
    parser.add_argument("--step", type=float, default=EVERY)
    asked = parser.parse_args()
    lens = Lens()
    body = build(lens, asked.step, asked.scheme)
    each = round(EVERY / asked.step)
    history, wall, longest = [0.0], 0.0, 0.0
    for look in range(round(DURATION / EVERY)):
        for step in range(each):
            force = lens.force * share((look * each + step + 1) * asked.step)
            began = time.perf_counter()
            body.advance(force)
            taken = time.perf_counter() - began
            wall, longest = wall + taken, max(longest, taken)
        history.append(front(lens, body.displacements()))
    tell(program, version, asked.scheme, asked.step, wall, longest, history)


def front(lens, displacements):
    """Mean displacement of the nodes of the front, along the axis (m)."""
    return float(displacements[lens.pressed, 2].mean())


def tell(program, version, scheme, step, wall, longest, history):
    row = {"program": program, "version": version, "scheme": scheme, "step": step, "wall": wall / DURATION}
    print(json.dumps(row | {"longest": longest, "history": history}), flush=True)
