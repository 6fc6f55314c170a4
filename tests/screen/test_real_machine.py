"""The page on the executor and the simulated lathe, on a clock that the test moves."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtTest import QTest

from app.desk.desk import Desk
from app.screen.look import DARK, Look
from app.screen.window.main_window import MainWindow
from core.executor.snapshot import State
from tests.screen.hands import Key
from tests.screen.pictures import Stage
from tests.screen.yes import twist_out
from tests.texts import begins, pattern


@pytest.fixture
def stage(qapp: object) -> Iterator[Stage]:
    stage = Stage()
    yield stage
    stage.close()


@pytest.fixture
def window(stage: Stage) -> Iterator[MainWindow]:
    window = MainWindow(Look(DARK))
    window.resize(1024, 600)
    window.open_desk(stage.desk)
    window.show()
    yield window
    window.put_away()


def reaches(stage: Stage, state: State) -> None:
    stage.tick(lambda: stage.desk.snapshot().state is state)


def both_palms(window: MainWindow) -> None:
    QTest.keyPress(window, Key.Key_F11)
    QTest.keyPress(window, Key.Key_F12)


def let_go(window: MainWindow) -> None:
    QTest.keyRelease(window, Key.Key_F11)
    QTest.keyRelease(window, Key.Key_F12)


def cycle_start(stage: Stage, window: MainWindow, state: State) -> None:
    """Press both, wait until it shows, let go; the relay wants both up before it works again."""
    both_palms(window)
    reaches(stage, state)
    let_go(window)
    later = stage.clock.now() + 0.5
    stage.tick(lambda: stage.clock.now() >= later)


def test_start_hold_go_on_single_block_estop_recover(stage: Stage, window: MainWindow) -> None:
    stage.start()
    stage.tick(lambda: stage.desk.snapshot().line > 6)
    QTest.keyClick(window, Key.Key_H)
    reaches(stage, State.HOLD)
    held = stage.desk.snapshot().actual
    later = stage.clock.now() + 1.0
    stage.tick(lambda: stage.clock.now() >= later)
    assert stage.desk.snapshot().actual == pytest.approx(held, abs=0.01)
    cycle_start(stage, window, State.RUN)
    QTest.keyClick(window, Key.Key_S)
    reaches(stage, State.BLOCK_END)
    QTest.keyClick(window, Key.Key_E)
    reaches(stage, State.ESTOP)
    assert stage.desk.snapshot().rpm_command == 0.0
    twist_out(window)
    reaches(stage, State.DISABLED)
    QTest.keyClick(window, Key.Key_D)
    reaches(stage, State.IDLE)


def test_one_palm_does_not_start_the_lathe(stage: Stage, window: MainWindow) -> None:
    stage.start()
    QTest.keyClick(window, Key.Key_H)
    reaches(stage, State.HOLD)
    QTest.keyPress(window, Key.Key_F11)
    later = stage.clock.now() + 1.0
    stage.tick(lambda: stage.clock.now() >= later)
    QTest.keyPress(window, Key.Key_F12)
    later = stage.clock.now() + 0.5
    stage.tick(lambda: stage.clock.now() >= later)
    assert stage.desk.snapshot().state is State.HOLD
    let_go(window)


def test_no_start_with_the_drives_off_and_it_is_said(stage: Stage, window: MainWindow) -> None:
    desk: Desk = stage.desk
    later = stage.clock.now() + 0.1  # a start that is on when the control begins to look is no press
    stage.tick(lambda: stage.clock.now() >= later)
    reaches(stage, State.DISABLED)
    both_palms(window)
    stage.tick(lambda: desk.snapshot().start_refused != "", 2.0)
    let_go(window)
    window.refresh()
    assert begins(desk.notice, "screen.no-start", why=pattern("screen.drives-off-reason"))
    assert desk.snapshot().state is State.DISABLED
