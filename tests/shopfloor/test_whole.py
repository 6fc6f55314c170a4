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


def test_screen_program_writes_status_from_start_to_end(home: Path) -> None:
    desk = build_desk()
    assert writers() == 1
    desk.close()
    assert writers() == 0
    status = json.loads((home / "status.json").read_text())
    assert (status["machine"], status["available"]) == ("GT-75", False)  # the control has ended


def test_status_of_store_used_by_another_process_is_not_changed(home: Path) -> None:
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
