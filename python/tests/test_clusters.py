"""Sweeps on clusters, as far as one machine without Ray and Slurm can test them."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hasard_rs import clusters


def command(directory: Path) -> str:
    return f"hasard train RemedyRushLevel1-v0 --preset quick --size 64x48 --envs 4 --threads 1 --frames 1000000000 --quiet --out {directory}"


def test_what_cannot_be_begun_is_said_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    for place, words, text in [("mars", ["sweep", "quick"], "give ray, ray:ADDRESS or slurm"), ("ray", ["sweep", "nothing"], "nothing")]:
        assert clusters.sweep_on(place, words) == 2
        printed = capsys.readouterr().err
        assert text in printed and printed.count("\n") == 1


def test_jobs_are_the_programs() -> None:
    jobs = clusters.jobs(["sweep", "quick", "--scale", "0.01"])
    assert len(jobs) == 5 and len({job["directory"] for job in jobs}) == 5
    assert all(job["command"].startswith("hasard train ") and job["directory"] in job["command"] for job in jobs)


@pytest.mark.skipif(sys.platform != "linux", reason="processes are read from /proc")
def test_a_run_ends_with_the_worker_that_was_killed(tmp_path: Path) -> None:
    run = tmp_path / "run"
    job = {"directory": str(run), "command": command(run)}
    code = "import json, sys; from hasard_rs.clusters import run_job; run_job(json.loads(sys.argv[1]))"

    def trainers() -> list[str]:
        found = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                words = (process / "cmdline").read_bytes().decode(errors="replace")
            except OSError:
                continue
            if str(run) in words and "hasard_rs.cli" in words:
                found.append(process.name)
        return found

    def wait_for(there: bool) -> None:
        until = time.monotonic() + 120
        while bool(trainers()) != there or (there and not (run / "config.json").exists()):
            assert time.monotonic() < until, trainers()
            time.sleep(0.05)

    worker = subprocess.Popen([sys.executable, "-c", code, json.dumps(job)])
    try:
        wait_for(True)
    finally:
        worker.kill()
        worker.wait()
    wait_for(False)
