"""A line that shows how far a training is."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Any, TextIO


class Bar:
    """Shows reports on one line of a terminal, each over the one before; says nothing where nobody looks.

    Args:
        frames: of the whole run, where they are known.
        to: the terminal; None: standard error.
    """

    def __init__(self, frames: int | None = None, to: TextIO | None = None) -> None:
        self.frames = frames
        self.to = sys.stderr if to is None else to
        self.seen = self.to.isatty()
        self.shown = False

    def show(self, report: dict[str, Any]) -> bool:
        """Shows a report, a dict as callbacks of `train` get it. Returns False: it never ends the run."""
        if self.seen:
            self.to.write(f"\r\x1b[K{self.line(report)}")
            self.to.flush()
            self.shown = True
        return False

    def line(self, report: dict[str, Any]) -> str:
        """Returns a report in a line: the share that is done where it is known, frames, means of return and cost, frames a second."""
        done = report["frames"]
        parts = [f"{done:,} frames"]
        if self.frames:
            filled = min(20, 20 * done // self.frames)
            parts.insert(0, f"[{'#' * filled}{'.' * (20 - filled)}] {100 * done // self.frames} %")
        for name, what in (("return_mean", "return"), ("cost_mean", "cost")):
            if report.get(name) is not None:
                parts.append(f"{what} {report[name]:.2f}")
        parts.append(f"{report['fps']:,.0f}/s")
        if self.frames and report["fps"] > 0:
            left = int((self.frames - done) / report["fps"])
            parts.append(f"{left // 3600}:{left // 60 % 60:02}:{left % 60:02} left")
        return "  ".join(parts)

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_exception: type[BaseException] | BaseException | TracebackType | None) -> None:
        if self.shown:
            self.to.write("\n")
            self.to.flush()
