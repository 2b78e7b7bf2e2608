"""Picking, grabbing, moving, letting go."""

from __future__ import annotations

import numpy as np
import pytest
import sinew


def test_a_hand_pulls_and_lets_go(simulation: sinew.Simulation) -> None:
    pick = simulation.pick(np.array([0.05, 0.05, 1.0]), (0, 0, -1))
    assert pick is not None
    assert pick.body == "block" and pick.distance == pytest.approx(0.9)
    assert pick.point == pytest.approx([0.05, 0.05, 0.1]) and pick.normal == pytest.approx([0, 0, 1])
    places = simulation.body("block").positions()
    assert pick.weights @ places[pick.nodes] == pytest.approx(pick.point)
    assert simulation.pick((0, 0, 1), (0, 0, 1)) is None
    with pytest.raises(ValueError, match="leads nowhere"):
        simulation.pick((0, 0, 1), (0, 0, 0))

    grab = simulation.grab(pick, stiffness=50, most_force=0.2)
    assert grab.force == pytest.approx([0, 0, 0])
    grab.move(pick.point + [0, 0, 0.02])
    simulation.advance_to(0.05)
    assert simulation.probe("top")[2] > 1e-4
    force = grab.force
    assert 0 < force[2] and np.linalg.norm(force) <= 0.2 + 1e-6
    grab.release()
    with pytest.raises(ValueError, match="released|no such|not held|no grab"):
        grab.force  # noqa: B018
    simulation.reset()


def test_nodes_are_grabbed_by_weights(simulation: sinew.Simulation) -> None:
    top = np.flatnonzero(simulation.body("block").rest_positions[:, 2] > 0.0999)
    grab = simulation.grab_nodes("block", top)
    grab.move((0.05, 0.05, 0.12))
    simulation.step(100)
    assert grab.force[2] > 0 and simulation.probe("top")[2] > 0
    with pytest.raises(ValueError, match="16 nodes and 2 weights"):
        simulation.grab_nodes("block", top, [1, 1])


def test_nothing_is_grabbed_unasked(block: sinew.Scene) -> None:
    simulation = sinew.Simulation(block, backend="cpu")
    with pytest.raises(ValueError, match="grabs"):
        simulation.grab_nodes("block", [0])
