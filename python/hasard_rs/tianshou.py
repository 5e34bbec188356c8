"""Tianshou: a batch of worlds in the manner of its `BaseVectorEnv`, which steps and resets any lanes."""

from __future__ import annotations

from typing import Any

import numpy as np

import hasard_rs
from hasard_rs import arguments as _arguments
from hasard_rs.errors import InvalidOption
from hasard_rs.infos import Infos, row, summary
from hasard_rs.spaces import action_format


class HasardVectorEnv:
    """A batch of worlds for Tianshou's collectors, which reset lanes themselves; actions are `discrete` unless asked otherwise.

    Args:
        env_id: one of `hasard_rs.ids()`.
        num_envs: lanes.
        num_threads: worker threads beside the caller's.
        arguments: those of `help(hasard_rs.Env)`; layout is "chw" unless given.

    Raises:
        InvalidOption for the action formats "tuple" and "dict"; what `hasard_rs.Worlds` raises.
    """

    is_async = False

    def __init__(self, env_id: str, num_envs: int, *, num_threads: int | None = None, **arguments: Any) -> None:
        spec = hasard_rs.spec(env_id)
        arguments = {"layout": "chw", "action_format": "discrete", **arguments}
        given = _arguments.read({**arguments, **hasard_rs._task(env_id, arguments)}, vector=True)
        given.without("hasard_rs.tianshou", "env_stats", "render_mode", "render_resolution")
        if given.action_format in ("tuple", "dict"):
            raise InvalidOption(f"action_format cannot be {given.action_format!r} in hasard_rs.tianshou, whose actions are one array")
        self.worlds = hasard_rs.Worlds(given.env_id, num_envs, num_threads=num_threads, autoreset_mode="Disabled", **given.world)
        self._format = action_format(given.action_format, self.worlds.nvec, self.worlds.num_deltas, given.delta_bins)
        self._infos = Infos(self.worlds, spec.scenario, given.infos, False)
        from gymnasium import spaces

        space = spaces.Box(0, 255, self.worlds.observation_shape, np.uint8)
        self.env_num = num_envs
        self.action_space = [self._format.space] * num_envs
        self.observation_space = [space] * num_envs
        self._seeds: Any = given.seed

    def __len__(self) -> int:
        return self.env_num

    def _lanes(self, chosen: Any) -> np.ndarray:
        if chosen is None:
            return np.arange(self.env_num)
        lanes = np.atleast_1d(np.asarray(chosen))
        if lanes.size and lanes.dtype.kind not in "iu":
            raise TypeError(f"lanes must be integers, got dtype {lanes.dtype}; give the lanes' numbers, 0..={self.env_num - 1}")
        if lanes.ndim > 1 or ((lanes < 0) | (lanes >= self.env_num)).any():
            raise InvalidOption(f"lanes cannot be {chosen!r:.60}; they must be a list of numbers, 0..={self.env_num - 1}")
        return lanes.astype(np.int64)

    def reset(self, env_id: Any = None, **kwargs: Any) -> tuple[np.ndarray, np.ndarray]:
        """Starts episodes.

        Args:
            env_id: lanes, an int or a list; None: all.
            kwargs: `seed`, an int (lane i's is seed + i) or a list of one for each of these lanes, in their order; None: that of `seed`.

        Returns:
            Observations uint8 [m, ...] of these lanes, and infos: an object array [m] of dicts.

        Raises:
            TypeError or InvalidOption for lanes that are none; TypeError or ValueError for seeds that are none, or of another number.
        """
        lanes = self._lanes(env_id)
        mask = np.zeros(self.env_num, np.bool_)
        mask[lanes] = True
        seeds = kwargs.get("seed")
        if seeds is None:
            # One a lane of all.
            seeds = self._seeds
        elif not _arguments.is_number(seeds):
            seeds = self._by_lane(lanes, seeds)
        batch = self.worlds.reset(seeds, None if mask.all() else mask)
        self._seeds = None
        return batch.observations[lanes], self._info_rows(batch, lanes, lanes)

    def _by_lane(self, lanes: np.ndarray, seeds: Any) -> list[int | None]:
        """Seeds of these lanes, in their order, as one a lane of all."""
        if isinstance(seeds, str) or not hasattr(seeds, "__len__"):
            raise TypeError(f"a seed must be an integer, or a list with one for each lane, got {seeds!r:.60}")
        if len(seeds) != len(lanes):
            raise ValueError(f"seed must have one entry for each of the {len(lanes)} lanes that are reset, got {len(seeds)}")
        each: list[int | None] = [None] * self.env_num
        for lane, seed in zip(lanes, seeds, strict=True):
            each[lane] = None if seed is None else _arguments.check_seed(seed)
        return each

    def step(self, action: Any, id: Any = None) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:  # noqa: A002
        """Steps lanes.

        Args:
            action: integers [m], or as the format says.
            id: the m lanes; None: all.

        Returns:
            (observations uint8 [m, ...], rewards float64 [m], terminated, truncated bool [m], infos: an object array [m] of dicts with "cost").

        Raises:
            InvalidAction; TypeError or ValueError for the wrong dtype or shape; ResetNeeded where a lane's episode is over. Nothing has moved then.
        """
        lanes = self._lanes(id)
        batch = self.worlds.step(*self._format.many(np.asarray(action), len(lanes)), lanes=lanes.tolist())
        infos = self._info_rows(batch, np.arange(len(lanes)), lanes)
        for episode in batch.episodes:
            infos[int(np.flatnonzero(lanes == episode["lane"])[0])]["episode_summary"] = summary(episode)
        return batch.observations, batch.rewards.astype(np.float64), batch.terminated, batch.truncated, infos

    def _info_rows(self, batch: Any, rows: np.ndarray, lanes: np.ndarray) -> np.ndarray:
        columns = self._infos.step(batch)
        infos = np.empty(len(lanes), dtype=object)
        for i, (index, lane) in enumerate(zip(rows, lanes, strict=True)):
            infos[i] = {**row(columns, int(index)), "env_id": int(lane)}
        return infos

    def seed(self, seed: Any = None) -> list[Any]:
        """Keeps the seed of the next reset, an int (lane i's is seed + i) or a list of one a lane. Returns one a lane. Raises ValueError
        for seeds of another number."""
        seeds: list[Any] = [None] * self.env_num
        if _arguments.is_number(seed):
            seeds = [int(seed) + lane for lane in range(self.env_num)]
        elif seed is not None:
            seeds = list(seed)
            if len(seeds) != self.env_num or not all(_arguments.is_whole(one) for one in seeds):
                raise ValueError(f"seed must be a whole number, or one for each of {self.env_num} lanes, got {seed!r:.60}")
        self._seeds = seed
        return seeds

    def render(self, **kwargs: Any) -> list[np.ndarray]:
        """Returns a picture a lane, uint8 [120, 160, 3]; kwargs are ignored."""
        return [self.worlds.render(lane) for lane in range(self.env_num)]

    def close(self) -> None:
        """Lets the worlds go."""
        self.worlds.close()
