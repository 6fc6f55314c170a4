"""Finds modules of one name in the tests of the optional features that are there."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType

from app.compose.optional_features import FEATURE_NAMES


def of_extras(name: str) -> list[ModuleType]:
    """Return the module ``tests.extras.FEATURE.name`` of each feature that has one."""
    here = Path(__file__).parent
    found = [feature for feature in FEATURE_NAMES if (here / feature / f"{name}.py").exists()]
    return [import_module(f"tests.extras.{feature}.{name}") for feature in found]
