"""An agent trained here plays in the published engine: weights from its checkpoint, NumPy, nothing of ours at run time.

    pip install vizdoom==1.3.2 hasard==0.2.0 numpy
    hasard train PrecipicePlungeLevel1-v0 --maps auto --iwad auto --rules released --out runs/pp1
    hasard envs --json > envs.json
    python agent_in_the_original.py runs/pp1 envs.json 100            # there: return, cost and steps of each episode, then means
    hasard eval runs/pp1 --episodes 100                                     # here; both take --greedy and --latest

The simplified actions and colour frames of 128x72, one at a time; rewards and costs are read as the published package reads them.
"""

import os
import sys
import tempfile

import numpy as np

from numpy_agent import of_run, reduced
from published_engine import Published


def main():
    run, listed, episodes = sys.argv[1], sys.argv[2], int(sys.argv[3])
    greedy = "--greedy" in sys.argv
    agent, env, groups = of_run(run, listed, "--latest" in sys.argv)
    scenario, level = env["id"].split("Level")
    os.chdir(tempfile.mkdtemp())
    original = Published(scenario, int(level[0]), env["hard"], groups, frames=True)
    sums = []
    for seed in range(1, episodes + 1):
        rng = None if greedy else np.random.default_rng(seed)
        frame, total, over = original.reset(seed), np.zeros(3), False
        agent.forget()
        while not over:
            frame, reward, cost, over = original.step(agent.act(reduced(frame), rng))
            total += reward, cost, 1
        sums.append(total)
        print("episode {}: return {:.3f}, cost {:.3f}, {:.0f} steps".format(seed, *total), flush=True)
    sums = np.array(sums)
    errors = sums.std(0, ddof=1) / np.sqrt(episodes) if episodes > 1 else np.zeros(3)
    print("mean of {}: return {:.3f} +- {:.3f}, cost {:.3f} +- {:.3f} (standard errors)".format(
        episodes, sums[:, 0].mean(), errors[0], sums[:, 1].mean(), errors[1]))


if __name__ == "__main__":
    main()
