"""Stresses pointwise: sinew's against FElupe's automatic differentiation of the energies that docs/physics.md writes down.

One cell with all nodes prescribed takes a random homogeneous deformation; its Cauchy stress must be the derivative of the
energy. Usage: stress_law.py SINEW
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import felupe as fem
import numpy as np
import tensortrax.math as tm
from quadratic import moduli

SHEAR, BULK = moduli(3000, 0.45)
ETA, DIRECTION = 2000, np.array([1.0, 2.0, -0.5])


def fibres(C):
    a = DIRECTION / np.linalg.norm(DIRECTION)
    along = sum(a[i] * a[j] * C[i, j] for i in range(3) for j in range(3))
    return ETA / 2 * (tm.linalg.det(C) ** (-1 / 3) * along - 1) ** 2


def neo_hookean(C):
    volume = tm.sqrt(tm.linalg.det(C))
    return SHEAR / 2 * (volume ** (-2 / 3) * tm.trace(C) - 3) + BULK / 2 * (volume - 1) ** 2


LAWS = {
    "neo_hookean": ("neo_hookean: Young(young: 3000, poisson: 0.45)", neo_hookean),
    "fibres": (
        f"neo_hookean: Young(young: 3000, poisson: 0.45), fibres: (eta: 2000, direction: Along{tuple(DIRECTION)})",
        lambda C: neo_hookean(C) + fibres(C),
    ),
}
SCENE = """(
    duration: 1,
    analysis: Static(),
    bodies: {{"cell": (mesh: Box(size: (1, 1, 1), cells: (1, 1, 1), elements: {elements}), material: "law")}},
    materials: {{"law": (density: 1000, {law})}},
    constraints: [Prescribed(on: All, gradient: {gradient})],
    probes: {{"stress": (what: Stress, on: All)}},
)
"""


def ours(sinew, law, gradient, elements):
    """Cauchy stress xx, yy, zz, xy, yz, xz (Pa)."""
    with tempfile.TemporaryDirectory() as folder:
        rows = ", ".join("({:.17g}, {:.17g}, {:.17g})".format(*row) for row in gradient)
        Path(folder, "cell.ron").write_text(SCENE.format(law=law, gradient=f"({rows})", elements=elements))
        command = [sinew, "run", f"{folder}/cell.ron", "--backend", "cpu", "--precision", "f64", "--out", f"{folder}/out"]
        subprocess.run(command, check=True, capture_output=True)
        with open(f"{folder}/out/probe_stress.csv") as file:
            return np.array([float(x) for x in list(csv.reader(file))[-1][1:]])


def theirs(energy, gradient):
    F = np.eye(3) + gradient
    nominal = fem.Hyperelastic(energy).gradient([F.reshape(3, 3, 1, 1), None])[0][..., 0, 0]
    stress = nominal @ F.T / np.linalg.det(F)
    return stress[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]


if __name__ == "__main__":
    sinew, chance, worst = sys.argv[1], np.random.default_rng(1), 0.0
    for name, (law, energy) in LAWS.items():
        for elements in ["Tet4", "Hex8", "Hex8MeanDilatation", "Tet4NodalPressure"]:
            misses = []
            for _ in range(5):
                gradient = chance.uniform(-0.35, 0.35, (3, 3))
                found, expected = ours(sinew, law, gradient, elements), theirs(energy, gradient)
                misses.append(np.abs(found - expected).max() / np.abs(expected).max())
            worst = max(worst, *misses)
            print(f"{name}, {elements}: largest difference over the largest stress {max(misses):.1e}", flush=True)
    sys.exit(worst > 1e-9)
