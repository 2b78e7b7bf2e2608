"""What pickles are made again with, in another process."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from ._sinew import Scene, Snapshot


def scene(
    name: str | None,
    text: str | None,
    path: str | os.PathLike[str] | None,
    files: Mapping[str, bytes] | None,
    sets: Sequence[str],
    allow_outside: bool,
) -> Scene:
    """A scene of a file, or of a text with its folder or its files; `sets` are texts `place=value`."""
    values = dict(one.split("=", 1) for one in sets)
    if text is None or name is None:
        return Scene(path or "", values, allow_outside=allow_outside)
    if files is not None:
        return Scene.from_text(text, values, name=name, files=files)
    return Scene.from_text(text, values, name=name, folder=path, allow_outside=allow_outside)


def snapshot(data: bytes) -> Snapshot:
    """A state of the bytes of its file."""
    return Snapshot.from_bytes(data)
