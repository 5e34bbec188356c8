#!/usr/bin/env python3
"""Small copies of finished runs, from which `hasard report` draws what it draws from the runs, but for threads and calibration.

    python3 tools/keep_runs.py runs/campaign docs/results/campaign --hasard target/release/hasard --agents 11

Of each run: settings, selection, closing episodes, curves with a row for each percent of the frames, the last heatmap of each level
with its map, and `eval.jsonl` if there is one. Agents are kept of the seeds that `--agents` names, for they are most of the bytes
(with `--algorithms` of those algorithms alone).
Numbers have six significant digits, and episodes no name of their environment where it is the run's. Runs without a selection are
passed over and counted. A run whose copy is there already is left alone; files of episodes beside the runs (`random-*.jsonl`) are
copied too.
"""

import argparse
import json
import shutil
import subprocess
import sys
from pathlib import Path

# What no table or figure of results is drawn from.
LEFT_OUT = (
    *("loss", "gradient_norm", "seconds_", "policy_lag", "learning_rate", "ratio_deviation", "epochs", "kernels", "threads"),
    *("_min", "_max", "approx_kl", "clip_fraction", "kl_divergence"),
)
WHOLE = ("config.json", "selected.json")
EPISODES = ("closing_episodes.jsonl", "last_policy_episodes.jsonl", "eval.jsonl")


def rounded(value):
    if isinstance(value, float):
        short = float(f"{value:.6g}")
        return int(short) if short.is_integer() else short
    if isinstance(value, list):
        return [rounded(one) for one in value]
    if isinstance(value, dict):
        return {name: rounded(one) for name, one in value.items()}
    return value


def lines(path):
    return [json.loads(line) for line in path.read_text().splitlines() if line.strip()]


def thinned(rows):
    """The last row of each percent of the frames, and every row that has an evaluation."""
    end = rows[-1]["frames"]
    kept = {}
    for row in rows:
        evaluated = "eval/return_mean" in row
        kept[(row["frames"] * 100 // end, row["frames"] if evaluated else 0)] = row
    ordered = sorted(kept.values(), key=lambda row: row["frames"])
    return [{name: value for name, value in row.items() if not any(part in name for part in LEFT_OUT)} for row in ordered]


def without_env(rows, env):
    """Episodes of a run, whose config.json names the environment: a tenth of their bytes."""
    return [{name: value for name, value in row.items() if (name, value) != ("env", env)} for row in rows]


def write_lines(path, rows):
    path.write_text("".join(json.dumps(rounded(row), separators=(",", ":")) + "\n" for row in rows))


def keep(run, copy, env, hasard, with_agent):
    """Writes the copy of a run; a copy that is there is a whole one, for its folder gets its name last."""
    half = copy.with_name(copy.name + ".part")
    shutil.rmtree(half, ignore_errors=True)
    half.mkdir(parents=True)
    for name in WHOLE:
        (half / name).write_text(json.dumps(rounded(json.loads((run / name).read_text())), separators=(",", ":")) + "\n")
    for name in EPISODES:
        # Where the last policy is the selected one, its episodes are those already kept.
        same = name == EPISODES[1] and (run / EPISODES[0]).exists() and (run / name).read_bytes() == (run / EPISODES[0]).read_bytes()
        if (run / name).exists() and not same:
            write_lines(half / name, without_env(lines(run / name), env))
    write_lines(half / "metrics.jsonl", thinned(lines(run / "metrics.jsonl")))
    if (run / "heatmaps.jsonl").exists():
        last = {row.get("automap"): row for row in lines(run / "heatmaps.jsonl")}
        write_lines(half / "heatmaps.jsonl", last.values())
        for name in filter(None, last):
            if (run / name).exists():
                shutil.copy(run / name, half / name)
    if with_agent:
        subprocess.run([hasard, "export-agent", run, "-o", half / "selected.agent"], check=True, stdout=subprocess.DEVNULL)
    half.rename(copy)


def main(arguments=None):
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("runs", type=Path)
    words.add_argument("copies", type=Path)
    words.add_argument("--hasard", default="hasard", help="the program, for --agents")
    words.add_argument("--agents", type=int, nargs="*", default=[], metavar="SEED", help="seeds whose agents are kept")
    words.add_argument("--algorithms", nargs="*", default=[], metavar="NAME", help="of these alone, such as PPOPID")
    args = words.parse_args(arguments)
    if not args.runs.is_dir():
        sys.exit(f"{args.runs}: no such folder; name the folder that `hasard sweep` wrote")
    kept = waiting = 0
    for config in sorted(args.runs.rglob("config.json")):
        run = config.parent
        copy = args.copies / run.relative_to(args.runs)
        if copy.exists():
            continue
        if not (run / "selected.json").exists():
            waiting += 1
            continue
        settings = json.loads(config.read_text())
        wanted = not args.algorithms or settings["algorithm"] in args.algorithms
        keep(run, copy, settings["env"]["id"], args.hasard, wanted and settings["seed"] in args.agents)
        kept += 1
    for file in args.runs.glob("*.jsonl"):
        args.copies.mkdir(parents=True, exist_ok=True)
        write_lines(args.copies / file.name, lines(file))
    total = sum(file.stat().st_size for file in args.copies.rglob("*") if file.is_file())
    print(f"{kept} runs copied, {waiting} not finished; {args.copies} has {total / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
