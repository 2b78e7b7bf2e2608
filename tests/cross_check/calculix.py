"""A second code: CalculiX (`ccx`, 20-node hexahedra with reduced integration, C3D20R) on three of the problems.

Its law `*HYPERELASTIC, NEO HOOKE` is U = C10 (Ī₁ - 3) + (J - 1)²/D1: ours with C10 = μ/2 and D1 = 2/κ.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import cantilever
import gravity_bar
import numpy as np
import squeezed_cube
from quadratic import REFERENCES, bulk_of, extrapolate, moduli, record_check, write

CODE = "CalculiX 2.20, C3D20R"
# offsets of the 20 nodes from a cell's first corner, in half cells
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
NODES = np.array(CORNERS + [tuple(np.add(CORNERS[a], CORNERS[b]) // 2) for a, b in EDGES])


class Deck:
    """An input file; `place` maps the unit cube's corners of cells as in quadratic.py."""

    def __init__(self, cells, place, shear, bulk, density=0):
        cells = np.array(cells)
        lines = [place(np.repeat(np.linspace(0, 1, n + 1)[:, None], 3, axis=1))[:, k] for k, n in enumerate(cells)]
        fine = [np.sort(np.concatenate([line, (line[1:] + line[:-1]) / 2])) for line in lines]
        elements = []
        for first in np.ndindex(*cells):
            elements.append(2 * np.array(first) + NODES)
        ids, where = {}, []
        rows = []
        for element in elements:
            row = []
            for key in map(tuple, element):
                if key not in ids:
                    ids[key] = len(ids) + 1
                    where.append([fine[k][key[k]] for k in range(3)])
                row.append(ids[key])
            rows.append(row)
        self.points = np.array(where)
        self.text = "*NODE, NSET=ALL\n" + "".join(
            f"{i}, {x:.12g}, {y:.12g}, {z:.12g}\n" for i, (x, y, z) in enumerate(self.points, 1))
        self.text += "*ELEMENT, TYPE=C3D20R, ELSET=BODY\n"
        for i, row in enumerate(rows, 1):
            self.text += f"{i}, " + ", ".join(map(str, row[:15])) + ",\n" + ", ".join(map(str, row[15:])) + "\n"
        self.text += f"*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n{shear / 2:.12g}, {2 / bulk:.12g}\n"
        self.text += f"*DENSITY\n{density:.12g}\n*SOLID SECTION, ELSET=BODY, MATERIAL=TISSUE\n"
        self.count = len(rows)

    def set(self, name, **where):
        keep = np.ones(len(self.points), bool)
        for axis, at in where.items():
            keep &= abs(self.points[:, "xyz".index(axis)] - at) < 1e-9
        ids = np.flatnonzero(keep) + 1
        self.text += f"*NSET, NSET={name}\n" + "".join(f"{i},\n" for i in ids)
        return ids

    def corners(self, name, length, width):
        """A set of the two corners of the free end that the half bar has."""
        where = [np.array([length, 0, z]) for z in (0, width)]
        ids = [int(np.argmin(np.linalg.norm(self.points - point, axis=1))) + 1 for point in where]
        self.text += f"*NSET, NSET={name}\n" + "".join(f"{i},\n" for i in ids)

    def mean_z(self, step):
        """Runs a step; the mean displacement along z (m) of the two corners."""
        numbers = self.run(step, "*NODE PRINT, NSET=TIP, FREQUENCY=1000\nU\n")
        return (numbers[-1] + numbers[-4]) / 2

    def run(self, step, output):
        """Runs a static step; numbers of the last table in the .dat file."""
        self.text += "*STEP, NLGEOM, INC=1000\n*STATIC\n0.05, 1., 1e-5, 0.1\n" + step
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "deck.inp").write_text(self.text + output + "*END STEP\n")
            told = subprocess.run(["ccx", "deck"], cwd=folder, capture_output=True, text=True)
            if "Job finished" not in told.stdout:
                raise RuntimeError(told.stdout[-2000:])
            data = Path(folder, "deck.dat").read_text()
        tables = re.split(r"\n *(?=[a-z ]+\(.*\) for set)", data)
        return [float(x) for x in re.findall(r"-?\d\.\d+E[+-]\d+", tables[-1].split("time", 1)[1])]


def bar(n):
    deck = Deck((3 * n, n // 2, n), gravity_bar.place, gravity_bar.SHEAR,
                bulk_of(gravity_bar.SHEAR, gravity_bar.POISSON), gravity_bar.DENSITY)
    deck.set("CLAMP", x=0), deck.set("MIDDLE", y=0.01)
    deck.corners("TIP", 0.1, 0.02)
    step = "*BOUNDARY\nCLAMP, 1, 3\nMIDDLE, 2, 2\n*DLOAD\nBODY, GRAV, 9.81, 0., 0., -1.\n"
    return {"tip_z": deck.mean_z(step)}


def beam(n):
    deck = Deck((4 * n, n // 2, n), cantilever.place, *moduli(cantilever.YOUNG, cantilever.POISSON))
    deck.set("CLAMP", x=0)
    deck.set("MIDDLE", y=0.005), deck.corners("TIP", 0.1, 0.01)
    end = deck.set("END", x=0.1)
    # the dead traction as the consistent forces of 8-node faces, put together by Gauss points
    points, force = deck.points[end - 1], np.zeros(len(end))
    ys, zs = (np.unique(np.round(points[:, k], 12)) for k in (1, 2))
    index = {(round(y, 12), round(z, 12)): i for i, (y, z) in enumerate(points[:, 1:])}
    for j in range(0, len(ys) - 1, 2):
        for k in range(0, len(zs) - 1, 2):
            area = (ys[j + 2] - ys[j]) * (zs[k + 2] - zs[k])
            for (a, b), share in zip([(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)],
                                     [-1 / 12] * 4 + [1 / 3] * 4):
                force[index[round(ys[j + a], 12), round(zs[k + b], 12)]] += share * area * cantilever.LARGE
    loads = "".join(f"{i}, 3, {-f:.12g}\n" for i, f in zip(end, force))
    step = "*BOUNDARY\nCLAMP, 1, 3\nMIDDLE, 2, 2\n*CLOAD\n" + loads
    return {"tip_z": deck.mean_z(step)}


def cube(n):
    half = squeezed_cube.EDGE / 2
    deck = Deck((n, n, n), squeezed_cube.place, squeezed_cube.SHEAR, bulk_of(squeezed_cube.SHEAR, squeezed_cube.POISSON))
    for name, axis in [("MX", "x"), ("MY", "y"), ("MZ", "z")]:
        deck.set(name, **{axis: 0})
    deck.set("PLATE", z=half)
    step = f"*BOUNDARY\nMX, 1, 1\nMY, 2, 2\nMZ, 3, 3\nPLATE, 1, 2\nPLATE, 3, 3, {-squeezed_cube.SQUEEZE * half:.12g}\n"
    return {"force": 4 * deck.run(step, "*NODE PRINT, NSET=PLATE, FREQUENCY=1000, TOTALS=ONLY\nRF\n")[-1]}


def settle(problem, quantity):
    """Takes the middle of what both codes extrapolate to as the reference, where they differ by more than its doubt."""
    table = json.loads(REFERENCES.read_text())
    entry = table[problem][quantity]
    limits = []
    for meshes in [entry["cells"], entry["checks"][CODE]]:
        levels = sorted(int(n) for n in meshes)[-3:]
        limits.append(extrapolate([1 / n for n in levels], [meshes[str(n)] for n in levels])[0])
    entry["checks"]["extrapolated"] = dict(zip(["FElupe", "CalculiX"], limits))
    if abs(limits[1] - limits[0]) / 2 > entry["uncertainty"]:
        entry["value"], entry["uncertainty"] = sum(limits) / 2, abs(limits[1] - limits[0]) / 2
    write(table)
    print(f"{problem} {quantity}: {limits} -> {entry['value']:.9g} ± {entry['uncertainty']:.2g}")


if __name__ == "__main__":
    problems = {"gravity_bar": bar, "cantilever": beam, "squeezed_cube": cube}
    for name in sys.argv[1:] or ["gravity_bar", "cantilever", "squeezed_cube:4:6"]:
        name, *levels = name.split(":")
        for n in map(int, levels or ["4", "6", "8"]):
            for quantity, value in problems[name](n).items():
                print(f"{name} {n}: {quantity} {value:.9g}", flush=True)
                record_check(name, quantity, CODE, n, value)
        # the cube's meshes cannot be fine enough for a limit
        if name != "squeezed_cube":
            settle(name, quantity)
