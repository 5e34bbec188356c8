"""Sample-Factory 2: the published package's environment names and settings, as one batched multi-agent environment.

    python -m hasard_rs.sample_factory --env=remedy_rush --level=1 --batched_sampling=True --env_agents=16

Lanes of one batch take the place of Sample-Factory's own environments: `--num_envs_per_worker` is `--worker_num_splits`, one a split.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from hasard_rs._extra import need

need("sample_factory", "sample-factory", "sample_factory")

import gymnasium  # noqa: E402
import torch  # noqa: E402

import hasard_rs  # noqa: E402
from hasard_rs.errors import InvalidOption  # noqa: E402
from hasard_rs.infos import summary  # noqa: E402
from hasard_rs.registry import Scenario  # noqa: E402
from hasard_rs.spaces import action_format  # noqa: E402

NAMES = {scenario.name.lower(): scenario.value for scenario in Scenario}


class HasardBatch(gymnasium.Env):  # type: ignore[type-arg]
    """`num_agents` worlds as Sample-Factory's batched samplers step them: tensors in and out, SAME_STEP.

    Args:
        env_id: one of `hasard_rs.ids()`.
        num_agents: lanes.
        render_mode: kept for Sample-Factory; `render` gives an RGB picture.
        arguments: those of `hasard_rs.Worlds`; observations are channels first.
    """

    is_multiagent = True

    def __init__(self, env_id: str, num_agents: int, *, render_mode: str | None = None, **arguments: Any) -> None:
        self.worlds = hasard_rs.Worlds(env_id, num_agents, layout="chw", **arguments)
        self._format = action_format("tuple", self.worlds.nvec, self.worlds.num_deltas, 11)
        self.num_agents, self.render_mode = num_agents, render_mode
        self.observation_space = gymnasium.spaces.Dict({"obs": gymnasium.spaces.Box(0, 255, self.worlds.observation_shape, np.uint8)})
        self.action_space = self._format.space

    def reset(self, *, seed: int | None = None, options: Any = None) -> Any:
        """Starts episodes; options are none. Returns {"obs": uint8 [n, c, h, w]} and no infos.

        An int seed s seeds lane i with s * num_agents + i: Sample-Factory's environments have the seeds 0, 1, 2, ..., and none plays another's
        episodes.
        """
        batch = self.worlds.reset(None if seed is None else seed * self.num_agents)
        return {"obs": torch.from_numpy(batch.observations)}, {}

    def step(self, actions: Any) -> Any:
        """Steps every lane.

        Args:
            actions: a tensor [n, parts]: choices, then deltas where there are any; or a list of arrays, one a part, as Sample-Factory gives
                actions that are not all discrete.

        Returns:
            ({"obs": uint8 [n, c, h, w]}, rewards float32 [n], terminated, truncated bool [n], infos), tensors. Where episodes ended infos has
            what they came to by name ("cost", each of its terms, statistics), float32 [n], 0 in the other lanes: Sample-Factory's summaries
            take the lanes that are over.

        Raises:
            InvalidAction; ValueError for another shape. Nothing has moved then.
        """
        if isinstance(actions, (list, tuple)):
            rows = np.column_stack([np.asarray(part.cpu() if torch.is_tensor(part) else part).reshape(self.num_agents, -1) for part in actions])
        else:
            rows = actions.cpu().numpy() if torch.is_tensor(actions) else np.asarray(actions)
        groups = len(self.worlds.nvec)
        deltas = rows[:, groups:].astype(np.float32) if self.worlds.num_deltas else None
        batch = self.worlds.step(rows[:, :groups].astype(np.int64), deltas)
        infos: dict[str, Any] = {}
        for episode in batch.episodes:
            for name, value in summary(episode).items():
                if name != "seed":
                    infos.setdefault(name, torch.zeros(self.num_agents))[episode["lane"]] = float(value)
        ends = torch.from_numpy(batch.terminated), torch.from_numpy(batch.truncated)
        return {"obs": torch.from_numpy(batch.observations)}, torch.from_numpy(batch.rewards), *ends, infos

    def render(self) -> Any:
        """Returns the first lane's picture, uint8 [120, 160, 3]."""
        return self.worlds.render(0)

    def close(self) -> None:
        """Lets the worlds go."""
        self.worlds.close()


def make(full_env_name: str, cfg: Any = None, env_config: Any = None, render_mode: str | None = None) -> HasardBatch:
    """An environment from Sample-Factory's settings, as its registry calls for one.

    Args:
        full_env_name: one of `NAMES`.
        cfg: the settings; of `add_arguments` and Sample-Factory's `env_frameskip`, `env_framestack`.
        env_config: ignored.
        render_mode: kept.

    Returns:
        A `HasardBatch`.

    Raises:
        InvalidOption for sampling that is not batched, or several environments a split, which could not report costs.
    """
    if not getattr(cfg, "batched_sampling", True):
        raise InvalidOption("the worlds are one batch: give --batched_sampling=True")
    if getattr(cfg, "num_envs_per_worker", 1) > getattr(cfg, "worker_num_splits", 1):
        raise InvalidOption("several environments a split report no costs: give --num_envs_per_worker as --worker_num_splits, and more --env_agents")
    arguments = {
        "hard_constraint": getattr(cfg, "constraint", "soft") == "hard",
        "resolution": (getattr(cfg, "res_w", 128), getattr(cfg, "res_h", 72)),
        "full_actions": bool(getattr(cfg, "all_actions", False)),
        "frame_skip": getattr(cfg, "env_frameskip", 4) or 4,
        "frame_stack": getattr(cfg, "env_framestack", 1) or 1,
    }
    env_id = f"{NAMES[full_env_name]}Level{getattr(cfg, 'level', 1)}-v0"
    return HasardBatch(env_id, getattr(cfg, "env_agents", 16), render_mode=render_mode, **arguments)


def register() -> None:
    """Registers the six names with Sample-Factory."""
    from sample_factory.envs.env_utils import register_env

    for name in NAMES:
        register_env(name, make)


def add_arguments(parser: Any) -> None:
    """Adds the published package's settings of an environment to an argparse `parser`."""
    parser.add_argument("--level", type=int, default=1, choices=[1, 2, 3])
    parser.add_argument("--constraint", default="soft", choices=["soft", "hard"])
    parser.add_argument("--res_w", type=int, default=128)
    parser.add_argument("--res_h", type=int, default=72)
    parser.add_argument("--all_actions", action="store_true")
    parser.add_argument("--env_agents", type=int, default=16, help="worlds of one batched environment")
    # Sample-Factory's own default of 1 would be another task.
    parser.set_defaults(env_frameskip=4)


def main() -> int:
    """Trains by Sample-Factory's own loop, from the command line. Returns its exit code."""
    from sample_factory.cfg.arguments import parse_full_cfg, parse_sf_args
    from sample_factory.train import run_rl

    register()
    parser, _ = parse_sf_args()
    add_arguments(parser)
    return int(run_rl(parse_full_cfg(parser)))


if __name__ == "__main__":
    sys.exit(main())
