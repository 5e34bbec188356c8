"""What python/examples/ppo_lag_torch.py and `hasard train` learned from as many frames: a table, and their curves as a picture.

    python python/compat/torch_curves.py docs/results/torch_example.png RUNS/torch-1 RUNS/torch-2 RUNS/torch-3 -- RUNS/ours-1 RUNS/ours-2 RUNS/ours-3

Folders before the dashes are the example's (TensorBoard), those after it runs of the program (metrics.jsonl). Both report the mean of the latest
100 episodes of training. Needs tensorboard and matplotlib.
"""

import json
import sys
from pathlib import Path

import matplotlib
import numpy as np
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def of_tensorboard(folder):
    """Frames, return and cost of a run of the example."""
    events = EventAccumulator(folder, size_guidance={"scalars": 0})
    events.Reload()
    rows = [events.Scalars(name) for name in ("return_mean", "cost_mean/cost")]
    return np.array([[one.step, one.value, other.value] for one, other in zip(*rows)])


def of_run(folder):
    """The same of a run of the program."""
    rows = [json.loads(line) for line in (Path(folder) / "metrics.jsonl").read_text().splitlines()]
    return np.array([[row["frames"], row["return_mean"], row["cost_mean"]] for row in rows if row.get("return_mean") is not None])


def main(picture, *folders):
    at = folders.index("--")
    groups = [("ppo_lag_torch.py", [of_tensorboard(one) for one in folders[:at]]), ("hasard train", [of_run(one) for one in folders[at + 1 :]])]
    print("| | " + " | ".join(f"seed {seed + 1}" for seed in range(at)) + " | mean return | mean cost |")
    print("|---|" + "---|" * at + "--:|--:|")
    for name, runs in groups:
        ends = [run[-1] for run in runs]
        means = np.mean(ends, 0)
        print(f"| {name} | " + " | ".join(f"{end[1]:.2f} @ {end[2]:.1f}" for end in ends) + f" | {means[1]:.2f} | {means[2]:.1f} |")
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained")
    for (name, runs), colour in zip(groups, ("#c8553d", "#1f6f8b")):
        for column, axis in enumerate(axes, start=1):
            for number, run in enumerate(runs):
                axis.plot(run[:, 0] / 1e6, run[:, column], color=colour, linewidth=1.3, alpha=0.8, label=name if number == 0 else None)
    axes[1].axhline(50, color="black", linestyle="--", linewidth=1, label="budget")
    for axis, title in zip(axes, ("return of an episode", "cost of an episode")):
        axis.set(xlabel="frames (millions)", ylabel=title)
        axis.spines[["top", "right"]].set_visible(False)
    axes[1].set_ylim(0, 150)
    axes[1].legend(frameon=False)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
