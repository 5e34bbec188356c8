"""The blocks of Python in the README and the book run as they stand, a training made short."""

import re
from pathlib import Path

import pytest

import hasard_rs

ROOT = Path(__file__).resolve().parent.parent.parent
PAGES = [ROOT / "README.md", *sorted(path for path in ROOT.glob("docs/**/*.md") if path.parent.name not in ("results", "tried"))]
BLOCKS = [(page, code) for page in PAGES for code in re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S)]


def test_there_are_blocks():
    assert len(BLOCKS) >= 5


@pytest.mark.parametrize("page, code", BLOCKS, ids=[page.relative_to(ROOT).as_posix() for page, _ in BLOCKS])
def test_a_block_runs(page, code, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = code.replace("range(1000)", "range(10)")
    code = re.sub(r"episodes=\d+", "episodes=1", code)
    if "train(" in code:
        small = {"network.dense": [32], "network.recurrent": 32, "sampling.rollout": 8, "episode_steps": 8, "evaluation.episodes": 1,
                 "evaluation.confirming_episodes": 1}
        train = hasard_rs.train
        monkeypatch.setattr(hasard_rs, "train", lambda env, **words: train(env, **words | {"frames": 256, "envs": 2, "set": small}))
    if "lava_garden.toml" in code:
        Path("lava_garden.toml").write_text((ROOT / "scenarios/remedy_rush.toml").read_text())
    exec(compile(code, str(page), "exec"), {"__name__": "page"})
