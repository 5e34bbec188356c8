"""Our own trainer from Python: PPOPID for a while, every report in a callback, then the agent at work."""

import sys
from pathlib import Path

import hasard_rs

out = Path(sys.argv[1] if len(sys.argv) > 1 else "runs/from_python")
frames = int(sys.argv[2]) if len(sys.argv) > 2 else 200_000


def callback(report: dict) -> bool:
    print({name: report.get(name) for name in ("frames", "return_mean", "cost_mean")})
    return report["frames"] >= frames


run = hasard_rs.train("hasard/VolcanicVentureLevel1-v0", "PPOPID", preset="quick", out=out, callback=callback)
agent = hasard_rs.Agent.load(run.directory)
envs = agent.make_vec(8)
observations, infos = envs.reset(seed=0)
state = None
for _ in range(100):
    actions, state = agent.act(observations, state)
    observations, rewards, terminations, truncations, infos = envs.step(actions)
    state = agent.after(state, infos["cost"], terminations | truncations)
print("rewards of the last step", rewards)
