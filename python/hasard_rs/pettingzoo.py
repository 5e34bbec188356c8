"""PettingZoo: one world as a parallel environment of one agent, for tools that speak only that."""

from __future__ import annotations

from typing import Any

from hasard_rs._extra import need

need("pettingzoo", "pettingzoo", "pettingzoo")

from pettingzoo import ParallelEnv as _ParallelEnv  # noqa: E402

import hasard_rs  # noqa: E402

PLAYER = "player_0"


class ParallelEnv(_ParallelEnv):  # type: ignore[type-arg]
    """One world; its agent is `player_0`, and `agents` empties when the episode ends.

    Args:
        env_id: one of `hasard_rs.ids()`.
        arguments: see `help(hasard_rs.Env)`.
    """

    def __init__(self, env_id: str, **arguments: Any) -> None:
        self.env = hasard_rs.make(env_id, **arguments).unwrapped
        self.metadata = {"name": env_id.replace("/", "_"), "render_modes": self.env.metadata["render_modes"]}
        self.render_mode = self.env.render_mode
        self.possible_agents = [PLAYER]
        self.agents: list[str] = []
        self.observation_spaces = {PLAYER: self.env.observation_space}
        self.action_spaces = {PLAYER: self.env.action_space}

    def observation_space(self, agent: str) -> Any:
        """Returns the space of an agent's observations, the same object every time."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Any:
        """Returns the space of an agent's actions, the same object every time."""
        return self.action_spaces[agent]

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """Starts an episode; seed and options as for `Env.reset`. Returns observations and infos by agent."""
        observation, info = self.env.reset(seed=seed, options=options)
        self.agents = [PLAYER]
        return {PLAYER: observation}, {PLAYER: info}

    def step(self, actions: dict[str, Any]) -> tuple[dict[str, Any], ...]:
        """Steps the world by `actions["player_0"]`. Returns what `Env.step` does, each by agent; raises what it raises."""
        observation, reward, terminated, truncated, info = self.env.step(actions[PLAYER])
        if terminated or truncated:
            self.agents = []
        return {PLAYER: observation}, {PLAYER: reward}, {PLAYER: terminated}, {PLAYER: truncated}, {PLAYER: info}

    def render(self) -> Any:
        """Returns what `Env.render` does."""
        return self.env.render()

    def close(self) -> None:
        """Lets the world go."""
        self.env.close()


def parallel_env(env_id: str, **arguments: Any) -> ParallelEnv:
    """Returns one world as a parallel environment; env_id and arguments as of `ParallelEnv`."""
    return ParallelEnv(env_id, **arguments)
