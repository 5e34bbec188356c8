"""The raw layer: external memory, lanes that are chosen, states that are saved, and processes that fork."""

from __future__ import annotations

import copy
import os
import pickle
import threading
import time
from typing import Any

import gymnasium
import numpy as np
import pytest
from conftest import assert_same

import hasard_rs
from hasard_rs import Worlds

ENV = "hasard/RemedyRushLevel1-v0"


def script(steps: int, n: int) -> np.ndarray:
    return np.random.default_rng(3).integers(0, 2, (steps, n, 4))


def test_bound_arrays_are_written_in_place() -> None:
    n, arguments = 5, {"resolution": "64x48", "frame_skip": 35, "num_threads": 1}
    mine, other = Worlds(ENV, n, **arguments), Worlds(ENV, n, **arguments)
    given = {
        "observations": np.zeros((n, 48, 64, 3), np.uint8),
        "rewards": np.zeros(n, np.float32),
        "costs": np.zeros(n, np.float32),
        "terminated": np.zeros(n, bool),
        "truncated": np.zeros(n, bool),
        "cost_terms": np.zeros((n, len(mine.cost_terms)), np.float32),
    }
    mine.bind(**given)
    assert mine.reset(4).observations is not None
    other.reset(4)
    for actions in script(80, n):
        found, expected = mine.step(actions), other.step(actions)
        for name, array in given.items():
            assert np.array_equal(array, getattr(expected, name)), name
            assert np.shares_memory(array, getattr(found, name)), name
        assert found.episodes == expected.episodes and np.array_equal(found.final_observations, expected.final_observations)
    mine.unbind()
    assert not np.shares_memory(mine.step(script(1, n)[0]).observations, given["observations"])


@pytest.mark.parametrize(
    "wrong",
    [np.zeros((5, 48, 64, 3), np.int8), np.zeros((4, 48, 64, 3), np.uint8), np.zeros((5, 48, 64, 6), np.uint8)[..., ::2], [1, 2], None],
)
def test_wrong_arrays_are_refused(wrong: Any) -> None:
    made = Worlds(ENV, 5, resolution="64x48", num_threads=0)
    small = {"rewards": np.zeros(5, np.float32), "costs": np.zeros(5, np.float32), "terminated": np.zeros(5, bool), "truncated": np.zeros(5, bool)}
    with pytest.raises(BufferError, match=r"observations must be a writable C-contiguous array of dtype uint8 and shape \[5, 48, 64, 3\]"):
        made.bind(observations=wrong, **small)
    frozen = np.zeros((5, 48, 64, 3), np.uint8)
    frozen.flags.writeable = False
    with pytest.raises(BufferError, match="read-only"):
        made.bind(observations=frozen, **small)


def test_arrays_that_share_memory_are_refused() -> None:
    made = Worlds(ENV, 5, resolution="64x48", num_threads=0)
    block = np.zeros(9, np.float32)
    given = {
        "observations": np.zeros((5, 48, 64, 3), np.uint8),
        "rewards": block[:5],
        "costs": block[4:],
        "terminated": np.zeros(5, bool),
        "truncated": np.zeros(5, bool),
    }
    with pytest.raises(BufferError, match="rewards and costs share memory; give each an array of its own"):
        made.bind(**given)
    with pytest.raises(BufferError, match="terminated and truncated share memory"):
        made.bind(**(given | {"costs": np.zeros(5, np.float32), "truncated": given["terminated"]}))
    made.bind(**(given | {"rewards": block[:4].repeat(2)[:5], "costs": block[4:]}))


def test_observations_are_never_written_again() -> None:
    made = Worlds(ENV, 2, resolution="64x48", num_threads=1)
    kept = [made.reset(0).observations]
    kept += [made.step(actions).observations for actions in script(30, 2)]
    copies = [array.copy() for array in kept]
    for actions in script(30, 2):
        made.step(actions)
    assert all(np.array_equal(a, b) for a, b in zip(kept, copies, strict=True))
    assert all(array.flags.writeable and array.flags.c_contiguous for array in kept)
    view = kept[0][1]
    address = view.ctypes.data
    del kept, made
    assert view.ctypes.data == address and np.array_equal(view, copies[0][1]), "a view outlives the worlds"


def test_chosen_lanes_come_in_their_order() -> None:
    whole, parts = (Worlds(ENV, 4, resolution="64x48", num_threads=t) for t in (0, 1))
    whole.reset(1)
    parts.reset(1)
    for actions in script(20, 4):
        expected = whole.step(actions)
        for lanes in ([3, 1], [0, 2]):
            found = parts.step(actions[lanes], lanes=lanes)
            assert np.array_equal(found.observations, expected.observations[lanes]) and found.lanes.tolist() == lanes


@pytest.mark.parametrize("vector", [False, True])
def test_pickles_and_copies_go_on_alike(vector: bool) -> None:
    arguments = {"resolution": "64x48", "full_actions": True, "infos": "full", "env_stats": True, "frame_stack": 2}
    env: Any = hasard_rs.make_vec(ENV, 3, **arguments) if vector else gymnasium.make(ENV, **arguments).unwrapped
    env.reset(seed=3)
    actions = [env.action_space.sample() for _ in range(30)]
    for action in actions[:15]:
        env.step(action)
    others = [pickle.loads(pickle.dumps(env)), copy.deepcopy(env)]
    for action in actions[15:]:
        expected = env.step(action)
        for other in others:
            assert_same(other.step(action), expected)
    assert_same(others[0].reset(), env.reset())


@pytest.mark.parametrize("mode", [None, "NextStep", "SameStep", "Disabled"])
def test_a_saved_moment_brings_everything_back(mode: str | None) -> None:
    # Into an environment that has played something else, and over the ends of episodes: what they have cost so far is part of the moment.
    env_id = "hasard/VolcanicVentureLevel1-v0"
    arguments = {"resolution": "64x48", "frame_skip": 20, "max_episode_steps": 12, "infos": "full", "env_stats": True, "frame_stack": 2}

    def made(seed: int) -> Any:
        env: Any = hasard_rs.make_vec(env_id, 3, autoreset_mode=mode, **arguments) if mode else hasard_rs.Env(scenario="VolcanicVenture", level=1, **arguments)
        env.reset(seed=seed)
        return env

    def moved(env: Any, action: Any) -> Any:
        result = env.step(action)
        over = result[2] | result[3]
        if mode == "Disabled" and np.any(over):
            return result, env.reset(options={"reset_mask": over})
        return (result, env.reset()) if mode is None and over else (result,)

    env, other = made(3), made(99)
    env.action_space.seed(1)
    actions = [env.action_space.sample() for _ in range(40)]
    costs = 0.0
    for action in actions[:8]:
        costs += np.sum(moved(env, action)[0][4]["cost"])
    for action in actions[30:]:
        moved(other, action)
    assert costs > 0.0
    other.load(env.save())
    assert other.save() == env.save()
    for action in actions[8:]:
        assert_same(moved(other, action), moved(env, action))


def test_before_the_first_reset_there_is_a_moment_too() -> None:
    one, other = (hasard_rs.Env(scenario="RemedyRush", level=1, resolution="64x48", seed=6) for _ in range(2))
    assert not one.reset(seed=8)[1]["cost"] and one.step([0, 1, 0, 0])
    one.load(other.save())
    with pytest.raises(hasard_rs.ResetNeeded):
        one.step([0, 1, 0, 0])
    assert_same(one.reset(), other.reset())


@pytest.mark.parametrize("vector", [False, True])
def test_the_seed_in_a_summary_repeats_the_episode(vector: bool) -> None:
    # As a float it lost the last bits of most seeds.
    arguments = {"resolution": "64x48", "max_episode_steps": 2, "infos": "full"}
    env: Any = hasard_rs.make_vec(ENV, 1, **arguments) if vector else hasard_rs.Env(scenario="RemedyRush", level=1, **arguments)
    for _ in range(5):
        began = np.atleast_1d(env.reset(seed=None)[1]["episode_seed"])
        env.step(env.action_space.sample())
        seed = np.atleast_1d(env.step(env.action_space.sample())[4]["episode_summary"]["seed"])
        assert seed.dtype == np.uint64 and seed.tolist() == began.tolist()


def test_lanes_and_groups_that_are_none_are_refused() -> None:
    made = Worlds(ENV, 4, groups=2, resolution="64x48", num_threads=0)
    made.reset(1)
    for wrong in (-1, 4, 1 << 70):
        for call in (made.render, made.state_hash, made.stats):
            with pytest.raises(IndexError, match=rf"lane {wrong} is not one of"):
                call(wrong)
        with pytest.raises(hasard_rs.InvalidOption, match=str(wrong)):
            made.step(np.zeros((1, 4), int), lanes=[wrong])
        for call in (made.recv, lambda group: made.send(np.zeros((2, 4), int), group=group)):
            with pytest.raises(hasard_rs.InvalidOption, match="group cannot be"):
                call(wrong)
    for call in (made.render, made.state_hash, made.stats, made.recv):
        with pytest.raises(TypeError, match="must be an integer, got 0.5"):
            call(0.5)
    assert made.state_hash(np.int16(3)) == made.state_hash(3)


def test_a_thousand_pickles_and_constructions_leave_no_memory_behind() -> None:
    import resource

    def memory() -> int:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    env = gymnasium.make(ENV, resolution="64x48").unwrapped
    env.reset(seed=1)
    made = Worlds(ENV, 8, resolution="64x48", num_threads=1)
    made.reset(1)
    zeros = np.zeros((8, 4), int)

    def round_(count: int) -> None:
        for _ in range(count):
            pickle.loads(pickle.dumps(env)).close()
            Worlds(ENV, 2, resolution="64x48", num_threads=1).close()
            made.step(zeros)

    round_(100)
    before = memory()
    round_(400)
    assert memory() - before < 30 << 20


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_child_is_refused_and_does_not_hang() -> None:
    threaded, alone = (Worlds(ENV, 4, resolution="64x48", num_threads=t) for t in (2, 0))
    threaded.reset(0)
    alone.reset(0)
    child = os.fork()
    if child == 0:
        code = 1
        try:
            alone.step(np.zeros((4, 4), int))
            threaded.step(np.zeros((4, 4), int))
        except hasard_rs.OutOfTurn as error:
            code = 0 if "make worlds after forking" in str(error) else 2
        finally:
            del threaded, alone
            os._exit(code)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    threaded.step(np.zeros((4, 4), int))


def test_other_threads_run_while_worlds_step() -> None:
    # No measure of speed: with the interpreter held, nobody could take the time in the first half of a step.
    made = Worlds(ENV, 64, resolution="640x480", num_threads=0)
    made.reset(0)
    times: list[float] = []
    over = threading.Event()

    def watch() -> None:
        while not over.wait(0.0005):
            times.append(time.perf_counter())

    thread = threading.Thread(target=watch)
    thread.start()
    seen = 0
    for _ in range(5):
        start = time.perf_counter()
        made.step(np.zeros((64, 4), int))
        middle = (start + time.perf_counter()) / 2
        seen += sum(start < moment < middle for moment in times)
    over.set()
    thread.join()
    assert seen > 0


def test_seeds_restart_streams_and_lanes_have_their_own() -> None:
    made = Worlds(ENV, 3, resolution="64x48", num_threads=0)
    first = made.reset(5).observations
    second = made.reset().observations
    assert not np.array_equal(first, second)
    assert np.array_equal(made.reset([5, 6, 7]).observations, first)
    assert np.array_equal(made.reset(np.array([5, 6, 7], np.uint64)).observations, first)
    assert np.array_equal(made.reset(5 + 2**64).observations, first), "seeds are modulo 2^64"
    assert len({row.tobytes() for row in first}) == 3
    only = made.reset([9, None, 9], np.array([True, False, False])).observations
    assert np.array_equal(only[1:], first[1:]) and not np.array_equal(only[0], first[0])


def test_states_are_the_same_everywhere() -> None:
    # A change of these is a change of the task, or of the random streams, on some platform or in some version.
    env = gymnasium.make("hasard/PrecipicePlungeLevel2-v0", resolution="64x48").unwrapped
    env.reset(seed=11)
    rewards = [env.step([i % 3, 1, 0, i % 2])[1] for i in range(50)]
    again = Worlds("PrecipicePlungeLevel2-v0", 1, resolution="64x48")
    again.reset(11)
    floats = [again.step([[i % 3, 1, 0, i % 2]]).rewards[0] for i in range(50)]
    assert [float(np.float32(reward)) for reward in rewards] == rewards == [float(value) for value in floats]
    assert env.state_hash() == again.state_hash()


def test_pictures_of_every_kind() -> None:
    env = gymnasium.make(ENV, render_mode="rgb_array", layout="chw", render_resolution=(100, 80)).unwrapped
    env.reset(seed=1)
    before = env.state_hash()
    assert env.render().shape == (80, 100, 3)
    for kind, channels in [("rgb", (3,)), ("segmented", (3,)), ("automap", (3,)), ("depth", ()), ("labels", ()), ("grey", ())]:
        picture = env.picture(kind, "80x60")
        assert picture.shape == (60, 80, *channels) and picture.dtype == np.uint8 and picture.any()
    assert env.state_hash() == before
