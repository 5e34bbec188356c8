"""The safety state of Sauté RL (Sootla et al., 2022)."""

from __future__ import annotations

import math
import numbers
from typing import Any

import gymnasium
from gymnasium.utils import RecordConstructorArgs

from hasard_rs.errors import InvalidOption
from hasard_rs.wrappers.moments import Moments


def _is_finite(value: Any) -> bool:
    try:
        return isinstance(value, numbers.Real) and math.isfinite(value)
    except OverflowError:  # An integer beyond all floats.
        return False


class Saute(Moments, RecordConstructorArgs):
    """Counts down what is left of the budget: a step that finds nothing left is rewarded with `unsafe_reward`.

    The state starts at 1 and follows z' = (z - cost / budget) / gamma (equation 3 of the paper); it is in `info["safety_state"]`. The budget
    is the environment's safety budget, spread over an episode when the cost is discounted.

    Args:
        env: an environment with `info["cost"]`, `safety_budget` and `max_episode_steps`.
        saute_gamma: discount of the cost; 1.0: none.
        budget: cost that an episode may have; None: the environment's.
        unsafe_reward: of each step that finds nothing left.

    Raises:
        InvalidOption for a saute_gamma that is no discount, a budget that is no finite number of at least 0, or an unsafe_reward that is none.
    """

    _own = "safety_state"

    def __init__(
        self, env: gymnasium.Env[Any, Any], saute_gamma: float = 0.99, *, budget: float | None = None, unsafe_reward: float = -1.0
    ) -> None:
        if not (_is_finite(saute_gamma) and 0.0 < saute_gamma <= 1.0):
            raise InvalidOption(f"saute_gamma cannot be {saute_gamma!r}; it must be above 0, at most 1")
        if budget is not None and not (_is_finite(budget) and budget >= 0):
            raise InvalidOption(f"budget cannot be {budget!r:.60}; it must be a finite number, 0 or more")
        if not _is_finite(unsafe_reward):
            raise InvalidOption(f"unsafe_reward cannot be {unsafe_reward!r:.60}; it must be a finite number")
        RecordConstructorArgs.__init__(self, saute_gamma=saute_gamma, budget=budget, unsafe_reward=unsafe_reward)
        gymnasium.Wrapper.__init__(self, env)
        steps = env.get_wrapper_attr("max_episode_steps")
        total = env.get_wrapper_attr("safety_budget") if budget is None else budget
        share = 1.0 if saute_gamma == 1.0 else (1.0 - saute_gamma**steps) / (1.0 - saute_gamma) / steps
        self.saute_gamma, self.budget, self.unsafe_reward = saute_gamma, max(total * share, 1e-8), unsafe_reward
        self.safety_state = 1.0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts an episode; seed and options as for `Env.reset`. Returns what it does; `info["safety_state"]` is 1.0."""
        observation, info = self.env.reset(seed=seed, options=options)
        self.safety_state = 1.0
        info["safety_state"] = self.safety_state
        return observation, info

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Holds an action. Returns what `Env.step` does, with the reward of the safe or the unsafe and `info["safety_state"]`."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        self.safety_state = (self.safety_state - float(info["cost"]) / self.budget) / self.saute_gamma
        info["safety_state"] = self.safety_state
        safe = self.safety_state > 0
        return observation, float(reward) if safe else self.unsafe_reward, terminated, truncated, info
