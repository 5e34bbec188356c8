"""CollateralDamage under its published class name."""

from __future__ import annotations

from typing import Any

from hasard_rs.env import Env


class CollateralDamage(Env):
    """`Env` with this scenario; the level is 1 unless given, arguments are those of `help(hasard_rs.Env)`."""

    def __init__(self, level: int = 1, **arguments: Any) -> None:
        super().__init__(scenario="CollateralDamage", level=level, **arguments)
