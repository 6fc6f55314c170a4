"""Pictures of the forms of shapes and calculators."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.runs.journal import Journal
from app.desk.desk import Desk
from app.screen.page_base import Page

SCENES = (
    ("shapes", 'F3 Shapes R "1/2 Enter Enter Enter ".5', "editor"),
    ("calculators", 'F3 Calculators T ".5 Enter "1 Enter "1', "shapes"),
)


def prepare(_desk: Desk, _journal: Journal, _folder: Path) -> None:
    """Nothing: the forms need no files."""


def settle(_page: Page | None, _wait: Callable[[], None]) -> None:
    """Wait for nothing: a form shows at once what it makes."""
