"""Plays the published worlds at random in ViZDoom and keeps what it shows and reports of chosen moments.

    pip install vizdoom==1.3.2 hasard==0.2.0 numpy opencv-python-headless
    python tools/dump_published_scenes.py OUT [--scenarios a,b] [--levels 1,2,3] [--moments 40] [--size 160X120]
    python tools/dump_published_scenes.py OUT --agent RUN ENVS_JSON    # the level of a run, played by its agent

For every level one folder OUT/SCENARIO_LEVEL_SIZE_SEED with scenes.json (position, facing, eye, floors, things in view,
inventory) and, of every moment, its colours, depth and labels as PNG files. `--example pixels` draws them with our engine.
OUT must lie outside the repository: nothing of the published files belongs there.
"""

import argparse
import json
import math
import os
import tempfile

import cv2
import numpy as np
import vizdoom
from numpy_agent import of_run, reduced
from published_engine import FOLDERS
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
# Way of a rocket from its thrower's middle to where it begins its first tic, map units, and units a tic.
MUZZLE, ROCKET_SPEED = 10, 20
# Policy steps between moments, and before the episode begins anew.
STRIDE, EPISODE = 13, 300
# How often a button is thought about, and pressed then.
CHANGE, PRESSED = 0.3, {"MOVE_FORWARD": 0.75, "USE": 0.12}


class Random:
    """Holds buttons and lets them go at random."""

    def __init__(self, seed, buttons):
        self.rng, self.buttons, self.held = np.random.default_rng(seed), buttons, [0.0] * len(buttons)

    def begin(self):
        pass

    def act(self, _):
        for i, button in enumerate(self.buttons):
            if self.rng.random() < CHANGE:
                self.held[i] = float(self.rng.random() < PRESSED.get(button, 0.4))
        return self.held


class Trained:
    """The agent of a run."""

    def __init__(self, seed, agent, groups):
        self.rng, self.agent, self.groups = np.random.default_rng(seed), agent, groups

    def begin(self):
        self.agent.forget()

    def act(self, frame):
        choices = self.agent.act(reduced(frame), self.rng)
        return [float(choice == index + 1) for group, choice in zip(self.groups, choices) for index in range(len(group))]


def open_game(args, folder, level, groups):
    game = vizdoom.DoomGame()
    game.load_config(os.path.join(folder, "conf.cfg"))
    if groups:
        game.set_available_buttons([getattr(vizdoom.Button, name) for group in groups for name in group])
    if args.no_particles:
        game.set_render_particles(False)
    if args.no_decals:
        game.set_render_decals(False)
    game.set_doom_scenario_path(os.path.join(folder, f"level_{level}.wad"))
    game.set_available_game_variables([getattr(GameVariable, name) for name in VARIABLES])
    game.set_screen_resolution(getattr(vizdoom.ScreenResolution, "RES_" + args.size))
    game.set_screen_format(vizdoom.ScreenFormat.RGB24)
    game.set_window_visible(False)
    game.set_sectors_info_enabled(True)
    game.set_objects_info_enabled(True)
    game.set_labels_buffer_enabled(True)
    game.set_depth_buffer_enabled(True)
    game.set_seed(args.seed)
    game.init()
    return game


def whole_tics(way):
    """Tics that a rocket flew the whole of; it bursts part of a tic's way on."""
    return max(int(way / ROCKET_SPEED + 0.01), 0)


class Rockets:
    """Where rockets flew and burst since the episode began, from what is reported of every fourth tic."""

    def __init__(self):
        self.bursts, self.flights, self.flying, self.burst, self.eye = [], [], {}, set(), None

    def note(self, state, eye):
        # They were thrown from where the thrower was at the look before.
        thrower, self.eye = self.eye or eye, eye
        burst, things = set(), [thing for thing in state.objects if thing.name == "Rocket"]
        for lost in set(self.flying) - {thing.id for thing in things}:
            flight = self.flying.pop(lost)
            flight["tics"] = int(state.tic) - FRAME_SKIP + 1 - flight["tic"]
        for thing in things:
            place = [thing.position_x, thing.position_y, thing.position_z]
            velocity = [thing.velocity_x, thing.velocity_y, thing.velocity_z]
            if any(velocity):
                if thing.id not in self.flying:
                    tics = round((math.dist(place[:2], thrower) - MUZZLE) / ROCKET_SPEED)
                    first = [at - (tics - 1) * step for at, step in zip(place, velocity)]
                    self.flying[thing.id] = {"tic": int(state.tic) + 1 - tics, "place": first, "velocity": velocity, "tics": None}
                    self.flights.append(self.flying[thing.id])
                continue
            burst.add(thing.id)
            if thing.id in self.flying:
                flight = self.flying.pop(thing.id)
                flight["tics"] = 1 + whole_tics(math.dist(place, flight["place"]))
                self.bursts.append([*place, thing.angle])
            elif thing.id not in self.burst:
                # Thrown since the last look, in the first tic after it, and burst already.
                way = [math.cos(math.radians(thing.angle)), math.sin(math.radians(thing.angle)), 0.0]
                flown = math.dist(place[:2], thrower) - MUZZLE
                first = [at + (ROCKET_SPEED - flown) * part for at, part in zip(place, way)]
                velocity = [ROCKET_SPEED * part for part in way]
                tics = whole_tics(flown)
                self.flights.append({"tic": int(state.tic) + 1 - FRAME_SKIP, "place": first, "velocity": velocity, "tics": tics})
                self.bursts.append([*place, thing.angle])
        self.burst = burst


def chance(seed, episode):
    """What the engine's own chance begins with in an episode: one number after the other of a Mersenne Twister with the game's seed."""
    return int(np.random.RandomState(seed).randint(0, 2**32, size=episode + 1, dtype=np.uint32)[-1])


def scene(number, state, rockets, chance, episode):
    """What the engine reports of a moment."""
    return {
        "number": number,
        "tic": int(state.tic),
        "variables": dict(zip(VARIABLES, map(float, state.game_variables))),
        "floors": [float(sector.floor_height) for sector in state.sectors],
        "ceilings": [float(sector.ceiling_height) for sector in state.sectors],
        "chance": chance,
        "episode": episode,
        "bursts": list(rockets.bursts),
        "flights": [dict(flight) for flight in rockets.flights],
        "labels": [
            {
                "name": label.object_name, "value": int(label.value), "angle": label.object_angle,
                "px": label.object_position_x, "py": label.object_position_y, "pz": label.object_position_z,
            }
            for label in state.labels
        ],
    }


def dump(args, scenario, level, out, trained=None):
    packages = os.path.dirname(os.path.dirname(vizdoom.__file__))
    folder = os.path.join(packages, "hasard", "envs", scenario)
    game = open_game(args, folder, level, trained and trained.groups)
    buttons = [str(button).split(".")[-1] for button in game.get_available_buttons()]
    player, scenes, rockets, episode, step = trained or Random(args.seed, buttons), [], Rockets(), 0, 0
    os.makedirs(out, exist_ok=True)
    player.begin()
    while len(scenes) < args.moments:
        game.make_action(player.act(game.get_state().screen_buffer), FRAME_SKIP)
        step += 1
        state = game.get_state()
        if state:
            rockets.note(state, [state.game_variables[VARIABLES.index(f"CAMERA_POSITION_{axis}")] for axis in "XY"])
        if not state or step % EPISODE == 0:
            game.new_episode()
            rockets, episode = Rockets(), episode + 1
            player.begin()
            game.make_action([0.0] * len(buttons), FRAME_SKIP)
        elif step % STRIDE == 0:
            pictures = {"rgb": state.screen_buffer[:, :, ::-1], "depth": state.depth_buffer, "labels": state.labels_buffer}
            for name, picture in pictures.items():
                cv2.imwrite(os.path.join(out, f"{len(scenes):02}_{name}.png"), picture)
            scenes.append(scene(len(scenes), state, rockets, chance(args.seed, episode), episode))
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
    parser.add_argument("--no-particles", action="store_true", help="without what the engine throws by chance")
    parser.add_argument("--no-decals", action="store_true", help="without soot and holes on walls")
    parser.add_argument("--agent", nargs=2, metavar=("RUN", "ENVS_JSON"), help="ENVS_JSON is what `hasard envs --json` prints")
    args = parser.parse_args()
    out = os.path.abspath(args.out)
    if args.agent:
        agent, env, groups = of_run(*args.agent)
        scenario, level = env["id"].split("Level")
    # The published engine leaves files where it is started.
    os.chdir(tempfile.mkdtemp())
    if args.agent:
        scenario, level, trained = FOLDERS[scenario], int(level[0]), Trained(args.seed, agent, groups)
        return dump(args, scenario, level, os.path.join(out, f"{scenario}_{level}_{args.size}_agent"), trained)
    for scenario in args.scenarios.split(","):
        for level in map(int, args.levels.split(",")):
            dump(args, scenario, level, os.path.join(out, f"{scenario}_{level}_{args.size}_{args.seed}"))


if __name__ == "__main__":
    main()
