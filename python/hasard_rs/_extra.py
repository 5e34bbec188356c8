"""How adapters ask for their library."""

from __future__ import annotations

import importlib
from typing import Any


def need(library: str, extra: str, adapter: str) -> Any:
    """Imports a library, or says how to get it."""
    try:
        return importlib.import_module(library)
    except ImportError as missing:
        raise ImportError(f"hasard_rs.{adapter} needs {library}: pip install '.[{extra}]' in the clone of hasard ({missing})") from missing
