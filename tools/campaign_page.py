#!/usr/bin/env python3
"""Writes the tables of docs/results/campaign.md, between its marks, from the kept copies of the runs.

    python3 tools/campaign_page.py docs/results/campaign docs/results/campaign.md --hasard target/release/hasard

A cell is the mean return @ mean cost of the last policies over the seeds that a whole table has; after it, with several seeds, how
many keep the budget with the upper end of their interval. Bold: the most return of those all of whose seeds do.
"""

import argparse
import re
import statistics
import sys
from pathlib import Path

from campaign_answers import table as answers
from campaign_runs import SCENARIOS, Campaign, common_seeds, iqm, of_seeds

WORDS = {name: re.sub(r"(?<!^)(?=[A-Z])", " ", name).replace("Detonators", "Detonator's") for name in SCENARIOS}
PAPER = ("PPO", "PPOCost", "PPOLag", "PPOSaute", "PPOPID", "P3O")
ALL = (*PAPER, "TRPO", "TRPOLag", "TRPOPID", "CPO", "FOCOPS", "CUP", "IPO")


def short(number):
    return f"{number:.0f}" if abs(number) >= 100 else f"{number:.1f}" if abs(number) >= 20 else f"{number:.2f}"


def titled(env):
    scenario, level = env.removesuffix("-v0").split("Level")
    return f"{WORDS[scenario]} {level}"


def pair(earned, cost):
    return f"{short(statistics.fmean(earned))} @ {short(statistics.fmean(cost))}"


def grid(head, columns, rows, chance=None, budgets_differ=False):
    """A table of runs: columns {title: env}, rows {title: env -> runs}; `chance` is random play's row, env -> (returns, costs).

    Where budgets differ from row to row each cell names its own, and none is the best.
    """
    keys = columns
    cells = {(row, column): runs(key) for row, runs in rows.items() for column, key in columns.items()}
    columns = [column for column in keys if any(cells[row, column] for row in rows)]
    if not any(cells.values()):
        return "No runs yet.", ()
    common = common_seeds(cells.values())
    lines = [f"| {head} | " + " | ".join(columns) + " |", "|---|" + "--:|" * len(columns)]
    kept = {key: of_seeds(runs, common) for key, runs in cells.items()}
    best = {}
    for column in columns:
        safe = {row: statistics.fmean(run.earned for run in kept[row, column]) for row in rows if kept[row, column] and all(run.within for run in kept[row, column])}
        safe = {row: value for row, value in safe.items() if value > 0.005}
        best[column] = max(safe, key=safe.get) if safe and not budgets_differ else None
    for row in rows:
        texts = []
        for column in columns:
            runs = kept[row, column]
            text = pair([run.earned for run in runs], [run.cost for run in runs]) if runs else ""
            text = f"{text} of {runs[0].budget:g}" if budgets_differ and runs else text
            text = f"**{text}**" if best[column] == row else text
            texts.append(f"{text} ({sum(run.within for run in runs)}/{len(runs)})" if len(common) > 1 and runs else text)
        lines.append(f"| {row} | " + " | ".join(texts) + " |")
    if chance:
        lines.append("| random | " + " | ".join(pair(*chance(keys[column])) for column in columns) + " |")
    return "\n".join(lines), sorted(common)


def budgets(campaign, envs):
    """A column for each environment, with its budget."""
    return {f"{titled(env)} ({campaign.budget[env]:g})": env for env in envs if env in campaign.budget}


def of_level(campaign, level, algorithms):
    envs = [f"{scenario}Level{level}-v0" for scenario in SCENARIOS]
    columns = budgets(campaign, envs)
    rows = {name: lambda env, name=name: campaign.of(name, env) for name in algorithms}
    return grid("algorithm", columns, rows, campaign.chance)


def feasible(campaign, level, algorithms):
    """Mean feasible scores, an environment a column; their mean, and the inter-quartile mean of all seeds' scores."""
    envs = [f"{scenario}Level{level}-v0" for scenario in SCENARIOS]
    runs = {(name, env): campaign.of(name, env) for name in algorithms for env in envs}
    common = common_seeds(runs.values())
    scales = {env: campaign.scale(env, common) for env in envs}
    envs = [env for env in envs if scales[env]]
    lines = ["| algorithm | " + " | ".join(map(titled, envs)) + " | mean | IQM |", "|---|" + "--:|" * (len(envs) + 2)]
    for name in algorithms:
        scores = [[run.feasible(scales[env]) for run in of_seeds(runs[name, env], common)] for env in envs]
        means = [statistics.fmean(some) for some in scores]
        lines.append(f"| {name} | " + " | ".join(f"{one:.2f}" for one in [*means, statistics.fmean(means), iqm(sum(scores, []))]) + " |")
    return "\n".join(lines), sorted(common)


def small(campaign):
    """Name: what each of the small tables shows."""
    first = [f"{scenario}Level1-v0" for scenario in SCENARIOS]
    of = campaign.of
    plain = {titled(env): env for env in first}
    shares = {f"{share:g} of the usual": lambda env, share=share: of("PPOLag", env, budget=share * campaign.budget[env]) for share in (0.5, 1.0, 1.5)}
    scales = {f"{scale:g}": lambda env, scale=scale: of("PPOCost", env, scale=scale) for scale in (0.1, 0.5, 1.0, 2.0)}
    return {
        "algorithms": grid(
            "algorithm",
            budgets(campaign, [first[1], first[2]]),
            {name: lambda env, name=name: of(name, env) for name in ALL},
        ),
        "trpo": grid("algorithm", budgets(campaign, first), {name: lambda env, name=name: of(name, env) for name in ALL[6:9]}),
        "cost scale": grid("PPOCost's scale", budgets(campaign, first), scales),
        "safety bounds": grid("PPOLag's budget", plain, shares, budgets_differ=True),
        "hard": grid(
            "algorithm",
            plain,
            {name: lambda env, name=name: of(name, env, hard=True) for name in ("PPO", "PPOCost", "PPOLag")},
            lambda env: campaign.chance(env, hard=True),
        ),
        "full actions": grid(
            "PPOLag's actions",
            budgets(campaign, first),
            {"simplified": lambda env: of("PPOLag", env), "full": lambda env: of("PPOLag", env, full=True)},
        ),
        "depth": grid(
            "algorithm and input",
            budgets(campaign, ["PrecipicePlungeLevel2-v0"]),
            {
                f"{name}, {seen}": lambda env, name=name, seen=seen: of(name, env, observation=seen)
                for name in ("PPO", "PPOPID")
                for seen in ("rgb", "rgb+depth")
            },
        ),
        "segmentation": grid(
            "PPOPID's input",
            budgets(campaign, ["ArmamentBurdenLevel2-v0"]),
            {seen: lambda env, seen=seen: of("PPOPID", env, observation=seen) for seen in ("rgb", "segmented")},
        ),
        "curriculum": grid(
            "PPOPID trained on",
            budgets(campaign, ["RemedyRushLevel3-v0", "CollateralDamageLevel3-v0"]),
            {"levels 1, 2, 3": lambda env: of("PPOPID", env, curriculum=True), "level 3": lambda env: of("PPOPID", env)},
        ),
    }


def seeds_line(seeds):
    return f"\n\nSeeds: {', '.join(map(str, seeds))}." if seeds else ""


def blocks(campaign):
    made = {
        "level 1": of_level(campaign, 1, PAPER),
        "feasible 1": feasible(campaign, 1, PAPER),
        "level 2": of_level(campaign, 2, ("PPO", "PPOLag", "PPOPID")),
        "level 3": of_level(campaign, 3, ("PPO", "PPOLag", "PPOPID")),
        **small(campaign),
    }
    made = {name: text + seeds_line(seeds) for name, (text, seeds) in made.items()}
    made["answers"] = answers(campaign)
    made["count"] = f"{len(campaign.runs)} runs of 2 million frames."
    return made


def filled(page, made):
    """The page with each marked block anew."""

    def block(found):
        name = found.group(1)
        if name not in made:
            sys.exit(f"the page asks for a table {name!r}; there are {', '.join(made)}")
        return f"<!-- table: {name} -->\n\n{made[name]}\n\n<!-- end -->"

    return re.sub(r"<!-- table: ([^>]+?) -->.*?<!-- end -->", block, page, flags=re.S)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("page", type=Path)
    parser.add_argument("--hasard", default="hasard", help="the program that makes the report")
    args = parser.parse_args()
    args.page.write_text(filled(args.page.read_text(), blocks(Campaign(args.folder, args.hasard))))


if __name__ == "__main__":
    main()
