"""Infos of a batch: columns of a value a lane, each with a mask under its name after an underscore, as Gymnasium's vector environments have."""

from __future__ import annotations

from typing import Any

import numpy as np

from hasard_rs.events import Events

Infos = dict[str, Any]
"""Columns by name; a dict of columns where a key holds several."""


def put(infos: Infos, key: str, column: Any, mask: np.ndarray) -> None:
    """Puts a column into `infos` under a key, zero where the mask is not."""
    if isinstance(column, dict):
        inner: Infos = {}
        for name, values in column.items():
            put(inner, name, values, mask)
        infos[key] = inner
    elif mask.all():
        infos[key] = column
    else:
        nothing = np.full_like(column, None) if column.dtype == object else np.zeros_like(column)
        infos[key] = np.where(mask.reshape(-1, *[1] * (column.ndim - 1)), column, nothing)
    infos[f"_{key}"] = mask.copy()


def add(infos: Infos, info: dict[str, Any], index: int, count: int) -> None:
    """Puts one lane's values, an `info` as of a single environment, into row `index` of `infos`, columns of `count` rows."""
    for key, value in info.items():
        if isinstance(value, dict):
            add(infos.setdefault(key, {}), value, index, count)
        else:
            # Events are as many as they are in each lane, and have no common shape.
            several = isinstance(value, Events)
            value = value if several else np.asarray(value)
            column = infos.setdefault(key, np.full(count, None, object) if several else np.zeros((count, *value.shape), value.dtype))
            column[index] = value
        infos.setdefault(f"_{key}", np.zeros(count, np.bool_))[index] = True


def cut(infos: Infos, rows: slice) -> Infos:
    """Returns copies of some rows of all columns of `infos`."""
    return {key: cut(column, rows) if isinstance(column, dict) else column[rows].copy() for key, column in infos.items()}


def replaced(infos: Infos, others: Infos, mask: np.ndarray) -> Infos:
    """Returns `infos` with the rows of `others` where the mask is. What only `infos` have, such as how an episode ended, is not true of those rows."""
    result: Infos = {}
    for key, column in infos.items():
        if key.startswith("_"):
            continue
        if key not in others:
            kept = infos[f"_{key}"] & ~mask
            if kept.any():
                result[key], result[f"_{key}"] = _hidden(column, mask), kept
            continue
        if isinstance(column, dict):
            result[key] = replaced(column, others[key], mask)
        else:
            result[key] = np.where(mask.reshape(-1, *[1] * (column.ndim - 1)), others[key], column)
        result[f"_{key}"] = infos[f"_{key}"] | mask
    return result


def _hidden(column: Any, mask: np.ndarray) -> Any:
    """A column with nothing in the rows of a mask."""
    if isinstance(column, dict):
        return {name: values & ~mask if name.startswith("_") else _hidden(values, mask) for name, values in column.items()}
    column = column.copy()
    column[mask] = None if column.dtype == object else 0
    return column
