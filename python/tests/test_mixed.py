"""Different tasks in one batch: each lane plays what it would play alone."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import hasard_rs

GARDEN = """
[scenario]
name = "MixedGarden"
budget = 3
actions = [["TURN_RIGHT"], ["MOVE_FORWARD"]]
[map]
ascii = '''
######
#.@..#
#....#
######'''
[[spawn]]
kind = "HealthBonus"
count = 6
respawn = 0
[[when]]
event = "pickup"
of = "HealthBonus"
reward = 1.0
cost.greed = 0.5
count = "vials"
"""


@pytest.fixture
def ids(tmp_path: Path) -> list[str]:
    path = tmp_path / "garden.toml"
    path.write_text(GARDEN)
    return ["hasard/RemedyRushLevel1-v0", "CollateralDamageLevel1-v0", str(path)]


def test_lanes_play_their_own_tasks(ids: list[str]) -> None:
    worlds = hasard_rs.make_vec(ids, 6, resolution="64x48", infos="full", env_stats=True, autoreset_mode="SameStep")
    assert worlds.tasks == ("hasard/RemedyRushLevel1-v0", "hasard/CollateralDamageLevel1-v0", "hasard/MixedGarden-v0")
    assert worlds.lane_tasks.tolist() == [0, 1, 2, 0, 1, 2]
    assert worlds.single_action_space.nvec.tolist() == [3, 2, 2, 2, 2]
    assert worlds.action_masks[1].tolist() == [True, True, True, True, False, True, False, True, False, True, True]
    assert worlds.scenario_name == ("RemedyRush", "CollateralDamage", "MixedGarden")
    assert worlds.safety_budget.tolist() == [5.0, 5.0, 3.0] * 2 and worlds.extent is None
    # What each task plays alone: buttons that it does not have do nothing.
    alone = [hasard_rs.make_vec(env_id, 6, resolution="64x48", autoreset_mode="SameStep") for env_id in ids]
    first, _ = worlds.reset(seed=4)
    firsts = [one.reset(seed=4)[0] for one in alone]
    assert all(np.array_equal(first[lane], firsts[lane % 3][lane]) for lane in range(6))
    rng = np.random.default_rng(0)
    sums = np.zeros((2, 6))
    for _ in range(540):
        actions = rng.integers(0, worlds.single_action_space.nvec, (6, 5))
        observations, rewards, terminated, truncated, infos = worlds.step(actions)
        assert infos["task"].tolist() == [0, 1, 2, 0, 1, 2]
        for task, one in enumerate(alone):
            # Turn, ahead, run, jump, attack; the garden has TURN_RIGHT alone, the second of the first.
            turn, ahead, run, jump, attack = actions.T
            chosen = np.stack([(turn, ahead, run, jump), (turn, attack), (turn == 2, ahead)][task], axis=1).astype(int)
            seen, earned, *_, own_infos = one.step(chosen)
            lanes = [task, task + 3]
            assert np.array_equal(observations[lanes], seen[lanes])
            assert rewards[lanes].tolist() == earned[lanes].tolist()
            assert infos["cost"][lanes].tolist() == own_infos["cost"][lanes].tolist()
        sums += [rewards, infos["cost"]]
    assert (sums[0].reshape(2, 3).sum(axis=0) != 0).all()
    assert infos["env_stats"]["vials"][[0, 1, 3, 4]].tolist() == [0.0] * 4


def test_pickles_and_saved_moments_go_on(ids: list[str]) -> None:
    worlds = hasard_rs.make_vec(ids, 5, resolution="64x48")
    worlds.reset(seed=1)
    rng = np.random.default_rng(1)
    for _ in range(30):
        worlds.step(rng.integers(0, worlds.single_action_space.nvec, (5, 5)))
    copy = pickle.loads(pickle.dumps(worlds))
    assert copy.tasks == worlds.tasks
    for _ in range(30):
        actions = rng.integers(0, worlds.single_action_space.nvec, (5, 5))
        assert np.array_equal(worlds.step(actions)[0], copy.step(actions)[0])


def test_a_mixture_that_cannot_be_is_refused(ids: list[str]) -> None:
    with pytest.raises(hasard_rs.InvalidOption, match="3 tasks need a lane each"):
        hasard_rs.make_vec(ids, 2)
    with pytest.raises(hasard_rs.UnknownEnvironment, match="RemedyRush"):
        hasard_rs.make_vec(["RemedyRushLevel9-v0", *ids], 8)
    with pytest.raises(hasard_rs.InvalidOption, match="empty"):
        hasard_rs.make_vec([], 8)


def test_the_full_space_is_one_for_all(ids: list[str]) -> None:
    worlds = hasard_rs.make_vec(ids, 3, full_actions=True, resolution="64x48")
    single = hasard_rs.make("RemedyRushLevel1-v0", full_actions=True)
    assert len(worlds.action_masks[0]) == sum(worlds.worlds.nvec) and worlds.worlds.num_deltas == 2
    assert single.action_space is not None


def test_a_pickle_whose_arrays_are_read_only_can_be_stepped() -> None:
    """Ray lays arrays of a pickle into memory that nobody may write to."""
    worlds = hasard_rs.make_vec("RemedyRushLevel1-v0", 3, resolution="64x48", autoreset_mode="NextStep")
    worlds.reset(seed=2)
    buffers: list[pickle.PickleBuffer] = []
    data = pickle.dumps(worlds, protocol=5, buffer_callback=buffers.append)
    assert buffers
    copy = pickle.loads(data, buffers=[bytes(buffer.raw()) for buffer in buffers])
    actions = np.ones((3, 4), int)
    assert np.array_equal(worlds.step(actions)[0], copy.step(actions)[0])
    copy.reset(seed=2)
