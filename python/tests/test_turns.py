"""Send, recv, step, reset and close of a batch, in every order, against a model of what each call does.

The model has worlds of its own for each group, which it steps where actions are sent, and knows of a group only whether it waits for actions (due) or
has a result that was not fetched (waiting), and which comes next. What a call raises and what it returns must be the model's.
"""

from __future__ import annotations

import itertools
import pickle
from typing import Any

import numpy as np
import pytest
from conftest import assert_same

import hasard_rs

ENV = "hasard/CollateralDamageLevel1-v0"
LANES = 2
# Episodes of two steps: they end within the sequences.
HOW: dict[str, Any] = {"resolution": "64x48", "max_episode_steps": 2}
CALLS = ("reset", "seeded", "masked", "send", "recv", "step", "close")
SEED, OTHER = 5, 9
WORLDS: dict[tuple[int, str], list[hasard_rs.Worlds]] = {}


class Model:
    """What a batch of `groups` groups of two lanes must do."""

    def __init__(self, groups: int, mode: str) -> None:
        # A new model's worlds may be used ones: it resets them before it looks.
        if (groups, mode) not in WORLDS:
            WORLDS[groups, mode] = [hasard_rs.Worlds(ENV, LANES, num_threads=0, autoreset_mode=mode, **HOW) for _ in range(groups)]
        self.worlds = WORLDS[groups, mode]
        self.groups, self.closed, self.begun = groups, False, False
        self.due: list[int] = []
        self.waiting: dict[int, Any] = {}
        self.coming = 0

    def do(self, call: str, actions: Any, mask: Any) -> Any:
        """The name of the error, or (group, observations, rewards, costs, flags); None where nothing is returned."""
        if call == "close":
            self.closed = True
            return None
        if self.closed:
            return "Closed"
        return getattr(self, call)(actions, mask)

    def returned(self, result: Any) -> Any:
        self.due.append(self.coming)
        self.coming = (self.coming + 1) % self.groups
        return result

    def begin(self, seed: int | None) -> Any:
        """All begin anew; the first group is returned, the others wait to be fetched."""
        for group, worlds in enumerate(self.worlds):
            worlds.reset(None if seed is None else [seed + group * LANES + lane for lane in range(LANES)])
        self.begun, self.due, self.coming = True, [], 0
        self.waiting = {group: rest(group, worlds) for group, worlds in enumerate(self.worlds)}
        return self.returned(self.waiting.pop(0))

    def reset(self, actions: Any, mask: Any) -> Any:
        return self.begin(None if self.begun else SEED)

    def seeded(self, actions: Any, mask: Any) -> Any:
        return self.begin(OTHER)

    def masked(self, actions: Any, mask: Any) -> Any:
        if not self.begun:
            return "ResetNeeded"
        if not self.due:
            return "OutOfTurn"
        first = self.due[0]
        for group, worlds in enumerate(self.worlds):
            own = mask[group * LANES : (group + 1) * LANES]
            if own.any():
                worlds.reset(mask=own)
            if group not in self.waiting:
                self.waiting[group] = rest(group, worlds)
                continue
            # What was not fetched keeps its rewards and costs where lanes were left alone.
            _, observations, rewards, costs, flags = self.waiting[group]
            observations = observations.copy()
            observations[own] = rest(group, worlds)[1][own]
            self.waiting[group] = (group, observations, np.where(own, 0, rewards), np.where(own, 0, costs), flags & ~own)
        self.due, self.coming = [], first
        return self.returned(self.waiting.pop(first))

    def send(self, actions: Any, mask: Any) -> Any:
        if not self.begun:
            return "ResetNeeded"
        if not self.due:
            return "OutOfTurn"
        group = self.due[0]
        try:
            batch = self.worlds[group].step(actions)
        except hasard_rs.ResetNeeded:
            return "ResetNeeded"
        del self.due[0]
        self.waiting[group] = (group, batch.observations, batch.rewards, batch.costs, batch.terminated | batch.truncated)
        return None

    def recv(self, actions: Any, mask: Any) -> Any:
        if self.coming not in self.waiting:
            return "OutOfTurn"
        return self.returned(self.waiting.pop(self.coming))

    def step(self, actions: Any, mask: Any) -> Any:
        sent = self.send(actions, mask)
        return sent if isinstance(sent, str) else self.recv(actions, mask)


def rest(group: int, worlds: hasard_rs.Worlds) -> Any:
    """What worlds show between steps."""
    nothing = np.zeros(LANES, np.float32)
    shown = worlds.load(worlds.save()).observations
    return group, shown, nothing, nothing, nothing.astype(bool)


def done(envs: hasard_rs.VectorEnv, call: str, actions: Any, mask: Any) -> Any:
    """What the batch does, in the model's words."""
    calls = {
        "reset": envs.reset,
        "seeded": lambda: envs.reset(seed=OTHER),
        "masked": lambda: envs.reset(options={"reset_mask": mask}),
        "send": lambda: envs.send(actions),
        "recv": envs.recv,
        "step": lambda: envs.step(actions),
        "close": envs.close,
    }
    try:
        result = calls[call]()
    except hasard_rs.HasardError as error:
        return type(error).__name__
    if result is None:
        return None
    infos = result[-1]
    group = int(infos["env_id"][0]) // LANES if "env_id" in infos else 0
    nothing = np.zeros(LANES)
    rewards, flags = (result[1], result[2] | result[3]) if len(result) == 5 else (nothing, nothing.astype(bool))
    return group, result[0], rewards, infos["cost"], flags


def compare(found: Any, wanted: Any, where: str) -> None:
    if not isinstance(wanted, tuple):
        assert found == wanted, f"{where}: {found if isinstance(found, str) else type(found)}, not {wanted}"
        return
    assert isinstance(found, tuple), f"{where}: {found}, not a result"
    for what, one, other in zip(("group", "observations", "rewards", "costs", "flags"), found, wanted, strict=True):
        assert np.array_equal(one, other), f"{where}: {what} {one} and {other}"


class Both:
    """A batch, and the model beside it."""

    def __init__(self, groups: int, mode: str) -> None:
        how = {**HOW, "batch_size": LANES, "autoreset_mode": mode, "num_threads": 0, "seed": SEED}
        self.envs, self.model = hasard_rs.make_vec(ENV, groups * LANES, **how), Model(groups, mode)
        self.actions, self.mask = np.ones((LANES, 2), int), np.arange(groups * LANES) % 2 == 0

    def do(self, calls: tuple[str, ...], where: Any) -> None:
        for at, call in enumerate(calls):
            compare(done(self.envs, call, self.actions, self.mask), self.model.do(call, self.actions, self.mask), f"{where} {calls} at {at}")


GROUPS = pytest.mark.parametrize(("groups", "mode"), [(1, "NextStep"), (2, "SameStep"), (3, "Disabled"), (3, "NextStep")])


@GROUPS
def test_every_order_of_four_calls(groups: int, mode: str) -> None:
    # One batch does them all: each order begins with a reset, or in whatever state the one before has left.
    both = Both(groups, mode)
    for number, calls in enumerate(itertools.product([call for call in CALLS if call != "close"], repeat=4)):
        both.do(("seeded", *calls) if number % 2 else calls, number)


@GROUPS
def test_every_order_before_the_first_reset_and_after_close(groups: int, mode: str) -> None:
    both = Both(groups, mode)
    for calls in itertools.product(["masked", "send", "recv", "step"], repeat=2):
        both.do(calls, "never reset")
    both.do(("reset", "step"), "never reset")
    for before in ("masked", "send", "recv", "step"):
        both.do(("reset", before, "close", *CALLS), "closed")
        both = Both(groups, mode)


@pytest.mark.parametrize("copy", [True, False])
def test_looking_and_pickling_wait_and_lose_nothing(copy: bool) -> None:
    how = {**HOW, "batch_size": LANES, "num_threads": 1, "render_mode": "rgb_array", "infos": "full", "env_stats": True}
    envs, looked = (hasard_rs.make_vec(ENV, 3 * LANES, copy=copy, **how) for _ in range(2))
    assert_same(envs.reset(seed=3), looked.reset(seed=3))
    actions = np.ones((LANES, 2), int)
    for turn in range(9):
        envs.send(actions)
        looked.send(actions)
        assert len(looked.render()) == 3 * LANES and len(looked.call("state_hash")) == 3 * LANES
        if turn % 3 == 1:
            looked = pickle.loads(pickle.dumps(looked))
        assert_same(looked.recv(), envs.recv(), f"turn {turn}")


def test_what_is_under_way_is_not_forgotten_by_others() -> None:
    envs = hasard_rs.make_vec(ENV, 2, **HOW)
    actions = np.ones((2, 2), int)
    envs.reset(seed=1)
    envs.send(actions)
    for look in (envs.call, envs.get_attr):
        look("position")
    for call in (lambda: envs.step(actions), lambda: envs.send(actions), lambda: envs.reset(options={"reset_mask": np.array([True, False])})):
        with pytest.raises(hasard_rs.OutOfTurn, match="recv first"):
            call()
    envs.recv()
    envs.step(actions)


def test_ends_are_reported_for_the_lanes_that_were_not_reset() -> None:
    envs = hasard_rs.make_vec(ENV, 4, **HOW, batch_size=2, autoreset_mode="SameStep", infos="full")
    envs.reset(seed=2)
    actions = np.ones((2, 2), int)
    for _ in range(3):
        envs.step(actions)
    # Group 1's second step, the last of its episodes, is under way now, and group 0 was returned.
    envs.step(actions)
    observations, infos = envs.reset(options={"reset_mask": np.array([False, False, True, False])})
    assert infos["env_id"].tolist() == [0, 1] and not infos["_cost"].any()
    envs.send(actions)
    _, _, terminated, truncated, infos = envs.recv()
    assert infos["env_id"].tolist() == [2, 3] and (terminated | truncated).tolist() == [False, True]
    for key in ("episode_summary", "final_obs", "final_info"):
        if key in infos:
            assert infos[f"_{key}"].tolist() == [False, True], key
    assert infos["final_obs"][0] is None and infos["final_info"]["episode_summary"]["length"][1] == 2.0
    assert infos["_cost"].all() and infos["cost"][0] == 0.0
