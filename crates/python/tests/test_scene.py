"""Scenes, and what is wrong with them."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
import sinew

from conftest import BLOCK, ROOT


def test_a_scene_tells_what_it_holds(cube: sinew.Scene) -> None:
    assert cube.title == "Cube under gravity"
    assert (cube.duration, cube.bodies, cube.probes, cube.tools) == (1.0, ["cube"], ["ground", "top"], [])
    assert "cells: (3, 3, 3)" in cube.text


@pytest.mark.parametrize("cells", [(2, 4, 5), [2, 4, 5], np.array([2, 4, 5]), "(2, 4, 5)"])
def test_values_are_put_in(cells: object) -> None:
    place = "bodies.block.mesh.cells"
    if isinstance(cells, list):
        with pytest.raises(sinew.SceneError):  # a list is a list, and cells are none
            sinew.Scene.from_text(BLOCK, {place: cells})
        return
    scene = sinew.Scene.from_text(BLOCK, {place: cells})
    assert len(sinew.Simulation(scene).body("block").rest_positions) == 3 * 5 * 6


def test_kinds_of_values() -> None:
    values = {"duration": np.float32(0.5), "integration.step": None, "fuse": False, "title": '"another"'}
    scene = sinew.Scene.from_text(BLOCK, values)
    assert (scene.duration, scene.title) == (0.5, "another")
    with pytest.raises(TypeError, match="of type object"):
        sinew.Scene.from_text(BLOCK, {"duration": object()})


def test_all_mistakes_are_told_with_their_places() -> None:
    wrong = BLOCK.replace("density: 1000", "density: -1").replace("poisson: 0.45", "poisson: 0.7")
    with pytest.raises(sinew.SceneError) as caught:
        sinew.Scene.from_text(wrong, name="wrong.ron")
    error = caught.value
    assert isinstance(error, ValueError) and isinstance(error, sinew.Error)
    assert len(error.diagnostics) == 2
    places = [(found["file"], found["line"], found["severity"]) for found in error.diagnostics]
    assert places == [("wrong.ron", 5, "error")] * 2
    line = wrong.splitlines()[4]
    assert line[error.diagnostics[0]["column"] - 1 :].startswith("-1")
    # the engine's own picture: the line with a mark below what is wrong
    assert line.strip() in str(error) and "^^" in str(error)


def test_a_wrong_word_is_told_with_what_is_allowed() -> None:
    with pytest.raises(sinew.SceneError) as caught:
        sinew.Scene.from_text(BLOCK.replace("elements: Hex8", "elements: Hex9"))
    assert "Hex8" in str(caught.value)


def test_files_that_are_not_there() -> None:
    with pytest.raises(sinew.SceneError, match="cannot read the scene nowhere.ron"):
        sinew.Scene("nowhere.ron")


def test_meshes_come_from_memory() -> None:
    mesh = (ROOT / "scenes/meshes/lens_814.msh").read_bytes()
    text = (ROOT / "scenes/lens_tets.ron").read_text()
    name = text.split('path: "')[1].split('"')[0]
    scene = sinew.Scene.from_text(text, files={name: mesh})
    body = sinew.Simulation(scene, backend="cpu").body(scene.bodies[0])
    assert len(body.rest_positions) > 100
    with pytest.raises(sinew.SceneError, match=name):
        sinew.Scene.from_text(text, files={"another": mesh})


def test_scenes_travel_as_pickles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = [sinew.Scene.from_text(BLOCK, {"duration": 0.25}, name="block.ron")]
    files.append(sinew.Scene.from_text(BLOCK, {"duration": 0.25}, files={}))
    path = tmp_path / "block.ron"
    path.write_text(BLOCK)
    monkeypatch.chdir(tmp_path)
    files.append(sinew.Scene("block.ron", {"duration": 0.25}))
    pickles = [pickle.dumps(scene) for scene in files]
    monkeypatch.chdir("/")
    for scene, data in zip(files, pickles, strict=True):
        again: sinew.Scene = pickle.loads(data)
        assert (again.text, again.duration) == (scene.text, 0.25)


def test_a_place_that_is_set_twice_travels_in_its_order() -> None:
    scene = sinew.Scene.from_text(BLOCK, {"bodies.block.mesh": "Box(size: (0.1, 0.1, 0.2), cells: (2, 2, 4))"})
    scene = scene.with_values({"bodies.block.mesh.cells": (5, 5, 5)})
    scene = scene.with_values({"bodies.block.mesh": "Box(size: (0.2, 0.1, 0.1), cells: (4, 2, 2))"})
    again: sinew.Scene = pickle.loads(pickle.dumps(scene))
    assert "cells: (4, 2, 2)" in again.text and again.text == scene.text


def test_warnings_are_told() -> None:
    shock = BLOCK.replace("loads:", 'constraints: [],\n loads:').replace(
        'constraints: [Fixed(on: Set("z0"))],\n',
        "",
    ).replace(
        "constraints: []",
        'constraints: [Fixed(on: Set("z0")), Prescribed(on: Set("z1"), displacement: (0, 0, 0.01), '
        'curve: Input(name: "pull"))]',
    )
    scene = sinew.Scene.from_text(shock)
    assert [found["severity"] for found in scene.warnings] == ["warning"]
    assert "rate" in str(scene.warnings)
