"""CalculiX (`ccx`): its neo-Hookean law, which is the same, HHT-α -.05, Newton's iterations with a direct factor. f64,
masses consistent. What it takes to read its input and to write its results is in its time."""

import argparse
import re
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from lens import BULK, DENSITY, DURATION, EVERY, PRESSED, SHEAR, Lens, front, share, tell

DECK = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE=C3D4, ELSET=LENS
{elements}
*NSET, NSET=RIM
{rim}
*NSET, NSET=FRONT
{front}
*MATERIAL, NAME=TISSUE
*HYPERELASTIC, NEO HOOKE
{c10}, {d1}
*DENSITY
{density}
*SOLID SECTION, ELSET=LENS, MATERIAL=TISSUE
*AMPLITUDE, NAME=SMOOTH
{curve}
*BOUNDARY
RIM, 1, 3
*STEP, NLGEOM, INC=100000
*DYNAMIC, DIRECT
{step}, {duration}
*CLOAD, AMPLITUDE=SMOOTH
{forces}
*NODE PRINT, NSET=FRONT, FREQUENCY={each}
U
*END STEP
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--step", type=float, default=EVERY)
    asked = parser.parse_args()
    lens = Lens()
    lines = lambda rows: "\n".join(rows)
    numbered = lambda rows: lines(f"{i + 1}, " + ", ".join(f"{x:.12g}" for x in row) for i, row in enumerate(rows))
    times = np.linspace(0, PRESSED, 101)
    loaded = [(node, axis) for node in np.flatnonzero(np.abs(lens.force).sum(1)) for axis in range(3) if lens.force[node, axis]]
    deck = DECK.format(
        nodes=numbered(lens.points),
        elements=lines(f"{i + 1}, " + ", ".join(str(node + 1) for node in tet) for i, tet in enumerate(lens.tets)),
        rim=lines(f"{node + 1}," for node in lens.held),
        front=lines(f"{node + 1}," for node in lens.pressed),
        c10=SHEAR / 2, d1=2 / BULK, density=DENSITY, step=asked.step, duration=DURATION,
        curve=lines([*(f"{t:.6g}, {share(t):.9g}" for t in times), f"{2 * DURATION}, 1"]),
        forces=lines(f"{node + 1}, {axis + 1}, {lens.force[node, axis]:.12g}" for node, axis in loaded),
        each=round(EVERY / asked.step),
    )
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "lens.inp").write_text(deck)
        began = time.perf_counter()
        done = subprocess.run(["ccx", "lens"], cwd=folder, capture_output=True, text=True, check=True)
        wall = time.perf_counter() - began
        version = re.search(r"Version ([\w.]+)", done.stdout)
        history = [0.0]
        for block in Path(folder, "lens.dat").read_text().split("displacements")[1:]:
            rows = [line.split() for line in block.splitlines()[1:] if len(line.split()) == 4]
            displacements = np.zeros_like(lens.points)
            for node, *numbers in rows:
                displacements[int(node) - 1] = [float(number) for number in numbers]
            history.append(front(lens, displacements))
    assert len(history) == round(DURATION / EVERY) + 1, f"{len(history)} looks"
    tell("CalculiX", version.group(1) if version else "", "HHT-α, Newton", asked.step, wall, None, history)


if __name__ == "__main__":
    main()
