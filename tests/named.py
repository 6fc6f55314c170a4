"""The tests that a document names, as ``folder/file.py::test``: whether they exist, and whether they ran."""

from __future__ import annotations

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
SAFETY = ROOT / "docs" / "safety.md"
LATE = ROOT / "docs" / "late.md"
NAMED = re.compile(r"`([\w/]+\.py)::(\w+)`")
_FOLDERS = (ROOT / "tests", ROOT / "tests" / "drivers")


def named_in(text: str) -> list[tuple[str, str]]:
    """(file, test) of every reference in a text, each once, but those of features that are left out."""
    return sorted({(file, test) for file, test in NAMED.findall(text) if not is_left_out(file)})


def all_named() -> str:
    """The text of both documents whose tests must run: of hazards, and of late, stopped or killed parts."""
    return "\n".join(page.read_text(encoding="utf-8") for page in (SAFETY, LATE))


def is_left_out(path: str) -> bool:
    """Return whether a path belongs to an optional feature whose folders are deleted."""
    name = re.search(r"\bextras/(\w+)", path)
    return name is not None and not (ROOT / "app" / "extras" / name.group(1)).exists()


def file_of(file: str) -> Path | None:
    """Where a file lies that is named from ``tests`` or from ``tests/drivers``; None: nowhere."""
    return next((folder / file for folder in _FOLDERS if (folder / file).is_file()), None)


def functions_of(file: Path) -> set[str]:
    """Names of the test functions of a file, those of its classes too."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


def not_run(text: str, passed: set[str]) -> list[str]:
    """References of a text of which no case passed; ``passed``: pytest's names, without parameters."""
    return [
        f"{file}::{test}"
        for file, test in named_in(text)
        if (found := file_of(file)) is None
        or not any(
            name.startswith(f"{found.relative_to(ROOT).as_posix()}::") and name.endswith(f"::{test}")
            for name in passed
        )
    ]
