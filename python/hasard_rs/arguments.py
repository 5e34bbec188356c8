"""Keyword arguments of environments: those of the worlds, and those of Gymnasium's side of them."""

from __future__ import annotations

import difflib
import enum
import operator
import os
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hasard_rs import _core
from hasard_rs.errors import InvalidOption

_WORLD = (
    "rules early_creatures hard_constraint hard full_actions frame_skip resolution size observation layout frame_stack max_episode_steps "
    "safety_budget iwad maps map published_depth published_colours"
).split()
_UPSTREAM = "record_every render_boxes render_segmented".split()
_VECTOR = "num_envs num_threads autoreset_mode batch_size copy".split()
# What an id stands for.
_TASK = ("scenario", "level", "scenario_file", "tasks")
_WHOLE = ("frame_skip", "frame_stack", "max_episode_steps", "num_envs", "num_threads")

_NAMES = {"hard": "hard_constraint", "size": "resolution", "map": "maps"}
"""The first name of each argument that has two."""

RENDER_MODES = ("rgb_array", "depth_array")
ACTION_FORMATS = ("multi_discrete", "tuple", "dict", "discrete", "box")


@dataclass
class Arguments:
    """What an environment is made with, sorted by who reads it."""

    env_id: str
    world: dict[str, Any] = field(default_factory=dict)
    action_format: str = "multi_discrete"
    delta_bins: int = 11
    render_mode: str | None = None
    render_resolution: Any = None
    seed: int | None = None
    infos: str = "cost"
    env_stats: bool = False

    @property
    def frame_skip(self) -> int:
        """Tics that an action is held."""
        return int(self.world.get("frame_skip", 4))

    @property
    def hard_constraint(self) -> bool:
        """Whether the constraint is the hard one."""
        return bool(self.world.get("hard_constraint", self.world.get("hard", False)))

    def without(self, where: str, *names: str) -> Arguments:
        """Makes sure that nothing is dropped in silence.

        Args:
            where: who has no use for them, for the message.
            names: of these arguments.

        Returns:
            The same arguments.

        Raises:
            InvalidOption where one of them was given.
        """
        usual = Arguments("")
        for name in names:
            if getattr(self, name) != getattr(usual, name):
                raise InvalidOption(f"{name} has no effect in {where}; leave it out")
        return self


def refuse_task(given: Iterable[str]) -> None:
    """Makes sure that nobody asks for another task than the id's; `given` are names of arguments. Raises TypeError, which names the first."""
    for name in given:
        if name in _TASK:
            raise TypeError(f"argument '{name}' is bound by the id; leave it out, and give another id for another task")


def for_make(given: dict[str, Any]) -> dict[str, Any]:
    """Returns arguments `given` for an id as Gymnasium's `make` takes them: of integers none but Python's.

    Raises what `refuse_task` does."""
    refuse_task(given)
    limit: Any = given.get("max_episode_steps")
    return {**given, "max_episode_steps": int(limit)} if is_whole(limit) else given


def over(usual: dict[str, Any], given: dict[str, Any]) -> dict[str, Any]:
    """Returns the arguments `given`, and of the `usual` ones those that are not given, by either of their names."""
    named = {_NAMES.get(name, name) for name in given}
    return {**{name: value for name, value in usual.items() if _NAMES.get(name, name) not in named}, **given}


def read(given: dict[str, Any], *, vector: bool) -> Arguments:
    """Sorts keyword arguments.

    Args:
        given: by name, scenario and level among them.
        vector: whether those of batches are known too.

    Returns:
        The arguments, checked but for those of the worlds, which check theirs.

    Raises:
        TypeError for a name that is no argument, which names the nearest; InvalidOption for a value that it cannot have.
    """
    given = dict(given)
    tasks = given.pop("tasks", None) if vector else None
    if tasks is None:
        tasks = [{name: given.pop(name) for name in ("scenario", "level", "scenario_file") if name in given}]
    arguments = Arguments(env_id=",".join(map(_env_id, tasks)))
    own = [name for name in vars(arguments) if name not in ("env_id", "world")]
    for name, value in given.items():
        if name in _WORLD:
            if name in ("maps", "map", "iwad") and isinstance(value, str) and not value:
                raise InvalidOption(f"{name} cannot be ''; it must be a path, 'auto', or None")
            arguments.world[name] = value
        elif name in own:
            setattr(arguments, name, value)
        elif name in _UPSTREAM:
            warnings.warn(f"{name} has no effect here", DeprecationWarning, stacklevel=4)
        else:
            known = [*_WORLD, *own, *(_VECTOR if vector else [])]
            if name in known:
                raise TypeError(f"argument '{name}' is not to be chosen here; leave it out")
            near = difflib.get_close_matches(name, known, 1, 0.5)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise TypeError(f"unexpected keyword argument '{name}'{hint}")
    _check(arguments)
    return arguments


def _env_id(task: dict[str, Any]) -> str:
    """The id of a task's `scenario` and `level`; with `scenario_file`, its path and text, that scenario is known in this process from now on."""
    try:
        scenario, level = task["scenario"], task["level"]
    except KeyError as missing:
        raise TypeError(f"missing keyword argument {missing}; hasard_rs.make takes an id, which has both") from None
    scenario = getattr(scenario, "value", scenario)
    file = task.get("scenario_file")
    if file is None:
        return f"{scenario}Level{level}-v0"
    return of_level(_core.register_scenario(*file), level, scenario)


def of_level(ids: Sequence[str], level: Any, name: str) -> str:
    """Returns the id of a `level` among `ids`, those of the scenario `name`. Raises InvalidOption for a level that it does not have."""
    if not is_whole(level) or not 1 <= level <= len(ids):
        raise InvalidOption(f"level cannot be {level!r}; the levels of {name} are 1 to {len(ids)}")
    return ids[operator.index(level) - 1]


def _check(arguments: Arguments) -> None:
    def one_of(name: str, allowed: tuple[Any, ...]) -> None:
        value = getattr(arguments, name)
        if not any(value is choice or (isinstance(value, str) and value == choice) for choice in allowed):
            raise InvalidOption(f"{name} cannot be {value!r}; it must be {' or '.join(map(repr, allowed))}")

    one_of("action_format", ACTION_FORMATS)
    one_of("render_mode", (None, *RENDER_MODES))
    one_of("infos", ("cost", "full", "events"))
    if not isinstance(arguments.env_stats, (bool, np.bool_)):
        raise InvalidOption(f"env_stats cannot be {arguments.env_stats!r}; it must be True or False")
    if arguments.infos == "events":
        arguments.world["events"] = True
    check_no_bools(arguments.world)
    bins = arguments.delta_bins
    if not is_whole(bins) or not 3 <= bins <= 255 or bins % 2 == 0:
        raise InvalidOption(f"delta_bins cannot be {bins!r}; it must be an odd number, 3..255")
    arguments.delta_bins = operator.index(bins)
    if arguments.render_resolution is not None:
        arguments.render_resolution = _core.frame_size("render_resolution", arguments.render_resolution)
    if arguments.seed is not None:
        arguments.seed = check_seed(arguments.seed)


def check_no_bools(given: dict[str, Any]) -> None:
    """Makes sure that True is not taken for 1 in the arguments `given`, by name. Raises InvalidOption where a number is asked for."""
    for name in _WHOLE:
        if isinstance(given.get(name), (bool, np.bool_)):
            raise InvalidOption(f"{name} cannot be {given[name]!r}; it must be a whole number")


def plain(value: Any) -> Any:
    """Returns a value of an argument as JSON can hold it: text, numbers, lists and dicts instead of enums, paths and NumPy's kinds."""
    if isinstance(value, enum.Enum):
        return plain(value.value)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, dict):
        return {name: plain(one) for name, one in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(plain(one) for one in value)
    return value


def is_whole(value: Any) -> bool:
    """Returns whether a `value` is one integer, NumPy's too; True and False are none."""
    if isinstance(value, (bool, np.bool_)):
        return False
    try:
        operator.index(value)
    except TypeError:
        return False
    return True


def is_number(seed: Any) -> bool:
    """Returns whether a `seed` is one integer, not one a lane: an array without axes too."""
    return hasattr(seed, "__index__") and np.ndim(seed) == 0


def check_seed(seed: Any) -> int:
    """Returns a seed as an int modulo 2^64. Raises ValueError for a negative one, TypeError for anything but an integer."""
    if not hasattr(seed, "__index__"):
        raise TypeError(f"a seed must be an integer, got {seed!r:.60}")
    seed = seed.__index__()
    if seed < 0:
        raise ValueError(f"a seed must not be negative, got {seed}")
    return seed & (2**64 - 1)
