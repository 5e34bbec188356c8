"""Other views of the same worlds: the published package's names, six-tuples, PettingZoo, wrappers, and adapters without their library."""

from __future__ import annotations

import importlib
import subprocess
import sys
import textwrap

import gymnasium
import numpy as np
import pytest

import hasard_rs

ENV = "hasard/VolcanicVentureLevel1-v0"


def test_the_published_packages_loop_runs_after_its_import_is_changed() -> None:
    # In a process of its own, since it registers bare ids.
    code = """
        import hasard_rs.published as hasard
        for scenario in hasard.Scenario:
            env = hasard.make(f"{scenario.value}Level{hasard.LEVELS[0]}-v0")
            env.reset()
            terminated = truncated = False
            steps = total_cost = total_reward = 0
            while not (terminated or truncated or steps > 20):
                action = env.action_space.sample()
                state, reward, terminated, truncated, info = env.step(action)
                env.unwrapped.get_statistics()
                steps, total_cost, total_reward = steps + 1, total_cost + info["cost"], total_reward + reward
            assert state.shape == (240, 320, 3) and info["env_stats"]
            env.close()
    """
    subprocess.run([sys.executable, "-W", "error", "-c", textwrap.dedent(code)], check=True)


def test_six_tuples() -> None:
    from hasard_rs import safety

    env, plain = safety.SafetyEnv(ENV, resolution="64x48"), hasard_rs.make(ENV, resolution="64x48")
    _, info = env.reset(seed=1)
    plain.reset(seed=1)
    assert "cost" not in info
    back = safety.to_gymnasium(safety.SafetyEnv(ENV, resolution="64x48"))
    back.reset(seed=1)
    for _ in range(100):
        observation, reward, cost, terminated, truncated, info = env.step([1, 1, 0, 1])
        expected = plain.step([1, 1, 0, 1])
        assert np.array_equal(observation, expected[0]) and (reward, terminated, truncated) == expected[1:4]
        assert cost == expected[4]["cost"] == back.step([1, 1, 0, 1])[4]["cost"] and "cost" not in info
    vec = safety.SafetyVectorEnv(ENV, 2, resolution="64x48", max_episode_steps=5)
    vec.reset(seed=0)
    for _ in range(5):
        result = vec.step(np.zeros((2, 4), int))
    assert result[4].all() and result[5]["_final_observation"].all() and result[5]["final_observation"][0].shape == (48, 64, 3)


def test_wrappers_count_costs() -> None:
    from hasard_rs.wrappers import CostPenalty, Saute

    env = Saute(CostPenalty(hasard_rs.make("hasard/PrecipicePlungeLevel1-v0", resolution="64x48"), 2.0), 1.0, budget=10.0, unsafe_reward=-7.0)
    env.reset(seed=0)
    spent, unsafe = 0.0, False
    for _ in range(200):
        _, reward, terminated, truncated, info = env.step([0, 1, 0, 1])
        spent += info["cost"]
        assert info["safety_state"] == pytest.approx(1.0 - spent / 10.0)
        assert reward == (info["raw_reward"] - 2.0 * info["cost"] if spent < 10.0 else -7.0)
        unsafe |= spent >= 10.0
        if terminated or truncated:
            break
    assert unsafe


def test_saute_counts_by_its_defaults() -> None:
    """Sootla et al. 2022, equation 3: z' = (z - c / d) / gamma, with d the budget of 50 times the mean of gamma^t over 525 steps."""
    from hasard_rs.wrappers import Saute

    env = Saute(hasard_rs.make("hasard/PrecipicePlungeLevel1-v0", resolution="64x48"))
    _, info = env.reset(seed=0)
    assert info["safety_state"] == 1.0
    each, state, costs = 50.0 * sum(0.99**step for step in range(525)) / 525.0, 1.0, 0
    for _ in range(100):
        _, reward, terminated, _, info = env.step([0, 1, 0, 1])
        state = (state - info["cost"] / each) / 0.99
        costs += info["cost"] > 0
        assert info["safety_state"] == pytest.approx(state, rel=1e-9)
        assert (reward == -1.0) == (state <= 0.0)
        if terminated:
            break
    assert costs >= 2 and state < 0.0


def test_pettingzoos_own_tests() -> None:
    pettingzoo_test = pytest.importorskip("pettingzoo.test")
    from hasard_rs.pettingzoo import parallel_env

    pettingzoo_test.parallel_api_test(parallel_env(ENV, resolution="64x48"), num_cycles=50)
    pettingzoo_test.parallel_seed_test(lambda: parallel_env(ENV, resolution="64x48"), num_cycles=5)


def test_tianshous_way_of_stepping_some_lanes() -> None:
    from hasard_rs.tianshou import HasardVectorEnv

    envs = HasardVectorEnv(ENV, 4, resolution="64x48", max_episode_steps=6)
    observations, infos = envs.reset(seed=3)
    assert observations.shape == (4, 3, 48, 64) and [info["env_id"] for info in infos] == [0, 1, 2, 3]
    for _ in range(6):
        result = envs.step(np.zeros(2, int), [3, 1])
    assert result[3].all() and [info["env_id"] for info in result[4]] == [3, 1] and "episode_summary" in result[4][0]
    envs.reset([3, 1])
    assert len(envs.step(np.zeros(4, int))[0]) == len(envs) == 4


@pytest.mark.parametrize("library", ["sb3", "rllib", "torchrl", "omnisafe", "sample_factory", "pufferlib", "ray"])
def test_adapters_say_what_they_need(library: str) -> None:
    needed = {"sb3": "stable_baselines3", "rllib": "ray", "torchrl": "torch"}.get(library, library)
    if importlib.util.find_spec(needed) is not None:
        pytest.skip("installed here")
    with pytest.raises(ImportError, match=rf"hasard_rs\.{library} needs .*pip install '\.\["):
        importlib.import_module(f"hasard_rs.{library}")


def test_published_classes_have_their_names() -> None:
    from hasard_rs.envs.volcanic_venture.env import VolcanicVenture

    env = VolcanicVenture(level=2, resolution="64x48")
    assert (env.scenario_name, env.level) == ("VolcanicVenture", 2)
    with pytest.warns(DeprecationWarning, match="has no effect"):
        hasard_rs.Env(scenario="VolcanicVenture", level=1, record_every=10)


def test_gymnasiums_vector_wrappers() -> None:
    from gymnasium.wrappers.vector import RecordEpisodeStatistics

    envs = RecordEpisodeStatistics(hasard_rs.make_vec(ENV, 2, resolution="64x48", max_episode_steps=5))
    envs.reset(seed=0)
    for _ in range(5):
        infos = envs.step(np.zeros((2, 4), int))[4]
    assert infos["episode"]["l"].tolist() == [5, 5] and infos["_episode_summary"].all()
    assert gymnasium.spec(ENV).max_episode_steps is None
