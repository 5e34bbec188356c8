"""Training from Python, trained agents, and the program in the wheel."""

from __future__ import annotations

import copy
import json
import multiprocessing
import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hasard_rs
from hasard_rs.agent import training_words

ENV = "hasard/RemedyRushLevel1-v0"
# Far longer than any test waits, and reported often: what ends these runs is their callback.
SMALL = {"frames": 4_096_000, "envs": 4, "threads": 1, "size": "64x48", "preset": "quick", "seed": 3, "set": {"reporting.report_seconds": 0.2}}


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> hasard_rs.Run:
    reports: list[dict] = []

    def callback(report: dict) -> bool:
        reports.append(report)
        return len(reports) >= 2

    run = hasard_rs.train(ENV, "PPOLag", out=tmp_path_factory.mktemp("runs") / "one", callback=callback, **SMALL)
    assert run.stopped and len(reports) == 2 and reports[-1]["frames"] == run.last["frames"]
    return run


def test_a_run_directory_is_the_programs(run: hasard_rs.Run) -> None:
    config = json.loads((run.directory / "config.json").read_text())
    assert config["algorithm"] == "PPOLag" and config["env"]["size"] == [64, 48]
    done = subprocess.run(
        [sys.executable, "-m", "hasard_rs.cli", "eval", str(run.directory), "--episodes", "1", "--seed", "0", "--json"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    agent = hasard_rs.Agent.load(run.directory)
    assert agent.evaluate(1) == [json.loads(line) for line in done.stdout.splitlines()]


def test_what_is_loaded_is_what_plays(tmp_path: Path) -> None:
    run = hasard_rs.train(ENV, "PPOLag", out=tmp_path / "run", callback=lambda report: True, **SMALL)
    first = hasard_rs.Agent.load(run.directory)
    greedy = hasard_rs.Agent.load(run.directory, greedy=True)
    drawn, likeliest = first.evaluate(1, seed=4), greedy.evaluate(1, seed=4)
    assert drawn != likeliest, "the test distinguishes them"
    assert first.evaluate(1, seed=4, greedy=True) == likeliest and greedy.evaluate(1, seed=4, greedy=False) == drawn
    words = [sys.executable, "-m", "hasard_rs.cli", "eval", str(run.directory), "--episodes", "1", "--seed", "4", "--json", "--latest", "--greedy"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert [json.loads(line) for line in done.stdout.splitlines()] == likeliest
    # The run goes on: its newest checkpoint is another, and what was loaded still plays. Then the first becomes the best.
    checkpoints = run.directory / "checkpoints"
    (oldest,) = checkpoints.glob("frames_*")
    shutil.copytree(oldest, tmp_path / "first")
    reports: list[dict] = []
    hasard_rs.train(ENV, out=run.directory, resume=True, callback=lambda report: reports.append(report) or len(reports) > 2)
    newest = hasard_rs.Agent.load(run.directory).evaluate(1, seed=4)
    assert first.evaluate(1, seed=4) == drawn != newest
    shutil.copytree(tmp_path / "first", checkpoints / oldest.name.replace("frames_", "best_"))
    best = hasard_rs.Agent.load(run.directory, best=True)
    # The episode; the summary has the frames that the run had made by then.
    assert best.evaluate(1, seed=4)[0] == drawn[0] and best.evaluate(1, seed=4, best=False) == newest
    assert [episode["seed"] for episode in best.evaluate(2, seed=2**64 - 1)[:2]] == [2**64 - 1, 0]
    for wrong in ({"episodes": 0}, {"episodes": 2.5}, {"seed": -1}, {"seed": "x"}):
        with pytest.raises((ValueError, TypeError)):
            best.evaluate(**wrong)


def test_agents_and_what_they_remember_are_pickled(tmp_path: Path) -> None:
    zoo = Path(__file__).parents[2] / "zoo"
    shutil.copy(zoo / "RemedyRushLevel1.agent", tmp_path / "one.agent")
    agent = hasard_rs.Agent.load(os.path.relpath(tmp_path / "one.agent"), greedy=True)
    env = agent.make_vec(2)
    observations, _ = env.reset(seed=1)
    actions, state = agent.act(observations, agent.begin(2, seed=9))
    observations, _, terminations, truncations, infos = env.step(actions)
    state = agent.after(state, infos["cost"], terminations | truncations)
    # In a process that was begun elsewhere.
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        actions, after = pool.apply(agent.act, (observations, state))
    own, own_after = agent.act(observations, state)
    assert np.array_equal(actions, own) and pickle.dumps(after) == pickle.dumps(own_after) != pickle.dumps(state)
    assert copy.deepcopy(agent).evaluate(1) == agent.evaluate(1)
    with pytest.raises(ValueError, match="no agent's state"):
        hasard_rs._core.AgentState.of_bytes(b"x")


def test_agents_of_the_zoo_and_of_files_are_agents(monkeypatch: pytest.MonkeyPatch) -> None:
    zoo = Path(__file__).parents[2] / "zoo"
    monkeypatch.setenv("HASARD_ZOO", str(zoo))
    by_name = hasard_rs.Agent.load("zoo:RemedyRushLevel1")
    by_file = hasard_rs.Agent.load(zoo / "RemedyRushLevel1.agent")
    assert by_name.env_id == by_file.env_id == ENV and by_name.config == by_file.config
    observations, _ = by_name.make_vec(2).reset(seed=1)
    assert np.array_equal(by_name.act(observations)[0], by_file.act(observations)[0])
    words = [sys.executable, "-m", "hasard_rs.cli", "eval", "zoo:RemedyRushLevel1", "--episodes", "1", "--seed", "3", "--json"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert [json.loads(line) for line in done.stdout.splitlines()] == by_name.evaluate(1, seed=3)
    with pytest.raises(hasard_rs.InvalidOption, match="zoo:RemedyRushLevel1"):
        hasard_rs.Agent.load("zoo:Nobody")
    # Under other rules, and in another environment: as the program plays it.
    words = [sys.executable, "-m", "hasard_rs.cli", "eval", "zoo:RemedyRushLevel1", "--episodes", "2", "--seed", "3", "--rules", "tables", "--json"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert [json.loads(line) for line in done.stdout.splitlines()] == by_name.evaluate(2, seed=3, rules="tables") != by_name.evaluate(2, seed=3)
    words[3:5] = ["rollout", "RemedyRushLevel3-v0", "--policy", "zoo:RemedyRushLevel1"]
    done = subprocess.run(words, capture_output=True, text=True)
    played = by_name.evaluate(2, seed=3, rules="tables", env_id="hasard/RemedyRushLevel3-v0")
    assert [json.loads(line) for line in done.stdout.splitlines()][:2] == played[:2]
    assert played[2]["summary"]["safety_budget"] == hasard_rs.spec("RemedyRushLevel3-v0").safety_budget
    with pytest.raises(hasard_rs.InvalidOption, match="buttons are others"):
        by_name.evaluate(1, env_id="CollateralDamageLevel1-v0")
    with pytest.raises(hasard_rs.UnknownEnvironment, match="RemedyRushLevel3"):
        by_name.evaluate(1, env_id="RemedyRushLevel33-v0")
    with pytest.raises(hasard_rs.InvalidOption, match="paper or released or tables"):
        by_name.evaluate(1, rules="none")
    with pytest.raises(hasard_rs.InvalidOption, match="without a run directory"):
        by_name.report("nowhere")


def test_environments_of_agents_take_both_names(run: hasard_rs.Run) -> None:
    agent = hasard_rs.Agent.load(run.directory)
    assert agent.make(size=[72, 48], hard=True).observation_space.shape == (48, 72, 3)
    assert agent.make_vec(2, resolution="72x48").single_observation_space.shape == (48, 72, 3)
    env = agent.make()
    assert env.safety_budget == env.unwrapped.safety_budget == agent.config["constraints"][0]["budget"]
    assert env.cost_terms == env.unwrapped.cost_terms


def test_agents_of_own_tasks_know_them_in_another_process(tmp_path: Path) -> None:
    table = {
        "scenario": {"name": "AgentsGarden", "tics": 350, "budget": 3, "actions": [["MOVE_FORWARD"], ["JUMP"], ["USE"]]},
        "map": {"ascii": "######\n#....#\n#.@..#\n#....#\n######"},
        "spawn": [{"name": "vials", "kind": "HealthBonus", "count": 6}],
        "when": [{"event": "pickup", "of": "vials", "reward": 1.0, "cost": {"greed": 0.5}}],
    }
    (tmp_path / "garden.toml").write_text(hasard_rs.Scenario.from_dict(table).text)
    one, two = (
        hasard_rs.train(tasks, "PPO", out=tmp_path / out, callback=lambda report: True, **SMALL)
        for tasks, out in ((str(tmp_path / "garden.toml"), "one"), (f"{ENV.removeprefix('hasard/')},{tmp_path / 'garden.toml'}", "two"))
    )
    acts = """
import sys, hasard_rs
agent = hasard_rs.Agent.load(sys.argv[1])
envs = agent.make_vec(2)
observations, _ = envs.reset(seed=1)
envs.step(agent.act(observations)[0])
print(agent.make().unwrapped.scenario_name)
"""
    done = subprocess.run([sys.executable, "-c", acts, str(one.directory)], capture_output=True, text=True)
    assert done.stdout == "AgentsGarden\n", done.stderr
    done = subprocess.run([sys.executable, "-c", acts, str(two.directory)], capture_output=True, text=True)
    assert "InvalidOption" in done.stderr and "several tasks; make_vec" in done.stderr
    with pytest.raises(hasard_rs.InvalidOption, match="callback"):
        hasard_rs.train(ENV, out=tmp_path / "three", callback=3, **SMALL)
    assert not (tmp_path / "three").exists()


def test_a_report_takes_one_folder_or_several(run: hasard_rs.Run, tmp_path: Path) -> None:
    """A text was taken letter by letter, and a path not at all."""
    for runs in (run.directory, str(run.directory), [run.directory]):
        assert (hasard_rs.report(runs, tmp_path / "page") / "index.html").is_file()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"frames": 2e6}, ["--frames=2000000"]),
        ({"frames": np.int64(5)}, ["--frames=5"]),
        ({"seed": -1}, ["--seed=-1"]),
        ({"size": (64, 48)}, ["--size=64x48"]),
        ({"resolution": [64, 48]}, ["--size=64x48"]),
        ({"resolution": [64, 48], "size": "64x48"}, ["--size=64x48"]),
        ({"hard_constraint": True, "hard": True}, ["--hard"]),
        ({"hard_constraint": np.True_}, ["--hard"]),
        ({"hard_constraint": False}, []),
        ({"maps": None, "map": Path("a.wad")}, ["--maps=a.wad"]),
        ({"curriculum": [1, 2]}, ["--curriculum=1,2"]),
        ({"safety_budget": ["lava=3", "jumps=4"]}, ["--safety-budget=lava=3", "--safety-budget=jumps=4"]),
        ({"async_": True, "quiet": True}, ["--async"]),
        ({"set": {"learning.rate": np.float32(0.5), "network.residual": (32, 32)}}, ["--set=learning.rate=0.5", "--set=network.residual=[32, 32]"]),
    ],
)
def test_flags_are_the_programs(given: dict, words: list[str]) -> None:
    assert training_words(ENV, "PPO", **given) == [ENV.removeprefix("hasard/"), "--quiet", "--algo=PPO", *words]
    assert training_words(ENV, None, algo="PPO", resume=True) == [ENV.removeprefix("hasard/"), "--quiet", "--algo=PPO", "--resume"]
    assert training_words([Path("a.toml"), ENV], None) == ["a.toml," + ENV.removeprefix("hasard/"), "--quiet"]
    assert training_words(ENV, None, resume=True) == [ENV.removeprefix("hasard/"), "--quiet", "--resume"]


def test_a_setting_is_given_once() -> None:
    for wrong in ({"algo": "PPOLag"}, {"hard": True, "hard_constraint": False}, {"size": "64x48", "resolution": (72, 48)}, {"map": "a", "maps": "b"}):
        with pytest.raises(hasard_rs.InvalidOption) as raised:
            training_words(ENV, "PPO", **wrong)
        assert all(f"{name}=" in str(raised.value) for name in wrong)
    with pytest.raises(hasard_rs.InvalidOption, match="'-1' for '--seed"):
        hasard_rs.train(ENV, out="nowhere", seed=-1)


def test_agents_are_functions_of_what_they_are_given(run: hasard_rs.Run) -> None:
    agent = hasard_rs.Agent.load(run.directory)
    vec = agent.make_vec(3)
    observations, _ = vec.reset(seed=5)
    start = agent.begin(3, seed=8)
    actions, after = agent.act(observations, start)
    assert actions.shape == (3, 4) and actions.dtype == np.int64
    again, _ = hasard_rs.Agent.load(run.directory).act(observations, start)
    assert np.array_equal(actions, again), "the same state gives the same actions, in any agent of the run"
    one, _ = agent.act(observations[1], agent.begin(1, seed=9))
    assert np.array_equal(one, actions[1]), "lanes do not depend on each other"
    vec.step(actions)
    agent.act(observations, agent.after(after, np.ones(3), np.array([True, False, False])))
    with pytest.raises(ValueError, match="observations must have shape"):
        agent.act(observations[:, :, ::2], start)
    for wrong in (observations.astype(np.float32), observations.tolist(), None):
        with pytest.raises(TypeError, match="observations must be an array of uint8"):
            agent.act(wrong, start)
    with pytest.raises(hasard_rs.HasardError, match="nowhere"):
        hasard_rs.Agent.load("nowhere")


def test_agents_that_watch_a_named_term_are_given_it(tmp_path: Path) -> None:
    settings = {**SMALL, "safety_budget": "harmful_items=5"}
    run = hasard_rs.train(ENV, "PPOSaute", out=tmp_path / "run", callback=lambda report: True, **settings)
    agent = hasard_rs.Agent.load(run.directory)
    vec = agent.make_vec(2, infos="full")
    observations, _ = vec.reset(seed=1)
    actions, state = agent.act(observations)
    observations, _, terminations, truncations, infos = vec.step(actions)
    over = terminations | truncations
    with pytest.raises(ValueError, match="give cost_terms too"):
        agent.act(observations, agent.after(state, infos["cost"], over))
    terms = infos["cost_terms"]
    rows = [agent.act(observations, agent.after(state, infos["cost"], over, given))[1].memory for given in (terms, terms + 4.0)]
    spent, more = (agent._trained.outputs(observations, memory)[0] for memory in rows)
    assert not np.array_equal(spent, more), "what the term costs is seen"


def test_other_agents_need_no_cost_terms_and_stay_in_the_action_space(tmp_path: Path) -> None:
    run = hasard_rs.train(ENV, out=tmp_path / "run", full_actions=True, safety_budget="harmful_items=5", callback=lambda report: True, **SMALL)
    agent = hasard_rs.Agent.load(run.directory)
    vec = agent.make_vec(4)
    observations, _ = vec.reset(seed=1)
    state, beyond = None, 0
    for _ in range(40):
        actions, state = agent.act(observations, state)
        assert vec.action_space.contains(actions)
        beyond += int((np.abs(actions["deltas"]) == 1.0).sum())
        observations, _, terminations, truncations, infos = vec.step(actions)
        state = agent.after(state, infos["cost"], terminations | truncations)
    assert beyond > 0, "none of its draws was beyond what a player can do"
    with pytest.raises(TypeError, match="costs must be an array"):
        agent.after(state, None, terminations)


def test_callbacks_that_raise_end_the_run(tmp_path: Path) -> None:
    def callback(report: dict) -> None:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        hasard_rs.train(ENV, out=tmp_path / "run", callback=callback, **SMALL)
    assert list((tmp_path / "run").glob("checkpoints/*")), "the run ended with a checkpoint"
    resumed = hasard_rs.train(ENV, out=tmp_path / "run", resume=True, callback=lambda report: True)
    assert resumed.stopped


def test_wrong_settings_write_nothing(tmp_path: Path) -> None:
    for wrong in [{"frames": float("nan")}, {"algorithm": "PPOX"}, {"preset": "slow"}, {"set": {"nothing": 1}}, {"nonsense": 1}]:
        with pytest.raises(hasard_rs.InvalidOption):
            hasard_rs.train(ENV, out=tmp_path / "run", **wrong)
    assert not (tmp_path / "run").exists()


def test_the_program_comes_with_the_wheel() -> None:
    words = [sys.executable, "-m", "hasard_rs.cli"]
    done = subprocess.run([*words, "envs"], capture_output=True, text=True)
    assert done.returncode == 0 and "VolcanicVentureLevel1-v0" in done.stdout
    done = subprocess.run([*words, "rollout", "NoSuchLevel1-v0"], capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    done = subprocess.run([*words, "eval", "--nonsense"], capture_output=True, text=True)
    assert done.returncode == 2 and "(see `hasard eval --help`)" in done.stderr
    done = subprocess.run([*words, "train", "RemedyRushLevel1-v0", "--on", "mars", "--workers", "2"], capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == "hasard: --on 'mars': give ray or ray:ADDRESS, with --workers N\n"


@pytest.mark.parametrize("other", [{}, {"network.cell": "lstm"}, {"network.residual": "[32,32]"}])
def test_the_torch_module_gives_the_same_outputs(run: hasard_rs.Run, tmp_path: Path, other: dict[str, str]) -> None:
    torch = pytest.importorskip("torch")
    import hasard_rs.torch

    if other:
        settings = {**SMALL, "frames": 1024, "set": other}
        run = hasard_rs.train(ENV, "PPOLag", out=tmp_path / "other", **settings)
    agent = hasard_rs.Agent.load(run.directory)
    envs = agent.make_vec(5)
    observations, _ = envs.reset(seed=2)
    model, memory, state = hasard_rs.torch.load(run.directory), agent.begin(5).memory, None
    for _ in range(10):
        rows, memory = agent._trained.outputs(observations, memory)
        with torch.no_grad():
            outputs, state = model(torch.from_numpy(observations), state)
        assert np.abs(outputs.numpy() - rows).max() < 1e-4
        observations = envs.step(envs.action_space.sample())[0]
