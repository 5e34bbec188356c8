"""RLlib's new API stack: worlds by the vector entry point, and a creator for `tune.register_env`."""

from __future__ import annotations

from typing import Any

from hasard_rs._extra import need

need("ray.rllib", "rllib", "rllib")

import hasard_rs  # noqa: E402


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
