"""Tianshou's collector, which steps and resets some of the lanes at a time.

    pip install '.[tianshou]'
"""

import numpy as np
from tianshou.data import Collector, VectorReplayBuffer

from hasard_rs.tianshou import HasardVectorEnv

envs = HasardVectorEnv("hasard/RemedyRushLevel1-v0", 8, resolution="64x48", max_episode_steps=100)
try:
    from tianshou.algorithm.random import MARLRandomDiscreteMaskedOffPolicyAlgorithm as Random

    policy = Random(action_space=envs.action_space[0]).policy
except ImportError:
    from tianshou.policy import RandomPolicy

    policy = RandomPolicy(action_space=envs.action_space[0])
collected = Collector(policy, envs, VectorReplayBuffer(2000, 8)).collect(n_episode=20, random=True, reset_before_collect=True)
print(collected.n_collected_episodes, "episodes, returns", np.round(collected.returns, 1))
assert collected.n_collected_episodes >= 20
