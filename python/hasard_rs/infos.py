"""What `info` and `infos` hold: the same keys at every reset and step, and more where an episode ends."""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np

from hasard_rs import _core
from hasard_rs.errors import InvalidOption
from hasard_rs.events import Events


class Infos:
    """Writes the infos of one environment or a batch of them.

    Args:
        worlds: whose.
        scenario: its name.
        infos: "cost", "full" or "events".
        env_stats: whether the statistics of every step are reported.
    """

    def __init__(self, worlds: Any, scenario: str, infos: str, env_stats: bool) -> None:
        self.worlds = worlds
        self.full = infos in ("full", "events")
        self.events = infos == "events"
        self.tasks = worlds.lane_tasks if "," in worlds.env_id else None
        self.env_stats = env_stats
        # Statistics of the published package that have a meaning here, by the name of ours; None is the episode's cost so far.
        self.published: dict[str, str | None] = dict(_core.published_stats(scenario))
        self.statistics = list(worlds.statistics)
        # Cost of each lane's running episode so far.
        self.cost = np.zeros(worlds.num_envs)

    def step(self, batch: Any) -> dict[str, Any]:
        """Returns columns of a step's or reset's `batch`: a value a row for each key."""
        columns: dict[str, Any] = {"cost": batch.costs.astype(np.float64)}
        if self.full:
            columns["cost_terms"] = batch.cost_terms.astype(np.float64)
            columns["position"] = np.array(batch.positions)
            columns["episode_seed"] = self.worlds.episode_seeds[batch.lanes]
        if self.tasks is not None:
            columns["task"] = self.tasks[batch.lanes]
        if self.events:
            columns["events"] = _by_lane(batch)
        if self.env_stats:
            self.cost[batch.lanes] += columns["cost"]
            columns["env_stats"] = self._stats(self.cost[batch.lanes], batch.statistics)
        return columns

    def save(self) -> bytes:
        """Returns where the worlds are, what their running episodes have cost so far, and a checksum of both."""
        state: bytes = self.worlds.save() + self.cost.astype("<f8").tobytes()
        return state + checksum(state)

    def load(self, state: Any) -> Any:
        """Brings the worlds and their costs to where `state` was saved. Returns the batch; raises InvalidOption, TypeError for what is no bytes."""
        if not isinstance(state, bytes):
            raise TypeError(f"a saved moment must be bytes, got {type(state).__name__}")
        state, noted = state[:-4], state[-4:]
        if noted != checksum(state):
            raise InvalidOption("the saved moment is spoiled, or of another version: its checksum is another; save it anew")
        end = max(0, len(state) - self.cost.nbytes)
        batch = self.worlds.load(state[:end])
        self.cost[:] = np.frombuffer(state, "<f8", offset=end)
        return batch

    def begin(self, lanes: Any) -> None:
        """Episodes begin in these lanes."""
        self.cost[lanes] = 0.0

    def _stats(self, cost: Any, statistics: Any) -> dict[str, Any]:
        columns = dict(zip(self.statistics, np.asarray(statistics, dtype=np.float64).T, strict=True))
        for name, own in self.published.items():
            columns[name] = np.array(cost) if own is None else columns[own]
        return columns

    def now(self, lane: int) -> dict[str, Any]:
        """Returns the info of a lane whose episode has just begun, where the batch shows the one that ended."""
        info: dict[str, Any] = {}
        if self.full:
            info = {"position": self.worlds.positions[lane], "episode_seed": self.worlds.episode_seeds[lane]}
        if self.env_stats:
            info["env_stats"] = self.stats(lane, 0.0)
        return info

    def stats(self, lane: int, cost: float) -> dict[str, float]:
        """Returns the statistics of a lane's running episode, which has had this cost so far."""
        statistics = np.array([[value for _, value in self.worlds.stats(lane)]])
        return {name: float(column[0]) for name, column in self._stats(np.array([cost]), statistics).items()}


def checksum(state: bytes) -> bytes:
    """Returns the four bytes by which a changed `state` is found out."""
    return zlib.crc32(state).to_bytes(4, "little")


def _by_lane(batch: Any) -> Any:
    """The events of each row as one column of objects."""
    column = np.empty(len(batch.lanes), dtype=object)
    offsets = batch.event_offsets.tolist()
    for index, (begin, end) in enumerate(zip(offsets, offsets[1:], strict=False)):
        column[index] = Events(batch.events[begin:end])
    return column


def row(columns: dict[str, Any], index: int) -> dict[str, Any]:
    """Returns one lane's values of all columns, those at `index`, as a single environment's info."""
    return {
        key: {name: float(column[index]) for name, column in value.items()} if isinstance(value, dict) else value[index]
        for key, value in columns.items()
    }


def summary(episode: dict[str, Any]) -> dict[str, Any]:
    """Returns what is known of an episode that ended: its seed as uint64, like `episode_seed`, since no float holds every seed; the rest floats."""
    info: dict[str, Any] = {name: float(episode[name]) for name in ("return", "cost", "length")}
    info["seed"] = np.uint64(episode["seed"])
    info |= {name: float(episode[name]) for name in ("terminated", "truncated")}
    info |= {f"cost_{name}": float(value) for name, value in episode["costs"].items()}
    return info | {name: float(value) for name, value in episode["statistics"].items()}
