"""Whose turn it is in a batch that is stepped in groups: which groups wait for actions, which are under way, and what has come back already."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

Result = tuple[Any, Any, Any, Any, dict[str, Any]]
"""What `step` returns, of a group."""


@dataclass
class Turns:
    """The state of the groups. Each is due, under way or back, or none of them before the first reset.

    Args:
        groups: their number.
        due: groups that were returned to the caller and wait for actions, the one that has waited longest first.
        under_way: groups whose actions were sent.
        back: what `recv` gives of a group without waiting: first observations, or a step that had to be waited for.
        coming: the group that `recv` gives next, round robin.
    """

    groups: int
    due: list[int] = field(default_factory=list)
    under_way: set[int] = field(default_factory=set)
    back: dict[int, Result] = field(default_factory=dict)
    coming: int = 0

    def restart(self, back: dict[int, Result], first: int) -> Result:
        """Has groups begin again, with what is `back` of all but those under way. Returns the result of the `first`, which is due then."""
        self.back = {**self.back, **back}
        self.due, self.coming = [], first
        return self.take()

    def take(self) -> Result:
        """Returns the result of the coming group, which is back and is due then."""
        result = self.back.pop(self.coming)
        self.mark_returned()
        return result

    def mark_returned(self) -> None:
        """Notes that the coming group was returned to the caller."""
        self.due.append(self.coming)
        self.coming = (self.coming + 1) % self.groups
