"""RLlib's PPO and IMPALA over the native vector environment, with the costs of its steps in their training batches.

    pip install '.[rllib]'
"""

import sys

import numpy as np
from ray.rllib.algorithms.impala import IMPALAConfig
from ray.rllib.algorithms.ppo import PPOConfig

from hasard_rs.rllib import costs, pixels

iterations = int(sys.argv[1]) if len(sys.argv) > 1 else 3
# IMPALA's runners sample while it learns, so it has two.
ways = {"PPO": (PPOConfig().training(minibatch_size=256, num_epochs=1), 1), "IMPALA": (IMPALAConfig(), 2)}
for config, runners in (ways[name] for name in sys.argv[2:] or ways):
    algorithm = (
        config.environment("hasard_rs:hasard/VolcanicVentureLevel1-v0", env_config={"resolution": "84x84", "frame_skip": 20})
        .env_runners(num_env_runners=runners, num_envs_per_env_runner=8, gym_env_vectorize_mode="vector_entry_point", env_to_module_connector=pixels)
        # With a whole core each, two runners and the learner wait for ever for a third one on a machine of two.
        .env_runners(num_cpus_per_env_runner=0.5)
        .training(train_batch_size_per_learner=1024, learner_connector=costs)
        .fault_tolerance(restart_failed_env_runners=False)
        .build_algo()
    )
    steps, episodes, returns = 0, 0, np.nan
    # An iteration of IMPALA ends by time, and may come before the first steps do.
    while steps < iterations * 1024 or not episodes:
        report = algorithm.train().get("env_runners", {})
        steps, episodes = report.get("num_env_steps_sampled_lifetime", steps), episodes + report.get("num_episodes", 0)
        returns = report.get("episode_return_mean", returns)
        print(type(algorithm).__name__, "steps", int(steps), "episodes", int(episodes), "return", returns, flush=True)
    assert np.isfinite(returns)
    algorithm.stop()
