"""Wrong and hostile calls end in the documented exceptions; what was refused has moved nothing."""

from __future__ import annotations

import os
import signal
import threading
from typing import Any

import gymnasium
import numpy as np
import pytest

import hasard_rs
from hasard_rs import Worlds

ENV = "hasard/VolcanicVentureLevel1-v0"
ALLOWED = (hasard_rs.HasardError, TypeError, ValueError, IndexError, BufferError)


def worlds(n: int = 3, **arguments: Any) -> Worlds:
    made = Worlds(ENV, n, **{"num_threads": 1, "resolution": "64x48", **arguments})
    made.reset(1)
    return made


@pytest.mark.parametrize(
    ("actions", "error"),
    [
        (np.zeros((3, 5), int), ValueError),
        (np.zeros((2, 4), int), ValueError),
        (np.zeros(12, int), ValueError),
        (0, TypeError),
        (None, TypeError),
        ("jump", TypeError),
        (np.zeros((3, 4)), TypeError),
        (np.full((3, 4), np.nan), TypeError),
        (np.full((3, 4), 1 << 62), hasard_rs.InvalidAction),
        (np.full((3, 4), -1), hasard_rs.InvalidAction),
        ([[0, 0, 0], [1, 1, 1, 1]], ValueError),
        (np.zeros((3, 4), object), TypeError),
        (np.zeros((3, 4), complex), TypeError),
    ],
)
def test_wrong_actions_are_refused_and_move_nothing(actions: Any, error: type[Exception]) -> None:
    for made in (worlds(), worlds(num_threads=0)):
        before = [made.state_hash(lane) for lane in range(3)]
        with pytest.raises(error):
            made.step(actions)
        assert [made.state_hash(lane) for lane in range(3)] == before
        made.step(np.zeros((3, 4), np.int8))
    vec = hasard_rs.make_vec(ENV, 3, resolution="64x48")
    vec.reset(seed=1)
    with pytest.raises(error):
        vec.step(actions)


def test_a_bad_action_is_named_with_lane_part_value_and_range() -> None:
    actions = np.zeros((3, 4), int)
    actions[2, 1] = 300
    with pytest.raises(hasard_rs.InvalidAction, match=r"^action of lane 2: part 1 is 300; it must be 0\.\.=1$"):
        worlds().step(actions)


def test_every_dtype_order_and_stride_acts_alike() -> None:
    plain = np.array([[1, 1, 0, 1], [2, 0, 1, 0], [0, 1, 1, 1]])
    expected = worlds().step(plain).observations
    spread = np.zeros((6, 8), np.int16)
    spread[::2, ::2] = plain
    for given in [plain.tolist(), np.asfortranarray(plain), spread[::2, ::2], plain[::-1][::-1], *map(plain.astype, "bBhHiIlL")]:
        assert np.array_equal(worlds().step(given).observations, expected)


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ({"frame_skip": 0}, hasard_rs.InvalidOption, "frame_skip cannot be 0; it must be 1..=35"),
        ({"resolution": "10x10"}, hasard_rs.InvalidOption, "resolution"),
        ({"resolution": (64, -48)}, hasard_rs.InvalidOption, "resolution"),
        ({"frame_stack": 17}, hasard_rs.InvalidOption, "frame_stack"),
        ({"rules": "papyrus"}, hasard_rs.InvalidOption, "paper or released"),
        ({"observation": b"rgb"}, hasard_rs.InvalidOption, "observation"),
        ({"frameskip": 4}, TypeError, "did you mean 'frame_skip'"),
        ({"delta_bins": 4}, hasard_rs.InvalidOption, "odd"),
        ({"action_format": "text"}, hasard_rs.InvalidOption, "action_format"),
        ({"render_mode": "ansi"}, hasard_rs.InvalidOption, "render_mode"),
        ({"seed": -1}, ValueError, "negative"),
        ({"safety_budget": float("nan")}, hasard_rs.InvalidOption, "safety_budget cannot be nan; it must be a number, 0 or more"),
        ({"safety_budget": -1}, hasard_rs.InvalidOption, "safety_budget cannot be -1; it must be a number, 0 or more"),
        ({"max_episode_steps": 0}, hasard_rs.InvalidOption, "max_episode_steps"),
        ({"iwad": "/nowhere.wad"}, hasard_rs.InvalidOption, "/nowhere.wad"),
        ({"maps": 3}, hasard_rs.InvalidOption, "maps cannot be 3; it must be a path or 'auto'"),
        ({"render_resolution": "large"}, hasard_rs.InvalidOption, "render_resolution cannot be 'large'"),
    ],
)
def test_wrong_arguments_are_named(arguments: dict[str, Any], error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        hasard_rs.Env(scenario="VolcanicVenture", level=1, **arguments)
    with pytest.raises(error, match=text):
        hasard_rs.VectorEnv(scenario="VolcanicVenture", level=1, num_envs=2, **arguments)


@pytest.mark.parametrize("arguments", [{"num_envs": 0}, {"num_envs": -1}, {"num_envs": 70000}, {"num_envs": 2.0}, {"batch_size": 3}, {"autoreset_mode": "Never"}, {"num_threads": 5000}, {"num_threads": -1}])
def test_wrong_batches_are_named(arguments: dict[str, Any]) -> None:
    with pytest.raises(hasard_rs.InvalidOption):
        hasard_rs.VectorEnv(scenario="VolcanicVenture", level=1, **{"num_envs": 4, "resolution": "64x48", **arguments})


def test_unknown_ids_name_the_nearest() -> None:
    for make in (hasard_rs.make, hasard_rs.make_vec, hasard_rs.spec):
        with pytest.raises(hasard_rs.UnknownEnvironment, match="VolcanicVentureLevel1-v0"):
            make("hasard/VulcanicVentureLevel1-v0")


def test_what_is_no_id_is_refused() -> None:
    for make in (hasard_rs.make, hasard_rs.make_vec, hasard_rs.spec, hasard_rs.train):
        for wrong in (None, 5, b"VolcanicVentureLevel1-v0"):
            with pytest.raises(TypeError, match="id must be a str"):
                make(wrong)  # type: ignore[operator]
    for scenario, level in (("VolcanicVentura", 1), ("VolcanicVenture", 7)):
        with pytest.raises(hasard_rs.UnknownEnvironment):
            hasard_rs.register_environment(scenario, level)


@pytest.mark.parametrize("action_format", ["multi_discrete", "tuple", "dict", "discrete", "box"])
def test_every_format_refuses_what_is_no_action(action_format: str, full: bool) -> None:
    made: dict[bool, Any] = {}
    for vector in (False, True):
        how = {"action_format": action_format, "full_actions": True, "resolution": "64x48", "max_episode_steps": 20}
        made[vector] = hasard_rs.make_vec(ENV, 2, **how) if vector else hasard_rs.make(ENV, **how).unwrapped
        made[vector].reset(seed=3)
    rng = np.random.default_rng(5)
    parts = [0, 1, -1, 300, 1 << 63, 0.5, np.nan, np.inf, 1j, None, "x", b"x", [], {}, object(), np.uint64(1), np.True_, np.zeros(2), [0, 0], [[0], [0]]]

    def junk() -> Any:
        shape = rng.integers(7)
        part = parts[rng.integers(len(parts))]
        if shape == 0:
            return part
        if shape == 1:
            return [part] * int(rng.integers(13))
        if shape == 2:
            return tuple(parts[rng.integers(len(parts))] for _ in range(11))
        if shape == 3:
            return {name: parts[rng.integers(len(parts))] for name in ("buttons", "deltas", "more")[: rng.integers(1, 4)]}
        kinds = [np.int8, np.uint8, np.int64, np.uint64, np.bool_, np.float16, np.float32, np.float64, np.complex64, "U3", object]
        array = np.zeros(tuple(rng.integers(0, 13, rng.integers(4))), kinds[rng.integers(len(kinds))])
        return {"buttons": array, "deltas": part} if shape == 4 else array[::-1] if array.ndim else array

    refused = 0
    for _ in range(10_000 if full else 600):
        env = made[bool(rng.integers(2))]
        before = env.save()
        try:
            _, _, terminated, truncated, _ = env.step(junk() if rng.integers(4) else env.action_space.sample())
        except (TypeError, ValueError):
            refused += 1
            assert env.save() == before, "what was refused has moved nothing"
        else:
            if env is made[False] and (terminated or truncated):
                env.reset()
    assert refused > 100


def test_use_after_close_and_out_of_turn() -> None:
    made = worlds()
    made.close()
    made.close()
    assert made.closed
    for call in (made.reset, made.save, lambda: made.step(np.zeros((3, 4), int)), made.recv, lambda: made.positions):
        with pytest.raises(hasard_rs.Closed):
            call()
    fresh = Worlds(ENV, 2, num_threads=0, groups=2, resolution="64x48")
    with pytest.raises(gymnasium.error.ResetNeeded):
        fresh.step(np.zeros((2, 4), int))
    fresh.reset(0)
    with pytest.raises(hasard_rs.OutOfTurn, match="send it first"):
        fresh.recv(1)
    fresh.send(np.zeros((1, 4), int), group=1)
    for call in (lambda: fresh.send(np.zeros((1, 4), int), group=1), fresh.reset, fresh.save, lambda: fresh.step(np.zeros((2, 4), int))):
        with pytest.raises(hasard_rs.OutOfTurn):
            call()
    assert fresh.recv(1).lanes.tolist() == [1]
    env = hasard_rs.make(ENV, resolution="64x48").unwrapped
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step([0, 0, 0, 0])
    with pytest.raises(AttributeError, match="no ViZDoom"):
        env.game  # noqa: B018


def test_masks_are_refused_with_gymnasiums_texts() -> None:
    vec = hasard_rs.make_vec(ENV, 3, resolution="64x48")
    vec.reset(seed=0)
    for mask, error, text in [
        ([True] * 3, TypeError, "must be a numpy array, got"),
        (np.ones(2, bool), ValueError, r"must have shape `\(3,\)`, got"),
        (np.ones(3, int), TypeError, "must have `dtype=np.bool_`, got"),
        (np.zeros(3, bool), ValueError, "must contain a boolean array with at least one True value"),
    ]:
        options = {"reset_mask": mask}
        with pytest.raises(error, match=text):
            vec.reset(options=options)
        assert "reset_mask" in options, "the caller's dict is left alone"


@pytest.mark.parametrize("seed", range(7, 10))
def test_ten_thousand_random_calls(seed: int, full: bool) -> None:
    rng = np.random.default_rng(seed)
    made, other = worlds(4, groups=2), worlds(2, autoreset_mode="Disabled", full_actions=True, max_episode_steps=30)
    state = other.save()
    junk = [None, -1, 0, 3.5, 1 << 70, "x", b"x", [], {}, np.nan, np.zeros((4, 4)), np.full((4, 4), 2), np.ones(4, bool), object(), np.inf]

    def any_of() -> Any:
        return junk[rng.integers(len(junk))]

    good = {"made": np.zeros((4, 4), int), "half": np.zeros((2, 4), int), "other": np.zeros((2, 9), int)}
    calls = [
        lambda: made.step(good["made"]),
        lambda: made.step(any_of()),
        lambda: made.send(good["half"], group=int(rng.integers(-1, 3))),
        lambda: made.recv(int(rng.integers(-1, 3))),
        lambda: made.step(good["half"], lanes=rng.integers(-1, 5, 2).tolist()),
        lambda: made.reset(any_of(), any_of()),
        lambda: made.reset(mask=np.array([True, False, True, False])),
        lambda: other.step(good["other"], any_of()),
        lambda: other.step(good["other"], rng.normal(size=(2, 2))),
        lambda: other.reset(mask=rng.integers(0, 2, 2).astype(bool)),
        lambda: other.load(bytes(rng.integers(0, 256, 60, dtype=np.uint8))),
        lambda: other.load(state[: rng.integers(len(state))]),
        lambda: other.load(state),
        lambda: other.render(int(rng.integers(-1, 4)), any_of(), any_of()),
        lambda: made.bind(observations=any_of(), rewards=any_of(), costs=any_of(), terminated=any_of(), truncated=any_of()),
        lambda: made.state_hash(any_of() if rng.integers(2) else int(rng.integers(6))),
        lambda: hasard_rs.Worlds(any_of(), any_of(), frame_skip=any_of()),
    ]
    done = 0
    for _ in range(10_000 if full or seed == 7 else 1_000):
        try:
            calls[rng.integers(len(calls))]()
            done += 1
        except ALLOWED:
            pass
    assert done > 100


def test_threads_that_call_at_random_while_one_closes() -> None:
    for seed in range(20):
        made, wrong = worlds(4, groups=2), []

        def hammer(seed: int, made: Worlds = made, wrong: list[BaseException] = wrong) -> None:
            rng = np.random.default_rng(seed)
            calls = [
                lambda: made.step(np.zeros((4, 4), int)),
                lambda: made.send(np.zeros((2, 4), int), group=int(rng.integers(2))),
                lambda: made.recv(int(rng.integers(2))),
                lambda: made.reset(mask=np.array([True, False, True, False])),
                lambda: made.load(made.save()),
                lambda: made.render(1),
            ]
            for _ in range(40):
                try:
                    calls[rng.integers(len(calls))]()
                except ALLOWED:
                    pass
                except BaseException as error:  # noqa: BLE001
                    wrong.append(error)

        threads = [threading.Thread(target=hammer, args=(seed * 10 + i,)) for i in range(3)]
        for thread in threads:
            thread.start()
        if seed % 2:
            made.close()
        for thread in threads:
            thread.join(timeout=60)
            assert not thread.is_alive(), "nobody waits for ever"
        assert not wrong
        made.close()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers here")
def test_interrupted_calls_leave_the_worlds_whole(full: bool) -> None:
    made, interrupts = worlds(4), 0

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for attempt in range(20_000 if full else 1_000):
            try:
                # From 20 us to 1 ms: some of them end within a call, whatever the machine's speed.
                signal.setitimer(signal.ITIMER_REAL, 0.00002 * (1 + attempt % 50))
                made.step(np.zeros((4, 4), int))
                made.render(0)
                signal.setitimer(signal.ITIMER_REAL, 0)
            except KeyboardInterrupt:
                interrupts += 1
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    state = made.save()
    copy = worlds(4)
    copy.load(state)
    assert np.array_equal(made.step(np.ones((4, 4), int)).observations, copy.step(np.ones((4, 4), int)).observations)
    assert interrupts, "the timer was quick enough to disturb"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_every_call_in_a_forked_child_is_refused() -> None:
    made = worlds(2)
    calls = [made.reset, made.save, lambda: made.step(np.zeros((2, 4), int)), lambda: made.recv(0), lambda: made.render(0), lambda: made.positions]
    child = os.fork()
    if child == 0:
        outcome = 0
        for call in calls * 50:
            try:
                call()
                outcome = 1
            except hasard_rs.OutOfTurn:
                pass
        made.close()
        os._exit(outcome)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    made.step(np.zeros((2, 4), int))


def test_two_threads_take_turns() -> None:
    made, errors = worlds(4), []

    def step() -> None:
        try:
            for _ in range(100):
                made.step(np.zeros((4, 4), int))
        except BaseException as error:  # noqa: BLE001
            errors.append(error)

    threads = [threading.Thread(target=step) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    expected = worlds(4)
    for _ in range(200):
        expected.step(np.zeros((4, 4), int))
    assert not errors and made.state_hash(2) == expected.state_hash(2)
