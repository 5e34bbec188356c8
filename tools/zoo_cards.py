#!/usr/bin/env python3
"""What the agents of the zoo score, as tables for docs/results/zoo.md.

    python3 tools/zoo_cards.py target/release/hasard > tables.md

Every agent plays 200 episodes, which no training saw, under the rules that it was trained with and under `tables`; beside its
figures stand those of a random policy under the same rules, and the paper's for PPOPID and for people. The 95 % half-widths are
Student's t, and so is the verdict; `hasard eval` takes a bootstrap interval where costs are skewed.
"""

import argparse
import csv
import json
import statistics
import struct
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENARIOS = ("ArmamentBurden", "VolcanicVenture", "RemedyRush", "CollateralDamage", "PrecipicePlunge", "DetonatorsDilemma")
# Half-width of a 95 % interval in standard errors: Student's t with 199 degrees of freedom.
WIDE = 1.97196


def card(path):
    """What an agent's file says of itself: safetensors keeps it in the header."""
    with path.open("rb") as file:
        (length,) = struct.unpack("<Q", file.read(8))
        return json.loads(json.loads(file.read(length))["__metadata__"]["hasard"])


def published(algorithm):
    rows = csv.DictReader((ROOT / "crates/report/data/published.csv").open())
    wanted = [row for row in rows if row["algorithm"] == algorithm and row["table"] in ("main", "human") and not row["option"]]
    return {(row["scenario"], int(row["level"])): f"{float(row['return']):.2f} @ {float(row['cost']):.2f}" for row in wanted}


def episodes(hasard, *words):
    lines = subprocess.run([hasard, *words, "--json"], check=True, capture_output=True, text=True).stdout.splitlines()
    rows = [json.loads(line) for line in lines]
    return [row for row in rows if "episode" in row]


def shown(numbers):
    half = WIDE * statistics.stdev(numbers) / len(numbers) ** 0.5
    return statistics.fmean(numbers), half


def row(hasard, name, rules, budget, people, paper):
    played = episodes(hasard, "eval", f"zoo:{name}", "--episodes", "200", "--rules", rules)
    costs = sorted(one["cost"] for one in played)
    earned, cost = shown([one["return"] for one in played]), shown(costs)
    state = "within" if cost[0] + cost[1] <= budget else "by its mean" if cost[0] <= budget else "**over**"
    tail = statistics.fmean(costs[-len(costs) // 10 :])
    over = 100 * sum(one > budget for one in costs) / len(costs)
    chance = episodes(hasard, "rollout", f"{name}-v0", "--policy", "random", "--episodes", "200", "--rules", rules)
    random = f"{statistics.fmean(one['return'] for one in chance):.1f} @ {statistics.fmean(one['cost'] for one in chance):.1f}"
    cells = (
        f"{name[:-6]} {name[-1]}",
        f"{earned[0]:.2f} ± {earned[1]:.2f}",
        f"{cost[0]:.2f} ± {cost[1]:.2f} of {budget:g}",
        state,
        f"{statistics.median(costs):.1f}",
        f"{costs[-1]:.1f}",
        f"{tail:.1f}",
        f"{over:.0f} %",
        random,
        paper,
        people,
    )
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("hasard", help="the program")
    parser.add_argument("--agents", default="", help="only agents whose names contain this")
    options = parser.parse_args()
    people, paper = published("Human"), published("PPOPID")
    for rules in ("paper", "tables"):
        print(f"Rules `{rules}`:\n")
        print("| agent | return | cost | | median cost | worst | mean of the worst tenth | episodes over | random | paper's PPOPID | people |")
        print("|---|--:|--:|---|--:|--:|--:|--:|--:|--:|--:|")
        for level in (1, 2, 3):
            for scenario in SCENARIOS:
                file = ROOT / f"zoo/{scenario}Level{level}.agent"
                if not file.is_file() or options.agents not in file.stem:
                    continue
                budget = card(file)["config"]["constraints"][0]["budget"]
                key = (scenario, level)
                print(row(options.hasard, file.stem, rules, budget, people.get(key, ""), paper.get(key, "")), flush=True)
        print()


if __name__ == "__main__":
    main()
