"""The environment for reinforcement learning, by Gymnasium's own checks."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
import sinew

gymnasium = pytest.importorskip("gymnasium")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from sinew.gym import TissueEnv, TissueVectorEnv  # noqa: E402

from conftest import BLOCK, PULL  # noqa: E402


def height(simulation: sinew.Simulation) -> float:
    return float(simulation.probe("top")[0])


def environment(**more: object) -> TissueEnv:
    words = {"actions": {"grip": (-2.0, 2.0)}, "observe": ["top", "block.displacements"], "reward": height, **more}
    return TissueEnv(sinew.Scene.from_text(BLOCK), backend="cpu", **words)  # type: ignore[arg-type]


def test_gymnasium_finds_nothing_wrong() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # places have no bounds; a spec is what environments have that were registered
        warnings.filterwarnings("ignore", "(?s).*(infinity|spec).*")
        check_env(environment(actions=["grip"]), skip_render_check=True)


def test_episodes_have_the_same_bits() -> None:
    env = environment()
    episodes = []
    for _ in range(2):
        seen, info = env.reset(seed=3)
        assert info == {"time": 0.0, "steps": 0} and not seen.any()
        course = []
        for action in np.random.default_rng(1).uniform(-1, 1, (6, 1)).astype(np.float32):
            seen, reward, terminated, truncated, info = env.step(action)
            course.append((seen.copy(), reward, terminated, truncated, info["steps"]))
        episodes.append(course)
    for one, other in zip(*episodes, strict=True):
        assert (one[0] == other[0]).all() and one[1:] == other[1:]
        assert one[0].shape == (3 + 3 * 64,) and one[0].any()
        assert one[1] == pytest.approx(one[0][0])
    # 0.1 s are 6 frames
    assert [step[3] for step in episodes[0]] == [False] * 5 + [True]


def test_a_breakdown_ends_the_episode() -> None:
    scene = BLOCK.replace(
        'constraints: [Fixed(on: Set("z0"))]',
        'constraints: [Fixed(on: Set("z0")), Prescribed(on: Set("z1"), displacement: (0, 0, -0.1), '
        'curve: Input(name: "grip", rate: 50))]',
    ).replace(PULL, "")
    env = TissueEnv(
        sinew.Scene.from_text(scene), actions={"grip": (0, 2)}, observe=["top"], reward=height, broken=-1, backend="cpu"
    )
    env.reset()
    for _ in range(6):
        _, reward, terminated, truncated, info = env.step(np.array([2], np.float32))
        if terminated:
            break
    assert terminated and not truncated and reward == -1 and "broke down" in info["unstable"]
    env.reset()
    assert not env.step(np.array([0], np.float32))[2]


def test_an_end_of_ones_own() -> None:
    env = environment(done=lambda simulation: simulation.time > 0.03)
    env.reset()
    assert [env.step(np.zeros(1, np.float32))[2] for _ in range(2)] == [False, True]


def test_names_that_are_not_there() -> None:
    with pytest.raises(KeyError, match="there is grip"):
        environment(actions=["pull"])
    with pytest.raises(ValueError, match="block.positions"):
        environment(observe=["tip"])


def same(one: object, other: object) -> bool:
    """Whether what two vectors of environments returned is the same to the last bit."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    return bool(np.array_equal(one, other))  # type: ignore[arg-type]


@pytest.mark.parametrize("workers", [1, 3])
def test_environments_side_by_side_are_those_of_gymnasium(workers: int) -> None:
    words: dict[str, Any] = {"actions": {"grip": (-2.0, 2.0)}, "observe": ["top"], "reward": height, "backend": "cpu"}
    soft = sinew.Scene.from_text(BLOCK)
    stiff = sinew.Scene.from_text(BLOCK, set={"materials.tissue.density": 2000.0})
    scenes = [soft, stiff, soft]
    ours = TissueVectorEnv(scenes, workers=workers, **words)
    theirs = gymnasium.vector.SyncVectorEnv([lambda scene=scene: TissueEnv(scene, **words) for scene in scenes])
    assert ours.action_space == theirs.action_space and ours.observation_space == theirs.observation_space
    assert ours.metadata["autoreset_mode"] == theirs.metadata["autoreset_mode"]
    assert all(map(same, ours.reset(seed=5), theirs.reset(seed=5)))
    draws = np.random.default_rng(2)
    ended = 0
    # 0.1 s are 6 frames: the seventh begins anew
    for _ in range(9):
        actions = draws.uniform(-2, 2, (3, 1)).astype(np.float32)
        found, wanted = ours.step(actions), theirs.step(actions)
        assert all(map(same, found, wanted))
        ended += int(found[3].sum())
    assert ended == 3 and (found[0][0] != found[0][1]).any()
    with pytest.raises(ValueError, match="2 actions for 3 environments"):
        ours.step(actions[:2])
    ours.close()


def test_a_vector_of_one_scene() -> None:
    words: dict[str, Any] = {"actions": ["grip"], "observe": ["block.displacements"], "reward": height, "backend": "cpu"}
    scene = sinew.Scene.from_text(BLOCK)
    env = TissueVectorEnv(scene, 2, **words)
    seen, _ = env.reset(seed=1)
    assert env.observation_space.contains(seen) and seen.shape == (2, 3 * 64)
    seen, rewards, *_ = env.step(np.array([[1], [-1]], np.float32))
    assert env.observation_space.contains(seen) and rewards[0] == pytest.approx(-rewards[1], rel=0.1) and rewards[0] > 0
    env.close()
    with pytest.raises(ValueError, match="one scene and a count"):
        TissueVectorEnv(scene, **words)
