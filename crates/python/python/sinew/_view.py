"""The live viewer, a program of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from ._errors import Error, SceneError, SnapshotError
from ._sinew import Picture, Scene, Simulation


def view(what: Scene | Simulation, *, run: bool = False, field: str | None = None) -> Picture | None:
    """Shows a scene from its start, or a simulation from its present state, in the live viewer, and waits until its
    window is closed. The viewer simulates for itself: `what` does not change. It can pull at a simulation that was made
    with `grabs=True`.

    In a notebook it gives a still picture of a simulation instead.

    run: whether it runs at once.
    field: what colours surfaces, by the names of `sinew-view --field`: "von_mises", "displacement" and so on.

    Raises Error where there is no program `sinew-view`, or it fails.
    """
    if isinstance(what, Simulation) and _is_notebook():
        return what.picture() if field is None else what.picture(field=field.title().replace("_", ""))
    program = shutil.which("sinew-view")
    if program is None:
        raise Error(
            "the viewer is not there: it is a program of its own, sinew-view; from sinew's repository: "
            "cargo install --path crates/view. Simulation.picture draws pictures without it"
        )
    scene = what.scene if isinstance(what, Simulation) else what
    with tempfile.TemporaryDirectory(prefix="sinew") as folder:
        words = [program, *_scene_words(scene, Path(folder))]
        if isinstance(what, Simulation):
            words += _state_words(what, Path(folder))
        words += ["--run"] if run else []
        words += ["--field", field] if field is not None else []
        ended = subprocess.run(words, stderr=subprocess.PIPE, text=True, check=False)
    if ended.returncode != 0:
        raise Error(ended.stderr.strip() or f"sinew-view ended with status {ended.returncode}")
    return None


def _scene_words(scene: Scene, folder: Path) -> list[str]:
    """The scene as the viewer is told it: its file and values, or a file in a folder that is there for so long."""
    made_of: Any = scene.__reduce__()
    name, text, path, files, sets, _ = made_of[1]
    if text is None:
        return [os.fspath(path), *(word for value in sets for word in ("--set", value))]
    if files is None:
        try:
            Scene.from_text(scene.text, files={})
        except SceneError as problem:
            raise ValueError(
                f"a scene of a text that names files in {path} cannot be shown: write the text there, and open that file"
            ) from problem
    for file, content in (files or {}).items():
        place = folder / file
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
    place = folder / (Path(name).name or "scene.ron")
    place.write_text(scene.text, encoding="utf-8")
    return [os.fspath(place)]


def _state_words(simulation: Simulation, folder: Path) -> list[str]:
    """The state as the viewer is told it; a static analysis has none, and is shown from its start."""
    precision = next(iter(simulation.bodies.values())).displacement.dtype
    words = ["--backend", "gpu" if simulation.is_on_gpu else "cpu", *(["--f64"] if precision == "float64" else [])]
    try:
        state = simulation.snapshot()
    except SnapshotError:
        return words
    place = folder / "state.sinew"
    state.write(place)
    return [*words, "--resume", os.fspath(place)]


def _is_notebook() -> bool:
    """Whether what calls is a kernel that shows pictures."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return getattr(shell, "kernel", None) is not None
