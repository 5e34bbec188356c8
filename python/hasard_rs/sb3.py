"""Stable-Baselines3, and sb3-contrib: a `VecEnv` over Rust's batch of worlds."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from hasard_rs._extra import need

need("stable_baselines3", "sb3", "sb3")

from stable_baselines3.common.vec_env import VecEnv as _VecEnv  # noqa: E402

import hasard_rs  # noqa: E402
from hasard_rs.errors import InvalidOption  # noqa: E402
from hasard_rs.infos import summary  # noqa: E402


class VecEnv(_VecEnv):
    """A batch of worlds as Stable-Baselines3 wants it: SAME_STEP, rewards float32, a dict of infos for each lane.

    Args:
        env_id: one of `hasard_rs.ids()`.
        n_envs: lanes.
        arguments: those of `help(hasard_rs.VectorEnv)`; layout is "chw" unless given.

    Raises:
        InvalidOption for batch_size or copy; what `hasard_rs.make_vec` raises.
    """

    def __init__(self, env_id: str, n_envs: int = 1, **arguments: Any) -> None:
        for name in ("batch_size", "copy"):
            if name in arguments:
                raise InvalidOption(f"{name} cannot be had in hasard_rs.sb3, whose arrays are the learner's to keep; leave it out")
        # Channels first, so that no wrapper transposes every observation.
        self.envs = hasard_rs.make_vec(env_id, n_envs, **{"layout": "chw", **arguments}, autoreset_mode="SameStep").unwrapped
        self.envs._given.without("hasard_rs.sb3", "infos", "env_stats")
        self.render_mode = self.envs.render_mode
        self._actions: Any = None
        self._began = np.zeros(n_envs)
        super().__init__(n_envs, self.envs.single_observation_space, self.envs.single_action_space)

    def reset(self) -> np.ndarray:
        """Starts episodes, by the seeds of `seed`, if any. Returns observations uint8 [n, ...]."""
        seeds = list(self._seeds) if any(seed is not None for seed in self._seeds) else None
        observations, infos = self.envs.reset(seed=seeds)
        self.reset_infos = [{"cost": float(cost)} for cost in infos["cost"]]
        self._began[:] = time.time()
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        """Keeps actions, integers [n, parts], for `step_wait`."""
        self._actions = actions

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        """Steps every lane.

        Returns (observations uint8 [n, ...], rewards float32 [n], dones bool [n], infos). Each info has "cost" and "TimeLimit.truncated"; where an
        episode ended "terminal_observation", "episode" (r, l, t in seconds) and "episode_summary" too. Raises what `VectorEnv.step` does.
        """
        batch = self.envs.worlds.step(*self.envs._format.many(self._actions, self.num_envs))
        infos: list[dict[str, Any]] = [{"cost": cost, "TimeLimit.truncated": False} for cost in batch.costs.tolist()]
        lasts = dict(zip(batch.final_lanes.tolist(), batch.final_observations, strict=True))
        for episode in batch.episodes:
            lane, now = episode["lane"], time.time()
            infos[lane]["TimeLimit.truncated"] = episode["truncated"] and not episode["terminated"]
            infos[lane]["terminal_observation"] = lasts[lane].copy()
            infos[lane]["episode"] = {"r": episode["return"], "l": episode["length"], "t": now - self._began[lane]}
            infos[lane]["episode_summary"] = summary(episode)
            self._began[lane] = now
        return batch.observations, batch.rewards, batch.terminated | batch.truncated, infos

    def close(self) -> None:
        """Lets the worlds go."""
        self.envs.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Returns the attribute attr_name for each lane of indices, as `VectorEnv.call` has it; of methods the vector environment's own."""
        own = getattr(self.envs, attr_name, None)
        answers = [own] * self.num_envs if callable(own) else self.envs.call(attr_name)
        return [answers[lane] for lane in self._lanes(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Sets the attribute attr_name, which all lanes share, to value, whatever indices are."""
        setattr(self.envs, attr_name, value)

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Calls method_name of `VectorEnv.call`, with method_args and method_kwargs. Returns an answer for each lane of indices."""
        answers = self.envs.call(method_name, *method_args, **method_kwargs)
        return [answers[lane] for lane in self._lanes(indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """Returns False for each lane of indices: no wrapper_class is around a single lane."""
        return [False] * len(self._lanes(indices))

    def get_images(self) -> Sequence[np.ndarray | None]:
        """Returns a picture a lane, uint8 [height, width, 3], or None without a render mode."""
        return self.envs.render() or [None] * self.num_envs

    def _lanes(self, indices: Any) -> Sequence[int]:
        return list(self._get_indices(indices))


def make_vec_env(env_id: str, n_envs: int = 1, seed: int | None = None, **arguments: Any) -> VecEnv:
    """A batch of worlds for Stable-Baselines3, channels first: `PPO("CnnPolicy", make_vec_env("hasard/RemedyRushLevel1-v0", 16))`.

    Args:
        env_id: one of `hasard_rs.ids()`.
        n_envs: lanes.
        seed: lane i's is seed + i; None: drawn from NumPy's global generator, as Stable-Baselines3 draws it.
        arguments: those of `help(hasard_rs.VectorEnv)`.

    Returns:
        A `VecEnv`.
    """
    env = VecEnv(env_id, n_envs, **arguments)
    env.seed(seed)
    return env
