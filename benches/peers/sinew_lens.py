"""Sinew: the binary of the environment variable SINEW runs the same scene."""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import tempfile

from lens import DENSITY, DURATION, EVERY, MESH, POISSON, PRESSED, TRACTION, YOUNG, tell

SCENE = """(
    duration: {duration},
    bodies: {{"lens": (mesh: File(path: "{mesh}"), material: "tissue")}},
    materials: {{"tissue": (density: {density}, neo_hookean: Young(young: {young}, poisson: {poisson}))}},
    constraints: [Fixed(on: Set("rim"))],
    loads: [Traction(on: Set("front"), traction: {traction}, curve: Smooth(end: {pressed}))],
    integration: (bound: Auto),
    probes: {{"front": (what: Displacement, on: Set("front"), every: {every})}},
)"""
SCHEMES = {
    "explicit": "explicit, stable step",
    "reference": "explicit, half the stable step, f64",
    "Euler": "implicit Euler",
    "GeneralizedAlpha()": "generalised-α .8",
}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--scheme", choices=SCHEMES, default="explicit")
    parser.add_argument("--step", type=float, default=EVERY)
    parser.add_argument("--threads", default="1")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        file, out = folder / "scene.ron", folder / "out"
        file.write_text(SCENE.format(
            duration=DURATION, mesh=MESH, density=DENSITY, young=YOUNG, poisson=POISSON, traction=TRACTION, pressed=PRESSED, every=EVERY,
        ))
        command = [os.environ["SINEW"], "run", "--quiet", "--allow-outside", "--backend", "cpu", "--threads", asked.threads, "-o", out, file]
        if asked.scheme == "reference":
            command += ["--precision", "f64", "--set", "integration.safety=0.45"]
        elif asked.scheme != "explicit":
            command += ["--set", f"solver=Implicit(scheme: {asked.scheme}, step: {asked.step})"]
        subprocess.run(command, check=True)
        summary = json.loads((out / "summary.json").read_text())
        with open(out / "probe_front.csv") as probe:
            rows = list(csv.reader(probe))
    along = next(place for place, name in enumerate(rows[0]) if name.strip().startswith(("z", "uz", "u_z")) or " z" in name)
    history = [float(row[along]) for row in rows[1:]]
    tell("sinew", "this tree", SCHEMES[asked.scheme], summary["time_step"], summary["solving_seconds"], summary["implicit"] and summary["frames"]["longest"], history)


if __name__ == "__main__":
    main()
