"""Scenes that tests use."""

from __future__ import annotations

from pathlib import Path

import pytest
import sinew

ROOT = Path(__file__).resolve().parents[3]

PULL = 'NodalForce(on: Set("z1"), force: (0.5, 0, 0), share: Total, curve: Input(name: "grip", rate: 50))'

# a block, held below, pulled at its top as an input says
BLOCK = """(
    title: "A block",
    duration: 0.1,
    bodies: {"block": (mesh: Box(size: (0.1, 0.1, 0.1), cells: (3, 3, 3), elements: Hex8), material: "tissue")},
    materials: {"tissue": (density: 1000, damping: 20, neo_hookean: Young(young: 3000, poisson: 0.45))},
    constraints: [Fixed(on: Set("z0"))],
    loads: [PULL],
    probes: {"top": (what: Displacement, on: Set("z1")), "ground": (what: Reaction, on: Set("z0"))},
)""".replace("PULL", PULL)


@pytest.fixture
def block() -> sinew.Scene:
    return sinew.Scene.from_text(BLOCK)


@pytest.fixture
def simulation(block: sinew.Scene) -> sinew.Simulation:
    return sinew.Simulation(block, backend="cpu", threads=1, grabs=True)


@pytest.fixture
def cube() -> sinew.Scene:
    return sinew.Scene(ROOT / "scenes/cube_under_gravity.ron", {"bodies.cube.mesh.cells": (3, 3, 3)})
