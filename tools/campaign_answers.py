#!/usr/bin/env python3
"""The answers to the hypotheses of docs/campaign.md, from the kept copies of its runs.

    python3 tools/campaign_answers.py docs/results/campaign --hasard target/release/hasard

Scores are those of docs/campaign.md: (R - random) / (PPO - random) of the last policy if the upper 95 % end of its cost is within
the budget, else 0. An environment where PPO's episodes do not show that it returns more than random play has no scale and is left
out, by name. Seeds are those that all runs of a hypothesis have, PPO's among them. Intervals: of single environments Student's t
over seeds; over environments 95 % of 2,000 bootstrap samples that draw seeds within each. A hypothesis whose runs are not there is
open, and so is one with a single seed.
"""

import argparse
import statistics
from pathlib import Path

from campaign_runs import SCENARIOS, Campaign, Run, common_seeds, difference_of_means, interval, iqm, of_seeds, student

NO_RUNS = ("open", "no runs", set())
ONE_SEED = "open: one seed has no interval"


def answer(strata, statistic, words, more="", of_strata=None):
    """What a statistic that is positive where the hypothesis holds says of it, and in which words; of_strata gives another interval."""
    words = f"{words} {statistic(strata):.2f}"
    if min(map(len, strata.values())) < 2:
        return ONE_SEED, words + more
    low, high = of_strata(strata) if of_strata else interval(strata, statistic)
    state = "holds" if low > 0 else "the contrary holds" if high < 0 else "not decided"
    return state, f"{words}, {low:.2f} to {high:.2f}{more}"


def without(envs):
    return f"; without {', '.join(env.removesuffix('-v0') for env in envs)}" if envs else ""


def difference(strata):
    """Inter-quartile mean over environments of the first side's mean less the second's."""
    sides = {key: statistics.fmean(values) for key, values in strata.items()}
    return iqm([value - sides[(False, env)] for (first, env), value in sides.items() if first])


def scored(campaign, lists, score=Run.feasible):
    """{key: (env, runs)} as {key: scores} of the seeds that all have; the environments without a scale; the seeds."""
    envs = {env for env, _ in lists.values()}
    seeds = common_seeds([*(runs for _, runs in lists.values()), *(campaign.of("PPO", env) for env in envs)])
    scales = {env: campaign.scale(env, seeds) for env in envs}
    kept = {key: [score(run, scales[env]) for run in of_seeds(runs, seeds)] for key, (env, runs) in lists.items() if scales[env]}
    return kept, sorted(env for env in envs if not scales[env]), seeds


def beside(campaign, pairs, words):
    """Two lists of runs an environment, by feasible score."""
    lists = {(first, env): (env, runs) for env, sides in pairs.items() if all(sides) for first, runs in zip((True, False), sides)}
    strata, left_out, seeds = scored(campaign, lists)
    if not strata:
        return ("open", f"no scale for {', '.join(left_out)}", seeds) if left_out else NO_RUNS
    # A bootstrap of a few seeds of one environment would be too narrow.
    alone = len({env for _, env in strata}) == 1
    return *answer(strata, difference, words, without(left_out), sides_apart if alone else None), seeds


def sides_apart(strata):
    """Of one environment: 95 % interval of the first side's mean less the second's, by Student's t."""
    return difference_of_means(*(values for _, values in sorted(strata.items(), reverse=True)))


def level(campaign, number):
    return [f"{scenario}Level{number}-v0" for scenario in SCENARIOS]


def h1(campaign):
    pairs = {env: (campaign.of("PPOPID", env), campaign.of("PPOLag", env)) for env in level(campaign, 1)}
    return beside(campaign, pairs, "IQM of the difference")


def h2(campaign):
    """Over where the lower end of the cost is over the budget, within where the upper end is within it; of one seed, over episodes."""
    over, within, open_still, counts, all_seeds = [], [], [], [], set()
    for number in (1, 2, 3):
        lists = {env: campaign.of("PPO", env) for env in level(campaign, number)}
        seeds = common_seeds(lists.values())
        all_seeds |= seeds
        counts.append(f"{len(seeds)} at level {number}")
        for env, runs in lists.items():
            runs, budget = of_seeds(runs, seeds), campaign.budget.get(env)
            if not runs:
                continue
            costs = [run.cost for run in runs]
            low, high = student(costs) if len(costs) > 1 else (runs[0].cost_low, runs[0].cost_high)
            found = over if low > budget else within if high <= budget else open_still
            found.append(f"{env.removesuffix('-v0')} ({statistics.fmean(costs):.1f} of {budget:g}, {low:.1f} to {high:.1f})")
    environments = len(over) + len(within) + len(open_still)
    state = "does not hold" if within else "open" if environments < 18 else "not decided" if open_still else "holds"
    text = f"over in {len(over)} of {environments}; within: {', '.join(within) or 'none'}; not decided: {', '.join(open_still) or 'none'}"
    return state, f"{text}; seeds: {', '.join(counts)}", all_seeds


def h3(campaign):
    """Slope of PPOLag's normalised return over the share of the budget, each environment's seeds a stratum."""
    lists = {}
    for env in level(campaign, 1):
        shares = {share: campaign.of("PPOLag", env, budget=share * campaign.budget.get(env, 0)) for share in (0.5, 1.0, 1.5)}
        if all(shares.values()):
            lists.update({(env, share): (env, runs) for share, runs in shares.items()})
    strata, _, seeds = scored(campaign, lists, Run.normalised)
    if not strata:
        return NO_RUNS

    def slope(drawn):
        points = [(share, value) for (_, share), values in drawn.items() for value in values]
        return statistics.linear_regression(*zip(*points)).slope

    return *answer(strata, slope, "slope, in scales a whole budget,", f"; {len(strata) // 3} scenarios"), seeds


def h4(campaign):
    pairs = {env: (campaign.of("PPOPID", env, curriculum=True), campaign.of("PPOPID", env)) for env in level(campaign, 3)}
    return beside(campaign, pairs, "IQM of the difference")


def h5(campaign):
    answers, all_seeds = [], set()
    for name, env, seen in (("depth", "PrecipicePlungeLevel2-v0", "rgb+depth"), ("segmentation", "ArmamentBurdenLevel2-v0", "segmented")):
        pairs = {env: (campaign.of("PPOPID", env, observation=seen), campaign.of("PPOPID", env))}
        state, text, seeds = beside(campaign, pairs, "difference")
        answers.append((name, state, text))
        all_seeds |= seeds
    states = [state for _, state, _ in answers]
    state = states[0] if len(set(states)) == 1 else "; ".join(f"{name}: {state}" for name, state, _ in answers)
    return state, "; ".join(f"{name}: {text}" for name, _, text in answers), all_seeds


def h6(campaign):
    """Below in five scenarios and not below in Precipice Plunge; each by the interval of the difference."""
    lists = {env: campaign.of("PPOLag", env, hard=True) for env in level(campaign, 1)}
    seeds, states, texts = common_seeds(lists.values()), [], []
    for env, runs in lists.items():
        earned, (chance, _) = [run.earned for run in of_seeds(runs, seeds)], campaign.chance(env, hard=True)
        if not earned or not chance:
            continue
        text = f"{env.removesuffix('-v0')} {statistics.fmean(earned):.2f} (random {statistics.fmean(chance):.2f}"
        if len(earned) < 2:
            states.append(ONE_SEED)
            texts.append(text + ")")
            continue
        low, high = difference_of_means(earned, chance)
        if env.startswith("PrecipicePlunge"):
            # Excepted: what would refute the hypothesis here is a return below random play's.
            low, high = -high, -low
        states.append("holds" if high < 0 else "the contrary holds" if low > 0 else "not decided")
        texts.append(f"{text}: {states[-1]})")
    if len(states) < len(SCENARIOS):
        return "open", f"{len(states)} of {len(SCENARIOS)} scenarios have runs", seeds
    if ONE_SEED in states:
        return ONE_SEED, "; ".join(texts), seeds
    state = "does not hold" if "the contrary holds" in states else "not decided" if "not decided" in states else "holds"
    return state, "; ".join(texts), seeds


def h7(campaign):
    lists = {(number, env): (env, campaign.of("PPOPID", env)) for number in (1, 2, 3) for env in level(campaign, number)}
    for env, runs in lists.values():
        if not runs:
            return "open", f"{env} has no run", set()
    strata, left_out, seeds = scored(campaign, lists)
    # A scenario that has no scale at one level would make of the others' difference one of scenarios.
    whole = {name for name in SCENARIOS if sum(env.startswith(name) for _, env in strata) == 3}
    strata = {key: values for key, values in strata.items() if key[1].split("Level")[0] in whole}

    def of_level(number, drawn):
        return iqm([value for (one, _), values in drawn.items() if one == number for value in values])

    if not strata:
        return "open", f"no scale for {', '.join(left_out)}", seeds
    left_out = [name for name in SCENARIOS if name not in whole]
    state, text = answer(strata, lambda drawn: of_level(1, drawn) - of_level(3, drawn), "level 1 less level 3")
    means = ", ".join(f"level {number} {of_level(number, strata):.2f}" for number in (1, 2, 3))
    return state, f"IQM: {means}; {text}{without(left_out)}", seeds


HYPOTHESES = {"H1": h1, "H2": h2, "H3": h3, "H4": h4, "H5": h5, "H6": h6, "H7": h7}


def table(campaign):
    rows = ["| # | answer | by | seeds |", "|---|---|---|---|"]
    for name, answered in HYPOTHESES.items():
        state, text, seeds = answered(campaign)
        rows.append(f"| {name} | {state} | {text} | {', '.join(map(str, sorted(seeds)))} |")
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
