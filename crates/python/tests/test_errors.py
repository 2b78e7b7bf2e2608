"""What goes wrong arrives as exceptions that programs can read, here and in other processes."""

from __future__ import annotations

import pickle

import pytest
import sinew

from conftest import BLOCK


def crushed() -> sinew.Simulation:
    """A block whose top is pushed through its bottom."""
    text = BLOCK.replace(
        'constraints: [Fixed(on: Set("z0"))]',
        'constraints: [Fixed(on: Set("z0")), Prescribed(on: Set("z1"), displacement: (0, 0, -0.2), '
        "curve: Smooth(end: 0.05))]",
    )
    return sinew.Simulation(sinew.Scene.from_text(text), backend="cpu")


def test_a_breakdown_tells_where_and_when() -> None:
    simulation = crushed()
    with pytest.raises(sinew.Unstable) as caught:
        simulation.finish()
    error = caught.value
    assert isinstance(error, RuntimeError)
    assert error.body == "block" and error.step == simulation.step_count and 0 < error.time < 0.1
    assert error.element is not None and error.criterion == "inverted"
    assert f"t = {error.time} s" in str(error) and error.cause in str(error)
    with pytest.raises(AttributeError):
        error.nothing  # noqa: B018
    # the state is there, and so is the way back
    assert simulation.body("block").displacements().any()
    simulation.reset()
    simulation.step(5)
    assert simulation.step_count == 5


def test_no_equilibrium_tells_the_residual() -> None:
    words = {"analysis": "Static(max_steps: 30)"}
    simulation = sinew.Simulation(sinew.Scene.from_text(BLOCK, words), backend="cpu")
    simulation.inputs["grip"] = 1
    with pytest.raises(sinew.NotConverged) as caught:
        simulation.finish()
    assert caught.value.body == "block" and caught.value.residual > caught.value.tolerance > 0


def test_errors_travel_as_pickles() -> None:
    with pytest.raises(sinew.Unstable) as caught:
        crushed().finish()
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is sinew.Unstable and again.details == caught.value.details
    assert str(again) == str(caught.value)


def test_a_snapshot_of_another_scene_is_refused(simulation: sinew.Simulation, cube: sinew.Scene) -> None:
    other = sinew.Simulation(cube, backend="cpu")
    before = simulation.snapshot()
    with pytest.raises(sinew.SnapshotError):
        simulation.restore(other.snapshot())
    assert simulation.snapshot().differences(before) == []


def test_options_that_do_not_go_together(block: sinew.Scene) -> None:
    with pytest.raises(ValueError, match="f64"):
        sinew.Simulation(block, backend="gpu", precision="f64")
