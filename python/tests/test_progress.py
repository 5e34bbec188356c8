"""The line that shows how far a training is."""

from __future__ import annotations

import io

from hasard_rs.progress import Bar

REPORT = {"frames": 250_000, "fps": 5_000.0, "return_mean": 3.25, "cost_mean": None}


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_sees_one_line_and_nobody_else_sees_any() -> None:
    terminal, file = Terminal(), io.StringIO()
    for to in (terminal, file):
        with Bar(1_000_000, to) as bar:
            assert not bar.show(REPORT) and not bar.show({**REPORT, "frames": 1_000_000})
    assert file.getvalue() == ""
    first, last = terminal.getvalue().split("\r\x1b[K")[1:]
    assert first == "[#####...............] 25 %  250,000 frames  return 3.25  5,000/s  0:02:30 left"
    assert last.startswith("[####################] 100 %") and last.endswith("0:00:00 left\n")


def test_without_a_goal_the_share_is_left_out() -> None:
    assert Bar(None, io.StringIO()).line(REPORT) == "250,000 frames  return 3.25  5,000/s"
