"""The kept runs of the campaign, and the statistics its questions ask for."""

import csv
import json
import math
import random
import statistics
import subprocess
import tempfile
from pathlib import Path

RESAMPLES = 2000
SCENARIOS = ("ArmamentBurden", "VolcanicVenture", "RemedyRush", "CollateralDamage", "PrecipicePlunge", "DetonatorsDilemma")


class Run:
    """One seed: its task, what its last policy earned and cost over its episodes, and whether it surely keeps its budget."""

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
        scale = config.get("algorithm_settings", {}).get("penalty_scale")
        self.scale = 1.0 if scale is None else scale
        earned = last["episode_return"]
        self.earned, ends = earned["mean"], earned.get("bootstrap")
        # As `hasard report` has it: of a bootstrap interval the longer arm.
        self.earned_half = max(self.earned - ends[0], ends[1] - self.earned) if ends else earned["half_width"]
        cost = last["cost"]
        self.cost, self.cost_high = cost["mean"], float(row["judged_cost_high"])
        self.cost_low = cost["bootstrap"][0] if cost["bootstrap"] else cost["mean"] - cost["half_width"]
        self.within = self.cost_high <= self.budget
        # What a campaign does not vary, and what an algorithm learns by in an environment.
        self.terms = {"rules": env["rules"], "preset": config.get("preset"), "frames": config["frames"], "frame_skip": env.get("frame_skip", 4)}
        self.learning = config.get("learning", {})

    def normalised(self, scale):
        """Its return, where random play's is 0 and PPO's is 1."""
        chance, ppo = scale
        return (self.earned - chance) / (ppo - chance)

    def feasible(self, scale):
        """The headline of docs/campaign.md; below 0 for a policy within its budget that earns less than random play."""
        return self.normalised(scale) if self.within else 0.0


class Campaign:
    def __init__(self, root, hasard="hasard"):
        with tempfile.TemporaryDirectory() as out:
            words = [hasard, "report", str(root), "-o", out]
            done = subprocess.run(words, capture_output=True, text=True)
            if done.returncode:
                raise SystemExit(done.stderr.strip() or f"{' '.join(words)} ended with {done.returncode}")
            rows = list(csv.DictReader((Path(out) / "runs.csv").read_text().splitlines()))
        if "judged_cost_high" not in rows[0]:
            raise SystemExit(f"{hasard} is older than this script; build it again")
        self.runs = [Run(row) for row in rows if row["judged_by"] == "last policy"]
        self.refuse_others(root)
        self.budget = {run.env: run.budget for run in self.runs if run.algorithm == "PPO" and not run.hard}
        self.random = {}
        for path in Path(root).rglob("random-*.jsonl"):
            episodes = [json.loads(line) for line in path.read_text().splitlines()]
            episodes = [one for one in episodes if "return" in one]
            self.random[path.stem.removeprefix("random-")] = episodes

    def refuse_others(self, root):
        """Ends the program where runs of another study lie among a campaign's: their means would be nobody's."""
        alike = {}
        for run in self.runs:
            first = self.runs[0]
            if run.terms != first.terms:
                raise SystemExit(f"{root}: has runs under {first.terms} and under {run.terms}; leave one kind there")
            like = alike.setdefault((run.algorithm, run.env), run)
            # Settings that came since are not in older files, and have no effect there.
            if any(like.learning.get(name, value) != value for name, value in run.learning.items()):
                raise SystemExit(f"{root}: {run.algorithm} on {run.env} has runs of several `learning` settings; leave one kind there")

    def of(self, algorithm, env, **wanted):
        """The seeds of an experiment; of the default task but for what is wanted."""
        usual = {"hard": False, "full": False, "curriculum": False, "observation": "rgb", "scale": 1.0, "budget": self.budget.get(env)}
        wanted = {**usual, **wanted}
        if wanted["hard"]:
            del wanted["budget"]  # A hard constraint has a budget of its own.
        here = (run for run in self.runs if run.algorithm == algorithm and run.env == env)
        found = [run for run in here if all(getattr(run, name) == value for name, value in wanted.items())]
        if len({run.seed for run in found}) < len(found):
            raise SystemExit(f"{algorithm} on {env}: a seed is there twice under {wanted}; leave one of its runs there")
        return found

    def chance(self, env, hard=False):
        """Random play's returns and costs, an episode each."""
        episodes = self.random.get(f"{env}-paper{'-hard' if hard else ''}", [])
        return [one["return"] for one in episodes], [one["cost"] for one in episodes]

    def scale(self, env, seeds):
        """What random play and PPO return, PPO over the seeds; None unless PPO's episodes show that it returns more."""
        chance, ppo = self.chance(env)[0], of_seeds(self.of("PPO", env), seeds)
        if not chance or not ppo:
            return None
        least = statistics.fmean(run.earned - run.earned_half for run in ppo)
        return (statistics.fmean(chance), statistics.fmean(run.earned for run in ppo)) if least > student(chance)[1] else None


def common_seeds(lists):
    """The seeds that all of several lists of runs have, of those that have any."""
    seeds = [{run.seed for run in runs} for runs in lists if runs]
    return set.intersection(*seeds) if seeds else set()


def of_seeds(runs, seeds):
    return [run for run in runs if run.seed in seeds]


def iqm(numbers):
    """The mean without the least and the largest quarter, each rounded down, as `rliable` and `hasard report` have it."""
    numbers, cut = sorted(numbers), len(numbers) // 4
    return statistics.fmean(numbers[cut : len(numbers) - cut])


# 97.5 % quantiles of Student's t for 1 to 9 degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262)


def student(values):
    """95 % interval of a mean of several values."""
    freedom = len(values) - 1
    # Cornish and Fisher's expansion, to 0.003 from ten degrees on.
    quantile = STUDENT[freedom - 1] if freedom <= len(STUDENT) else 1.96 + 2.372 / freedom + 2.823 / freedom**2
    mean, half = statistics.fmean(values), quantile * statistics.stdev(values) / math.sqrt(len(values))
    return mean - half, mean + half


def difference_of_means(one, other):
    """95 % interval of the difference of two means, from the interval of each (MOVER; Zou and Donner 2008)."""
    (low, high), (least, most) = student(one), student(other)
    mean, rest = statistics.fmean(one), statistics.fmean(other)
    return mean - rest - math.hypot(mean - low, most - rest), mean - rest + math.hypot(high - mean, rest - least)


def interval(strata, statistic):
    """95 % of bootstrap samples of a statistic of {name: seeds' values}, each redrawn within its name."""
    stream = random.Random(20261125)
    drawn = sorted(
        statistic({name: stream.choices(values, k=len(values)) for name, values in strata.items()}) for _ in range(RESAMPLES)
    )
    return drawn[int(0.025 * RESAMPLES)], drawn[int(0.975 * RESAMPLES) - 1]
