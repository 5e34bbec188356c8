"""An agent trained in the published engine, by a plain PPO of its own, plays there and here.

    pip install vizdoom==1.3.2 hasard==0.2.0 numpy torch gymnasium hasard-rs
    python agent_from_the_original.py RemedyRush 1 300000 100 [--keep POLICY.pt]      # frames of training, episodes of each

Prints return and cost of every episode, then both engines' means with standard errors. The worlds here are `hasard_rs` with the
published maps and rules; frames are the same 128x72 of colour, actions the simplified ones.
"""

import os
import sys
import tempfile

import hasard_rs
import numpy as np
import torch
import vizdoom

from numpy_agent import reduced
from plain_ppo import Policy, train
from published_engine import MAPS, Published

WORLDS = 8


class There:
    """A world of the published engine; episodes are seeded one after the other."""

    def __init__(self, scenario, level, groups, seed):
        self.world, self.seed = Published(scenario, level, False, groups, frames=True), seed

    def reset(self):
        self.seed += 1
        return reduced(self.world.reset(self.seed))

    def step(self, action):
        frame, reward, cost, over = self.world.step(action)
        return None if frame is None else reduced(frame), reward, cost, over


class Here:
    """A world of ours."""

    def __init__(self, scenario, level, seed):
        iwad = os.path.join(os.path.dirname(vizdoom.__file__), "freedoom2.wad")
        name = f"hasard/{scenario}Level{level}-v0"
        self.world, self.seed = hasard_rs.make(name, rules="released", resolution="128x72", maps=MAPS, iwad=iwad), seed

    def reset(self):
        self.seed += 1
        return self.world.reset(seed=self.seed)[0]

    def step(self, action):
        frame, reward, terminated, truncated, info = self.world.step(action)
        return frame, reward, info["cost"], terminated or truncated


def played(name, world, policy, episodes):
    """Return and cost of each episode."""
    sums = []
    for episode in range(episodes):
        frame, total, over = world.reset(), np.zeros(2), False
        while not over:
            frame, reward, cost, over = world.step(policy.act(frame[None])[0][0].numpy())
            total += reward, cost
        sums.append(total)
        print("{} {}: return {:.3f}, cost {:.3f}".format(name, episode + 1, *total), flush=True)
    return np.array(sums)


def main():
    scenario, level, frames, episodes = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    kept = os.path.abspath(sys.argv[sys.argv.index("--keep") + 1]) if "--keep" in sys.argv else None
    os.chdir(tempfile.mkdtemp())
    torch.manual_seed(1)
    torch.set_num_threads(1)
    groups = hasard_rs.spec(f"hasard/{scenario}Level{level}-v0").buttons
    sizes = [len(group) + 1 for group in groups]
    there = [There(scenario, level, groups, 1000 * lane) for lane in range(WORLDS)]
    policy = train(there, sizes, frames)
    if kept:
        torch.save(policy.state_dict(), kept)
    sides = [("there", there[0]), ("here", Here(scenario, level, 0))]
    theirs, ours = [played(name, world, policy, episodes) for name, world in sides]
    for index, what in enumerate(("return", "cost")):
        a, b = theirs[:, index], ours[:, index]
        errors = [x.std(ddof=1) / np.sqrt(episodes) for x in (a, b)]
        apart = (b.mean() - a.mean()) / np.hypot(*errors)
        print(f"{what}: there {a.mean():.2f} +- {errors[0]:.2f}, here {b.mean():.2f} +- {errors[1]:.2f}, {apart:+.1f} standard errors")


if __name__ == "__main__":
    main()
