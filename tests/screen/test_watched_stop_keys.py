"""Presses that the key watcher has sent to the control, and their events that come to the screen later."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import cast

import pytest
from PySide6.QtWidgets import QApplication

from app.desk.stop_keys.stop_records import Focus, Stop, StopKind, press_number
from app.desk.stop_keys.watched_keys import WatchedKeys
from app.screen import page_table
from core.executor.commands import FeedHold
from core.executor.snapshot import State
from tests.screen.hands import Hands, Key
from tests.screen.test_keyboard import send, window_of

AT = 10_000


@dataclass
class Watched:
    """A watcher of which the test says what it has sent."""

    sent: list[Stop] = field(default_factory=list)
    told: list[Stop] = field(default_factory=list)
    shown: list[Focus] = field(default_factory=list)

    def send(self, kind: StopKind, key: int) -> None:
        self.sent.append(Stop(kind, press_number(key, AT)))
        self.told.append(self.sent[-1])

    def show(self, focus: Focus) -> None:
        self.shown.append(focus)

    def news(self) -> list[Stop]:
        told, self.told = self.told, []
        return told

    def was_sent(self, press: int) -> bool:
        return press in {each.press for each in self.sent}


@pytest.fixture
def watched(hands: Hands) -> tuple[Hands, Watched]:
    hands.sees(lambda: QApplication.focusWindow() is window_of(hands))
    made = Watched()
    hands.window.keyboard._watched = cast("WatchedKeys", made)
    return hands, made


def moving(hands: Hands, state: State = State.RUN) -> None:
    hands.machine.now = replace(hands.machine.now, state=state)


def test_the_windows_and_whether_esc_holds_are_shown(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    hands.window.refresh()
    assert made.shown[-1] == Focus(frozenset({int(window_of(hands).winId())}), esc_holds=False)
    moving(hands, State.WAIT)
    hands.window.refresh()
    assert made.shown[-1].esc_holds
    hands.frame.go(page_table.SECCMP)
    hands.window.refresh()
    assert not made.shown[-1].esc_holds


def test_a_hold_carries_the_number_of_its_press(watched: tuple[Hands, Watched]) -> None:
    hands, _ = watched
    send(hands, Key.Key_Pause, at=AT)
    (hold,) = [each for each in hands.machine.posted if isinstance(each, FeedHold)]
    assert hold.press == press_number(Key.Key_Pause, AT)


def test_an_esc_that_has_held_leaves_no_page(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    hands.frame.go(page_table.MENU)
    moving(hands, State.HOLD)  # by the watcher
    hands.window.refresh()
    made.send(StopKind.ESC, Key.Key_Escape)
    send(hands, Key.Key_Escape, at=AT)
    assert hands.frame.page.NAME == page_table.MENU
    assert hands.machine.posted[-1].press == press_number(Key.Key_Escape, AT)  # type: ignore[attr-defined]


def test_an_esc_that_has_not_held_leaves_the_page(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    hands.frame.go(page_table.MENU)
    moving(hands, State.HOLD)
    hands.window.refresh()
    made.send(StopKind.ESC, Key.Key_Escape)
    send(hands, Key.Key_Escape, at=AT + 500)  # another press
    assert hands.frame.page.NAME == page_table.AUTOMATIC
    assert FeedHold() not in hands.machine.posted


def test_an_estop_whose_key_never_comes_is_shown_pressed(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    made.send(StopKind.ESTOP, Key.Key_ScrollLock)
    hands.window.refresh()
    assert hands.desk.hands.estop_pressed


def test_a_hold_whose_key_never_comes_is_not_posted_again(watched: tuple[Hands, Watched]) -> None:
    hands, made = watched
    made.send(StopKind.HOLD, Key.Key_Pause)
    hands.window.refresh()
    assert FeedHold() not in hands.machine.posted
    assert not hands.desk.hands.estop_pressed


def test_without_an_x_server_nothing_is_started(hands: Hands) -> None:
    def never() -> None:
        raise AssertionError

    assert hands.window.keyboard.watch_stops(never) is None
