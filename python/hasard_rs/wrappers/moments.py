"""Moments of wrapped environments: what wrappers know of the episode goes along with the environment's own bytes."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from typing import Any

import gymnasium
from gymnasium.wrappers import OrderEnforcing, TimeLimit

from hasard_rs.errors import InvalidOption

_VERSION = 1
# What Gymnasium's wrappers know of an episode; the others that its `make` adds know nothing.
_KEPT: tuple[tuple[type[Any], str], ...] = ((OrderEnforcing, "_has_reset"), (TimeLimit, "_elapsed_steps"))


def save(wrapper: gymnasium.Wrapper[Any, Any, Any, Any], *own: float) -> bytes:
    """Returns a moment: the wrapper's own numbers, those of Gymnasium's wrappers below it, and what `save` of the environment gives.

    Raises AttributeError for an environment that has no `save`, and what that raises.
    """
    # None, of steps before a reset, is -1.
    numbers = [*own, *(-1 if getattr(env, name) is None else getattr(env, name) for env, name in _between(wrapper))]
    rest = struct.pack(f"<{len(numbers)}d", *numbers) + wrapper.env.get_wrapper_attr("save")()
    return _head(wrapper) + struct.pack("<I", zlib.crc32(rest)) + rest


def load(wrapper: gymnasium.Wrapper[Any, Any, Any, Any], state: bytes, count: int) -> tuple[Any, list[float]]:
    """Comes back to a moment that `save` gave of a wrapper made alike.

    Args:
        wrapper: whose.
        state: the moment.
        count: of the wrapper's own numbers.

    Returns:
        The observation, and the wrapper's own numbers.

    Raises:
        InvalidOption for bytes that are spoiled, or of something else; TypeError for what is no bytes. Nothing has changed then.
    """
    if not isinstance(state, bytes):
        raise TypeError(f"a saved moment must be bytes, got {type(state).__name__}")
    head, below = _head(wrapper), list(_between(wrapper))
    form = f"<{count + len(below)}d"
    start = len(head) + 4
    rest = state[start:]
    if not state.startswith(head) or len(rest) < struct.calcsize(form) or state[len(head) : start] != struct.pack("<I", zlib.crc32(rest)):
        name = type(wrapper).__name__
        raise InvalidOption(f"state cannot be these bytes, which are no moment of this {name}, or spoiled; give what save of one made alike gave")
    numbers = struct.unpack_from(form, rest)
    observation = wrapper.env.get_wrapper_attr("load")(rest[struct.calcsize(form) :])
    for (env, name), number in zip(below, numbers[count:], strict=True):
        setattr(env, name, bool(number) if name == "_has_reset" else None if number < 0 else int(number))
    return observation, list(numbers[:count])


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
