"""Saved moments of wrapped environments: what wrappers know comes back with the world."""

from __future__ import annotations

import copy
from typing import Any

import gymnasium
import numpy as np
import pytest
from conftest import SMALL, assert_same

import hasard_rs
from hasard_rs import published
from hasard_rs.safety import SafetyEnv, SafetyVectorEnv
from hasard_rs.wrappers import CostPenalty, CostWrapper, Saute

ENV = "hasard/VolcanicVentureLevel1-v0"


def wrapped(**more: Any) -> Saute:
    return Saute(CostPenalty(hasard_rs.make(ENV, **SMALL, **more)), budget=7.0)


def cost_of(env: gymnasium.Env[Any, Any]) -> float:
    return float(env.get_wrapper_attr("episode_cost"))


@pytest.mark.parametrize("more", [{}, {"max_episode_steps": 30}, {"render_mode": "depth_array"}])
def test_wrappers_come_back_with_the_world(more: dict[str, Any]) -> None:
    env = wrapped(**more)
    env.action_space.seed(3)
    env.reset(seed=4)
    for _ in range(20):
        observation = env.step(env.action_space.sample())[0]
    state, cost, left = env.save(), cost_of(env), env.safety_state
    actions = [env.action_space.sample() for _ in range(10)]
    results = [env.step(action) for action in actions]
    env.reset(seed=5)
    assert cost > 0.0 and left != env.safety_state == 1.0
    # A fresh one needs no reset first, and ends where the other does.
    for again in (env, wrapped(**more)):
        assert np.array_equal(again.load(state), observation)
        assert (cost_of(again), again.safety_state) == (cost, left)
        assert_same([again.step(action) for action in actions], results)
    assert results[-1][3] == ("max_episode_steps" in more)


def test_before_a_reset_one_is_needed_after_load_too() -> None:
    state = hasard_rs.make(ENV, **SMALL).save()
    env = hasard_rs.make(ENV, **SMALL)
    env.reset(seed=1)
    env.load(state)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(env.action_space.sample())


def test_foreign_and_spoiled_moments_are_refused() -> None:
    env = hasard_rs.make(ENV, **SMALL)
    env.reset(seed=1)
    env.step(env.action_space.sample())
    state, cost = env.save(), cost_of(env)
    other = hasard_rs.make("hasard/RemedyRushLevel1-v0", **SMALL)
    other.reset(seed=1)
    spoiled = [b"", b"x" * 300, state[:40], state[:-1], state + b"x", state[:60] + bytes([state[60] ^ 1]) + state[61:]]
    for wrong in (*spoiled, env.unwrapped.save(), other.save(), Saute(env).save()):
        with pytest.raises(hasard_rs.InvalidOption):
            env.load(wrong)
        assert cost_of(env) == cost and env.save() == state
    with pytest.raises(TypeError, match="must be bytes"):
        env.load("state")
    plain = CostWrapper(gymnasium.make("CartPole-v1"))
    with pytest.raises(AttributeError, match="save"):
        plain.save()


def test_the_published_names_come_back_too() -> None:
    env, other = (published.make("VolcanicVentureLevel1-v0", resolution="160x120") for _ in range(2))
    env.action_space.seed(2)
    env.reset(seed=1)
    for _ in range(20):
        env.step(env.action_space.sample())
    state, inner = env.save(), env.unwrapped
    known = (dict(inner.get_statistics()), inner.calculate_cost(), cost_of(env))
    env.reset(seed=2)
    assert inner.get_statistics() != known[0] and cost_of(env) != known[2]
    for again in (env, other):
        again.load(state)
        assert (again.unwrapped.get_statistics(), again.unwrapped.calculate_cost(), cost_of(again)) == known


@pytest.mark.parametrize("lanes", [0, 3])
def test_six_tuples_come_back_too(lanes: int) -> None:
    env: Any = SafetyVectorEnv(ENV, lanes, **SMALL) if lanes else SafetyEnv(ENV, **SMALL)
    env.action_space.seed(3)
    env.reset(seed=4)
    for _ in range(20):
        observation = env.step(env.action_space.sample())[0]
    observation, state = observation.copy(), env.save()
    actions = [env.action_space.sample() for _ in range(10)]
    results = [copy.deepcopy(env.step(action)) for action in actions]
    env.reset(seed=5)
    assert np.array_equal(env.load(state), observation)
    assert_same([copy.deepcopy(env.step(action)) for action in actions], results)


@pytest.mark.parametrize("lanes", [None, 2])
def test_no_bit_of_a_moment_may_change(lanes: int | None) -> None:
    env: Any = hasard_rs.make(ENV, **SMALL).unwrapped if lanes is None else hasard_rs.make_vec(ENV, lanes, **SMALL)
    env.reset(seed=1)
    env.step(env.action_space.sample())
    saved = env.save()
    before = env.save()
    for bit in range(8 * len(saved)):
        spoiled = bytearray(saved)
        spoiled[bit // 8] ^= 1 << bit % 8
        with pytest.raises(hasard_rs.InvalidOption, match="spoiled"):
            env.load(bytes(spoiled))
    assert env.save() == before
    env.load(saved)


class TwoLanes(hasard_rs.VectorEnv):
    def __init__(self, scenario: str) -> None:
        super().__init__(scenario=scenario, level=1, num_envs=2, **SMALL)


def test_batches_of_a_subclass_are_copied() -> None:
    env = TwoLanes("RemedyRush")
    env.reset(seed=3)
    twin = copy.deepcopy(env)
    actions = env.action_space.sample()
    assert type(twin) is TwoLanes and np.array_equal(env.step(actions)[0], twin.step(actions)[0])
