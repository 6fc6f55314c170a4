"""Pages by key and by finger; what starts where, and what stays in sight."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.desk.page_description import PageDescription
from app.desk.status.prompt_line import START_ON_AUTOMATIC
from app.screen import page_table
from app.screen.page_table import ALL_PAGES, import_class
from core.executor.commands import CycleStart, FeedHold
from core.executor.snapshot import Alarm, LogEvent, MachineState
from tests.screen.hands import Hands, Key
from tests.texts import begins, text


@pytest.mark.parametrize("entry", ALL_PAGES, ids=lambda entry: entry.name)
def test_every_page_in_table_exists(entry: PageDescription) -> None:
    assert entry.name == import_class(entry.view_class).NAME
    assert not entry.model_class or callable(import_class(entry.model_class).close)


def test_f1_opens_menu_and_f2_and_esc_return(hands: Hands) -> None:
    hands.key(Key.Key_F1)
    assert hands.frame.current_page.NAME == page_table.MENU
    assert hands.frame.title_line.page_title == page_table.MENU
    assert hands.frame.key_bar.key_labels[1] == "AUTO"
    hands.key(Key.Key_F2)
    assert hands.frame.current_page is hands.page
    assert hands.frame.key_bar.key_labels[1] == "FILE"
    hands.key(Key.Key_F1)
    hands.key(Key.Key_Escape)
    assert hands.frame.current_page is hands.page


def test_touch_on_function_key_opens_page(hands: Hands) -> None:
    hands.key(Key.Key_F1)
    bar = hands.frame.key_bar
    hands.sees(lambda: bool(bar._places))
    QTest.mouseClick(bar, Qt.MouseButton.LeftButton, pos=QPoint(bar.width() * 3 // 20, bar.height() // 2))
    assert hands.frame.current_page is hands.page


def test_cycle_starts_only_on_automatic_page(hands: Hands) -> None:
    hands.load("pin")
    hands.key(Key.Key_F1)
    hands.both_palms()
    assert CycleStart() not in hands.machine.posted
    assert hands.prompt() == START_ON_AUTOMATIC
    hands.key(Key.Key_F2)
    hands.both_palms()
    assert CycleStart() in hands.machine.posted


def test_feed_hold_works_on_every_page(hands: Hands) -> None:
    hands.load("pin")
    hands.both_palms()
    hands.key(Key.Key_F1)
    hands.sees(
        lambda: hands.frame.readout_line.status is not None and hands.machine.now.state is MachineState.RUN
    )
    assert hands.frame.readout_line.isVisible()
    assert not hands.frame.position_panel.isVisible()
    hands.key(Key.Key_H)
    assert FeedHold() in hands.machine.posted
    hands.sees_state(MachineState.HOLD)


def test_page_change_releases_palm_button(hands: Hands) -> None:
    hands.load("pin")
    hands.down(Key.Key_F11)
    hands.key(Key.Key_F1)
    assert hands.machine.palms == set()
    hands.up(Key.Key_F11)


def test_alarm_has_priority_over_page_prompt(hands: Hands) -> None:
    hands.key(Key.Key_F1)
    hands.machine.fault(Alarm(102, "following", "FOLLOWING ERROR", "blocked", "free the slide", line=4))
    hands.sees(lambda: begins(hands.prompt(), "screen.what-to-do", remedy="free the slide"))
    assert hands.frame.title_line.state_text == text(
        "screen.alarm", number=102, what=text("screen.following-error")
    )
    assert hands.frame.prompt_line.reason_text == text("screen.cause", cause="blocked")
    assert (
        hands.frame.run_line.stop_text
        == f"{hands.frame.title_line.state_text}  ·  {text('screen.line', line=4)}"
    )
    hands.key(Key.Key_F7)
    assert hands.frame.alarm_list.isVisible()
    hands.key(Key.Key_Escape)
    assert not hands.frame.alarm_list.isVisible()
    assert hands.frame.current_page.NAME == page_table.MENU


def test_run_line_is_visible_on_every_other_page(hands: Hands) -> None:
    hands.load("bushing")
    assert not hands.frame.run_line.isVisible()  # the Automatic page has it all in large
    hands.machine.step = 0.2  # so that it takes some pictures, however slowly they come
    hands.both_palms()
    hands.sees(lambda: hands.machine.now.line > 9 and bool(hands.machine.now.comment))
    hands.machine.step = 0.0  # from here on it stays in its block: all show the same
    for key in (Key.Key_F9, Key.Key_F8, Key.Key_F1):
        hands.key(key)
        hands.sees(lambda: hands.frame.run_line.block_text.startswith(f"L{hands.machine.now.line}  "))
        assert hands.frame.run_line.isVisible()
        assert hands.frame.run_line.comment_text == hands.machine.now.comment
        assert [name for name, _figure in hands.frame.run_line.time_texts] == [
            "PARTS",
            "CYCLE",
            "LEFT",
            "LAST",
        ]
        hands.frame.run_line.grab()


def test_function_key_without_label_shows_message(hands: Hands) -> None:
    hands.key(Key.Key_F1)
    hands.key(Key.Key_F10)
    hands.key(Key.Key_F8)
    assert hands.frame.key_bar.key_labels[7] == ""
    assert hands.prompt() == text("screen.no-function", key="F8")


def test_f7_scrolls_list_of_stops_and_esc_closes_it(hands: Hands) -> None:
    for line in range(40):
        alarm = Alarm(102, "following", "FOLLOWING ERROR", f"cause {line}", "free the slide", line=line)
        hands.desk.hear(LogEvent(0.0, "alarm", "", line, alarm))
    hands.key(Key.Key_F7)
    log = hands.frame.alarm_list
    hands.sees(lambda: len(log.logged_stops) == 40)
    assert log.logged_stops[0].alarm.line == 39
    log.grab()  # it knows its rows when it is drawn
    hands.key(Key.Key_PageDown)
    assert log.marked == log.rows
    for _ in range(40):
        hands.key(Key.Key_PageDown)
    log.grab()
    assert (log.marked, log.first_row) == (39, 40 - log.rows)
    hands.key(Key.Key_PageUp)
    assert log.marked == 39 - log.rows
    hands.key(Key.Key_Escape)
    assert not log.isVisible()
