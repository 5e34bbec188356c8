"""Six-tuple environments, as Safety-Gymnasium, OmniSafe and SafePO step them: the cost is a value of its own, not in `info`."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

import hasard_rs


class SafetyEnv(gymnasium.Env[np.ndarray, Any]):
    """A single environment whose `step` returns (observation, reward, cost, terminated, truncated, info).

    Args:
        env: an id, or an environment that has `info["cost"]`.
        arguments: with an id, those of `help(hasard_rs.Env)`.

    Raises:
        TypeError for arguments with an environment that is made; what `hasard_rs.make` raises.
    """

    def __init__(self, env: str | gymnasium.Env[Any, Any], **arguments: Any) -> None:
        if arguments and not isinstance(env, str):
            raise TypeError(f"{', '.join(arguments)}: an environment that is made takes no arguments; give its id, or make it with them")
        self.env = hasard_rs.make(env, **arguments) if isinstance(env, str) else env
        self.action_space, self.observation_space = self.env.action_space, self.env.observation_space
        self.metadata, self.render_mode, self.spec = self.env.metadata, self.env.render_mode, self.env.spec

    @property
    def safety_budget(self) -> float:
        """Cost that an episode may have. Raises AttributeError for an environment without one."""
        return float(self.env.get_wrapper_attr("safety_budget"))

    @property
    def max_episode_steps(self) -> int:
        """Steps of an episode that only time ends. Raises AttributeError for an environment without a limit."""
        return int(self.env.get_wrapper_attr("max_episode_steps"))

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts an episode; seed and options as for `Env.reset`. Returns the observation and its info, without "cost"."""
        observation, info = self.env.reset(seed=seed, options=options)
        return observation, {name: value for name, value in info.items() if name != "cost"}

    def step(self, action: Any) -> tuple[np.ndarray, float, float, bool, bool, dict[str, Any]]:  # type: ignore[override]
        """Holds an action. Returns (observation, reward, cost, terminated, truncated, info), floats and bools; raises what `Env.step` does."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        cost = float(info.pop("cost"))
        return observation, float(reward), cost, terminated, truncated, info

    def save(self) -> bytes:
        """Returns where the environment is, to come back to by `load`. Raises AttributeError for one of another package."""
        return bytes(self.env.get_wrapper_attr("save")())

    def load(self, state: bytes) -> np.ndarray:
        """Comes back to `state`, which `save` gave. Returns the observation of that moment; raises what `Env.load` does."""
        observation: np.ndarray = self.env.get_wrapper_attr("load")(state)
        return observation

    def render(self) -> Any:
        """Returns what `Env.render` does."""
        return self.env.render()

    def close(self) -> None:
        """Lets the world go."""
        self.env.close()


class SafetyVectorEnv:
    """A batch of worlds in SAME_STEP mode whose `step` returns (observations, rewards, costs, terminateds, truncateds, infos).

    Last observations are in `infos` as `final_observation` and `_final_observation`, Gymnasium's names before 1.0; `final_info` is a dict of
    columns, as Gymnasium 1 has it.

    Args:
        env_id: one of `hasard_rs.ids()`.
        num_envs: lanes.
        arguments: those of `help(hasard_rs.VectorEnv)`.
    """

    def __init__(self, env_id: str, num_envs: int, **arguments: Any) -> None:
        self.envs = hasard_rs.make_vec(env_id, num_envs, autoreset_mode="SameStep", **arguments)
        self.num_envs = num_envs
        self.single_action_space, self.single_observation_space = self.envs.single_action_space, self.envs.single_observation_space
        self.action_space, self.observation_space = self.envs.action_space, self.envs.observation_space

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts episodes; seed and options as for `VectorEnv.reset`. Returns observations uint8 [n, ...] and infos, without "cost"."""
        observations, infos = self.envs.reset(seed=seed, options=options)
        return observations, _without_cost(infos)

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Steps every lane by actions of action_space.

        Returns (observations uint8 [n, ...], rewards float64 [n], costs float64 [n], terminateds, truncateds bool [n], infos); raises what
        `VectorEnv.step` does.
        """
        observations, rewards, terminated, truncated, infos = self.envs.step(actions)
        costs = infos["cost"]
        infos = _without_cost(infos)
        if "final_obs" in infos:
            infos["final_observation"], infos["_final_observation"] = infos.pop("final_obs"), infos.pop("_final_obs")
        return observations, rewards, costs, terminated, truncated, infos

    def save(self) -> bytes:
        """Returns where every lane is, to come back to by `load`; raises what `VectorEnv.save` does."""
        return self.envs.save()

    def load(self, state: bytes) -> np.ndarray:
        """Comes back to `state`, which `save` gave. Returns observations uint8 [n, ...] of then; raises what `VectorEnv.load` does."""
        return self.envs.load(state)

    def close(self) -> None:
        """Lets the worlds go."""
        self.envs.close()


def _without_cost(infos: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in infos.items() if name not in ("cost", "_cost")}


class _Five(gymnasium.Wrapper[Any, Any, Any, Any]):
    """A six-tuple environment with its cost put back into `info`."""

    def __init__(self, env: Any) -> None:
        super().__init__(env)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        observation, info = self.env.reset(seed=seed, options=options)
        return observation, {**info, "cost": 0.0}

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        observation, reward, cost, terminated, truncated, info = self.env.step(action)  # type: ignore[misc]
        return observation, reward, terminated, truncated, {**info, "cost": cost}


def from_gymnasium(env: gymnasium.Env[Any, Any]) -> SafetyEnv:
    """Returns a six-tuple view of an environment `env` that has `info["cost"]`."""
    return SafetyEnv(env)


def to_gymnasium(env: Any) -> gymnasium.Env[Any, Any]:
    """Returns a five-tuple view of a six-tuple environment `env`."""
    return _Five(env)


def register() -> list[str]:
    """Puts `SafetyHasard<Scenario><Level>-v0` and `SafetyHasard<Scenario><Level>Gymnasium-v0` into Safety-Gymnasium. Returns their ids."""
    from hasard_rs._extra import need

    safety_gymnasium = need("safety_gymnasium", "omnisafe", "safety")
    made = []
    for env_id in hasard_rs.ids():
        spec = hasard_rs.spec(env_id)
        name = f"SafetyHasard{spec.scenario}{spec.level}"
        safety_gymnasium.register(id=f"{name}-v0", entry_point="hasard_rs.safety:SafetyEnv", kwargs={"env": env_id})
        gymnasium.register(f"{name}Gymnasium-v0", entry_point="hasard_rs:make", kwargs={"env_id": env_id})
        made += [f"{name}-v0", f"{name}Gymnasium-v0"]
    return made
