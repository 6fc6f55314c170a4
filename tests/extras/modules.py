"""Finds modules of one name in the tests of the optional features that are there."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType


def of_extras(name: str) -> list[ModuleType]:
    """Return the module ``tests.extras.FEATURE.name`` of each feature that has one."""
    folders = sorted(path.parent.name for path in Path(__file__).parent.glob(f"*/{name}.py"))
    return [import_module(f"tests.extras.{folder}.{name}") for folder in folders]
