"""The published package's own names, for its users: their scripts run after `import hasard_rs.published as hasard`.

Bare ids such as `RemedyRushLevel1-v0`, `Tuple` actions, 320x240, the released rules, `info["env_stats"]`. Importing this module registers
the bare ids with Gymnasium. What differs: no window by default and no `game`; a time-out is `truncated` alone; the last observation is the last
frame; `reset` has infos.
"""

from __future__ import annotations

import struct
from typing import Any

import gymnasium

from hasard_rs import _core
from hasard_rs.arguments import for_make, over
from hasard_rs.env import Env
from hasard_rs.registry import LEVELS, Scenario, bare
from hasard_rs.wrappers.cost import CostPenalty, CostWrapper
from hasard_rs.wrappers.drawable import Drawable
from hasard_rs.wrappers.saute import Saute

_RESOLUTIONS = ("800X600", "640X480", "320X240", "160X120")


class DoomEnv(Env):
    """An environment with the published package's defaults and methods.

    Args:
        arguments: those of `help(hasard_rs.Env)`; rules are "released", action_format "tuple", resolution "320x240" and env_stats True unless given.
            render_mode "human" is taken for "rgb_array".
    """

    delta_actions_scaling_factor = 7.5

    def __init__(self, **arguments: Any) -> None:
        # The published package has None for its own size.
        arguments = {name: value for name, value in arguments.items() if name not in ("resolution", "size") or value is not None}
        given = over({"rules": "released", "action_format": "tuple", "resolution": "320x240", "env_stats": True}, arguments)
        if given.get("render_mode") == "human":
            # A window would need pygame; Gymnasium's make adds one to the frames if it is asked for a human mode.
            given["render_mode"] = "rgb_array"
        # They are counted in any case, for `get_statistics`.
        self._reports = bool(given["env_stats"])
        super().__init__(**{**given, "env_stats": True})
        self.game_res = given.get("resolution", given.get("size"))
        self._statistics: dict[str, float] = {}
        self._cost = 0.0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        """Starts an episode; seed and options as for `Env.reset`. Returns and raises what it does."""
        observation, info = super().reset(seed=seed, options=options)
        self._note(info)
        return observation, info

    def step(self, action: Any) -> Any:
        """Holds an action, a tuple of parts. Returns and raises what `Env.step` does; `info["env_stats"]` has the published names, floats."""
        result = super().step(action)
        self._note(result[4])
        return result

    def _note(self, info: dict[str, Any]) -> None:
        self._statistics, self._cost = info["env_stats"], float(info["cost"])
        if not self._reports:
            del info["env_stats"]

    def save(self) -> bytes:
        """Returns where the environment is, and the cost of the last step, to come back to by `load`."""
        return struct.pack("<d", self._cost) + super().save()

    def load(self, state: bytes) -> Any:
        """Comes back to a saved moment, `state`, statistics and cost too. Returns and raises what `Env.load` does."""
        if not isinstance(state, bytes):
            raise TypeError(f"a saved moment must be bytes, got {type(state).__name__}")
        observation = super().load(state[8:])
        (self._cost,) = struct.unpack_from("<d", state)
        self._statistics = self._infos.stats(0, float(self._infos.cost[0])) if self._worlds.started else {}
        return observation

    def calculate_cost(self) -> float:
        """Returns the cost of the last step, 0 after a reset."""
        return self._cost

    def get_statistics(self, mode: str = "") -> dict[str, float]:
        """Returns the episode's statistics so far; `mode` is ignored."""
        return self._statistics

    def reduced_action_space(self) -> Any:
        """Returns the space of the simplified actions."""
        return DoomEnv(**{**self._arguments, "full_actions": False}).action_space

    def full_action_space(self) -> Any:
        """Returns the space of all buttons, and two continuous axes."""
        return DoomEnv(**{**self._arguments, "full_actions": True}).action_space

    def full_actions(self) -> bool:
        """Returns whether all buttons are in use."""
        return bool(self._arguments.get("full_actions", False))

    def video_schedule(self, episode_id: int) -> bool:
        """Returns False, whatever episode_id is: none is filmed of itself; see `gymnasium.wrappers.RecordVideo`, or `hasard record`."""
        return False


def entry(**arguments: Any) -> gymnasium.Env[Any, Any]:
    """What Gymnasium's `make` calls: returns a `DoomEnv` of these arguments, whose depth can be shown and filmed. Raises what it does."""
    env = DoomEnv(**arguments)
    return Drawable(env) if env.render_mode == "depth_array" else env


entry.metadata = {**DoomEnv.metadata, "render_modes": [*DoomEnv.metadata["render_modes"]]}  # type: ignore[attr-defined]


def register_environment(scenario: str | Scenario, level: int) -> None:
    """Registers one bare id, of a scenario (a `Scenario` or its value) and a level (1 to 3); nothing happens if it is registered.

    Raises UnknownEnvironment, which names the nearest id.
    """
    name = scenario.value if isinstance(scenario, Scenario) else scenario
    env_id = f"{name}Level{level}-v0"
    _core.describe(env_id)
    if env_id not in gymnasium.registry:
        gymnasium.register(
            env_id, entry_point="hasard_rs.published:entry", kwargs={"scenario": name, "level": level}, disable_env_checker=True
        )


def make(env_id: str, **kwargs: Any) -> gymnasium.Env[Any, Any]:
    """Returns an environment by its bare env_id, in a `CostWrapper`; kwargs as of `DoomEnv`. Raises what `hasard_rs.make` does."""
    kwargs = for_make(kwargs)
    _core.describe(bare(env_id))
    return CostWrapper(gymnasium.make(bare(env_id), **kwargs))


for _scenario in Scenario:
    for _level in LEVELS:
        register_environment(_scenario, _level)

__all__ = ["LEVELS", "CostPenalty", "CostWrapper", "DoomEnv", "Saute", "Scenario", "make", "register_environment"]
