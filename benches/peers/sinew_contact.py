"""Sinew: the binary of the environment variable SINEW runs the same scene; its fields are read back, every millisecond."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np

from contact_cubes import CASES, CELLS, EDGE, EVERY, GRAVITY, POISSON, YOUNG, Case, judge

SCENE = """(
    title: "{name}",
    duration: {duration},
    bodies: {{{bodies}}},
    materials: {{"tissue": (density: 1000, neo_hookean: Young(young: {young}, poisson: {poisson}))}},
    loads: [{loads}],
    tools: {{"table": (shape: Plane())}},
    contacts: [{contacts}],
    output: (fields: [Displacement, Velocity], fields_every: {every}),
)"""


def scene(case):
    count = len(case.rest)
    name = "cube{}".format
    box = f"Box(size: ({EDGE}, {EDGE}, {EDGE}), cells: ({CELLS}, {CELLS}, {CELLS}), elements: Tet4)"
    body = lambda i: f'"{name(i)}": (mesh: {box}, material: "tissue", translate: {CASES[case.name][1][i]})'
    tables = [f'Tool(tool: "table", body: "{name(i)}")' for i in range(count)]
    near = lambda i, j: np.abs(case.rest[i].mean(0) - case.rest[j].mean(0)).max() < 2 * EDGE
    pairs = [
        f'Between(bodies: ("{name(i)}", "{name(j)}"))' for i in range(count) for j in range(i + 1, count) if near(i, j)
    ]
    loads = [f'Gravity(body: "{name(i)}", acceleration: (0, 0, -{GRAVITY}))' for i in range(count)]
    return SCENE.format(
        name=case.name, duration=case.duration, young=YOUNG, poisson=POISSON, every=EVERY,
        bodies=", ".join(map(body, range(count))), loads=", ".join(loads), contacts=", ".join(tables + pairs),
    )


def main(name, threads):
    case = Case(name)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        file, out = folder / "scene.ron", folder / "out"
        file.write_text(scene(case))
        command = [os.environ["SINEW"], "run", "--quiet", "--backend", "cpu", "--threads", threads, "-o", out, file]
        subprocess.run(command, check=True)
        summary = json.loads((out / "summary.json").read_text())
        looks = [look(case, path) for path in sorted(out.glob("fields_*.vtu"))]
    wall = summary["solving_seconds"] / summary["simulated"]
    judge("sinew", "this tree", case, summary["time_step"], wall, looks, "" if threads == "1" else f"{threads} threads")


def look(case, path):
    """Positions and velocities in the order of the case's nodes."""
    mesh = meshio.read(path)
    moved, velocity = (mesh.point_data[name].astype(float) for name in ("displacement", "velocity"))
    rest = mesh.points.astype(float)
    own = case.rest.reshape(-1, 3)
    order = lambda points: np.lexsort(np.round(points / 1e-6).astype(int).T)
    rows = np.empty(len(own), int)
    rows[order(own)] = order(rest)
    assert np.abs(rest[rows] - own).max() < 1e-6, "the fields have other nodes"
    shape = case.rest.shape
    return (rest + moved)[rows].reshape(shape), velocity[rows].reshape(shape)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "1")
