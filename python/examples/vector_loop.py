"""A batch of worlds, stepped by Rust threads while Python is free; costs of each step in `infos`."""

import sys
import time

import hasard_rs

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 500
envs = hasard_rs.make_vec("hasard/RemedyRushLevel1-v0", 32, resolution="128x72", autoreset_mode="SameStep")
observations, infos = envs.reset(seed=0)
start = time.perf_counter()
for _ in range(steps):
    observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
    if "final_info" in infos:
        ended = infos["_final_info"]
        print("episode costs", infos["final_info"]["episode_summary"]["cost"][ended])
print(f"{steps * 32 / (time.perf_counter() - start):.0f} policy steps/s")
