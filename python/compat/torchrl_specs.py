"""TorchRL's own checks of environments: its wrapper over the native vector environment in both modes that it takes, and our EnvBase."""

import hasard_rs
from hasard_rs.torchrl import HasardEnv
from torchrl.collectors import Collector
from torchrl.envs import GymWrapper
from torchrl.envs.utils import check_env_specs

ENV = "hasard/RemedyRushLevel1-v0"
SMALL = {"resolution": "64x48", "max_episode_steps": 5}

for mode in ("Disabled", "SameStep"):
    for how in ("both", True, False):
        check_env_specs(GymWrapper(hasard_rs.make_vec(ENV, 4, autoreset_mode=mode, **SMALL)), break_when_any_done=how)
    print(f"check_env_specs of GymWrapper, {mode}, break_when_any_done both, True and False")
for arguments in ({}, {"observation": "grey", "frame_stack": 4, "layout": "chw"}):
    for how in ("both", True, False):
        check_env_specs(HasardEnv(ENV, 4, **SMALL, **arguments), break_when_any_done=how)
print("check_env_specs of HasardEnv: rgb, and stacked grey frames, channels first")
frames = sum(batch.numel() for batch in Collector(GymWrapper(hasard_rs.make_vec(ENV, 4, autoreset_mode="Disabled", **SMALL)), None, frames_per_batch=200, total_frames=1000))
assert frames == 1000
print("Collector over GymWrapper:", frames, "frames")
