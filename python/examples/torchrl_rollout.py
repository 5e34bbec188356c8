"""TorchRL: our EnvBase and its own wrapper over the native vector environment, checked and collected from.

    pip install '.[torchrl]'
"""

import hasard_rs
from hasard_rs.torchrl import HasardEnv
from torchrl.collectors import Collector
from torchrl.envs import GymWrapper
from torchrl.envs.utils import check_env_specs

env = HasardEnv("hasard/RemedyRushLevel1-v0", 8, resolution="64x48")
check_env_specs(env)
frames = 0
for batch in Collector(env, None, frames_per_batch=400, total_frames=2000):
    frames += batch.numel()
    print("cost", batch["next", "cost"].sum().item(), "of", batch.numel(), "steps")
assert frames >= 2000
vec = hasard_rs.make_vec("hasard/RemedyRushLevel1-v0", 4, resolution="64x48", autoreset_mode="Disabled")
check_env_specs(GymWrapper(vec))
