"""One run over several Ray workers: each has its share of the worlds and the whole loop in Rust; gradients and statistics are exchanged.

What is learned equals a run of one process but for the order in which gradients are added up, and two runs of N workers are equal to the bit. The
first worker writes the usual run directory, which must be on a file system that all machines share if the first worker's machine may be lost.
"""

from __future__ import annotations

import asyncio
import os
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hasard_rs import _core
from hasard_rs._extra import need
from hasard_rs.agent import Report, Run, training_words
from hasard_rs.errors import HasardError, InvalidOption

ray = need("ray", "ray", "ray")

_LARGE = 100_000
"""Bytes from which on a worker's part goes through Ray's object store, and the meeting passes on where it is."""
_PATIENCE = 60.0
"""Seconds that workers have to be there; then fewer are tried."""
_FAILURES = 5
"""Losses in a row, without a report between them, after which a run is given up."""


class Meeting:
    """Where workers meet: an actor that gives everyone's part to everyone of `ranks` workers, and hears the first worker's reports."""

    def __init__(self, ranks: int) -> None:
        self.ranks = ranks
        self.rounds: dict[int, tuple[dict[int, Any], asyncio.Event]] = {}
        self.taken: dict[int, int] = {}
        self.reports: list[Report] = []
        self.stopping = False

    async def gather(self, rank: int, number: int, part: list[Any]) -> list[Any]:
        """Waits until everyone's part of a round has come.

        Args:
            rank: of the worker.
            number: of the round.
            part: bytes, or where in Ray's memory they are, in a list, so that Ray does not fetch them.

        Returns:
            The parts in the order of ranks.
        """
        parts, complete = self.rounds.setdefault(number, ({}, asyncio.Event()))
        parts[rank] = part[0]
        if len(parts) == self.ranks:
            complete.set()
        await complete.wait()
        self.taken[number] = self.taken.get(number, 0) + 1
        if self.taken[number] == self.ranks:
            del self.rounds[number], self.taken[number]
        return [parts[one] for one in range(self.ranks)]

    async def hear(self, report: Report) -> bool:
        """Keeps a report. Returns whether the run is to end."""
        self.reports.append(report)
        return self.stopping

    async def news(self, stop: bool) -> list[Report]:
        """Takes down whether the run is to `stop`. Returns the reports since the last time."""
        self.stopping |= stop
        reports, self.reports = self.reports, []
        return reports


class Worker:
    """A worker: an actor.

    Args:
        meeting: the actor where all meet.
        rank: its own, 0 to ranks - 1.
        ranks: number of workers.
    """

    def __init__(self, meeting: Any, rank: int, ranks: int) -> None:
        self.meeting, self.rank, self.ranks = meeting, rank, ranks
        self.number = 0
        self.lost = False

    def ready(self) -> bool:
        """Returns True, once the actor is there."""
        return True

    def gather(self, part: np.ndarray) -> list[np.ndarray]:
        """Returns everyone's bytes, by this one's part; raises RayError where another is lost."""
        self.number += 1
        try:
            sent = ray.put(part) if part.nbytes >= _LARGE else part
            parts = ray.get(self.meeting.gather.remote(self.rank, self.number, [sent]))
            return [ray.get(one) if isinstance(one, ray.ObjectRef) else one for one in parts]
        except ray.exceptions.RayError:
            self.lost = True
            raise

    def run(self, words: list[str]) -> tuple[str, bool, Report] | None:
        """Trains until the run ends, by `words` of `hasard train`.

        Returns the directory, whether it was stopped and the last report; None for all but the first worker, and if another machine is lost. Raises
        InvalidOption for wrong settings.
        """
        try:
            if self.rank == 0:
                directory, stopped, last = _core.train(words, self.hear, warnings.warn, self.gather, self.ranks)
                return os.fspath(directory), stopped, last
            _core.follow(self.gather, self.rank, self.ranks, warnings.warn)
        except HasardError:
            if not self.lost:
                raise
        return None

    def hear(self, report: Report) -> bool:
        """Hands a report on. Returns whether the run is to end."""
        return bool(ray.get(self.meeting.hear.remote(report)))


def train(
    env_id: str,
    algorithm: str | None = None,
    *,
    workers: int,
    address: str | None = None,
    num_cpus: float = 1,
    options: Mapping[str, Any] | None = None,
    callback: Callable[[Report], Any] | None = None,
    preset: str | None = None,
    out: str | os.PathLike[str] | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    **flags: Any,
) -> Run:
    """Trains as `hasard_rs.train` does, over `workers` Ray actors that share the run's worlds.

    If a worker or its machine is lost, all begin anew from the run's last checkpoint, as many as the cluster still has room for. A run that exists is
    gone on with by `resume=True`, with any number of workers.

    Args:
        env_id, algorithm, callback, preset, out, set, flags: as of `hasard_rs.train`.
        workers: how many; each has its share of the run's worlds (`envs`).
        address: of the cluster; None starts one on this machine unless Ray is running.
        num_cpus: what each worker asks Ray for; the flag `threads` says what it uses.
        options: further options of the actors.

    Returns:
        A `Run`.

    Raises:
        InvalidOption for wrong settings, or more workers than the cluster has room for; HasardError when workers were lost five times in a row without
        a report between.
    """
    words = training_words(env_id, algorithm, preset=preset, out=out, set=set, **flags)
    return train_words(words, workers, address=address, num_cpus=num_cpus, options=options, callback=callback)


def train_words(
    words: list[str],
    workers: int,
    *,
    address: str | None = None,
    num_cpus: float = 1,
    options: Mapping[str, Any] | None = None,
    callback: Callable[[Report], Any] | None = None,
) -> Run:
    """Trains as `train` does, from the `words` of the program's command line.

    workers, address, num_cpus, options and callback are as there; so is what it returns and raises.
    """
    if not ray.is_initialized():
        ray.init(address=address, log_to_driver=False)
    if not 1 <= workers <= _room(num_cpus):
        raise InvalidOption(f"workers cannot be {workers}; it must be 1..={_room(num_cpus)}: each asks for {num_cpus} CPUs, and no more are in the cluster")
    driver = _Driver(words, callback, {"num_cpus": num_cpus, "scheduling_strategy": "SPREAD", **(options or {})})
    count, failures = workers, 0
    while True:
        outcome = driver.attempt(count)
        if outcome is not None:
            directory, stopped, last = outcome
            if driver.raised is not None:
                raise driver.raised
            return Run(Path(directory), stopped, last)
        failures = 1 if driver.heard else failures + 1
        if failures >= _FAILURES:
            raise HasardError(f"workers were lost {failures} times in a row before they could report; the run stays where its last checkpoint is")
        if "--resume" not in words:
            words.append("--resume")
        time.sleep(1.0)
        count = max(1, min(workers, _room(num_cpus)))
        print(f"hasard: a worker was lost; {count} go on from the last checkpoint", file=sys.stderr, flush=True)


def _room(num_cpus: float) -> int:
    """How many workers the cluster has room for."""
    return int(ray.cluster_resources().get("CPU", 0) / num_cpus) if num_cpus > 0 else 1 << 16


class _Driver:
    """Starts workers and watches them."""

    def __init__(self, words: list[str], callback: Callable[[Report], Any] | None, placed: dict[str, Any]) -> None:
        self.words, self.callback, self.placed = words, callback, placed
        self.stop = False
        self.raised: BaseException | None = None
        self.heard = False

    def attempt(self, count: int) -> tuple[str, bool, Report] | None:
        """How the run ended, or None if a worker was lost."""
        self.heard = False
        meeting = ray.remote(Meeting).options(num_cpus=0).remote(count)
        hire = ray.remote(Worker).options(**self.placed).remote
        workers = [hire(meeting, rank, count) for rank in range(count)]
        try:
            ray.get([worker.ready.remote() for worker in workers], timeout=_PATIENCE)
            return self._watch(meeting, [worker.run.remote(self.words) for worker in workers])
        except (ray.exceptions.RayActorError, ray.exceptions.GetTimeoutError, ray.exceptions.ObjectLostError):
            return None
        except ray.exceptions.RayTaskError as error:
            raise (error.cause if isinstance(error.cause, Exception) else error) from None
        finally:
            for actor in (*workers, meeting):
                ray.kill(actor)

    def _watch(self, meeting: Any, runs: list[Any]) -> tuple[str, bool, Report] | None:
        going = list(runs)
        while True:
            try:
                done, going = ray.wait(going, num_returns=1, timeout=0.2)
                self._report(ray.get(meeting.news.remote(self.stop)))
            except KeyboardInterrupt as interrupt:
                # The run ends with a checkpoint; then this is raised again.
                self.stop, self.raised, done = True, interrupt, []
            if runs[0] in done:
                return ray.get(runs[0])
            for one in done:
                # Raises what went wrong there; a worker that ends well does so because the first one does.
                ray.get(one)

    def _report(self, reports: list[Report]) -> None:
        for report in reports:
            self.heard = True
            if self.callback is None or self.stop:
                continue
            try:
                self.stop = bool(self.callback(report))
            except BaseException as error:  # noqa: BLE001
                self.stop, self.raised = True, error
