"""Maps and pictures of the user's: the same words as the program's, and an agent is at work in those that it was trained in."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from test_training import SMALL

import hasard_rs
from hasard_rs import _core

ENV = "hasard/VolcanicVentureLevel1-v0"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A folder with a package `hasard`, laid out as the published one, whose first level is ours in the dark."""
    level = tmp_path / "hasard" / "envs" / "volcanic_venture" / "level_1.wad"
    level.parent.mkdir(parents=True)
    (tmp_path / "hasard" / "__init__.py").write_text("raise RuntimeError('this package is not run')\n")
    assert _core.main(["hasard", "export-wad", ENV.removeprefix("hasard/"), "-o", str(level)]) == 0
    ours = level.read_bytes()
    assert b"lightlevel = 210" in ours
    level.write_bytes(ours.replace(b"lightlevel = 210", b"lightlevel = 100"))
    return tmp_path


def seen(env: Any) -> bytes:
    """The first picture of an episode, which distinguishes maps."""
    picture = env.reset(seed=3)[0].tobytes()
    env.close()
    return picture


def test_maps_have_the_programs_names(package: Path) -> None:
    folder = package / "hasard" / "envs"
    builtin = seen(hasard_rs.make(ENV, resolution="64x48"))
    theirs = seen(hasard_rs.make(ENV, resolution="64x48", maps=folder))
    assert theirs != builtin
    assert seen(hasard_rs.make(ENV, resolution="64x48", map=folder / "volcanic_venture" / "level_1.wad")) == theirs
    assert seen(hasard_rs.make(ENV, resolution="64x48", maps=None)) == builtin
    with pytest.raises(hasard_rs.InvalidMap, match="no map of RemedyRushLevel1-v0"):
        hasard_rs.make("hasard/RemedyRushLevel1-v0", maps=folder)


def test_a_saved_moment_stays_with_its_map(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = package / "hasard" / "envs"
    theirs, builtin = (hasard_rs.make(ENV, resolution="64x48", maps=maps).unwrapped for maps in (folder, None))
    theirs.reset(seed=1)
    builtin.reset(seed=1)
    moment, own = theirs.save(), builtin.save()
    with pytest.raises(ValueError, match="saved from other worlds .*maps="):
        builtin.load(moment)
    with pytest.raises(ValueError, match="these are .*maps="):
        theirs.load(own)
    assert builtin.save() == own
    monkeypatch.chdir(package)
    again = hasard_rs.make(ENV, resolution="64x48", maps="hasard/envs").unwrapped
    again.reset(seed=2)
    again.load(moment)
    assert again.save() == moment


def test_auto_is_what_the_program_finds(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    theirs = seen(hasard_rs.make(ENV, resolution="64x48", maps=package / "hasard" / "envs"))
    monkeypatch.setenv("PYTHONPATH", f"{package}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    # The interpreter at hand is asked: there is no other on this path.
    monkeypatch.setenv("PATH", str(package))
    assert seen(hasard_rs.make(ENV, resolution="64x48", maps="auto")) == theirs
    words = [sys.executable, "-m", "hasard_rs.cli", "render", ENV.removeprefix("hasard/"), "--maps", "auto", "-o", str(package / "frame.png")]
    assert subprocess.run(words, capture_output=True).returncode == 0
    (package / "vizdoom").mkdir()
    (package / "vizdoom" / "__init__.py").touch()
    (package / "vizdoom" / "freedoom2.wad").write_bytes(b"no WAD")
    with pytest.raises(ValueError, match=r"vizdoom.freedoom2\.wad"):
        hasard_rs.make(ENV, maps="auto", iwad="auto")


def test_agents_are_at_work_where_they_were_trained(package: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PYTHONPATH", f"{package}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    run = hasard_rs.train(ENV, "PPOLag", out=tmp_path / "run", maps="auto", callback=lambda report: True, **SMALL)
    agent = hasard_rs.Agent.load(run.directory)
    assert agent.arguments()["maps"] == "auto"
    theirs = seen(hasard_rs.make(ENV, resolution="64x48", maps="auto"))
    assert seen(agent.make()) == seen(agent.make_vec(1)) == theirs
    assert seen(agent.make(maps=None)) != theirs
