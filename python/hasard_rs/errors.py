"""Exceptions of this package; the compiled part raises them too.

Each is also one of Python's own, so that code that knows nothing of this package catches what it expects.
"""

from __future__ import annotations

try:
    from gymnasium.error import ResetNeeded as _GymnasiumResetNeeded
except ImportError:  # Gymnasium is not needed for Worlds.
    _GymnasiumResetNeeded = RuntimeError  # type: ignore[assignment,misc]


class HasardError(Exception):
    """Base of all exceptions of this package."""


class UnknownEnvironment(HasardError, ValueError):
    """No environment has this id; the message names the nearest one."""


class InvalidOption(HasardError, ValueError):
    """An argument has a value that it cannot take; the message says which it can."""


class InvalidAction(HasardError, ValueError):
    """An action is outside of the action space; no world has moved."""


class InvalidMap(HasardError, ValueError):
    """A map cannot be built or played in."""


class OutOfTurn(HasardError, RuntimeError):
    """A call came when it could not be done, such as `recv` before `send`, or worlds used after a fork."""


class ResetNeeded(OutOfTurn, _GymnasiumResetNeeded):
    """A step of an episode that is over or has not begun; also `gymnasium.error.ResetNeeded`."""


class WorldPanicked(HasardError, RuntimeError):
    """A fault of this package; the object is closed, please report it."""


class Closed(HasardError, RuntimeError):
    """The object was closed before."""


__all__ = [
    "Closed",
    "HasardError",
    "InvalidAction",
    "InvalidMap",
    "InvalidOption",
    "OutOfTurn",
    "ResetNeeded",
    "UnknownEnvironment",
    "WorldPanicked",
]
