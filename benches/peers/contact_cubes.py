"""The drop and the pile that all programs run, and what is read off them. SI units throughout.

drop: a cube falls 5 mm on a table. pile: eight cubes, four on the table and four that fall on them, shifted. Nothing is
damped and nothing rubs, so that energy, and momentum along the table, have no reason to change."""

import argparse
import json
import time

import numpy as np

from cubes import KUHN

EDGE, CELLS = 0.02, 4
YOUNG, POISSON, DENSITY = 1e4, 0.4, 1000.0
SHEAR = YOUNG / (2 * (1 + POISSON))
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
GRAVITY = 9.81
EVERY = 1e-3  # time between two looks
CASES = {
    "drop": (0.2, [(0, 0, 5e-3)]),
    "pile": (
        0.2,
        [(x, y, 1e-4) for x in (0, 0.024) for y in (0, 0.024)]
        + [(x, y, 0.0231) for x in (0.007, 0.031) for y in (0.004, 0.028)],
    ),
}


def box():
    """points (n, 3), x fastest, and tets (m, 4), of positive volume, of one cube with a corner at the origin."""
    line = np.arange(CELLS + 1)
    z, y, x = (axis.ravel() for axis in np.meshgrid(line, line, line, indexing="ij"))
    points = np.stack([x, y, z], 1) * (EDGE / CELLS)
    row = CELLS + 1
    corners = np.array([i + row * (j + row * k) for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    corner = np.flatnonzero((x < CELLS) & (y < CELLS) & (z < CELLS))[:, None] + corners
    return points, corner[:, KUHN].reshape(-1, 4).astype(np.int32)


def surface(tets):
    """Triangles (k, 3) that belong to one tetrahedron, and its first corner's opposite node turned outwards by order."""
    faces = tets[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, 1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


class Case:
    """rest (cubes, n, 3), tets (m, 4) and triangles (k, 3) of each cube, mass (n) of its nodes."""

    def __init__(self, name):
        self.name = name
        self.duration, places = CASES[name]
        points, self.tets = box()
        self.rest = points + np.array(places)[:, None]
        self.triangles = surface(self.tets)
        edges = points[self.tets[:, 1:]] - points[self.tets[:, :1]]
        self.volume = np.linalg.det(edges) / 6
        assert (self.volume > 0).all()
        self.inverse = np.linalg.inv(edges)
        self.mass = np.zeros(len(points))
        np.add.at(self.mass, self.tets.ravel(), np.repeat(self.volume * DENSITY / 4, 4))

    def energy(self, x, v):
        """Kinetic, of weight above the table, and the strain energy that the neo-Hookean law has in such a shape (J)."""
        kinetic = 0.5 * (self.mass * (v**2).sum(-1)).sum()
        weight = (self.mass * x[..., 2]).sum() * GRAVITY
        edges = x[:, self.tets[:, 1:]] - x[:, self.tets[:, :1]]
        f = np.swapaxes(self.inverse @ edges, -1, -2)
        j = np.linalg.det(f)
        if not (j > 0).all():
            return float("nan")
        i1 = (f**2).sum((-1, -2)) * np.cbrt(j) ** -2
        bulk = LAME + 2 / 3 * SHEAR
        density = 0.5 * SHEAR * (i1 - 3) + 0.5 * bulk * (j - 1) ** 2
        return kinetic + weight + (density * self.volume).sum()

    def depth(self, x):
        """How far nodes are in the table, and in other cubes (m)."""
        table = max(0.0, -x[..., 2].min())
        other = 0.0
        for a in range(len(x)):
            for b in range(len(x)):
                if a != b:
                    other = max(other, self.depth_in(x[a], x[b]))
        return table, other

    def depth_in(self, nodes, cube):
        near = ((nodes > cube.min(0)) & (nodes < cube.max(0))).all(1)
        deepest = 0.0
        for node in nodes[near]:
            corners = cube[self.tets]
            weights = np.linalg.solve(
                np.swapaxes(corners[:, 1:] - corners[:, :1], -1, -2), (node - corners[:, 0])[..., None]
            )[..., 0]
            if ((weights > 0).all(1) & (weights.sum(1) < 1)).any():
                deepest = max(deepest, distance(node, cube[self.triangles]))
        return deepest


def distance(point, triangles):
    """To the nearest plane of a triangle whose inside the point's foot is in; edges count where none is (m)."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    height = ((point - a) * normal).sum(1)
    foot = point - height[:, None] * normal
    side = lambda p, q: (np.cross(q - p, foot - p) * normal).sum(1) >= 0
    inside = side(a, b) & side(b, c) & side(c, a)
    if inside.any():
        return np.abs(height[inside]).min()
    return np.linalg.norm(point - triangles.mean(1), axis=1).min()


def judge(program, version, case, step, wall, looks, note=""):
    """Prints a line of JSON. `looks`: positions and velocities (cubes, n, 3) every millisecond; `wall`: s a simulated second."""
    energies = np.array([case.energy(x, v) for x, v in looks])
    depths = np.array([case.depth(x) for x, _ in looks[:: 5 if len(case.rest) > 1 else 1]])
    total = case.mass.sum() * len(case.rest)
    # what the fall brings in
    fall = energies[0] - case.energy(np.asarray(case.rest) - [0, 0, case.rest[..., 2].min()], 0 * case.rest)
    scale = fall if case.name == "drop" else energies[0]
    sideways = [np.linalg.norm((case.mass[:, None] * v).sum((0, 1))[:2]) for _, v in looks]
    speed = np.sqrt(2 * GRAVITY * (5e-3 if case.name == "drop" else 3e-3))
    if not np.isfinite(energies).all():
        note = (note + "; " if note else "") + "elements turn inside out"
    row = {
        "program": program, "version": version, "case": case.name, "step": step, "wall": wall,
        "table": float(depths[:, 0].max()), "other": float(depths[:, 1].max()),
        "most": float(np.nanmax((energies - energies[0]) / scale)), "end": float((energies[-1] - energies[0]) / scale),
        "sideways": float(max(sideways) / (total * speed)), "note": note,
    }
    print(json.dumps(row), flush=True)


def measure(program, version, build, step, note=""):
    """Runs `build(case)`, with `advance(steps)`, `looks()` → positions and velocities, by `step` (s)."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--case", choices=CASES, default="drop")
    case = Case(parser.parse_args().case)
    build(case, step).advance(2)  # what compiles at the first step does so here
    body = build(case, step)
    steps = round(EVERY / step)
    looks, wall = [body.look()], 0.0
    for _ in range(round(case.duration / EVERY)):
        began = time.perf_counter()
        body.advance(steps)
        wall += time.perf_counter() - began
        looks.append(body.look())
    judge(program, version, case, step, wall / case.duration, looks, note)
