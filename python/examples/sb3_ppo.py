"""Stable-Baselines3's PPO, and sb3-contrib's RecurrentPPO, on a native batch of worlds.

    pip install '.[sb3]'
"""

import sys

from sb3_contrib import RecurrentPPO
from stable_baselines3 import PPO

from hasard_rs.sb3 import make_vec_env

steps = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
env = make_vec_env("hasard/RemedyRushLevel1-v0", 16, seed=1, resolution="64x64")
PPO("CnnPolicy", env, n_steps=64, batch_size=256, n_epochs=1, verbose=1).learn(steps)
env = make_vec_env("hasard/RemedyRushLevel1-v0", 8, seed=1, resolution="64x64")
RecurrentPPO("CnnLstmPolicy", env, n_steps=32, batch_size=128, n_epochs=1, verbose=1).learn(steps // 2)
