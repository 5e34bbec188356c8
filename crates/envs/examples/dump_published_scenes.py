"""Plays the published worlds at random in the published engine and keeps what it shows and tells of chosen moments.

    pip install vizdoom==1.3.2 hasard==0.2.0 numpy opencv-python-headless
    python crates/envs/examples/dump_published_scenes.py OUT [--scenarios a,b] [--levels 1,2,3] [--moments 40] [--size 160X120]

For every level one folder OUT/SCENARIO_LEVEL_SIZE_SEED with scenes.json (position, facing, eye, floors, things in view,
inventory) and, of every moment, its colours, depth and labels as PNG files. `--example pixels` draws them with our engine.
OUT must lie outside the repository: nothing of the published files belongs there.
"""

import argparse
import json
import os
import tempfile

import cv2
import numpy as np
import vizdoom
from vizdoom import GameVariable

SCENARIOS = (
    "armament_burden", "collateral_damage", "detonators_dilemma", "precipice_plunge", "remedy_rush", "volcanic_venture",
)
VARIABLES = (
    "CAMERA_POSITION_X CAMERA_POSITION_Y CAMERA_POSITION_Z CAMERA_ANGLE CAMERA_PITCH POSITION_Z "
    "HEALTH ARMOR DEAD SELECTED_WEAPON "
    + " ".join(f"AMMO{slot} WEAPON{slot}" for slot in range(2, 8))
).split()
FRAME_SKIP = 4
# Policy steps between moments, and before the episode begins anew.
STRIDE, EPISODE = 13, 300
# How often a button is thought about, and pressed then.
CHANGE, PRESSED = 0.3, {"MOVE_FORWARD": 0.75, "USE": 0.12}


def open_game(args, folder, level):
    game = vizdoom.DoomGame()
    game.load_config(os.path.join(folder, "conf.cfg"))
    game.set_doom_scenario_path(os.path.join(folder, f"level_{level}.wad"))
    game.set_available_game_variables([getattr(GameVariable, name) for name in VARIABLES])
    game.set_screen_resolution(getattr(vizdoom.ScreenResolution, "RES_" + args.size))
    game.set_screen_format(vizdoom.ScreenFormat.RGB24)
    game.set_window_visible(False)
    game.set_sectors_info_enabled(True)
    game.set_labels_buffer_enabled(True)
    game.set_depth_buffer_enabled(True)
    game.set_seed(args.seed)
    game.init()
    return game


def told(number, state):
    """What the engine tells of a moment."""
    return {
        "number": number,
        "tic": int(state.tic),
        "variables": dict(zip(VARIABLES, map(float, state.game_variables))),
        "floors": [float(sector.floor_height) for sector in state.sectors],
        "ceilings": [float(sector.ceiling_height) for sector in state.sectors],
        "labels": [
            {
                "name": label.object_name, "value": int(label.value), "angle": label.object_angle,
                "px": label.object_position_x, "py": label.object_position_y, "pz": label.object_position_z,
            }
            for label in state.labels
        ],
    }


def dump(args, scenario, level, out):
    packages = os.path.dirname(os.path.dirname(vizdoom.__file__))
    folder = os.path.join(packages, "hasard", "envs", scenario)
    game = open_game(args, folder, level)
    buttons = [str(button).split(".")[-1] for button in game.get_available_buttons()]
    rng = np.random.default_rng(args.seed)
    held, scenes, step = [0.0] * len(buttons), [], 0
    os.makedirs(out, exist_ok=True)
    while len(scenes) < args.moments:
        for i, button in enumerate(buttons):
            if rng.random() < CHANGE:
                held[i] = float(rng.random() < PRESSED.get(button, 0.4))
        game.make_action(held, FRAME_SKIP)
        step += 1
        if game.is_episode_finished() or step % EPISODE == 0:
            game.new_episode()
            game.make_action([0.0] * len(buttons), FRAME_SKIP)
        elif step % STRIDE == 0:
            state = game.get_state()
            pictures = {"rgb": state.screen_buffer[:, :, ::-1], "depth": state.depth_buffer, "labels": state.labels_buffer}
            for name, picture in pictures.items():
                cv2.imwrite(os.path.join(out, f"{len(scenes):02}_{name}.png"), picture)
            scenes.append(told(len(scenes), state))
    game.close()
    width, height = map(int, args.size.split("X"))
    head = {
        "scenario": scenario, "level": level, "width": width, "height": height, "scenes": scenes,
        "wad": os.path.join(folder, f"level_{level}.wad"), "iwad": os.path.join(packages, "vizdoom", "freedoom2.wad"),
    }
    with open(os.path.join(out, "scenes.json"), "w") as file:
        json.dump(head, file)
    print(out, len(scenes), "moments", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", help="folder outside the repository")
    parser.add_argument("--scenarios", default=",".join(SCENARIOS))
    parser.add_argument("--levels", default="1,2,3")
    parser.add_argument("--moments", type=int, default=40)
    parser.add_argument("--size", default="160X120")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    out = os.path.abspath(args.out)
    # The published engine leaves files where it is started.
    os.chdir(tempfile.mkdtemp())
    for scenario in args.scenarios.split(","):
        for level in map(int, args.levels.split(",")):
            dump(args, scenario, level, os.path.join(out, f"{scenario}_{level}_{args.size}_{args.seed}"))


if __name__ == "__main__":
    main()
