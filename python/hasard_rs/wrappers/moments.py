"""Moments of wrapped environments: what wrappers know of the episode goes along with the environment's own bytes."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any, ClassVar

import gymnasium
from gymnasium.wrappers import OrderEnforcing, TimeLimit

from hasard_rs.errors import InvalidOption
from hasard_rs.infos import checksum

_VERSION = 1
# What Gymnasium's wrappers know of an episode; the others that its `make` adds know nothing.
_KEPT: tuple[tuple[type[Any], str], ...] = ((OrderEnforcing, "_has_reset"), (TimeLimit, "_elapsed_steps"))


class Moments(gymnasium.Wrapper[Any, Any, Any, Any]):
    """A wrapper whose number of the episode, the attribute that `_own` names, is saved and loaded along with the environment."""

    _own: ClassVar[str]

    def save(self) -> bytes:
        """Returns where the environment and this wrapper are, to come back to by `load`. Raises what `Env.save` does."""
        # None, of steps before a reset, is -1.
        below = (-1 if getattr(env, name) is None else getattr(env, name) for env, name in _between(self))
        numbers = [getattr(self, self._own), *below]
        rest = struct.pack(f"<{len(numbers)}d", *numbers) + self.env.get_wrapper_attr("save")()
        return _head(self) + checksum(rest) + rest

    def load(self, state: bytes) -> Any:
        """Comes back to a saved moment, which counts as a reset where one came before it.

        Args:
            state: what `save` gave, of an environment made and wrapped alike.

        Returns:
            The environment's observation of that moment.

        Raises:
            InvalidOption for bytes that are spoiled, or of another environment; TypeError for what is no bytes. Nothing has changed then.
        """
        if not isinstance(state, bytes):
            raise TypeError(f"a saved moment must be bytes, got {type(state).__name__}")
        head, below = _head(self), list(_between(self))
        form = f"<{1 + len(below)}d"
        start = len(head) + 4
        rest = state[start:]
        if not state.startswith(head) or len(rest) < struct.calcsize(form) or state[len(head) : start] != checksum(rest):
            name = type(self).__name__
            raise InvalidOption(f"state cannot be these bytes, which are no moment of this {name}, or spoiled; give what save of one made alike gave")
        own, *numbers = struct.unpack_from(form, rest)
        observation = self.env.get_wrapper_attr("load")(rest[struct.calcsize(form) :])
        for (env, name), number in zip(below, numbers, strict=True):
            setattr(env, name, bool(number) if name == "_has_reset" else None if number < 0 else int(number))
        setattr(self, self._own, own)
        return observation


def _head(wrapper: Any) -> bytes:
    names = ",".join([type(wrapper).__name__, *(name for _, name in _between(wrapper))])
    return f"hasard-rs moment {_VERSION} {names}\n".encode()


def _between(wrapper: Any) -> Iterator[tuple[Any, str]]:
    """Gymnasium's wrappers that know of the episode, down to what saves itself, and the name of what each knows."""
    env = wrapper.env
    while isinstance(env, gymnasium.Wrapper) and not hasattr(type(env), "save"):
        for kind, name in _KEPT:
            if isinstance(env, kind):
                yield env, name
        env = env.env
