"""The status file of a running desk."""

from __future__ import annotations

import json
import threading
from pathlib import Path

from app.compose.screen_desk import build_desk
from tests.cli.conftest import home

__all__ = ["home"]


def writers() -> int:
    return sum(thread.name == "status" for thread in threading.enumerate())


def test_the_screen_program_writes_its_status_from_its_start_to_its_end(home: Path) -> None:
    desk = build_desk()
    assert writers() == 1
    desk.close()
    assert writers() == 0
    status = json.loads((home / "status.json").read_text())
    assert (status["machine"], status["available"]) == ("GT-75", False)  # the control has ended


def test_a_store_that_another_has_leaves_its_status_alone(home: Path) -> None:
    first = build_desk()
    try:
        second = build_desk()
        try:
            assert writers() == 1
        finally:
            second.close()
        assert writers() == 1
    finally:
        first.close()
