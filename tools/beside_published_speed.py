#!/usr/bin/env python3
"""Our policy steps a second beside the published engine's, on the same levels, one thread each, in turn.

    pip install vizdoom HASARD numpy
    cargo build --release -p hasard-envs --example step_cost
    python3 tools/beside_published_speed.py [PART OF AN ENVIRONMENT'S NAME...]

The published worlds run raw, without any wrapper: 160x120 RGB24 as the engine gives it, reduced to 128x72 by indexing,
4 tics a step, random buttons, new episodes included; the maps are those of the installed package `hasard`, the pictures
those of the package `vizdoom`. Ours: 32 worlds in turn, 128x72 RGB, 4 tics a step, random actions, new episodes included;
built-in maps and pictures, with `--maps` the published ones.
Each gets a second of wall time, in turn, for five rounds; printed is the median of the rounds' ratios.
Both run on the same one core: the published engine is a process of its own that answers to Python's, and where two cores take long
to wake one another, as virtual machines do, it makes but half as many steps on two. `--all-cores` leaves both where they are put.
"""

import argparse
import contextlib
import importlib.util
import os
import pathlib
import random
import re
import statistics
import subprocess
import tempfile
import time

SCENARIOS = ["ArmamentBurden", "RemedyRush", "CollateralDamage", "VolcanicVenture", "PrecipicePlunge", "DetonatorsDilemma"]
WIDTH, HEIGHT, FRAME_SKIP, LANES = 128, 72, 4, "32"


@contextlib.contextmanager
def on_one_core():
    """This process, and those that it starts, on a core that they share, where the system can have them do so."""
    cores = os.sched_getaffinity(0) if hasattr(os, "sched_setaffinity") else None
    if cores:
        os.sched_setaffinity(0, {max(cores)})
    try:
        yield
    finally:
        if cores:
            os.sched_setaffinity(0, cores)


def package(name):
    """Where an installed package lies; it is not run."""
    found = importlib.util.find_spec(name)
    if found is None:
        raise SystemExit(f"the package {name} is needed: pip install {'HASARD' if name == 'hasard' else name}")
    return pathlib.Path(found.submodule_search_locations[0])


def open_game(maps, scenario, level):
    """A level of the published engine, raw, from the folder of the published maps; and the index of the pixels that a learner gets."""
    import numpy
    import vizdoom

    folder = maps / re.sub(r"(?<!^)(?=[A-Z])", "_", scenario).lower()
    game = vizdoom.DoomGame()
    game.load_config(str(folder / "conf.cfg"))
    game.set_doom_scenario_path(str(folder / f"level_{level}.wad"))
    game.set_doom_game_path(str(package("vizdoom") / "freedoom2.wad"))
    game.set_screen_resolution(vizdoom.ScreenResolution.RES_160X120)
    game.set_screen_format(vizdoom.ScreenFormat.RGB24)
    game.set_window_visible(False)
    game.set_mode(vizdoom.Mode.PLAYER)
    game.init()
    rows, columns = numpy.arange(HEIGHT) * 120 // HEIGHT, numpy.arange(WIDTH) * 160 // WIDTH
    return game, numpy.ix_(rows, columns)


class Published:
    """One world of the published engine."""

    def __init__(self, scenario, level):
        import numpy
        import vizdoom

        self.game, self.picked = open_game(package("hasard") / "envs", scenario, level)
        self.copy = numpy.ascontiguousarray
        # Only buttons that are held or not; those with an amount stay at 0.
        binary = [not vizdoom.is_delta_button(button) for button in self.game.get_available_buttons()]
        self.action = lambda: [float(pressed and random.random() < 0.5) for pressed in binary]

    def steps_per_second(self, seconds):
        steps, start = 0, time.perf_counter()
        while time.perf_counter() - start < seconds:
            if self.game.is_episode_finished():
                self.game.new_episode()
            self.game.make_action(self.action(), FRAME_SKIP)
            state = self.game.get_state()
            if state is not None:
                self.copy(state.screen_buffer[self.picked])
            steps += 1
        return steps / (time.perf_counter() - start)


def ours(program, environment, seconds, maps):
    command = [program, environment, f"{seconds}s", LANES, "observe", "320"] + (["--maps"] if maps else [])
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ)
    if done.returncode != 0:
        raise SystemExit(f"{program}: {done.stderr.strip()}")
    return 1e9 / float(done.stdout.split()[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", help="parts of names; all environments if none is given")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--simd", choices=["plain", "avx2", "avx512"], help="what ours may use (HASARD_SIMD)")
    parser.add_argument("--maps", action="store_true", help="ours in the published maps, with the published pictures, too")
    parser.add_argument("--all-cores", action="store_true", help="do not keep both on one core")
    parser.add_argument("--program", default="target/release/examples/step_cost", help="the built example")
    given = parser.parse_args()
    program = str(pathlib.Path(given.program).resolve())
    # The published engine leaves its settings where it runs.
    os.chdir(tempfile.mkdtemp(prefix="beside_published_speed_"))
    if given.simd:
        os.environ["HASARD_SIMD"] = given.simd
    names = [(scenario, level) for scenario in SCENARIOS for level in (1, 2, 3)]
    wanted = [name for name in names if not given.parts or any(part in f"{name[0]}Level{name[1]}" for part in given.parts)]
    print("| environment | published, steps/s | ours, steps/s | ratio | least | most |")
    print("|---|---:|---:|---:|---:|---:|")
    medians = []
    for scenario, level in wanted:
        environment = f"{scenario}Level{level}-v0"
        with contextlib.nullcontext() if given.all_cores else on_one_core():
            published = Published(scenario, level)
            published.steps_per_second(0.2)
            turn = lambda: (published.steps_per_second(given.seconds), ours(program, environment, given.seconds, given.maps))
            pairs = [turn() for _ in range(given.rounds)]
            published.game.close()
        ratios = [mine / theirs for theirs, mine in pairs]
        medians.append(statistics.median(ratios))
        theirs, mine = (statistics.median(values) for values in zip(*pairs))
        print(f"| {environment} | {theirs:.0f} | {mine:.0f} | {medians[-1]:.1f} | {min(ratios):.1f} | {max(ratios):.1f} |", flush=True)
    if medians:
        print(f"\ngeometric mean {statistics.geometric_mean(medians):.1f}, least {min(medians):.1f}")


if __name__ == "__main__":
    main()
