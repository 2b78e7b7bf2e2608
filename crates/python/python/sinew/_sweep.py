"""Many variants of a scene, wherever there are processors; what is done is kept, whatever happens."""

from __future__ import annotations

import concurrent.futures
import hashlib
import itertools
import json
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ._errors import Error, GpuError
from ._sinew import Scene, Simulation, __version__

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
    """`finished`, or the name of what ended it: `Unstable`, `NotConverged`, `SceneError`, `GpuError`."""
    error: str | None
    """What was said then."""
    time: float
    """Simulated time that was reached (s)."""
    seconds: float
    """What it took on the wall (s), making it included."""
    kept: dict[str, NDArray[Any]]
    """What was kept, by name: with `at` a first axis of times, of which a variant that ended early has fewer."""


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
    random = np.random.default_rng(seed)
    columns = {}
    for place, (low, high) in places.items():
        shares = (random.permutation(count) + random.random(count)) / count
        columns[place] = [float(low + share * (high - low)) for share in shares]
    return [{place: column[row] for place, column in columns.items()} for row in range(count)]


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
        lists or arrays. It is asked at the times of `at` (s), or once at the scene's end.
    on: where: anything with `submit` whose futures are those of `concurrent.futures`, or a Dask client. Left out,
        threads of this process, one a core. A function for `keep` must be importable where processes do the work.
    out: a file of JSON lines, one a row, written as rows come in. What stands in it is not run again: a sweep that was
        cut off goes on. A line counts for the same scene text, values, times, probes (or name of the function), options
        and version of sinew; content of mesh files is not looked at.
    part: (3, 16) takes the third of 16 parts of the table, each 16th row; the rows' numbers stay those of the table.
    pack: rows are sent in packs of about so many seconds, `ahead` packs ahead of what has come back.
    options: those of Simulation; `threads` is 1 and `backend` "cpu" unless they say otherwise.

    A variant that breaks down, or whose values are wrong, is a row. Other errors end the sweep, what is done stays in
    `out`.
    """
    which, parts = part
    if not 1 <= which <= parts:
        raise ValueError(f"there is no part {which} of {parts}")
    options = {"threads": 1, "backend": "cpu", **options}
    numbered = [(number, dict(values)) for number, values in enumerate(table) if number % parts == which - 1]
    how = (None if at is None else [float(time) for time in at], _keep_name(keep), options)
    keys = {number: _key(scene, values, how) for number, values in numbered}
    done = dict(_read(out, keys)) if out is not None else {}
    missing = [variant for variant in numbered if variant[0] not in done]
    work = (scene, keep, how[0], options)
    for line in _run(work, missing, on, pack, ahead):
        done[line["number"]] = line
        if out is not None:
            _write(out, {"key": keys[line["number"]], "version": __version__, **line})
    return [_row(done[number]) for number, _ in numbered]


def _keep_name(keep: Keep) -> Any:
    if callable(keep):
        return f"{keep.__module__}.{getattr(keep, '__qualname__', type(keep).__qualname__)}"
    return list(keep)


def _key(scene: Scene, values: Values, how: tuple[Any, ...]) -> str:
    what = [__version__, scene.text, values, *how]
    return hashlib.sha256(json.dumps(what, sort_keys=True, default=_plain).encode()).hexdigest()[:32]


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} cannot be kept: only numbers, texts, lists, dicts and arrays can")


def _read(out: str | os.PathLike[str], keys: Mapping[int, str]) -> Iterator[tuple[int, dict[str, Any]]]:
    try:
        file = open(out, encoding="utf-8")
    except FileNotFoundError:
        return
    with file:
        for text in file:
            try:
                line = json.loads(text)
            except ValueError:
                continue  # cut off in the middle
            number = line.get("number")
            # a GPU that failed says nothing of the variant
            if keys.get(number) == line.get("key") and line.get("ended") != GpuError.__name__:
                yield number, line


def _write(out: str | os.PathLike[str], line: Mapping[str, Any]) -> None:
    with open(out, "a+b") as file:
        # after a line that was cut off a new one begins
        if file.tell() > 0:
            file.seek(-1, os.SEEK_END)
            if file.read(1) != b"\n":
                file.write(b"\n")
        file.write((json.dumps(line, default=_plain) + "\n").encode())


def _row(line: Mapping[str, Any]) -> Row:
    kept = {name: np.asarray(value) for name, value in line["kept"].items()}
    names = ("number", "values", "ended", "error", "time", "seconds")
    return Row(**{name: line[name] for name in names}, kept=kept)


def _run(
    work: tuple[Any, ...], variants: Sequence[tuple[int, Values]], on: Executor | None, pack: float, ahead: int | None
) -> Iterator[dict[str, Any]]:
    """Lines as they come in."""
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
                    yield line
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
    reached, ended, error = 0.0, "finished", None
    simulation = None
    try:
        simulation = Simulation(scene.with_values(values), **options)
        if at is None:
            simulation.finish()
            kept = dict(_ask(keep, simulation))
        for moment in at or ():
            simulation.advance_to(moment)
            for name, value in _ask(keep, simulation).items():
                kept.setdefault(name, []).append(value)
    except Error as problem:
        ended, error = type(problem).__name__, str(problem)
    if simulation is not None:
        try:
            reached = simulation.time
        except Error:
            pass
    line = {"number": number, "values": dict(values), "ended": ended, "error": error, "time": reached}
    # what a process hands over is what the file holds
    plain: dict[str, Any] = json.loads(json.dumps({**line, "kept": kept}, default=_plain))
    return {**plain, "seconds": time.perf_counter() - started}


def _ask(keep: Keep, simulation: Simulation) -> Mapping[str, Any]:
    return keep(simulation) if callable(keep) else {name: simulation.probe(name) for name in keep}
