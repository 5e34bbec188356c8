"""Memory and threads stay where they are over many steps, constructions and pickles; with --full as many as were ever asked for."""

from __future__ import annotations

import gc
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import assert_same

import hasard_rs

ENV = "hasard/RemedyRushLevel1-v0"
PROCESS = Path("/proc/self")
pytestmark = pytest.mark.skipif(not (PROCESS / "statm").exists(), reason="memory is read from /proc")
# An allocator's own slack; one leaked observation of 64x48 a step would be 9 kB.
SLACK = 12e6


def use() -> tuple[float, int]:
    """Resident bytes and threads of this process."""
    gc.collect()
    return int((PROCESS / "statm").read_text().split()[1]) * 4096, len(list((PROCESS / "task").iterdir()))


def stays(work: Callable[[int], None], count: int) -> None:
    """Nothing grows between the first tenth of the work and its end."""
    for i in range(count // 10):
        work(i)
    memory, threads = use()
    for i in range(count // 10, count):
        work(i)
    later, still = use()
    print(f"{count} times: {memory / 1e6:.1f} MB and {threads} threads, later {later / 1e6:.1f} MB and {still}")
    assert later - memory < SLACK and still == threads


def test_steps(full: bool) -> None:
    vec = hasard_rs.make_vec(ENV, 64, resolution="64x48", num_threads=1, infos="full", autoreset_mode="SameStep")
    vec.reset(seed=1)
    vec.action_space.seed(0)
    stays(lambda _: vec.step(vec.action_space.sample()) and None, 5_000_000 // 64 if full else 2_000)


def test_constructions(full: bool) -> None:
    def make(i: int) -> None:
        vec = hasard_rs.make_vec(ENV, 4, resolution="64x48", num_threads=2)
        vec.reset(seed=i)
        vec.step(vec.action_space.sample())
        env = hasard_rs.make(ENV, resolution="64x48")
        env.reset(seed=i)
        if i % 2:
            vec.close()
            env.close()

    stays(make, 1_000 if full else 40)


def test_pickles(full: bool) -> None:
    vec = hasard_rs.make_vec(ENV, 2, resolution="64x48", num_threads=1, max_episode_steps=40)
    vec.reset(seed=1)
    vec.action_space.seed(0)
    held = [vec]

    def pickled(_: int) -> None:
        actions = vec.action_space.sample()
        copy = pickle.loads(pickle.dumps(held[0]))
        assert_same(copy.step(actions), held[0].step(actions))
        held[0].close()
        held[0] = copy

    stays(pickled, 1_000 if full else 60)
    assert np.asarray(held[0].call("episode_seed")).shape == (2,)
