"""Steps, inputs, what is seen, ways back."""

from __future__ import annotations

import os
import pickle
import signal
import threading
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
import sinew

from conftest import BLOCK, PULL


def test_steps_and_times(simulation: sinew.Simulation) -> None:
    assert (simulation.time, simulation.step_count) == (0, 0)
    simulation.step()
    simulation.step(9)
    assert simulation.step_count == 10
    assert simulation.time == pytest.approx(10 * simulation.time_step)
    simulation.advance_to(0.05)
    assert 0.05 <= simulation.time + 1e-9 < 0.05 + 2 * simulation.time_step
    finished = [simulation.is_finished]
    simulation.finish()
    finished.append(simulation.is_finished)
    assert finished == [False, True] and not simulation.is_on_gpu
    assert "A block" in repr(simulation)


def test_pieces_change_no_bit(block: sinew.Scene) -> None:
    one, other = (sinew.Simulation(block, backend="cpu") for _ in range(2))
    for simulation in (one, other):
        simulation.inputs["grip"] = 1
    one.step(50)
    for _ in range(50):
        other.step()
    assert one.snapshot().differences(other.snapshot()) == []
    other.step()
    assert one.snapshot().differences(other.snapshot()) != []


def test_threads_change_no_bit(cube: sinew.Scene) -> None:
    states = []
    for threads in (1, 2):
        simulation = sinew.Simulation(cube, backend="cpu", threads=threads)
        simulation.step(40)
        states.append(simulation.body("cube").positions())
    assert (states[0] == states[1]).all() and np.ptp(states[0]) > 0


def test_a_budget_of_time(simulation: sinew.Simulation) -> None:
    told = simulation.advance_for(0.0)
    assert (told["steps"], told["why"]) == (1, "budget")
    told = simulation.advance_for(10.0, until=0.02)
    assert told["why"] == "reached" and simulation.time >= 0.02 - 1e-9
    assert told["simulated"] == pytest.approx(simulation.time - simulation.time_step)
    assert told["real_time_factor"] == pytest.approx(told["simulated"] / told["took"])
    started = time.perf_counter()
    told = simulation.advance_for(0.2)
    assert told["why"] == "budget" and 0.1 < time.perf_counter() - started < 2
    for wrong in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="budget"):
            simulation.advance_for(wrong)


def test_inputs_are_a_mapping(simulation: sinew.Simulation) -> None:
    inputs = simulation.inputs
    assert isinstance(inputs, Mapping)
    assert dict(inputs.items()) == {"grip": 0.0} and list(inputs) == ["grip"] and "grip" in inputs
    inputs["grip"] = 0.3
    assert inputs["grip"] == 0.0  # taken up by the next step
    about = inputs.about("grip")
    assert (about["target"], about["rate"], about["uses"]) == (0.3, 50.0, [("loads[0].curve", "force", "N")])
    simulation.step(200)
    assert inputs["grip"] == pytest.approx(0.3)
    assert simulation.probe("top")[0] > 0
    with pytest.raises(KeyError, match="there is grip"):
        inputs["grap"] = 1
    with pytest.raises(KeyError):
        inputs["grap"]
    assert inputs.get("grap") is None
    with pytest.raises(ValueError, match="finite"):
        inputs["grip"] = float("nan")


def test_what_is_seen(cube: sinew.Scene) -> None:
    simulation = sinew.Simulation(cube, backend="cpu", precision="f64")
    simulation.finish()
    body = simulation.body("cube")
    # the ground bears the cube: 1 kg; 1 % for what still moves
    assert simulation.probe("ground") == pytest.approx([0, 0, 9.81], abs=0.1)
    assert body.masses().sum() == pytest.approx(1.0)
    top = body.rest_positions[:, 2] > 0.0999
    mean = body.displacements()[top].mean(axis=0)
    assert mean == pytest.approx(simulation.probes()["top"], abs=2e-3) and mean[2] < -0.005
    fields = body.fields()
    assert {name: value.shape for name, value in fields.items()} == {
        "displacement": (64, 3),
        "velocity": (64, 3),
        "volume_ratio": (27,),
        "stress": (27, 6),
        "alive": (27,),
    }
    assert fields["alive"].dtype == bool and fields["alive"].all()
    # below, the material bears all of the weight over an area of about 0.01 m²: some -981 Pa; half an element's height
    # less of it is above the lowest elements' middles
    low = body.fields()["stress"][np.arange(27) < 9, 2].mean()
    assert -1000 < low < -600
    energies = simulation.energies()
    assert energies["strain"] > 0 and energies["load_work"] is None
    assert simulation.summary("finished")["ended"] == "finished"
    assert simulation.summary()["nodes"] == 64
    assert sorted(body.node_numbers) == list(range(body.node_numbers.min(), body.node_numbers.min() + 64))
    with pytest.raises(ValueError, match="contacts"):
        body.contact()


def test_the_surface_is_closed(cube: sinew.Scene) -> None:
    body = sinew.Simulation(cube, backend="cpu").body("cube")
    triangles, places = body.triangles, body.positions()
    assert triangles.dtype == np.uint32 and triangles.shape == (6 * 9 * 2, 3)
    a, b, c = (places[triangles[:, corner]] for corner in range(3))
    # divergence theorem: outward triangles hold the cube's volume
    assert (a * np.cross(b, c)).sum() / 6 == pytest.approx(1e-3)


def test_states_come_back(simulation: sinew.Simulation, tmp_path: Path) -> None:
    simulation.inputs["grip"] = 1
    simulation.step(20)
    kept = simulation.snapshot()
    assert kept.step_count == 20 and kept.time == simulation.time
    simulation.step(20)
    later = simulation.snapshot()
    simulation.restore(kept)
    assert simulation.step_count == 20
    simulation.step(20)
    assert simulation.snapshot().differences(later) == []
    kept.write(tmp_path / "kept.sinew")
    for again in (sinew.Snapshot.read(tmp_path / "kept.sinew"), pickle.loads(pickle.dumps(kept))):
        assert again.differences(kept) == []
    simulation.reset()
    assert simulation.step_count == 0 and simulation.inputs["grip"] == 0
    with pytest.raises(sinew.SnapshotError):
        sinew.Snapshot.from_bytes(b"no snapshot")


def test_history_is_rewound(simulation: sinew.Simulation) -> None:
    simulation.keep_history(0.01)
    simulation.advance_to(0.05)
    kept = simulation.history
    assert len(kept) >= 5 and kept[0] == 0 and np.diff(kept).min() >= 0.01
    reached = simulation.rewind(0.025)
    assert reached == simulation.time == simulation.history[-1] == max(time for time in kept if time <= 0.025) > 0
    simulation.forget_history()
    assert simulation.history == []


def test_materials_change_while_it_runs(cube: sinew.Scene) -> None:
    simulation = sinew.Simulation(cube, backend="cpu")
    simulation.advance_to(0.5)
    before = simulation.probe("top")[2]
    simulation.change({"materials.tissue.neo_hookean": "Young(young: 4500, poisson: 0.45)"})
    simulation.advance_to(0.9)
    # half as stiff again: it sags by two thirds and a little
    assert 0.75 * before < simulation.probe("top")[2] < 0.55 * before
    simulation.change({"loads[0].acceleration": (0, 0, 0.0)})
    simulation.advance_to(1.5)
    assert abs(simulation.probe("top")[2]) < 0.05 * abs(before)
    with pytest.raises(sinew.SceneError, match="poisson"):
        simulation.change({"materials.tissue.neo_hookean": "Young(young: 30000, poisson: 0.7)"})


def test_options_that_are_not_known(block: sinew.Scene) -> None:
    with pytest.raises(ValueError, match='allowed: "auto", "cpu", "gpu"'):
        sinew.Simulation(block, backend="tpu")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match='allowed: "f32", "f64"'):
        sinew.Simulation(block, precision="f16")  # type: ignore[arg-type]
    simulation = sinew.Simulation(block)
    with pytest.raises(ValueError, match='no body named "blok"; there is block'):
        simulation.body("blok")
    with pytest.raises(ValueError, match="no probe named"):
        simulation.probe("tip")


def test_ctrl_c_ends_a_long_run(cube: sinew.Scene) -> None:
    simulation = sinew.Simulation(cube, backend="cpu", threads=1)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    started = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        simulation.advance_to(1e6)
    assert time.perf_counter() - started < 10
    # it goes on from between two steps
    reached = simulation.step_count
    simulation.step()
    assert simulation.step_count == reached + 1 > 1


def test_the_interpreter_is_released(cube: sinew.Scene) -> None:
    simulation = sinew.Simulation(cube, backend="cpu", threads=1)
    thread = threading.Thread(target=simulation.step, args=(200_000,))
    thread.start()
    counted = 0
    while thread.is_alive() and counted < 1000:
        counted += 1
    # this thread ran while the other one stepped, and what it asks is answered between two pieces
    assert counted == 1000 and thread.is_alive()
    assert 0 < simulation.step_count <= 200_000
    thread.join()
    assert simulation.step_count == 200_000


def test_copies_are_parted() -> None:
    scene = sinew.Scene.from_text(
        BLOCK.replace('material: "tissue")', 'material: "tissue", copies: 5)').replace(
            "share: Total", "share: Total, per_copy: Linear(-1, 1)"
        )
    )
    simulation = sinew.Simulation(scene, backend="cpu")
    simulation.inputs["grip"] = 1
    simulation.advance_to(0.05)
    body = simulation.body("block")
    moved = body.by_copy(body.displacements())
    assert body.copies == 5 and moved.shape == (5, 64, 3)
    mean = moved[:, :, 0].mean(axis=1)
    # the force goes from -1 to 1 evenly: so do the copies, and the middle one stays
    assert mean[0] < mean[1] < mean[2] < mean[3] < mean[4]
    assert mean[0] == pytest.approx(-mean[4], rel=1e-3) and mean[2] == 0
    assert body.by_copy(body.fields()["stress"]).shape == (5, 27, 6)
    with pytest.raises(ValueError, match="cannot be parted into 5 copies"):
        body.by_copy(moved[:4, 0])


def test_arrays_are_numbers_a_copy() -> None:
    stiffness = np.array([1e3, 4e3])
    scene = sinew.Scene.from_text(
        BLOCK.replace('material: "tissue")', 'material: "tissue", copies: 2)'),
        {"bodies.block.per_copy": f'{{"tissue.neo_hookean.young": {sinew.per_copy(stiffness)}}}'},
    )
    simulation = sinew.Simulation(scene, backend="cpu")
    simulation.inputs["grip"] = 0.1
    simulation.advance_to(0.05)
    body = simulation.body("block")
    soft, stiff = body.by_copy(body.displacements())[:, :, 0].mean(axis=1)
    assert soft > stiff > 0
    for wrong in (stiffness[None], [1.0, float("nan")]):
        with pytest.raises(ValueError, match="one finite number or vector a copy"):
            sinew.per_copy(wrong)


def test_arrays_are_vectors_a_copy() -> None:
    ways = np.array([[0.0, 2.0, 0.0], [3.0, 0.0, 0.0]])
    gravity = f'Gravity(body: "block", acceleration: (1, 1, 1), per_copy: {sinew.per_copy(ways)})'
    text = BLOCK.replace('material: "tissue")', 'material: "tissue", copies: 2)').replace(PULL, gravity)
    simulation = sinew.Simulation(sinew.Scene.from_text(text), backend="cpu")
    simulation.advance_to(0.01)
    body = simulation.body("block")
    first, second = body.by_copy(body.displacements()).mean(axis=1)
    assert first[1] > 10 * abs(first[0]) and second[0] > 10 * abs(second[1])
