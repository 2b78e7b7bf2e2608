"""Many variants of a scene, wherever there are processors; what is done is kept, whatever happens. Which there are, and
what is known of them, is the engine's (`sinew sweep`); here they are spread."""

from __future__ import annotations

import concurrent.futures
import itertools
import json
import math
import os
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ._errors import Error, NotConverged, SceneError, Unstable
from ._sinew import (
    Scene,
    Simulation,
    SweepResults,
    check_kept,
    latin_hypercube_rows,
    probes_at,
    read_sweep_file,
    warnings_of,
)

Values = Mapping[str, Any]
Keep = Sequence[str] | Callable[[Simulation], Mapping[str, Any]]


@dataclass(frozen=True)
class Row:
    """What became of a variant."""

    number: int
    """Its number in the table, counted from 0."""
    values: dict[str, Any]
    """What was put in, by place."""
    ended: str
    """`Finished`, or the name of what ended it: `Unstable`, `NotConverged`, `SceneError`."""
    error: str | None
    """What was said then."""
    time: float
    """Simulated time that was reached (s)."""
    seconds: float
    """What it took on the wall (s), making it included."""
    kept: dict[str, NDArray[Any]]
    """What was kept, by name: with `at` a first axis of times, of which a variant that ended early has fewer. What is no
    finite number is `nan`."""
    warnings: list[str]
    """What the guards warned of: its numbers are that uncertain."""


class Executor(Protocol):
    """What sweeps run on: of `concurrent.futures`, mpi4py, or a Dask client."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Any:
        """Calls a function elsewhere."""


def grid(places: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Every combination of values of places, the last place changing fastest."""
    return [dict(zip(places, values, strict=True)) for values in itertools.product(*places.values())]


def latin_hypercube(places: Mapping[str, tuple[float, float]], count: int, *, seed: int) -> list[dict[str, Any]]:
    """So many variants whose values of each place, from low to high, are one in each of `count` equal intervals (McKay,
    Beckman & Conover 1979). The same seed gives the same table."""
    rows = latin_hypercube_rows(list(places.items()), count, seed)
    return [dict(zip(places, row, strict=True)) for row in rows]


def read_sweep(path: str | os.PathLike[str], *, allow_outside: bool = False) -> dict[str, Any]:
    """What `sweep` is given by a file of the command `sinew sweep`: `sweep(**read_sweep("sweep.ron"), out="out/sweep")`
    goes on where the command was stopped, and the other way round."""
    scene, table, keep, at = read_sweep_file(os.fspath(path))
    return {
        "scene": Scene(scene, allow_outside=allow_outside),
        "table": table,
        "keep": keep,
        "at": at or None,
    }


def sweep(
    scene: Scene,
    table: Sequence[Values],
    *,
    keep: Keep,
    at: Sequence[float] | None = None,
    on: Executor | None = None,
    out: str | os.PathLike[str] | None = None,
    part: tuple[int, int] = (1, 1),
    pack: float = 1.0,
    ahead: int | None = None,
    **options: Any,
) -> list[Row]:
    """Runs a scene with each row of a table put in; one Row for each, in the table's order.

    keep: names of probes, or a function that takes a simulation and gives what is to be kept of it, by name: numbers,
        lists or arrays. It is asked at the times of `at` (s), or once at the scene's end: probes exactly there, what
        lies within a step interpolated as in tables; a function at the end of the first step not before each.
    on: where: anything with `submit` whose futures are those of `concurrent.futures`, or a Dask client. Left out,
        threads of this process, one a core. A function for `keep` must be importable where processes do the work.
    out: a folder, with the files of the command `sinew sweep`: `manifest.jsonl`, a line a row, written as rows come in,
        and the table `rows.csv` of what probes saw. What stands in it is not run again, whoever ran it: a sweep that
        was cut off goes on. A line counts for the same scene text, values, times, probes (or name of the function),
        options and version of sinew, and while the files that its variant names hold the same.
    part: (3, 16) takes the third of 16 parts of the table, each 16th row; the rows' numbers stay those of the table.
    pack: rows are sent in packs of about so many seconds, `ahead` packs ahead of what has come back.
    options: those of Simulation; `threads` is 1 and `backend` "cpu" unless they say otherwise.

    A variant that breaks down, or whose values are wrong, is a row. Other errors end the sweep, what is done stays in
    `out`.
    """
    which, parts = part
    if not 1 <= which <= parts:
        raise ValueError(f"there is no part {which} of {parts}")
    options = {"threads": 1, "backend": "cpu", "precision": "f32", "grabs": False, **options}
    rows = [dict(values) for values in table]
    times = [] if at is None else [float(time) for time in at]
    with tempfile.TemporaryDirectory() as nowhere:
        how = (options["backend"], options["precision"], options["grabs"])
        results = SweepResults(scene, rows, _keep_name(keep), times, part, os.fspath(out or nowhere), how)
        missing = [(number, rows[number]) for number in results.missing()]
        try:
            for number, line in _run((scene, keep, times or None, options), missing, on, pack, ahead):
                results.add(number, json.dumps(line))
        finally:
            results.write_table()
        lines = [json.loads(line) for line in results.lines()]
    return [_row(line, rows[line["number"]]) for line in lines]


def _keep_name(keep: Keep) -> str | list[str]:
    if callable(keep):
        return f"{keep.__module__}.{getattr(keep, '__qualname__', type(keep).__qualname__)}"
    return list(keep)


def _plain(value: Any) -> Any:
    """What is kept as JSON has it: numbers and arrays of numpy as lists, what is no finite number as null."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {str(name): _plain(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return None
    if isinstance(value, bool | int | float | str):
        return value
    raise TypeError(f"{value!r} cannot be kept: only numbers, texts, lists, dicts and arrays can")


def _array(value: Any) -> NDArray[Any]:
    try:
        array = np.asarray(value)
        return np.asarray(value, np.float64) if array.dtype == object else array
    except (TypeError, ValueError):
        return np.asarray(value, object)


def _row(line: Mapping[str, Any], values: Values) -> Row:
    kept = {name: _array(value) for name, value in line["kept"].items()}
    names = ("number", "ended", "error", "time", "seconds", "warnings")
    return Row(**{name: line[name] for name in names}, values=dict(values), kept=kept)


def _run(
    work: tuple[Any, ...], variants: Sequence[tuple[int, Values]], on: Executor | None, pack: float, ahead: int | None
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Numbers and lines as they come in."""
    if not variants:
        return
    own = concurrent.futures.ThreadPoolExecutor(os.cpu_count()) if on is None else None
    executor: Any = own or on
    if hasattr(executor, "get_executor"):
        executor = executor.get_executor()  # of a Dask client
    most = ahead or 2 * (getattr(executor, "_max_workers", None) or os.cpu_count() or 1)
    left, flying = list(reversed(variants)), set[Any]()
    seconds, lines = 0.0, 0
    try:
        while left or flying:
            while left and len(flying) < most:
                fits = max(1, int(pack * lines / seconds)) if seconds > 0 else 1
                # near the end everybody gets a share
                fits = min(fits, -(-len(left) // most))
                taken = [left.pop() for _ in range(min(fits, len(left)))]
                flying.add(executor.submit(run_pack, *work, taken))
            finished, flying = concurrent.futures.wait(flying, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in finished:
                for line in future.result():
                    seconds, lines = seconds + line["seconds"], lines + 1
                    yield line["number"], line
    finally:
        for future in flying:
            future.cancel()
        if own is not None:
            own.shutdown()


def run_pack(
    scene: Scene,
    keep: Keep,
    at: Sequence[float] | None,
    options: Mapping[str, Any],
    variants: Sequence[tuple[int, Values]],
) -> list[dict[str, Any]]:
    """What is called where the work is done: one line a variant, of numbers and lists alone."""
    return [_run_one(scene, keep, at, options, number, values) for number, values in variants]


def _run_one(
    scene: Scene, keep: Keep, at: Sequence[float] | None, options: Mapping[str, Any], number: int, values: Values
) -> dict[str, Any]:
    started = time.perf_counter()
    kept: dict[str, Any] = {}
    reached, ended, error = 0.0, "Finished", None
    warnings: list[str] = []
    simulation = None
    try:
        variant = scene.with_values(values)
        # it may end before the scene as it stands does
        check_kept(variant, [] if callable(keep) else list(keep), list(at or ()))
        simulation = Simulation(variant, **options)
        if at is None:
            simulation.finish()
            kept = dict(_ask(keep, simulation))
        left = list(at or ())
        while left:
            seen = _ask_at(keep, simulation, left)
            left = left[len(seen) :]
            for name, value in ((name, value) for one in seen for name, value in one.items()):
                kept.setdefault(name, []).append(value)
    except (Unstable, NotConverged, SceneError) as problem:
        # other errors say nothing of the variant
        ended, error = type(problem).__name__, str(problem)
    if simulation is not None:
        try:
            reached, warnings = simulation.time, warnings_of(simulation)
        except Error:
            pass
    seconds = time.perf_counter() - started
    # what a process hands over is what the file holds, without the values
    line = {"number": number, "ended": ended, "error": error, "time": reached, "seconds": seconds}
    return {**line, "kept": _plain(kept), "warnings": warnings}


def _ask(keep: Keep, simulation: Simulation) -> Mapping[str, Any]:
    return keep(simulation) if callable(keep) else {name: simulation.probe(name) for name in keep}


def _ask_at(keep: Keep, simulation: Simulation, times: Sequence[float]) -> list[Mapping[str, Any]]:
    """What is to be kept at the first of some times (s), and at those after it that need no further step."""
    if callable(keep):
        simulation.advance_to(times[0])
        return [keep(simulation)]
    return [dict(zip(keep, seen, strict=True)) for seen in probes_at(simulation, list(keep), list(times))]
