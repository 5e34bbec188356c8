"""Action formats: five spaces over the same actions, since no library takes all of them.

An action is a tuple of categorical parts (buttons) and, with `full_actions`, two continuous parts (deltas of look and turn).
Each format turns its own kind of action into rows of both, by whole arrays.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces

from hasard_rs.errors import InvalidAction

Rows = tuple[Any, Any]
"""Categorical parts, integers [n, groups], and continuous parts, float32 [n, deltas] or None."""


class ActionFormat:
    """One of the five formats for one action space.

    Args:
        nvec: choices of each categorical part.
        deltas: number of continuous parts.
        bins: of each delta where the format has no numbers.
    """

    space: spaces.Space[Any]

    def __init__(self, nvec: tuple[int, ...], deltas: int, bins: int) -> None:
        self.nvec = np.array(nvec, dtype=np.int64)
        self.groups = len(nvec)
        self.deltas = deltas
        self.bins = bins

    def one(self, action: Any) -> Rows:
        """Reads the action of a single environment. Returns rows; raises InvalidAction, TypeError or ValueError."""
        raise NotImplementedError

    def many(self, actions: Any, lanes: int) -> Rows:
        """Reads the actions of so many lanes. Returns rows; raises InvalidAction, TypeError or ValueError."""
        raise NotImplementedError

    def masks(self, choices: np.ndarray) -> np.ndarray:
        """Returns masks of the space's choices, bool [n, m], made of `choices`, those of the categorical parts', bool [n, sum of nvec]."""
        return choices

    def _integers(self, given: Any, shape: tuple[int, ...], what: str) -> np.ndarray:
        array = np.asarray(given)
        if array.dtype.kind not in "iub":
            raise TypeError(f"{what} must be integers, got dtype {array.dtype}")
        return _shaped(array, shape, what)

    @staticmethod
    def _wrong(rows: np.ndarray, lane: int, part: int, value: Any, allowed: str) -> InvalidAction:
        """The error of a part of an action; its lane is named where there are several."""
        of = f" of lane {lane}" if len(rows) > 1 else ""
        return InvalidAction(f"action{of}: part {part} is {value}; it must be {allowed}")

    def _binned(self, rows: np.ndarray) -> Rows:
        """Rows whose last columns are bins of the deltas."""
        if not self.deltas:
            return rows, None
        bins = rows[:, self.groups :]
        wrong = (bins < 0) | (bins >= self.bins)
        if wrong.any():
            lane, part = np.argwhere(wrong)[0]
            raise self._wrong(rows, lane, part + self.groups, bins[lane, part], f"0..={self.bins - 1}")
        return rows[:, : self.groups], (2.0 * bins / (self.bins - 1) - 1.0).astype(np.float32)


def _numbers(given: Any, what: str, dtype: type[np.floating[Any]]) -> np.ndarray:
    array = np.asarray(given)
    if array.dtype.kind not in "iubf":
        raise TypeError(f"{what} must be numbers, got dtype {array.dtype}")
    return array.astype(dtype, copy=False)


def _shaped(array: np.ndarray, shape: tuple[int, ...], what: str) -> np.ndarray:
    if array.shape == shape:
        return array
    if array.ndim == 0:
        raise TypeError(f"{what} must be an array of shape {shape}, got a scalar")
    raise ValueError(f"{what} must have shape {shape}, got {array.shape}")


def _column(given: Any, lanes: int) -> Any:
    """One part a lane, which networks give as a row or as a column."""
    array = np.asarray(given)
    return array[:, 0] if array.shape == (lanes, 1) else given


def _box(parts: int) -> spaces.Box:
    return spaces.Box(-1.0, 1.0, (parts,), np.float32)


class MultiDiscrete(ActionFormat):
    """A choice for each part; bin k of a delta is -1 + 2k / (bins - 1)."""

    def __init__(self, nvec: tuple[int, ...], deltas: int, bins: int) -> None:
        super().__init__(nvec, deltas, bins)
        self.parts = self.groups + deltas
        self.space = spaces.MultiDiscrete([*nvec, *[bins] * deltas])

    def masks(self, choices: np.ndarray) -> np.ndarray:
        return np.concatenate([choices, np.ones((len(choices), self.deltas * self.bins), np.bool_)], axis=1)

    def one(self, action: Any) -> Rows:
        return self._binned(self._integers(action, (self.parts,), "the action")[None])

    def many(self, actions: Any, lanes: int) -> Rows:
        return self._binned(self._integers(actions, (lanes, self.parts), "actions"))


class Discrete(ActionFormat):
    """One number for all parts together, row-major: `np.unravel_index(action, nvec)`."""

    def __init__(self, nvec: tuple[int, ...], deltas: int, bins: int) -> None:
        super().__init__(nvec, deltas, bins)
        self.sizes = (*nvec, *[bins] * deltas)
        self.count = int(np.prod(self.sizes))
        self.space = spaces.Discrete(self.count)

    def masks(self, choices: np.ndarray) -> np.ndarray:
        parts = np.split(choices, np.cumsum(self.nvec)[:-1], axis=1)
        bins = [np.ones((len(choices), self.bins), np.bool_)] * self.deltas
        whole = np.ones((len(choices), 1), np.bool_)
        for part in [*parts, *bins]:
            whole = (whole[:, :, None] & part[:, None, :]).reshape(len(choices), -1)
        return whole

    def one(self, action: Any) -> Rows:
        # NumPy's argmax and torch's item give 0-d arrays as well as arrays of one element.
        array = np.asarray(action)
        return self.many(array.reshape(1) if array.size == 1 else array, 1)

    def many(self, actions: Any, lanes: int) -> Rows:
        flat = self._integers(_column(actions, lanes), (lanes,), "actions")
        wrong = (flat < 0) | (flat >= self.count)
        if wrong.any():
            lane = int(wrong.argmax())
            raise self._wrong(flat, lane, 0, flat[lane], f"0..={self.count - 1}")
        return self._binned(np.stack(np.unravel_index(flat.astype(np.int64), self.sizes), axis=1))


class Tuple(ActionFormat):
    """A `Discrete` for each categorical part, then a `Box` of one number for each delta: the published package's spaces."""

    def __init__(self, nvec: tuple[int, ...], deltas: int, bins: int) -> None:
        super().__init__(nvec, deltas, bins)
        self.space = spaces.Tuple([*[spaces.Discrete(int(n)) for n in nvec], *[_box(1) for _ in range(deltas)]])

    def one(self, action: Any) -> Rows:
        self._count(action)
        categorical = [np.asarray(part).reshape(1) if np.size(part) == 1 else part for part in action[: self.groups]]
        return self.many((*categorical, *action[self.groups :]), 1)

    def many(self, actions: Any, lanes: int) -> Rows:
        if isinstance(actions, np.ndarray) and actions.ndim > 1:
            # An array of rows would be read by its columns where there are as many lanes as parts.
            raise TypeError(f"actions must be a tuple of {self.groups + self.deltas} parts, each of {lanes} lanes, got an array {actions.shape}")
        self._count(actions)
        parts = [self._integers(_column(part, lanes), (lanes,), "each part of the actions") for part in actions[: self.groups]]
        if not self.deltas:
            return np.stack(parts, axis=1), None
        continuous = [self._delta(part, self.groups + index, lanes) for index, part in enumerate(actions[self.groups :])]
        return np.stack(parts, axis=1), np.concatenate(continuous, axis=1)

    @staticmethod
    def _delta(given: Any, part: int, lanes: int) -> np.ndarray:
        """A delta of each lane in a column."""
        array = _numbers(given, "each delta", np.float32)
        if array.size != lanes:
            raise ValueError(f"part {part} of the action must be a delta, {lanes} in all, one a lane, got shape {array.shape}")
        return array.reshape(lanes, 1)

    def _count(self, actions: Any) -> None:
        if not hasattr(actions, "__len__") or hasattr(actions, "keys"):
            raise TypeError(f"the action must be a tuple of {self.groups + self.deltas} parts, got {type(actions).__name__}")
        if len(actions) != self.groups + self.deltas:
            raise ValueError(f"the action must have {self.groups + self.deltas} parts, got {len(actions)}")


class Dict(ActionFormat):
    """`buttons`: a choice for each categorical part; `deltas`: numbers in [-1, 1], with full actions only."""

    def __init__(self, nvec: tuple[int, ...], deltas: int, bins: int) -> None:
        super().__init__(nvec, deltas, bins)
        both: dict[str, spaces.Space[Any]] = {"buttons": spaces.MultiDiscrete(list(nvec))}
        if deltas:
            both["deltas"] = _box(deltas)
        self.space = spaces.Dict(both)

    def one(self, action: Any) -> Rows:
        self._check(action)
        buttons = self._integers(action["buttons"], (self.groups,), "buttons")[None]
        deltas = _shaped(_numbers(action["deltas"], "deltas", np.float32), (self.deltas,), "deltas")[None] if self.deltas else None
        return buttons, deltas

    def many(self, actions: Any, lanes: int) -> Rows:
        self._check(actions)
        buttons = self._integers(actions["buttons"], (lanes, self.groups), "buttons")
        deltas = _shaped(_numbers(actions["deltas"], "deltas", np.float32), (lanes, self.deltas), "deltas") if self.deltas else None
        return buttons, deltas

    def _check(self, action: Any) -> None:
        wanted = {"buttons", "deltas"} if self.deltas else {"buttons"}
        if not hasattr(action, "keys"):
            raise TypeError(f"the action must be a dict of {sorted(wanted)}, got {type(action).__name__}")
        if set(action.keys()) != wanted:
            raise ValueError(f"the action must be a dict of {sorted(wanted)}, got {sorted(map(str, action.keys()))}")


class Box(ActionFormat):
    """A number in [-1, 1] for every part: a categorical one is cut into equal stretches, a delta is the number itself.

    Numbers beyond [-1, 1] count as the nearest end, as Gaussian policies go beyond now and then; NaN is an error.
    """

    def __init__(self, nvec: tuple[int, ...], deltas: int, bins: int) -> None:
        super().__init__(nvec, deltas, bins)
        self.parts = self.groups + deltas
        self.space = _box(self.parts)

    def one(self, action: Any) -> Rows:
        return self._cut(_shaped(_numbers(action, "the action", np.float64), (self.parts,), "the action")[None])

    def many(self, actions: Any, lanes: int) -> Rows:
        return self._cut(_shaped(_numbers(actions, "actions", np.float64), (lanes, self.parts), "actions"))

    def _cut(self, rows: np.ndarray) -> Rows:
        wrong = np.isnan(rows)
        if wrong.any():
            lane, part = np.argwhere(wrong)[0]
            raise self._wrong(rows, lane, part, "nan", "a number in [-1, 1]")
        rows = np.clip(rows, -1.0, 1.0)
        stretches = np.floor((rows[:, : self.groups] + 1.0) / 2.0 * self.nvec).astype(np.int64)
        deltas = rows[:, self.groups :].astype(np.float32) if self.deltas else None
        return np.minimum(self.nvec - 1, stretches), deltas


_FORMATS: dict[str, type[ActionFormat]] = {
    "multi_discrete": MultiDiscrete,
    "tuple": Tuple,
    "dict": Dict,
    "discrete": Discrete,
    "box": Box,
}


def action_format(name: str, nvec: tuple[int, ...], deltas: int, bins: int) -> ActionFormat:
    """Returns the format of a name, for an action space of so many choices a part (nvec) and so many deltas, cut into bins where need be."""
    return _FORMATS[name](nvec, deltas, bins)
