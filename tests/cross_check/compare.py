"""Runs the scenes of scenes/accuracy with every element on three meshes and measures them against the references.

Writes docs/accuracy/elements.csv and puts the tables into docs/accuracy.md. Usage: compare.py SINEW [PROBLEM ...];
`compare.py none tables` only measures the values that are there against the references once more. ELEMENTS=Tet10,Wedge6
in the environment runs these alone, and keeps the other rows.
"""

import csv
import json
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
RECORD = ROOT / "docs" / "accuracy"
LONGEST = 400  # s of a processor: what takes longer is told as such


def kinds(sinew):
    """All kinds of elements, from what is allowed where there is a word that is none."""
    scene = str(ROOT / "scenes" / "accuracy" / "cook.ron")
    told = subprocess.run([sinew, "check", scene, "--set", "bodies.panel.mesh.elements=None"], capture_output=True, text=True)
    return re.search(r"allowed: ([\w, ]+)", told.stderr).group(1).split(", ")


def wall_pressure(probes, cells, elements):
    """The pressure (Pa) on the wall of the moved cylinder from what holds the nodes at 45 degrees."""
    # of faces with nodes amid their sides a line of corners and sides has a third: the corners have none of it
    share = 1 / 3 if elements == "Tet10" else 1
    width = math.sin(math.pi / 2 / cells[1])
    return probes["wall"][0] / (share * 0.014 * 0.005 * width * math.cos(math.pi / 4))


def of(probe, axis, factor=1.0):
    return lambda probes, cells, elements: factor * probes[probe]["xyz".index(axis)]


# problem: body, meshes from coarse to fine, quantities by their names in references.json
PROBLEMS = {
    "gravity_bar": ("bar", [(10, 2, 2), (20, 4, 4), (40, 8, 8)], {"tip_z": of("tip", "z")}),
    "cantilever": ("bar", [(20, 2, 2), (40, 4, 4), (80, 8, 8)], {"tip_z": of("tip", "z")}),
    "cantilever_small": ("bar", [(20, 2, 2), (40, 4, 4), (80, 8, 8)], {"tip_z": of("tip", "z")}),
    "squeezed_cube": ("cube", [(4, 4, 4), (8, 8, 8), (16, 16, 16)],
                      {"force": of("plate", "z"), "bulge": of("side", "x")}),
    "cook": ("panel", [(8, 8, 1), (16, 16, 2), (32, 32, 4)], {"corner_y": of("corner", "y")}),
    "cook_plane_strain": ("panel", [(8, 8, 1), (16, 16, 1), (32, 32, 1)], {"corner_y": of("corner", "y")}),
    "twisted_column": ("column", [(4, 4, 16), (8, 8, 32), (12, 12, 48)],
                       {"axial_force": of("lid", "z"), "corner_x": of("edge", "x")}),
    "thick_cylinder": ("tube", [(4, 8, 1), (8, 16, 2), (16, 32, 2)], {"inner_displacement": of("inside", "x")}),
    "thick_cylinder_moved": ("tube", [(4, 8, 1), (8, 16, 2), (16, 32, 2)],
                             {"pressure": wall_pressure, "outer_displacement": of("outside", "x")}),
    "anisotropic_bar": ("bar", [(20, 2, 2), (40, 4, 4), (80, 8, 8)],
                        {"pull": of("pull", "x"), "shear_force": of("pull", "z"), "fifth_z": of("fifth", "z")}),
}
# problems that are another's scene with values put in
VARIANTS = {
    "cantilever_small": ("cantilever", ["loads[0].traction=(0, 0, -0.03)"]),
    "cook_plane_strain": ("cook", ["constraints[1].on=All"]),
}


def run(sinew, scene, sets, precision="f64"):
    """Runs a scene; its summary, or None and why not."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sinew, "run", str(ROOT / "scenes" / "accuracy" / f"{scene}.ron"), "--backend", "cpu",
                   "--threads", "1", "--precision", precision, "--out", f"{folder}/out"]
        for value in sets:
            command += ["--set", value]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))
        told = subprocess.run(command, capture_output=True, text=True, preexec_fn=limit)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        if told.returncode < 0 and spent > 0.99 * LONGEST:
            return None, f"stopped after {LONGEST} s"
        if told.returncode != 0:
            return None, next((line for line in told.stderr.splitlines() if line.startswith("error")), "no word")
        return json.loads(Path(folder, "out", "summary.json").read_text()) | {"processor_seconds": spent}, ""


def study(sinew, problem, references, wanted_kinds):
    """Kinds of elements on all meshes of a problem: a row each."""
    scene, sets = VARIANTS.get(problem, (problem, []))
    body, meshes, quantities = PROBLEMS[problem]
    for elements in wanted_kinds:
        for cells in meshes:
            own = [f"bodies.{body}.mesh.elements={elements}", f"bodies.{body}.mesh.cells={cells}"]
            summary, wrong = run(sinew, scene, sets + own)
            for quantity, formula in quantities.items():
                reference = references[problem][quantity]
                row = {"problem": problem, "quantity": quantity, "elements": elements,
                       "cells": "×".join(map(str, cells)), "reference": reference["value"],
                       "uncertainty": reference["uncertainty"], "unit": reference["unit"], "why_not": wrong}
                if summary:
                    probes = {name: value for name, (_, value) in summary["probes"].items()}
                    value = formula(probes, cells, elements)
                    row |= {"value": value, "error": value / reference["value"] - 1, "steps": summary["steps"],
                            "seconds": summary["processor_seconds"]}
                print({k: row.get(k) for k in ["problem", "quantity", "elements", "cells", "value", "error", "seconds", "why_not"]}, flush=True)
                yield row


def seconds(value):
    """Two digits, or whole seconds."""
    return f"{value:.0f} s" if value >= 10 else f"{value:.2g} s"


def table(rows):
    """A Markdown table of errors: elements down, meshes across."""
    meshes = list(dict.fromkeys(row["cells"] for row in rows))
    text = "| element | " + " | ".join(f"{mesh} cells" for mesh in meshes) + " |\n|---|" + "---|" * len(meshes) + "\n"
    for elements in dict.fromkeys(row["elements"] for row in rows):
        cells = []
        for mesh in meshes:
            row = next(row for row in rows if row["elements"] == elements and row["cells"] == mesh)
            done = row.get("error") not in (None, "")
            cells.append(f"{100 * float(row['error']):+.2f} % ({seconds(float(row['seconds']))})" if done else "no result")
        text += f"| `{elements}` | " + " | ".join(cells) + " |\n"
    return text


def put_into_record(rows):
    """Replaces what stands between <!-- PROBLEM QUANTITY --> and <!-- end --> in docs/accuracy.md."""
    page = ROOT / "docs" / "accuracy.md"
    text = page.read_text()
    for key in dict.fromkeys((row["problem"], row["quantity"]) for row in rows):
        mark = f"<!-- {key[0]} {key[1]} -->"
        own = table([row for row in rows if (row["problem"], row["quantity"]) == key])
        text = re.sub(re.escape(mark) + r"\n.*?<!-- end -->", f"{mark}\n{own}<!-- end -->", text, flags=re.S)
    page.write_text(text)


def keep(rows, results):
    """Writes all rows."""
    columns = ["problem", "quantity", "elements", "cells", "value", "reference", "uncertainty", "unit", "error", "steps",
               "seconds", "why_not"]
    with results.open("w") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    sinew, wanted = sys.argv[1], sys.argv[2:] or list(PROBLEMS)
    references = json.loads((RECORD / "references.json").read_text())
    results = RECORD / "elements.csv"
    rows = list(csv.DictReader(results.open())) if results.exists() else []
    for row in rows:
        reference = references[row["problem"]][row["quantity"]]
        row |= {"reference": reference["value"], "uncertainty": reference["uncertainty"]}
        if row["value"]:
            row["error"] = float(row["value"]) / reference["value"] - 1
    if wanted == ["tables"]:
        wanted = []
    else:
        wanted_kinds = os.environ["ELEMENTS"].split(",") if "ELEMENTS" in os.environ else kinds(sinew)
    for problem in wanted:
        others = [row for row in rows if row["problem"] != problem or row["elements"] not in wanted_kinds]
        rows = others + list(study(sinew, problem, references, wanted_kinds))
        keep(rows, results)
    keep(rows, results)
    if (ROOT / "docs" / "accuracy.md").exists():
        put_into_record(rows)
