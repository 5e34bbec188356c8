"""Training from Python, and trained agents at work. Run directories are the same as the program's."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hasard_rs import _core
from hasard_rs.errors import HasardError
from hasard_rs.progress import Bar

Report = dict[str, Any]
"""A row of metrics.jsonl: frames, return, cost, multipliers and so on, by name."""


@dataclass(frozen=True)
class Run:
    """A run that has ended: its directory, whether the caller stopped it, and its last report."""

    directory: Path
    stopped: bool
    last: Report


def train(
    env_id: str,
    algorithm: str = "PPOLag",
    *,
    preset: str | None = None,
    out: str | os.PathLike[str] | None = None,
    callback: Callable[[Report], Any] | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    **flags: Any,
) -> Run:
    """Trains an agent, as `hasard train` does; other threads of Python run meanwhile.

    flags are the program's, with underscores: `frames=2_000_000, seed=1, envs=32, threads=2, resume=True`; `set` holds what the program takes as
    `--set name=value`. callback is called with every report, a dict; where it returns True the run ends, with a checkpoint. What it raises,
    and Ctrl-C, end the run the same way and are raised again. Wrong settings: `InvalidOption`, before anything is written. On a terminal a line
    tells how far it is.
    """
    words = training_words(env_id, algorithm, preset=preset, out=out, set=set, **flags)
    with Bar(flags.get("frames")) as bar:

        def hear(report: Report) -> Any:
            bar.show(report)
            return callback is not None and callback(report)

        directory, stopped, last = _core.train(words, hear if bar.seen else callback, lambda text: warnings.warn(text, stacklevel=2))
    return Run(Path(directory), stopped, last)


def training_words(
    env_id: str,
    algorithm: str,
    *,
    preset: str | None = None,
    out: str | os.PathLike[str] | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    **flags: Any,
) -> list[str]:
    """What `train` is given, as words of the program."""
    words = [env_id.removeprefix("hasard/"), "--algo", algorithm, "--quiet"]
    for name, value in {"preset": preset, "out": None if out is None else os.fspath(out), **flags}.items():
        flag = "--" + name.replace("_", "-")
        if value is True:
            words.append(flag)
        elif isinstance(value, (list, tuple)):
            words += [word for one in value for word in (flag, str(one))]
        elif value is not None and value is not False:
            words += [flag, str(value)]
    for name, value in (set or {}).items():
        words += ["--set", f"{name}={json.dumps(value) if not isinstance(value, str) else value}"]
    return words


class Agent:
    """A trained agent. `act` is a function of what it is given: what the agent remembers is handed in and out.

        agent = Agent.load("runs/vv1")
        env = agent.make_vec(8)
        observations, infos = env.reset(seed=0)
        state = None
        for _ in range(1000):
            actions, state = agent.act(observations, state)
            observations, rewards, terminations, truncations, infos = env.step(actions)
            state = agent.after(state, infos["cost"], terminations | truncations)
    """

    def __init__(self, trained: Any, run: Path) -> None:
        self._trained = trained
        self.run = run
        self.env_id = f"hasard/{trained.env_id}"
        self.config: dict[str, Any] = json.loads((run / "config.json").read_text())

    @classmethod
    def load(cls, run: str | os.PathLike[str], *, best: bool = False, greedy: bool = False) -> Agent:
        """The agent of a run directory: its newest checkpoint or the best within budget; drawing its actions, or taking the likeliest."""
        return cls(_core.TrainedAgent(Path(run), best=best, greedy=greedy), Path(run))

    def arguments(self) -> dict[str, Any]:
        """Keyword arguments of environments like the one that the agent was trained in."""
        env = self.config["env"]
        told = {name: env[name] for name in ("rules", "full_actions", "frame_skip", "observation", "frame_stack")}
        told |= {"hard_constraint": env["hard"], "resolution": tuple(env["size"])}
        return told | {name: env[name] for name in ("published_depth", "published_colours", "iwad") if name in env}

    def make(self, **arguments: Any) -> Any:
        """A single environment like the one that the agent was trained in."""
        import hasard_rs

        return hasard_rs.make(self.env_id, **{**self.arguments(), **self._format(), **arguments})

    def make_vec(self, num_envs: int = 1, **arguments: Any) -> Any:
        """A vector environment like the one that the agent was trained in, in SAME_STEP mode."""
        import hasard_rs

        given = {"autoreset_mode": "SameStep", **self.arguments(), **self._format(), **arguments}
        return hasard_rs.make_vec(self.env_id, num_envs, **given)

    def _format(self) -> dict[str, Any]:
        return {"action_format": "dict"} if self.config["env"]["full_actions"] else {}

    def begin(self, lanes: int, seed: int = 0) -> Any:
        """What the agent remembers when episodes begin; its draws follow from `seed` and the lane."""
        return _State(self._trained.begin([(seed + lane) % 2**64 for lane in range(lanes)]), None, None, None)

    def act(self, observations: np.ndarray, state: Any = None) -> tuple[Any, Any]:
        """Actions for observations uint8 [n, ...] (or one, [...]), and what the agent remembers then. state=None: episodes begin."""
        single = observations.ndim == 3
        observations = observations[None] if single else observations
        state = self.begin(len(observations)) if state is None else state
        actions, deltas, after = self._trained.act(observations, state.memory, state.costs, state.over, state.terms)
        chosen: Any = actions
        if deltas.shape[1]:
            chosen = {"buttons": actions[0], "deltas": deltas[0]} if single else {"buttons": actions, "deltas": deltas}
        elif single:
            chosen = actions[0]
        return chosen, _State(after, None, None, None)

    def after(self, state: Any, costs: Any, over: Any, cost_terms: Any = None) -> Any:
        """What the agent remembers once a step has cost so much (float [n]), and episodes are over in these lanes (bool [n]): those begin anew.

        Agents that watch one of the cost terms (PPOSaute under a budget of a named term) need `infos["cost_terms"]` ([n, k]) too, which environments
        made with `infos="full"` have; `act` raises ValueError without.
        """
        terms = None if cost_terms is None else np.atleast_2d(cost_terms).astype(float).tolist()
        return _State(state.memory, np.atleast_1d(costs).astype(float).tolist(), np.atleast_1d(over).astype(bool).tolist(), terms)

    def evaluate(self, episodes: int = 20, seed: int = 0, *, best: bool = False, greedy: bool = False) -> list[dict[str, Any]]:
        """Plays episodes as `hasard eval --json` does: a dict each, and the summary as the last."""
        words = ["eval", os.fspath(self.run), "--episodes", str(episodes), "--seed", str(seed), "--json"]
        return _lines([*words, *["--latest"] * (not best), *["--greedy"] * greedy])

    def report(self, out: str | os.PathLike[str]) -> Path:
        """Writes the run's page of tables and curves, as `hasard report` does."""
        return report([self.run], out)


@dataclass(frozen=True)
class _State:
    """What an agent remembers, and what has happened since its last step."""

    memory: Any
    costs: list[float] | None
    over: list[bool] | None
    terms: list[list[float]] | None


def report(runs: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> Path:
    """Writes one page of tables and curves from run directories, as `hasard report` does."""
    _run(["report", *[os.fspath(run) for run in runs], "-o", os.fspath(out)])
    return Path(out)


def _run(words: Sequence[str]) -> str:
    done = subprocess.run([sys.executable, "-m", "hasard_rs.cli", *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise HasardError(done.stderr.strip().removeprefix("hasard: ") or f"hasard ended with {done.returncode}")
    return done.stdout


def _lines(words: Sequence[str]) -> list[dict[str, Any]]:
    return [json.loads(line) for line in _run(words).splitlines()]
