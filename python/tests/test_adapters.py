"""Adapters beside stand-ins of their libraries, which do what the libraries' own classes do with what an adapter gives them.

Each stand-in says which code of the library it stands for.
"""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hasard_rs
from hasard_rs import _core

ENV = "hasard/RemedyRushLevel1-v0"
GARDEN: dict[str, Any] = {
    "scenario": {"name": "AdapterGarden", "tics": 70, "budget": 3, "actions": [["TURN_LEFT", "TURN_RIGHT"], ["MOVE_FORWARD"]]},
    "map": {"ascii": "######\n#....#\n#.@..#\n######"},
    "when": [{"event": "timer", "every": 35, "reward": 1.0}],
}


def adapter(monkeypatch: pytest.MonkeyPatch, name: str, **libraries: dict[str, Any]) -> Any:
    """An adapter's module beside these stand-ins: modules by name, with what they hold."""
    for library, content in libraries.items():
        module = types.ModuleType(library.replace("__", "."))
        module.__dict__.update(content)
        monkeypatch.setitem(sys.modules, module.__name__, module)
    for loaded in (f"hasard_rs.{name}", "hasard_rs.ray_training"):
        monkeypatch.delitem(sys.modules, loaded, raising=False)
    module = importlib.import_module(f"hasard_rs.{name}")
    # Nobody else gets it.
    for loaded in (name, "ray_training"):
        sys.modules.pop(f"hasard_rs.{loaded}", None)
        hasard_rs.__dict__.pop(loaded, None)
    return module


# Torch's names for what NumPy does too.
TORCH = {"from_numpy": lambda array: array, "is_tensor": lambda value: False, "zeros": lambda count: np.zeros(count, np.float32)}


def sample_factory(monkeypatch: pytest.MonkeyPatch) -> Any:
    return adapter(monkeypatch, "sample_factory", sample_factory={}, torch=TORCH)


def settings(**given: Any) -> Any:
    """Sample-Factory's defaults (cfg/cfg.py), and the adapter's own of a parser."""
    usual = {"env_frameskip": 1, "env_framestack": 1, "batched_sampling": True, "num_envs_per_worker": 2, "worker_num_splits": 2}
    return types.SimpleNamespace(**{**usual, "env_agents": 3, "res_w": 64, "res_h": 48, **given})


def test_sample_factory_has_the_benchmarks_frame_skip(monkeypatch: pytest.MonkeyPatch) -> None:
    module = sample_factory(monkeypatch)
    parser = argparse.ArgumentParser()
    parser.add_argument("--env_frameskip", default=1, type=int)
    module.add_arguments(parser)
    assert parser.parse_args([]).env_frameskip == 4
    assert module.make("remedy_rush", settings(env_frameskip=4)).worlds.episode_steps == 525
    for wrong in ({"batched_sampling": False}, {"num_envs_per_worker": 4}):
        with pytest.raises(hasard_rs.InvalidOption):
            module.make("remedy_rush", settings(**wrong))


def test_sample_factory_hears_of_costs_and_no_two_lanes_play_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of infos its batched sampler takes tensors of all agents, in the lanes that are over (`_process_env_step`)."""
    module = sample_factory(monkeypatch)
    first, second = (module.make("remedy_rush", settings(env_frameskip=35)) for _ in range(2))
    first.reset(seed=0)
    second.reset(seed=1)
    assert not set(first.worlds.episode_seeds) & set(second.worlds.episode_seeds)
    for _ in range(60):
        obs, rewards, terminated, truncated, infos = first.step(np.zeros((3, len(first.worlds.nvec)), np.int32))
        finished = terminated | truncated
        assert isinstance(infos, dict) and bool(infos) == bool(finished.any())
    assert finished.all()
    assert all(value.shape == (3,) and value.dtype == np.float32 for value in infos.values())
    assert {"cost", "length"} <= set(infos) and "seed" not in infos


def test_sample_factory_acts_by_parts_with_full_actions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its `preprocess_actions` gives a list for actions that are not all discrete: [n] of each discrete part, [n, 1] of each number."""
    env = sample_factory(monkeypatch).make("remedy_rush", settings(all_actions=True))
    env.reset(seed=0)
    parts = [np.zeros(3, np.int32) for _ in env.worlds.nvec] + [np.full((3, 1), 0.5, np.float32) for _ in range(env.worlds.num_deltas)]
    other = sample_factory(monkeypatch).make("remedy_rush", settings(all_actions=True))
    other.reset(seed=0)
    env.step(parts)
    rows = np.zeros((3, len(parts)), np.float32)
    rows[:, len(env.worlds.nvec) :] = 0.5
    other.step(rows)
    assert [env.worlds.state_hash(lane) for lane in range(3)] == [other.worlds.state_hash(lane) for lane in range(3)]


class PufferEnv:
    """As PufferLib's: buffers of its own unless it is given some (`set_buffers`)."""

    def __init__(self, buf: Any = None) -> None:
        space, n = self.single_observation_space, self.num_agents
        self.observations = np.zeros((n, *space.shape), space.dtype)
        self.rewards = np.zeros(n, np.float32)
        self.terminals, self.truncations = np.zeros(n, bool), np.zeros(n, bool)


def test_pufferlibs_neighbours_play_other_episodes_and_resets_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its Serial backend resets environment i with seed + i."""
    module = adapter(monkeypatch, "pufferlib", pufferlib={"PufferEnv": PufferEnv})
    envs = [module.HasardPuffer(ENV, 4, resolution="64x48") for _ in range(2)]
    for number, env in enumerate(envs):
        env.reset(7 + number)
    assert len({seed for env in envs for seed in env.worlds.episode_seeds}) == 8
    alone = module.HasardPuffer(ENV, 2, resolution="64x48", seed=3)
    seeds = [tuple(alone.reset() and alone.worlds.episode_seeds) for _ in range(3)]
    assert len(set(seeds)) == 3
    again = module.HasardPuffer(ENV, 2, resolution="64x48", seed=3)
    again.reset()
    assert tuple(again.worlds.episode_seeds) == seeds[0]
    own = hasard_rs.Scenario.from_dict(GARDEN)
    assert module.HasardPuffer(own.ids[0], 2, resolution="64x48").reset(1)[0].shape == (2, 3, 48, 64)
    with pytest.raises(TypeError, match="'autoreset_mode' is not to be chosen here"):
        module.HasardPuffer(ENV, 2, autoreset_mode="SameStep")


def test_rollouts_of_ray_keep_last_observations_and_deltas(monkeypatch: pytest.MonkeyPatch) -> None:
    ray = {"remote": lambda *given, **options: given[0] if given else lambda made: made}
    module = adapter(monkeypatch, "ray", ray=ray)
    sampler = module.Sampler(ENV, 3, resolution="64x48", frame_skip=35, full_actions=True)
    rollout = sampler.sample(61)
    assert rollout["deltas"].shape == (61, 3, 2) and np.abs(rollout["deltas"]).max() > 0.5
    ends = list(zip(rollout["final_steps"].tolist(), rollout["final_lanes"].tolist(), strict=True))
    assert ends == [tuple(at) for at in np.argwhere(rollout["terminated"] | rollout["truncated"]).tolist()] and len(ends) >= 3
    assert rollout["final_observations"].shape == (len(ends), 48, 64, 3)
    for (step, lane), last in zip(ends, rollout["final_observations"], strict=True):
        assert not np.array_equal(last, rollout["observations"][step + 1, lane]), "that is the next episode's first"
    sampler.set_policy(lambda observations: np.zeros((3, len(sampler.worlds.nvec)), np.int64), 1)
    with pytest.raises(TypeError, match="a pair"):
        sampler.sample(1)
    plain = module.Sampler(ENV, 2, resolution="64x48").sample(2)
    assert "deltas" not in plain and plain["final_observations"].shape == (0, 48, 64, 3)


class Sb3VecEnv:
    """As Stable-Baselines3's `VecEnv`: seeds are kept for the next reset, indices are lanes or all."""

    def __init__(self, num_envs: int, observation_space: Any, action_space: Any) -> None:
        self.num_envs, self.observation_space, self.action_space = num_envs, observation_space, action_space
        self._reset_seeds()

    def _reset_seeds(self) -> None:
        self._seeds: list[int | None] = [None] * self.num_envs

    def _reset_options(self) -> None:
        self._options = [{}] * self.num_envs

    def _get_indices(self, indices: Any) -> Any:
        return range(self.num_envs) if indices is None else [indices] if isinstance(indices, int) else indices


def sb3(monkeypatch: pytest.MonkeyPatch) -> Any:
    names = ("stable_baselines3", "stable_baselines3__common")
    return adapter(monkeypatch, "sb3", **{name: {} for name in names}, stable_baselines3__common__vec_env={"VecEnv": Sb3VecEnv})


@pytest.mark.parametrize("arguments", [{}, {"full_actions": True}, {"action_format": "discrete"}, {"action_format": "discrete", "full_actions": True}])
def test_masks_are_of_the_action_space(monkeypatch: pytest.MonkeyPatch, arguments: dict[str, Any]) -> None:
    """sb3-contrib stacks `env_method("action_masks")` and reshapes it to (lanes, choices of the space)."""
    env = sb3(monkeypatch).VecEnv([ENV, "hasard/VolcanicVentureLevel1-v0"], 4, resolution="64x48", **arguments)
    masks = np.stack(env.env_method("action_masks"))
    choices = env.action_space.n if arguments.get("action_format") else int(env.action_space.nvec.sum())
    assert masks.shape == (4, choices) and masks.dtype == np.bool_
    assert np.array_equal(env.get_attr("action_masks", [1])[0], masks[1])
    if arguments.get("action_format") and not arguments.get("full_actions"):
        # A number is allowed where each of its parts is.
        nvec, parts = env.envs.worlds.nvec, env.envs.action_masks
        for lane in range(4):
            rows = np.split(parts[lane], np.cumsum(nvec)[:-1])
            expected = [all(row[part] for row, part in zip(rows, np.unravel_index(k, nvec), strict=True)) for k in range(choices)]
            assert masks[lane].tolist() == expected


def test_what_is_of_all_lanes_is_not_called_once_a_lane(monkeypatch: pytest.MonkeyPatch) -> None:
    module = sb3(monkeypatch)
    env = module.VecEnv([ENV, "hasard/VolcanicVentureLevel1-v0"], 4, resolution="64x48")
    env.reset()
    seeds = env.env_method("episode_seed")
    for name in ("reset", "step", "close", "send"):
        with pytest.raises(AttributeError, match=f"'{name}' is of all lanes at once"):
            env.env_method(name)
    assert env.env_method("episode_seed") == seeds == env.get_attr("episode_seed")
    assert env.get_attr("safety_budget") == [5.0, 50.0, 5.0, 50.0]
    assert env.get_attr("scenario_name", [1, 2]) == ["VolcanicVenture", "RemedyRush"]
    assert len(env.get_attr("position")) == 4
    for wrong in ({"copy": False}, {"batch_size": 2}):
        with pytest.raises(hasard_rs.InvalidOption, match=next(iter(wrong))):
            module.VecEnv(ENV, 4, **wrong)


def test_tianshou_takes_own_tasks_and_arrays_alone() -> None:
    from hasard_rs.tianshou import HasardVectorEnv

    own = hasard_rs.Scenario.from_dict(GARDEN)
    env = HasardVectorEnv(own.ids[0], 2, resolution="64x48")
    assert env.seed(np.int64(3)) == [3, 4] == env.seed([3, 4])
    assert env.reset()[0].shape == (2, 3, 48, 64)
    for wrong in ("tuple", "dict"):
        with pytest.raises(hasard_rs.InvalidOption, match="one array"):
            HasardVectorEnv(ENV, 4, action_format=wrong)


def test_rows_are_no_tuple_of_parts() -> None:
    vec = hasard_rs.make_vec(ENV, 4, action_format="tuple", resolution="64x48")
    vec.reset(seed=1)
    assert len(vec.worlds.nvec) == 4
    with pytest.raises(TypeError, match="a tuple of 4 parts"):
        vec.step(np.zeros((4, 4), np.int64))
    vec.step(tuple(np.zeros(4, np.int64) for _ in range(4)))


def test_the_published_names_forget_the_last_episode() -> None:
    published = importlib.import_module("hasard_rs.published")
    for env_stats in (True, False):
        env = published.make("RemedyRushLevel1-v0", env_stats=env_stats, resolution="160x120").unwrapped
        _, info = env.reset(seed=1)
        assert ("env_stats" in info) == env_stats
        fresh = dict(env.get_statistics())
        for _ in range(30):
            info = env.step(env.action_space.sample())[4]
        assert ("env_stats" in info) == env_stats and set(env.get_statistics()) == set(fresh)
        env.reset()
        assert env.get_statistics() == fresh and env.calculate_cost() == 0.0


def test_a_checkpoint_is_the_one_that_the_agent_acts_by(tmp_path: Path) -> None:
    """`hasard_rs.torch.load` asks for it: the selected one, and never a half-written one."""
    small = {"envs": 4, "threads": 1, "size": "64x48", "quiet": True}
    small |= {"set": {"network.dense": [32], "network.recurrent": 32, "sampling.rollout": 8, "evaluation.episodes": 1, "evaluation.confirming_episodes": 2}}
    run = hasard_rs.train(ENV, frames=3000, eval_every=1000, seed=1, out=tmp_path / "run", **small).directory
    assert _core.checkpoint_of(tmp_path, False) is None
    newest = sorted((run / "checkpoints").glob("frames_*"))[-1]
    (run / "checkpoints/frames_999999999999.partial").mkdir()
    assert Path(_core.checkpoint_of(run, False)) == newest
    frames = json.loads((run / "selected.json").read_text())["frames"]
    assert Path(_core.checkpoint_of(run, True)).name == f"best_{frames:012}"


def test_settings_that_cannot_be_are_named() -> None:
    for wrong, words in (({"batch_size": 1.5}, "batch_size cannot be 1.5"), ({"batch_size": "2"}, "batch_size"), ({"env_stats": "no"}, "env_stats")):
        with pytest.raises(hasard_rs.InvalidOption, match=words):
            hasard_rs.make_vec(ENV, 4, resolution="64x48", **wrong)
    with pytest.raises(hasard_rs.InvalidOption, match="saute_gamma"):
        hasard_rs.published.Saute(hasard_rs.make(ENV, resolution="64x48"), 0.0)


def test_six_values_know_their_budget() -> None:
    from hasard_rs.safety import SafetyEnv

    env = SafetyEnv(ENV, resolution="64x48")
    assert (env.safety_budget, env.max_episode_steps) == (5.0, 525)


def test_flags_of_clusters_are_heard_with_an_equals_sign(capsys: pytest.CaptureFixture[str]) -> None:
    from hasard_rs.cli import main

    assert main(["train", "RemedyRushLevel1", "--on=moon", "--workers=2"]) == 2
    assert "--on 'moon'" in capsys.readouterr().err
    assert main(["sweep", "main", "--on=moon"]) == 2
    assert "'moon'" in capsys.readouterr().err


def test_omnisafes_evaluator_makes_an_environment_and_films_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its `load_saved` gives these arguments, and its `render` appends what the environment's returns as a frame."""
    core = {"CMDP": type("CMDP", (), {"__init__": lambda self, env_id: None}), "env_register": lambda made: made}
    module = adapter(monkeypatch, "omnisafe", torch={"device": str}, omnisafe={}, omnisafe__envs={}, omnisafe__envs__core=core)
    camera = {"camera_id": None, "camera_name": None, "width": 256, "height": 256}
    env = module.HasardEnv("RemedyRushLevel1-v0", num_envs=1, render_mode="rgb_array", **camera)
    env.envs.reset(seed=1)
    assert env.render().shape == (256, 256, 3)
    two = module.HasardEnv("RemedyRushLevel1-v0", num_envs=2, render_mode="rgb_array", **camera)
    two.envs.reset(seed=1)
    assert [frame.shape for frame in two.render()] == [(256, 256, 3)] * 2
    with pytest.warns(UserWarning, match="render_mode"):
        assert module.HasardEnv("RemedyRushLevel1-v0", **camera).render() is None
