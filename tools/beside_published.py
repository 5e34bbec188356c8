"""Random buttons in the published engine and in ours, tic by tic; prints the first tic that differs, episode by episode.

    pip install vizdoom==1.3.2 hasard==0.2.0 numpy
    cargo build --release -p hasard && cargo build --release -p hasard-envs --example bare_world
    python beside_published.py TARGET/release whole 100        # Precipice Plunge 1, which draws nothing at random: whole episodes
    python beside_published.py TARGET/release bodies VolcanicVenture 60   # bodies among the floors that the original drew
    python beside_published.py TARGET/release bodies RemedyRush 60        # the same in the published map, which has no tiles, among its trees
    python beside_published.py TARGET/release traces RemedyRush 3         # there, the buttons of all motion that was recorded elsewhere
    python beside_published.py TARGET/release returns RemedyRush 1 300    # returns and costs in the published map, both engines
    python beside_published.py TARGET/release returns all 300             # all 24 maps (examples: action_episodes)

Nothing of the published packages is kept; they are run where pip put them. Compared are position, velocity, angle and pitch,
to 1/65536 map unit and 0.01 degree.
"""

import csv
import glob
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import vizdoom

from published_engine import FOLDERS, MAPS, Published

VARIABLES = "POSITION_X POSITION_Y POSITION_Z ANGLE PITCH VELOCITY_X VELOCITY_Y VELOCITY_Z".split()
# Our maps of these are of our own design.
PUBLISHED_MAPS = ("RemedyRush", "DetonatorsDilemma")
# What stands in them all the time, some of it in a body's way.
STANDING = (
    "TorchTree Stalagtite BigTree TechLamp TechLamp2 Candlestick ShortRedTorch ShortBlueTorch ShortGreenTorch "
    "burning_top burning_debris".split()
)
RECORDINGS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../crates/engine/tests/traces/*.trace")
SIMPLE = "TURN_LEFT TURN_RIGHT MOVE_FORWARD MOVE_BACKWARD LOOK_UP LOOK_DOWN JUMP".split()
FULL = SIMPLE + "MOVE_LEFT MOVE_RIGHT SPEED CROUCH TURN180 LOOK_UP_DOWN_DELTA TURN_LEFT_RIGHT_DELTA".split()


def game(scenario, buttons):
    """The published engine with a scenario's first level."""
    packages = os.path.dirname(os.path.dirname(vizdoom.__file__))
    folder = os.path.join(packages, "hasard", "envs", FOLDERS[scenario])
    game = vizdoom.DoomGame()
    game.load_config(os.path.join(folder, "conf.cfg"))
    game.set_doom_scenario_path(os.path.join(folder, "level_1.wad"))
    game.set_available_buttons([getattr(vizdoom.Button, name) for name in buttons])
    game.set_available_game_variables([getattr(vizdoom.GameVariable, name) for name in VARIABLES])
    game.set_screen_resolution(vizdoom.ScreenResolution.RES_160X120)
    game.set_window_visible(False)
    game.set_sectors_info_enabled(True)
    game.set_objects_info_enabled(True)
    game.init()
    return game


def held(rng, buttons, tics):
    """Buttons that are pressed and let go at random; delta buttons have degrees."""
    now, all_tics = [0.0] * len(buttons), []
    for _ in range(tics):
        for index, name in enumerate(buttons):
            if rng.random() < 0.08:
                value = float(rng.normal() * 3) if "DELTA" in name else 1.0
                now[index] = value if rng.random() < 0.45 else 0.0
        all_tics.append(list(now))
    return all_tics


def words(buttons, values):
    """A tic's buttons as `hasard trace` reads them."""
    pressed = [f"{name}={value}" if "DELTA" in name else name for name, value in zip(buttons, values) if value]
    return "+".join(pressed) or "noop"


def played(game, tics):
    """The variables after each tic, until the episode ends."""
    rows = []
    for values in tics:
        game.make_action(values, 1)
        state = game.get_state()
        if state is None:
            break
        rows.append([float(value) for value in state.game_variables])
    return rows


def first_difference(theirs, ours):
    """Index of the first row that differs."""
    allowed = [2e-5] * 3 + [0.01] * 2 + [2e-5] * 3
    for index, (a, b) in enumerate(zip(theirs, ours)):
        gaps = [abs(x - y) for x, y in zip(a, b)]
        gaps[3] = min(gaps[3], 360 - gaps[3])
        if any(gap > most for gap, most in zip(gaps, allowed)):
            return index
    return None


def whole(programs, episodes):
    """Whole episodes of Precipice Plunge 1, by `hasard trace`."""
    original = game("PrecipicePlunge", SIMPLE)
    for seed in range(1, episodes + 1):
        tics = held(np.random.default_rng(seed), SIMPLE, 2090)
        original.set_seed(seed)
        original.new_episode()
        theirs = played(original, tics)
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write("action\n" + "".join(words(SIMPLE, values) + "\n" for values in tics))
            file.flush()
            command = "trace PrecipicePlungeLevel1-v0 --rules released --after 0 --actions".split()
            out = subprocess.run([f"{programs}/hasard", *command, file.name], capture_output=True, text=True, check=True)
        rows = [row for row in csv.reader(out.stdout.splitlines()) if len(row) > 9 and row[2]][2:]
        yield seed, len(theirs), first_difference(theirs, [[float(value) for value in row[2:10]] for row in rows])


def bodies(programs, scenario, episodes):
    """Random buttons for bodies among the floors that the original has drawn by then."""
    original, seed = game(scenario, FULL), 0
    while episodes:
        seed += 1
        rng = np.random.default_rng(seed)
        tics = held(rng, FULL, 1000)
        outcome = body(programs, original, scenario, seed, tics, rng)
        if outcome is None:
            print(f"seed {seed}: the original locked the agent up in rock, left out")
            continue
        episodes -= 1
        yield seed, *outcome


def traces(programs, scenario, seeds):
    """The buttons of every recording in `crates/engine/tests/traces`, each from a few places."""
    original = game(scenario, FULL)
    recorded = {tuple(map(tuple, recorded_buttons(path))): path for path in sorted(glob.glob(RECORDINGS))}
    for tics, path in recorded.items():
        for seed in range(1, seeds + 1):
            outcome = body(programs, original, scenario, seed, [list(values) for values in tics], np.random.default_rng(seed))
            if outcome is not None:
                yield f"{os.path.basename(path)}, {seed}", *outcome


def recorded_buttons(path):
    """What a recording held down, tic by tic, as values of FULL."""
    tics, now = [], [0.0] * len(FULL)
    for line in open(path).read().splitlines()[1:]:
        if line.startswith("> "):
            pressed = dict((word.split("=") + ["1"])[:2] for word in line[2:].split("+"))
            now = [float(pressed.get(name, 0)) for name in FULL]
        else:
            tics += [now] * (int(line[1:] or 1) if line.startswith(".") else 1)
    return tics


def inside(sectors, x, y):
    """Whether a point lies in a sector: an odd number of its lines are crossed on the way out."""
    def crossed(line):
        (x1, y1), (x2, y2) = (line.x1, line.y1), (line.x2, line.y2)
        return (y1 > y) != (y2 > y) and x < x1 + (y - y1) * (x2 - x1) / (y2 - y1)
    return any(sum(map(crossed, sector.lines)) % 2 for sector in sectors)


def body(programs, original, scenario, seed, tics, rng):
    """A body alone, by the example `bare_world`: tics compared and the first that differs; nothing for one that begins in rock, where
    there is no floor but what the order of an engine's nodes makes of it."""
    original.set_seed(seed)
    original.new_episode()
    original.make_action([0] * len(FULL), 40)
    state = original.get_state()
    lines = [line for sector in state.sectors for line in sector.lines]
    west, east = min(line.x1 for line in lines) + 40, max(line.x1 for line in lines) - 40
    south, north = min(line.y1 for line in lines) + 40, max(line.y1 for line in lines) - 40
    for kind in {thing.name for thing in state.objects} - {"DoomPlayer", *STANDING}:
        original.send_game_command(f"remove {kind}")
    original.send_game_command("god")
    if scenario not in PUBLISHED_MAPS:  # there the rules have put the agent somewhere
        original.send_game_command(f"warp {rng.uniform(west, east):.0f} {rng.uniform(south, north):.0f}")
    original.make_action([0] * len(FULL), 40)
    state = original.get_state()
    x, y = state.game_variables[:2]
    if scenario in PUBLISHED_MAPS and not inside(state.sectors, x, y):
        return None
    start = " ".join(repr(float(value)) for value in state.game_variables[:5])
    floors = []
    for sector in state.sectors:
        count = 2 * len(sector.lines)
        x = sum(line.x1 + line.x2 for line in sector.lines) / count
        y = sum(line.y1 + line.y2 for line in sector.lines) / count
        floors.append(f"{x} {y} {sector.floor_height} {sector.ceiling_height}")
    theirs = played(original, tics)
    text = [f"{scenario}Level1-v0", start, str(len(floors)), *floors, *(words(FULL, values) for values in tics[: len(theirs)])]
    program = [f"{programs}/examples/bare_world"] + ([MAPS] if scenario in PUBLISHED_MAPS else [])
    out = subprocess.run(program, input="\n".join(text) + "\n", capture_output=True, text=True, check=True)
    ours = [[float(value) for value in line.split(",")] for line in out.stdout.splitlines()]
    return len(theirs), first_difference(theirs, ours)


def both(programs, scenario, level, hard, episodes):
    """The same random actions in both engines' worlds of a published map: (return, cost) of each episode, theirs and ours."""
    name = f"{scenario}Level{level}-v0"
    listed = subprocess.run([f"{programs}/hasard", "envs", "--json"], capture_output=True, text=True, check=True).stdout
    groups = next(env["actions"]["simplified"] for env in map(json.loads, listed.splitlines()) if env["id"] == name)
    original, lines, theirs = Published(scenario, level, hard, groups), [], []
    for seed in range(1, episodes + 1):
        rng = np.random.default_rng(7919 * seed)
        actions = np.stack([rng.integers(0, len(group) + 1, 525) for group in groups], 1)
        lines.append(f"{seed} " + " ".join("".join(map(str, action)) for action in actions))
        original.reset(seed)
        sums = np.zeros(2)
        for action in actions:
            _, reward, cost, over = original.step(action)
            sums += reward, cost
            if over:
                break
        theirs.append(sums)
    original.close()
    program = [f"{programs}/examples/action_episodes", MAPS, name, "hard" if hard else "soft"]
    out = subprocess.run(program, input="\n".join(lines) + "\n", capture_output=True, text=True, check=True).stdout
    return np.array(theirs), np.array([[float(word) for word in line.split()[:2]] for line in out.splitlines()])


def returns(programs, rest):
    """A table: mean and standard error of returns and costs in both, and how many standard errors lie between."""
    if rest[0] == "all":
        maps, episodes = [(name, level, hard) for name in FOLDERS for level, hard in [(1, 0), (1, 1), (2, 0), (3, 0)]], int(rest[1])
    else:
        maps, episodes = [(rest[0], int(rest[1].rstrip("h")), rest[1].endswith("h"))], int(rest[2])
    print("| map | return there | here | standard errors | cost there | here | standard errors |")
    print("|---|--:|--:|--:|--:|--:|--:|", flush=True)
    for scenario, level, hard in maps:
        theirs, ours = both(programs, scenario, level, bool(hard), episodes)
        cells = []
        for a, b in zip(theirs.T, ours.T):
            error = np.sqrt((a.var(ddof=1) + b.var(ddof=1)) / episodes)
            apart = (b.mean() - a.mean()) / error if error else float(b.mean() != a.mean())
            cells += [f"{a.mean():.3f}", f"{b.mean():.3f}", f"{apart:+.1f}"]
        print(f"| {scenario} {level}{' hard' if hard else ''} | " + " | ".join(cells) + " |", flush=True)


def main():
    programs, what, *rest = sys.argv[1:]
    programs = os.path.abspath(programs)
    # The published engine leaves files where it is started.
    os.chdir(tempfile.mkdtemp())
    if what == "returns":
        return returns(programs, rest)
    runs = whole(programs, int(rest[0])) if what == "whole" else {"bodies": bodies, "traces": traces}[what](programs, rest[0], int(rest[1]))
    tics = episodes = astray = 0
    for seed, length, difference in runs:
        episodes, tics = episodes + 1, tics + length
        if difference is not None:
            astray += 1
            print(f"seed {seed}: differs at tic {difference + 1} of {length}")
    print(f"{episodes} episodes, {tics} tics, {astray} episodes differ")


if __name__ == "__main__":
    main()
