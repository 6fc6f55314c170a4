"""The station under fingers and mouse."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QTouchEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.station_dock import StationDock
from app.screen.window_layout import FINGERTIP_PX, MIN_WINDOW_PX, find_unit_px, make_automatic_layout
from core.executor.commands import CycleStart
from core.executor.snapshot import MachineState
from tests.screen.hands import Hands


def dock_of(hands: Hands) -> StationDock:
    dock = hands.frame.station_dock
    assert dock is not None
    hands.window.move(-300, 0)  # the offscreen screen is 800 pixels wide, and touches beyond it are dropped
    dock.grab()  # drawing declares the controls
    return dock


def middle(dock: StationDock, number: int) -> QPoint:
    return dock.controls[number].box.center().toPoint()


class Fingers:
    """Fingers on the dock, by number."""

    def __init__(self, dock: StationDock) -> None:
        self._dock = dock
        self.device = QTest.createTouchDevice()
        self._down: set[int] = set()

    def press(self, finger: int, at: QPoint) -> None:
        """One more goes down; the others stay."""
        sequence = QTest.touchEvent(self._dock, self.device, False)
        for other in self._down:
            sequence.stationary(other)
        sequence.press(finger, at, self._dock)
        sequence.commit(True)
        self._down.add(finger)

    def move(self, finger: int, at: QPoint) -> None:
        """One slides."""
        sequence = QTest.touchEvent(self._dock, self.device, False)
        sequence.move(finger, at, self._dock)
        sequence.commit(True)

    def release(self, **at: QPoint) -> None:
        """All come up."""
        sequence = QTest.touchEvent(self._dock, self.device, False)
        for finger, where in zip(sorted(self._down), at.values(), strict=True):
            sequence.release(finger, where, self._dock)
        sequence.commit(True)
        self._down.clear()


def test_canceled_touch_releases_palm_button(hands: Hands) -> None:
    dock = dock_of(hands)
    fingers = Fingers(dock)
    fingers.press(0, middle(dock, -2))
    assert hands.machine.palms == {"left"}
    QApplication.sendEvent(dock, QTouchEvent(QEvent.Type.TouchCancel, fingers.device))
    assert hands.machine.palms == set()
    fingers.release(left=middle(dock, -2))


def test_touch_drag_turns_potentiometer(hands: Hands) -> None:
    dock = dock_of(hands)
    fingers = Fingers(dock)
    track = dock.controls[9].box  # E-stop, twist, OFF, AUTO, less, more, spindle pot, less, more, feed pot
    end = QPointF(track.left(), track.center().y()).toPoint()
    fingers.press(0, track.center().toPoint())
    assert hands.desk.station_controls.feed_pot.wanted == 0.75
    fingers.move(0, end)
    assert hands.desk.station_controls.feed_pot.wanted == 0.0
    fingers.release(at=end)


def test_station_controls_are_touch_sized_in_smallest_window(hands: Hands) -> None:
    """The tracks of the pots had 42 pixels."""
    at = make_automatic_layout(*MIN_WINDOW_PX, has_dock=True).dock
    dock = StationDock(ScreenTheme(DARK_PALETTE, find_unit_px(*MIN_WINDOW_PX)), hands.desk)
    dock.resize(at.w, at.h)
    dock.grab()
    assert len(dock.controls) == 13  # as above, feed hold and the palms
    assert all(min(each.box.width(), each.box.height()) >= FINGERTIP_PX for each in dock.controls)


def test_two_touches_on_palm_buttons_start_cycle(hands: Hands) -> None:
    hands.load("pin")
    dock = dock_of(hands)
    fingers, left, right = Fingers(dock), middle(dock, -2), middle(dock, -1)
    fingers.press(0, left)
    assert CycleStart() not in hands.machine.posted
    fingers.press(1, right)
    assert hands.machine.palms == {"left", "right"}
    fingers.release(left=left, right=right)
    assert CycleStart() in hands.machine.posted
    assert hands.machine.palms == set()


def test_mouse_alone_cannot_start_cycle(hands: Hands) -> None:
    hands.load("pin")
    dock = dock_of(hands)
    for number in (-2, -1):
        QTest.mouseClick(dock, Qt.MouseButton.LeftButton, pos=middle(dock, number))
    assert CycleStart() not in hands.machine.posted


def test_estop_button_latches_and_is_released_by_twisting(hands: Hands) -> None:
    dock = dock_of(hands)
    QTest.mouseClick(dock, Qt.MouseButton.LeftButton, pos=middle(dock, 0))
    hands.sees_state(MachineState.ESTOP)
    QTest.mouseClick(dock, Qt.MouseButton.LeftButton, pos=middle(dock, 0))
    assert hands.machine.now.state is MachineState.ESTOP
    QTest.mouseClick(dock, Qt.MouseButton.LeftButton, pos=middle(dock, 1))
    hands.sees_state(MachineState.DISABLED)


def test_window_release_releases_touched_palm_button(hands: Hands) -> None:
    dock = dock_of(hands)
    dock.controls[-1].on_press(QPointF())
    assert hands.machine.palms == {"right"}
    hands.window.release_all_inputs()
    assert hands.machine.palms == set()
