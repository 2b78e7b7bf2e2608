"""Runs as USD files, for Blender, Houdini, Omniverse, Unreal: the surface of each body, moving."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from ._sinew import Simulation


def write(
    simulation: Simulation,
    path: str | os.PathLike[str],
    times: Sequence[float],
    *,
    up: str = "Z",
    frames_per_second: float = 24.0,
) -> None:
    """Goes on to each of the times (s) in their order and writes where the surfaces are then: those of the meshes, also
    of bodies that have a skin. What lies before the present time is that, and a state is written once, also where
    several times lie within one step.

    `.usda` is text, and needs nothing else; `.usdc` and `.usd` are packed by `pip install usd-core`. Lengths are in
    metres, `up` is the axis that points up: "Y" or "Z". Where elements are removed, the surface changes.
    """
    if up not in ("Y", "Z"):
        raise ValueError(f"the axis {up!r} cannot point up in USD; allowed: 'Y', 'Z'")
    ending = Path(path).suffix
    if ending not in (".usda", ".usdc", ".usd"):
        raise ValueError(f"{os.fspath(path)}: a file name that ends in .usda, .usdc or .usd is wanted")
    samples: dict[str, list[tuple[float, NDArray[Any], NDArray[Any]]]] = {name: [] for name in simulation.bodies}
    written: float | None = None
    for time in times:
        simulation.advance_to(time)
        if simulation.time == written:
            continue
        written = simulation.time
        for name, body in simulation.bodies.items():
            samples[name].append((simulation.time * frames_per_second, body.positions(), body.triangles))
    text = _text(samples, up, frames_per_second)
    if ending == ".usda":
        Path(path).write_text(text, encoding="utf-8")
    else:
        _pack(text, path)


def _pack(text: str, path: str | os.PathLike[str]) -> None:
    try:
        from pxr import Usd
    except ImportError as missing:
        raise ImportError("packed USD files need `pip install usd-core`; .usda needs nothing") from missing
    with tempfile.TemporaryDirectory() as folder:
        plain = Path(folder) / "scene.usda"
        plain.write_text(text, encoding="utf-8")
        Usd.Stage.Open(str(plain)).Export(os.fspath(path))


def _text(samples: dict[str, list[tuple[float, NDArray[Any], NDArray[Any]]]], up: str, rate: float) -> str:
    codes = [code for frames in samples.values() for code, _, _ in frames] or [0.0]
    names = _names(list(samples))
    meshes = "\n".join(_mesh(names[body], body, frames) for body, frames in samples.items())
    return f"""#usda 1.0
(
    defaultPrim = "sinew"
    metersPerUnit = 1
    upAxis = "{up}"
    timeCodesPerSecond = {rate!r}
    startTimeCode = {min(codes)!r}
    endTimeCode = {max(codes)!r}
)

def Xform "sinew"
{{
{meshes}
}}
"""


def _names(bodies: list[str]) -> dict[str, str]:
    """Names that USD takes: letters, digits and underscores, none twice."""
    names: dict[str, str] = {}
    for body in bodies:
        name = re.sub(r"\W", "_", body, flags=re.ASCII)
        name = name if name and not name[0].isdigit() else f"_{name}"
        while name in names.values():
            name += "_"
        names[body] = name
    return names


def _mesh(name: str, body: str, frames: list[tuple[float, NDArray[Any], NDArray[Any]]]) -> str:
    points, counts, indices, extents = [], [], [], []
    before: NDArray[Any] | None = None
    for code, places, triangles in frames:
        points.append(f"{code!r}: {_vectors(places)}")
        extents.append(f"{code!r}: {_vectors([places.min(axis=0), places.max(axis=0)])}")
        if before is None or before.shape != triangles.shape or (before != triangles).any():
            counts.append(f"{code!r}: {[3] * len(triangles)}")
            indices.append(f"{code!r}: {triangles.ravel().tolist()}")
            before = triangles
    return f"""    def Mesh "{name}" (
        displayName = "{body.replace(chr(92), chr(92) * 2).replace(chr(34), chr(92) + chr(34))}"
    )
    {{
        uniform token subdivisionScheme = "none"
        float3[] extent.timeSamples = {{ {", ".join(extents)} }}
        point3f[] points.timeSamples = {{ {", ".join(points)} }}
        int[] faceVertexCounts.timeSamples = {{ {", ".join(counts)} }}
        int[] faceVertexIndices.timeSamples = {{ {", ".join(indices)} }}
    }}"""


def _vectors(rows: Any) -> str:
    return "[" + ", ".join(f"({x:.9g}, {y:.9g}, {z:.9g})" for x, y, z in rows) + "]"
