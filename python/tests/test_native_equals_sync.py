"""The native vector environment is SyncVectorEnv of the single one, bit for bit: observations, rewards, flags and infos.

The one deliberate difference: under SAME_STEP `infos["cost"]` (and its terms) of a step that ends an episode is that step's, where
SyncVectorEnv shows the 0 of the reset.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest
from conftest import assert_same
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import hasard_rs

STEPS = 150


def pair(env_id: str, mode: AutoresetMode, n: int, **arguments: Any) -> tuple[Any, Any]:
    native = hasard_rs.make_vec(env_id, n, autoreset_mode=mode.value, **arguments)
    # The class itself: gymnasium.make would turn max_episode_steps into a wrapper.
    scenario, level = env_id.removeprefix("hasard/").removesuffix("-v0").split("Level")
    singles = [lambda: hasard_rs.Env(scenario=scenario, level=int(level), **arguments) for _ in range(n)]
    return native, SyncVectorEnv(singles, autoreset_mode=mode)


def settle(infos: dict[str, Any], sync: dict[str, Any]) -> None:
    """Lays the one deliberate difference into Sync's infos, after making sure of it."""
    final = sync.get("final_info")
    if final is not None:
        ended = sync["_final_info"]
        for key in ("cost", "cost_terms"):
            if key in sync:
                assert not sync[key][ended].any(), "SyncVectorEnv shows the reset's"
                sync[key][ended] = final[key][ended]


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize("env_id", ["hasard/RemedyRushLevel1-v0", "hasard/PrecipicePlungeLevel3-v0", "hasard/DetonatorsDilemmaLevel2-v0"])
@pytest.mark.parametrize("infos", ["cost", "full"])
def test_bit_for_bit(env_id: str, mode: AutoresetMode, infos: str) -> None:
    full = infos == "full"
    arguments = {"resolution": "64x48", "frame_skip": 35, "infos": infos, "env_stats": full, "full_actions": full, "hard_constraint": full}
    native, sync = pair(env_id, mode, 3, **arguments)
    assert_same(native.reset(seed=5), sync.reset(seed=5), "reset")
    native.action_space.seed(3)
    ends = 0
    for step in range(STEPS):
        actions = native.action_space.sample()
        found, expected = native.step(actions), sync.step(actions)
        settle(found[4], expected[4])
        assert_same(found, expected, f"step {step}")
        ends += int((found[2] | found[3]).sum())
    assert ends >= 3
    assert_same(native.reset(), sync.reset(), "the next episodes")
    mask = np.array([True, False, True])
    assert_same(native.reset(options={"reset_mask": mask}), sync.reset(options={"reset_mask": mask}), "some lanes")


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED])
@pytest.mark.parametrize("env_id", hasard_rs.ids())
def test_every_id_in_every_mode(env_id: str, mode: AutoresetMode, full: bool) -> None:
    arguments = {"resolution": "64x48", "max_episode_steps": 90, "infos": "full", "env_stats": True}
    native, sync = pair(env_id, mode, 2, **arguments)
    assert_same(native.reset(seed=11), sync.reset(seed=11), "reset")
    native.action_space.seed(8)
    ends = 0
    for step in range(1000 if full else 100):
        actions = native.action_space.sample()
        found, expected = native.step(actions), sync.step(actions)
        settle(found[4], expected[4])
        assert_same(found, expected, f"step {step}")
        over = found[2] | found[3]
        ends += int(over.sum())
        if mode == AutoresetMode.DISABLED and over.any():
            assert_same(native.reset(options={"reset_mask": over}), sync.reset(options={"reset_mask": over.copy()}), f"reset after step {step}")
    assert ends >= 2


def test_disabled_rests_until_reset() -> None:
    native, sync = pair("hasard/RemedyRushLevel1-v0", AutoresetMode.DISABLED, 3, resolution="64x48", frame_skip=35, max_episode_steps=9)
    assert_same(native.reset(seed=5), sync.reset(seed=5))
    for _ in range(5):
        while True:
            actions = native.action_space.sample()
            found, expected = native.step(actions), sync.step(actions)
            assert_same(found, expected)
            ended = found[2] | found[3]
            if ended.any():
                break
        with pytest.raises(gymnasium.error.ResetNeeded, match=r"lanes \[0, 1, 2\]"):
            native.step(native.action_space.sample())
        assert_same(native.reset(options={"reset_mask": ended}), sync.reset(options={"reset_mask": ended}))


@pytest.mark.parametrize("action_format", ["multi_discrete", "tuple", "dict", "discrete", "box"])
def test_every_format_acts_alike_in_both(action_format: str) -> None:
    arguments = {"resolution": "64x48", "action_format": action_format, "full_actions": True}
    native, sync = pair("hasard/VolcanicVentureLevel2-v0", AutoresetMode.NEXT_STEP, 3, **arguments)
    assert native.action_space == sync.action_space and native.single_action_space == sync.single_action_space
    assert native.observation_space == sync.observation_space
    assert_same(native.reset(seed=1), sync.reset(seed=1))
    for _ in range(30):
        actions = native.action_space.sample()
        assert_same(native.step(actions), sync.step(actions))


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_threads_width_and_groups_change_nothing(mode: str) -> None:
    env_id, arguments = "hasard/RemedyRushLevel2-v0", {"resolution": "64x48", "frame_skip": 35, "autoreset_mode": mode}
    wide = hasard_rs.make_vec(env_id, 8, num_threads=0, **arguments)
    threads = hasard_rs.make_vec(env_id, 8, num_threads=3, **arguments)
    narrow = hasard_rs.make_vec(env_id, 4, num_threads=1, **arguments)
    in_place = hasard_rs.make_vec(env_id, 8, copy=False, **arguments)
    grouped = hasard_rs.make_vec(env_id, 8, batch_size=4, num_threads=2, **arguments)
    all_at_once = [vec.reset(seed=9)[0] for vec in (wide, threads, in_place)]
    assert np.array_equal(all_at_once[0], all_at_once[1]) and np.array_equal(all_at_once[0], all_at_once[2])
    assert np.array_equal(narrow.reset(seed=9)[0], all_at_once[0][:4])
    observation, infos = grouped.reset(seed=9)
    assert np.array_equal(observation, all_at_once[0][:4]) and infos["env_id"].tolist() == [0, 1, 2, 3]
    rng = np.random.default_rng(1)
    script = rng.integers(0, 2, (80, 8, 4))
    grouped.send(script[0, :4])
    assert np.array_equal(grouped.recv()[0], all_at_once[0][4:])
    grouped.send(script[0, 4:])
    for step in range(79):
        expected = wide.step(script[step])
        assert_same(threads.step(script[step]), expected)
        for found, wanted in zip(in_place.step(script[step])[:4], expected[:4], strict=True):
            assert np.array_equal(found, wanted)
        for found, wanted in zip(narrow.step(script[step][:4])[:4], expected[:4], strict=True):
            assert np.array_equal(found, wanted[:4])
        for half in (slice(0, 4), slice(4, 8)):
            result = grouped.recv()
            for found, wanted in zip(result[:4], expected[:4], strict=True):
                assert np.array_equal(found, wanted[half])
            assert np.array_equal(result[4]["cost"], expected[4]["cost"][half])
            assert result[4]["env_id"].tolist() == list(range(half.start, half.stop))
            grouped.send(script[step + 1][half])


def test_the_single_environment_equals_each_lane() -> None:
    native = hasard_rs.make_vec("hasard/ArmamentBurdenLevel1-v0", 3, resolution="64x48")
    batch, _ = native.reset(seed=40)
    for lane in range(3):
        env = gymnasium.make("hasard/ArmamentBurdenLevel1-v0", resolution="64x48")
        assert np.array_equal(env.reset(seed=40 + lane)[0], batch[lane])
        assert env.unwrapped.state_hash() == native.call("state_hash")[lane]
