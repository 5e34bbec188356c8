"""Costs in `info`, and costs taken from the reward."""

from __future__ import annotations

from typing import Any

import gymnasium
from gymnasium.utils import RecordConstructorArgs

from hasard_rs.wrappers.moments import Moments


class CostWrapper(Moments, RecordConstructorArgs):
    """Makes sure that `info["cost"]` of `env` is there, at reset too, and keeps the episode's sum in `episode_cost`."""

    _own = "episode_cost"

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        RecordConstructorArgs.__init__(self)
        gymnasium.Wrapper.__init__(self, env)
        self.episode_cost = 0.0

    @property
    def cost_terms(self) -> Any:
        """A `CostTerm` for each named part of the cost, as `Env.cost_terms`."""
        return self.env.get_wrapper_attr("cost_terms")

    @property
    def safety_budget(self) -> float:
        """Cost that an episode may have, as `Env.safety_budget`; another `budget` is that of the environment within."""
        return float(self.env.get_wrapper_attr("safety_budget"))

    @safety_budget.setter
    def safety_budget(self, budget: float) -> None:
        """Sets that of the environment within, to another `budget`."""
        self.env.unwrapped.safety_budget = budget  # type: ignore[attr-defined]

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts an episode; seed and options as for `Env.reset`, and so is what it returns."""
        observation, info = self.env.reset(seed=seed, options=options)
        self.episode_cost = 0.0
        info.setdefault("cost", 0.0)
        return observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Holds an action. Returns and raises what `Env.step` does."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self.episode_cost += self.process_cost(info)
        return observation, reward, terminated, truncated, info

    def process_cost(self, info: dict[str, Any]) -> float:
        """Returns the cost in a step's info, which is put in, 0.0, if it is missing."""
        return float(info.setdefault("cost", 0.0))


class CostPenalty(gymnasium.Wrapper[Any, Any, Any, Any], RecordConstructorArgs):
    """Takes `penalty_scaling` times the cost from the reward of `env`; the raw reward is in `info["raw_reward"]`."""

    def __init__(self, env: gymnasium.Env[Any, Any], penalty_scaling: float = 1.0) -> None:
        RecordConstructorArgs.__init__(self, penalty_scaling=penalty_scaling)
        gymnasium.Wrapper.__init__(self, env)
        self.penalty_scaling = penalty_scaling

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Holds an action. Returns what `Env.step` does, with the reward less the penalty."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        info["raw_reward"] = float(reward)
        return observation, float(reward) - self.penalty_scaling * float(info["cost"]), terminated, truncated, info
