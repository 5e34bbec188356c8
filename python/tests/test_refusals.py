"""What cannot be asked for is refused by name: another task than the id's, lanes and counts that are none, budgets that are no numbers."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from conftest import SMALL

import hasard_rs
from hasard_rs import published, safety
from hasard_rs.tianshou import HasardVectorEnv
from hasard_rs.wrappers import Saute

ENV = "hasard/RemedyRushLevel1-v0"


@pytest.mark.parametrize("wrong", [{"level": 3}, {"scenario": "VolcanicVenture"}, {"scenario_file": ["a.toml", ""]}, {"tasks": []}])
def test_the_task_is_the_ids(wrong: dict[str, Any]) -> None:
    makes = [
        lambda: hasard_rs.make(ENV, **wrong),
        lambda: hasard_rs.make_vec(ENV, 2, **wrong),
        lambda: hasard_rs.make_vec([ENV, "VolcanicVentureLevel1-v0"], 2, **wrong),
        lambda: published.make("RemedyRushLevel1-v0", **wrong),
        lambda: HasardVectorEnv(ENV, 2, **wrong),
        lambda: hasard_rs.Agent.load("zoo:RemedyRushLevel1").make(**wrong),
    ]
    for make in makes:
        with pytest.raises(TypeError, match=f"'{next(iter(wrong))}' is bound by the id"):
            make()


def test_the_task_is_the_ids_for_gymnasium_too() -> None:
    for wrong in ({"level": 3}, {"scenario": "VolcanicVenture"}):
        for make in (gymnasium.make, gymnasium.make_vec):
            with pytest.raises(TypeError, match="bound by the id; hasard/RemedyRushLevel1-v0 cannot be"):
                make(ENV, **wrong)
    # An id of one's own may have any.
    gymnasium.register("mine/Rush-v0", entry_point="hasard_rs.env:entry", kwargs={"scenario": "RemedyRush", "level": 2})
    assert gymnasium.make("mine/Rush-v0", level=3, **SMALL).unwrapped.level == 3


def test_values_that_are_none_are_refused_in_a_line() -> None:
    for arguments, why in (
        ({"num_envs": "2", "batch_size": 1}, "num_envs cannot be '2'"),
        ({"num_envs": None, "batch_size": 1}, "num_envs cannot be None"),
        ({"autoreset_mode": None}, "autoreset_mode cannot be None"),
        ({"maps": ""}, "maps cannot be ''"),
        ({"iwad": ""}, "iwad cannot be ''"),
    ):
        with pytest.raises(hasard_rs.InvalidOption, match=why):
            hasard_rs.make_vec(ENV, **arguments)
    env = hasard_rs.make(ENV, **SMALL)
    env.reset(seed=1)
    assert env.unwrapped.picture("rgb", np.array([80, 60])).shape == (60, 80, 3)
    for size in ("", 0, ()):
        with pytest.raises(hasard_rs.InvalidOption, match="WxH"):
            env.unwrapped.picture("rgb", size)
    for saute in ({"saute_gamma": "0.9"}, {"unsafe_reward": float("nan")}, {"budget": 10**400}):
        with pytest.raises(hasard_rs.InvalidOption, match=f"{next(iter(saute))} cannot be"):
            Saute(env, **saute)
    with pytest.raises(hasard_rs.InvalidOption, match="it must be a dict of settings"):
        hasard_rs.train(ENV, set=["learning.rate=1"])
    with pytest.raises(hasard_rs.UnknownEnvironment):
        published.register_environment("RemedyRush", 9)
    with pytest.raises(hasard_rs.UnknownEnvironment):
        published.make("RemedyRushLevel9-v0")
    lanes = HasardVectorEnv(ENV, 4)
    for seeds in ([1, 2], "x", [1, 2, 3, "4"]):
        with pytest.raises(ValueError, match="one for each of 4 lanes"):
            lanes.seed(seeds)
    lanes.reset()


def test_lanes_of_gymnasium_take_a_budget_and_ours_any_value() -> None:
    lanes = gymnasium.vector.SyncVectorEnv([lambda: hasard_rs.make(ENV, **SMALL)])
    lanes.set_attr("safety_budget", 3)
    assert lanes.get_attr("safety_budget") == (3,)
    native = hasard_rs.make_vec(ENV, 2, **SMALL)
    native.set_attr("mark", [np.zeros(3)] * 2)
    assert native.get_attr("mark")[1].tolist() == [0.0] * 3
    with pytest.raises(ValueError, match="must be equal"):
        native.set_attr("mark", [np.zeros(3), np.ones(3)])


def test_an_end_at_the_limit_is_an_end() -> None:
    """Gymnasium's TimeLimit would call it cut off too."""
    def played(limit: int | None) -> tuple[int, tuple[bool, bool]]:
        env = hasard_rs.make("VolcanicVentureLevel1-v0", hard_constraint=True, max_episode_steps=limit, **SMALL)
        env.reset(seed=11)
        env.action_space.seed(1)
        for step in range(1, 600):
            _, _, terminated, truncated, _ = env.step(env.action_space.sample())
            if terminated or truncated:
                return step, (terminated, truncated)
        raise AssertionError("it never ends")

    steps, end = played(None)
    assert end == (True, False) and played(steps) == (steps, end)
    assert played(steps - 1) == (steps - 1, (False, True))


def test_the_seed_that_was_given_first_fills_gaps() -> None:
    envs, others = hasard_rs.make_vec(ENV, 3, seed=5, **SMALL), hasard_rs.make_vec(ENV, 3, **SMALL)
    envs.reset(seed=[1, None, 3])
    others.reset(seed=[1, 6, 3])
    assert envs.worlds.episode_seeds.tolist() == others.worlds.episode_seeds.tolist()
    # Once the vector has begun, lanes without a seed go on with their streams.
    envs.reset(seed=[1, None, 3])
    others.reset(seed=[1, None, 3])
    assert envs.worlds.episode_seeds.tolist() == others.worlds.episode_seeds.tolist()


def test_seeds_go_to_the_lanes_that_tianshou_names() -> None:
    env, other = HasardVectorEnv(ENV, 3, **SMALL), hasard_rs.Worlds(ENV, 3, **SMALL)
    for lanes, seeds, wanted in (([2, 1, 0], [10, 11, 12], [12, 11, 10]), ([2, 0], [20, 21], [21, None, 20])):
        env.reset(lanes, seed=seeds)
        other.reset(wanted, np.array([seed is not None for seed in wanted]) if None in wanted else None)
        assert env.worlds.episode_seeds.tolist() == other.episode_seeds.tolist()
    env.seed([1, 2, 3])
    for wrong, error in (([1.7], TypeError), ([True, False, True], TypeError), ([3], hasard_rs.InvalidOption), (-1, hasard_rs.InvalidOption)):
        for call in (lambda: env.reset(wrong), lambda: env.step([0], wrong)):  # noqa: B023
            with pytest.raises(error, match="lanes"):
                call()
    with pytest.raises(ValueError, match="one entry for each of the 2 lanes"):
        env.reset([2, 0], seed=[1, 2, 3])
    # What was refused has not used up the seeds of the next reset.
    env.reset()
    other.reset([1, 2, 3])
    assert env.worlds.episode_seeds.tolist() == other.episode_seeds.tolist()


def test_numpys_integers_are_numbers_and_bools_are_none() -> None:
    agent = hasard_rs.Agent.load("zoo:RemedyRushLevel1")
    assert agent.begin(np.int64(2), np.int64(5)) is not None
    for given, error, words in (
        ((3, -1), ValueError, "a seed must not be negative"),
        ((3, 1.5), TypeError, "a seed must be an integer"),
        ((-1,), hasard_rs.InvalidOption, "lanes cannot be -1"),
        ((True,), hasard_rs.InvalidOption, "lanes cannot be True"),
    ):
        with pytest.raises(error, match=words):
            agent.begin(*given)
    env = hasard_rs.make(ENV, max_episode_steps=np.int64(5), delta_bins=np.int64(5), full_actions=True, **SMALL)
    assert env.get_wrapper_attr("max_episode_steps") == 5 and env.action_space.nvec[-1] == 5
    garden: dict[str, Any] = {
        "scenario": {"name": "RefusalGarden", "tics": 70, "budget": 3, "actions": [["TURN_LEFT", "TURN_RIGHT"], ["MOVE_FORWARD"]]},
        "map": {"ascii": "######\n#....#\n#.@..#\n######"},
    }
    own = hasard_rs.Scenario.from_dict(garden)
    assert own.make(level=np.int64(1), **SMALL).get_wrapper_attr("level") == 1
    for name in ("frame_skip", "frame_stack", "max_episode_steps"):
        for make in (hasard_rs.make, hasard_rs.make_vec):
            with pytest.raises(hasard_rs.InvalidOption, match=f"{name} cannot be True; it must be a whole number"):
                make(ENV, **{name: True, **SMALL})
    for batch in ({"num_threads": True}, {"num_envs": True}, {"copy": "no"}, {"copy": None}):
        with pytest.raises(hasard_rs.InvalidOption, match=f"{next(iter(batch))} cannot be"):
            hasard_rs.make_vec(ENV, **batch, **SMALL)


def test_a_budget_is_a_number() -> None:
    env = hasard_rs.make(ENV, **SMALL)
    for wrong in (float("nan"), float("inf"), -5, "5"):
        with pytest.raises(hasard_rs.InvalidOption, match="budget cannot be"):
            published.Saute(env, budget=wrong)  # type: ignore[arg-type]
    assert published.Saute(env, budget=np.float32(0)).budget > 0


def test_five_values_have_a_cost_at_reset_too() -> None:
    env = safety.to_gymnasium(safety.SafetyEnv(ENV, **SMALL))
    assert env.reset(seed=1)[1]["cost"] == 0.0


def test_a_delta_of_the_wrong_size_is_named() -> None:
    arguments: dict[str, Any] = {"action_format": "tuple", "full_actions": True, **SMALL}
    for envs in (hasard_rs.make(ENV, **arguments), hasard_rs.make_vec(ENV, 3, **arguments)):
        envs.reset(seed=1)
        actions = envs.action_space.sample()
        envs.step(actions)
        with pytest.raises(ValueError, match=r"part 10 of the action must be a delta.* got shape \(2,\)"):
            envs.step((*actions[:-1], [0.0, 0.5]))


def test_a_list_of_one_id_is_that_id() -> None:
    envs = hasard_rs.make_vec([ENV], 2, **SMALL)
    assert envs.spec is not None and envs.spec.id == ENV
    assert hasard_rs.make_vec([ENV, "VolcanicVentureLevel1-v0"], 2, **SMALL).spec is None
