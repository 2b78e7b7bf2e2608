"""Pictures and files for other programs."""

from __future__ import annotations

import struct
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sinew
import sinew.rerun
import sinew.usd

from conftest import BLOCK


def size(png: bytes) -> tuple[int, int]:
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", png[16:24])
    return width, height


def test_a_picture_shows_the_present_state(simulation: sinew.Simulation, tmp_path: Path) -> None:
    rest = simulation.picture(size=(320, 240), from_=(1, -2, 0.6))
    assert size(rest.png) == (320, 240)
    simulation.inputs["grip"] = 1
    simulation.step(100)
    moved = simulation.picture(size=(320, 240), from_=(1, -2, 0.6))
    assert moved.png != rest.png
    assert simulation.picture("displacement.z", size=(320, 240)).png not in (moved.png, rest.png)
    moved.save(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes() == moved._repr_png_()
    # what a notebook shows of the simulation itself
    assert size(simulation._repr_png_()) == (960, 720)
    with pytest.raises(sinew.SceneError, match="picture"):
        simulation.picture(zoom=-1)
    with pytest.raises(ValueError, match="nothing"):
        simulation.picture("nothing")


# a face in the middle of the block, which is far from filling it
SKIN = b"v 0.04 0.04 0.05\nv 0.06 0.04 0.05\nv 0.05 0.06 0.05\nf 1 2 3\n"


def test_of_a_body_with_a_skin_that_is_drawn() -> None:
    with_skin = BLOCK.replace('material: "tissue")', 'material: "tissue", skin: (file: "skin.obj"))')
    pictures = []
    for text, files in [(BLOCK, {}), (with_skin, {"skin.obj": SKIN})]:
        scene = sinew.Scene.from_text(text, files=files)
        simulation = sinew.Simulation(scene, backend="cpu", threads=1)
        pictures.append(simulation.picture(size=(320, 240), from_=(1, -2, 0.6)).png)
    assert pictures[0] != pictures[1]


def test_usd_has_a_state_once(simulation: sinew.Simulation, tmp_path: Path) -> None:
    path = tmp_path / "block.usda"
    simulation.step(2)
    now = simulation.time
    sinew.usd.write(simulation, path, [0.0, 0.5 * now, now + 0.02, now + 0.02])
    points = path.read_text().split("points.timeSamples = {")[1].split("}")[0]
    assert points.count(": [") == 2


def test_usd_text_holds_the_moving_surface(simulation: sinew.Simulation, tmp_path: Path) -> None:
    path = tmp_path / "block.usda"
    simulation.inputs["grip"] = 1
    sinew.usd.write(simulation, path, [0.0, 0.02, 0.04], frames_per_second=100)
    text = path.read_text()
    assert text.startswith("#usda 1.0") and 'def Mesh "block"' in text and 'upAxis = "Z"' in text
    points = text.split("points.timeSamples = {")[1].split("}")[0]
    frames = [np.array(eval(f"[{part.split(']')[0]}]")) for part in points.split(": [")[1:]]  # noqa: S307
    assert [frame.shape for frame in frames] == [(64, 3)] * 3
    assert frames[0] == pytest.approx(simulation.body("block").rest_positions, abs=1e-7)
    assert frames[2] == pytest.approx(simulation.body("block").positions(), abs=1e-7)
    # the surface stays the same, and is there once
    assert text.split("faceVertexIndices.timeSamples = {")[1].split("}")[0].count(":") == 1
    with pytest.raises(ValueError, match="ends in .usda"):
        sinew.usd.write(simulation, "block.obj", [])
    with pytest.raises(ValueError, match="'Y', 'Z'"):
        sinew.usd.write(simulation, path, [], up="X")


def test_usd_is_read_by_usd(simulation: sinew.Simulation, tmp_path: Path) -> None:
    usd = pytest.importorskip("pxr.Usd")
    path = tmp_path / "block.usdc"
    sinew.usd.write(simulation, path, [0.0, 0.02])
    stage = usd.Stage.Open(str(path))
    points = stage.GetPrimAtPath("/sinew/block").GetAttribute("points")
    assert len(points.GetTimeSamples()) == 2 and len(points.Get(0.0)) == 64


def test_bodies_get_names_that_usd_takes() -> None:
    names = sinew.usd._names(["left lobe", "left.lobe", "2nd", "é"])
    assert list(names.values()) == ["left_lobe", "left_lobe_", "_2nd", "_"]


def test_rerun_is_told_the_state(simulation: sinew.Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[Any, ...]] = []
    stand_in = types.ModuleType("rerun")
    for name in ("set_time", "log"):
        setattr(stand_in, name, lambda *words, _name=name, **more: told.append((_name, words, more)))
    for name in ("Mesh3D", "Scalars"):
        setattr(stand_in, name, lambda *words, _name=name, **more: (_name, words, more))
    monkeypatch.setitem(sys.modules, "rerun", stand_in)
    simulation.step(3)
    sinew.rerun.log(simulation, "run")
    assert told[0] == ("set_time", ("time",), {"duration": simulation.time, "recording": None})
    assert [call[1][0] for call in told[1:]] == ["run/block", "run/probes/ground", "run/probes/top"]
    mesh = told[1][1][1]
    assert mesh[0] == "Mesh3D" and (mesh[2]["vertex_positions"] == simulation.body("block").positions()).all()


def test_rerun_keeps_what_it_is_told(simulation: sinew.Simulation, tmp_path: Path) -> None:
    rerun = pytest.importorskip("rerun")
    rerun.init("sinew", spawn=False)
    rerun.save(tmp_path / "run.rrd")
    sinew.rerun.log(simulation)
    rerun.disconnect()
    assert (tmp_path / "run.rrd").stat().st_size > 1000
