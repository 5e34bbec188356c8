"""Ray: worlds on many machines. Samplers hold their worlds and give rollouts; a learner of yours asks for them.

The lanes of all samplers together are the same whatever their number: sampler k's lanes follow those before it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from hasard_rs._extra import need

ray = need("ray", "ray", "ray")

import hasard_rs  # noqa: E402
from hasard_rs.ray_training import train  # noqa: E402, F401

Rollout = dict[str, Any]
"""observations [T + 1, n, ...] uint8, actions, rewards, costs, cost_terms, terminated, truncated [T, n], final_observations, episodes, version."""


class Sampler:
    """Worlds and a policy on one machine; an actor by `samplers`.

    Args:
        env_id: one of `hasard_rs.ids()`.
        num_envs: lanes.
        first_lane: number of the first of them among all samplers' lanes.
        seed: of lane 0 of all.
        num_threads: worker threads beside the actor's.
        arguments: those of `hasard_rs.Worlds`.
    """

    def __init__(self, env_id: str, num_envs: int, *, first_lane: int = 0, seed: int = 0, num_threads: int = 0, **arguments: Any) -> None:
        self.worlds = hasard_rs.Worlds(env_id, num_envs, num_threads=num_threads, **arguments)
        self.observations = self.worlds.reset(seed + first_lane).observations
        self.rng = np.random.default_rng([seed, first_lane])
        self.policy: Any = None
        self.version = -1

    def set_policy(self, policy: Any, version: int) -> None:
        """Sets the policy of the samples to come.

        Args:
            policy: a function of observations (uint8 [n, ...]) that gives actions, integers [n, parts], with full_actions a pair of these and
                deltas, float32 [n, 2] in [-1, 1]; None draws at random.
            version: a number that the rollouts will carry.
        """
        self.policy, self.version = policy, version

    def sample(self, steps: int) -> Rollout:
        """Samples all lanes.

        Args:
            steps: T, how many.

        Returns:
            A rollout: "observations" uint8 [T + 1, n, ...], "actions" int64 [T, n, parts], "rewards" and "costs" float32 [T, n], "cost_terms" float32
            [T, n, k], "terminated" and "truncated" bool [T, n], "episodes" (a dict each), "version"; with full_actions "deltas" float32
            [T, n, 2]. Where an episode ends the next observation is the next episode's first: the last of the m that ended are
            "final_observations" uint8 [m, ...], in "final_steps" and "final_lanes" int64 [m], to bootstrap from where time ended them. Fresh
            contiguous arrays, which Ray's object store takes without a copy.
        """
        worlds, n = self.worlds, self.worlds.num_envs
        rollout: Rollout = {
            "observations": np.empty((steps + 1, n, *worlds.observation_shape), np.uint8),
            "actions": np.empty((steps, n, len(worlds.nvec)), np.int64),
            "cost_terms": np.empty((steps, n, len(worlds.cost_terms)), np.float32),
            "final_observations": [],
            "final_steps": [],
            "final_lanes": [],
            "episodes": [],
            "version": self.version,
        }
        for name, dtype in (("rewards", np.float32), ("costs", np.float32), ("terminated", np.bool_), ("truncated", np.bool_)):
            rollout[name] = np.empty((steps, n), dtype)
        if worlds.num_deltas:
            rollout["deltas"] = np.empty((steps, n, worlds.num_deltas), np.float32)
        for step in range(steps):
            rollout["observations"][step] = self.observations
            actions, deltas = self._act()
            batch = worlds.step(actions, deltas)
            rollout["actions"][step], self.observations = actions, batch.observations
            if deltas is not None:
                rollout["deltas"][step] = deltas
            rollout["final_observations"] += list(batch.final_observations)
            rollout["final_lanes"] += batch.final_lanes.tolist()
            rollout["final_steps"] += [step] * len(batch.final_lanes)
            for name in ("rewards", "costs", "cost_terms", "terminated", "truncated"):
                rollout[name][step] = getattr(batch, name)
            rollout["episodes"] += batch.episodes
        rollout["observations"][steps] = self.observations
        lasts = rollout["final_observations"]
        rollout["final_observations"] = np.stack(lasts) if lasts else np.empty((0, *worlds.observation_shape), np.uint8)
        for name in ("final_steps", "final_lanes"):
            rollout[name] = np.array(rollout[name], np.int64)
        return rollout

    def _act(self) -> tuple[Any, Any]:
        """Actions of all lanes, and deltas or None."""
        worlds, n = self.worlds, self.worlds.num_envs
        if self.policy is None:
            actions = self.rng.integers(0, worlds.nvec, (n, len(worlds.nvec)))
            deltas = self.rng.uniform(-1.0, 1.0, (n, worlds.num_deltas)).astype(np.float32) if worlds.num_deltas else None
            return actions, deltas
        given = self.policy(self.observations)
        if not worlds.num_deltas:
            return given, None
        if not isinstance(given, tuple) or len(given) != 2:
            raise TypeError("with full_actions a policy must give a pair, actions and deltas")
        return given


def samplers(env_id: str, count: int, lanes: int, *, seed: int = 0, num_cpus: float = 1, options: Any = None, **arguments: Any) -> list[Any]:
    """Starts samplers; one that dies is started anew, with its first episodes.

    Args:
        env_id: one of `hasard_rs.ids()`.
        count: how many.
        lanes: of all together.
        seed: lane i's is seed + i, whatever the count.
        num_cpus: what each asks Ray for.
        options: further options of the actors.
        arguments: those of `Sampler`.

    Returns:
        Handles of the actors.
    """
    actor = ray.remote(Sampler)
    placed = {"num_cpus": num_cpus, "max_restarts": -1, "max_task_retries": 0, "scheduling_strategy": "SPREAD", **(options or {})}
    shares = [lanes * (i + 1) // count - lanes * i // count for i in range(count)]
    firsts = [lanes * i // count for i in range(count)]
    make = actor.options(**placed).remote
    return [make(env_id, share, first_lane=first, seed=seed, **arguments) for share, first in zip(shares, firsts, strict=True)]


def rollouts(actors: list[Any], steps: int) -> Iterator[tuple[int, Rollout]]:
    """Samples for ever. An actor is asked again at once; a lost rollout is sampled anew.

    Args:
        actors: from `samplers`.
        steps: of each rollout.

    Returns:
        An iterator over (number of the actor, rollout), as they come. Its arrays are read-only views of Ray's memory.
    """
    asked = {actor.sample.remote(steps): i for i, actor in enumerate(actors)}
    while True:
        ready, _ = ray.wait(list(asked), num_returns=1)
        index = asked.pop(ready[0])
        try:
            rollout = ray.get(ready[0])
        except ray.exceptions.RayActorError:
            rollout = None
        asked[actors[index].sample.remote(steps)] = index
        if rollout is not None:
            yield index, rollout
