"""What several tests use."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

SMALL = {"resolution": "64x48"}


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--full", action="store_true", help="counts that take an hour: every id for 1,000 steps, 5 million steps, 1,000 constructions")


@pytest.fixture
def full(request: pytest.FixtureRequest) -> bool:
    """Whether the counts are to be those that take long."""
    return bool(request.config.getoption("--full"))


def assert_same(a: Any, b: Any, where: str = "") -> None:
    """Equal to the bit, types and dtypes too; names the first place that differs."""
    assert type(a) is type(b), f"{where}: {type(a)} and {type(b)}"
    if isinstance(a, dict):
        assert a.keys() == b.keys(), f"{where}: {sorted(a)} and {sorted(b)}"
        for key in a:
            assert_same(a[key], b[key], f"{where}.{key}")
    elif isinstance(a, np.ndarray) and a.dtype == object:
        for i, (one, other) in enumerate(zip(a, b, strict=True)):
            assert_same(one, other, f"{where}[{i}]")
    elif isinstance(a, np.ndarray):
        assert a.dtype == b.dtype and a.shape == b.shape, f"{where}: {a.dtype} {a.shape} and {b.dtype} {b.shape}"
        assert np.array_equal(a, b), f"{where}: {a[a != b][:5]} and {b[a != b][:5]}"
    elif isinstance(a, (list, tuple)):
        assert len(a) == len(b), where
        for i, (one, other) in enumerate(zip(a, b, strict=True)):
            assert_same(one, other, f"{where}[{i}]")
    else:
        assert a == b, f"{where}: {a} and {b}"


@pytest.fixture
def small() -> dict[str, Any]:
    return dict(SMALL)
