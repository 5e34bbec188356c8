"""TorchRL: a batch of worlds as an `EnvBase`, costs among its outputs."""

from __future__ import annotations

from typing import Any

import numpy as np

from hasard_rs._extra import need

torch = need("torch", "torchrl", "torchrl")
need("torchrl", "torchrl", "torchrl")

from tensordict import TensorDict  # noqa: E402
from torchrl.data import Bounded, Categorical, Composite, MultiCategorical, Unbounded  # noqa: E402
from torchrl.envs import EnvBase  # noqa: E402

import hasard_rs  # noqa: E402
from hasard_rs import arguments as _arguments  # noqa: E402


class HasardEnv(EnvBase):
    """A batch of worlds: `pixels` uint8 [n, ...], `action` int64 [n, parts], `reward`, `cost` float32 [n, 1], `cost_terms` [n, k], done keys.

    Args:
        env_id: one of `hasard_rs.ids()`.
        num_envs: lanes, the batch size.
        num_threads: worker threads beside the caller's.
        device: of the tensors.
        arguments: those of `help(hasard_rs.Env)`; layout is "chw" unless given.

    Raises:
        InvalidOption for full_actions, which have continuous parts: use GymWrapper for them.
    """

    def __init__(self, env_id: str, num_envs: int = 1, *, num_threads: int | None = None, device: Any = "cpu", **arguments: Any) -> None:
        super().__init__(device=torch.device(device), batch_size=torch.Size([num_envs]))
        given = _arguments.read({"layout": "chw", **arguments, **hasard_rs._task(env_id, arguments)}, vector=True)
        given.without("hasard_rs.torchrl", "action_format", "delta_bins", "render_mode", "render_resolution", "infos", "env_stats")
        if given.world.get("full_actions"):
            raise hasard_rs.InvalidOption("full_actions have continuous parts; use GymWrapper over hasard_rs.make_vec for them")
        self.worlds = hasard_rs.Worlds(given.env_id, num_envs, num_threads=num_threads, autoreset_mode="Disabled", **given.world)
        shape, terms, n = self.worlds.observation_shape, len(self.worlds.cost_terms), num_envs
        self.observation_spec = Composite(
            pixels=Bounded(0, 255, shape=(n, *shape), dtype=torch.uint8, device=self.device),
            cost=Unbounded(shape=(n, 1), dtype=torch.float32, device=self.device),
            cost_terms=Unbounded(shape=(n, terms), dtype=torch.float32, device=self.device),
            shape=(n,),
        )
        self.action_spec = MultiCategorical(list(self.worlds.nvec), shape=(n, len(self.worlds.nvec)), device=self.device)
        self.reward_spec = Unbounded(shape=(n, 1), dtype=torch.float32, device=self.device)
        flag = Categorical(2, shape=(n, 1), dtype=torch.bool, device=self.device)
        self.done_spec = Composite(done=flag, terminated=flag.clone(), truncated=flag.clone(), shape=(n,))
        self._seed: int | None = given.seed

    def _as_tensors(self, batch: Any) -> dict[str, Any]:
        terminated = torch.from_numpy(batch.terminated)[:, None]
        truncated = torch.from_numpy(batch.truncated)[:, None]
        return {
            "pixels": torch.from_numpy(batch.observations),
            "cost": torch.from_numpy(batch.costs)[:, None],
            "cost_terms": torch.from_numpy(batch.cost_terms),
            "done": terminated | truncated,
            "terminated": terminated,
            "truncated": truncated,
        }

    def _reset(self, tensordict: Any = None, **kwargs: Any) -> Any:
        mask = None
        if tensordict is not None and "_reset" in tensordict.keys():
            mask = tensordict["_reset"].reshape(-1).cpu().numpy().astype(np.bool_)
        seed, self._seed = self._seed, None
        batch = self.worlds.reset(seed, None if mask is None or mask.all() else mask)
        return TensorDict(self._as_tensors(batch), batch_size=self.batch_size, device=self.device)

    def _step(self, tensordict: Any) -> Any:
        batch = self.worlds.step(tensordict["action"].cpu().numpy())
        tensors = {**self._as_tensors(batch), "reward": torch.from_numpy(batch.rewards)[:, None]}
        return TensorDict(tensors, batch_size=self.batch_size, device=self.device)

    def _set_seed(self, seed: int | None) -> None:
        self._seed = seed

    def close(self, **kwargs: Any) -> None:
        """Lets the worlds go; kwargs are TorchRL's."""
        self.worlds.close()
        super().close(**kwargs)
