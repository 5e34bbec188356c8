#!/usr/bin/env python3
"""Two sets of runs of the same environments and seeds beside each other, by feasible score.

    python3 tools/quick_old_new.py runs/quick-old runs/quick-new runs/quick-ppo docs/results/campaign

The score of a run is (R - random) / (PPO - random) of its selected checkpoint over the closing episodes if the upper 95 % end of
their cost is within the budget, else 0; with --last, of its last policy over episodes of its own. PPO's return is that of the third
folder's last policies, random play's that of the `random-*.jsonl` of the fourth. Seeds that one side lacks in an environment are left
out there. The mean is over environments of the mean over seeds; its ratio has an interval of 2,000 bootstrap samples that draw seeds,
the same for both sides, within each environment.
"""

import argparse
import json
import math
import statistics
from pathlib import Path

from campaign_runs import interval


def runs_of(root, last=False):
    """{(environment, seed): what the selected checkpoint, or the last policy, of a finished run returned and cost}."""
    found = {}
    for path in sorted(Path(root).rglob("selected.json")):
        config, selected = (json.loads((path.parent / name).read_text()) for name in ("config.json", "selected.json"))
        closing = selected["last"] if last else selected.get("closing") or selected["last"]
        key = config["env"]["id"], config["seed"]
        if key in found:
            raise SystemExit(f"{path.parent}: {key[0]} with seed {key[1]} is there twice; leave one of them there")
        cost = closing["cost"]
        high = cost["bootstrap"][1] if cost["bootstrap"] else cost["mean"] + cost["half_width"]
        found[key] = closing["episode_return"]["mean"], cost["mean"], high <= config["constraints"][0]["budget"]
    if not found:
        raise SystemExit(f"{root}: no finished runs; `hasard sweep` makes them")
    return found


def score(run, scale):
    chance, ppo = scale
    return (run[0] - chance) / (ppo - chance) if run[2] else 0.0


def means(strata):
    """Each side's mean over environments of the mean over seeds."""
    return [statistics.fmean(statistics.fmean(pair[side] for pair in pairs) for pairs in strata.values()) for side in (0, 1)]


def ratio(strata):
    """The second side's mean by the first's."""
    old, new = means(strata)
    return new / old if old > 0 else math.inf


def table(old, new, scales):
    lines = ["| environment | seeds | old | score | new | score |", "|---|---|--:|--:|--:|--:|"]
    strata = {}
    for env in dict.fromkeys(env for env, _ in new):
        seeds = sorted(seed for other, seed in new if other == env and (env, seed) in old)
        if not seeds or scales.get(env) is None:
            continue
        strata[env] = [tuple(score(side[env, seed], scales[env]) for side in (old, new)) for seed in seeds]
        cells = []
        for index, side in enumerate((old, new)):
            mine = [side[env, seed] for seed in seeds]
            within = sum(run[2] for run in mine)
            cells.append(f"{statistics.fmean(run[0] for run in mine):.1f} @ {statistics.fmean(run[1] for run in mine):.1f} ({within}/{len(mine)})")
            cells.append(f"{statistics.fmean(pair[index] for pair in strata[env]):.2f}")
        lines.append(f"| {env.removesuffix('-v0')} | {', '.join(map(str, seeds))} | {' | '.join(cells)} |")
    if not strata:
        raise SystemExit("no environment has a seed on both sides, and a scale")
    old_mean, new_mean = means(strata)
    words = f"Mean feasible score {old_mean:.2f} and {new_mean:.2f}, a ratio of {ratio(strata):.2f}"
    if min(map(len, strata.values())) > 1:
        low, high = interval(strata, ratio)
        words += f", {low:.2f} to {high:.2f}"
    else:
        words += "; one seed has no interval"
    return "\n".join(lines) + f"\n\n{words}."


def scales_of(ppo, chance):
    """{environment: what random play and PPO return}, PPO over its seeds."""
    returns = {}
    for path in sorted(Path(ppo).rglob("selected.json")):
        config = json.loads((path.parent / "config.json").read_text())
        env, task = config["env"]["id"], config["env"]
        if config["algorithm"] != "PPO" or task["rules"] != "paper" or task["hard"] or task["full_actions"]:
            raise SystemExit(f"{path.parent}: the scale is PPO's under the rules `paper`; give a folder of such runs alone")
        returns.setdefault(env, []).append(json.loads(path.read_text())["last"]["episode_return"]["mean"])
    scales = {}
    for env, own in returns.items():
        for path in Path(chance).rglob(f"random-{env}-paper.jsonl"):
            episodes = [json.loads(line) for line in path.read_text().splitlines()]
            scales[env] = statistics.fmean(one["return"] for one in episodes if "return" in one), statistics.fmean(own)
    return {env: scale for env, scale in scales.items() if scale[1] > scale[0]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("old", "new", "ppo", "chance"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--last", action="store_true", help="last policies rather than selected checkpoints")
    given = parser.parse_args()
    new, scales = runs_of(given.new, given.last), scales_of(given.ppo, given.chance)
    print(table(runs_of(given.old, given.last), new, scales))
    left_out = sorted({env for env, _ in new} - set(scales))
    if left_out:
        print(f"\nWithout {', '.join(left_out)}: no run of PPO there that returns more than random play.")


if __name__ == "__main__":
    main()
