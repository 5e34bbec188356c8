"""PufferLib 3: a batch of worlds that writes into the buffers which PufferLib gives."""

from __future__ import annotations

from typing import Any

import numpy as np

from hasard_rs._extra import need

pufferlib = need("pufferlib", "pufferlib", "pufferlib")

import hasard_rs  # noqa: E402
from hasard_rs import arguments as _arguments  # noqa: E402
from hasard_rs.infos import summary  # noqa: E402
from hasard_rs.spaces import action_format  # noqa: E402


class HasardPuffer(pufferlib.PufferEnv):  # type: ignore[name-defined,misc]
    """Worlds in SAME_STEP mode over PufferLib's own arrays; infos come at ends.

    Costs of the step are in `costs` (float32 [n]): an attribute of the process that steps the worlds, which is another one than the learner's
    under PufferLib's Multiprocessing. The costs of episodes are in the infos in any case.

    Args:
        env_id: one of `hasard_rs.ids()`.
        num_envs: lanes.
        num_threads: worker threads beside the caller's.
        buf: PufferLib's arrays; None: its own.
        seed: of the first reset without one.
        arguments: see `help(hasard_rs.Env)`; layout is "chw" unless given.
    """

    def __init__(self, env_id: str, num_envs: int = 1, *, num_threads: int | None = None, buf: Any = None, seed: int = 0, **arguments: Any) -> None:
        given = _arguments.read({"layout": "chw", **arguments, **hasard_rs._task(env_id, arguments)}, vector=True)
        given.without("hasard_rs.pufferlib", "action_format", "render_mode", "render_resolution", "infos", "env_stats")
        self.worlds = hasard_rs.Worlds(given.env_id, num_envs, num_threads=num_threads, **given.world)
        self._format = action_format("multi_discrete", self.worlds.nvec, self.worlds.num_deltas, given.delta_bins)
        import gymnasium

        self.single_observation_space = gymnasium.spaces.Box(0, 255, self.worlds.observation_shape, np.uint8)
        self.single_action_space = self._format.space
        self.num_agents = num_envs
        super().__init__(buf)
        self.costs = np.zeros(num_envs, np.float32)
        self.worlds.bind(
            observations=self.observations,
            rewards=self.rewards,
            costs=self.costs,
            terminated=self.terminals,
            truncated=self.truncations,
        )
        self._seed: int | None = seed

    def reset(self, seed: int | None = None) -> tuple[np.ndarray, list[dict[str, Any]]]:
        """Starts episodes. Returns observations uint8 [n, ...], PufferLib's array, and no infos.

        An int seed s seeds lane i with s * num_envs + i: PufferLib gives neighbours neighbouring seeds, and none plays another's episodes. None
        goes on with the lanes' streams, after a first reset by the constructor's seed.
        """
        seed, self._seed = self._seed if seed is None else seed, None
        self.worlds.reset(None if seed is None else seed * self.num_agents)
        return self.observations, []

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        """Steps every lane.

        Args:
            actions: integers [n, parts].

        Returns:
            Observations, rewards, terminals and truncations, PufferLib's arrays, and a dict for each episode that ended.

        Raises:
            InvalidAction; TypeError or ValueError for the wrong dtype or shape. Nothing has moved then.
        """
        batch = self.worlds.step(*self._format.many(actions, self.num_agents))
        return self.observations, self.rewards, self.terminals, self.truncations, [summary(episode) for episode in batch.episodes]

    def render(self) -> np.ndarray:
        """Returns the first lane's picture, uint8 [120, 160, 3]."""
        return self.worlds.render(0)

    def close(self) -> None:
        """Lets the worlds go."""
        self.worlds.close()
