"""When the search of a list does not open, what closes it, and which keys are then discarded."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from app.jog.jog_view import JogPage
from app.offsets.tool_offsets_view import ToolOffsetsPage
from app.screen import page_table
from core.executor.snapshot import Alarm, MachineState, Snapshot
from tests.screen.lathe import Key, Operator
from tests.screen.test_leafing import above
from tests.screen.test_list_keys import LOGGED, fill_log, ready
from tests.screen.test_list_search import (
    functions,
    open_search,
    send,
    table_with_search,
    type_text,
    typed,
    write,
)
from tests.screen.typist import NONE
from tests.texts import text as wording

__all__ = ["above", "ready"]
ALARM = Alarm(102, "following", "FOLLOWING ERROR", "cause", "free the slide", line=1)


def test_enter_is_refused_if_no_row_contains_the_text(ready: Operator) -> None:
    shown = functions(ready)
    open_search(ready)
    write(ready, "zzz")
    ready.key(Key.Key_Return)
    assert ready.frame.search_bar.is_open
    assert ready.prompt() == wording("screen.search-no-row")
    ready.key(Key.Key_Escape)
    assert shown.at == 0


@pytest.mark.parametrize("page", [page_table.AUTOMATIC, page_table.JOG, page_table.MDI])
def test_a_page_without_a_list_refuses_the_search(ready: Operator, page: str) -> None:
    assert ready.frame.open_page(page)
    open_search(ready)
    assert not ready.frame.search_bar.is_open
    assert ready.prompt() == wording("screen.search-no-list")


def test_an_unfinished_value_refuses_the_search_and_keeps_its_tool(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.TOOLS)
    page = ready.frame.current_page
    assert isinstance(page, ToolOffsetsPage)
    tool = page.model.tool_number
    write(ready, "5")
    open_search(ready)
    assert not ready.frame.search_bar.is_open
    assert ready.prompt() == wording("screen.search-entry")
    assert (page.model.tool_number, page.model.text) == (tool, "5")
    ready.key(Key.Key_Escape)
    open_search(ready)
    assert ready.frame.search_bar.is_open


def test_an_unfinished_number_in_the_entry_line_refuses_the_search(ready: Operator) -> None:
    shown = functions(ready)
    ready.key(Key.Key_Down, Key.Key_Return)  # the parts counter, which has an entry line
    write(ready, "7")
    open_search(ready)
    assert not ready.frame.search_bar.is_open
    assert (ready.prompt(), shown.inside) == (wording("screen.search-entry"), True)


def test_enter_is_refused_while_the_selected_row_is_not_found(above: QWidget) -> None:
    panel, search = table_with_search(above)
    panel.on_select = lambda _row: None  # The page does not move the selection.
    type_text(search, "17")
    assert (panel.found_rows, panel.selected_row) == ((17,), 0)
    assert not search.handle_key("Enter")
    assert search.is_open


@pytest.mark.parametrize("key", [Key.Key_F2, Key.Key_F3, Key.Key_F6])
def test_a_function_key_does_not_act_on_a_row_that_the_search_hides(ready: Operator, key: Key) -> None:
    assert ready.frame.open_page(page_table.TOOLS)
    offsets = ready.stage.desk.offset_book.tool_offsets
    open_search(ready)
    write(ready, "zzz")
    ready.key(key)
    assert ready.prompt() == wording("screen.search-no-row")
    assert (ready.frame.search_bar.is_open, typed(ready)) == (True, "zzz")
    assert ready.stage.desk.offset_book.tool_offsets == offsets
    ready.key(Key.Key_F1)  # leaves the page and needs no row
    assert not ready.frame.search_bar.is_open


@pytest.mark.parametrize("letter", ["y", "n"])
def test_a_question_closes_the_search_and_a_typed_letter_does_not_answer_it(
    ready: Operator, letter: str
) -> None:
    answered: list[str] = []
    desk = ready.stage.desk
    functions(ready)
    open_search(ready)
    write(ready, "e")
    desk.ask_operator("PRESS Y TO DELETE, N TO KEEP", lambda: answered.append("yes"))
    write(ready, letter)
    ready.pause(0.9)  # longer than the reading time of 0.5 s
    write(ready, letter)
    assert (answered, desk.confirmation_key) == ([], "Y")
    assert not ready.frame.search_bar.is_open
    ready.pause(1.1)
    write(ready, letter)
    assert (answered, desk.confirmation_key) == (["yes"] if letter == "y" else [], "")


def test_an_open_question_refuses_the_search(ready: Operator) -> None:
    functions(ready)
    ready.stage.desk.ask_operator("PRESS Y TO DELETE, N TO KEEP", lambda: None)
    open_search(ready)
    assert not ready.frame.search_bar.is_open
    assert ready.stage.desk.prompt_notice == wording("screen.search-question")
    assert ready.stage.desk.confirmation_key == "Y"


def test_the_programs_page_names_its_own_search(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.PROGRAMS)
    open_search(ready)
    assert not ready.frame.search_bar.is_open
    assert ready.prompt() == wording("screen.search-by-name")


@pytest.mark.parametrize("state", [MachineState.JOG, MachineState.HOMING])
def test_manual_motion_refuses_and_closes_the_search(above: QWidget, state: MachineState) -> None:
    panel, search = table_with_search(above)
    moving = replace(Snapshot(), state=state)
    assert search.find_refusal(panel, moving) == wording("screen.search-moving")
    assert not search.find_refusal(panel, Snapshot())
    type_text(search, "7")
    search.update(moving)
    assert (search.is_open, panel.found_rows, panel.selected_row) == (False, None, 0)


def test_the_palm_buttons_start_nothing_while_a_search_is_open(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.MDI)
    ready.line("G04F99")
    fill_log(ready)
    ready.key(Key.Key_F7)
    ready.window.grab()
    open_search(ready)
    ready.palms()
    assert (ready.shot.state, ready.frame.search_bar.is_open) == (MachineState.IDLE, True)
    ready.key(Key.Key_F11)
    assert ready.prompt() == wording("screen.search-palms")


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (MachineState.IDLE, MachineState.RUN),
        (MachineState.IDLE, MachineState.HOLD),
        (MachineState.SINGLE_BLOCK_STOP, MachineState.RUN),
        (MachineState.PROGRAM_STOP, MachineState.WAIT),
    ],
)
def test_a_cycle_start_closes_the_search(above: QWidget, before: MachineState, after: MachineState) -> None:
    panel, search = table_with_search(above)
    search.close()
    search.open(panel, replace(Snapshot(), state=before))
    search.update(replace(Snapshot(), state=before))
    assert search.is_open
    search.update(replace(Snapshot(), state=after))
    assert not search.is_open


def test_the_handwheel_refuses_and_closes_the_search(above: QWidget) -> None:
    panel, search = table_with_search(above)
    turned = replace(Snapshot(), wheel="x")
    assert search.find_refusal(panel, turned) == wording("screen.search-wheel")
    search.update(turned)
    assert not search.is_open


def test_the_search_waits_until_the_layout_may_change_after_a_jog(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.JOG)
    fill_log(ready)
    QTest.keyPress(ready.window, Key.Key_Left)
    ready.reaches(MachineState.JOG)
    QTest.keyRelease(ready.window, Key.Key_Left)
    ready.reaches(MachineState.IDLE)
    ready.key(Key.Key_F7)
    ready.window.grab()
    open_search(ready)
    assert not ready.frame.search_bar.is_open
    assert ready.prompt() == wording("screen.search-after-jog")
    ready.pause(3.1)
    open_search(ready)
    assert ready.frame.search_bar.is_open


def test_the_field_and_the_keyboard_disappear_as_soon_as_the_search_closes(ready: Operator) -> None:
    functions(ready)
    bar, page = ready.frame.search_bar, ready.frame.current_page
    bar.has_letters = True
    open_search(ready)
    assert (bar.isHidden(), bar.letter_pad.isHidden(), page.is_searching) == (False, False, True)
    bar.search.force_close()  # without a new layout
    assert (bar.isHidden(), bar.letter_pad.isHidden(), page.is_searching) == (True, True, False)


def test_a_new_alarm_closes_the_search_but_an_old_one_does_not(above: QWidget) -> None:
    panel, search = table_with_search(above)
    search.cancel()
    search.open(panel, replace(Snapshot(), alarms=(ALARM,)))
    search.update(replace(Snapshot(), alarms=(ALARM,)))
    assert search.is_open
    search.update(replace(Snapshot(), alarms=(ALARM, replace(ALARM, line=2))))
    assert not search.is_open


def test_a_list_without_rows_or_with_an_immovable_selection_refuses(above: QWidget) -> None:
    panel, search = table_with_search(above, count=0)
    assert search.find_refusal(panel, Snapshot()) == wording("screen.search-no-list")
    panel, search = table_with_search(above)
    panel.on_select = None
    assert search.find_refusal(panel, Snapshot()) == wording("screen.search-no-list")
    assert search.find_refusal(None, Snapshot()) == wording("screen.search-no-list")


def test_the_rest_of_a_text_is_discarded_after_an_estop_closes_the_search(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.TOOLS)
    page = ready.frame.current_page
    assert isinstance(page, ToolOffsetsPage)
    tool = page.model.tool_number
    open_search(ready)
    write(ready, "t1")
    send(ready, Key.Key_ScrollLock)
    ready.reaches(MachineState.ESTOP)
    write(ready, "7uyd")
    ready.key(Key.Key_Return, Key.Key_F3)
    assert ready.prompt() == wording("screen.search-closed")
    assert (page.model.tool_number, page.model.text) == (tool, "")
    assert not ready.stage.desk.confirmation_key
    ready.pause(0.9)  # less than 1 s after the last key
    write(ready, "7")
    assert not page.model.text
    ready.pause(1.1)
    repeat = QKeyEvent(QEvent.Type.KeyPress, Key.Key_7, NONE, "7", True)
    QCoreApplication.sendEvent(ready.window, repeat)
    assert not page.model.text
    ready.pause(1.1)
    write(ready, "7")
    assert page.model.text == "7"


@pytest.mark.parametrize(
    ("letter", "states"),
    [("e", {MachineState.ESTOP}), ("h", {MachineState.HOLD, MachineState.STOPPING})],
)
def test_stop_letters_stop_at_once_after_the_search_is_closed(
    ready: Operator, letter: str, states: set[MachineState]
) -> None:
    ready.palms()
    ready.reaches(MachineState.RUN)
    assert ready.frame.open_page(page_table.TOOLS)  # All characters are text on this page.
    ready.window.grab()
    open_search(ready)
    ready.frame.search_bar.search.force_close()
    write(ready, letter)
    ready.until(lambda: ready.shot.state in states)


def test_the_search_does_not_open_again_while_keys_are_discarded(ready: Operator) -> None:
    ready.palms()
    ready.reaches(MachineState.RUN)
    assert ready.frame.open_page(page_table.TOOLS)
    ready.window.grab()
    open_search(ready)
    ready.frame.search_bar.search.force_close()
    ready.frame.search_bar.open_search()  # the touched key
    assert not ready.frame.search_bar.is_open
    assert ready.prompt() == wording("screen.search-closed")
    write(ready, "h")
    ready.until(lambda: ready.shot.state in {MachineState.HOLD, MachineState.STOPPING})


def test_a_stop_letter_that_is_handled_late_still_stops(
    ready: Operator, monkeypatch: pytest.MonkeyPatch
) -> None:
    ready.palms()
    ready.reaches(MachineState.RUN)
    assert ready.frame.open_page(page_table.TOOLS)
    ready.window.grab()
    open_search(ready)
    ready.frame.search_bar.search.force_close()
    ready.pause(1.2)
    assert ready.frame.has_text_field()
    monkeypatch.setattr(ready.stage.desk.window_state, "_press_age", lambda: 0.4)  # pressed at 0.8 s
    assert not ready.frame.has_text_field()
    write(ready, "h")
    ready.until(lambda: ready.shot.state in {MachineState.HOLD, MachineState.STOPPING})


def test_a_stop_key_of_the_page_acts_while_keys_are_discarded(
    ready: Operator, monkeypatch: pytest.MonkeyPatch
) -> None:
    stopped: list[str] = []
    fill_log(ready)
    assert ready.frame.open_page(page_table.JOG)
    monkeypatch.setattr(JogPage, "make_stop_key_actions", lambda _page: {"0": lambda: stopped.append("0")})
    ready.key(Key.Key_F7)
    ready.window.grab()
    open_search(ready)
    ready.frame.search_bar.search.force_close()
    write(ready, "10")
    assert stopped == ["0"]


@pytest.mark.parametrize("key", [Key.Key_F7, Key.Key_F1])
def test_a_function_key_closes_the_search_first(ready: Operator, key: Key) -> None:
    functions(ready)
    open_search(ready)
    write(ready, "e")
    ready.key(key)
    assert not ready.frame.search_bar.is_open
    write(ready, "0")
    assert typed(ready) == "e"


def test_the_alarm_log_is_searched_by_line_and_text(ready: Operator) -> None:
    fill_log(ready)
    ready.key(Key.Key_F7)
    ready.window.grab()
    log = ready.frame.alarm_list
    open_search(ready)
    write(ready, "following")
    assert log.found_rows is not None
    assert len(log.found_rows) == LOGGED
    ready.key(Key.Key_End, Key.Key_Return)
    assert (log.marked, log.found_rows) == (LOGGED - 1, None)
    assert log.isVisible()
