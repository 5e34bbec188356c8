"""The numbers in an event: what happened, to which thing, and what did it. With `infos="events"` each step's info has an array of them."""

from __future__ import annotations

import enum

from hasard_rs import _core

_NAMES = _core.event_names()

Event = enum.IntEnum("Event", {name.upper(): number for name, number in _NAMES["kinds"].items()})  # type: ignore[misc]
Event.__doc__ = "What happened: PICKUP, DAMAGE, DEATH, LANDING or SHOT, the field `kind` of an event."

Thing = enum.IntEnum("Thing", _NAMES["things"])  # type: ignore[misc]
Thing.__doc__ = "Every thing by its name, such as HealthBonus, Player or Zombieman: the fields `what` and `by` of an event."

Cause = enum.IntEnum("Cause", {name.upper(): number for name, number in _NAMES["causes"].items()})  # type: ignore[misc]
Cause.__doc__ = "What hurt: FLOOR, FALL, BULLET, ROCKET, BLAST, BARREL or SCRIPT, the field `cause` of an event."
