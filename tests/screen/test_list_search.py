"""The search field of the lists: characters are text, stop keys act, and it opens only where it may."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from app.desk.pages.table_content import TableContent, TableRow
from app.offsets.tool_offsets import TABLE_COLUMNS
from app.offsets.tool_offsets_view import ToolOffsetsPage
from app.screen import page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.lists.list_search import ListSearch
from app.screen.panel import Panel, TouchTarget
from app.screen.screen_theme import ScreenTheme
from app.screen.table_panel import TablePanel
from app.screen.window_layout import FINGERTIP_PX
from app.special.special_functions import SpecialFunctionsModel
from app.special.special_view import SpecialFunctionsPage
from core.executor.snapshot import Alarm, MachineState, Snapshot
from tests.attached import attached
from tests.screen.lathe import Key, Operator
from tests.screen.test_leafing import MANY, SMALL, above, press
from tests.screen.test_list_keys import LOGGED, fill_log, ready
from tests.screen.typist import NONE
from tests.texts import text as wording

__all__ = ["above", "ready"]
ALARM = Alarm(102, "following", "FOLLOWING ERROR", "cause", "free the slide", line=1)


def open_search(operator: Operator) -> None:
    send(operator, Key.Key_F, Qt.KeyboardModifier.ControlModifier)


def send(operator: Operator, key: int, held: Qt.KeyboardModifier = NONE, text: str = "") -> None:
    """Press a key where the platform sends it, so that the stop keys are tested too."""
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
        QCoreApplication.sendEvent(operator.window.windowHandle(), QKeyEvent(kind, key, held, text))


def write(operator: Operator, text: str) -> None:
    for character in text:
        send(operator, ord(character.upper()), text=character)


def typed(operator: Operator) -> str:
    return operator.frame.search_bar.search.input_field.text


def functions(operator: Operator) -> SpecialFunctionsModel:
    """The special functions, with their page open and painted."""
    assert operator.frame.open_page(page_table.SPECIAL)
    operator.window.grab()
    return attached(operator.stage.desk, SpecialFunctionsModel)


def search_key(panel: Panel) -> TouchTarget:
    panel.grab()
    (found,) = [each for each in panel.list_targets() if each.name == "SEARCH"]
    return found


# --- text -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("page", [page_table.SPECIAL, page_table.TOOLS, page_table.ZERO])
def test_stop_letters_digits_and_signs_are_text(ready: Operator, page: str) -> None:
    assert ready.frame.open_page(page)
    before = ready.shot.feed_override, ready.shot.spindle_override
    open_search(ready)
    write(ready, "h E0+,?/ydr")
    ready.pause(0.1)
    assert typed(ready) == "h E0+,?/ydr"
    assert ready.shot.state is MachineState.IDLE
    assert (ready.shot.feed_override, ready.shot.spindle_override) == before
    assert ready.frame.help_panel.isHidden()


def test_stop_letters_act_again_after_the_search(ready: Operator) -> None:
    functions(ready)
    open_search(ready)
    send(ready, Key.Key_Escape)
    send(ready, Key.Key_E)
    ready.reaches(MachineState.ESTOP)


@pytest.mark.parametrize("key", [Key.Key_H, Key.Key_E, Key.Key_Space])
def test_ctrl_with_a_stop_letter_stops_nothing(ready: Operator, key: Key) -> None:
    functions(ready)
    open_search(ready)
    send(ready, key, Qt.KeyboardModifier.ControlModifier)
    ready.pause(0.1)
    assert (ready.shot.state, typed(ready)) == (MachineState.IDLE, "")


def test_scroll_lock_is_the_estop_during_a_search(ready: Operator) -> None:
    functions(ready)
    open_search(ready)
    write(ready, "e")
    send(ready, Key.Key_ScrollLock)
    ready.reaches(MachineState.ESTOP)
    assert not ready.frame.search_bar.is_open


def test_drawn_stop_button_acts_during_a_search(ready: Operator) -> None:
    functions(ready)
    open_search(ready)
    write(ready, "e")
    dock = ready.frame.station_dock
    assert dock is not None
    dock.grab()
    for control in [each for each in dock.controls if each.stops_machine]:
        control.press_and_release()
    ready.reaches(MachineState.ESTOP)
    assert typed(ready) == "e"


def test_a_search_opens_while_the_estop_is_pressed(above: QWidget) -> None:
    panel, search = table_with_search(above)
    search.cancel()
    stopped = replace(Snapshot(), state=MachineState.ESTOP)
    search.open(panel, stopped)
    search.update(stopped)
    assert search.is_open


def test_pause_starts_feed_hold_during_a_search(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.MDI)
    fill_log(ready)
    ready.line("G04F99")
    assert ready.mdi.prepared_line.ready_job is not None, ready.mdi.prepared_line.diagnostics
    ready.palms()
    ready.reaches(MachineState.WAIT)
    ready.key(Key.Key_F7)
    ready.window.grab()
    open_search(ready)
    write(ready, "h ")
    ready.pause(0.1)
    assert ready.shot.state is MachineState.WAIT
    send(ready, Key.Key_Pause)
    ready.until(lambda: ready.shot.state in {MachineState.HOLD, MachineState.STOPPING})
    assert typed(ready) == "h "


def test_digits_and_arrows_do_not_reach_the_jog_page_below_the_alarm_log(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.JOG)
    fill_log(ready)
    ready.key(Key.Key_F7)
    ready.window.grab()
    open_search(ready)
    before = ready.shot.demand
    write(ready, "102 0")
    ready.key(Key.Key_Left, Key.Key_Down)
    ready.pause(0.3)
    assert (typed(ready), ready.shot.demand, ready.shot.state) == ("102 0", before, MachineState.IDLE)


# --- found rows -------------------------------------------------------------------------------------------


def test_typing_selects_the_first_found_row_and_enter_keeps_it(ready: Operator) -> None:
    shown = functions(ready)
    log = next(at for at, each in enumerate(shown.functions) if each.name == "EVENT LOG")
    open_search(ready)
    write(ready, "event l")
    assert shown.at == log > 0
    ready.key(Key.Key_Return)
    assert (shown.at, ready.frame.search_bar.is_open, shown.inside) == (log, False, False)
    page = ready.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    assert page.function_list.found_rows is None


def test_esc_selects_the_former_row_and_keeps_the_page(ready: Operator) -> None:
    shown = functions(ready)
    ready.key(Key.Key_Down, Key.Key_Down)
    open_search(ready)
    write(ready, "event l")
    assert shown.at != 2
    ready.key(Key.Key_Escape)
    assert (shown.at, ready.frame.search_bar.is_open) == (2, False)
    assert ready.frame.current_page.NAME == page_table.SPECIAL


def test_arrows_home_and_end_select_only_found_rows(above: QWidget) -> None:
    panel, search = table_with_search(above)
    type_text(search, "1")  # row 1, rows 10 to 19 and row 21 of 30
    assert panel.found_rows == (1, *range(10, 20), 21)
    for key, row in (("End", 21), ("Down", 21), ("Up", 19), ("Home", 1), ("Up", 1), ("Down", 10)):
        search.handle_key(key)
        assert panel.selected_row == row


def test_a_touch_selects_the_found_row_that_is_drawn_there(above: QWidget) -> None:
    panel, search = table_with_search(above)
    type_text(search, "7")  # rows 7, 17 and 27
    panel.grab()
    rows = [each.box for each in panel.list_targets() if each.kind == "row"]
    assert len(rows) == 3
    press(panel, rows[2])
    assert panel.selected_row == 27


def test_one_page_has_the_visible_rows(ready: Operator) -> None:
    shown = functions(ready)
    page = ready.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    assert 1 < page.function_list.rows < len(shown.functions) - 1
    ready.key(Key.Key_PageDown)
    assert shown.at == page.function_list.rows
    ready.key(Key.Key_PageUp)
    assert shown.at == 0


def test_search_finds_a_tool_by_its_number(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.TOOLS)
    page = ready.frame.current_page
    assert isinstance(page, ToolOffsetsPage)
    open_search(ready)
    write(ready, "t17")
    ready.key(Key.Key_Return)
    assert (page.model.tool_number, page.model.text) == (17, "")


@pytest.mark.parametrize(
    ("text", "rows"), [("rotacion", (0, 1)), ("Rotación", (0, 1)), ("ano", (2,)), ("rotacien", ())]
)
def test_accents_and_capitals_make_no_difference(above: QWidget, text: str, rows: tuple[int, ...]) -> None:
    panel, search = table_with_search(above, count=3)
    show_rows(panel, ["ROTACIÓN", "rotacio\u0301n", "AÑO"])  # The second name has a combining accent.
    type_text(search, text)
    assert panel.found_rows == rows


def test_changed_texts_do_not_move_the_selection(above: QWidget) -> None:
    panel, search = table_with_search(above)
    type_text(search, "17")
    assert panel.selected_row == 17
    names = [f"row {n}" for n in range(MANY)]
    names[17], names[3] = "done", "row 17"
    show_rows(panel, names)
    search.update(Snapshot())
    assert (panel.found_rows, panel.selected_row) == ((3, 17), 17)
    assert search.handle_key("Enter")
    assert panel.selected_row == 17


def test_a_row_that_appears_is_selected_only_by_a_key(above: QWidget) -> None:
    panel, search = table_with_search(above)
    type_text(search, "new")
    show_rows(panel, [*(f"row {n}" for n in range(MANY)), "new"])
    search.update(Snapshot())
    assert (panel.found_rows, panel.selected_row) == ((MANY,), 0)
    assert not search.handle_key("Enter")
    search.handle_key("Down")
    assert panel.selected_row == MANY


@pytest.mark.parametrize(("count", "selected"), [(MANY, 4), (MANY - 1, 17), (MANY + 1, 17)])
def test_esc_selects_the_former_row_only_if_no_row_was_added_or_removed(
    above: QWidget, count: int, selected: int
) -> None:
    panel, search = table_with_search(above)
    search.cancel()
    assert panel.on_select is not None
    panel.on_select(4)
    search.open(panel, Snapshot())
    type_text(search, "17")
    show_rows(panel, [f"row {n}" for n in range(count)])
    search.cancel()
    assert panel.selected_row == selected


# --- touch ------------------------------------------------------------------------------------------------


def test_the_search_key_is_as_large_as_a_fingertip_and_opens_the_keyboard(ready: Operator) -> None:
    functions(ready)
    page, bar = ready.frame.current_page, ready.frame.search_bar
    assert isinstance(page, SpecialFunctionsPage)
    ready.window.refresh()
    key = search_key(page.function_list)
    assert min(key.box.width(), key.box.height()) >= FINGERTIP_PX
    press(page.function_list, key.box)
    assert bar.is_open
    assert not bar.letter_pad.isHidden()
    bar.letter_pad.grab()
    letters = bar.letter_pad.list_targets()
    press(bar.letter_pad, letters[0].box)  # the digit 1
    assert typed(ready) == "1"
    bar.grab()
    assert all(min(each.box.width(), each.box.height()) >= FINGERTIP_PX for each in bar.list_targets())
    assert page.geometry().bottom() < bar.y()
    press(bar, bar.list_targets()[-1].box)  # CLOSE
    assert not bar.is_open
    assert bar.isHidden()


@pytest.mark.parametrize("page", [page_table.SPECIAL, page_table.TOOLS, page_table.ZERO])
def test_the_list_is_visible_above_the_keyboard_in_a_small_window(ready: Operator, page: str) -> None:
    ready.window.resize(1024, 600)
    assert ready.frame.open_page(page)
    ready.window.grab()
    ready.window.refresh()
    rows = ready.frame.current_page.find_list()
    assert rows is not None
    press(rows, search_key(rows).box)
    ready.window.refresh()
    ready.window.grab()
    places = [each.box for each in rows.list_targets() if each.kind == "row"]
    assert places
    assert all(rows.rect().contains(each.toAlignedRect()) for each in places)


def test_a_touch_during_a_search_only_selects_the_function(ready: Operator) -> None:
    shown = functions(ready)
    open_search(ready)
    write(ready, "event l")
    page = ready.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    page.function_list.grab()
    (row,) = [each.box for each in page.function_list.list_targets() if each.kind == "row"]
    press(page.function_list, row)
    press(page.function_list, row)
    assert (shown.functions[shown.at].name, shown.inside) == ("EVENT LOG", False)
    ready.key(Key.Key_Return)
    press(page.function_list, row)
    assert shown.inside  # A touch opens the function again.


def test_two_touches_of_a_tool_do_not_open_its_remark_during_a_search(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.TOOLS)
    page = ready.frame.current_page
    assert isinstance(page, ToolOffsetsPage)
    open_search(ready)
    write(ready, "t1")  # The first found row is T1, which is set.
    page.content_panel.grab()
    cells = [each.box for each in page.content_panel.list_targets() if each.kind == "row"]
    remark = cells[TABLE_COLUMNS.index("remark")]
    press(page.content_panel, remark)
    page.model.column_index = TABLE_COLUMNS.index("remark")
    press(page.content_panel, remark)
    assert (page.model.tool_number, page.model.is_text_open) == (1, False)
    ready.key(Key.Key_Escape)
    page.content_panel.grab()
    press(page.content_panel, remark)
    assert page.model.is_text_open  # A touch opens the remark again.


def test_keys_of_the_page_for_touch_enter_nothing_during_a_search(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.TOOLS)
    page = ready.frame.current_page
    assert isinstance(page, ToolOffsetsPage)
    open_search(ready)
    page.handle_touched_key("5")
    assert (page.model.text, ready.prompt()) == ("", wording("screen.search-palms"))


def test_the_search_closes_when_the_page_shows_another_list(ready: Operator) -> None:
    shown = functions(ready)
    open_search(ready)
    shown.inside = True
    ready.window.refresh()
    assert not ready.frame.search_bar.is_open


def test_a_list_that_shows_all_rows_has_no_search_key(above: QWidget) -> None:
    panel, _search = table_with_search(above, count=3)
    panel.on_search_key = lambda: None
    panel.grab()
    assert not [each for each in panel.list_targets() if each.name == "SEARCH"]


# --- refusals ---------------------------------------------------------------------------------------------


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


def table_with_search(above: QWidget, count: int = MANY) -> tuple[TablePanel, ListSearch]:
    """A table with numbered rows, which a touch or a search selects, and its open search."""

    def select(row: int) -> None:
        panel.show_table(replace(panel.table, marked=row))

    panel = TablePanel(ScreenTheme(DARK_PALETTE, SMALL), select, above)
    panel.on_select = select
    panel.resize(500, 300)
    rows = tuple(TableRow((f"row {n}",)) for n in range(count))
    panel.show_table(TableContent("PROGRAMS", ("NAME",), (1.0,), rows, 0 if rows else -1))
    above.show()
    panel.grab()
    search = ListSearch()
    search.open(panel, Snapshot())
    return panel, search


def show_rows(panel: TablePanel, names: list[str]) -> None:
    panel.show_table(replace(panel.table, rows=tuple(TableRow((each,)) for each in names)))


def type_text(search: ListSearch, text: str) -> None:
    for character in text:
        assert search.handle_key(character)
