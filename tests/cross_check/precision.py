"""f32 against f64 over 100 000 steps: a bar that swings under its weight and comes to rest, every element, at the stable step
and at a twentieth of it, with compensated and with plain sums, on the CPU and on a GPU (a software device, if there is no other).

Writes docs/accuracy/precision.csv and the table of docs/accuracy.md. Usage: precision.py SINEW [no-gpu]
"""

import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
STEPS, SAMPLES = 100_000, 50
SCENE = """(
    duration: DURATION,
    bodies: {"b": (mesh: Box(size: (0.1, 0.02, 0.02), cells: (5, 1, 1), elements: ELEMENT), material: "m")},
    materials: {"m": (density: 1000, neo_hookean: Young(young: 3e3, poisson: 0.45), damping: 3)},
    constraints: [Fixed(on: Plane(normal: (1, 0, 0), at: 0))],
    loads: [Gravity(acceleration: (0.05, 0, -0.2))],
    probes: {PROBES},
    integration: (step: STEP, compensated: COMPENSATED),
)"""
# every node by its own: corners of the cells
NODES = [(x, y, z) for x in (0.02, 0.04, 0.06, 0.08, 0.1) for y in (0, 0.02) for z in (0, 0.02)]


def scene(folder, element, step, compensated):
    probes = ", ".join(
        f'"n{i}": (what: Displacement, on: Sphere(center: ({x}, {y}, {z}), radius: 1e-6), every: {STEPS // SAMPLES * step!r})'
        for i, (x, y, z) in enumerate(NODES))
    text = SCENE.replace("DURATION", repr(STEPS * step)).replace("ELEMENT", element).replace("PROBES", probes)
    text = text.replace("STEP", repr(step)).replace("COMPENSATED", str(compensated).lower())
    path = Path(folder, "bar.ron")
    path.write_text(text)
    return path


def course(sinew, element, step, options, compensated=True):
    """All displacements (m) at all samples."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sinew, "run", str(scene(folder, element, step, compensated)), "--threads", "1", *options, "--out", f"{folder}/out"]
        told = subprocess.run(command, capture_output=True, text=True)
        if told.returncode:
            raise RuntimeError(told.stderr)
        tables = []
        for i in range(len(NODES)):
            with open(f"{folder}/out/probe_n{i}.csv") as file:
                tables.append([[float(value) for value in row[1:4]] for row in list(csv.reader(file))[1:]])
        return [[tables[node][sample] for node in range(len(NODES))] for sample in range(len(tables[0]))]


def length(u, v=(0, 0, 0)):
    return sum((a - b) ** 2 for a, b in zip(u, v)) ** 0.5


def difference(exact, other):
    """The largest difference of a node at any sample over the largest displacement."""
    assert len(exact) == len(other) >= SAMPLES, (len(exact), len(other))
    pairs = [(u, v) for a, b in zip(exact, other) for u, v in zip(a, b)]
    return max(length(u, v) for u, v in pairs) / max(length(u) for u, _ in pairs)


def stable(sinew, element):
    """Nine tenths of the rigorous bound (s)."""
    with tempfile.TemporaryDirectory() as folder:
        told = subprocess.run([sinew, "check", "--json", str(scene(folder, element, 1e-6, True))], capture_output=True, text=True, check=True)
        return 0.9 * json.loads(told.stdout)["stability"]["bound"]["time_step"]


if __name__ == "__main__":
    sinew, gpu = sys.argv[1], "no-gpu" not in sys.argv
    cpu, rows = ["--backend", "cpu", "--precision"], []
    for element in ["Tet4", "Tet4NodalPressure", "Hex8", "Hex8MeanDilatation"]:
        for part in [1, 20]:
            step = float(f"{stable(sinew, element) / part:.3g}")
            exact = course(sinew, element, step, cpu + ["f64"])
            row = {"element": element, "part": part, "step": step,
                   "compensated": difference(exact, course(sinew, element, step, cpu + ["f32"])),
                   "plain": difference(exact, course(sinew, element, step, cpu + ["f32"], compensated=False))}
            if gpu:
                row["gpu"] = difference(exact, course(sinew, element, step, ["--backend", "gpu"]))
            print(row, flush=True)
            rows.append(row)
    with (ROOT / "docs/accuracy/precision.csv").open("w") as file:
        writer = csv.DictWriter(file, ["element", "part", "step", "compensated", "plain", "gpu"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    text = "| element | step | f32, CPU | f32, GPU | f32 with plain sums, CPU |\n|---|---|---|---|---|\n"
    for row in rows:
        shown = [f"{row[name]:.1e}" if name in row else "not run" for name in ("compensated", "gpu", "plain")]
        text += f"| `{row['element']}` | {1000 * row['step']:.3g} ms | " + " | ".join(shown) + " |\n"
    page = ROOT / "docs/accuracy.md"
    mark = "<!-- precision -->"
    page.write_text(re.sub(re.escape(mark) + r"\n.*?<!-- end -->", f"{mark}\n{text}<!-- end -->", page.read_text(), flags=re.S))
