"""The console script `hasard`: the whole program, as `cargo install` gives it, and work on clusters.

`hasard sweep ... --on ray[:ADDRESS]` and `--on slurm` hand each run to a cluster: see `hasard_rs.clusters`.
`hasard train ... --workers N --on ray[:ADDRESS]` shares one run out to N workers: see `hasard_rs.ray`.
"""

from __future__ import annotations

import os
import signal
import sys

from hasard_rs import _core


def main(words: list[str] | None = None) -> int:
    """Runs the program with these words (the command line's, if None). Returns its exit code: 0 fine, 1 a negative result, 2 bad input."""
    words = sys.argv[1:] if words is None else words
    if words[:1] == ["sweep"] and _has(words, "--on"):
        from hasard_rs.clusters import sweep_on

        return sweep_on(*_taken(words, "--on"))
    if words[:1] == ["train"] and (_has(words, "--on") or _has(words, "--workers")):
        return train_on(words[1:])
    # The program ends at Ctrl-C, or with a checkpoint where it trains, whatever Python would do.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    script = os.path.abspath(sys.argv[0])
    if os.access(script, os.X_OK) and not script.endswith(".py"):
        os.environ.setdefault("HASARD_PROGRAM", script)
    return int(_core.main(["hasard", *words]))


def train_on(words: list[str]) -> int:
    """Does `hasard train ... --workers N --on ray[:ADDRESS]`, whose `words` come after `train`.

    Returns 0 when the run has ended, 1 when workers were lost for good, 2 for bad input, 130 after Ctrl-C; it raises nothing.
    """
    from hasard_rs.errors import HasardError, InvalidOption
    from hasard_rs.progress import Bar

    try:
        place, words = _taken(words, "--on")
        workers, words = _taken(words, "--workers")
        where, _, address = place.partition(":")
        if where != "ray":
            raise InvalidOption(f"--on '{place}': give ray or ray:ADDRESS, with --workers N")
        if not workers.isdecimal():
            raise InvalidOption(f"--workers '{workers}': give a number of workers, with --on ray")
        from hasard_rs.ray_training import train_words

        with Bar() as bar:
            run = train_words([*words, *["--quiet"] * ("--quiet" not in words)], int(workers), address=address or None, callback=bar.show)
        print(f"{run.directory} is a run directory: hasard eval {run.directory}, hasard report {run.directory}", file=sys.stderr)
    except (ImportError, InvalidOption) as error:
        print(f"hasard: {error}", file=sys.stderr)
        return 2
    except HasardError as error:
        print(f"hasard: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


def _has(words: list[str], flag: str) -> bool:
    return any(word == flag or word.startswith(f"{flag}=") for word in words)


def _taken(words: list[str], flag: str) -> tuple[str, list[str]]:
    """A flag's value, and the words without both."""
    for at, word in enumerate(words):
        if word.startswith(f"{flag}="):
            return word.partition("=")[2], [*words[:at], *words[at + 1 :]]
        if word == flag and at + 1 < len(words):
            return words[at + 1], [*words[:at], *words[at + 2 :]]
    return "", words


if __name__ == "__main__":
    sys.exit(main())
