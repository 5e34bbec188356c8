"""What is stepped here is what Rust recorded: the fingerprints of crates/envs/tests/goldens.txt, played again through `Worlds`.

The stream of actions and the fingerprint are written down here a second time, from their definitions, since nothing of them is offered to Python.
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

import hasard_rs

GOLDENS = Path(__file__).parents[2] / "crates/envs/tests/goldens.txt"
WORD = 2**64 - 1


class Stream:
    """The engine's random stream (SplitMix64)."""

    def __init__(self, seed: int) -> None:
        self.state = self.mix((seed + 0x9E3779B97F4A7C15) & WORD)

    @staticmethod
    def mix(word: int) -> int:
        word = ((word ^ (word >> 30)) * 0xBF58476D1CE4E5B9) & WORD
        word = ((word ^ (word >> 27)) * 0x94D049BB133111EB) & WORD
        return word ^ (word >> 31)

    def next(self) -> int:
        self.state = (self.state + 0x9E3779B97F4A7C15) & WORD
        return self.mix(self.state)

    def below(self, bound: int) -> int:
        return ((self.next() >> 32) * bound) >> 32

    def between(self, low: int, high: int) -> int:
        return low + ((self.next() * (high - low + 1)) >> 64)


def fingerprint(words: list[int]) -> str:
    found = 0x9E3779B97F4A7C15
    for word in words:
        found = ((found ^ word) * 0xA24BAED4963EE407) & WORD
        found = ((found << 29) | (found >> 35)) & WORD
    found = ((found ^ (found >> 32)) * 0xBF58476D1CE4E5B9) & WORD
    return f"{found ^ (found >> 29):016x}"


def begin(worlds: hasard_rs.Worlds, seed: int) -> hasard_rs.Batch:
    """Starts the episode of exactly this seed: saved lanes hold it after their head, the number of lanes and the stream."""
    worlds.reset(0)
    saved = bytearray(worlds.save())
    at = saved.index(b"hslanes\x02") + 8 + 8 + 8
    saved[at : at + 8] = struct.pack("<Q", seed)
    return worlds.load(bytes(saved))


@pytest.mark.parametrize("actions", ["simplified", "full"])
@pytest.mark.parametrize("env_id", [env_id.removeprefix("hasard/") for env_id in hasard_rs.ids()])
def test_worlds_do_what_rust_recorded(env_id: str, actions: str) -> None:
    rows = [line.split() for line in GOLDENS.read_text().splitlines()]
    frames, state = next((row[4], row[7]) for row in rows if row[:4] == [env_id, "paper", "soft", actions])
    worlds = hasard_rs.Worlds(env_id, 1, num_threads=0, resolution="128x72", autoreset_mode="Disabled", full_actions=actions == "full")
    stream, episode = Stream(7), 0
    begin(worlds, episode)
    chosen, deltas = np.zeros((1, len(worlds.nvec)), np.int64), np.zeros((1, worlds.num_deltas))
    states, seen = [], []
    for _ in range(300):
        for part, size in enumerate(worlds.nvec):
            if stream.below(4) == 0:
                chosen[0, part] = stream.below(size)
        for part in range(worlds.num_deltas):
            if stream.below(4) == 0:
                deltas[0, part] = stream.between(-128, 128) / 128
        batch = worlds.step(chosen, deltas if worlds.num_deltas else None)
        states.append(worlds.state_hash(0))
        # All pixels are some 3,000 words a step: two environments' are enough.
        if env_id in ("VolcanicVentureLevel3-v0", "DetonatorsDilemmaLevel1-v0") and actions == "simplified":
            seen += np.frombuffer(batch.observations.tobytes(), "<u8").tolist()
        if batch.terminated[0] or batch.truncated[0]:
            episode += 1
            begin(worlds, episode)
    assert fingerprint(states) == state
    if seen:
        assert fingerprint(seen) == frames
