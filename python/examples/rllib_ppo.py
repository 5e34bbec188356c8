"""RLlib's PPO and IMPALA over the native vector environment."""

import sys

import numpy as np
from ray.rllib.algorithms.impala import IMPALAConfig
from ray.rllib.algorithms.ppo import PPOConfig

iterations = int(sys.argv[1]) if len(sys.argv) > 1 else 3
for config in (PPOConfig().training(minibatch_size=256, num_epochs=1), IMPALAConfig()):
    algorithm = (
        config.environment("hasard_rs:hasard/VolcanicVentureLevel1-v0", env_config={"resolution": "84x84", "frame_skip": 20})
        .env_runners(num_env_runners=1, num_envs_per_env_runner=8, gym_env_vectorize_mode="vector_entry_point")
        .training(train_batch_size_per_learner=1024)
        .build_algo()
    )
    for _ in range(iterations):
        result = algorithm.train()
    told = result["env_runners"]
    print(type(algorithm).__name__, "episodes", told.get("num_episodes"), "return", told.get("episode_return_mean"))
    assert np.isfinite(told.get("episode_return_mean", 0.0))
    algorithm.stop()
