"""The search field of the lists: characters are text, and keys and touches select found rows."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QKeyEvent
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
from tests.screen.test_list_keys import fill_log, ready
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
