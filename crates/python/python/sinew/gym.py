"""Environments for reinforcement learning, as Gymnasium has them: `pip install sinew-tissue[gym]`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ._errors import Unstable
from ._sinew import Scene, Simulation

Array = NDArray[np.float32]


class TissueEnv(gymnasium.Env[Array, Array]):
    """A scene whose inputs an agent sets, once a frame.

    scene: with inputs (`curve: Input(name: "grip", rate: 5)`); a `rate` keeps actions from being shocks.
    actions: the inputs that an action sets, each with its bounds; names alone are bounded by -1 and 1.
    observe: what an observation holds, one after the other: a probe's name, or `BODY.displacements` or `BODY.positions`
        for all its nodes in the author's order (m).
    reward: of a simulation at the end of a frame.
    done: whether an episode has come to its end, of a simulation at the end of a frame.
    frame: simulated time between actions (s).
    duration: an episode is cut off (`truncated`) after so much simulated time (s); the scene's when left out.
    broken: the reward of a frame in which the simulation breaks down; it ends the episode, `info["unstable"]` says why.
    options: those of Simulation; `threads` is 1 unless they say otherwise: many environments share a machine best so.

    `reset` goes back to the scene's start: the same actions give the same bits.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        scene: Scene,
        *,
        actions: Sequence[str] | Mapping[str, tuple[float, float]],
        observe: Sequence[str],
        reward: Callable[[Simulation], float],
        done: Callable[[Simulation], bool] | None = None,
        frame: float = 1 / 60,
        duration: float | None = None,
        broken: float = 0.0,
        **options: Any,
    ) -> None:
        bounds = actions if isinstance(actions, Mapping) else dict.fromkeys(actions, (-1.0, 1.0))
        self.simulation = Simulation(scene, **{"threads": 1, **options})
        self._inputs = list(bounds)
        for name in self._inputs:
            self.simulation.inputs[name]  # a name that is not there is told now
        self._observe, self._reward, self._done = list(observe), reward, done
        self._frame, self._broken = frame, broken
        self._duration = scene.duration if duration is None else duration
        self._frames = 0
        low, high = (np.array([bound[side] for bound in bounds.values()], np.float32) for side in (0, 1))
        self.action_space = spaces.Box(low, high, dtype=np.float32)
        self._last = self._observation()
        self.observation_space = spaces.Box(-np.inf, np.inf, self._last.shape, np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        """Goes back to the scene's start. A scene has no chance in it; `seed` is for what a program draws."""
        super().reset(seed=seed, options=options)
        self.simulation.reset()
        self._frames = 0
        self._last = self._observation()
        return self._last, self._info()

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Sets the inputs, and simulates a frame."""
        for name, value in zip(self._inputs, action, strict=True):
            self.simulation.inputs[name] = float(value)
        self._frames += 1
        try:
            # frames end with the first step that reaches them: what that is too far is not added up
            self.simulation.advance_to(self._frames * self._frame)
            self._last = self._observation()
        except Unstable as problem:
            return self._last, self._broken, True, False, {**self._info(), "unstable": str(problem)}
        ended = self._done is not None and bool(self._done(self.simulation))
        late = self._frames * self._frame >= self._duration * (1 - 1e-9)
        return self._last, float(self._reward(self.simulation)), ended, late and not ended, self._info()

    def _info(self) -> dict[str, Any]:
        return {"time": self.simulation.time, "steps": self.simulation.step_count}

    def _observation(self) -> Array:
        parts = [np.ravel(self._part(name)) for name in self._observe]
        return np.concatenate(parts, dtype=np.float32) if parts else np.zeros(0, np.float32)

    def _part(self, name: str) -> NDArray[np.float64]:
        if name in self.simulation.scene.probes:
            return self.simulation.probe(name)
        body, _, what = name.rpartition(".")
        if body in self.simulation.scene.bodies and what in ("displacements", "positions"):
            of = self.simulation.body(body)
            return of.positions() if what == "positions" else of.displacements()
        there = [*self.simulation.scene.probes, *(f"{body}.positions" for body in self.simulation.scene.bodies)]
        raise ValueError(f"{name!r} cannot be observed; there is {', '.join(there)}, and `.displacements` of bodies")
