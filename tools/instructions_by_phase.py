#!/usr/bin/env python3
"""Where a policy step's instructions go: `instructions_by_phase.py [ENVIRONMENT...] [--steps 2100] [--lanes 4]`.

Runs the example `step_cost` (built with symbols, as the release profile has them) under valgrind's callgrind and prints,
for each phase of a step, thousand instructions / misses of the nearest data cache / mispredicted branches, as simulated.
Such counts do not depend on what else the machine does. Valgrind knows no AVX-512: it counts what runs with AVX2, or
with HASARD_SIMD=plain.
"""

import argparse
import collections
import re
import subprocess
import tempfile

DEFAULT = ["VolcanicVentureLevel1-v0", "VolcanicVentureLevel3-v0", "PrecipicePlungeLevel3-v0", "RemedyRushLevel1-v0"]
DEFAULT += ["CollateralDamageLevel1-v0", "DetonatorsDilemmaLevel3-v0"]
# The first that fits a function's name counts; what the compiler inlined counts to the function that it is in.
PHASES = [
    ("wall columns", r"render::(walls::(shade|column|batch|decals)|textures)"),
    ("colours", r"render::(output|colour)"),
    ("planes, sky", r"render::(planes|buffers::visplane)"),
    ("clipping", r"render::(walls::clip|buffers::clip)"),
    ("BSP walk, segs, drawsegs", r"render::(walls|scene|view|buffers::(drawsegs|sectors))"),
    ("sprites, weapon, midtextures", r"render::(sprites|patch|overlay::weapon)"),
    ("columns to rows", r"render::buffers::transpose"),
    ("status bar, rest of a frame", r"render::"),
    ("movers, riders", r"world::(parts|sectors)::(mover|waggle|riders|by_sector|plane_mover|contacts)"),
    ("lights", r"world::(parts|sectors)::light"),
    ("collision, sight", r"world::(motion|parts::(lines|crossing)|combat::hitscan)|map::"),
    ("rest of the world", r"hasard_engine::"),
    ("rules, environment", r"hasard_envs::|step_cost"),
    ("clearing, copying", r"memset|memcpy|memmove"),
    ("everything else", r""),
]
EVENTS = [["Ir"], ["D1mr", "D1mw"], ["Bcm", "Bim"]]


def own_costs(path):
    """The own cost of each function: its name and its counts, in the order of the file's events."""
    names, costs, events = {}, collections.defaultdict(collections.Counter), []
    function, is_call = None, False
    for line in open(path):
        if line.startswith("events:"):
            events = line.split()[1:]
        elif match := re.match(r"(c?)fn=\((\d+)\)(?: (.*))?", line):
            called, number, name = match.groups()
            if name:
                names[number] = name
            if not called:
                function = names[number]
        elif line.startswith("calls="):
            is_call = True
        elif re.match(r"[0-9+*-]", line):
            if not is_call:
                costs[function].update(dict(zip(events, map(int, line.split()[1:]))))
            is_call = False
    return costs


def measure(program, environment, steps, lanes):
    """Counts a step of each phase."""
    with tempfile.NamedTemporaryFile() as out:
        tool = ["valgrind", "--tool=callgrind", "--cache-sim=yes", "--branch-sim=yes", "--toggle-collect=*Worlds*run*"]
        command = [*tool, f"--callgrind-out-file={out.name}", program, environment, str(steps), str(lanes)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        phases = collections.defaultdict(lambda: [0.0] * len(EVENTS))
        for function, counts in own_costs(out.name).items():
            phase = next(name for name, pattern in PHASES if re.search(pattern, function))
            for i, events in enumerate(EVENTS):
                phases[phase][i] += sum(counts[event] for event in events) / steps
        return phases


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("environments", nargs="*", default=DEFAULT)
    parser.add_argument("--steps", type=int, default=2100)
    parser.add_argument("--lanes", type=int, default=4)
    parser.add_argument("--program", default="target/release/examples/step_cost")
    arguments = parser.parse_args()
    columns = [measure(arguments.program, name, arguments.steps, arguments.lanes) for name in arguments.environments]
    short = [re.sub(r"Level(\d).*", r"\1", name) for name in arguments.environments]
    cell = lambda counts: f"{counts[0] / 1000:.1f} / {counts[1]:.0f} / {counts[2]:.0f}"
    print("| phase | " + " | ".join(short) + " |")
    print("|---|" + "---:|" * len(short))
    for name, _ in PHASES:
        print(f"| {name} | " + " | ".join(cell(column[name]) for column in columns) + " |")
    totals = [[sum(counts[i] for counts in column.values()) for i in range(len(EVENTS))] for column in columns]
    print("| **all** | " + " | ".join(cell(total) for total in totals) + " |")


if __name__ == "__main__":
    main()
