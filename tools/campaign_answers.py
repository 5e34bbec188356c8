#!/usr/bin/env python3
"""The answers to the hypotheses of docs/campaign.md, from the kept copies of its runs.

    python3 tools/campaign_answers.py docs/results/campaign --hasard target/release/hasard

Scores are those of `hasard report`: (R - random) / (PPO - random) of the last policy if the upper 95 % end of its cost is within
the budget, else 0; an environment where PPO is not shown to return more than random play has no scale and is left out, by name.
Intervals: 95 % of 2,000 bootstrap samples that draw seeds within each environment. A hypothesis whose runs are not there is open,
and so is one with a single seed.
"""

import argparse
import statistics
from pathlib import Path

from campaign_runs import SCENARIOS, Campaign, interval, iqm

NO_RUNS = ("open", "no runs")
ONE_SEED = "open: one seed has no interval"


def answer(strata, statistic, words, more=""):
    """What a statistic that is positive where the hypothesis holds says of it, and in which words."""
    words = f"{words} {statistic(strata):.2f}"
    if min(map(len, strata.values())) < 2:
        return ONE_SEED, words + more
    low, high = interval(strata, statistic)
    state = "holds" if low > 0 else "the contrary holds" if high < 0 else "not decided"
    return state, f"{words}, {low:.2f} to {high:.2f}{more}"


def scores(runs):
    return [run.feasible for run in runs if run.feasible is not None]


def without(envs):
    return f"; without {', '.join(env.removesuffix('-v0') for env in envs)}" if envs else ""


def difference(strata):
    """Inter-quartile mean over environments of the first side's mean less the second's."""
    sides = {key: statistics.fmean(values) for key, values in strata.items()}
    return iqm([value - sides[(False, env)] for (first, env), value in sides.items() if first])


def beside(pairs, words):
    """Two lists of runs an environment, by feasible score."""
    strata, left_out = {}, []
    for env, (ours, others) in pairs.items():
        if not ours or not others:
            continue
        if not scores(ours) or not scores(others):
            left_out.append(env)
            continue
        strata[(True, env)], strata[(False, env)] = scores(ours), scores(others)
    if not strata:
        return ("open", f"no scale for {', '.join(left_out)}") if left_out else NO_RUNS
    return answer(strata, difference, words, without(left_out))


def level(campaign, number):
    return [f"{scenario}Level{number}-v0" for scenario in SCENARIOS]


def h1(campaign):
    pairs = {env: (campaign.of("PPOPID", env), campaign.of("PPOLag", env)) for env in level(campaign, 1)}
    return beside(pairs, "IQM of the difference")


def h2(campaign):
    """Over where the lower end of the cost is over the budget, within where the upper end is within it; of one seed, over episodes."""
    over, within, open_still = [], [], []
    for env, budget in sorted(campaign.budget.items()):
        runs = campaign.of("PPO", env)
        costs = [run.cost for run in runs]
        ends = interval({env: costs}, lambda drawn: statistics.fmean(drawn[env])) if len(costs) > 1 else (runs[0].cost_low, runs[0].cost_high)
        found = over if ends[0] > budget else within if ends[1] <= budget else open_still
        found.append(f"{env.removesuffix('-v0')} ({statistics.fmean(costs):.1f} of {budget:g})")
    environments = len(over) + len(within) + len(open_still)
    state = "does not hold" if within else "open" if environments < 18 else "not decided" if open_still else "holds"
    return state, f"over in {len(over)} of {environments}; within: {', '.join(within) or 'none'}; not decided: {', '.join(open_still) or 'none'}"


def h3(campaign):
    """Slope of PPOLag's normalised return over the share of the budget, each environment's seeds a stratum."""
    strata = {}
    for env, budget in campaign.budget.items():
        shares = {share: campaign.of("PPOLag", env, budget=share * budget) for share in (0.5, 1.0, 1.5)}
        if all(shares.values()) and all(run.normalised is not None for runs in shares.values() for run in runs):
            strata.update({(env, share): [run.normalised for run in runs] for share, runs in shares.items()})
    if not strata:
        return NO_RUNS

    def slope(drawn):
        points = [(share, value) for (_, share), values in drawn.items() for value in values]
        return statistics.linear_regression(*zip(*points)).slope

    return answer(strata, slope, "slope, in scales a whole budget,", f"; {len(strata) // 3} scenarios")


def h4(campaign):
    pairs = {env: (campaign.of("PPOPID", env, curriculum=True), campaign.of("PPOPID", env)) for env in level(campaign, 3)}
    return beside(pairs, "IQM of the difference")


def h5(campaign):
    answers = []
    for name, env, seen in (("depth", "PrecipicePlungeLevel2-v0", "rgb+depth"), ("segmentation", "ArmamentBurdenLevel2-v0", "segmented")):
        pairs = {env: (campaign.of("PPOPID", env, observation=seen), campaign.of("PPOPID", env))}
        answers.append((name, *beside(pairs, "IQM of the difference")))
    states = [state for _, state, _ in answers]
    state = states[0] if len(set(states)) == 1 else "; ".join(f"{name}: {state}" for name, state, _ in answers)
    return state, "; ".join(f"{name}: {text}" for name, _, text in answers)


def h6(campaign):
    """Below in five scenarios and not below in Precipice Plunge; each by the interval of the difference."""
    states, texts = [], []
    for scenario in SCENARIOS:
        env = f"{scenario}Level1-v0"
        runs, (chance, _) = campaign.of("PPOLag", env, hard=True), campaign.chance(env, hard=True)
        if not runs or not chance:
            continue
        sign = 1 if scenario == "PrecipicePlunge" else -1
        strata = {"agent": [run.earned for run in runs], "random": chance}
        state, _ = answer({"agent": strata["agent"]} if len(runs) < 2 else strata, lambda drawn: sign * (
            statistics.fmean(drawn["agent"]) - statistics.fmean(drawn.get("random", chance))), "")
        states.append(state)
        texts.append(f"{env.removesuffix('-v0')} {statistics.fmean(strata['agent']):.2f} (random {statistics.fmean(chance):.2f})")
    if len(states) < len(SCENARIOS):
        return "open", f"{len(states)} of {len(SCENARIOS)} scenarios have runs"
    if ONE_SEED in states:
        return ONE_SEED, "; ".join(texts)
    state = "does not hold" if "the contrary holds" in states else "not decided" if "not decided" in states else "holds"
    return state, "; ".join(texts)


def h7(campaign):
    strata, left_out = {}, []
    for number in (1, 2, 3):
        for env in level(campaign, number):
            runs = campaign.of("PPOPID", env)
            if not runs:
                return "open", f"{env} has no run"
            if scores(runs):
                strata[(number, env)] = scores(runs)
            else:
                left_out.append(env)

    def mean(number, drawn):
        return statistics.fmean(value for (one, _), values in drawn.items() if one == number for value in values)

    state, text = answer(strata, lambda drawn: mean(1, drawn) - mean(3, drawn), "level 1 less level 3")
    means = ", ".join(f"level {number} {mean(number, strata):.2f}" for number in (1, 2, 3))
    return state, f"{means}; {text}{without(left_out)}"


HYPOTHESES = {"H1": h1, "H2": h2, "H3": h3, "H4": h4, "H5": h5, "H6": h6, "H7": h7}


def table(campaign):
    rows = ["| # | answer | by |", "|---|---|---|"]
    for name, answered in HYPOTHESES.items():
        state, text = answered(campaign)
        rows.append(f"| {name} | {state} | {text} |")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--hasard", default="hasard", help="the program that makes the report")
    args = parser.parse_args()
    campaign = Campaign(args.folder, args.hasard)
    print(f"{len(campaign.runs)} runs\n\n{table(campaign)}")


if __name__ == "__main__":
    main()
