"""The single environment."""

from __future__ import annotations

import copy
import secrets
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import logger, spaces

from hasard_rs import arguments as _arguments
from hasard_rs._core import Worlds
from hasard_rs.common import Shared, frame_size
from hasard_rs.infos import Infos, row, summary
from hasard_rs.own import names_kept, scenario_and_level
from hasard_rs.spaces import action_format
from hasard_rs.wrappers.drawable import Drawable


class Env(Shared, gymnasium.Env[np.ndarray, Any]):
    """One world with its task, as Gymnasium's single environment.

    Made by `hasard_rs.make(id, **arguments)` or `gymnasium.make(id, **arguments)`.

    Args:
        arguments: all keyword-only, the same for `VectorEnv` and (but for those of actions, rendering and infos) `Worlds`.
            scenario, level, scenario_file: bound by the id.
            rules ("paper"): or "released", those of the published package, or "tables", those of the code behind the paper's tables.
            early_creatures (False): in Detonator's Dilemma 1 under "tables", the creatures that the first of the paper's runs met.
            hard_constraint, or hard (False): a violation ends the episode; in Armament Burden it takes the burden and slows the agent.
            full_actions (False): all buttons, and two continuous axes.
            frame_skip (4): tics of 1/35 s that an action is held, 1 to 35.
            resolution, or size ("160x120"): "WxH" or (width, height), a list too, pixels, 64x48 to 1920x1080.
            observation ("rgb"): "rgb+depth", "segmented" or "grey"; 3, 4, 3 or 1 channels.
            layout ("hwc"): or "chw". frame_stack (1): frames along the channels, oldest first, 1 to 16.
            action_format ("multi_discrete"): "tuple", "dict", "discrete" or "box".
            delta_bins (11): of each continuous axis where the format has none, odd, 3 to 255.
            max_episode_steps (None): cuts episodes off earlier; `spec.max_episode_steps` and the attribute say what holds.
            render_mode (None): "rgb_array" or "depth_array". render_resolution (None): of `render`, if other than resolution.
            seed (None): of the first reset without one; 64 bits of the operating system's if None.
            infos ("cost"): "full" adds "cost_terms" (float64 [k]), "position" (int32 [2], map units) and "episode_seed" (uint64); "events" adds
                to those "events", what happened in the step: `Events`, used as a structured array of tic, kind (`Event`), what and by (`Thing`), player, cause
                (`Cause`), x, y (map units) and amount, -1 where there is none.
            env_stats (False): adds "env_stats", a dict of floats by name.
            safety_budget (None): an attribute, without effect on the world.
            maps, or map (None): a folder, a WAD, or "auto" for the published package's. iwad (None): a file, or "auto".
            published_depth, published_colours (False): depth and segments look as ViZDoom's.

    Raises:
        UnknownEnvironment, InvalidOption (two names of one argument that contradict each other, too), InvalidMap, or TypeError for a name that
        is no argument.

    Attributes:
        observation_space: `Box(0, 255, (height, width, channels * frame_stack), uint8)`, or channels first with `layout="chw"`.
        action_space: as action_format says. extent: x from, y from, x to, y to of the map, map units.
        safety_budget: cost that an episode may have, 0 under the hard constraint. cost_terms: a `CostTerm` each. max_episode_steps: steps of
            an episode that only time ends.
        scenario_name, level, hard_constraint, frame_skip: as it was made. spec: Gymnasium's, which makes it again, through JSON too.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array", "depth_array"], "render_fps": 8.75}  # type: ignore[misc]

    def __init__(self, **arguments: Any) -> None:
        self._build(arguments)

    def _build(self, arguments: dict[str, Any]) -> None:
        with names_kept(arguments):
            given = _arguments.read(arguments, vector=False)
            self._arguments, self._given = arguments, given
            self._worlds = Worlds(given.env_id, 1, num_threads=0, autoreset_mode="Disabled", statistics=given.env_stats, **given.world)
        self._format = action_format(given.action_format, self._worlds.nvec, self._worlds.num_deltas, given.delta_bins)
        self._infos = Infos(self._worlds, scenario_and_level(given.env_id)[0], given.infos, given.env_stats)
        self.action_space = self._format.space
        self.observation_space = spaces.Box(0, 255, self._worlds.observation_shape, np.uint8)
        self._describe()

    def _limit(self, steps: Any) -> None:
        # -1 is Gymnasium's word for none.
        if steps is None or steps == -1 or steps == self.max_episode_steps:
            return
        own = self._arguments.get("max_episode_steps")
        self._worlds.close()
        self._build({**self._arguments, "max_episode_steps": steps if own is None else min(own, steps)})

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts an episode.

        Args:
            seed: starts the stream of episodes anew, not negative, taken modulo 2^64. None: the next episode of the stream.
            options: none are known.

        Returns:
            The first observation (uint8, of observation_space's shape) and its info: "cost" (float64) is 0.0.

        Raises:
            TypeError or ValueError for a seed that is none; Closed after `close`.
        """
        if seed is not None:
            seed = _arguments.check_seed(seed)
        elif not self._worlds.started:
            seed = self._given.seed if self._given.seed is not None else secrets.randbits(64)
        super().reset(seed=seed)
        batch = self._worlds.reset(seed)
        self._infos.begin(0)
        return batch.observations[0], row(self._infos.step(batch), 0)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Holds an action for `frame_skip` tics.

        Args:
            action: one of action_space; any integer dtype, lists too.

        Returns:
            (observation, reward: float, terminated: bool, truncated: bool, info). `info["cost"]` (float64) is the cost of this step; the step that
            ends an episode has `info["episode_summary"]`: floats return, cost, length (steps), terminated, truncated, cost_<term> and the
            scenario's statistics, and the uint64 seed.

        Raises:
            InvalidAction, which names part, value and range; TypeError or ValueError for the wrong dtype or shape; ResetNeeded before the first
            reset and after an end; Closed after `close`. Nothing has moved then.
        """
        batch = self._worlds.step(*self._format.one(action))
        info = row(self._infos.step(batch), 0)
        terminated, truncated = bool(batch.terminated[0]), bool(batch.truncated[0])
        if batch.episodes:
            info["episode_summary"] = summary(batch.episodes[0])
        return batch.observations[0], float(batch.rewards[0]), terminated, truncated, info

    def render(self, mode: str | None = None) -> np.ndarray | None:  # type: ignore[override]
        """Draws the present as `render_mode` says.

        Args:
            mode: ignored; the published package has it.

        Returns:
            uint8 [height, width, 3] for "rgb_array", uint8 [height, width] for "depth_array" (0 near to 255 far; from `make` with three equal
            channels, as Gymnasium's wrappers that draw ask for); None, after a warning, without a render mode.
        """
        if self.render_mode is None:
            logger.warn("render() needs render_mode='rgb_array' or 'depth_array' when the environment is made; nothing is drawn")
            return None
        kind = "rgb" if self.render_mode == "rgb_array" else "depth"
        return self._worlds.render(0, kind, frame_size(self._worlds, self._given))

    def picture(self, kind: str = "rgb", resolution: str | Sequence[int] | None = None) -> np.ndarray:
        """Draws the present, whatever `render_mode` is; the episode goes on unchanged.

        Args:
            kind: "rgb", "segmented", "automap", "depth" (0 near to 255 far, 7.3 map units a level), "labels" or "grey".
            resolution: "WxH" or (width, height), 64x48 to 1920x1080; None: that of observations.

        Returns:
            uint8 [height, width, 3] for rgb, segmented and automap, uint8 [height, width] for depth, labels and grey.

        Raises:
            InvalidOption for another kind or size.
        """
        own = frame_size(self._worlds, replace(self._given, render_resolution=None))
        return self._worlds.render(0, kind, own if resolution is None else resolution)

    def state_hash(self) -> int:
        """Returns a fingerprint (64 bits) of everything that the future depends on; the same on every platform."""
        return self._worlds.state_hash(0)

    @property
    def position(self) -> np.ndarray:
        """Where the player stands: int32 [2], map units."""
        return self._worlds.positions[0]

    def save(self) -> bytes:
        """Returns where the environment is, to come back to by `load`; bytes of this version of the package."""
        return self._infos.save()

    def load(self, state: bytes) -> np.ndarray:
        """Comes back to a saved moment, by repeating its episode.

        Args:
            state: what `save` gave, of an environment made alike.

        Returns:
            The observation of that moment.

        Raises:
            InvalidOption for bytes that are spoiled, or of another environment; nothing has changed then.
        """
        return self._infos.load(state).observations[0]

    @property
    def game(self) -> Any:
        """The published package's engine, which is not here: raises AttributeError, which says what there is instead."""
        raise AttributeError("there is no ViZDoom here; see env.save, env.picture, info['env_stats']")

    def close(self) -> None:
        """Lets the world go; closing twice is fine."""
        self._worlds.close()

    def __getstate__(self) -> dict[str, Any]:
        return {"arguments": self._arguments, "saved": self.save(), "kept": copy.deepcopy(self._kept())}

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Not by the constructor: a subclass's has other arguments.
        self._build(state["arguments"])
        self.load(state["saved"])
        # A copy: arrays that came through shared memory, as Ray's do, cannot be written to.
        self.__dict__.update(copy.deepcopy(state["kept"]))


def entry(**arguments: Any) -> gymnasium.Env[Any, Any]:
    """What Gymnasium's `make` calls: returns an `Env` of these arguments, whose depth can be shown and filmed. Raises what `Env` does."""
    env = Env(**arguments)
    return Drawable(env) if env.render_mode == "depth_array" else env


# Gymnasium looks here for what it may be asked for.
entry.metadata = Env.metadata  # type: ignore[attr-defined]
