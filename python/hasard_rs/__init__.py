"""HASARD: vision-based safe reinforcement learning in Doom-like 3D worlds, written in Rust.

    import hasard_rs

    env = hasard_rs.make("hasard/RemedyRushLevel1-v0")
    observation, info = env.reset(seed=7)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    print(reward, info["cost"])

`make_vec` gives a batch of worlds that Rust steps; `Worlds` the same without Gymnasium. docs/python.md has a recipe for each library.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from hasard_rs import arguments as _arguments
from hasard_rs._core import Batch, Worlds, __version__
from hasard_rs.agent import Agent, Run, report, train
from hasard_rs.errors import (
    Closed,
    HasardError,
    InvalidAction,
    InvalidMap,
    InvalidOption,
    OutOfTurn,
    ResetNeeded,
    UnknownEnvironment,
    WorldPanicked,
)
from hasard_rs.events import Cause, Event, Events, Thing
from hasard_rs.own import OwnScenario, is_file
from hasard_rs.registry import LEVELS, CostTerm, Scenario, Spec, bare, ids, register_all, register_environment, spec

try:
    import gymnasium as _gymnasium
except ImportError:  # Worlds works without.
    _gymnasium = None  # type: ignore[assignment]
else:
    from hasard_rs.env import Env
    from hasard_rs.vector import VectorEnv

    register_all()

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Sequence

    import gymnasium


def make(env_id: str | os.PathLike[str], **kwargs: Any) -> gymnasium.Env[Any, Any]:
    """An environment in a `CostWrapper`, as `gymnasium.make` makes it.

    Args:
        env_id: one of `ids()`, with or without `hasard/`; `module:id` imports the module first; or a task of your own, `my_task.toml`.
        kwargs: keyword arguments, listed in `help(hasard_rs.Env)`, and those of `gymnasium.make`.

    Returns:
        A Gymnasium environment; `.unwrapped` is the `hasard_rs.Env`.

    Raises:
        UnknownEnvironment, which names the nearest id; InvalidOption for a value that an argument cannot have; InvalidMap for maps that cannot be
        played; TypeError for a name that is no argument, or bound by the id (scenario, level).
    """
    from hasard_rs.wrappers.cost import CostWrapper

    kwargs = _arguments.for_make(kwargs)
    made = _gymnasium.make(f"hasard/{_known(env_id)}", **kwargs)
    # The environment itself ends episodes at their limit. Gymnasium's wrapper would call an end at the last step cut off too.
    return CostWrapper(made.env if isinstance(made, _gymnasium.wrappers.TimeLimit) else made)


def make_vec(env_id: str | os.PathLike[str] | Sequence[str | os.PathLike[str]], num_envs: int = 1, **kwargs: Any) -> VectorEnv:
    """A native vector environment, as `gymnasium.make_vec` makes it.

    Args:
        env_id: one of `ids()`, with or without `hasard/`; `module:id` imports the module first; a task of your own, `my_task.toml`; or a list of
            them, which the lanes take in turn (`help(hasard_rs.VectorEnv)`).
        num_envs: lanes, 1 to 65536.
        kwargs: keyword arguments, listed in `help(hasard_rs.Env)` and, of batches only, in `help(hasard_rs.VectorEnv)`.

    Returns:
        A `hasard_rs.VectorEnv`.

    Raises:
        What `make` raises; ImportError with a Gymnasium older than 1.1.
    """
    if not hasattr(_gymnasium, "make_vec") or not hasattr(_gymnasium.vector, "AutoresetMode"):
        raise ImportError("make_vec needs Gymnasium 1.1 or newer: pip install -U gymnasium; make and Worlds work with older ones")
    _arguments.refuse_task(kwargs)
    if isinstance(env_id, (list, tuple)) and len(env_id) != 1:
        tasks = [_task(one) for one in env_id]
        if not tasks:
            raise InvalidOption("a batch needs a task; the list of ids is empty")
        texts: dict[str, str] = {}
        for task in tasks:
            text = task.get("scenario_file", ["", ""])[1]
            if texts.setdefault(task["scenario"], text) != text:
                raise InvalidOption(f"two tasks of the batch are called {task['scenario']}; give one of them another name")
        return VectorEnv(tasks=tasks, num_envs=num_envs, **kwargs)
    known = _known(cast("str", env_id[0] if isinstance(env_id, (list, tuple)) else env_id))
    made = _gymnasium.make_vec(f"hasard/{known}", num_envs=num_envs, vectorization_mode="vector_entry_point", **kwargs)
    return cast("VectorEnv", made)


def _task(env_id: str | os.PathLike[str], given: Iterable[str] = ()) -> dict[str, Any]:
    """What makes an environment: scenario, level, and the text of a task of one's own; none of them may be among the arguments `given`."""
    _arguments.refuse_task(given)
    return dict(_gymnasium.spec(f"hasard/{_known(env_id)}").kwargs)


def _known(env_id: str | os.PathLike[str]) -> str:
    """The bare id, if it is one; else the error that names the nearest."""
    known = spec(env_id)
    return bare(known.id if is_file(env_id) else cast("str", env_id))


__all__ = [
    "LEVELS",
    "Agent",
    "Batch",
    "Cause",
    "Closed",
    "CostTerm",
    "Env",
    "Event",
    "Events",
    "HasardError",
    "InvalidAction",
    "InvalidMap",
    "InvalidOption",
    "OutOfTurn",
    "OwnScenario",
    "ResetNeeded",
    "Run",
    "Scenario",
    "Spec",
    "Thing",
    "UnknownEnvironment",
    "VectorEnv",
    "WorldPanicked",
    "Worlds",
    "__version__",
    "ids",
    "make",
    "make_vec",
    "register_environment",
    "report",
    "spec",
    "train",
]
