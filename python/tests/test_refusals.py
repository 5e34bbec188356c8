"""What cannot be asked for is refused by name: another task than the id's, lanes and counts that are none, budgets that are no numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import hasard_rs
from hasard_rs import published, safety
from hasard_rs.tianshou import HasardVectorEnv

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
