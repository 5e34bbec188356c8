#!/usr/bin/env python3
"""Two builds of the example step_cost beside each other (Linux): ab.py A B [-r ROUNDS] [-s STEPS] [-l LANES] [--maps] ENVIRONMENT...

A and B are programs, each perhaps after settings such as HASARD_SIMD=avx2. Prints the median ratio of the processor time
of a step of A to that of B: above 1, B is faster. Both run on one core in turns of 20 ms, one stopped while the other runs:
whatever else the machine does meets both alike. On a shared machine whose speed changed by half within a minute such ratios
scattered by 1 to 2 %, those of whole runs in turn by 20. First both print their fingerprints: different work is not compared.
"""

import argparse
import os
import signal
import statistics
import subprocess
import time

TURN = 0.02


def start(command, *arguments):
    *settings, program = command.split()
    environment = os.environ | dict(setting.split("=", 1) for setting in settings)
    return subprocess.Popen([program, *arguments], env=environment, stdout=subprocess.PIPE, text=True)


def printed(process):
    text, _ = process.communicate()
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(process.args)} ended with status {process.returncode}")
    return text.strip()


def side_by_side(commands, arguments):
    """Processor time of a step of each, nanoseconds."""
    processes = [start(command, *arguments) for command in commands]
    try:
        for process in processes:
            process.send_signal(signal.SIGSTOP)
        while any(process.poll() is None for process in processes):
            for process in processes:
                if process.poll() is None:
                    process.send_signal(signal.SIGCONT)
                    end = time.monotonic() + TURN
                    while time.monotonic() < end and process.poll() is None:
                        time.sleep(TURN / 4)
                    process.send_signal(signal.SIGSTOP)
    finally:
        for process in processes:
            process.send_signal(signal.SIGCONT)
    return [float(printed(process).split()[0]) for process in processes]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a")
    parser.add_argument("b")
    parser.add_argument("environments", nargs="+")
    parser.add_argument("-r", "--rounds", type=int, default=3)
    parser.add_argument("-s", "--steps", default="60000")
    parser.add_argument("-l", "--lanes", default="32")
    parser.add_argument("--maps", action="store_true", help="the published maps and pictures")
    given = parser.parse_args()
    worlds = ["--maps"] if given.maps else []
    # The two must share a core, or nothing would be in turn; this program sleeps.
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    ratios_of_all = []
    for environment in given.environments:
        same = [printed(start(program, environment, "300", "2", "hash", "0", *worlds)) for program in (given.a, given.b)]
        if same[0] != same[1]:
            raise SystemExit(f"{given.a} and {given.b} do different work: {same[0]} and {same[1]}")
        times = []
        for turn in range(given.rounds):
            # Either begins every other time.
            order = 1 if turn % 2 == 0 else -1
            arguments = (environment, given.steps, given.lanes, "observe", "400", *worlds)
            times.append(side_by_side((given.a, given.b)[::order], arguments)[::order])
        ratios = [a / b for a, b in times]
        ratios_of_all.append(statistics.median(ratios))
        least = [min(column) / 1000 for column in zip(*times)]
        print(
            f"{environment:28} median ratio {ratios_of_all[-1]:.3f} ({min(ratios):.3f} to {max(ratios):.3f}),"
            f" least times {least[0]:.1f} and {least[1]:.1f} us",
            flush=True,
        )
    print(f"geometric mean of the medians {statistics.geometric_mean(ratios_of_all):.3f}")


if __name__ == "__main__":
    main()
