"""The live viewer is a program of its own: what it is told."""

from __future__ import annotations

import os
import sys
import types
from pathlib import Path

import pytest
import sinew

from conftest import BLOCK, ROOT

# keeps what it is told, and the files that it is told of
PROGRAM = """#!/bin/sh
printf '%s\\n' "$@" > "$SEEN/words"
cp -r "$(dirname "$1")" "$SEEN/folder"
case "$*" in *"--field none") echo "there is no field none" >&2; exit 2 ;; esac
"""


@pytest.fixture
def seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    program = tmp_path / "sinew-view"
    program.write_text(PROGRAM)
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("SEEN", str(tmp_path))
    return tmp_path


def words(seen: Path) -> list[str]:
    return (seen / "words").read_text().splitlines()


def test_a_simulation_is_seen_from_where_it_is(simulation: sinew.Simulation, seen: Path) -> None:
    simulation.inputs["grip"] = 1
    simulation.step(30)
    assert sinew.view(simulation, run=True, field="von_mises") is None
    scene, *told = words(seen)
    state = told[told.index("--resume") + 1]
    assert told == ["--backend", "cpu", "--resume", state, "--run", "--field", "von_mises"]
    assert (seen / "folder" / Path(scene).name).read_text() == simulation.scene.text
    kept = sinew.Snapshot.read(seen / "folder" / Path(state).name)
    assert kept.step_count == 30 and kept.differences(simulation.snapshot()) == []
    assert not Path(scene).exists(), "nothing is left behind"


def test_numbers_are_as_wide_as_they_were(block: sinew.Scene, seen: Path) -> None:
    sinew.view(sinew.Simulation(block, backend="cpu", precision="f64"))
    assert "--f64" in words(seen)


def test_a_scene_is_seen_from_its_start(cube: sinew.Scene, seen: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SEEN", str(seen / "other"))
    (seen / "other").mkdir()
    sinew.view(cube)
    path = str(ROOT / "scenes/cube_under_gravity.ron")
    assert words(seen / "other") == [path, "--set", "bodies.cube.mesh.cells=(3, 3, 3)"]


def test_files_in_memory_go_with_it(seen: Path) -> None:
    mesh = (ROOT / "scenes/meshes/lens_814.msh").read_bytes()
    text = (ROOT / "scenes/lens_tets.ron").read_text()
    sinew.view(sinew.Scene.from_text(text, name="lens.ron", files={"meshes/lens_814.msh": mesh}))
    assert [Path(word).name for word in words(seen)] == ["lens.ron"]
    assert (seen / "folder/meshes/lens_814.msh").read_bytes() == mesh
    # a viewer has no folder in which the text stands
    with pytest.raises(ValueError, match="write the text there"):
        sinew.view(sinew.Scene.from_text(text, folder=ROOT / "scenes"))


def test_what_the_viewer_says_is_an_error(simulation: sinew.Simulation, seen: Path) -> None:
    with pytest.raises(sinew.Error, match="there is no field none"):
        sinew.view(simulation, field="none")


def test_who_has_no_viewer_is_told_how_to_get_it(cube: sinew.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(sinew.Error, match="cargo install --path crates/view"):
        sinew.view(cube)


def test_a_notebook_shows_a_picture(simulation: sinew.Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = types.SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: kernel))
    for field in (None, "von_mises"):
        picture = sinew.view(simulation, field=field)
        assert picture is not None and picture.png.startswith(b"\x89PNG")
