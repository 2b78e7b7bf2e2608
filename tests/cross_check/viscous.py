"""The viscous relaxation with every integrator, step and number type against its differential equations.

Writes docs/accuracy/viscous.csv and the table of docs/accuracy.md. Usage: viscous.py SINEW
"""

import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
TIMES = [0.5, 1.0, 2.0, 4.0]


def pull(sinew, integrator, step, precision, elements="Hex8MeanDilatation"):
    """Times (s) and pulls (N)."""
    with tempfile.TemporaryDirectory() as folder:
        sets = [f"materials.tissue.prony.integrator={integrator}", f"bodies.block.mesh.elements={elements}",
                f"integration.step={step}"]
        command = [sinew, "run", str(ROOT / "scenes/accuracy/viscous_relaxation.ron"), "--backend", "cpu",
                   "--precision", precision, "--out", f"{folder}/out"]
        for value in sets:
            command += ["--set", value]
        told = subprocess.run(command, capture_output=True, text=True)
        if told.returncode:
            raise RuntimeError(told.stderr)
        with open(f"{folder}/out/probe_pull.csv") as file:
            return [(float(row[0]), float(row[1])) for row in list(csv.reader(file))[1:]]


if __name__ == "__main__":
    references = json.loads((ROOT / "docs/accuracy/references.json").read_text())["viscous_relaxation"]
    rows = []
    for integrator in ["Exact", "BackwardEuler"]:
        for step in [5e-4, 2.5e-4, 1.25e-4]:
            for precision in ["f64", "f32"]:
                found = pull(sys.argv[1], integrator, step, precision)
                row = {"integrator": integrator, "step": step, "precision": precision}
                for time in TIMES:
                    at, value = min(found, key=lambda seen: abs(seen[0] - time))
                    row[f"error_at_{time:g}"] = value / references[f"force_at_{time:g}"]["value"] - 1
                rows.append(row)
                print(row, flush=True)
    with (ROOT / "docs/accuracy/viscous.csv").open("w") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    text = "| integrator | step | " + " | ".join(f"at {time:g} s, f64 | f32" for time in TIMES) + " |\n"
    text += "|---|---|" + "---|---|" * len(TIMES) + "\n"
    for exact, single in zip(rows[::2], rows[1::2]):
        errors = [f"{row[f'error_at_{time:g}']:+.1e}" for time in TIMES for row in (exact, single)]
        text += f"| `{exact['integrator']}` | {1000 * exact['step']:g} ms | " + " | ".join(errors) + " |\n"
    page = ROOT / "docs/accuracy.md"
    mark = "<!-- viscous_relaxation force -->"
    page.write_text(re.sub(re.escape(mark) + r"\n.*?<!-- end -->", f"{mark}\n{text}<!-- end -->", page.read_text(), flags=re.S))
