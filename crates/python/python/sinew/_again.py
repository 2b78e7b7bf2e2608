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
    """A scene of a file, or of a text with its folder or its files; `sets` are texts `place=value`, put in one after
    the other."""
    return Scene._made_of(name, text, path, files, sets, allow_outside)


def snapshot(data: bytes) -> Snapshot:
    """A state of the bytes of its file."""
    return Snapshot.from_bytes(data)
