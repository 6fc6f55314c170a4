"""An operator with programs of his own and an archive that remembers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.screen.look import Look
from app.screen.main_window import MainWindow
from app.screen.theme import DARK
from tests.editor.shop import Memory
from tests.screen.desks import SAMPLES, desk_on
from tests.screen.editor.writer import Writer
from tests.screen.fake import FakeMachine


@pytest.fixture
def memory() -> Memory:
    """The archive."""
    return Memory()


@pytest.fixture
def writer(qtbot: QtBot, machine: FakeMachine, memory: Memory, tmp_path: Path) -> Iterator[Writer]:
    """In front of an open desk whose own programs are in a temporary folder."""
    desk = desk_on(machine, tmp_path, SAMPLES, archive=memory)
    window = MainWindow(Look(DARK))
    window.resize(1024, 600)
    with qtbot.waitExposed(window):
        window.show()
    window.open_desk(desk)
    window.activateWindow()
    yield Writer(qtbot, window, desk, machine)
    machine.idle()
    window.put_away()
    desk.close()
