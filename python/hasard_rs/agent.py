"""Training from Python, and trained agents at work. Run directories are the same as the program's."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np

from hasard_rs import _core
from hasard_rs.arguments import check_seed, is_number, is_whole, over, plain
from hasard_rs.errors import HasardError, InvalidOption
from hasard_rs.own import from_text
from hasard_rs.progress import Bar
from hasard_rs.registry import bare, spec

Report = dict[str, Any]
"""A row of metrics.jsonl: frames, return, cost, multipliers and so on, by name."""


@dataclass(frozen=True)
class Run:
    """A run that has ended: its `directory`, whether the caller `stopped` it, and its `last` report."""

    directory: Path
    stopped: bool
    last: Report

    @property
    def selection(self) -> dict[str, Any] | None:
        """The checkpoint that the run selected, as in `selected.json`: "frames", "closing" (what it is worth in episodes that had no part in the choice),
        "last" (the same of the last policy) and more; None for a run that was stopped, or never evaluated."""
        for name in ("selected.json", "hand_out.json"):
            if (self.directory / name).is_file():
                return json.loads((self.directory / name).read_text())  # type: ignore[no-any-return]
        return None

    @property
    def closing(self) -> dict[str, Any] | None:
        """What the run is worth: the closing evaluation of the selected checkpoint, or None."""
        return (self.selection or {}).get("closing")


def train(
    env_id: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    algorithm: str | None = None,
    *,
    preset: str | None = None,
    out: str | os.PathLike[str] | None = None,
    callback: Callable[[Report], Any] | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    **flags: Any,
) -> Run:
    """Trains an agent, as `hasard train` does; other threads of Python run meanwhile.

    On a terminal a line shows how far it is.

    Args:
        env_id: one of `ids()`, with or without `hasard/`; the path of a task of your own; or a list of them, which the worlds take in turn.
        algorithm: PPO, PPOCost, PPOLag, PPOSaute, PPOPID, P3O, TRPO, TRPOLag, TRPOPID, CPO, FOCOPS, CUP or IPO; None: the program's, PPOPID, or
            that of the run that is resumed.
        preset: "quick", "paper", "released" or "tables"; None: the program's, "quick".
        out: the run's directory; None: one under runs/.
        callback: is called with every report, a dict by name (frames, fps, return_mean, cost_mean, ...); where it returns True the run ends, with
            a checkpoint. What it raises, and Ctrl-C, end the run the same way and are raised again.
        set: what the program takes as `--set name=value`.
        flags: the program's, with underscores: `frames=2_000_000, seed=1, envs=32, threads=2, size="64x48", maps="auto", resume=True`. Names of
            environments' arguments do too (`hard_constraint`, `resolution`, `map`), and pairs and lists (`size=(64, 48)`, `curriculum=[1, 2]`,
            `safety_budget=["jumps=5", "lava=20"]`); `async_` stands for --async.

    Returns:
        A `Run`.

    Raises:
        InvalidOption for wrong settings, before anything is written.
    """
    if callback is not None and not callable(callback):
        raise InvalidOption(f"callback cannot be {callback!r:.60}; it must be a function of a report, or None")
    words = training_words(env_id, algorithm, preset=preset, out=out, set=set, **flags)
    frames = flags.get("frames")
    with Bar(int(frames) if isinstance(frames, (int, float)) and math.isfinite(frames) else None) as bar:

        def hear(report: Report) -> Any:
            bar.show(report)
            return callback is not None and callback(report)

        directory, stopped, last = _core.train(words, hear if bar.seen else callback, lambda text: warnings.warn(text, stacklevel=2))
    return Run(Path(directory), stopped, last)


def training_words(
    env_id: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    algorithm: str | None,
    *,
    preset: str | None = None,
    out: str | os.PathLike[str] | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    **flags: Any,
) -> list[str]:
    """Returns what `train` is given (env_id, algorithm, preset, out, set and flags) as words of the program. Raises InvalidOption for
    one setting by two names that contradict each other."""
    tasks = env_id if isinstance(env_id, (list, tuple)) else [env_id]
    words = [",".join(bare(plain(task)) for task in tasks), "--quiet"]
    if set is not None and not isinstance(set, Mapping):
        raise InvalidOption(f"set cannot be {set!r:.60}; it must be a dict of settings by name, such as {{'learning.rate': 0.0003}}")
    names = {"algorithm": algorithm, "preset": preset, "out": None if out is None else os.fsdecode(out), **flags}
    given: dict[str, tuple[str, list[str]]] = {}
    for other, value in names.items():
        # `async` is a word of Python's, so that `async_` stands for it.
        name = _FLAGS.get(other, other).rstrip("_")
        made = _words(name, plain(value))
        if value is None:
            continue
        if name in given and given[name][1] != made:
            first = given[name][0]
            text = f"{first}={names[first]!r} and {other}={value!r} contradict each other: both name one setting; give one of them"
            raise InvalidOption(text)
        given[name] = (other, made)
    words += [word for _, made in given.values() for word in made]
    for name, value in (set or {}).items():
        words.append(f"--set={name}={value if isinstance(value, str) else json.dumps(plain(value))}")
    return words


_FLAGS = {"algorithm": "algo", "hard_constraint": "hard", "resolution": "size", "map": "maps"}
"""The program's name of each setting that environments have another name for."""


def _words(name: str, value: Any) -> list[str]:
    """A setting as words of the program; none where it is off, or says that nothing is printed."""
    flag = "--" + name.replace("_", "-")
    if value is None or value is False or name == "quiet":
        return []
    if value is True:
        return [flag]
    if isinstance(value, float) and value.is_integer():
        # 2e6 frames.
        value = int(value)
    if isinstance(value, (list, tuple)):
        if name == "size":
            return [f"{flag}={'x'.join(map(str, value))}"]
        if name == "curriculum":
            return [f"{flag}={','.join(map(str, value))}"]
        return [f"{flag}={one}" for one in value]
    # In one word, so that a value that begins with a dash is no flag.
    return [f"{flag}={value}"]


class Agent:
    """A trained agent. `act` is a function of what it is given: what the agent remembers is passed in and returned.

        agent = Agent.load("runs/vv1")
        env = agent.make_vec(8)
        observations, infos = env.reset(seed=0)
        state = None
        for _ in range(1000):
            actions, state = agent.act(observations, state)
            observations, rewards, terminations, truncations, infos = env.step(actions)
            state = agent.after(state, infos["cost"], terminations | truncations)

    Made by `Agent.load`, with its best and greedy. Agents and states can be pickled and copied; an agent is then loaded again,
    from the same place. Attributes: run, the directory, file or "zoo:NAME" that it came from; env_id; config, the run's settings.
    """

    def __init__(self, trained: Any, run: Path, best: bool = False, greedy: bool = False) -> None:
        self._trained = trained
        self._how = {"best": best, "greedy": greedy}
        self.run = run
        self.env_id = f"hasard/{trained.env_id}"
        self.config: dict[str, Any] = json.loads(trained.config)

    @classmethod
    def load(cls, run: str | os.PathLike[str], *, best: bool = False, greedy: bool = False) -> Agent:
        """The agent of a run directory, of a file of `hasard export-agent`, or of the zoo.

        Args:
            run: the directory that `train`, or the program, wrote; a file; or "zoo:NAME", such as "zoo:RemedyRushLevel1".
            best: the best checkpoint within budget instead of the newest; the newest too of a run without one. A file has one agent.
            greedy: takes the likeliest actions instead of drawing them.

        Returns:
            An agent.

        Raises:
            InvalidOption where there is no run, no checkpoint or a spoiled one, or no such agent in the zoo.
        """
        return cls(_core.TrainedAgent(run, best=best, greedy=greedy), Path(run), best, greedy)

    def __reduce__(self) -> tuple[Callable[[], Agent], tuple[()]]:
        """For pickle and copies: the agent is loaded again, from the same place."""
        place = str(self.run)
        return partial(Agent.load, place if place.startswith("zoo:") else os.path.abspath(place), **self._how), ()

    def arguments(self) -> dict[str, Any]:
        """Returns keyword arguments of environments like the one that the agent was trained in, its maps and pictures among them."""
        env = self.config["env"]
        arguments = {name: env[name] for name in ("rules", "full_actions", "frame_skip", "observation", "frame_stack")}
        arguments |= {"hard_constraint": env["hard"], "resolution": tuple(env["size"])}
        # The attribute that wrappers such as `Saute` go by is what the agent was trained for.
        scalar = [one["budget"] for one in self.config["constraints"] if one.get("term") is None]
        arguments |= {"safety_budget": scalar[0]} if scalar else {}
        return arguments | {name: env[name] for name in ("early_creatures", "published_depth", "published_colours", "maps", "iwad") if env.get(name) is not None}

    def make(self, **arguments: Any) -> Any:
        """Returns a single environment like the one that the agent was trained in; `arguments` (see `help(hasard_rs.Env)`, by
        either name) come before its own. Raises InvalidOption for an agent of several tasks, which `make_vec` makes a batch of."""
        import hasard_rs

        tasks = self._tasks()
        if len(tasks) > 1:
            raise InvalidOption(f"{self.run}: the agent is of several tasks; make_vec makes a batch of them")
        return hasard_rs.make(tasks[0], **over({**self.arguments(), **self._format()}, arguments))

    def make_vec(self, num_envs: int = 1, **arguments: Any) -> Any:
        """A vector environment like the one that the agent was trained in, in SAME_STEP mode.

        Args:
            num_envs: lanes.
            arguments: see `help(hasard_rs.VectorEnv)`; they come before the agent's own.

        Returns:
            A `hasard_rs.VectorEnv`.
        """
        import hasard_rs

        usual = {"autoreset_mode": "SameStep", **self.arguments(), **self._format()}
        tasks = self._tasks()
        return hasard_rs.make_vec(tasks if len(tasks) > 1 else tasks[0], num_envs, **over(usual, arguments))

    def _tasks(self) -> list[str]:
        """The ids that it was trained on; tasks of one's own are known from now on, by the text that the run kept."""
        env = self.config["env"]
        for file in [env.get("scenario_file"), *env.get("scenario_files", [])]:
            if file:
                from_text(file["text"], file["path"])
        return [f"hasard/{task.strip()}" for task in env["id"].split(",")]

    def _format(self) -> dict[str, Any]:
        return {"action_format": "dict"} if self.config["env"]["full_actions"] else {}

    def begin(self, lanes: int, seed: int = 0) -> Any:
        """Returns what the agent remembers when episodes begin in so many `lanes`; its draws follow from `seed` and the lane.

        Raises InvalidOption for lanes that are no number of them; TypeError or ValueError for a seed that is none.
        """
        if not is_whole(lanes) or lanes < 0:
            raise InvalidOption(f"lanes cannot be {lanes!r:.60}; it must be a whole number, 0 or more")
        first = check_seed(seed)
        return _State(self._trained.begin([(first + lane) % 2**64 for lane in range(lanes)]), None, None, None)

    def act(self, observations: np.ndarray, state: Any = None) -> tuple[Any, Any]:
        """Chooses actions.

        Args:
            observations: uint8 [n, height, width, channels], or one, [height, width, channels].
            state: what the agent remembers, from `begin` or `after`; None: episodes begin.

        Returns:
            Actions, and what the agent remembers then. Actions are int64 [n, parts], or [parts] for one; of agents with full actions a dict of
            "buttons" and "deltas" (float32 [n, 2] in [-1, 1]).

        Raises:
            TypeError for observations that are no array of uint8; ValueError for those of another shape, or cost terms that `after` was not given.
        """
        if not isinstance(observations, np.ndarray) or observations.dtype != np.uint8:
            got = f"dtype {observations.dtype}" if isinstance(observations, np.ndarray) else f"{observations!r:.60}"
            raise TypeError(f"observations must be an array of uint8, as environments give them, got {got}")
        single = observations.ndim == 3
        observations = observations[None] if single else observations
        state = self.begin(len(observations)) if state is None else state
        actions, deltas, after = self._trained.act(observations, state.memory, state.costs, state.over, state.terms)
        chosen: Any = actions
        if deltas.shape[1]:
            # What the network draws may lie beyond what a player can do.
            deltas = np.clip(deltas, -1.0, 1.0)
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

        Raises:
            TypeError for costs or over that are None.
        """
        for name, value in (("costs", costs), ("over", over)):
            if value is None:
                raise TypeError(f"{name} must be an array with an entry for each lane, got None")
        terms = None if cost_terms is None else np.atleast_2d(cost_terms).astype(float).tolist()
        return _State(state.memory, np.atleast_1d(costs).astype(float).tolist(), np.atleast_1d(over).astype(bool).tolist(), terms)

    def evaluate(
        self,
        episodes: int = 20,
        seed: int = 0,
        *,
        env_id: str | os.PathLike[str] | None = None,
        rules: str | None = None,
        best: bool | None = None,
        greedy: bool | None = None,
    ) -> list[dict[str, Any]]:
        """Plays episodes in worlds like those that the agent was trained in; the result is what `hasard eval --json` prints.

            agent.evaluate(200, seed=1_000_000, env_id="RemedyRushLevel3-v0")

        The weights that were loaded play, whatever has been written to the run since.

        Args:
            episodes: how many.
            seed: of the first episode, one more for each of the next: what `info["episode_seed"]` says of an episode, not what `reset(seed=...)` takes,
                which begins a stream of episodes.
            env_id: another environment that has the agent's buttons, such as another level: an id, or a task's file.
                It and `rules` hold the agent to that task's own budget; None: the agent's own.
            rules: "paper", "released" or "tables"; None: the agent's own.
            best: as of `load`; None: as this agent was loaded. Another than that loads the run anew.
            greedy: the same.

        Returns:
            A dict an episode, and the summary as the last.

        Raises:
            InvalidOption for no episodes, an environment that lacks a button or other rules than these, and what `load` raises;
            UnknownEnvironment for an id that is none; TypeError or ValueError for a seed that is none.
        """
        asked = {name: bool(self._how[name] if value is None else value) for name, value in (("best", best), ("greedy", greedy))}
        if asked != self._how:
            return Agent.load(self.run, **asked).evaluate(episodes, seed, env_id=env_id, rules=rules)
        if not is_number(episodes) or int(episodes) < 1:
            raise InvalidOption(f"episodes cannot be {episodes!r}; it must be 1 or more")
        first = check_seed(seed)
        if rules is not None and env_id is None and "," in self.config["env"]["id"]:
            raise InvalidOption(f"rules={rules!r}: the agent is of several tasks; name one of them as env_id")
        elsewhere = None if env_id is None else bare(spec(cast("str", env_id)).id)
        seeds = [(first + number) % 2**64 for number in range(int(episodes))]
        rows: list[dict[str, Any]] = json.loads(self._trained.evaluate(seeds, elsewhere, rules))
        return rows

    def report(self, out: str | os.PathLike[str]) -> Path:
        """Writes the run's page of tables and curves into the folder `out`, as `hasard report` does. Returns the folder; raises HasardError."""
        if not self.run.is_dir():
            raise InvalidOption(f"{self.run}: an agent without a run directory has no curves; give the directory that it was trained into")
        return report([self.run], out)


@dataclass(frozen=True)
class _State:
    """What an agent remembers, and what has happened since its last step."""

    memory: Any
    costs: list[float] | None
    over: list[bool] | None
    terms: list[list[float]] | None


def report(runs: str | os.PathLike[str] | Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> Path:
    """Writes one page of tables and curves from run directories, as `hasard report` does.

    Args:
        runs: a directory or a folder of them, or several.
        out: the folder of the page.

    Returns:
        The folder.

    Raises:
        HasardError, with the program's line of what went wrong.
    """
    several = [runs] if isinstance(runs, (str, os.PathLike)) else runs
    # Paths may begin with a dash.
    _run(["report", f"--out={os.fspath(out)}", "--", *[os.fspath(run) for run in several]])
    return Path(out)


def _run(words: Sequence[str]) -> str:
    done = subprocess.run([sys.executable, "-m", "hasard_rs.cli", *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise HasardError(done.stderr.strip().removeprefix("hasard: ") or f"hasard ended with {done.returncode}")
    return done.stdout
