"""MDI by keys alone, on the executor and the simulated lathe."""

from __future__ import annotations

from itertools import chain

import pytest

from app.mdi.mdi_view import MdiPage
from app.screen import page_table
from app.screen.entry_panel import LINE_KEYS
from core.executor.snapshot import MachineState, StartAction
from tests.screen.lathe import Key, Operator
from tests.screen.yes import yes
from tests.texts import begins, shows, text

INCH = 25.4


@pytest.fixture
def at_mdi(operator: Operator) -> Operator:
    """Drives on, MDI in front."""
    operator.drives_on()
    operator.key(Key.Key_F1, Key.Key_F4)
    assert operator.frame.title_line.page_title == page_table.MDI
    operator.pause(0.05)
    return operator


def page_of(operator: Operator) -> MdiPage:
    page = operator.frame.current_page
    assert isinstance(page, MdiPage)
    operator.window.refresh()
    return page


def value(operator: Operator, key: str) -> str:
    return next(row.active_code for row in page_of(operator).modal_panel.rows if row.key == key)


def test_mdi_line_is_proved_and_run_and_its_modes_remain(at_mdi: Operator) -> None:
    assert value(at_mdi, "distance") == "—"
    at_mdi.run("G90G72")
    assert (value(at_mdi, "distance"), value(at_mdi, "x words")) == ("G90", "G72 Ø")
    at_mdi.run("x.5f100")
    assert at_mdi.shot.actual[0] == pytest.approx(0.25 * INCH, abs=0.006)
    assert value(at_mdi, "feed") == "100.00 in/min"
    assert page_of(at_mdi).history_panel.history_lines == ("G90G72", "x.5f100")
    assert page_of(at_mdi).line_panel.text == ""


def test_mdi_error_is_marked_and_can_be_corrected(at_mdi: Operator) -> None:
    at_mdi.run("G90")
    at_mdi.line("X.5F1000")
    page = page_of(at_mdi)
    assert page.line_panel.diagnostics[0].column == 4
    assert shows(page.line_panel.finding_text, "screen.feed-out-of-range")
    assert begins(at_mdi.prompt(), "screen.line-does-not-run")
    at_mdi.palms()
    assert at_mdi.shot.state is MachineState.IDLE
    assert at_mdi.prompt() == text("screen.no-line-ready")
    at_mdi.key(Key.Key_Backspace)
    assert page_of(at_mdi).line_panel.diagnostics == ()
    at_mdi.key(Key.Key_Return)
    at_mdi.mdi.prepared_line.worker.wait_for_results(60.0)
    assert at_mdi.prompt() == text("screen.run-the-line", start=text("screen.both-palms"))


def test_changed_line_is_not_ready_to_start(at_mdi: Operator) -> None:
    at_mdi.run("G91F50")
    at_mdi.line("X.1")
    assert page_of(at_mdi).line_panel.is_ready
    at_mdi.type("0")
    at_mdi.palms()
    assert at_mdi.shot.state is MachineState.IDLE
    assert at_mdi.shot.actual[0] == pytest.approx(0.0, abs=0.006)
    assert not page_of(at_mdi).line_panel.is_ready


def test_history_is_used_by_arrow_keys_and_touch(at_mdi: Operator) -> None:
    for line in ("G90F50", "X.1", "Z-.1"):
        at_mdi.run(line)
    at_mdi.type("X.")
    at_mdi.key(Key.Key_Up, Key.Key_Up)
    assert page_of(at_mdi).line_panel.text == "X.1"
    at_mdi.key(Key.Key_Down, Key.Key_Down)
    assert page_of(at_mdi).line_panel.text == "X."  # what was being typed
    page = page_of(at_mdi)
    at_mdi.window.grab()
    page.history_panel._places[0][1]()
    assert page_of(at_mdi).line_panel.text == "G90F50"


def test_cursor_moves_within_line(at_mdi: Operator) -> None:
    at_mdi.type("G9X.1")
    at_mdi.key(Key.Key_Left, Key.Key_Left, Key.Key_Left)
    at_mdi.type("1")
    assert page_of(at_mdi).line_panel.text == "G91X.1"
    at_mdi.key(Key.Key_Delete)
    assert page_of(at_mdi).line_panel.text == "G91.1"
    at_mdi.key(Key.Key_Escape)
    assert page_of(at_mdi).line_panel.text == ""


def test_history_is_reloaded_next_day(at_mdi: Operator) -> None:
    at_mdi.run("G90F50")
    at_mdi.key(Key.Key_F1)
    at_mdi.key(Key.Key_F4)
    at_mdi.mdi.mdi_input.history_lines = []
    at_mdi.mdi.mdi_input.reload_history()
    assert at_mdi.mdi.mdi_input.history_lines == ["G90F50"]


def test_letters_act_as_keys_while_line_runs(at_mdi: Operator) -> None:
    at_mdi.run("G90")
    at_mdi.line("X1F5")
    at_mdi.palms()
    assert at_mdi.shot.state is MachineState.RUN
    at_mdi.key(Key.Key_H)
    at_mdi.reaches(MachineState.HOLD)
    at_mdi.key(Key.Key_F1)  # it is still under way
    assert at_mdi.frame.title_line.page_title == page_table.MDI
    at_mdi.key(Key.Key_R)
    yes(at_mdi.window)
    at_mdi.reaches(MachineState.IDLE)
    assert value(at_mdi, "distance") == "G90"
    at_mdi.type("R")  # text again
    assert page_of(at_mdi).line_panel.text == "R"


def test_every_letter_can_be_typed_with_drives_off(at_mdi: Operator) -> None:
    at_mdi.type("X.5 he")
    assert page_of(at_mdi).line_panel.text == "X.5 he"
    assert at_mdi.shot.state is MachineState.IDLE
    at_mdi.window.press_estop()
    at_mdi.reaches(MachineState.ESTOP)
    override = at_mdi.shot.feed_override
    at_mdi.type("+-sod/")
    at_mdi.pause(1.0)
    assert page_of(at_mdi).line_panel.text == "X.5 he+-sod/"
    assert at_mdi.shot.feed_override == override
    assert not at_mdi.shot.single_block
    at_mdi.key(Key.Key_Return)
    assert shows(at_mdi.prompt(), "screen.line-proved-with-drives")


def test_spindle_stays_on_after_leaving_page_until_its_stop_key(at_mdi: Operator) -> None:
    at_mdi.run("M03S900")
    at_mdi.pause(2.0)
    at_mdi.key(Key.Key_F1)
    assert at_mdi.frame.title_line.page_title == page_table.MENU
    at_mdi.pause(1.0)
    assert at_mdi.shot.rpm_actual == pytest.approx(900, rel=0.05)
    assert at_mdi.shot.starts is StartAction.PROGRAM
    at_mdi.key(Key.Key_F4)
    assert value(at_mdi, "spindle") == "M03"
    at_mdi.key(Key.Key_F8)
    at_mdi.pause(0.05)
    assert at_mdi.shot.rpm_command == 0.0
    assert value(at_mdi, "spindle") == "M05"


def test_mdi_does_not_open_while_program_runs(operator: Operator) -> None:
    operator.stage.start()
    operator.key(Key.Key_F1, Key.Key_F4)
    assert operator.frame.title_line.page_title == page_table.MENU
    assert begins(operator.prompt(), "screen.program-runs-no-mdi")


def test_palm_buttons_start_no_program_on_mdi_page(at_mdi: Operator) -> None:
    desk = at_mdi.stage.desk
    desk.program_choice.load_by_name("bushing")
    desk.program_loader.wait_until_loaded(30.0)
    at_mdi.palms()
    assert at_mdi.shot.state is MachineState.IDLE
    at_mdi.key(Key.Key_F2)
    assert at_mdi.frame.current_page is at_mdi.frame.automatic_page
    at_mdi.palms()
    assert at_mdi.shot.state in {MachineState.RUN, MachineState.WAIT}


def test_tool_without_offset_is_rejected_before_start(at_mdi: Operator) -> None:
    at_mdi.line("T9")
    assert shows(page_of(at_mdi).line_panel.finding_text, "screen.tool-never-set", number=9)
    assert at_mdi.mdi.prepared_line.ready_job is None
    at_mdi.key(Key.Key_Escape)
    at_mdi.run("T1")
    assert value(at_mdi, "tool").startswith("T1")


def test_mdi_unit_applies_to_program_without_unit_code(at_mdi: Operator) -> None:
    desk = at_mdi.stage.desk
    desk.program_choice.load_by_name("bushing")
    desk.program_loader.wait_until_loaded(30.0)
    at_mdi.run("G71")
    at_mdi.key(Key.Key_F2)
    at_mdi.window.refresh()
    loaded = desk.program_loader.wait_until_loaded(30.0)
    assert loaded.job is not None
    assert loaded.job.setup.metric
    assert any(found.code == "units-unnamed" for found in loaded.diagnostics)


def test_line_is_typed_by_touch_only(at_mdi: Operator) -> None:
    page = page_of(at_mdi)
    at_mdi.window.grab()
    page.line_panel._places[0][1]()
    assert page.letter_pad.isVisible()
    at_mdi.window.refresh()
    at_mdi.window.grab()
    keys = dict(zip(chain(*LINE_KEYS), page.letter_pad._places, strict=True))
    assert keys.keys() >= set("()/}=+~")  # without them no loop, no function in parentheses
    for key in (*"G91X.1F50", "Back", "Back", "8", "Enter"):
        box, press, *_ = keys[key]
        assert min(box.width(), box.height()) >= 42  # 9 mm
        press()
    at_mdi.mdi.prepared_line.worker.wait_for_results(60.0)
    at_mdi.pause(0.05)
    assert page_of(at_mdi).line_panel.is_ready
    at_mdi.palms()
    at_mdi.reaches(MachineState.IDLE)
    assert at_mdi.shot.actual[0] == pytest.approx(0.1 * INCH, abs=0.006)
    page.line_panel._places[0][1]()
    assert page.letter_pad.isHidden()
