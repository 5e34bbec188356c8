"""Sweeps on clusters: each run is one process of the program with a directory of its own, started by Ray or by Slurm.

Directories must be on a file system that all machines share. A run whose machine is lost is resumed elsewhere from its checkpoint, since each
command line goes on where its directory stands.
"""

from __future__ import annotations

import ctypes
import json
import shlex
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

from hasard_rs._extra import need


def jobs(words: list[str]) -> list[dict[str, Any]]:
    """The runs of a sweep that the program would start, by its own `--dry-run`.

    Args:
        words: the command line, from `sweep` on.

    Returns:
        A dict a run, with "directory" and "command".

    Raises:
        ValueError, with the program's line of what went wrong.
    """
    asked = [sys.executable, "-m", "hasard_rs.cli", *words, "--dry-run"]
    done = subprocess.run([*asked, *([] if "--json" in words else ["--json"])], capture_output=True, text=True, check=False)
    if done.returncode:
        raise ValueError(done.stderr.strip())
    return [json.loads(line) for line in done.stdout.splitlines()]


def run_job(job: dict[str, Any]) -> tuple[int, str]:
    """Runs, or resumes, one `job` of `jobs` on this process's machine. Returns its exit code and the end of what it said."""
    directory = Path(job["directory"])
    arguments = shlex.split(job["command"])[1:]
    if (directory / "config.json").exists() and "--resume" not in arguments:
        arguments.append("--resume")
    words = [sys.executable, "-m", "hasard_rs.cli", *arguments]
    done = subprocess.run(words, capture_output=True, text=True, check=False, preexec_fn=_ends_with_its_parent)
    return done.returncode, (done.stderr or done.stdout)[-2000:]


def _ends_with_its_parent() -> None:
    """Where a worker is killed, its run must not go on: it would hold the directory that another worker is to resume."""
    if sys.platform == "linux":
        set_parent_death_signal = 1
        ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGKILL)


def sweep_on(place: str, words: list[str]) -> int:
    """Does `hasard sweep ... --on PLACE`.

    Args:
        place: "ray", "ray:ADDRESS" or "slurm".
        words: the command line, from `sweep` on, without `--on`.

    Returns:
        0 when every run has ended well, 1 when some have not, 2 for bad input; it raises nothing.
    """
    where, _, address = place.partition(":")
    try:
        if where == "ray":
            failed = _on_ray(jobs(words), address or None)
        elif where in ("slurm", "local"):
            failed = _on_slurm(jobs(words), where)
        else:
            raise ValueError(f"hasard: --on {place!r}: give ray, ray:ADDRESS or slurm")
    except (ImportError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    for directory, text in failed:
        print(f"hasard: {directory}: {text.strip().splitlines()[-1] if text.strip() else 'failed'}", file=sys.stderr)
    return 1 if failed else 0


def _on_ray(todo: list[dict[str, Any]], address: str | None) -> list[tuple[str, str]]:
    ray = need("ray", "ray", "clusters")
    if not ray.is_initialized():
        ray.init(address=address, log_to_driver=False)
    # A lost machine is no failure of the run: it is started again elsewhere, and resumes.
    task = ray.remote(run_job).options(num_cpus=1, max_retries=-1, scheduling_strategy="SPREAD", runtime_env={"env_vars": {"OMP_NUM_THREADS": "1"}})
    waiting = {task.remote(job): job for job in todo}
    failed, done = [], 0
    while waiting:
        ready, _ = ray.wait(list(waiting), num_returns=1)
        job = waiting.pop(ready[0])
        code, text = ray.get(ready[0])
        done += 1
        print(f"[{done}/{len(todo)}] {job['directory']}: {'finished' if code == 0 else 'failed'}", flush=True)
        if code:
            failed.append((job["directory"], text))
    return failed


def _on_slurm(todo: list[dict[str, Any]], cluster: str) -> list[tuple[str, str]]:
    submitit = need("submitit", "slurm", "clusters")
    executor = submitit.AutoExecutor(folder=str(Path(todo[0]["directory"]).parent / "slurm"), cluster=cluster)
    executor.update_parameters(tasks_per_node=1, cpus_per_task=1, timeout_min=24 * 60)
    if cluster == "slurm":
        executor.update_parameters(slurm_array_parallelism=64)
    handed = list(zip(todo, executor.map_array(run_job, todo), strict=True))
    failed = []
    for i, (job, running) in enumerate(handed):
        code, text = running.result()
        print(f"[{i + 1}/{len(todo)}] {job['directory']}: {'finished' if code == 0 else 'failed'}", flush=True)
        if code:
            failed.append((job["directory"], text))
    return failed
