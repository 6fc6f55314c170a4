"""The page on the executor and the simulated lathe, on a clock that the test moves."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtTest import QTest

from app.desk.desk import Desk
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.main_window import MainWindow
from core.executor.snapshot import MachineState
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
    window = MainWindow(ScreenTheme(DARK_PALETTE))
    window.resize(1024, 600)
    window.show_model(stage.desk)
    window.show()
    yield window
    window.close_silently()


def reaches(stage: Stage, state: MachineState) -> None:
    stage.tick(lambda: stage.desk.read_snapshot().state is state)


def both_palms(window: MainWindow) -> None:
    QTest.keyPress(window, Key.Key_F11)
    QTest.keyPress(window, Key.Key_F12)


def let_go(window: MainWindow) -> None:
    QTest.keyRelease(window, Key.Key_F11)
    QTest.keyRelease(window, Key.Key_F12)


def cycle_start(stage: Stage, window: MainWindow, state: MachineState) -> None:
    """Press both, wait until it shows, let go; the relay wants both up before it works again."""
    both_palms(window)
    reaches(stage, state)
    let_go(window)
    later = stage.clock.now() + 0.5
    stage.tick(lambda: stage.clock.now() >= later)


def test_cycle_start_hold_resume_single_block_estop_and_recovery(stage: Stage, window: MainWindow) -> None:
    stage.start()
    stage.tick(lambda: stage.desk.read_snapshot().line > 6)
    QTest.keyClick(window, Key.Key_H)
    reaches(stage, MachineState.HOLD)
    held = stage.desk.read_snapshot().actual
    later = stage.clock.now() + 1.0
    stage.tick(lambda: stage.clock.now() >= later)
    assert stage.desk.read_snapshot().actual == pytest.approx(held, abs=0.01)
    cycle_start(stage, window, MachineState.RUN)
    QTest.keyClick(window, Key.Key_S)
    reaches(stage, MachineState.SINGLE_BLOCK_STOP)
    QTest.keyClick(window, Key.Key_E)
    reaches(stage, MachineState.ESTOP)
    assert stage.desk.read_snapshot().rpm_command == 0.0
    twist_out(window)
    reaches(stage, MachineState.DISABLED)
    QTest.keyClick(window, Key.Key_D)
    reaches(stage, MachineState.IDLE)


def test_one_palm_button_does_not_start_lathe(stage: Stage, window: MainWindow) -> None:
    stage.start()
    QTest.keyClick(window, Key.Key_H)
    reaches(stage, MachineState.HOLD)
    QTest.keyPress(window, Key.Key_F11)
    later = stage.clock.now() + 1.0
    stage.tick(lambda: stage.clock.now() >= later)
    QTest.keyPress(window, Key.Key_F12)
    later = stage.clock.now() + 0.5
    stage.tick(lambda: stage.clock.now() >= later)
    assert stage.desk.read_snapshot().state is MachineState.HOLD
    let_go(window)


def test_start_with_drives_off_is_rejected_with_reason(stage: Stage, window: MainWindow) -> None:
    desk: Desk = stage.desk
    later = stage.clock.now() + 0.1  # a start that is on when the control begins to look is no press
    stage.tick(lambda: stage.clock.now() >= later)
    reaches(stage, MachineState.DISABLED)
    both_palms(window)
    stage.tick(lambda: desk.read_snapshot().start_refusal_reason != "", 2.0)
    let_go(window)
    window.refresh()
    assert begins(desk.prompt_notice, "screen.no-start", why=pattern("screen.drives-off-reason"))
    assert desk.read_snapshot().state is MachineState.DISABLED
