"""The console script `hasard`: the whole program, as `cargo install` gives it, and sweeps on clusters.

`hasard sweep ... --on ray[:ADDRESS]` and `--on slurm` hand each run to a cluster: see `hasard_rs.clusters`.
"""

from __future__ import annotations

import os
import signal
import sys

from hasard_rs import _core


def main(words: list[str] | None = None) -> int:
    """Runs the program with these words (the command line's, if None) and gives its exit code."""
    words = sys.argv[1:] if words is None else words
    if words[:1] == ["sweep"] and "--on" in words:
        from hasard_rs.clusters import sweep_on

        at = words.index("--on")
        place = words[at + 1] if at + 1 < len(words) else ""
        return sweep_on(place, [*words[:at], *words[at + 2 :]])
    # The program ends at Ctrl-C, or with a checkpoint where it trains, whatever Python would do.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    script = os.path.abspath(sys.argv[0])
    if os.access(script, os.X_OK) and not script.endswith(".py"):
        os.environ.setdefault("HASARD_PROGRAM", script)
    return int(_core.main(["hasard", *words]))


if __name__ == "__main__":
    sys.exit(main())
