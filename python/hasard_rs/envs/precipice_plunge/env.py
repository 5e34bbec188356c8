"""PrecipicePlunge under its published class name."""

from __future__ import annotations

from typing import Any

from hasard_rs.env import Env


class PrecipicePlunge(Env):
    """`Env` with this scenario; the level is 1 unless given, arguments are those of `help(hasard_rs.Env)`."""

    def __init__(self, level: int = 1, **arguments: Any) -> None:
        super().__init__(scenario="PrecipicePlunge", level=level, **arguments)
