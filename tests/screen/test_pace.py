"""How often the screen is drawn: sixty times a second, less only where nothing happens."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtTest import QTest

from app.screen.main_window import FRAME_MS, REST_MS, UNTOUCHED
from core.executor.snapshot import State
from tests.screen.hands import Hands, Key


def interval(hands: Hands) -> int:
    (timer,) = [each for each in hands.window.findChildren(QTimer) if each.parent() is hands.window]
    return timer.interval()


def left_alone(hands: Hands) -> None:
    """Two seconds without a key or finger, and the next frame."""
    hands.window.times.touched = hands.window.times.clock() - UNTOUCHED - 0.1
    hands.window._tick()


@pytest.mark.parametrize("state", [State.ESTOP, State.DISABLED, State.IDLE, State.FAULT])
def test_a_machine_at_rest_that_nobody_touches_is_drawn_less_often(hands: Hands, state: State) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)
    assert interval(hands) == FRAME_MS
    left_alone(hands)
    assert interval(hands) == REST_MS


def test_the_first_key_ends_it_before_it_is_judged(hands: Hands) -> None:
    left_alone(hands)
    hands.window._timer.timeout.disconnect()  # no frame comes in between
    QTest.keyClick(hands.window.windowHandle(), Key.Key_Shift)  # it does nothing by itself
    assert interval(hands) == FRAME_MS


@pytest.mark.parametrize("state", sorted(set(State) - {State.ESTOP, State.DISABLED, State.IDLE, State.FAULT}))
def test_whatever_may_move_is_drawn_sixty_times_a_second(hands: Hands, state: State) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)
    left_alone(hands)
    assert interval(hands) == FRAME_MS


def test_the_handwheel_and_a_page_that_lives_are_too(hands: Hands, monkeypatch: pytest.MonkeyPatch) -> None:
    hands.machine.now = replace(hands.machine.now, wheel="X")
    left_alone(hands)
    assert interval(hands) == FRAME_MS
    hands.machine.now = replace(hands.machine.now, wheel="")
    left_alone(hands)
    assert interval(hands) == REST_MS
    monkeypatch.setattr(hands.page, "lively", lambda: True)
    left_alone(hands)
    assert interval(hands) == FRAME_MS


def test_a_motion_is_seen_with_the_next_frame(hands: Hands) -> None:
    left_alone(hands)
    hands.machine.now = replace(hands.machine.now, state=State.JOG)
    left_alone(hands)
    assert interval(hands) == FRAME_MS
