"""Own scenarios: files and dictionaries in place of ids, in every way that makes an environment."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import hasard_rs

SCENARIOS = Path(__file__).parents[2] / "scenarios"

GARDEN: dict[str, Any] = {
    "scenario": {"name": "PyGarden", "tics": 350, "budget": 3, "actions": [["TURN_LEFT", "TURN_RIGHT"], ["MOVE_FORWARD"]]},
    "map": {"tile": 64, "ascii": "######\n#....#\n#.@..#\n#....#\n######"},
    "spawn": [{"name": "vials", "kind": "HealthBonus", "count": 6, "respawn": 0}],
    "when": [{"event": "pickup", "of": "vials", "reward": 1.0, "cost": {"greed": 0.5}, "count": "vials"}],
    "levels": {"2": {"spawn": {"vials": {"count": 2}}}},
}


def test_a_dictionary_is_a_scenario_everywhere() -> None:
    own = hasard_rs.Scenario.from_dict(GARDEN)
    assert own.ids == ("hasard/PyGardenLevel1-v0", "hasard/PyGardenLevel2-v0")
    known = hasard_rs.spec(own.ids[0])
    assert (known.scenario, known.level, known.safety_budget, known.max_episode_steps) == ("PyGarden", 1, 3.0, 88)
    env = own.make(resolution="64x48", env_stats=True)
    check_env(env.unwrapped, skip_render_check=True)
    env.reset(seed=3)
    reward, cost = 0.0, 0.0
    for _ in range(88):
        _, step_reward, terminated, truncated, info = env.step(np.array([1, 1]))
        reward, cost = reward + float(step_reward), cost + info["cost"]
    assert truncated and not terminated
    assert reward == info["env_stats"]["vials"] == 2 * cost > 0


def test_batches_and_pickles_play_the_same() -> None:
    own = hasard_rs.Scenario.from_dict(GARDEN)
    worlds = own.make_vec(4, level=2, resolution="64x48")
    copy = pickle.loads(pickle.dumps(own.make(level=2, resolution="64x48")))
    observations, _ = worlds.reset(seed=5)
    # The first lane of a batch has the batch's seed, as in Gymnasium's vectors.
    first, _ = copy.reset(seed=5)
    assert np.array_equal(observations[0], first)
    bare = hasard_rs.Worlds(own.ids[1], 2, resolution="64x48")
    assert bare.reset(5).observations.shape == (2, 48, 64, 3)


@pytest.mark.parametrize("path", sorted(SCENARIOS.glob("*.toml")), ids=lambda path: path.stem)
def test_the_examples_play_from_their_files(path: Path) -> None:
    env = hasard_rs.make(str(path), resolution="64x48")
    env.reset(seed=1)
    for _ in range(20):
        env.step(env.action_space.sample())
    assert gymnasium.make(env.unwrapped.spec.id) is not None
    assert hasard_rs.Worlds(str(path), 1, resolution="64x48").reset(1).observations.shape == (1, 48, 64, 3)


def test_mistakes_are_one_line_with_their_place(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_text('[scenario]\nname = "Bad"\ntics = 0\n[map]\nascii = "@"\n')
    for make in (hasard_rs.make, hasard_rs.spec):
        with pytest.raises(hasard_rs.InvalidOption, match=r"bad\.toml:3:8: tics must be a whole number") as raised:
            make(str(file))
        assert "\n" not in str(raised.value)
    with pytest.raises(hasard_rs.InvalidOption, match="cannot be read"):
        hasard_rs.make(str(tmp_path / "none.toml"))
    with pytest.raises(TypeError, match="text, numbers"):
        hasard_rs.Scenario.from_dict({"scenario": {"name": None}})
    with pytest.raises(TypeError, match="must be a dict, got None"):
        hasard_rs.Scenario.from_dict(None)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="did you mean 'frame_skip'") as raised:
        hasard_rs.Scenario.from_dict(GARDEN).make(frameskip=4)
    assert len(str(raised.value)) < 300, "without the whole file"


def test_the_last_of_a_name_counts() -> None:
    hasard_rs.Scenario.from_dict(GARDEN)
    changed = {**GARDEN, "scenario": {**GARDEN["scenario"], "tics": 35}}
    own = hasard_rs.Scenario.from_dict(changed)
    assert hasard_rs.make(own.ids[0]).unwrapped.max_episode_steps == 9
    assert hasard_rs.Scenario.from_dict(GARDEN).make().unwrapped.max_episode_steps == 88


def test_each_scenario_plays_its_own_rules_whatever_was_made_since() -> None:
    def of(reward: float) -> Any:
        return hasard_rs.Scenario.from_dict({**GARDEN, "when": [{"event": "step", "reward": reward}]})

    first, second = of(100.0), of(7.0)
    for own, reward in ((first, 100.0), (second, 7.0), (pickle.loads(pickle.dumps(first)), 100.0)):
        env = own.make(resolution="64x48")
        env.reset(seed=1)
        assert env.step(np.array([0, 0]))[1] == reward
        env.close()
    for level in (0, -1, 3, "1", True):
        with pytest.raises(hasard_rs.InvalidOption, match="1 to 2"):
            first.make(level=level)


def test_a_batch_of_two_tasks_of_one_name_is_refused(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text(f'{hasard_rs.Scenario.from_dict(GARDEN).text}# {name}\n')
    with pytest.raises(hasard_rs.InvalidOption, match="called PyGarden"):
        hasard_rs.make_vec([str(tmp_path / "a.toml"), str(tmp_path / "b.toml")], 2)


def test_a_copy_leaves_its_name_to_what_was_made_last() -> None:
    first = hasard_rs.Scenario.from_dict({**GARDEN, "scenario": {**GARDEN["scenario"], "name": "PyTwice", "tics": 400}})
    env = first.make(resolution="64x48")
    env.reset(seed=1)
    last = hasard_rs.Scenario.from_dict({**GARDEN, "scenario": {**GARDEN["scenario"], "name": "PyTwice", "tics": 800}})
    copies = [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
    assert [one.unwrapped.max_episode_steps for one in copies] == [100, 100]
    name = last.ids[0]
    known = [hasard_rs.spec(name).max_episode_steps, hasard_rs.Worlds(name, 1).episode_steps, hasard_rs.make(name).unwrapped.max_episode_steps]
    assert known == [200, 200, 200]
    # Of a scenario that has other levels now, the former ids are none.
    alone = {name: value for name, value in GARDEN.items() if name != "levels"}
    alone["scenario"] = {**GARDEN["scenario"], "name": "PyTwice"}
    assert hasard_rs.Scenario.from_dict(alone).ids == ("hasard/PyTwice-v0",) and name not in gymnasium.registry


def test_an_unpickled_environment_is_known_by_its_id() -> None:
    own = hasard_rs.Scenario.from_dict({**GARDEN, "scenario": {**GARDEN["scenario"], "name": "PyFar"}})
    env = own.make(resolution="64x48")
    env.reset(seed=1)
    code = (
        "import pickle, sys, hasard_rs; pickle.load(sys.stdin.buffer); "
        "print(hasard_rs.spec('PyFarLevel2-v0').id, hasard_rs.make('PyFarLevel2-v0').unwrapped.level)"
    )
    done = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(env), capture_output=True)
    assert done.stdout.decode().split() == ["hasard/PyFarLevel2-v0", "2"], done.stderr.decode()
