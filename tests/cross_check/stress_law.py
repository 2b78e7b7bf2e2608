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
DIRECTION = np.array([1.0, 2.0, -0.5])
ALONG = ", ".join(map(str, DIRECTION))
ELASTIC = "neo_hookean: Young(young: 3000, poisson: 0.45)"


def volumetric(C):
    return BULK / 2 * (tm.sqrt(tm.linalg.det(C)) - 1) ** 2


def first(C):
    """Ī₁."""
    return tm.linalg.det(C) ** (-1 / 3) * tm.trace(C)


def second(C):
    """Ī₂."""
    return tm.linalg.det(C) ** (-2 / 3) * (tm.trace(C) ** 2 - tm.trace(C @ C)) / 2


def fourth(C):
    """Ī₄."""
    a = DIRECTION / np.linalg.norm(DIRECTION)
    return tm.linalg.det(C) ** (-1 / 3) * sum(a[i] * a[j] * C[i, j] for i in range(3) for j in range(3))


def neo_hookean(C):
    return SHEAR / 2 * (first(C) - 3) + volumetric(C)


def st_venant_kirchhoff(C):
    E = (C - tm.base.eye(C)) / 2
    return SHEAR * (tm.trace(E @ E) - tm.trace(E) ** 2 / 3) + BULK / 2 * tm.trace(E) ** 2


def ogden(C):
    stretches = tm.sqrt(tm.linalg.eigvalsh(C, eps=0) * tm.linalg.det(C) ** (-1 / 3))
    return sum(mu / alpha * (tm.sum(stretches**alpha) - 3) for mu, alpha in [(800, 2.5), (-150, -3)]) + volumetric(C)


def arruda_boyce(C):
    factors = [1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750]
    series = sum(c * 1.6 ** (2 - 2 * i) * (first(C) ** i - 3**i) for i, c in enumerate(factors, 1))
    return 900 * series + volumetric(C)


def exponential_fibres(C):
    strain = 0.1 * (first(C) - 3) + (1 - 3 * 0.1) * (fourth(C) - 1)
    return neo_hookean(C) + 500 / (2 * 0.8) * (tm.exp(0.8 * strain**2) - 1)


LAWS = {
    "neo_hookean": (ELASTIC, neo_hookean),
    "st_venant_kirchhoff": ("st_venant_kirchhoff: Young(young: 3000, poisson: 0.45)", st_venant_kirchhoff),
    "mooney_rivlin": (
        f"mooney_rivlin: (c10: 300, c01: 200, bulk: {BULK})",
        lambda C: 300 * (first(C) - 3) + 200 * (second(C) - 3) + volumetric(C),
    ),
    "ogden": (f"ogden: (terms: [(mu: 800, alpha: 2.5), (mu: -150, alpha: -3)], bulk: {BULK})", ogden),
    "arruda_boyce": (f"arruda_boyce: (shear: 900, locking_stretch: 1.6, bulk: {BULK})", arruda_boyce),
    "fibres": (
        f"{ELASTIC}, fibres: (eta: 2000, direction: Along({ALONG}))",
        lambda C: neo_hookean(C) + 2000 / 2 * (fourth(C) - 1) ** 2,
    ),
    "exponential_fibres": (
        f"{ELASTIC}, exponential_fibres: [(k1: 500, k2: 0.8, dispersion: 0.1, tension_only: false, "
        f"direction: Along({ALONG}))]",
        exponential_fibres,
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
        told = subprocess.run(command, capture_output=True, text=True)
        if told.returncode:
            raise RuntimeError(told.stderr)
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
