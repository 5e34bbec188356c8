"""The numbers in an event: what happened, to which thing, and what did it. With `infos="events"` each step's info has them all."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from typing import Any

import numpy as np


class Events:
    """What happened in one step of one environment: a structured array, `array`, and all that an array has.

    It is no array itself because Gymnasium's batches put arrays of all environments into one, in which those of different lengths have no place.
    Of anything else they keep one an environment.
    """

    __slots__ = ("array",)

    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.array, name)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.array, dtype=dtype) if copy else np.asarray(self.array, dtype=dtype)

    def __getitem__(self, key: Any) -> Any:
        return self.array[key]

    def __len__(self) -> int:
        return len(self.array)

    def __iter__(self) -> Iterator[Any]:
        return iter(self.array)

    def __repr__(self) -> str:
        return f"Events({self.array!r})"

    def __eq__(self, other: object) -> Any:
        return self.array == (other.array if isinstance(other, Events) else other)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return Events, (self.array,)


class Event(enum.IntEnum):
    """What happened: the field `kind` of an event."""

    PICKUP = 0
    DAMAGE = 1
    DEATH = 2
    LANDING = 3
    SHOT = 4


class Cause(enum.IntEnum):
    """What hurt: the field `cause` of an event."""

    FLOOR = 0
    FALL = 1
    BULLET = 2
    ROCKET = 3
    BLAST = 4
    BARREL = 5
    SCRIPT = 6


class Thing(enum.IntEnum):
    """Every thing: the fields `what` and `by` of an event."""

    Player = 0
    HealthBonus = 1
    Stimpack = 2
    Medikit = 3
    ArmorBonus = 4
    RocketAmmo = 5
    Shell = 6
    Cell = 7
    Clip = 8
    Infrared = 9
    BlurSphere = 10
    Allmap = 11
    Backpack = 12
    RadSuit = 13
    YellowCard = 14
    BlueSkull = 15
    Pistol = 16
    Shotgun = 17
    SuperShotgun = 18
    Chaingun = 19
    RocketLauncher = 20
    PlasmaRifle = 21
    Bfg9000 = 22
    Cacodemon = 23
    ZombieMan = 24
    ShotgunGuy = 25
    ChaingunGuy = 26
    DoomImp = 27
    Demon = 28
    Revenant = 29
    LostSoul = 30
    ExplosiveBarrel = 31
    Rocket = 32
    RocketSmokeTrail = 33
    PlasmaBall = 34
    BfgBall = 35
    BulletPuff = 36
    Blood = 37
    TechLamp = 38
    TechLamp2 = 39
    ShortRedColumn = 40
    ShortGreenColumn = 41
    HeartColumn = 42
    TechPillar = 43
    TorchTree = 44
    Stalagtite = 45
    BigTree = 46
    Gibs = 47
    GibbedMarine = 48
    SmallBloodPool = 49
    BrainStem = 50
    PatrolPoint = 51
    DeadMarine = 52
    DeadZombieMan = 53
    DeadShotgunGuy = 54
    Candlestick = 55
    ShortBlueTorch = 56
    ShortGreenTorch = 57
    ShortRedTorch = 58
    ColonGibs = 59
    BurningTop = 60
    BurningDebris = 61
