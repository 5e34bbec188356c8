#!/usr/bin/env python3
"""The answers to the hypotheses of docs/campaign.md, from the kept copies of its runs.

    python3 tools/campaign_answers.py docs/results/campaign

Scores are those of `hasard report`: (R - random) / (PPO - random) of the last policy if the upper 95 % end of its cost is within
the budget, else 0; an environment where PPO is not shown to return more than random play has no scale and is left out, by name.
Intervals: 95 % of 2,000 bootstrap samples that draw seeds within each environment. A hypothesis whose runs are not there is open.
"""

import argparse
import json
import random
import statistics
from collections import defaultdict
from pathlib import Path

RESAMPLES = 2000


class Run:
    def __init__(self, folder):
        config = json.loads((folder / "config.json").read_text())
        last = json.loads((folder / "selected.json").read_text())["last"]
        env = config["env"]
        self.env, self.algorithm, self.seed = env["id"], config["algorithm"].lower(), config["seed"]
        self.scenario, self.level = self.env.split("Level")[0], int(self.env.split("Level")[1][0])
        self.hard = bool(env.get("hard"))
        self.observation = str(env.get("observation", "rgb")).lower()
        self.full = bool(env.get("full_actions"))
        self.curriculum = bool(config.get("curriculum"))
        self.budget = config["constraints"][0]["budget"]
        earned, cost = last["episode_return"], last["cost"]
        self.earned, self.earned_low = earned["mean"], earned["mean"] - earned["half_width"]
        low, high = cost["bootstrap"] or (cost["mean"] - cost["half_width"], cost["mean"] + cost["half_width"])
        self.cost, self.cost_low, self.cost_high = cost["mean"], low, high

    def plain(self, budget):
        return not (self.hard or self.full or self.curriculum) and self.observation == "rgb" and self.budget == budget


class Campaign:
    def __init__(self, root):
        folders = [path.parent for path in root.rglob("config.json") if (path.parent / "selected.json").is_file()]
        self.runs = [Run(folder) for folder in sorted(folders)]
        self.budget = {run.env: run.budget for run in self.runs if run.algorithm == "ppo" and not run.hard}
        self.random = {}
        for path in root.rglob("random-*.jsonl"):
            rows = [json.loads(line) for line in path.read_text().splitlines()]
            returns = [row["return"] for row in rows if "return" in row]
            half = 1.96 * statistics.stdev(returns) / len(returns) ** 0.5
            self.random[path.stem.removeprefix("random-")] = (statistics.fmean(returns), half)

    def of(self, algorithm, env, **wanted):
        here = (run for run in self.runs if run.algorithm == algorithm and run.env == env)
        return [run for run in here if all(getattr(run, name) == value for name, value in wanted.items())]

    def scale(self, env, **task):
        """Random play's and PPO's mean return; nothing where PPO has not learned more than chance does."""
        ppo = self.of("ppo", env, **task)
        chance = self.random.get(env + "-paper" + ("-hard" if task.get("hard") else ""))
        if not ppo or chance is None or statistics.fmean(run.earned_low for run in ppo) <= chance[0] + chance[1]:
            return None
        return chance[0], statistics.fmean(run.earned for run in ppo)

    def feasible(self, run, scale):
        low, high = scale
        return max(0.0, (run.earned - low) / (high - low)) if run.cost_high <= run.budget else 0.0


def iqm(numbers):
    """The mean of the middle half; values at its ends count by their share, as in Agarwal et al. 2021."""
    numbers, cut = sorted(numbers), len(numbers) / 4
    weights = [min(1.0, max(0.0, k + 1 - cut)) * min(1.0, max(0.0, len(numbers) - cut - k)) for k in range(len(numbers))]
    return sum(weight * number for weight, number in zip(weights, numbers)) / sum(weights)


def interval(strata, statistic):
    """Of a statistic of {name: seeds' values}, each redrawn within its name."""
    stream = random.Random(20261125)
    drawn = sorted(
        statistic({name: stream.choices(values, k=len(values)) for name, values in strata.items()}) for _ in range(RESAMPLES)
    )
    return drawn[int(0.025 * RESAMPLES)], drawn[int(0.975 * RESAMPLES) - 1]


def answer(strata, statistic, words, more=""):
    """What a statistic that is positive where the hypothesis holds says of it, and in which words."""
    words = f"{words} {statistic(strata):.2f}"
    if min(map(len, strata.values())) < 2:
        return "open: one seed has no interval", words + more
    low, high = interval(strata, statistic)
    state = "holds" if low > 0 else "the contrary holds" if high < 0 else "not decided"
    return state, f"{words}, {low:.2f} to {high:.2f}{more}"


def pairs(campaign, level, better, worse):
    """Feasible scores of two algorithms on the environments of a level that have a scale; and those that have none."""
    strata, without = {}, []
    for env in sorted(env for env in campaign.budget if f"Level{level}" in env):
        plain = {"hard": False, "full": False, "curriculum": False, "observation": "rgb", "budget": campaign.budget[env]}
        scale = campaign.scale(env, **plain)
        sides = [campaign.of(name, env, **plain) for name in (better, worse)]
        if not all(sides):
            continue
        if scale is None:
            without.append(env)
            continue
        for name, runs in zip((better, worse), sides):
            strata[(name, env)] = [campaign.feasible(run, scale) for run in runs]
    return strata, without


def h1(campaign):
    strata, without = pairs(campaign, 1, "ppopid", "ppolag")
    if not strata:
        return "open", "no runs"

    def difference(drawn):
        side = lambda name: iqm([value for key, values in drawn.items() if key[0] == name for value in values])
        return side("ppopid") - side("ppolag")

    left = f"; without {', '.join(without)}" if without else ""
    return answer(strata, difference, "difference of the IQMs", left)


def h2(campaign):
    under, over = [], []
    for env, budget in sorted(campaign.budget.items()):
        runs = [run for run in campaign.of("ppo", env) if run.plain(budget)]
        costs = [run.cost for run in runs]
        low = interval({env: costs}, lambda drawn: statistics.fmean(drawn[env]))[0] if len(costs) > 1 else runs[0].cost_low
        (over if low > budget else under).append(f"{env.removesuffix('-v0')} ({statistics.fmean(costs):.1f} of {budget:g})")
    state = "open" if len(under) + len(over) < 18 else "holds" if not under else "does not hold"
    return state, f"over in {len(over)} of {len(over) + len(under)}; not shown to be over: {', '.join(under) or 'none'}"


def h7(campaign):
    means = {}
    for level in (1, 2, 3):
        strata, without = pairs(campaign, level, "ppopid", "ppo")
        values = [value for key, seeds in strata.items() if key[0] == "ppopid" for value in seeds]
        scenarios = len({env for _, env in strata}) + len(without)
        if values and scenarios == 6:
            means[level] = (statistics.fmean(values), len(values), without)
    if set(means) != {1, 2, 3}:
        return "open", "a level's six scenarios are not all there"
    text = "; ".join(
        f"level {level} {mean:.2f} ({count} runs{', without ' + ', '.join(left) if left else ''})" for level, (mean, count, left) in means.items()
    )
    falls = means[1][0] > means[2][0] > means[3][0]
    return "means fall; no interval yet" if falls else "means do not fall", text


def by_budget(campaign):
    """Slope of PPOLag's normalised return over the share of the budget, each environment's seeds a stratum."""
    strata = {}
    for env, budget in campaign.budget.items():
        scale = campaign.scale(env, hard=False, full=False, curriculum=False, observation="rgb", budget=budget)
        shares = defaultdict(list)
        for run in campaign.of("ppolag", env, hard=False, full=False, curriculum=False, observation="rgb"):
            shares[run.budget / budget].append(run)
        if scale and len(shares) >= 3:
            for share, runs in shares.items():
                strata[(env, share)] = [(run.earned - scale[0]) / (scale[1] - scale[0]) for run in runs]
    if not strata:
        return "open", "no runs"

    def slope(drawn):
        points = [(share, value) for (_, share), values in drawn.items() for value in values]
        return statistics.linear_regression(*zip(*points)).slope

    return answer(strata, slope, "slope, in scales a whole budget,")


def not_yet(campaign):
    return "open", "its runs are still to be made"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    campaign = Campaign(parser.parse_args().folder)
    print(f"{len(campaign.runs)} runs\n")
    print("| # | answer | by |")
    print("|---|---|---|")
    for name, answered in (("H1", h1), ("H2", h2), ("H3", by_budget), ("H4", not_yet), ("H5", not_yet), ("H6", not_yet), ("H7", h7)):
        state, text = answered(campaign)
        print(f"| {name} | {state} | {text} |")


if __name__ == "__main__":
    main()
