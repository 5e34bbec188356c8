"""The policy in NumPy that plays agents in ViZDoom gives what the program's own network gives."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import numpy as np

import hasard_rs

ENV = "hasard/PrecipicePlungeLevel1-v0"
EXAMPLE = Path(__file__).parents[2] / "tools/numpy_agent.py"


def test_outputs_are_those_of_the_program(tmp_path: Path) -> None:
    run = hasard_rs.train(ENV, "PPOLag", out=tmp_path / "run", frames=1, envs=2, threads=1, preset="quick").directory
    spec = importlib.util.spec_from_file_location("numpy_agent", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    agent = hasard_rs.Agent.load(run)
    config = json.loads((run / "config.json").read_text())
    vec = agent.make_vec(1)
    frame, _ = vec.reset(seed=3)
    sizes = [int(size) for size in vec.single_action_space.nvec]
    weights = sorted(run.glob("checkpoints/frames_*/weights.safetensors"))[-1]
    plain, state = module.Agent(weights, config["network"]["convolutions"], sizes), agent._trained.begin([0])
    # Black and noise lie far from what the run saw, so that the bounds of normalised pixels count.
    shape = frame.shape[1:]
    frames = [frame[0], np.zeros(shape, np.uint8), np.random.default_rng(1).integers(0, 256, shape).astype(np.uint8), frame[0]]
    for seen in frames:
        rows, state = agent._trained.outputs(seen[None], state)
        logits = plain.logits(seen)
        assert logits.shape == (sum(sizes),)
        assert np.abs(logits - rows[0, : len(logits)]).max() < 1e-4
