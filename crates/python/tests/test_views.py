"""Arrays without copies: they show what they should, and live as long as anybody holds them."""

from __future__ import annotations

import gc

import numpy as np
import pytest
import sinew

from conftest import BLOCK, ROOT


def churn() -> list[bytearray]:
    """Takes memory that was freed, and writes into it."""
    gc.collect()
    return [bytearray(b"\xff" * size) for size in (768, 1536, 4096) for _ in range(2000)]


def pulled(scene: sinew.Scene, **options: object) -> sinew.Simulation:
    simulation = sinew.Simulation(scene, threads=1, **options)  # type: ignore[arg-type]
    simulation.inputs["grip"] = 1
    simulation.step(30)
    return simulation


def test_a_view_is_of_the_engines_memory(block: sinew.Scene) -> None:
    simulation = pulled(block, backend="cpu")
    body = simulation.body("block")
    view = body.displacement
    assert view.dtype == np.float32 and view.shape == (64, 3) and not view.flags.owndata
    assert view.ctypes.data == body.displacement.ctypes.data
    assert (view[body.rows] == body.displacements()).all() and view.any()
    assert body.positions() == pytest.approx(body.rest_positions + view[body.rows], abs=1e-9)
    # explicit steps write where it lies
    before, generation = view.copy(), body.generation
    simulation.step(30)
    assert body.generation == generation and (view[body.rows] == body.displacements()).all()
    assert (view != before).any()
    wide = pulled(block, backend="cpu", precision="f64").body("block").displacement
    assert wide.dtype == np.float64 and wide == pytest.approx(before, abs=1e-5)


def test_nobody_writes_into_the_engine(simulation: sinew.Simulation) -> None:
    view = simulation.body("block").displacement
    with pytest.raises(ValueError, match="read-only"):
        view[0, 0] = 1
    with pytest.raises(ValueError, match="WRITEABLE"):
        view.flags.writeable = True


def test_a_view_outlives_its_simulation(block: sinew.Scene) -> None:
    simulation = pulled(block, backend="cpu")
    view = simulation.body("block").displacement
    address, shown = view.ctypes.data, view.copy()
    part = view[10:20, 1]
    del simulation
    taken = churn()
    assert (view == shown).all() and view.ctypes.data == address
    del view
    taken += churn()
    assert (part == shown[10:20, 1]).all()


@pytest.mark.parametrize("way", ["reset", "restore", "rewind", "change"])
def test_a_view_of_the_past_keeps_its_state(simulation: sinew.Simulation, way: str) -> None:
    body = simulation.body("block")
    simulation.keep_history(1e-3)
    start = simulation.snapshot()
    simulation.inputs["grip"] = 1
    simulation.step(30)
    view, generation = body.displacement, body.generation
    shown = view.copy()
    if way == "reset":
        simulation.reset()
    elif way == "restore":
        simulation.restore(start)
    elif way == "rewind":
        simulation.rewind(0)
    else:
        simulation.change({"loads[0].force": (0.25, 0, 0)})
    assert body.generation > generation
    simulation.step(5)
    taken = churn()
    assert (view == shown).all() and shown.any()
    new = body.displacement
    assert (new[body.rows] == body.displacements()).all() and (new != view).any() and taken


@pytest.mark.parametrize(
    "words",
    [
        {"solver": "Implicit(step: 0.01)", "loads[0].curve": "Input(name: \"grip\", rate: 50)"},
        {"analysis": "Static()"},
        {"analysis": "Static(method: Newton)"},
    ],
)
def test_steps_that_may_move_memory(words: dict[str, str]) -> None:
    scene = sinew.Scene.from_text(BLOCK, words)
    simulation = sinew.Simulation(scene, backend="cpu", threads=1)
    simulation.inputs["grip"] = 1
    body = simulation.body("block")
    views = []
    for _ in range(3):
        views.append((body.displacement, body.displacement.copy()))
        simulation.step(4)
    simulation.finish()
    taken = churn()
    assert all((view == shown).all() for view, shown in views) and taken
    assert (body.displacement[body.rows] == body.displacements()).all() and body.displacement.any()


def test_positions_go_into_the_callers_array(simulation: sinew.Simulation) -> None:
    body = simulation.body("block")
    simulation.inputs["grip"] = 1
    simulation.step(30)
    for kind in (np.float64, np.float32):
        out = np.zeros((64, 3), kind)
        assert body.positions(out=out) is out
        assert (out == body.positions().astype(kind)).all()
        assert body.displacements(out) is out and (out == body.displacements().astype(kind)).all()
    with pytest.raises(ValueError, match=r"\(63, 3\); it must be \(64, 3\)"):
        body.positions(out=np.zeros((63, 3)))
    copy = body.positions()
    copy[:] = 0
    assert body.positions().any()


def test_a_gpu_is_copied_from(block: sinew.Scene) -> None:
    try:
        simulation = pulled(block, backend="gpu")
    except sinew.GpuError as missing:
        pytest.skip(str(missing))
    assert simulation.is_on_gpu
    body = simulation.body("block")
    view, shown = body.displacement, body.displacement.copy()
    assert shown.any()
    simulation.step(30)
    assert (body.displacement[body.rows] == body.displacements()).all()
    assert (view == shown).all() and (body.displacement != shown).any()
    other = pulled(block, backend="cpu").body("block").displacement
    assert shown == pytest.approx(other, abs=1e-5 * float(np.abs(other).max()))


def test_many_bodies_each_have_their_view() -> None:
    scene = sinew.Scene(ROOT / "scenes/stacked_blocks.ron")
    simulation = sinew.Simulation(scene, backend="cpu")
    views = {name: body.displacement for name, body in simulation.bodies.items()}
    simulation.step(20)
    shown = {name: body.displacements()[np.argsort(body.rows)] for name, body in simulation.bodies.items()}
    assert len(views) == 3
    del simulation
    taken = churn()
    assert all((views[name] == shown[name]).all() for name in views) and taken
