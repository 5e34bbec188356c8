#!/usr/bin/env python3
"""Frames a second of our training beside the published trainer's, the whole loop of each, in turn on the same cores.

    python3 -m venv ORIGINAL && ORIGINAL/bin/pip install 'HASARD[sample-factory]' torchviz pandas moviepy
    cargo build --release -p hasard-cli
    python3 tools/beside_published_trainer.py ORIGINAL/bin/python target/release/hasard [--rounds 3] [--under "chrt -r 1"]

The published trainer is the one in the package HASARD, a changed Sample-Factory, run as its guide says: asynchronous, 2 workers
of 16 worlds each, on the CPU, with its own network and batch. It makes no videos here, which it does by default and which take
time. Its frames are tics, frame skip included, as ours are. They are counted from its own reports, once it has reported
frames for `--warm` seconds and for `--seconds` from then on; its start and its first random steps are left out.

Ours is the preset `released`, with evaluations as usual, in float32 and in bfloat16: frames by `wall_s` in the last row of
`metrics.jsonl`, from the start of training, and by the seconds of the whole command.
Each round runs every program once; printed are all rounds, medians, and each median as a multiple of the published one.
`--under` puts a command before each of them. `--no-evaluation` adds our runs without evaluations, to show what those take.
"""

import argparse
import datetime
import json
import os
import pathlib
import re
import shlex
import signal
import statistics
import subprocess
import sys
import tempfile
import time

REPORT = re.compile(r"\[(\d{4}-\d\d-\d\d \d\d:\d\d:\d\d,\d{3})\].*Total num frames: (\d+)\.")
THEIRS = "--algo PPOLag --env volcanic_venture --level 1 --device cpu --num_workers 2 --num_envs_per_worker 16 --record False"
OURS = "VolcanicVentureLevel1-v0 --preset released --algo PPOLag --threads 2"


def reports(lines):
    """(seconds, frames) of each report in the published trainer's output."""
    for line in lines:
        if found := REPORT.search(line):
            yield datetime.datetime.strptime(found[1], "%Y-%m-%d %H:%M:%S,%f").timestamp(), int(found[2])


def rate_after(rows, warm, seconds):
    """Frames a second over `seconds`, from `warm` seconds after the first report of any frames; None where reports end before."""
    first = start = None
    for now, frames in rows:
        if frames and first is None:
            first = now
        if first is not None and now - first >= warm and start is None:
            start = (now, frames)
        elif start and now - start[0] >= seconds:
            return (frames - start[1]) / (now - start[0])
    return None


def end(process):
    """Ends the published trainer with its workers and their engines, which are one process group."""
    for number in (signal.SIGINT, signal.SIGKILL):
        try:
            os.killpg(process.pid, number)
        except ProcessLookupError:
            break
        time.sleep(3)
    process.wait()


def published(arguments, seed, folder):
    command = [*arguments.under, arguments.python, "-m", "sample_factory.train", *THEIRS.split(), *arguments.theirs]
    command += ["--seed", str(seed), "--train_dir", folder, "--experiment", "run"]
    # Where a machine holds numpy's and torch's kernels down to an older processor's, theirs would be slower than they need be.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("OPENBLAS_")}
    process = subprocess.Popen(
        command, cwd=folder, env=environment, text=True, start_new_session=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    last = []

    def lines():
        for line in process.stdout:
            last[:] = [*last[-20:], line]
            yield line

    try:
        rate = rate_after(reports(lines()), arguments.warm, arguments.seconds)
    finally:
        end(process)
    if rate is None:
        raise SystemExit(f"the published trainer ended too early; its last lines:\n{''.join(last)}")
    return (rate,)


def ours(arguments, seed, folder, options):
    out = pathlib.Path(folder) / "run"
    command = [*arguments.under, arguments.program, "train", *OURS.split(), "--seed", str(seed), "--frames", str(arguments.frames)]
    begun = time.monotonic()
    done = subprocess.run([*command, "--out", out, *options], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    whole = time.monotonic() - begun
    if done.returncode or not (out / "metrics.jsonl").exists():
        raise SystemExit(f"{shlex.join(map(str, done.args))} ended with {done.returncode}:\n{done.stderr[-2000:]}")
    row = json.loads((out / "metrics.jsonl").read_text().splitlines()[-1])
    return row["frames"] / row["wall_s"], row["frames"] / whole


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("python", help="the interpreter that has the package HASARD")
    parser.add_argument("program", help="our program")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=1_000_000, help="length of each of our runs")
    parser.add_argument("--warm", type=float, default=10, help="seconds of the published trainer that do not count")
    parser.add_argument("--seconds", type=float, default=60, help="seconds of it that do")
    parser.add_argument("--under", type=shlex.split, default=[], help="a command put before each program")
    parser.add_argument("--theirs", type=shlex.split, default=[], help="further arguments of the published trainer")
    parser.add_argument("--no-evaluation", action="store_true", help="also ours without evaluations")
    parser.add_argument("--only", help="only the programs whose name has this in it")
    arguments = parser.parse_args()
    arguments.python, arguments.program = (os.path.abspath(path) for path in (arguments.python, arguments.program))
    for path in (arguments.python, arguments.program):
        if not os.access(path, os.X_OK):
            parser.error(f"no program: {path}")
    programs = {"published": published}
    for products in ("float32", "bfloat16"):
        for extra in ([], ["--eval-every", "0"])[: 2 if arguments.no_evaluation else 1]:
            options = ["--set", f"learning.products={products}", *extra]
            programs[" ".join(["ours", products, *extra])] = lambda a, s, f, options=options: ours(a, s, f, options)
    results = {name: [] for name in programs if not arguments.only or arguments.only in name}
    if not results or arguments.rounds < 1:
        parser.error(f"nothing to run: --rounds begins at 1, and --only picks among {', '.join(programs)}")
    for seed in range(1, arguments.rounds + 1):
        for name in results:
            with tempfile.TemporaryDirectory() as folder:
                results[name].append(programs[name](arguments, seed, folder))
            print(f"round {seed}, {name}: " + ", ".join(f"{rate:,.0f}" for rate in results[name][-1]), file=sys.stderr, flush=True)
    print("| program | frames/s of each round | median | times the published | median of the whole command |\n|---|---|--:|--:|--:|")
    base = statistics.median(row[0] for row in results["published"]) if "published" in results else None
    for name, rows in results.items():
        middle = statistics.median(row[0] for row in rows)
        times = f"{middle / base:.2f}" if base else ""
        whole = f"{statistics.median(row[1] for row in rows):,.0f}" if len(rows[0]) > 1 else ""
        print(f"| {name} | {', '.join(f'{row[0]:,.0f}' for row in rows)} | {middle:,.0f} | {times} | {whole} |")


if __name__ == "__main__":
    main()
