"""An operator with programs of his own and an archive that remembers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from tests.editor.shop import Memory
from tests.screen.desks import SAMPLES, desk_on
from tests.screen.editor.writer import Writer
from tests.screen.fake import FakeMachine
from tests.screen.hands import window_on


@pytest.fixture
def memory() -> Memory:
    """The archive."""
    return Memory()


@pytest.fixture
def writer(qtbot: QtBot, machine: FakeMachine, memory: Memory, tmp_path: Path) -> Iterator[Writer]:
    """In front of an open desk whose own programs are in a temporary folder."""
    desk = desk_on(machine, tmp_path, SAMPLES, archive=memory)
    with window_on(qtbot, desk, machine) as window:
        yield Writer(qtbot, window, desk, machine)
