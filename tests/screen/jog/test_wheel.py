"""The handwheel by key, mouse wheel and finger on the real executor: what is selected moves, or nothing."""

from __future__ import annotations

import math

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog
from pytestqt.qtbot import QtBot

from app.desk.status.interrupted_notice import NoticeRow
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import MachineState
from tests.screen.jog.bench import INCH, JogBench, Key
from tests.texts import shows, text

THOU = 0.001 * INCH


def notches(jog: JogBench, count: int) -> None:
    """The mouse's wheel over the pad, one notch a tick."""
    pad = jog.page.jog_cross
    for _ in range(abs(count)):
        delta = QPoint(0, 120 if count > 0 else -120)
        middle = QPointF(pad.rect().center())
        event = QWheelEvent(
            middle,
            QPointF(pad.mapToGlobal(middle.toPoint())),
            QPoint(),
            delta,
            Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(pad, event)
        jog.run(0.01)


def selected(jog: JogBench, axis: str = "X") -> None:
    """By the key."""
    for _ in range("XZC".index(axis) + 1):
        jog.key(Key.Key_V)
        jog.run(0.05)
    jog.run(0.2)
    assert jog.shot.wheel == axis


@pytest.mark.parametrize("axis", ["X", "Z"])
def test_handwheel_notch_moves_one_thousandth(wheeled: JogBench, axis: str) -> None:
    selected(wheeled, axis)
    assert shows(wheeled.prompt, "jog.wheel-moves", axis=axis)
    notches(wheeled, 5)
    wheeled.until(lambda: wheeled.shot.state is MachineState.IDLE)
    wheeled.run(0.3)
    assert wheeled.shot.demand["XZ".index(axis)] == pytest.approx(5 * THOU, abs=1e-9)
    notches(wheeled, -5)
    wheeled.run(0.5)
    assert wheeled.shot.demand == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_touch_drag_turns_drawn_handwheel(wheeled: JogBench) -> None:
    selected(wheeled)
    wheeled.page.jog_cross.grab()  # drawing places the controls
    box = wheeled.page.jog_cross.controls[-1].box
    for at in wheeled.page.jog_cross.controls:
        if at.on_move is not None and at.on_release is None:
            box = at.box
    pad, centre, size = wheeled.page.jog_cross, box.center(), 0.3 * min(box.width(), box.height())

    def around(degrees: float) -> QPoint:
        angle = math.radians(degrees)
        return (centre + QPointF(math.cos(angle), math.sin(angle)) * size).toPoint()

    QTest.mousePress(pad, Qt.MouseButton.LeftButton, pos=around(0))
    for degrees in range(0, 91, 5):
        QTest.mouseMove(pad, around(degrees))
        wheeled.run(0.01)
    QTest.mouseRelease(pad, Qt.MouseButton.LeftButton, pos=around(90))
    wheeled.run(0.5)
    assert wheeled.shot.demand[0] == pytest.approx(25 * THOU, abs=1.1 * THOU)  # a quarter of a hundred clicks


def test_unselected_handwheel_moves_nothing(wheeled: JogBench) -> None:
    notches(wheeled, 20)
    wheeled.run(0.3)
    selected(wheeled)
    wheeled.key(Key.Key_Escape)
    notches(wheeled, 20)
    wheeled.run(0.3)
    assert wheeled.shot.demand == (0.0, 0.0, 0.0)


def stays(wheeled: JogBench) -> None:
    """It is off and stays so, whatever the wheel does."""
    wheeled.run(0.3)
    assert wheeled.shot.wheel == ""
    at = wheeled.shot.demand
    for _ in range(20):
        station = wheeled.desk.station_controls.station
        assert station is not None
        station.turn_handwheel(4)
        wheeled.run(0.01)
    wheeled.run(0.3)
    assert wheeled.shot.demand == at


def test_leaving_page_deselects_handwheel(wheeled: JogBench) -> None:
    selected(wheeled)
    notches(wheeled, 5)
    wheeled.key(Key.Key_F1)
    stays(wheeled)


def test_dialog_deselects_handwheel(wheeled: JogBench, qtbot: QtBot) -> None:
    selected(wheeled)
    notches(wheeled, 5)
    dialog = QDialog(wheeled.window)
    qtbot.addWidget(dialog)
    dialog.setModal(True)
    dialog.show()
    wheeled.run(0.1)
    assert shows(wheeled.prompt, "jog.keyboard-left-wheel")
    dialog.close()
    stays(wheeled)


def test_frozen_screen_deselects_handwheel(wheeled: JogBench) -> None:
    selected(wheeled)
    wheeled.run(0.6, screen=False)
    assert wheeled.shot.wheel_ended == text("jog.page-silent")
    stays(wheeled)


def test_value_entry_deselects_handwheel(wheeled: JogBench) -> None:
    selected(wheeled)
    wheeled.type("t")
    wheeled.run(0.1)
    assert wheeled.shot.wheel == ""
    wheeled.key(Key.Key_Escape)
    stays(wheeled)


def test_arrow_pressed_while_handwheel_turns_stops_both(wheeled: JogBench) -> None:
    selected(wheeled, "Z")
    wheeled.key(Key.Key_F2)  # .0001
    wheeled.run(0.3)
    notches(wheeled, 20)
    wheeled.down(Key.Key_Right)
    notches(wheeled, 20)
    wheeled.up(Key.Key_Right)
    stays(wheeled)
    assert shows(wheeled.prompt, "jog.wheel-off-because", why=text("jog.key-while-turned").upper())


def test_step_key_changes_handwheel_notch_distance(wheeled: JogBench) -> None:
    selected(wheeled)
    wheeled.key(Key.Key_F2)
    wheeled.run(0.3)
    notches(wheeled, 3)
    wheeled.run(0.5)
    assert wheeled.shot.demand[0] == pytest.approx(0.3 * THOU, abs=1e-9)
    wheeled.key(Key.Key_F2)  # continuous
    wheeled.run(0.1)
    assert wheeled.shot.wheel == ""


def test_machine_without_handwheel_shows_message_and_draws_none(jog: JogBench) -> None:
    jog.key(Key.Key_V)
    assert jog.prompt == text("jog.no-wheel")
    assert not jog.page.model.is_handwheel_shown


@pytest.mark.parametrize("high", [314, 361])
def test_handwheel_targets_are_touch_sized_on_smallest_screen(wheeled: JogBench, high: int) -> None:
    """314 pixels are what a yellow row leaves to the page, 361 what it has without one."""
    wheeled.window.resize(1024, 600)
    pad = wheeled.page.jog_cross
    pad.resize(394, high)
    pad.grab()
    assert len(pad.controls) >= 17
    for control in pad.controls:
        assert min(control.box.width(), control.box.height()) >= FINGERTIP_PX - 1
        assert pad.find_full_area().contains(control.box)


def test_handwheel_targets_are_touch_sized_with_two_notice_rows(
    wheeled: JogBench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They were 43 pixels each without a key on them, and left 21 to what is held."""
    frame = wheeled.window.frame
    assert frame is not None
    rows = (
        NoticeRow("INTERRUPTED: LINE 4", "T1"),
        NoticeRow("NOT SAVED: the disk is full", "20 parts"),
    )
    monkeypatch.setattr("app.screen.window.window_frame.make_notices", lambda *_what, **_more: rows)
    wheeled.window.resize(1024, 600)
    wheeled.window.refresh()
    assert frame.notice_rows.isVisible()
    pad = wheeled.page.jog_cross
    pad.grab()
    assert len(pad.controls) >= 12
    for control in pad.controls:
        assert min(control.box.width(), control.box.height()) >= FINGERTIP_PX - 1
        assert pad.find_full_area().contains(control.box)


def test_low_pad_has_one_row_for_rapid_step_and_speed(wheeled: JogBench) -> None:
    wheeled.window.resize(1024, 600)
    pad, speeds = wheeled.page.jog_cross, wheeled.page.model.jog_speeds
    pad.resize(394, 314)
    pad.grab()
    step, speed = speeds.step_index, speeds.speed_index
    for control in pad.controls[:3]:
        QTest.mouseClick(pad, Qt.MouseButton.LeftButton, pos=control.box.center().toPoint())
    assert wheeled.page.model.held_jog.is_rapid_armed
    assert speeds.step_index != step
    assert speeds.speed_index != speed
