"""`help()` answers: every public name says what it takes, what it returns and what it raises. Read from the source, so that no adapter's library
is needed; the compiled part is asked itself, beside its stub."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import hasard_rs
from hasard_rs import _core

FOLDER = Path(hasard_rs.__file__).parent
MODULES = sorted(path for path in FOLDER.rglob("*.py") if path.name == "__init__.py" or not path.name.startswith("_"))
Function = ast.FunctionDef | ast.AsyncFunctionDef
PROTOCOL = {"__enter__", "__exit__", "__len__", "__repr__", "__getstate__", "__setstate__"}


def lacks(where: str, text: str, names: list[str], returns: bool, raises: bool) -> list[str]:
    """What a docstring does not say."""
    if not text.strip():
        return [f"{where}: no docstring"]
    unsaid = [f"{where}: argument {name}" for name in names if not re.search(rf"\b{name}\b", text)]
    unsaid += [f"{where}: what it returns"] * (returns and not re.search(r"\b[Rr]eturns\b", text))
    return unsaid + [f"{where}: what it raises"] * (raises and not re.search(r"\b[Rr]aises\b", text))


def names_of(function: Function) -> list[str]:
    given = function.args
    every = [*given.posonlyargs, *given.args, *given.kwonlyargs, *([given.kwarg] if given.kwarg else []), *([given.vararg] if given.vararg else [])]
    return [one.arg for one in every if one.arg not in ("self", "cls") and not one.arg.startswith("_")]


def decorated(function: Function, name: str) -> bool:
    return any(ast.unparse(one).endswith(name) for one in function.decorator_list)


def gives(function: Function) -> bool:
    """Whether it gives something; a property's docstring is what it gives."""
    return not decorated(function, "property") and function.returns is not None and ast.unparse(function.returns) not in ("None", "NoReturn")


def raises(function: Function) -> bool:
    """Whether the function itself raises, beside what abstract methods and its inner functions do."""
    inner = {node for one in ast.walk(function) if isinstance(one, Function) and one is not function for node in ast.walk(one)}
    found = [node for node in ast.walk(function) if isinstance(node, ast.Raise) and node not in inner and node.exc is not None]
    return any("NotImplementedError" not in ast.unparse(node) for node in found)


def functions(module: ast.Module, name: str) -> Iterator[tuple[str, Function, str]]:
    """Public functions and methods of a module, with the docstring that help() shows for each: the base's where a class is derived from one here."""
    classes = {node.name: node for node in module.body if isinstance(node, ast.ClassDef)}

    def doc(node: ast.ClassDef, method: str | None = None) -> str:
        bases = " ".join(doc(classes[base.id], method) for base in node.bases if isinstance(base, ast.Name) and base.id in classes)
        if method is None:
            return f"{ast.get_docstring(node) or ''} {bases}"
        own = [one for one in node.body if isinstance(one, Function) and one.name == method]
        return (ast.get_docstring(own[0]) if own else None) or bases

    for node in module.body:
        if isinstance(node, Function) and not node.name.startswith("_"):
            yield f"{name}.{node.name}", node, ast.get_docstring(node) or ""
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for method in (one for one in node.body if isinstance(one, Function)):
                if method.name == "__init__":
                    yield f"{name}.{node.name}", method, doc(node)
                elif not method.name.startswith("_"):
                    yield f"{name}.{node.name}.{method.name}", method, doc(node, method.name)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(FOLDER).as_posix())
def test_modules_say_it_all(path: Path) -> None:
    module = ast.parse(path.read_text())
    assert ast.get_docstring(module), "the module has no docstring"
    unsaid = [f"class {node.name}: no docstring" for node in module.body if isinstance(node, ast.ClassDef) and not ast.get_docstring(node)]
    for where, function, text in functions(module, path.stem):
        unsaid += lacks(where, text, names_of(function), gives(function), raises(function))
    assert not unsaid, "\n".join(unsaid)


def test_the_compiled_part_says_it_all() -> None:
    stub = ast.parse((FOLDER / "_core.pyi").read_text())
    unsaid = []

    def check(where: str, function: Function, found: Any) -> None:
        unsaid.extend(lacks(where, found.__doc__ or "", names_of(function), gives(function), False))

    for node in stub.body:
        if isinstance(node, ast.FunctionDef):
            check(node.name, node, getattr(_core, node.name))
        elif isinstance(node, ast.ClassDef):
            kind = getattr(_core, node.name)
            for method in (one for one in node.body if isinstance(one, ast.FunctionDef) and one.name not in PROTOCOL):
                where = f"{node.name}.{method.name}"
                if method.name == "__new__":
                    unsaid.extend(lacks(where, kind.__doc__, names_of(method), False, True))
                elif kind is _core.Batch:
                    unsaid.extend(lacks("Batch", kind.__doc__, [method.name], False, False))
                else:
                    check(where, method, getattr(kind, method.name))
    assert not unsaid, "\n".join(unsaid)


def test_public_names_are_documented() -> None:
    data = {"LEVELS", "__version__"}
    for name in set(hasard_rs.__all__) - data:
        assert (getattr(hasard_rs, name).__doc__ or "").strip(), name
