"""OmniSafe: the 18 environments as a `CMDP` of flat pixels and `Box` actions, which is all that it takes."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from gymnasium import spaces

from hasard_rs._extra import need

torch = need("torch", "omnisafe", "omnisafe")
need("omnisafe", "omnisafe", "omnisafe")

from omnisafe.envs.core import CMDP, env_register  # noqa: E402

import hasard_rs  # noqa: E402
from hasard_rs.arguments import over  # noqa: E402


@env_register
class HasardEnv(CMDP):
    """A batch of worlds as OmniSafe steps them: tensors float32 of `device`, SAME_STEP; with one environment without the first axis.

    Observations are pixels / 255 in a row, in [0, 1] (64x48 grey unless asked otherwise); actions are `box`.

    Args:
        env_id: a bare id, such as `RemedyRushLevel1-v0`.
        num_envs: lanes.
        device: of the tensors.
        arguments: see `help(hasard_rs.VectorEnv)`; OmniSafe hands on `env_cfgs`. Of those that its Evaluator gives, width and height are the
            size of pictures, and camera_id and camera_name have no effect.

    Raises:
        What `hasard_rs.make_vec` raises.
    """

    _support_envs: ClassVar[list[str]] = [env_id.removeprefix("hasard/") for env_id in hasard_rs.ids()]
    need_auto_reset_wrapper = False
    need_time_limit_wrapper = False
    need_evaluation = False

    def __init__(self, env_id: str, num_envs: int = 1, device: Any = "cpu", **arguments: Any) -> None:
        super().__init__(env_id)
        self._device = torch.device(device)
        width, height, *_ = (arguments.pop(name, None) for name in ("width", "height", "camera_id", "camera_name"))
        if arguments.get("render_mode") and width and height:
            arguments.setdefault("render_resolution", (width, height))
        given = over({"resolution": "64x48", "observation": "grey"}, arguments)
        self.envs = hasard_rs.make_vec(env_id, num_envs, autoreset_mode="SameStep", action_format="box", **given)
        self.envs._given.without("hasard_rs.omnisafe", "infos", "env_stats")
        self._num_envs = num_envs
        pixels = int(np.prod(self.envs.worlds.observation_shape))
        self._observation_space = spaces.Box(0.0, 1.0, (pixels,), np.float32)
        self._action_space = self.envs.single_action_space
        self._metadata = dict(self.envs.metadata)
        self._seed: int | None = None

    @property
    def max_episode_steps(self) -> int:
        """Steps of an episode that only time ends."""
        return self.envs.max_episode_steps

    def _flat(self, observations: np.ndarray) -> Any:
        flat = torch.from_numpy(observations).to(self._device).reshape(len(observations), -1).float() / 255.0
        return flat if self._num_envs > 1 else flat[0]

    def _row(self, values: np.ndarray) -> Any:
        row = torch.as_tensor(values, dtype=torch.float32, device=self._device)
        return row if self._num_envs > 1 else row[0]

    def set_seed(self, seed: int) -> None:
        """Keeps the `seed` of the next reset."""
        self._seed = seed

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Starts episodes; seed and options as for `VectorEnv.reset`. Returns observations float32 [num_envs, pixels] and an empty info."""
        seed, self._seed = self._seed if seed is None else seed, None
        observations, _ = self.envs.reset(seed=seed, options=options)
        return self._flat(observations), {}

    def step(self, action: Any) -> tuple[Any, Any, Any, Any, Any, dict[str, Any]]:
        """Steps every lane.

        Args:
            action: float32 [num_envs, parts] in [-1, 1].

        Returns:
            (observations, rewards, costs, terminated, truncated, info), float32; where episodes ended, `info` has "final_observation" and
            "_final_observation".

        Raises:
            InvalidAction for NaN, ValueError for another shape.
        """
        actions = action.detach().cpu().numpy().reshape(self._num_envs, -1)
        observations, rewards, terminated, truncated, infos = self.envs.step(actions)
        info: dict[str, Any] = {}
        if "final_obs" in infos:
            last = observations.copy()
            for lane in np.flatnonzero(infos["_final_obs"]):
                last[lane] = infos["final_obs"][lane]
            info = {"final_observation": self._flat(last), "_final_observation": infos["_final_obs"]}
        ends = (self._row(terminated), self._row(truncated))
        return self._flat(observations), self._row(rewards), self._row(infos["cost"]), *ends, info

    def sample_action(self) -> Any:
        """Returns a random action."""
        return torch.as_tensor(self._action_space.sample(), dtype=torch.float32, device=self._device)

    def render(self) -> Any:
        """Returns a picture uint8 [height, width, 3], of several environments one each; None without a render mode."""
        pictures = self.envs.render()
        return pictures[0] if pictures and self._num_envs == 1 else pictures

    def close(self) -> None:
        """Lets the worlds go."""
        self.envs.close()
