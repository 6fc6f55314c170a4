"""Rooms with PINs, and PINs that take no time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from core.extras.access import pins
from tests.cli.conftest import filled, refusals, turndesk
from tests.cli.say import home, say
from tests.desk.levels_room import opened_room
from tests.extras.access.pin_room import PinRoom

__all__ = ["filled", "home", "refusals", "say", "turndesk"]


@pytest.fixture(autouse=True)
def _cheap_pins(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hash PINs at a cost that takes no time."""
    monkeypatch.setattr(pins, "DEFAULT_COST", pins.ScryptCost(4, 8, 1))


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[PinRoom]:
    """A desk with an empty store."""
    with opened_room(tmp_path, monkeypatch, PinRoom) as made:
        yield made
