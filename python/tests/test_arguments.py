"""Every argument of an environment: single against batch, through JSON and pickle, and by both of its names."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from conftest import assert_same
from gymnasium.envs.registration import EnvSpec
from test_native_equals_sync import settle

import hasard_rs
from hasard_rs import _core
from hasard_rs import arguments as known

ENV = "hasard/CollateralDamageLevel1-v0"
SMALL = {"resolution": "64x48", "max_episode_steps": 4}
# Each with a value that is not its default; "MAP" stands for a file that is made for the test.
VALUES: dict[str, Any] = {
    "rules": "released",
    "early_creatures": True,
    "hard_constraint": True,
    "hard": True,
    "full_actions": True,
    "frame_skip": np.int64(9),
    "resolution": [72, 48],
    "size": np.array([72, 48]),
    "observation": "rgb+depth",
    "layout": "chw",
    "frame_stack": 2,
    "max_episode_steps": 3,
    "safety_budget": 2.5,
    # No complete game file may lie in a repository.
    "iwad": None,
    "maps": "MAP",
    "map": "MAP",
    "published_depth": True,
    "published_colours": True,
    "action_format": "box",
    "delta_bins": 5,
    "render_mode": "depth_array",
    "render_resolution": [64, 48],
    "seed": 11,
    "infos": "full",
    "env_stats": True,
}
BATCH: dict[str, Any] = {"num_threads": 1, "autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP, "batch_size": 1, "copy": False}
FACTS = (
    "observation_space",
    "action_space",
    "render_mode",
    "safety_budget",
    "cost_terms",
    "max_episode_steps",
    "extent",
    "scenario_name",
    "level",
    "hard_constraint",
    "frame_skip",
)


@pytest.fixture(scope="module")
def level(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The level as a file of maps, with fewer lights."""
    path = tmp_path_factory.mktemp("maps") / "level.wad"
    assert _core.main(["hasard", "export-wad", ENV.removeprefix("hasard/"), "-o", str(path)]) == 0
    return path


def id_for(name: str) -> str:
    """An environment that takes the argument: one alone has other creatures."""
    return "hasard/DetonatorsDilemmaLevel1-v0" if name == "early_creatures" else ENV


def given(name: str, level: Path, **more: Any) -> dict[str, Any]:
    value = {**VALUES, **BATCH}[name]
    if name == "early_creatures":
        more["rules"] = "tables"
    elif name == "published_colours":
        more["observation"] = "segmented"
    elif name == "published_depth":
        more["observation"] = "rgb+depth"
    elif name == "delta_bins":
        more["full_actions"] = True
    elif name == "render_resolution":
        more["render_mode"] = "rgb_array"
    return known.over({**SMALL, **more}, {name: level if isinstance(value, str) and value == "MAP" else value})


def test_every_argument_is_here() -> None:
    own = {name for name in vars(known.Arguments("")) if name not in ("env_id", "world")}
    assert set(VALUES) == {*known._WORLD, *own} and {*BATCH, "num_envs"} == set(known._VECTOR)


@pytest.mark.parametrize("name", VALUES)
def test_one_world_is_a_lane_of_a_batch(name: str, level: Path) -> None:
    arguments = given(name, level)
    native = gymnasium.make_vec(id_for(name), num_envs=2, **arguments)
    sync = gymnasium.make_vec(id_for(name), num_envs=2, vectorization_mode="sync", **arguments)
    single = sync.envs[0].unwrapped
    for fact in FACTS:
        theirs = f"single_{fact}" if fact.endswith("_space") else fact
        assert getattr(native, theirs) == getattr(single, fact), fact
        assert fact.endswith("_space") or native.get_attr(fact) == sync.get_attr(fact)
    if name == "seed":
        # Lane i of a batch is seeded with the seed and i, as by `reset`.
        found, second = native.reset(), hasard_rs.make(id_for(name), **{**arguments, "seed": 12}).reset()
        assert_same(found[0], np.stack([single.reset()[0], second[0]]))
        return
    assert_same(native.reset(seed=6), sync.reset(seed=6), "reset")
    native.action_space.seed(1)
    ends = 0
    for step in range(10):
        actions = native.action_space.sample()
        found, expected = native.step(actions), sync.step(actions)
        settle(found[4], expected[4])
        assert_same(found, expected, f"step {step}")
        ends += int("episode_summary" in found[4])
    assert ends >= 2
    if native.render_mode is not None:
        assert_same(native.render(), sync.render(), "pictures")


def same(one: Any, other: Any) -> None:
    """Steps two environments, or batches, alike."""
    assert one.observation_space == other.observation_space and one.action_space == other.action_space
    assert one.get_wrapper_attr("safety_budget") == other.get_wrapper_attr("safety_budget") if isinstance(one, gymnasium.Env) else True
    assert_same(one.reset(), other.reset()) if one.unwrapped._given.seed else assert_same(one.reset(seed=4), other.reset(seed=4))
    one.action_space.seed(2)
    for step in range(6):
        action = one.action_space.sample()
        found, expected = copy.deepcopy(one.step(action)), other.step(action)
        assert_same(found, expected, f"step {step}")
        if isinstance(one, gymnasium.Env) and (found[2] or found[3]):
            assert_same(one.reset(), other.reset())
    if one.render_mode is not None:
        assert_same(one.render(), other.render())


@pytest.mark.parametrize("name", VALUES)
def test_a_world_comes_back_from_json_and_pickle(name: str, level: Path) -> None:
    env = hasard_rs.make(id_for(name), **given(name, level))
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert type(env.unwrapped) is type(again.unwrapped)
    assert env.spec.max_episode_steps == again.spec.max_episode_steps == env.get_wrapper_attr("max_episode_steps")
    same(env, again)
    env.action_space.seed(5)
    copies = [pickle.loads(pickle.dumps(env)), copy.deepcopy(env)]
    action = env.action_space.sample()
    env.reset(), [other.reset() for other in copies]
    result = env.step(action)
    for other in copies:
        assert_same(other.step(action), result)


@pytest.mark.parametrize("name", {**VALUES, **BATCH})
def test_a_batch_comes_back_from_json_and_pickle(name: str, level: Path) -> None:
    envs = hasard_rs.make_vec(id_for(name), 2, **given(name, level))
    again = gymnasium.make_vec(EnvSpec.from_json(envs.spec.to_json()))
    assert again.num_envs == 2 and again.autoreset_mode == envs.autoreset_mode and again.batch_size == envs.batch_size
    assert again.spec.max_episode_steps == envs.spec.max_episode_steps == envs.max_episode_steps
    same(envs, again)
    for other in (pickle.loads(pickle.dumps(envs)), copy.deepcopy(envs)):
        action = envs.action_space.sample()
        before = pickle.dumps(envs)
        result = copy.deepcopy(envs.step(action))
        assert_same(other.step(action), result)
        envs = pickle.loads(before)


def test_subclasses_and_what_was_set_come_back_too() -> None:
    from hasard_rs.envs.remedy_rush.env import RemedyRush
    from hasard_rs.published import DoomEnv

    for env in (RemedyRush(2, resolution="64x48"), DoomEnv(scenario="RemedyRush", level=2, resolution="64x48")):
        env.reset(seed=1)
        env.mine = [3]
        other = pickle.loads(pickle.dumps(env))
        assert type(other) is type(env) and other.mine == [3] and other.level == 2
        action = env.action_space.sample()
        assert_same(other.step(action), env.step(action))
    assert other.get_statistics() == env.get_statistics() and other.game_res == "64x48"


@pytest.mark.parametrize(
    "pair",
    [
        {"hard": True, "hard_constraint": False},
        {"hard_constraint": True, "hard": False},
        {"size": "64x48", "resolution": "72x48"},
        {"resolution": [64, 48], "size": (72, 48)},
        {"map": "a.wad", "maps": "b.wad"},
    ],
)
def test_names_that_contradict_each_other_are_refused(pair: dict[str, Any]) -> None:
    makes = [
        lambda: hasard_rs.make(ENV, **pair),
        lambda: hasard_rs.make_vec(ENV, 2, **pair),
        lambda: hasard_rs.Worlds(ENV, 2, **pair),
        lambda: hasard_rs.train(ENV, out="nowhere", **pair),
    ]
    for make in makes:
        with pytest.raises(hasard_rs.InvalidOption, match="contradict each other") as raised:
            make()
        assert all(f"{name}=" in str(raised.value) for name in pair)


def test_names_that_agree_are_taken() -> None:
    env = hasard_rs.make(ENV, size="64X48", resolution=[64, 48], hard=True, hard_constraint=True, maps=None, map=None)
    assert env.observation_space.shape == (48, 64, 3) and env.unwrapped.hard_constraint
    from hasard_rs import published

    env = published.make("VolcanicVentureLevel1-v0", size="64x48")
    assert env.observation_space.shape == (48, 64, 3)


@pytest.mark.parametrize("wrong", [[64], [64, 48, 3], [64.0, 48.0], ["64", "48"], [[64], [48]], {"width": 64, "height": 48}, [10, 10], [1 << 40, 48]])
def test_pairs_that_are_none_are_refused(wrong: Any) -> None:
    for name in ("resolution", "size", "render_resolution"):
        with pytest.raises(hasard_rs.InvalidOption, match=f"{name} cannot be .* it must be"):
            hasard_rs.make(ENV, **{name: wrong})


@pytest.mark.parametrize("steps", [0, -2, "10", 2.5])
def test_limits_that_are_none_are_refused(steps: Any) -> None:
    for make in (hasard_rs.make, hasard_rs.make_vec):
        with pytest.raises(hasard_rs.InvalidOption, match="max_episode_steps cannot be"):
            make(ENV, max_episode_steps=steps)


def test_the_limit_is_the_least_of_those_asked_for() -> None:
    for asked, limit in ((None, 521), (7, 7), (100_000, 521), (-1, 521)):
        env = gymnasium.make(ENV, max_episode_steps=asked, resolution="64x48")
        assert env.unwrapped.max_episode_steps == env.unwrapped.spec.max_episode_steps == limit
        assert env.spec.max_episode_steps == (asked if asked == 100_000 else limit)
    env = gymnasium.make(gymnasium.make(ENV, max_episode_steps=7).spec, max_episode_steps=5)
    assert env.spec.max_episode_steps == env.unwrapped.max_episode_steps == 5
    assert gymnasium.make(ENV, frame_skip=8).spec.max_episode_steps == gymnasium.make_vec(ENV, frame_skip=8).max_episode_steps
    wrapped = gymnasium.wrappers.TimeAwareObservation(hasard_rs.make(ENV, resolution="64x48"))
    assert wrapped.reset(seed=1)[0].shape == wrapped.observation_space.shape


def test_a_seed_is_a_number_or_one_a_lane() -> None:
    worlds, single = hasard_rs.Worlds(ENV, 2, resolution="64x48"), hasard_rs.make(ENV, resolution="64x48", infos="full")
    worlds.reset(7)
    wanted = worlds.episode_seeds.tolist()
    for seed in (np.array(7), np.int64(7), np.uint8(7)):
        for envs in (hasard_rs.make_vec(ENV, 2, resolution="64x48"), hasard_rs.Worlds(ENV, 2, resolution="64x48")):
            envs.reset(seed) if isinstance(envs, hasard_rs.Worlds) else envs.reset(seed=seed)
            seeds = envs.episode_seeds if isinstance(envs, hasard_rs.Worlds) else envs.worlds.episode_seeds
            assert seeds.tolist() == wanted
        assert int(single.reset(seed=seed)[1]["episode_seed"]) == wanted[0]
    with pytest.raises(TypeError, match="a seed must be an integer, or a sequence"):
        hasard_rs.make_vec(ENV, 2).reset(seed=3.5)


def test_a_single_world_says_nothing_of_lanes() -> None:
    env = hasard_rs.Env(scenario="CollateralDamage", level=1, max_episode_steps=1, resolution="64x48", action_format="multi_discrete")
    env.reset(seed=1)
    with pytest.raises(hasard_rs.InvalidAction) as raised:
        env.step([9, 0])
    assert str(raised.value) == "action: part 0 is 9; it must be 0..=2"
    env.step([0, 0])
    with pytest.raises(hasard_rs.ResetNeeded) as raised:
        env.step([0, 0])
    assert str(raised.value) == "the episode is over; call reset before the next step"
    for action_format, wrong in (("discrete", 99), ("box", [np.nan, 0.0]), ("tuple", (5, 0)), ("dict", {"buttons": [5, 0]})):
        env = hasard_rs.Env(scenario="CollateralDamage", level=1, resolution="64x48", action_format=action_format)
        env.reset(seed=1)
        with pytest.raises(hasard_rs.InvalidAction) as raised:
            env.step(wrong)
        assert str(raised.value).startswith("action: part 0 is "), action_format
    env = hasard_rs.Env(scenario="CollateralDamage", level=1, resolution="64x48", action_format="dict", full_actions=True)
    env.reset(seed=1)
    with pytest.raises(hasard_rs.InvalidAction) as raised:
        env.step({"buttons": np.zeros(len(env._worlds.nvec), int), "deltas": [np.nan, 0.0]})
    assert "lane" not in str(raised.value)


def test_one_part_may_come_in_a_column() -> None:
    for action_format, actions in (("discrete", np.array([[3], [5]])), ("tuple", (np.array([[1], [2]]), np.array([[0], [1]])))):
        envs, others = (hasard_rs.make_vec(ENV, 2, resolution="64x48", action_format=action_format) for _ in range(2))
        envs.reset(seed=1), others.reset(seed=1)
        flat = actions[:, 0] if action_format == "discrete" else tuple(part[:, 0] for part in actions)
        assert_same(envs.step(actions), others.step(flat))
        with pytest.raises(ValueError, match="shape"):
            envs.step(np.zeros((2, 2), int) if action_format == "discrete" else (np.zeros((2, 2), int),) * 2)


def test_the_hard_constraint_has_a_budget_of_0() -> None:
    for given, budget in (({}, 5.0), ({"hard_constraint": True}, 0.0), ({"hard_constraint": True, "safety_budget": 3}, 3.0)):
        env = hasard_rs.make("RemedyRushLevel1-v0", **given)
        assert env.get_wrapper_attr("safety_budget") == budget
        env.close()
