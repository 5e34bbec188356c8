"""What the single environment and the batch share: facts as attributes, pictures, the spec, and what a pickle keeps."""

from __future__ import annotations

import copy
import sys
from typing import Any

import gymnasium
import numpy as np

from hasard_rs._core import Worlds
from hasard_rs.arguments import Arguments, plain
from hasard_rs.own import scenario_and_level
from hasard_rs.registry import CostTerm

# Made anew from the arguments, where a pickle is read.
_MADE_ANEW = ("_worlds", "_infos", "_format", "_given", "_arguments")


def frame_size(worlds: Worlds, given: Arguments) -> Any:
    """Returns what `render` draws in these `worlds`: the size that is `given` for it, or that of observations, (width, height)."""
    if given.render_resolution is not None:
        return given.render_resolution
    shape = worlds.observation_shape
    height, width = shape[1:] if given.world.get("layout") == "chw" else shape[:2]
    return width, height


class Shared:
    """Attributes and the spec of an environment, or of a batch of them."""

    metadata: dict[str, Any]
    _arguments: dict[str, Any]
    _given: Arguments
    _worlds: Worlds
    _spec: Any = None

    def _describe(self, **more: Any) -> None:
        """Sets the attributes that follow from the arguments; `more` goes into the metadata."""
        given, worlds = self._given, self._worlds
        self.render_mode = given.render_mode
        # Lists of its own: some of Gymnasium's wrappers append to them.
        self.metadata = {**copy.deepcopy(type(self).metadata), "render_fps": 35 / given.frame_skip, **more}
        # Of a batch of different tasks one a lane, and no extent.
        mixed = "," in given.env_id
        budgets = np.asarray(worlds.safety_budgets)
        self.safety_budget: float | np.ndarray = budgets[worlds.lane_tasks] if mixed else worlds.safety_budget
        self.cost_terms = tuple(CostTerm(name, counted) for name, counted in worlds.cost_terms)
        self.max_episode_steps: int = worlds.episode_steps
        self.extent: tuple[int, int, int, int] | None = worlds.extent
        names: list[Any] = [scenario_and_level(env_id) for env_id in given.env_id.split(",")]
        self.scenario_name: Any = names[0][0]
        self.level: Any = names[0][1]
        if mixed:
            self.scenario_name, self.level = zip(*names, strict=True)
        self.hard_constraint, self.frame_skip = given.hard_constraint, given.frame_skip

    @property
    def spec(self) -> gymnasium.envs.registration.EnvSpec | None:
        """How to make it again, by `gymnasium.make` or `make_vec`, through JSON too, as Gymnasium has given it; `max_episode_steps` is the limit
        of an episode."""
        return self._spec

    @spec.setter
    def spec(self, given: Any) -> None:
        """Takes what Gymnasium has `given`, its values as JSON can hold them. Raises InvalidOption for a limit of steps that cannot be, TypeError for
        a scenario or level that is not the id's."""
        if given is not None:
            _check_task(given.id, self.scenario_name, self.level)
            self._limit(_asked_limit(sys._getframe(1), given))
            given = copy.copy(given)
            if given.entry_point == f"{type(self).__module__}:entry":
                # A wrapper that the entry point adds has a place of its own in a spec.
                given.entry_point = f"{type(self).__module__}:{type(self).__name__}"
            given.kwargs, given.max_episode_steps = plain(given.kwargs), self.max_episode_steps
        self._spec = given

    def _limit(self, steps: Any) -> None:
        """Has episodes end after so many steps, natively, where Gymnasium was asked for it. A batch is asked directly."""

    def _kept(self) -> dict[str, Any]:
        """What of this object a pickle keeps as it is, beside the arguments and where the worlds are."""
        return {name: value for name, value in self.__dict__.items() if name not in _MADE_ANEW}


def _check_task(env_id: str, scenario: str, level: int) -> None:
    """Raises TypeError for a scenario or level that is not the id's; ids of one's own may have any."""
    if env_id.startswith("hasard/") and scenario_and_level(env_id) != (scenario, level):
        raise TypeError(f"scenario and level are bound by the id; {env_id} cannot be {scenario} {level}: ask for that id")


def _asked_limit(frame: Any, given: Any) -> Any:
    """The limit that `gymnasium.make` is about to enforce by a TimeLimit around the environment.

    A TimeLimit says nothing to the environment within, whose last step would then have no summary of the episode, and no environment is given
    `max_episode_steps`: `make` keeps it to itself. It sets the spec right after it has made the environment, and that is where it can be seen.
    """
    if frame.f_code is not gymnasium.make.__code__:
        return None
    asked = frame.f_locals.get("max_episode_steps")
    registered = getattr(frame.f_locals.get("env_spec"), "max_episode_steps", None)
    return registered if asked is None else asked
