"""What goes wrong: a text for people, and what is known of it for programs."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """Something that sinew says. `details` is what is known of it, by name; each is an attribute, too."""

    def __init__(self, message: str, details: dict[str, Any] | None = None) -> None:
        super().__init__(message, details or {})

    @property
    def details(self) -> dict[str, Any]:
        """What is known of it, by name."""
        known: dict[str, Any] = self.args[1]
        return known

    def __str__(self) -> str:
        return str(self.args[0])

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("__") and name in self.details:
            return self.details[name]
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")


class SceneError(Error, ValueError):
    """A scene that is wrong. The text shows each mistake in the lines of the scene; `diagnostics` lists them.

    Each of `diagnostics` is a dict with `severity` (`error` or `warning`), `message`, `file`, `line` and `column`
    (counted from 1; None where there is none), `label` (a word on the place) and `notes` (what is allowed, what to do).
    """

    diagnostics: list[dict[str, Any]]


class Unstable(Error, RuntimeError):
    """What was simulated is no longer physical; the simulation keeps the state in which that was noticed.

    `time` (s) and `step` of when it was noticed, `body`, `what` went wrong, its likely `cause`, `good_until` (s), the
    `criterion` that ended it with its `value` and `limit`, and the author's number of the `node` or `element`, or None.
    """

    time: float
    step: int
    body: str
    what: str
    cause: str
    good_until: float
    criterion: str
    value: float | None
    limit: float | None
    node: int | None
    element: int | None


class NotConverged(Error, RuntimeError):
    """No equilibrium was found.

    `steps` taken, the `residual` and the `tolerance` as shares of loads and reactions, and where the largest `force`
    (N) is that nothing balances: `body` and `node`.
    """

    steps: int
    residual: float
    tolerance: float
    body: str
    node: int
    force: float


class GpuError(Error, RuntimeError):
    """There is no GPU, or it failed; the CPU takes every scene (`backend="cpu"`)."""


class SnapshotError(Error, ValueError):
    """A state that cannot be taken, read, or gone on from; nothing has changed."""


class Bug(Error, RuntimeError):
    """A mistake of sinew's own. The simulation cannot be used any more; please report it with the scene."""
