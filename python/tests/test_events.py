"""What happened in a step: rewards and costs of one's own can be made of it."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import hasard_rs
from hasard_rs import Cause, Event, Thing

WORTH = {Thing.HealthBonus: 1.0, Thing.Stimpack: 3.0, Thing.Medikit: 6.0}


def earned(events: np.ndarray) -> float:
    taken = events["what"][events["kind"] == Event.PICKUP]
    return sum(worth * float((taken == thing).sum()) for thing, worth in WORTH.items())


class Greedy(gymnasium.Wrapper[Any, Any, Any, Any]):
    """A wrapper that makes its reward of events, as docs/guide/own_task.md shows it."""

    def step(self, action: Any) -> Any:
        observation, _, terminated, truncated, info = self.env.step(action)
        return observation, earned(info["events"]), terminated, truncated, info


def test_a_wrapper_makes_the_reward_of_events() -> None:
    env = Greedy(hasard_rs.make("RemedyRushLevel1-v0", infos="events", resolution="64x48"))
    plain = hasard_rs.make("RemedyRushLevel1-v0", resolution="64x48")
    _, info = env.reset(seed=3)
    plain.reset(seed=3)
    assert info["events"].shape == (0,) and info["events"].dtype.names[:3] == ("tic", "kind", "what")
    total = 0.0
    for step in range(525):
        action = [step // 11 % 3, 1, 1, 0]
        _, reward, _, _, info = env.step(action)
        _, expected, _, _, plain_info = plain.step(action)
        assert reward == expected and "events" not in plain_info
        total += reward
        assert set(info["events"]["player"]) <= {0}
    assert total > 5
    assert {"cost_terms", "position"} <= set(info)


def test_lava_is_the_floors_damage() -> None:
    env = hasard_rs.make("VolcanicVentureLevel1-v0", infos="events", resolution="64x48")
    env.reset(seed=1)
    lost = 0.0
    for step in range(400):
        *_, info = env.step([step // 9 % 3, 1, 0, 1])
        events = info["events"]
        lava = events["amount"][(events["kind"] == Event.DAMAGE) & (events["cause"] == Cause.FLOOR)]
        assert info["cost"] == lava.sum()
        lost += float(lava.sum())
    assert lost > 0


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_a_batch_has_the_events_of_each_lane(mode: AutoresetMode) -> None:
    worlds = hasard_rs.make_vec("RemedyRushLevel1-v0", 6, infos="events", autoreset_mode=mode, max_episode_steps=90, resolution="64x48")
    _, infos = worlds.reset(seed=2)
    assert [len(events) for events in infos["events"]] == [0] * 6
    total, ended = 0.0, 0
    for step in range(200):
        if mode == AutoresetMode.DISABLED and step in (90, 180):
            worlds.reset(options={"reset_mask": np.ones(6, np.bool_)})
        actions = np.tile([1, 1, 1, 0], (6, 1))
        actions[:, 0] = (step // 7 + np.arange(6)) % 3
        _, rewards, terminated, truncated, infos = worlds.step(actions)
        assert [earned(events) for events in infos["events"]] == rewards.tolist()
        total += float(rewards.sum())
        if mode == AutoresetMode.SAME_STEP and (terminated | truncated).any():
            ended += 1
            last = infos["final_info"]["events"]
            assert [earned(events) for events in last] == rewards.tolist()
    assert total > 20 and (ended > 0) == (mode == AutoresetMode.SAME_STEP)


def test_raw_worlds_have_rows_and_offsets() -> None:
    worlds = hasard_rs.Worlds("RemedyRushLevel1-v0", 4, events=True, resolution="64x48")
    assert worlds.reset(0).event_offsets.tolist() == [0] * 5
    seen = 0
    for step in range(300):
        batch = worlds.step(np.tile([step // 10 % 3, 1, 1, 0], (4, 1)))
        for lane in range(4):
            begin, end = batch.event_offsets[lane : lane + 2]
            assert earned(batch.events[begin:end]) == batch.rewards[lane]
        seen += len(batch.events)
    assert seen > 5
    quiet = hasard_rs.Worlds("RemedyRushLevel1-v0", 4, resolution="64x48")
    quiet.reset(0)
    assert all(len(quiet.step(np.tile([1, 1, 1, 0], (4, 1))).events) == 0 for _ in range(100))


def test_the_numbers_are_the_engines() -> None:
    names = hasard_rs._core.event_names()
    assert {kind.name.lower(): int(kind) for kind in Event} == names["kinds"]
    assert {cause.name.lower(): int(cause) for cause in Cause} == names["causes"]
    assert {thing.name: int(thing) for thing in Thing} == names["things"]


@pytest.mark.parametrize("batch", [gymnasium.vector.SyncVectorEnv, gymnasium.vector.AsyncVectorEnv])
def test_gymnasiums_batches_keep_the_events_of_each_environment(batch: Any) -> None:
    """They put arrays of all environments into one, in which events of different number were lost, or repeated, or an error."""
    arguments: dict[str, Any] = {"resolution": "64x48", "infos": "events"}
    lanes = batch([lambda: hasard_rs.make("CollateralDamageLevel1-v0", **arguments)] * 2)
    native = hasard_rs.make_vec("CollateralDamageLevel1-v0", 2, **arguments)
    lanes.reset(seed=1)
    native.reset(seed=1)
    lanes.action_space.seed(1)
    seen = 0
    for _ in range(150):
        actions = lanes.action_space.sample()
        theirs, ours = lanes.step(actions)[4]["events"], native.step(actions)[4]["events"]
        for their, own in zip(theirs, ours, strict=True):
            assert np.array_equal(np.asarray(their), np.asarray(own))
            seen += len(own)
    lanes.close()
    assert seen > 50


def test_events_are_used_as_an_array_and_can_be_copied() -> None:
    array = np.array([(3, 4), (5, 6)], dtype=[("tic", "<u4"), ("kind", "<i2")])
    events = hasard_rs.Events(array)
    for one in (events, copy.deepcopy(events), pickle.loads(pickle.dumps(events))):
        assert (one == array).all() and (one == events).all() and len(one) == 2
        assert one["kind"].tolist() == [4, 6] and one.dtype == array.dtype and [int(row["tic"]) for row in one] == [3, 5]
        assert np.array_equal(np.asarray(one), array) and one.shape == (2,)
    assert repr(events).startswith("Events(array(")
