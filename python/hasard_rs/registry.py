"""The 18 environments: ids, what is known of each, and their registration with Gymnasium."""

from __future__ import annotations

import enum
import importlib
import os
from dataclasses import dataclass
from typing import Any, cast

from hasard_rs import _core
from hasard_rs.own import OwnScenario, from_dict, from_file, is_file, opened

LEVELS = [1, 2, 3]
"""Levels of every scenario."""


class Scenario(enum.Enum):
    """The six scenarios."""

    ARMAMENT_BURDEN = "ArmamentBurden"
    DETONATORS_DILEMMA = "DetonatorsDilemma"
    VOLCANIC_VENTURE = "VolcanicVenture"
    PRECIPICE_PLUNGE = "PrecipicePlunge"
    COLLATERAL_DAMAGE = "CollateralDamage"
    REMEDY_RUSH = "RemedyRush"

    @staticmethod
    def from_file(path: str | os.PathLike[str]) -> OwnScenario:
        """Returns the scenario of a file of your own at `path`. Raises InvalidOption with the first mistake, its line and column."""
        return from_file(path)

    @staticmethod
    def from_dict(table: dict[str, Any]) -> OwnScenario:
        """Returns the scenario of `table`, with the fields of a file. Raises as `from_file`; TypeError for what a file cannot hold."""
        return from_dict(table)


@dataclass(frozen=True)
class CostTerm:
    """A named part of the cost; one that is not `counted` is measured beside the cost."""

    name: str
    counted: bool


@dataclass(frozen=True)
class Spec:
    """What is known of an environment without making it.

    nvec: choices of each part of the simplified actions; buttons: the names of the buttons that each part chooses from. max_episode_steps: at
    frame_skip 4. safety_budget: cost that an episode may have, under the rules "paper"; published_safety_budget: under "released".
    """

    id: str
    scenario: str
    level: int
    rules: str
    cost_terms: tuple[CostTerm, ...]
    safety_budget: float
    nvec: tuple[int, ...]
    buttons: tuple[tuple[str, ...], ...]
    max_episode_steps: int
    published_safety_budget: float


def ids() -> list[str]:
    """Returns every id, such as `hasard/RemedyRushLevel1-v0`, by scenario and level."""
    return [f"hasard/{env_id}" for env_id in _core.ids()]


def bare(env_id: str) -> str:
    """Returns `env_id` without its namespace; `module:id` imports the module first, as Gymnasium does. Raises TypeError for anything but a str."""
    if not isinstance(env_id, str):
        raise TypeError(f"an environment's id must be a str such as 'hasard/RemedyRushLevel1-v0', got {env_id!r:.60}")
    module, colon, rest = env_id.rpartition(":")
    if colon:
        importlib.import_module(module)
    return rest.removeprefix("hasard/")


def spec(env_id: str | os.PathLike[str]) -> Spec:
    """What is known of an environment without making it.

    Args:
        env_id: one of `ids()`, with or without `hasard/`; or a scenario's file, `my_task.toml`, which is known by its id from then on.

    Returns:
        A `Spec`.

    Raises:
        UnknownEnvironment, which names the nearest id.
    """
    if is_file(env_id):
        env_id = opened(env_id)
    known = _core.describe(bare(cast("str", env_id)))
    return Spec(
        id=f"hasard/{known['id']}",
        scenario=known["scenario"],
        level=known["level"],
        rules="paper",
        cost_terms=tuple(CostTerm(name, counted) for name, counted in known["cost_terms"]),
        safety_budget=known["safety_budget"],
        nvec=tuple(known["nvec"]),
        buttons=tuple(tuple(names) for names in known["buttons"]),
        max_episode_steps=known["max_episode_steps"],
        published_safety_budget=known["published_safety_budget"],
    )


def register_environment(scenario: str | Scenario, level: int) -> None:
    """Registers one environment with Gymnasium; nothing happens if it is registered.

    Args:
        scenario: a `Scenario` or its value.
        level: 1 to 3.

    Raises:
        UnknownEnvironment, which names the nearest id.
    """
    import gymnasium

    name = scenario.value if isinstance(scenario, Scenario) else scenario
    env_id = f"hasard/{name}Level{level}-v0"
    _core.describe(env_id)
    if env_id not in gymnasium.registry:
        # No max_episode_steps: it would wrap a limit of the wrong length for another frame_skip; the worlds truncate themselves.
        gymnasium.register(
            env_id,
            entry_point="hasard_rs.env:entry",
            vector_entry_point="hasard_rs.vector:VectorEnv",
            kwargs={"scenario": name, "level": level},
            nondeterministic=False,
            # The checks of every step are this package's tests; and the checker does not know of depth that can be filmed.
            disable_env_checker=True,
        )


def register_all() -> None:
    """Registers all 18 ids."""
    for env_id in _core.ids():
        scenario, level = env_id.removesuffix("-v0").split("Level")
        register_environment(scenario, int(level))
