#!/usr/bin/env python3
"""Two builds of the example step_cost in turn: ab.py A B [-r ROUNDS] [-s STEPS] [-l LANES] ENVIRONMENT...

A and B are programs, each perhaps after settings such as HASARD_SIMD=avx2. Prints the median ratio of the processor time
of a step of A to that of B: above 1, B is faster. One ratio scatters by a quarter on a shared machine, the median of 11
rounds by some per cent. First both print their fingerprints: different work is not compared.
"""

import argparse
import os
import statistics
import subprocess


def run(command, *arguments):
    *settings, program = command.split()
    environment = os.environ | dict(setting.split("=", 1) for setting in settings)
    done = subprocess.run([program, *arguments], env=environment, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a")
    parser.add_argument("b")
    parser.add_argument("environments", nargs="+")
    parser.add_argument("-r", "--rounds", type=int, default=11)
    parser.add_argument("-s", "--steps", default="3000")
    parser.add_argument("-l", "--lanes", default="8")
    given = parser.parse_args()
    ratios_of_all = []
    for environment in given.environments:
        same = [run(program, environment, "300", "2", "hash") for program in (given.a, given.b)]
        if same[0] != same[1]:
            raise SystemExit(f"{given.a} and {given.b} do different work: {same[0]} and {same[1]}")
        times = ([], [])
        for turn in range(given.rounds):
            for which in ((0, 1), (1, 0))[turn % 2]:
                program = (given.a, given.b)[which]
                printed = run(program, environment, given.steps, given.lanes, "observe", "400")
                times[which].append(float(printed.split()[0]))
        ratios = [a / b for a, b in zip(*times)]
        ratios_of_all.append(statistics.median(ratios))
        print(
            f"{environment:28} median ratio {ratios_of_all[-1]:.2f} ({min(ratios):.2f} to {max(ratios):.2f}),"
            f" least times {min(times[0]) / 1000:.1f} and {min(times[1]) / 1000:.1f} us",
            flush=True,
        )
    print(f"geometric mean of the medians {statistics.geometric_mean(ratios_of_all):.3f}")


if __name__ == "__main__":
    main()
