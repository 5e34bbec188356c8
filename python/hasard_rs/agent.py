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
from hasard_rs.registry import bare

Report = dict[str, Any]
"""A row of metrics.jsonl: frames, return, cost, multipliers and so on, by name."""


@dataclass(frozen=True)
class Run:
    """A run that has ended: its `directory`, whether the caller `stopped` it, and its `last` report."""

    directory: Path
    stopped: bool
    last: Report


def train(
    env_id: str,
    algorithm: str = "PPOPID",
    *,
    preset: str | None = None,
    out: str | os.PathLike[str] | None = None,
    callback: Callable[[Report], Any] | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    **flags: Any,
) -> Run:
    """Trains an agent, as `hasard train` does; other threads of Python run meanwhile.

    On a terminal a line tells how far it is.

    Args:
        env_id: one of `ids()`, with or without `hasard/`.
        algorithm: PPO, PPOCost, PPOLag, PPOSaute, PPOPID, P3O, TRPO, TRPOLag, TRPOPID, CPO, FOCOPS, CUP or IPO.
        preset: "quick", "paper", "released" or "tables"; None: the program's, "quick".
        out: the run's directory; None: one under runs/.
        callback: is called with every report, a dict by name (frames, fps, return_mean, cost_mean, ...); where it returns True the run ends, with
            a checkpoint. What it raises, and Ctrl-C, end the run the same way and are raised again.
        set: what the program takes as `--set name=value`.
        flags: the program's, with underscores: `frames=2_000_000, seed=1, envs=32, threads=2, size="64x48", maps="auto", resume=True`.

    Returns:
        A `Run`.

    Raises:
        InvalidOption for wrong settings, before anything is written.
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
    """Returns what `train` is given (env_id, algorithm, preset, out, set and flags) as words of the program."""
    words = [bare(env_id), "--algo", algorithm, "--quiet"]
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

    Made by `Agent.load`. Attributes: run, its directory; env_id; config, the run's settings.
    """

    def __init__(self, trained: Any, run: Path) -> None:
        self._trained = trained
        self.run = run
        self.env_id = f"hasard/{trained.env_id}"
        self.config: dict[str, Any] = json.loads((run / "config.json").read_text())

    @classmethod
    def load(cls, run: str | os.PathLike[str], *, best: bool = False, greedy: bool = False) -> Agent:
        """The agent of a run directory.

        Args:
            run: the directory that `train`, or the program, wrote.
            best: the best checkpoint within budget instead of the newest.
            greedy: takes the likeliest actions instead of drawing them.

        Returns:
            An agent.

        Raises:
            InvalidOption where there is no run, no checkpoint or a spoiled one.
        """
        return cls(_core.TrainedAgent(Path(run), best=best, greedy=greedy), Path(run))

    def arguments(self) -> dict[str, Any]:
        """Returns keyword arguments of environments like the one that the agent was trained in, its maps and pictures among them."""
        env = self.config["env"]
        told = {name: env[name] for name in ("rules", "full_actions", "frame_skip", "observation", "frame_stack")}
        told |= {"hard_constraint": env["hard"], "resolution": tuple(env["size"])}
        return told | {name: env[name] for name in ("early_creatures", "published_depth", "published_colours", "maps", "iwad") if name in env}

    def make(self, **arguments: Any) -> Any:
        """Returns a single environment like the one that the agent was trained in; `arguments` (see `help(hasard_rs.Env)`) come before its own."""
        import hasard_rs

        return hasard_rs.make(self.env_id, **{**self.arguments(), **self._format(), **arguments})

    def make_vec(self, num_envs: int = 1, **arguments: Any) -> Any:
        """A vector environment like the one that the agent was trained in, in SAME_STEP mode.

        Args:
            num_envs: lanes.
            arguments: see `help(hasard_rs.VectorEnv)`; they come before the agent's own.

        Returns:
            A `hasard_rs.VectorEnv`.
        """
        import hasard_rs

        given = {"autoreset_mode": "SameStep", **self.arguments(), **self._format(), **arguments}
        return hasard_rs.make_vec(self.env_id, num_envs, **given)

    def _format(self) -> dict[str, Any]:
        return {"action_format": "dict"} if self.config["env"]["full_actions"] else {}

    def begin(self, lanes: int, seed: int = 0) -> Any:
        """Returns what the agent remembers when episodes begin in so many `lanes`; its draws follow from `seed` and the lane."""
        return _State(self._trained.begin([(seed + lane) % 2**64 for lane in range(lanes)]), None, None, None)

    def act(self, observations: np.ndarray, state: Any = None) -> tuple[Any, Any]:
        """Chooses actions.

        Args:
            observations: uint8 [n, height, width, channels], or one, [height, width, channels].
            state: what the agent remembers, from `begin` or `after`; None: episodes begin.

        Returns:
            Actions, and what the agent remembers then. Actions are int64 [n, parts], or [parts] for one; of agents with full actions a dict of
            "buttons" and "deltas" (float32 [n, 2] in [-1, 1]).

        Raises:
            ValueError for observations of another shape, or cost terms that `after` was not told.
        """
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
        """What the agent remembers once a step is made.

        Args:
            state: what `act` gave.
            costs: of the step, float [n].
            over: lanes whose episodes are over, bool [n]: those begin anew.
            cost_terms: `infos["cost_terms"]`, float [n, k], of environments made with `infos="full"`: agents need it that watch one of the terms
                (PPOSaute under a budget of a named term). `act` raises ValueError without.

        Returns:
            The state for the next `act`.
        """
        terms = None if cost_terms is None else np.atleast_2d(cost_terms).astype(float).tolist()
        return _State(state.memory, np.atleast_1d(costs).astype(float).tolist(), np.atleast_1d(over).astype(bool).tolist(), terms)

    def evaluate(self, episodes: int = 20, seed: int = 0, *, best: bool = False, greedy: bool = False) -> list[dict[str, Any]]:
        """Plays episodes in worlds like those that the agent was trained in, as `hasard eval --json` does.

        Args:
            episodes: how many.
            seed: of the first.
            best: the best checkpoint within budget instead of the newest.
            greedy: the likeliest actions instead of drawn ones.

        Returns:
            A dict an episode, and the summary as the last.

        Raises:
            HasardError, with the program's line of what went wrong.
        """
        words = ["eval", os.fspath(self.run), "--episodes", str(episodes), "--seed", str(seed), "--json"]
        return _lines([*words, *["--latest"] * (not best), *["--greedy"] * greedy])

    def report(self, out: str | os.PathLike[str]) -> Path:
        """Writes the run's page of tables and curves into the folder `out`, as `hasard report` does. Returns the folder; raises HasardError."""
        return report([self.run], out)


@dataclass(frozen=True)
class _State:
    """What an agent remembers, and what has happened since its last step."""

    memory: Any
    costs: list[float] | None
    over: list[bool] | None
    terms: list[list[float]] | None


def report(runs: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> Path:
    """Writes one page of tables and curves from run directories, as `hasard report` does.

    Args:
        runs: directories, or folders of them.
        out: the folder of the page.

    Returns:
        The folder.

    Raises:
        HasardError, with the program's line of what went wrong.
    """
    _run(["report", *[os.fspath(run) for run in runs], "-o", os.fspath(out)])
    return Path(out)


def _run(words: Sequence[str]) -> str:
    done = subprocess.run([sys.executable, "-m", "hasard_rs.cli", *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise HasardError(done.stderr.strip().removeprefix("hasard: ") or f"hasard ended with {done.returncode}")
    return done.stdout


def _lines(words: Sequence[str]) -> list[dict[str, Any]]:
    return [json.loads(line) for line in _run(words).splitlines()]
