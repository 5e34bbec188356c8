"""Stable-Baselines3's own checker, wrappers and evaluation on its batch of worlds; warnings are errors."""

import tempfile
import warnings
from pathlib import Path

import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.vec_env import VecCheckNan, VecFrameStack, VecMonitor, VecNormalize, VecVideoRecorder

import hasard_rs
from hasard_rs.sb3 import make_vec_env

ENV = "hasard/RemedyRushLevel1-v0"
SMALL = {"resolution": "64x48", "max_episode_steps": 12}


def rolled(envs, steps=30):
    """Random steps of a batch; gives the infos of the episodes that ended."""
    observations = envs.reset()
    assert observations.shape == (envs.num_envs, *envs.observation_space.shape)
    ended = []
    for _ in range(steps):
        observations, rewards, dones, infos = envs.step(np.array([envs.action_space.sample() for _ in range(envs.num_envs)]))
        assert observations.shape == (envs.num_envs, *envs.observation_space.shape) and all("cost" in info for info in infos)
        ended += [info for info, done in zip(infos, dones, strict=True) if done]
    assert ended and all(info["TimeLimit.truncated"] and info["terminal_observation"].shape == envs.observation_space.shape for info in ended)
    return ended


def main():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for action_format in ("multi_discrete", "discrete", "box"):
            for observation in ("rgb", "grey"):
                check_env(hasard_rs.make(ENV, action_format=action_format, observation=observation, resolution="64x48").unwrapped)
        print("check_env: three formats, two observations")
    assert all("episode" in info for info in rolled(VecMonitor(make_vec_env(ENV, 3, seed=1, **SMALL))))
    stacked = VecFrameStack(make_vec_env(ENV, 3, seed=1, **SMALL), 4)
    assert stacked.observation_space.shape == (12, 48, 64)
    rolled(stacked)
    rolled(VecNormalize(make_vec_env(ENV, 3, seed=1, **SMALL), norm_obs=False))
    rolled(VecCheckNan(make_vec_env(ENV, 3, seed=1, **SMALL), raise_exception=True))
    print("VecMonitor, VecFrameStack, VecNormalize, VecCheckNan")
    with tempfile.TemporaryDirectory() as folder:
        filmed = VecVideoRecorder(
            make_vec_env(ENV, 2, seed=1, render_mode="rgb_array", **SMALL), folder, lambda step: step == 0, video_length=10
        )
        rolled(filmed, 14)
        filmed.close()
        assert list(Path(folder).glob("*.mp4"))
    print("VecVideoRecorder")
    envs = VecMonitor(make_vec_env(ENV, 4, seed=1, **SMALL))
    mean, spread = evaluate_policy(PPO("CnnPolicy", envs, n_steps=8, batch_size=8), envs, n_eval_episodes=6)
    print(f"evaluate_policy: return {mean:.2f}, spread {spread:.2f}")


if __name__ == "__main__":
    main()
