"""RLlib's new API stack: worlds by the vector entry point, connectors for pixels and costs, and a creator for `tune.register_env`.

    config = (
        PPOConfig()
        .environment("hasard_rs:hasard/RemedyRushLevel1-v0", env_config={"resolution": "84x84"})
        .env_runners(gym_env_vectorize_mode="vector_entry_point", env_to_module_connector=hasard_rs.rllib.pixels)
        .training(learner_connector=hasard_rs.rllib.costs)
    )
"""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces

from hasard_rs._extra import need

need("ray.rllib", "rllib", "rllib")

from ray.rllib.connectors.connector_v2 import ConnectorV2  # noqa: E402
from ray.rllib.connectors.env_to_module.observation_preprocessor import SingleAgentObservationPreprocessor  # noqa: E402

import hasard_rs  # noqa: E402


class PixelConnector(SingleAgentObservationPreprocessor):
    """Bytes of pixels as float32 in [0, 1], in the episodes too: RLlib's networks take no bytes. `config.env_runners(env_to_module_connector=pixels)`
    puts it in front."""

    def recompute_output_observation_space(self, input_observation_space: Any, input_action_space: Any) -> Any:
        """The space of what comes out. Args: input_observation_space, input_action_space: of what comes in. Returns a `Box(0, 1)`, float32."""
        return spaces.Box(0.0, 1.0, input_observation_space.shape, np.float32)

    def preprocess(self, observation: Any, episode: Any) -> Any:
        """Turns one observation over. Args: observation: uint8; episode: not looked at. Returns float32 of the same shape."""
        return observation.astype(np.float32) / 255.0 if observation.dtype == np.uint8 else observation


class CostConnector(ConnectorV2):
    """A column "cost" in the training batch, float32: of each step, from its info; for losses that constrain it.
    `config.training(learner_connector=costs)` puts it in front."""

    def __call__(self, *, rl_module: Any, batch: Any, episodes: Any, explore: Any = None, shared_data: Any = None, **kwargs: Any) -> Any:
        """Adds the column.

        Args:
            batch: to which it is added.
            episodes: whose infos have the costs.
            rl_module, explore, shared_data, kwargs: RLlib's, not looked at.

        Returns:
            The batch.
        """
        for episode in self.single_agent_episode_iterator(episodes, agents_that_stepped_only=False):
            # The first info is the reset's. The step that PPO and IMPALA append for an episode's last value repeats an info; `loss_mask` leaves it out.
            costs = [np.float32(info.get("cost", 0.0)) for info in episode.get_infos(slice(1, len(episode) + 1))]
            self.add_n_batch_items(batch, "cost", items_to_add=costs, num_items=len(episode), single_agent_episode=episode)
        return batch


def pixels(*given: Any) -> PixelConnector:
    """Returns a `PixelConnector`, as `env_to_module_connector` of a configuration; RLlib's arguments are `given` and not looked at."""
    return PixelConnector()


def costs(*given: Any) -> CostConnector:
    """Returns a `CostConnector`, as `learner_connector` of a configuration; RLlib's arguments are `given` and not looked at."""
    return CostConnector()


def creator(context: Any) -> Any:
    """An environment for RLlib.

    Args:
        context: RLlib's `EnvContext`, a dict of `env_id` and arguments of `help(hasard_rs.Env)`.

    Returns:
        A single environment; where `num_envs` is among them, a vector environment in NEXT_STEP mode, the only one that RLlib steps.

    Raises:
        What `hasard_rs.make` raises.
    """
    given = dict(context)
    env_id = given.pop("env_id")
    num_envs = given.pop("num_envs", None)
    if num_envs is None:
        return hasard_rs.make(env_id, **given)
    return hasard_rs.make_vec(env_id, num_envs, autoreset_mode="NextStep", **given)


def register(name: str = "hasard") -> None:
    """Registers the creator with Tune under `name`, so that `config.environment(name, env_config={"env_id": ...})` finds it."""
    from ray.tune import register_env

    register_env(name, creator)
