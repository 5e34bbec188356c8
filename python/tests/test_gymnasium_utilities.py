"""Gymnasium's own utilities on these environments: its comparison of two of them, and its measurement of a batch."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_match import check_environments_match
from gymnasium.utils.performance import benchmark_vector_step

import hasard_rs

ENV = "hasard/DetonatorsDilemmaLevel1-v0"


class FirstLane(gymnasium.Env[Any, Any]):
    """Lane 0 of a batch, as a single environment."""

    def __init__(self, envs: hasard_rs.VectorEnv) -> None:
        self.envs = envs
        self.observation_space, self.action_space, self.render_mode = envs.single_observation_space, envs.single_action_space, envs.render_mode

    def _info(self, infos: dict[str, Any]) -> dict[str, Any]:
        return {
            key: {name: values[0].item() if values.dtype == float else values[0] for name, values in column.items() if not name.startswith("_")}
            if isinstance(column, dict)
            else column[0]
            for key, column in infos.items()
            if not key.startswith("_")
        }

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        observations, infos = self.envs.reset(seed=seed)
        return observations[0], self._info(infos)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        observations, rewards, terminations, truncations, infos = self.envs.step(np.stack([action] * self.envs.num_envs))
        return observations[0], float(rewards[0]), bool(terminations[0]), bool(truncations[0]), self._info(infos)

    def render(self) -> Any:
        return self.envs.render()[0]


@pytest.mark.parametrize("mode", ["NextStep", "Disabled"])
def test_the_first_lane_matches_the_single_environment(mode: str, full: bool) -> None:
    arguments: dict[str, Any] = {"resolution": "64x48", "infos": "full", "env_stats": True, "render_mode": "rgb_array"}
    single = gymnasium.make(ENV, **arguments).unwrapped
    lane = FirstLane(hasard_rs.make_vec(ENV, 3, autoreset_mode=mode, **arguments))
    # The first 525 steps are an episode.
    check_environments_match(single, lane, num_steps=1000 if full else 560, seed=4)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_a_batch_is_measured_in_every_mode(mode: str) -> None:
    envs = hasard_rs.make_vec(ENV, 4, resolution="64x48", max_episode_steps=20, autoreset_mode=mode)
    assert benchmark_vector_step(envs, target_duration=1, seed=2) > 0.0
