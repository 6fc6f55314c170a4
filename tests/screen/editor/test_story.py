"""Programs written, mended, saved and brought back, by keys alone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import Qt

from app.desk.pages import page_entry
from app.desk.programs.program_loading import LoadingPhase
from app.editor import editor_messages as messages
from app.editor.editor_model import EditorStage
from app.programs.program_list_model import ProgramListModel
from app.screen import page_table
from core.executor.commands import CycleStart, FeedHold, LoadJob
from core.executor.snapshot import MachineState
from core.language.diagnostics import Severity
from tests.editor.shop import GOOD, Memory
from tests.screen.desks import SAMPLES
from tests.screen.editor.writer import Writer
from tests.screen.hands import Key
from tests.texts import begins, shows
from tests.texts import text as wording

CTRL = Qt.KeyboardModifier.ControlModifier


def test_new_program_is_written_corrected_and_saved(writer: Writer, tmp_path: Path, memory: Memory) -> None:
    writer.key(Key.Key_F2)
    writer.type("first")
    writer.key(Key.Key_Return)
    writer.key(Key.Key_X)  # FILE NOT FOUND, any key
    writer.key(Key.Key_F3)
    assert writer.prompt() == wording("screen.new-file")
    writer.key(Key.Key_F1)
    writer.sees(lambda: writer.editor.head_line.heading.mark == "NEW")
    writer.write(GOOD.replace("Z-.5", "Z-.5.5"))
    writer.sees(writer.proved)
    found = writer.editor.text_field.find_finding(5)
    assert found is not None
    assert found.severity is Severity.ERROR
    writer.key(Key.Key_F6)
    writer.sees(lambda: writer.editor.text_field.cursor_line == 5)
    writer.sees(lambda: found.message in writer.prompt())
    writer.key(Key.Key_End)
    writer.key(Key.Key_Backspace)
    writer.key(Key.Key_Backspace)
    writer.sees(lambda: writer.proved() and not writer.editor.finding_list.findings.diagnostics)
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    assert writer.desk.program_loader.loaded_program.name == "first.nc"
    assert (tmp_path / "first.nc").read_text() == GOOD
    assert [text for text, _why in memory.kept["first.nc"]] == [GOOD.encode()]
    writer.sees(lambda: writer.prompt().startswith(wording("screen.to-start")))


def test_esc_aborts_a_new_file(writer: Writer, tmp_path: Path) -> None:
    writer.key(Key.Key_F2)
    writer.type("first")
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.prompt() == messages.CREATE_FILE)
    writer.key(Key.Key_Escape)
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    assert not list(tmp_path.glob("[!.]*"))  # no program; a draft is none


def test_create_prompt_does_not_show_last_edited_text(writer: Writer) -> None:
    writer.edit("pin")
    writer.key(Key.Key_F10)
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    writer.key(Key.Key_F2)
    writer.type("first")
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.prompt() == messages.CREATE_FILE)
    assert not writer.editor.text_field.isVisible()
    assert writer.editor.head_line.heading.name == "first"
    writer.key(Key.Key_F1)
    writer.sees(writer.editor.text_field.hasFocus)
    writer.sees(lambda: writer.text() == "")


def test_invalid_name_is_rejected_with_message(writer: Writer) -> None:
    writer.key(Key.Key_F2)
    writer.type("bad?name")
    writer.key(Key.Key_F3)
    writer.key(Key.Key_F1)
    writer.sees(lambda: shows(writer.prompt(), "editor.no-program-name"))
    writer.key(Key.Key_Escape)
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)


def test_editor_does_not_open_without_program_or_name(writer: Writer) -> None:
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.prompt() == page_entry.NO_PROGRAM)
    assert writer.front == page_table.AUTOMATIC


@pytest.mark.parametrize(
    "state", [MachineState.RUN, MachineState.HOLD, MachineState.SINGLE_BLOCK_STOP, MachineState.WAIT]
)
def test_text_is_edited_while_loaded_program_runs_unchanged(writer: Writer, state: MachineState) -> None:
    writer.load("pin")
    loaded = writer.desk.program_loader.loaded_program
    writer.machine.now = replace(writer.machine.now, state=state, rpm_command=900.0, rpm_actual=900.0)
    writer.machine.blocks = ()
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.EDITOR)
    assert writer.desk.program_loader.loaded_program is loaded
    assert not writer.desk.window_state.can_start_here  # the palms are for the Automatic page


def test_editor_does_not_open_while_axis_is_jogged(writer: Writer) -> None:
    writer.load("pin")
    writer.machine.now = replace(writer.machine.now, state=MachineState.JOG)
    writer.key(Key.Key_F3)
    assert writer.prompt() == page_entry.AXES_MOVING
    assert writer.front == page_table.AUTOMATIC


@pytest.mark.parametrize(
    ("command", "measured", "why"), [(900, 0, page_entry.SPINDLE_ON), (0, 80, page_entry.SPINDLE_COASTING)]
)
def test_editor_does_not_open_while_spindle_turns(
    writer: Writer, command: int, measured: int, why: str
) -> None:
    writer.load("pin")
    writer.machine.now = replace(writer.machine.now, rpm_command=command, rpm_actual=measured)
    writer.key(Key.Key_F3)
    assert writer.prompt() == why
    assert writer.front == page_table.AUTOMATIC


def test_palm_buttons_start_nothing_in_editor(writer: Writer) -> None:
    writer.edit("pin")
    writer.both_palms()
    assert CycleStart() not in writer.machine.posted


def test_saving_sample_asks_for_name_and_leaves_sample_unchanged(writer: Writer, tmp_path: Path) -> None:
    before = (SAMPLES / "pin.nc").read_bytes()
    writer.edit("pin")
    assert writer.editor.head_line.heading.mark == "SAMPLE"
    writer.type("(MINE)")
    writer.key(Key.Key_F2)
    writer.sees(lambda: writer.prompt() == messages.SAMPLE_READ_ONLY)
    writer.sees(writer.editor.question_line.first_field.hasFocus)
    writer.type("mine")
    writer.key(Key.Key_Return)
    writer.sees(lambda: writer.prompt() == wording("editor.saved", name="mine.nc"))
    assert (SAMPLES / "pin.nc").read_bytes() == before
    assert (tmp_path / "mine.nc").read_bytes() == b"(MINE)" + before
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    assert writer.desk.program_loader.loaded_program.name == "mine.nc"


def test_esc_at_name_of_sample_returns_to_editing(writer: Writer, tmp_path: Path) -> None:
    writer.edit("pin")
    writer.type("(MINE)")
    writer.key(Key.Key_F3)
    writer.sees(writer.editor.question_line.first_field.hasFocus)
    writer.key(Key.Key_Escape)
    writer.sees(writer.editor.text_field.hasFocus)
    writer.type("X")
    assert writer.text().startswith("(MINE)X")
    assert not list(tmp_path.glob("[!.]*"))  # no program; a draft is none


def test_find_counts_matches_and_replace_all_is_one_undo_step(writer: Writer) -> None:
    writer.new("feeds")
    writer.write("F100\nX1F1000\nZ1F100")
    writer.key(Key.Key_F, CTRL)
    writer.type("f100")
    writer.sees(
        lambda: (
            writer.editor.question_line.message_text
            == wording("editor.found-and-inside", found=wording("editor.found", count=2), count=1)
        )
    )
    writer.key(Key.Key_Tab)
    writer.type("F300")
    writer.key(Key.Key_F5)
    assert writer.editor.question_line.message_text == wording("editor.replaced", count=2)
    assert writer.text() == "F300\nX1F1000\nZ1F300"
    writer.key(Key.Key_Escape)
    writer.key(Key.Key_Z, CTRL)
    assert writer.text() == "F100\nX1F1000\nZ1F100"


def test_matches_are_replaced_one_at_a_time(writer: Writer) -> None:
    writer.new("feeds")
    writer.write("F1\nF1\nF1")
    writer.key(Key.Key_F4)
    writer.type("F1")
    writer.key(Key.Key_Tab)
    writer.type("F2")
    for _ in range(2):
        writer.key(Key.Key_F4)
    assert writer.text().count("F2") == 2
    assert writer.text().count("F1") == 1


def test_go_to_line_rejects_invalid_line_number(writer: Writer) -> None:
    writer.edit("pin")
    writer.key(Key.Key_F5)
    writer.type("0")
    writer.key(Key.Key_Return)
    assert begins(writer.editor.question_line.message_text, "editor.number-from-one")
    writer.key(Key.Key_Backspace)
    writer.type("7")
    writer.key(Key.Key_Return)
    assert writer.editor.text_field.cursor_line == 7


def test_the_path_follows_the_cursor(writer: Writer) -> None:
    writer.new("path")
    writer.write(GOOD)
    writer.sees(writer.proved)
    writer.key(Key.Key_G, CTRL)
    writer.type("4")
    writer.key(Key.Key_Return)
    writer.sees(lambda: writer.editor.path_view.tip_position.z == pytest.approx(2.54))
    writer.key(Key.Key_Down)
    writer.sees(lambda: writer.editor.path_view.tip_position.z == pytest.approx(-12.7))
    assert writer.editor.path_view.tip_position.x == pytest.approx(12.7)  # X1 is a diameter of one inch


def test_an_older_version_is_restored_and_can_be_undone(writer: Writer, memory: Memory) -> None:
    writer.new("part")
    writer.write(GOOD)
    writer.key(Key.Key_F2)
    writer.sees(lambda: shows(writer.prompt(), "editor.saved"))
    writer.type("(SECOND)")
    writer.key(Key.Key_F2)
    writer.sees(lambda: len(memory.kept["part.nc"]) == 2)
    writer.sees(lambda: shows(writer.prompt(), "editor.saved"))
    writer.key(Key.Key_F7)
    writer.sees(lambda: len(writer.editor.version_history.rows) == 2)
    writer.key(Key.Key_Down)
    writer.sees(lambda: [row.sign for row in writer.editor.version_history.changes].count("-") == 1)
    writer.key(Key.Key_Return)
    writer.sees(lambda: writer.text() == GOOD)
    writer.key(Key.Key_Z, CTRL)
    assert writer.text() == GOOD.rstrip("\n") + "(SECOND)"


def test_leaving_without_saving_asks_once(writer: Writer, tmp_path: Path) -> None:
    writer.new("gone")
    writer.write("X1")
    writer.key(Key.Key_F10)
    writer.sees(lambda: writer.prompt() == messages.CONFIRM_DISCARD)
    writer.key(Key.Key_F10)
    writer.sees(lambda: writer.prompt() == messages.CONFIRM_DISCARD)  # never the key that asked
    writer.key(Key.Key_F6)
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    assert not list(tmp_path.glob("[!.]*"))  # no program; a draft is none


def test_typing_cancels_discard_question(writer: Writer) -> None:
    writer.new("kept")
    writer.write("X1")
    writer.key(Key.Key_F10)
    writer.sees(lambda: writer.prompt() == messages.CONFIRM_DISCARD)
    writer.type("Z1")
    writer.sees(lambda: writer.prompt() != messages.CONFIRM_DISCARD)
    writer.key(Key.Key_F10)
    writer.sees(lambda: writer.prompt() == messages.CONFIRM_DISCARD)
    assert writer.text() == "X1Z1"


def test_esc_holds_cycle_started_at_station(writer: Writer) -> None:
    writer.edit("pin")
    writer.machine.now = replace(writer.machine.now, state=MachineState.RUN)
    writer.sees(lambda: writer.prompt() == messages.TEXT_NOT_RUNNING)
    writer.key(Key.Key_Escape)
    assert FeedHold() in writer.machine.posted


def test_closing_the_window_saves_first(writer: Writer, tmp_path: Path) -> None:
    writer.new("closing")
    writer.write(GOOD)
    writer.sees(writer.proved)
    assert not writer.window.close()
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    assert (tmp_path / "closing.nc").read_text() == GOOD


def test_an_empty_program_is_not_saved(writer: Writer) -> None:
    writer.new("empty")
    writer.key(Key.Key_F2)
    writer.sees(lambda: writer.prompt() == messages.EMPTY_NOT_SAVED)
    writer.key(Key.Key_F3)  # an untouched new file is forgotten
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)


def test_f1_saves_and_opens_main_menu(writer: Writer, tmp_path: Path) -> None:
    writer.new("menu")
    writer.write(GOOD)
    writer.key(Key.Key_F1)
    writer.sees(lambda: writer.front == page_table.MENU)
    assert (tmp_path / "menu.nc").exists()
    assert writer.desk.program_loader.loaded_program.phase is LoadingPhase.EMPTY  # that is what F3 is for
    assert writer.desk.prompt_notice == wording("editor.saved-not-loaded", name="menu.nc")


def test_viewing_program_leaves_loaded_program_unchanged(writer: Writer, tmp_path: Path) -> None:
    for name in ("mine.nc", "other.nc"):
        (tmp_path / name).write_text(GOOD)
    assert writer.desk.program_choice.load_by_name("mine")
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    on_desk, posted, model = (
        writer.desk.program_loader.loaded_program,
        len(writer.machine.posted),
        writer.desk.page_registry.find_model(ProgramListModel),
    )
    assert model is not None
    for leaves in (Key.Key_F1, Key.Key_F3, Key.Key_Escape):
        writer.frame.open_page(page_table.PROGRAMS)
        writer.sees(lambda: "other.nc" in [program.name for program in model.listed_programs])
        model.select_row([program.name for program in model.listed_programs].index("other.nc"))
        writer.key(Key.Key_F3)
        writer.sees(lambda: writer.front == page_table.EDITOR and writer.editor.editor.name == "other.nc")
        writer.sees(lambda: writer.editor.editor.stage is EditorStage.OPEN)
        writer.key(leaves)
        writer.sees(lambda: writer.front != page_table.EDITOR)
        assert writer.desk.program_loader.loaded_program is on_desk
        if leaves is not Key.Key_Escape:
            assert writer.desk.prompt_notice == wording(
                "editor.only-looked-at", name="other.nc", other="mine.nc"
            )
    assert not [each for each in writer.machine.posted[posted:] if isinstance(each, LoadJob)]


def test_f1_saves_only_and_f3_loads_the_saved_text(writer: Writer, tmp_path: Path) -> None:
    """F1 loaded the text although the prompt said that it does not, and the next start ran it."""
    (tmp_path / "mine.nc").write_text(GOOD)
    assert writer.desk.program_choice.load_by_name("mine")
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    on_desk, posted = writer.desk.program_loader.loaded_program, len(writer.machine.posted)
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.editor.editor.stage is EditorStage.OPEN)
    writer.write("(CHANGED)\n")
    writer.key(Key.Key_F1)
    writer.sees(lambda: writer.front == page_table.MENU)
    assert "(CHANGED)" in (tmp_path / "mine.nc").read_text()
    assert writer.desk.program_loader.loaded_program is on_desk
    assert not [each for each in writer.machine.posted[posted:] if isinstance(each, LoadJob)]
    assert writer.desk.prompt_notice == wording("editor.saved-old-runs", name="mine.nc")
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.EDITOR and writer.editor.editor.stage is EditorStage.OPEN)
    writer.key(Key.Key_F3)  # nothing has been typed since, and yet it is not what is loaded
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    source = writer.desk.program_loader.loaded_program.source
    assert source is not None
    assert "(CHANGED)" in source.text


def test_every_page_shows_that_saved_text_is_not_loaded(writer: Writer) -> None:
    writer.desk.storage_state.set_file_readers(lambda: "DIFFERENT", lambda: None)
    for page in (page_table.AUTOMATIC, page_table.PROGRAMS, page_table.MENU):
        writer.frame.open_page(page)
        writer.sees(lambda page=page: writer.front == page)  # type: ignore[misc]
        writer.sees(lambda: "DIFFERENT" in [row.text for row in writer.frame.notice_rows.notice_rows])


def test_another_document_does_not_show_the_findings_of_the_last_one(writer: Writer, tmp_path: Path) -> None:
    """Two files of one name in two folders: the findings of the first stood beside the second."""
    writer.new("first")
    writer.write("G90G94\nQ\n")
    editor = writer.editor.editor
    writer.sees(lambda: editor.live_proof.current_findings.error_count > 0)
    writer.key(Key.Key_F1)
    writer.sees(lambda: writer.front == page_table.MENU)
    other = tmp_path / "other" / "first.nc"
    other.parent.mkdir()
    other.write_text(GOOD)
    editor.live_proof.worker.cancel_request()
    editor.open_program(other)
    while editor.document is None:
        editor.poll()
    assert editor.live_proof.current_findings.error_count == 0  # before its own proof


def test_loaded_program_is_reloaded_when_its_file_changes(writer: Writer, tmp_path: Path) -> None:
    (tmp_path / "mine.nc").write_text(GOOD)
    assert writer.desk.program_choice.load_by_name("mine")
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    before = writer.desk.program_loader.load_count
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.editor.editor.stage is EditorStage.OPEN)
    writer.key(Key.Key_F1)
    writer.sees(lambda: writer.front == page_table.MENU)
    assert writer.desk.program_loader.load_count == before
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.EDITOR and writer.editor.editor.stage is EditorStage.OPEN)
    writer.write("(CHANGED)\n")
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    writer.sees(lambda: writer.desk.program_loader.load_count == before + 1)
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)


def test_f3_with_unknown_name_offers_new_program_and_creates_no_file(writer: Writer, tmp_path: Path) -> None:
    """It edits no other one, and nothing is there before it is said so."""
    (tmp_path / "mine.nc").write_text(GOOD)
    assert writer.desk.program_choice.load_by_name("mine")
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    writer.frame.open_page(page_table.PROGRAMS)
    model = writer.desk.page_registry.find_model(ProgramListModel)
    assert model is not None
    writer.sees(lambda: bool(model.listed_programs))
    writer.type("NOSUCHNAME")
    writer.sees(lambda: not model.listed_programs)
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.frame.key_bar.key_labels[0] == "CREATE")
    writer.key(Key.Key_F10)
    writer.sees(lambda: writer.front != page_table.EDITOR)
    assert [path.name for path in tmp_path.glob("*.nc")] == ["mine.nc"]


def test_f3_in_empty_program_list_opens_no_editor(writer: Writer) -> None:
    writer.frame.open_page(page_table.PROGRAMS)
    model = writer.desk.page_registry.find_model(ProgramListModel)
    assert model is not None
    writer.sees(lambda: bool(model.listed_programs))
    model.all_programs, model.listed_programs = (), ()
    writer.key(Key.Key_F3)
    assert writer.front == page_table.PROGRAMS
    assert writer.desk.prompt_notice == wording("screen.no-program-marked")


def test_f3_at_file_question_edits_marked_or_typed_program(writer: Writer, tmp_path: Path) -> None:
    for name in ("mine.nc", "other.nc"):
        (tmp_path / name).write_text(GOOD)
    assert writer.desk.program_choice.load_by_name("mine")
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    writer.key(Key.Key_F2)
    writer.key(Key.Key_F3)
    assert writer.front == page_table.AUTOMATIC
    assert begins(writer.desk.prompt_notice, "editor.name-or-mark")
    files = writer.page.file_prompt
    names = [entry.name for entry in files._entries]
    for _ in range(names.index("other.nc")):
        writer.key(Key.Key_Down)
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.EDITOR and writer.editor.editor.name == "other.nc")


def test_machine_key_letters_are_typed_and_switch_nothing(writer: Writer) -> None:
    writer.new("letters")
    posted = len(writer.machine.posted)
    writer.type("SOCHRDEAT/,.+-Z")
    assert writer.text() == "SOCHRDEAT/,.+-Z"
    assert len(writer.machine.posted) == posted


def test_editor_session_saves_text_and_versions(writer: Writer, tmp_path: Path, memory: Memory) -> None:
    writer.new("day")
    writer.write("G90G94G72F300\nT1\nM03S1000\nX1Z.1\nF5Z-.5\nF5X1.5\nM05\nF300X2Z1\nM30")
    writer.sees(lambda: writer.proved() and not writer.editor.finding_list.findings.error_count)
    writer.key(Key.Key_F2)
    writer.sees(lambda: shows(writer.prompt(), "editor.saved"))
    written = writer.text()

    writer.key(Key.Key_F, CTRL)  # every feed of 5 to 8, and back again as one step
    writer.type("F5")
    writer.key(Key.Key_Tab)
    writer.type("F8")
    writer.key(Key.Key_F5)
    assert writer.editor.question_line.message_text == wording("editor.replaced", count=2)
    writer.key(Key.Key_Escape)
    assert writer.text() == written.replace("F5", "F8")
    writer.key(Key.Key_F8)
    assert writer.text() == written
    writer.key(Key.Key_F9)
    assert writer.text() == written.replace("F5", "F8")

    writer.key(Key.Key_G, CTRL)  # a line goes wrong, is found by F6 and mended
    writer.type("6")
    writer.key(Key.Key_Return)
    writer.key(Key.Key_End)
    writer.type("Q")
    writer.sees(lambda: writer.proved() and writer.editor.finding_list.findings.error_count > 0)
    writer.key(Key.Key_Home, CTRL)
    writer.key(Key.Key_F6)
    assert writer.editor.text_field.cursor_line == 6
    writer.key(Key.Key_End)
    writer.key(Key.Key_Backspace)
    writer.sees(lambda: writer.proved() and not writer.editor.finding_list.findings.error_count)
    writer.key(Key.Key_F2)
    writer.sees(lambda: len(memory.kept["day.nc"]) == 2)
    writer.sees(lambda: shows(writer.prompt(), "editor.saved"))

    writer.key(Key.Key_F7)  # the first version back, saved by leaving
    writer.sees(lambda: len(writer.editor.version_history.rows) == 2)
    writer.key(Key.Key_Down)
    writer.sees(lambda: [row.sign for row in writer.editor.version_history.changes].count("+") == 2)
    writer.key(Key.Key_Return)
    writer.sees(lambda: writer.text().rstrip() == written)
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    writer.sees(lambda: writer.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    assert (tmp_path / "day.nc").read_text().rstrip() == written
    assert len(memory.kept["day.nc"]) == 3
