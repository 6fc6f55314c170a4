"""How often the screen is drawn: sixty times a second, less only where nothing happens."""

from __future__ import annotations

import threading
from dataclasses import replace

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtTest import QTest

from app.screen.window.main_window import AT_REST_FRAME_MS, FRAME_MS, IDLE_DELAY_S
from app.screen.window.window_frame import MAX_REFRESH_AGE_S
from core.executor.snapshot import MachineState
from tests.screen.hands import Hands, Key


def interval(hands: Hands) -> int:
    (timer,) = [each for each in hands.window.findChildren(QTimer) if each.parent() is hands.window]
    return timer.interval()


def left_alone(hands: Hands) -> None:
    """Two seconds without a key or finger, and the next frame."""
    assert hands.window.page_preloader is not None
    hands.window.page_preloader.is_done = True
    hands.window.input_times.input_time_s = hands.window.input_times.clock() - IDLE_DELAY_S - 0.1
    hands.window._handle_tick()


@pytest.mark.parametrize(
    "state", [MachineState.ESTOP, MachineState.DISABLED, MachineState.IDLE, MachineState.FAULT]
)
def test_idle_machine_is_drawn_less_often(hands: Hands, state: MachineState) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)
    assert interval(hands) == FRAME_MS
    left_alone(hands)
    hands.sees(lambda: interval(hands) == AT_REST_FRAME_MS)


def test_first_key_restores_frame_rate_before_it_is_processed(hands: Hands) -> None:
    left_alone(hands)
    hands.window._timer.timeout.disconnect()  # no frame comes in between
    QTest.keyClick(hands.window.windowHandle(), Key.Key_Shift)  # it does nothing by itself
    assert interval(hands) == FRAME_MS


def test_machine_change_restores_frame_rate_from_any_thread(
    hands: Hands, monkeypatch: pytest.MonkeyPatch
) -> None:
    left_alone(hands)
    hands.sees(lambda: interval(hands) == AT_REST_FRAME_MS)
    seen: list[int] = []
    monkeypatch.setattr(hands.window, "_pace", seen.append)
    executor = threading.Thread(target=hands.desk.window_state.wake_window)
    executor.start()
    executor.join()
    hands.sees(lambda: FRAME_MS in seen)
    monkeypatch.undo()


@pytest.mark.parametrize(
    "state",
    sorted(
        set(MachineState) - {MachineState.ESTOP, MachineState.DISABLED, MachineState.IDLE, MachineState.FAULT}
    ),
)
def test_states_with_possible_motion_are_drawn_sixty_times_per_second(
    hands: Hands, state: MachineState
) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)
    left_alone(hands)
    assert interval(hands) == FRAME_MS


def test_handwheel_and_animated_page_are_drawn_at_full_rate(
    hands: Hands, monkeypatch: pytest.MonkeyPatch
) -> None:
    hands.machine.now = replace(hands.machine.now, wheel="X")
    left_alone(hands)
    assert interval(hands) == FRAME_MS
    hands.machine.now = replace(hands.machine.now, wheel="")
    left_alone(hands)
    hands.sees(lambda: interval(hands) == AT_REST_FRAME_MS)
    monkeypatch.setattr(hands.page, "is_animating", lambda: True)
    left_alone(hands)
    assert interval(hands) == FRAME_MS


def test_motion_is_visible_in_next_frame(hands: Hands) -> None:
    left_alone(hands)
    hands.machine.now = replace(hands.machine.now, state=MachineState.JOG)
    left_alone(hands)
    assert interval(hands) == FRAME_MS


# --- which frames are made at all -------------------------------------------------------------------------


class Counted:
    """Ticks of the window's timer at rest, made by hand on a clock of their own, and their frames."""

    def __init__(self, hands: Hands) -> None:
        self._hands, self._window = hands, hands.window
        self._window._timer.stop()
        self.t = 1000.0
        hands.desk.clock.read_seconds = self._window.input_times.clock = lambda: self.t
        self.frames = 0
        self._refresh, self._window.refresh = self._window.refresh, self._count  # type: ignore[method-assign]
        self.until_still()

    def _count(self) -> None:
        self.frames += 1
        self._refresh()

    def until_still(self) -> None:
        """All is drawn, and nobody has touched anything for a while."""
        self._hands.machine.alive = False  # the same time in every snapshot would be a silent control
        self._window.input_times.input_time_s = self.t - IDLE_DELAY_S - 0.1
        for _ in range(50):
            self.tick(0.0)
            self._hands.qtbot.wait(1)  # what is to be drawn is drawn
        self.frames = 0

    def tick(self, after: float = 0.048) -> int:
        """One tick so much later; the frames since the last one."""
        self.t += after
        before = self.frames
        self._window._handle_tick()
        return self.frames - before


@pytest.fixture
def counted(hands: Hands) -> Counted:
    return Counted(hands)


def test_unchanged_picture_is_not_drawn_again(counted: Counted) -> None:
    assert [counted.tick() for _ in range(5)] == [0] * 5


def test_unchanged_screen_is_refreshed_after_maximum_age(counted: Counted) -> None:
    counted.tick(MAX_REFRESH_AGE_S + 0.01)
    assert counted.frames == 1


def test_change_other_than_time_is_drawn_in_next_frame(hands: Hands, counted: Counted) -> None:
    machine = hands.machine
    machine.now = replace(machine.now, t=machine.now.t + 0.1)
    assert counted.tick() == 0
    machine.now = replace(machine.now, inputs=frozenset({"guard"}))
    assert counted.tick() == 1


def test_another_program_is_drawn_in_next_frame(hands: Hands, counted: Counted) -> None:
    hands.desk.program_loader.replace_loaded_program(
        replace(hands.desk.program_loader.loaded_program, progress_count=7)
    )
    assert counted.tick() == 1


def test_repaint_causes_one_more_refresh(hands: Hands, counted: Counted) -> None:
    hands.frame.prompt_line.repaint()
    assert [counted.tick() for _ in range(2)] == [1, 0]


@pytest.mark.usefixtures("stalls")
def test_screen_is_refreshed_after_stall_before_anything_starts(counted: Counted) -> None:
    assert [counted.tick(after) for after in (0.31, 0.001, 0.001)] == [1, 1, 0]


def test_animated_page_is_not_animated_while_minimized(
    hands: Hands, counted: Counted, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hands.page, "is_animating", lambda: True)
    assert counted.tick(0.001) == 1
    monkeypatch.setattr(hands.window, "isMinimized", lambda: True)
    assert counted.tick(0.001) == 0
