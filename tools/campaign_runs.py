"""The kept runs of the campaign, and the statistics its questions ask for; scores are those of `hasard report`."""

import csv
import json
import random
import statistics
import subprocess
import tempfile
from pathlib import Path

RESAMPLES = 2000
SCENARIOS = ("ArmamentBurden", "VolcanicVenture", "RemedyRush", "CollateralDamage", "PrecipicePlunge", "DetonatorsDilemma")


class Run:
    """One seed: its task, what its last policy earned and cost, and its scores (None without a scale)."""

    def __init__(self, row):
        folder = Path(row["directory"])
        config = json.loads((folder / "config.json").read_text())
        last = json.loads((folder / "selected.json").read_text())["last"]
        env = config["env"]
        self.env, self.algorithm, self.seed = env["id"], config["algorithm"], config["seed"]
        self.scenario, self.level = self.env.split("Level")[0], int(self.env.split("Level")[1][0])
        self.hard, self.full = bool(env.get("hard")), bool(env.get("full_actions"))
        self.observation = str(env.get("observation", "rgb")).lower()
        self.curriculum = bool(config.get("curriculum"))
        self.budget = config["constraints"][0]["budget"]
        # PPOCost's alone; null is what the rules say, 1 under `paper`.
        self.scale = config.get("algorithm_settings", {}).get("penalty_scale") or 1.0
        self.earned, self.earned_half = last["episode_return"]["mean"], last["episode_return"]["half_width"]
        cost = last["cost"]
        self.cost, self.cost_high = cost["mean"], float(row["judged_cost_high"])
        self.cost_low = cost["bootstrap"][0] if cost["bootstrap"] else cost["mean"] - cost["half_width"]
        self.within = self.cost_high <= self.budget
        self.normalised, self.feasible = (float(row[name]) if row[name] else None for name in ("normalised_return", "feasible_score"))


class Campaign:
    def __init__(self, root, hasard="hasard"):
        with tempfile.TemporaryDirectory() as out:
            words = [hasard, "report", str(root), "-o", out]
            done = subprocess.run(words, capture_output=True, text=True)
            if done.returncode:
                raise SystemExit(done.stderr.strip() or f"{' '.join(words)} ended with {done.returncode}")
            rows = list(csv.DictReader((Path(out) / "runs.csv").read_text().splitlines()))
        if "feasible_score" not in rows[0]:
            raise SystemExit(f"{hasard} is older than this script; build it again")
        self.runs = [Run(row) for row in rows if row["judged_by"] == "last policy"]
        self.budget = {run.env: run.budget for run in self.runs if run.algorithm == "PPO" and not run.hard}
        self.random = {}
        for path in Path(root).rglob("random-*.jsonl"):
            episodes = [json.loads(line) for line in path.read_text().splitlines()]
            episodes = [one for one in episodes if "return" in one]
            self.random[path.stem.removeprefix("random-")] = episodes

    def of(self, algorithm, env, **wanted):
        """The seeds of an experiment; of the default task but for what is wanted."""
        usual = {"hard": False, "full": False, "curriculum": False, "observation": "rgb", "scale": 1.0, "budget": self.budget.get(env)}
        wanted = {**usual, **wanted}
        if wanted["hard"]:
            del wanted["budget"]  # A hard constraint has a budget of its own.
        here = (run for run in self.runs if run.algorithm == algorithm and run.env == env)
        return [run for run in here if all(getattr(run, name) == value for name, value in wanted.items())]

    def chance(self, env, hard=False):
        """Random play's returns and costs, an episode each."""
        episodes = self.random.get(f"{env}-paper{'-hard' if hard else ''}", [])
        return [one["return"] for one in episodes], [one["cost"] for one in episodes]


def iqm(numbers):
    """The mean of the middle half; values at its ends count by their share, as in Agarwal et al. 2021."""
    numbers, cut = sorted(numbers), len(numbers) / 4
    weights = [min(1.0, max(0.0, k + 1 - cut)) * min(1.0, max(0.0, len(numbers) - cut - k)) for k in range(len(numbers))]
    return sum(weight * number for weight, number in zip(weights, numbers)) / sum(weights)


def interval(strata, statistic):
    """95 % of bootstrap samples of a statistic of {name: seeds' values}, each redrawn within its name."""
    stream = random.Random(20261125)
    drawn = sorted(
        statistic({name: stream.choices(values, k=len(values)) for name, values in strata.items()}) for _ in range(RESAMPLES)
    )
    return drawn[int(0.025 * RESAMPLES)], drawn[int(0.975 * RESAMPLES) - 1]
