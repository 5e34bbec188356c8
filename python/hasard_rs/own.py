"""Own scenarios: a task is one file, or the same as a dictionary. docs/guide/own_task.md has the whole format."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hasard_rs import _core
from hasard_rs.arguments import of_level, plain
from hasard_rs.errors import InvalidOption


@dataclass(frozen=True)
class OwnScenario:
    """A scenario from a file or a dictionary, known by its ids from now on.

    path: where its text was, or a name for it; text: all of it, TOML; ids: an id a level, with `hasard/`.
    """

    path: str
    text: str
    ids: tuple[str, ...]

    def make(self, level: int = 1, **arguments: Any) -> Any:
        """Returns its environment of a `level` in a `CostWrapper`; `arguments` as of `hasard_rs.make`."""
        import hasard_rs

        return hasard_rs.make(self._id(level), **arguments)

    def make_vec(self, num_envs: int = 1, level: int = 1, **arguments: Any) -> Any:
        """Returns a `VectorEnv` of `num_envs` lanes of a `level`; `arguments` as of `hasard_rs.make_vec`."""
        import hasard_rs

        return hasard_rs.make_vec(self._id(level), num_envs, **arguments)

    def _id(self, level: int) -> str:
        """The id of a level, which is this scenario's again if another of its name was made since, or in another process."""
        known = from_text(self.text, self.path).ids
        return of_level(known, level, self.path)


def is_file(env_id: Any) -> bool:
    """Returns whether `env_id` is a scenario's file: a path that ends in `.toml`, perhaps with `#2` for its second level."""
    return isinstance(env_id, os.PathLike) or (isinstance(env_id, str) and env_id.partition("#")[0].lower().endswith(".toml"))


def from_text(text: str, path: str = "scenario.toml") -> OwnScenario:
    """Makes the environments of a scenario's text known, to Gymnasium too.

    Args:
        text: TOML.
        path: what messages call it.

    Returns:
        The scenario. The last one of a name counts.

    Raises:
        InvalidOption with the first mistake, its line and column.
    """
    ids = tuple(f"hasard/{env_id}" for env_id in _core.register_scenario(path, text))
    try:
        import gymnasium
    except ImportError:  # Worlds works without.
        return OwnScenario(path, text, ids)
    name = scenario_and_level(ids[0])[0]
    # A scenario of that name may have had other levels.
    for former in [known for known, spec in gymnasium.registry.items() if _file_of(spec) and spec.kwargs["scenario"] == name]:
        del gymnasium.registry[former]
    for index, env_id in enumerate(ids):
        gymnasium.register(
            env_id,
            entry_point="hasard_rs.env:entry",
            vector_entry_point="hasard_rs.vector:VectorEnv",
            # The text goes along, so that another process makes the same.
            kwargs={"scenario": name, "level": index + 1, "scenario_file": [path, _Text(text)]},
            nondeterministic=False,
            disable_env_checker=True,
        )
    return OwnScenario(path, text, ids)


def _file_of(spec: Any) -> Any:
    """The path and text of an environment's file, if Gymnasium's `spec` is of one; else None."""
    return spec.kwargs.get("scenario_file") if spec.kwargs.get("scenario") else None


@contextmanager
def names_kept(arguments: dict[str, Any]) -> Iterator[None]:
    """While an environment is made from its `arguments`, by a copy or a pickle too, its own text goes by its name; afterwards the last one that
    was made known by that name does again. Returns what `with` takes."""
    tasks = arguments.get("tasks") or [arguments]
    own = {task["scenario"]: task["scenario_file"] for task in tasks if task.get("scenario_file") and task.get("scenario")}
    if not own:
        yield
        return
    try:
        import gymnasium

        known = {spec.kwargs["scenario"]: _file_of(spec) for spec in gymnasium.registry.values() if _file_of(spec)}
    except ImportError:
        known = {}
    try:
        yield
    finally:
        for name, (path, text) in own.items():
            if name in known and known[name][1] != text:
                path, text = known[name]
                _core.register_scenario(path, text)
            elif name not in known:
                from_text(text, path)


class _Text(str):
    """A file's text. Gymnasium's errors show an environment's arguments, where the whole of it would bury what is wrong."""

    __slots__ = ()

    def __repr__(self) -> str:
        return f"<{len(self)} characters>"


def from_file(path: str | os.PathLike[str]) -> OwnScenario:
    """Reads the scenario's file at `path`. Returns the scenario. Raises InvalidOption with the first mistake, its line and column."""
    place = os.fspath(Path(path))
    return from_text(_core.read_scenario(place), place)


def from_dict(table: dict[str, Any], path: str = "scenario.toml") -> OwnScenario:
    """Makes a scenario of `table`, a dictionary with the fields of a file; `path` is what messages call it.

    Returns and raises as `from_text`; TypeError for what TOML cannot hold.
    """
    if not isinstance(table, dict):
        raise TypeError(f"a scenario's table must be a dict, got {table!r:.60}")
    return from_text("".join(f"{_key(name)} = {_value(value)}\n" for name, value in plain(table).items()), path)


def opened(env_id: Any) -> str:
    """Reads the file that `env_id` names, `my_task.toml` or `my_task.toml#2`. Returns the id that it has from now on.

    Raises InvalidOption for a level that it does not have, and as `from_file`.
    """
    path, _, level = os.fspath(env_id).partition("#")
    scenario = from_file(path)
    known = {str(number + 1): name for number, name in enumerate(scenario.ids)}
    if (level or "1") not in known:
        raise InvalidOption(f"{path}#{level}: its levels are 1 to {len(known)}")
    return known[level or "1"]


def scenario_and_level(env_id: str) -> tuple[str, int]:
    """Splits an `env_id`. Returns `RemedyRush` and 2 for `hasard/RemedyRushLevel2-v0`; an id without a level has level 1."""
    name, found, level = env_id.removeprefix("hasard/").removesuffix("-v0").rpartition("Level")
    return (name, int(level)) if found and level.isdigit() else (f"{name}{found}{level}", 1)


def _key(name: Any) -> str:
    if not isinstance(name, str):
        raise TypeError(f"a field's name must be a str, got {name!r:.60}")
    return _value(name)


def _value(value: Any) -> str:
    """The TOML of a value."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(name)} = {_value(inner)}" for name, inner in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_value, value)) + "]"
    raise TypeError(f"a scenario's fields are text, numbers, true or false, lists and dicts, not {value!r:.60}")
