"""Environments for reinforcement learning, as Gymnasium has them: `pip install sinew-tissue[gym]`."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
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


class TissueVectorEnv(VectorEnv[Array, Array, NDArray[Any]]):
    """Several environments side by side: simulations of their own that step on threads, each on one at a time.

    scenes: one scene for all of them, or one for each.
    count: how many there are of one scene.
    workers: threads that step them; as many as the machine has processors when left out, and no more than environments.
    words: those of TissueEnv. What they call (`reward`, `done`) is called on these threads.

    What `reset` and `step` return has the bits of each environment by itself, whatever `workers` is. An environment
    whose episode has ended begins anew with the next `step`, whose action for it is not used
    (`AutoresetMode.NEXT_STEP`).
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self, scenes: Scene | Sequence[Scene], count: int | None = None, *, workers: int | None = None, **words: Any
    ) -> None:
        if isinstance(scenes, Scene) == (count is None):
            raise ValueError("one scene and a count, or a scene for each environment")
        each = [scenes] * (count or 0) if isinstance(scenes, Scene) else list(scenes)
        if not each:
            raise ValueError("there is no environment")
        self.envs = [TissueEnv(scene, **words) for scene in each]
        self.num_envs = len(self.envs)
        self.single_action_space = self.envs[0].action_space
        self.single_observation_space = self.envs[0].observation_space
        for env in self.envs:
            if env.observation_space != self.single_observation_space:
                raise ValueError("observations of all environments must have the same shape")
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self._pool = ThreadPoolExecutor(workers or min(self.num_envs, os.cpu_count() or 1))
        self._ended = np.zeros(self.num_envs, np.bool_)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Goes back to the start of all scenes. A number n for a seed is n, n + 1, ... of the environments."""
        seeds = [seed] * self.num_envs if seed is None else seed
        if isinstance(seeds, int):
            seeds = [seeds + number for number in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise ValueError(f"there are {len(seeds)} seeds for {self.num_envs} environments")
        self._ended[:] = False
        found = list(self._pool.map(lambda env, seed: env.reset(seed=seed, options=options), self.envs, seeds))
        return np.stack([seen for seen, _ in found]), self._together([info for _, info in found])

    def step(
        self, actions: Array
    ) -> tuple[Array, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Sets the inputs of all, an action a row, and simulates a frame of each."""

        def one(env: TissueEnv, ended: bool, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
            if ended:
                seen, info = env.reset()
                return seen, 0.0, False, False, info
            return env.step(action)

        if len(actions) != self.num_envs:
            raise ValueError(f"there are {len(actions)} actions for {self.num_envs} environments")
        found = list(self._pool.map(one, self.envs, self._ended, actions))
        seen, rewards, terminated, truncated, infos = zip(*found, strict=True)
        ends = np.array(terminated, np.bool_), np.array(truncated, np.bool_)
        self._ended = ends[0] | ends[1]
        return np.stack(seen), np.array(rewards, np.float64), *ends, self._together(infos)

    def close_extras(self, **_: Any) -> None:
        """Ends the threads."""
        self._pool.shutdown()

    def _together(self, each: Sequence[dict[str, Any]]) -> dict[str, Any]:
        infos: dict[str, Any] = {}
        for number, info in enumerate(each):
            infos = self._add_info(infos, info, number)
        return infos
