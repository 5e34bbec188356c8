"""Every render mode with every wrapper of Gymnasium's that draws, single and vector."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import gymnasium.wrappers as single_wrappers
import gymnasium.wrappers.vector as vector_wrappers
import numpy as np
import pytest

import hasard_rs
import hasard_rs.published

ENV = "hasard/CollateralDamageLevel1-v0"
SMALL: dict[str, Any] = {"frame_skip": 35, "max_episode_steps": 3, "resolution": "64x48"}
MODES = pytest.mark.parametrize("mode", ["rgb_array", "depth_array"])
MAKES = pytest.mark.parametrize("make", [hasard_rs.make, gymnasium.make, lambda env_id, **how: hasard_rs.published.make(env_id, **how)])


@pytest.fixture(autouse=True)
def no_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setenv("PYGAME_HIDE_SUPPORT_PROMPT", "1")


def play(env: Any) -> None:
    """An episode and the beginning of another."""
    env.reset(seed=1)
    for _ in range(5):
        _, _, terminated, truncated, _ = env.step(env.action_space.sample())
        if np.ndim(terminated) == 0 and (terminated or truncated):
            env.reset()
    env.close()


@MODES
@MAKES
def test_films_of_one_world(mode: str, make: Any, tmp_path: Path) -> None:
    pytest.importorskip("moviepy")
    env = single_wrappers.RecordVideo(make(ENV, render_mode=mode, **SMALL), str(tmp_path / "films"), episode_trigger=lambda _: True)
    play(env)
    films = list((tmp_path / "films").glob("*.mp4"))
    assert len(films) == 2 and all(film.stat().st_size > 0 for film in films)


@MODES
@pytest.mark.parametrize("batch_size", [0, 2])
def test_films_of_a_batch(mode: str, batch_size: int, tmp_path: Path) -> None:
    pytest.importorskip("moviepy")
    envs = hasard_rs.make_vec(ENV, 4, render_mode=mode, batch_size=batch_size, **SMALL)
    if batch_size:
        # Gymnasium's recorder asks for all lanes in every step; a picture of all can be had nonetheless.
        envs.reset(seed=1)
        envs.step(envs.action_space.sample())
        assert [picture.shape for picture in envs.render()] == [(48, 64, 3)] * 4
        envs.step(envs.action_space.sample())
        return
    play(vector_wrappers.RecordVideo(envs, str(tmp_path / "films"), episode_trigger=lambda _: True))
    assert list((tmp_path / "films").glob("*.mp4"))


@MODES
def test_windows(mode: str) -> None:
    pytest.importorskip("pygame")
    play(single_wrappers.HumanRendering(hasard_rs.make(ENV, render_mode=mode, **SMALL)))
    pytest.importorskip("cv2")
    play(vector_wrappers.HumanRendering(hasard_rs.make_vec(ENV, 2, render_mode=mode, **SMALL)))


@pytest.mark.filterwarnings("ignore:.*You are trying to use 'human' rendering")
def test_a_window_is_opened_where_it_is_asked_for_however_often() -> None:
    pytest.importorskip("pygame")
    for _ in range(2):
        env = hasard_rs.make(ENV, render_mode="human", **SMALL)
        assert env.render_mode == "human"
        play(env)
    assert hasard_rs.Env.metadata["render_modes"] == ["rgb_array", "depth_array"], "wrappers do not write into the class"


@MODES
def test_collections(mode: str) -> None:
    for env in (hasard_rs.make(ENV, render_mode=f"{mode}_list", **SMALL), single_wrappers.RenderCollection(hasard_rs.make(ENV, render_mode=mode, **SMALL))):
        env.reset(seed=1)
        env.step(env.action_space.sample())
        pictures = env.render()
        assert len(pictures) == 2 and all(picture.shape == (48, 64, 3) and picture.dtype == np.uint8 for picture in pictures)
    assert hasard_rs.Env.metadata["render_modes"] == ["rgb_array", "depth_array"]


@MODES
@pytest.mark.parametrize("render_only", [True, False])
def test_pictures_as_observations(mode: str, render_only: bool) -> None:
    env = hasard_rs.make(ENV, render_mode=mode, **SMALL)
    env.reset(seed=1)
    env = single_wrappers.AddRenderObservation(env, render_only=render_only)
    observation, _ = env.reset(seed=1)
    assert observation in env.observation_space
    pixels = observation if render_only else observation["pixels"]
    assert pixels.shape == (48, 64, 3) and np.array_equal(pixels, env.render())


@MODES
def test_noise_over_pictures(mode: str) -> None:
    wraps: list[Any] = [
        lambda env: single_wrappers.AddWhiteNoise(env, probability_of_noise_per_pixel=0.5),
        lambda env: single_wrappers.ObstructView(env, obstructed_pixels_ratio=0.2, obstruction_width=8),
    ]
    for wrap in wraps:
        env = wrap(hasard_rs.make(ENV, render_mode=mode, **SMALL))
        env.reset(seed=1)
        assert env.render().shape == (48, 64, 3)


def test_depth_is_one_picture_in_every_form() -> None:
    env = hasard_rs.make(ENV, render_mode="depth_array", **SMALL)
    env.reset(seed=1)
    plain = env.unwrapped.render()
    assert plain.shape == (48, 64) and np.array_equal(plain, env.unwrapped.picture("depth")), "two axes, as Gymnasium's checker asks"
    assert np.array_equal(env.render(), np.stack([plain] * 3, axis=2))
    envs = hasard_rs.make_vec(ENV, 2, render_mode="depth_array", **SMALL)
    envs.reset(seed=1)
    assert np.array_equal(envs.render()[0], env.render())
