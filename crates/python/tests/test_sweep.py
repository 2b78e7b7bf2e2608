"""Sweeps: the same rows wherever they run, none twice, none lost."""

from __future__ import annotations

import concurrent.futures
import json
import multiprocessing
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sinew

import kept
from conftest import BLOCK, PULL, ROOT

# held below, under its weight
SAGGING = BLOCK.replace(PULL, "Gravity(acceleration: (0, 0, -9.81))")
YOUNG = "materials.tissue.neo_hookean.young"
WAYS = [(0, 0, -9.81), (0, 0, -1.62), (3.0, 0, 0)]
TABLE: list[dict[str, Any]] = sinew.grid({YOUNG: [3000, 6000, 12000], "loads[0].acceleration": WAYS})


@pytest.fixture
def sagging() -> sinew.Scene:
    return sinew.Scene.from_text(SAGGING)


def same(one: Sequence[sinew.Row], other: Sequence[sinew.Row]) -> bool:
    """Whether all is the same to the last bit, but for what it took."""

    def plain(row: sinew.Row) -> tuple[object, ...]:
        places = {name: (value.dtype.str, value.shape, value.tobytes()) for name, value in row.kept.items()}
        return (row.number, json.dumps(row.values), row.ended, row.error, row.time, row.warnings, places)

    return [plain(row) for row in one] == [plain(row) for row in other]


def test_rows_are_what_single_runs_give(sagging: sinew.Scene) -> None:
    rows = sinew.sweep(sagging, TABLE, keep=kept.shape)
    assert [row.number for row in rows] == list(range(9)) and {row.ended for row in rows} == {"Finished"}
    for row, values in zip(rows, TABLE, strict=True):
        simulation = sinew.Simulation(sagging.with_values(values), backend="cpu", threads=1)
        simulation.finish()
        assert (row.kept["places"] == simulation.body("block").positions()).all()
        assert row.time == simulation.time and row.kept["count"] == 64
    # stiffer tissue sags less
    assert rows[0].kept["mean"][2] < rows[3].kept["mean"][2] < rows[6].kept["mean"][2] < 0.05


def test_probes_at_times(sagging: sinew.Scene) -> None:
    (row,) = sinew.sweep(sagging, [{YOUNG: 5000}], keep=["top", "ground"], at=[0.01, 0.02, 0.1])
    assert row.kept["top"].shape == (3, 3)
    assert row.kept["top"][0, 2] > row.kept["top"][1, 2] > row.kept["top"][2, 2]


@pytest.mark.parametrize("at", [[0.02, 0.01], [0.01, 0.01], [float("nan")], [-1.0]])
def test_times_that_do_not_ascend_are_refused(sagging: sinew.Scene, at: list[float]) -> None:
    for keep in (["top"], kept.shape):
        with pytest.raises(ValueError, match="no time|ascend"):
            sinew.sweep(sagging, [{YOUNG: 5000}], keep=keep, at=at)


def test_times_within_a_step_are_met(sagging: sinew.Scene) -> None:
    steps = {"solver": "Implicit(step: 0.01)"}
    (row,) = sinew.sweep(sagging, [steps], keep=["top"], at=[0.01, 0.0125, 0.0175, 0.02])
    first, *between, last = row.kept["top"]
    assert np.allclose(between, [first + share * (last - first) for share in (0.25, 0.75)], rtol=0, atol=1e-12)
    assert np.abs(last - first).max() > 1e-5


def test_a_variant_that_ends_before_it_is_asked_is_a_row(sagging: sinew.Scene) -> None:
    for keep in (["top"], kept.shape):
        rows = sinew.sweep(sagging, [{"duration": 0.05}, {"duration": 0.01}], keep=keep, at=[0.02])
        assert [row.ended for row in rows] == ["Finished", "SceneError"]
        assert "0.02 s is after the scene's end, 0.01 s" in str(rows[1].error)


def test_what_guards_warn_of_is_in_rows(sagging: sinew.Scene) -> None:
    rows = sinew.sweep(sagging, [{"guards": "(energy: (warn: 1e-12))"}, {}], keep=["top"])
    assert "came from nothing" in rows[0].warnings[0] and rows[1].warnings == []


def test_a_variant_that_breaks_down_is_a_row(sagging: sinew.Scene) -> None:
    crushed = {"loads[0].acceleration": (0, 0, -3000)}
    table: list[dict[str, Any]] = [{YOUNG: 3000}, crushed, {YOUNG: -1}, {YOUNG: 6000}]
    rows = sinew.sweep(sagging, table, keep=["top"], at=[0.01, 0.1])
    assert [row.ended for row in rows] == ["Finished", "Unstable", "SceneError", "Finished"]
    assert "broke down" in str(rows[1].error) and 0 < rows[1].time < 0.1 and "young" in str(rows[2].error)
    assert len(rows[1].kept.get("top", [])) < 2 == len(rows[0].kept["top"])


def test_nothing_runs_twice(sagging: sinew.Scene, tmp_path: Path) -> None:
    out = tmp_path / "manifest.jsonl"
    table: list[dict[str, Any]] = [*TABLE[:4], {"loads[0].acceleration": (0, 0, -3000)}]
    first = sinew.sweep(sagging, table, keep=kept.shape, out=tmp_path)
    lines = out.read_text().splitlines()
    assert len(lines) == 5
    assert same(sinew.sweep(sagging, table, keep=kept.shape, out=tmp_path), first)
    assert out.read_text().splitlines() == lines
    # of a sweep that was cut off in the middle of a line, what is missing runs
    out.write_text("\n".join(lines[:3]) + "\n" + lines[3][:50])
    assert same(sinew.sweep(sagging, table, keep=kept.shape, out=tmp_path), first)
    again = out.read_text().splitlines()
    assert len(again) == 6 and again[:3] == lines[:3]
    # of another precision, other values, other things kept, nothing counts
    sinew.sweep(sagging, table[:1], keep=kept.shape, out=tmp_path, precision="f64")
    sinew.sweep(sagging, [{YOUNG: 3001}], keep=kept.shape, out=tmp_path)
    sinew.sweep(sagging, table[:1], keep=["top"], out=tmp_path)
    assert len(out.read_text().splitlines()) == 9
    known = json.loads(lines[0])
    assert {"key", "number", "values", "ended", "error", "time", "kept", "seconds", "warnings"} == set(known)


SWEEP = """(
    scene: "sagging.ron",
    variants: Grid([("materials.tissue.neo_hookean.young", [3000, 6000.5]), ("materials.tissue.damping", [5, 7.5, 20]),
        ("loads[0].acceleration", ["(0, 0, -9.81)", "(0, 0, -3000)"])]),
    keep: ["top", "ground"],
    at: [0.05, 0.1],
)"""


def test_the_command_and_python_go_on_with_each_other(tmp_path: Path) -> None:
    command = ROOT / "target/debug/sinew"
    if not command.exists():
        pytest.skip("the command has not been built: cargo build")
    (tmp_path / "sagging.ron").write_text(SAGGING)
    file = tmp_path / "sweep.ron"
    file.write_text(SWEEP)
    a_sweep = sinew.read_sweep(file)

    def by_the_command(out: Path) -> str:
        words = [str(command), "sweep", str(file), "-o", str(out)]
        told = subprocess.run(words, check=True, capture_output=True, text=True, cwd=tmp_path)
        return str(told.stdout)

    def half(out: Path) -> None:
        lines = (out / "manifest.jsonl").read_text().splitlines()
        (out / "manifest.jsonl").write_text("\n".join(lines[:5]) + "\n")

    first, second = tmp_path / "first", tmp_path / "second"
    assert "already" not in by_the_command(first)
    whole = (first / "rows.csv").read_bytes()
    rows = sinew.sweep(**a_sweep, out=second)
    assert (second / "rows.csv").read_bytes() == whole
    assert [row.ended for row in rows] == ["Finished", "Unstable"] * 6 and rows[0].kept["top"].shape == (2, 3)
    # what one has begun the other goes on with
    half(first)
    assert same(sinew.sweep(**a_sweep, out=first), rows)
    assert len((first / "manifest.jsonl").read_text().splitlines()) == 12
    half(second)
    assert "5 of them there already" in by_the_command(second)
    assert (first / "rows.csv").read_bytes() == (second / "rows.csv").read_bytes() == whole
    # the same rows of the same seed
    file.write_text(
        'LatinHypercube(count: 7, seed: 3, places: [("a", (0, 1)), ("b", (10, 30))])'.join(
            ['(scene: "sagging.ron", variants: ', ', keep: ["top"])']
        )
    )
    drawn = sinew.read_sweep(file)["table"]
    assert drawn == sinew.latin_hypercube({"a": (0, 1), "b": (10, 30)}, 7, seed=3)


def test_parts_are_the_whole(sagging: sinew.Scene) -> None:
    whole = sinew.sweep(sagging, TABLE, keep=kept.shape)
    parts = [sinew.sweep(sagging, TABLE, keep=kept.shape, part=(part, 4)) for part in (1, 2, 3, 4)]
    assert [len(part) for part in parts] == [3, 2, 2, 2]
    assert same(sorted(sum(parts, []), key=lambda row: row.number), whole)
    with pytest.raises(ValueError, match="no part 5 of 4"):
        sinew.sweep(sagging, TABLE, keep=kept.shape, part=(5, 4))


@pytest.mark.parametrize("pack", [0.0, 1.0])
def test_processes_give_the_same_bits(sagging: sinew.Scene, pack: float) -> None:
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        rows = sinew.sweep(sagging, TABLE, keep=kept.shape, on=pool, pack=pack)
    assert same(rows, sinew.sweep(sagging, TABLE, keep=kept.shape))


def test_mistakes_of_ones_own_end_it(sagging: sinew.Scene, tmp_path: Path) -> None:
    # of whichever variant ends first
    with pytest.raises(ZeroDivisionError, match="at 0.(0999|1)"):
        sinew.sweep(sagging, TABLE, keep=kept.wrong, out=tmp_path)
    with pytest.raises(TypeError, match="cannot be kept"):
        sinew.sweep(sagging, TABLE[:1], keep=lambda simulation: {"simulation": simulation})


def test_dask_loses_a_worker_and_no_row(
    sagging: sinew.Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.setenv("SINEW_TEST_MARK", str(tmp_path / "mark"))
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent))
    table = [{YOUNG: 3000 + 100 * number} for number in range(40)]
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        before = set(client.run(lambda: __import__("os").getpid()).values())
        rows = sinew.sweep(sagging, table, keep=kept.shape_of_a_mortal, on=client, pack=0.1)
        client.wait_for_workers(2)
        after = set(client.run(lambda: __import__("os").getpid()).values())
    # one of the two was killed in the middle of its work, and another came
    assert (tmp_path / "mark").exists() and len(before & after) == 1
    assert same(rows, sinew.sweep(sagging, table, keep=kept.shape))


def test_ray_gives_the_same_bits(sagging: sinew.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    ray = pytest.importorskip("ray")
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parent))

    class OnRay:
        def submit(self, fn: object, /, *args: object) -> concurrent.futures.Future[object]:
            future: concurrent.futures.Future[object] = ray.remote(fn).remote(*args).future()
            return future

    ray.init(num_cpus=2, include_dashboard=False)
    try:
        rows = sinew.sweep(sagging, TABLE, keep=kept.shape, on=OnRay())
    finally:
        ray.shutdown()
    assert same(rows, sinew.sweep(sagging, TABLE, keep=kept.shape))


def test_tables() -> None:
    assert sinew.grid({"a": [1, 2], "b": ["x", "y"]}) == [
        {"a": 1, "b": "x"},
        {"a": 1, "b": "y"},
        {"a": 2, "b": "x"},
        {"a": 2, "b": "y"},
    ]
    table = sinew.latin_hypercube({"a": (0, 1), "b": (10, 30)}, 50, seed=7)
    assert table == sinew.latin_hypercube({"a": (0, 1), "b": (10, 30)}, 50, seed=7)
    assert table != sinew.latin_hypercube({"a": (0, 1), "b": (10, 30)}, 50, seed=8)
    for place, low, high in (("a", 0, 1), ("b", 10, 30)):
        shares = (np.array([row[place] for row in table]) - low) / (high - low)
        # one in each of the intervals
        assert sorted((shares * 50).astype(int)) == list(range(50))
