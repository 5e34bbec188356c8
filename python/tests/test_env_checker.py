"""Gymnasium's own checker, over every id, action format and kind of observation; warnings are errors (pyproject.toml)."""

from __future__ import annotations

import subprocess
import sys

import gymnasium
import pytest
from gymnasium.utils.env_checker import check_env

import hasard_rs

FORMATS = ("multi_discrete", "tuple", "dict", "discrete", "box")
OBSERVATIONS = ("rgb", "rgb+depth", "segmented", "grey")


@pytest.mark.parametrize("env_id", hasard_rs.ids())
def test_every_id_in_every_format(env_id: str, full: bool) -> None:
    for i, action_format in enumerate(FORMATS):
        for observation in OBSERVATIONS if full else OBSERVATIONS[i % 4 : i % 4 + 1]:
            arguments = {"action_format": action_format, "full_actions": i % 2 == 0, "observation": observation}
            env = gymnasium.make(env_id, render_mode="rgb_array", resolution="64x48", **arguments)
            check_env(env.unwrapped)
            env.close()


@pytest.mark.parametrize("action_format", FORMATS)
@pytest.mark.parametrize("full_actions", [False, True])
def test_every_format_with_every_observation(action_format: str, full_actions: bool) -> None:
    for observation in OBSERVATIONS:
        for layout in ("hwc", "chw"):
            for frame_stack in (1, 4):
                looks = {"observation": observation, "layout": layout, "frame_stack": frame_stack}
                env = gymnasium.make(
                    "hasard/DetonatorsDilemmaLevel2-v0",
                    action_format=action_format,
                    full_actions=full_actions,
                    resolution="64x48",
                    render_mode="depth_array",
                    **looks,
                )
                check_env(env.unwrapped)


def test_ids_are_registered_once_and_bare_ones_are_not() -> None:
    # Tasks of their own that other tests have made are not the benchmark's.
    def registered() -> list[str]:
        return [env_id for env_id, spec in gymnasium.registry.items() if env_id.startswith("hasard/") and "scenario_file" not in spec.kwargs]

    assert registered() == hasard_rs.ids() and len(registered()) == 18
    # In an interpreter of its own: another test may have imported the module that registers bare ids.
    asks = "import gymnasium, hasard_rs, sys; sys.exit('VolcanicVentureLevel1-v0' in gymnasium.registry)"
    assert subprocess.run([sys.executable, "-c", asks], check=False).returncode == 0
    hasard_rs.register_environment("VolcanicVenture", 1)
    assert registered() == hasard_rs.ids()
