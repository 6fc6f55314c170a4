"""A lathe with the Jog page open, and one whose slides have to be homed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from tests.screen.hands import LIMIT
from tests.screen.jog.bench import JogBench, bench_on, opened


def _open(qtbot: QtBot, folder: Path, *, absolute: bool = True, **more: bool) -> Iterator[JogBench]:
    bench = bench_on(folder, absolute=absolute, **more)
    qtbot.waitExposed(bench.window, timeout=LIMIT)
    opened(bench)
    yield bench
    bench.window.close_silently()
    bench.desk.close()
    bench.store.close()


@pytest.fixture
def jog(qtbot: QtBot, tmp_path: Path) -> Iterator[JogBench]:
    yield from _open(qtbot, tmp_path)


@pytest.fixture
def lost(qtbot: QtBot, tmp_path: Path) -> Iterator[JogBench]:
    yield from _open(qtbot, tmp_path, absolute=False)


@pytest.fixture
def no_c(qtbot: QtBot, tmp_path: Path) -> Iterator[JogBench]:
    yield from _open(qtbot, tmp_path, with_c=False)


@pytest.fixture
def wheeled(qtbot: QtBot, tmp_path: Path) -> Iterator[JogBench]:
    """A lathe with a handwheel; its station is the screen's, so the wheel is drawn."""
    yield from _open(qtbot, tmp_path, wheel=True)


@pytest.fixture
def setter(qtbot: QtBot, tmp_path: Path) -> Iterator[JogBench]:
    """A lathe with a tool setter, jog buttons beside its slides, and a tool."""
    yield from _open(qtbot, tmp_path, setter=True)
