"""Gymnasium's wrappers of vector environments do to the native one what they do to SyncVectorEnv, in every mode; what they refuse, they refuse alike."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import gymnasium.wrappers.vector as wrappers
import numpy as np
import pytest
from conftest import assert_same
from gymnasium.vector import AutoresetMode
from test_native_equals_sync import pair, settle

MODES = [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED]
WRAPPERS: dict[str, Callable[[Any], Any]] = {
    "ClipAction": wrappers.ClipAction,
    "ClipReward": lambda env: wrappers.ClipReward(env, -0.5, 0.5),
    "DictInfoToList": wrappers.DictInfoToList,
    "DtypeObservation": lambda env: wrappers.DtypeObservation(env, np.float32),
    "FlattenObservation": wrappers.FlattenObservation,
    "GrayscaleObservation": wrappers.GrayscaleObservation,
    "NormalizeObservation": wrappers.NormalizeObservation,
    "NormalizeReward": wrappers.NormalizeReward,
    "RecordEpisodeStatistics": wrappers.RecordEpisodeStatistics,
    "RescaleAction": lambda env: wrappers.RescaleAction(env, 0.0, 1.0),
    "ReshapeObservation": lambda env: wrappers.ReshapeObservation(env, (48 * 64, 3)),
    "TransformReward": lambda env: wrappers.TransformReward(env, lambda reward: 2.0 * reward),
}


def outcome(env: Any, wrap: Callable[[Any], Any], mode: AutoresetMode) -> list[Any]:
    """Everything that a wrapped environment returns in two episodes, or what was raised."""
    try:
        wrapped = wrap(env)
        results: list[Any] = [wrapped.reset(seed=4)]
        wrapped.action_space.seed(2)
        for _ in range(14):
            # A copy: some wrappers write over what they returned.
            results.append(copy.deepcopy(wrapped.step(wrapped.action_space.sample())))
            if mode == AutoresetMode.DISABLED and (over := results[-1][2] | results[-1][3]).any():
                results.append(wrapped.reset(options={"reset_mask": over}))
    except Exception as error:  # noqa: BLE001
        return [type(error), str(error).replace("SyncVectorEnv", "VectorEnv")]
    return results


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", WRAPPERS)
def test_the_same_is_returned(name: str, mode: AutoresetMode) -> None:
    arguments = {"resolution": "64x48", "max_episode_steps": 6, "frame_skip": 20, "action_format": "box" if name.endswith("Action") else "multi_discrete"}
    native, sync = pair("hasard/VolcanicVentureLevel1-v0", mode, 2, **arguments)
    found, expected = outcome(native, WRAPPERS[name], mode), outcome(sync, WRAPPERS[name], mode)
    assert len(found) == len(expected), (found[:2], expected[:2])
    if name == "RecordEpisodeStatistics" and mode == AutoresetMode.DISABLED:
        # SyncVectorEnv takes the mask out of the caller's dict, so that this wrapper does not see it and counts on; ours leaves it there.
        lengths = [step[4]["episode"]["l"].tolist() for step in found if len(step) == 5 and "episode" in step[4]]
        assert lengths == [[6, 6], [6, 6]]
        found, expected = found[:7], expected[:7]
    for step, (one, other) in enumerate(zip(found, expected, strict=True)):
        if isinstance(one, tuple) and len(one) == 5:
            for infos in (one[4], other[4]):
                if isinstance(infos, dict) and "episode" in infos:
                    assert infos["episode"].pop("t").shape == (2,)
            if isinstance(other[4], dict):
                settle(one[4], other[4])
            elif mode == AutoresetMode.SAME_STEP:
                for lane, theirs in zip(one[4], other[4], strict=True):
                    if "final_info" in theirs:
                        assert lane["cost"] == theirs["final_info"]["cost"] and theirs.pop("cost") == 0.0
                        lane.pop("cost")
        assert_same(one, other, f"{name}, {mode.value}, step {step}")
