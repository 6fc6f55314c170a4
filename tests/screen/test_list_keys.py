"""Home, End, Page up and Page down act alike in every list, and never on a list that another one covers."""

from __future__ import annotations

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit
from pytestqt.qtbot import QtBot

from app.desk.status.prompt_line import READING_TIME_S
from app.editor.editor_model import EditorStage
from app.editor.editor_view import EditorPage
from app.jog.manual_functions import ManualFunctions
from app.offsets.tool_offsets_view import ToolOffsetsPage
from app.offsets.tool_shapes import ToolShapeTable
from app.programs.program_list_model import ProgramListModel
from app.screen import page_table
from app.searchto.searchto_model import RestartModel
from app.special.special_functions import SpecialFunctionsModel
from core.executor.snapshot import Alarm, LogEvent, MachineState
from tests.attached import attached
from tests.screen.hands import Hands
from tests.screen.lathe import Key, Operator

LOGGED = 30


@pytest.fixture
def ready(operator: Operator) -> Operator:
    operator.stage.make_ready()
    return operator


def fill_log(operator: Operator) -> None:
    for line in range(LOGGED):
        alarm = Alarm(102, "following", "FOLLOWING ERROR", "cause", "free the slide", line=line + 1)
        operator.stage.desk.hear(LogEvent(float(line), "alarm", alarm.text, alarm.line, alarm))
    operator.window.refresh()


def wait_for_text(qtbot: QtBot, operator: Operator, page: EditorPage) -> None:
    def look() -> bool:
        operator.window.refresh()
        return page.editor.stage is EditorStage.OPEN and page.text_field.isVisible()

    qtbot.waitUntil(look, timeout=60_000)


def press_focused(key: Key) -> None:
    """Press a key where the keyboard focus is, which can be a text field."""
    focused = QApplication.focusWidget()
    assert focused is not None
    QTest.keyClick(focused, key)


def wait_for_programs(qtbot: QtBot, operator: Operator, programs: ProgramListModel) -> None:
    def look() -> bool:
        operator.window.refresh()
        return len(programs.listed_programs) > 1

    qtbot.waitUntil(look, timeout=60_000)


def test_end_and_home_select_last_and_first_special_function(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.SPECIAL)
    functions = attached(ready.stage.desk, SpecialFunctionsModel)
    ready.key(Key.Key_End)
    assert functions.at == len(functions.functions) - 1
    ready.key(Key.Key_Home)
    assert functions.at == 0


def test_end_and_home_select_last_and_first_program(qtbot: QtBot, ready: Operator) -> None:
    assert ready.frame.open_page(page_table.PROGRAMS)
    programs = attached(ready.stage.desk, ProgramListModel)
    wait_for_programs(qtbot, ready, programs)
    ready.key(Key.Key_End)
    assert programs.selected_row == len(programs.listed_programs) - 1
    ready.key(Key.Key_Home)
    assert programs.selected_row == 0


def test_end_and_home_select_last_and_first_tool(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.TOOLS)
    page = ready.frame.current_page
    assert isinstance(page, ToolOffsetsPage)
    ready.key(Key.Key_End)
    assert page.model.tool_number == 32
    ready.key(Key.Key_Home)
    assert page.model.tool_number == 1


def test_end_and_home_select_last_and_first_tool_shape(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.SHAPE)
    model = getattr(ready.frame.current_page, "model")  # noqa: B009
    assert isinstance(model, ToolShapeTable)
    ready.key(Key.Key_End)
    assert model.tool_number == 32
    ready.key(Key.Key_Home)
    assert model.tool_number == 1


def test_end_and_home_select_last_and_first_zero_offset(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.ZERO)
    model = getattr(ready.frame.current_page, "model")  # noqa: B009
    ready.key(Key.Key_End)
    assert model.number == 59
    ready.key(Key.Key_Home)
    assert model.number == 54


def test_end_and_home_select_last_and_first_line_of_searchto(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.SEARCHTO_PAGE)
    cursor = attached(ready.stage.desk, RestartModel).line_cursor
    ready.key(Key.Key_End)
    assert cursor.selected_line == len(cursor.program_lines)
    ready.key(Key.Key_Home)
    assert cursor.selected_line == 1


def test_end_shows_the_last_line_of_the_program(qtbot: QtBot, ready: Operator) -> None:
    listing = ready.frame.automatic_page.program_listing
    ready.window.grab()
    ready.key(Key.Key_End)
    ready.window.grab()
    assert listing.first_row > 0
    assert not listing.follows_run
    ready.key(Key.Key_Home)
    assert listing.follows_run


@pytest.mark.parametrize("page", [page_table.PROGRAMS, page_table.MDI, page_table.AUTOMATIC])
def test_keys_of_the_alarm_log_do_not_reach_the_covered_page(ready: Operator, page: str) -> None:
    assert ready.frame.open_page(page)
    programs = attached(ready.stage.desk, ProgramListModel)
    fill_log(ready)
    before = programs.selected_row, ready.mdi.mdi_input.text
    ready.key(Key.Key_F7)
    ready.window.grab()
    log = ready.frame.alarm_list
    ready.key(Key.Key_Down)
    assert log.marked == 1
    ready.key(Key.Key_End)
    ready.window.grab()
    assert (log.marked, log.first_row + log.rows) == (LOGGED - 1, LOGGED)
    ready.key(Key.Key_Home, Key.Key_Up)
    ready.window.grab()
    assert log.first_row == log.marked == 0
    assert (programs.selected_row, ready.mdi.mdi_input.text) == before


@pytest.mark.parametrize("key", [Key.Key_Left, Key.Key_Right, Key.Key_Down, Key.Key_Up, Key.Key_PageUp])
def test_no_key_jogs_an_axis_while_the_alarm_log_covers_the_jog_page(ready: Operator, key: Key) -> None:
    assert ready.frame.open_page(page_table.JOG)
    fill_log(ready)
    ready.key(Key.Key_F7)
    before = ready.shot.demand
    QTest.keyPress(ready.window, key)
    ready.pause(0.3)
    assert (ready.shot.state, ready.shot.demand) == (MachineState.IDLE, before)
    QTest.keyRelease(ready.window, key)
    ready.key(Key.Key_F7)
    QTest.keyPress(ready.window, Key.Key_Left)
    ready.reaches(MachineState.JOG)  # The page receives the keys again.
    QTest.keyRelease(ready.window, Key.Key_Left)
    ready.reaches(MachineState.IDLE)


def test_the_alarm_log_stops_the_axis_that_an_arrow_key_moves(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.JOG)
    QTest.keyPress(ready.window, Key.Key_Left)
    ready.reaches(MachineState.JOG)
    ready.key(Key.Key_F7)
    ready.reaches(MachineState.IDLE)
    QTest.keyRelease(ready.window, Key.Key_Left)


def test_no_key_reaches_the_line_that_the_alarm_log_covers(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.MDI)
    ready.type("M0")
    ready.key(Key.Key_F7)
    ready.type("8")
    ready.key(Key.Key_Return)
    assert (ready.mdi.mdi_input.text, ready.mdi.prepared_line.worker.is_busy) == ("M0", False)
    ready.key(Key.Key_F7)
    ready.type("8")
    assert ready.mdi.mdi_input.text == "M08"


@pytest.mark.parametrize("cover", [Key.Key_F7, Key.Key_Question])
def test_the_stop_key_in_the_prompt_stops_the_spindle_of_a_covered_jog_page(
    ready: Operator, cover: Key
) -> None:
    assert ready.frame.open_page(page_table.MDI)
    ready.run("G97M03S500")
    assert ready.frame.open_page(page_table.JOG)
    ready.until(lambda: ManualFunctions.is_spindle_turning(ready.shot))
    ready.key(cover)
    assert ready.frame.alarm_list.isVisible() or ready.frame.help_panel.isVisible()
    assert "0: STOP" in ready.prompt()
    ready.key(Key.Key_0)
    ready.until(lambda: not ManualFunctions.is_spindle_turning(ready.shot))
    assert ready.frame.help_panel.isHidden()


def test_zero_is_no_stop_key_while_it_is_a_digit_of_the_speed(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.JOG)
    ready.key(Key.Key_B, Key.Key_9)
    assert ready.frame.current_page.has_text_field()
    assert not ready.frame.current_page.make_stop_key_actions()


def test_the_alarm_log_closes_the_file_prompt_so_that_enter_loads_no_program(hands: Hands) -> None:
    hands.key(Key.Key_F2)
    hands.sees(hands.page.file_prompt.isVisible)
    before = hands.desk.program_loader.loaded_program
    hands.key(Key.Key_F7)
    assert hands.frame.alarm_list.isVisible()
    assert not hands.page.file_prompt.isVisible()
    assert not hands.frame.has_text_field()
    hands.key(Key.Key_Return)
    assert hands.desk.program_loader.loaded_program is before


def test_the_alarm_log_takes_the_keys_from_a_field_of_the_editor_and_returns_them(
    qtbot: QtBot, ready: Operator
) -> None:
    assert ready.frame.open_page(page_table.EDITOR)
    page = ready.frame.current_page
    assert isinstance(page, EditorPage)
    wait_for_text(qtbot, ready, page)
    press_focused(Key.Key_F5)  # GO TO
    field = QApplication.focusWidget()
    assert isinstance(field, QLineEdit)
    press_focused(Key.Key_1)
    typed = field.text()
    press_focused(Key.Key_F7)
    assert ready.frame.alarm_list.isVisible()
    assert not ready.frame.has_text_field()
    press_focused(Key.Key_2)
    press_focused(Key.Key_Return)
    assert field.text() == typed
    assert ready.frame.alarm_list.isVisible()
    press_focused(Key.Key_F7)
    assert QApplication.focusWidget() is field
    press_focused(Key.Key_3)
    assert field.text() == typed + "3"


@pytest.mark.parametrize("text", ["x-1.5", "x+", "g,", "r", "d", "u", "t", "a", "y", "n"])
def test_text_for_a_covered_entry_is_no_command(ready: Operator, text: str) -> None:
    assert ready.frame.open_page(page_table.MDI)
    ready.type("G0")
    ready.key(Key.Key_F7)
    before = ready.shot.feed_override, ready.shot.spindle_override, ready.window.theme.palette
    ready.type(text)
    assert "F7" in ready.prompt()
    ready.pause(0.1)
    shot = ready.shot
    assert (shot.feed_override, shot.spindle_override, ready.window.theme.palette) == before
    assert (shot.state, ready.mdi.mdi_input.text) == (MachineState.IDLE, "G0")
    assert not ready.stage.desk.confirmation_key
    assert ready.frame.alarm_list.isVisible()


def test_drives_stay_off_when_d_is_typed_for_a_covered_entry(operator: Operator) -> None:
    operator.until(lambda: operator.shot.state is MachineState.DISABLED)
    assert operator.frame.open_page(page_table.MDI)
    operator.key(Key.Key_F7, Key.Key_D)
    operator.pause(0.5)
    assert operator.shot.state is MachineState.DISABLED


@pytest.mark.parametrize("key", [Key.Key_H, Key.Key_Space])
def test_stop_letters_are_no_text_for_a_covered_entry(ready: Operator, key: Key) -> None:
    assert ready.frame.open_page(page_table.MDI)
    ready.key(Key.Key_F7)
    ready.key(key)
    assert "F7" not in ready.prompt()


def test_e_presses_the_estop_while_the_alarm_log_covers_an_entry(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.MDI)
    ready.key(Key.Key_F7, Key.Key_E)
    ready.reaches(MachineState.ESTOP)


def test_a_question_is_answered_while_the_alarm_log_covers_an_entry(ready: Operator) -> None:
    assert ready.frame.open_page(page_table.MDI)
    ready.key(Key.Key_F7)
    answers: list[str] = []
    ready.stage.desk.ask_operator("SURE?", lambda: answers.append("yes"))
    ready.pause(READING_TIME_S + 0.1)
    ready.key(Key.Key_Y)
    assert answers == ["yes"]


@pytest.mark.parametrize("key", [Key.Key_F2, Key.Key_F5])
def test_a_function_key_of_the_page_closes_the_alarm_log_first(ready: Operator, key: Key) -> None:
    assert ready.frame.open_page(page_table.JOG)
    ready.key(Key.Key_F7)
    ready.key(key)
    assert not ready.frame.alarm_list.isVisible()


def test_home_does_not_select_a_program_while_its_new_name_is_typed(qtbot: QtBot, ready: Operator) -> None:
    assert ready.frame.open_page(page_table.PROGRAMS)
    programs = attached(ready.stage.desk, ProgramListModel)
    wait_for_programs(qtbot, ready, programs)
    ready.key(Key.Key_End, Key.Key_F4)
    chosen = programs.selected_row
    assert programs.name_question
    ready.key(Key.Key_Home)
    assert programs.selected_row == chosen > 0
