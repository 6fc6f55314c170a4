"""Levels: off they change nothing, on they refuse with the way out, and the history says who did it."""

from __future__ import annotations

import re
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from app.editor.editor_model import EditorModel
from app.offsets.offset_changes import ConfirmedOffsetChanges, OffsetHistory
from app.production.parts_watch import ProductionMonitor
from app.programs.program_list_model import ProgramListModel
from app.special.counter_functions import PartsCounterFunction
from app.special.inputs_outputs import SignalListKind as Shown
from app.special.inputs_outputs import SignalsFunction
from app.special.lamps_and_sound import LampsAndSoundFunction
from app.special.machine_records import EVENT_FILTERS, MachineFileFunction
from app.special.operator_settings import SpindleLimitFunction
from app.special.setup_sheet_function import SetupSheetFunction
from app.transfer.line_transfer import ReceivedProgram
from app.transfer.serial_transfer import SerialTransferFunction
from core.access.access_page import make_access_page
from core.access.access_table import ACCESS_RULES, AccessLevel, ProtectedChange
from core.executor.snapshot import MachineState
from core.store import database
from core.store.offsets.touch_off import TouchPosition
from core.store.production.tool_lives import read_insert_changes
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import OffsetKind
from tests.desk.levels_room import LIMIT, Room, room
from tests.texts import begins, pattern, shows
from tests.texts import text as wording
from tests.whole_product import WHOLE_PRODUCT

__all__ = ["room"]
HOUSE = Path(__file__).parents[2]
OPERATORS = {
    ProtectedChange.WEAR,
    ProtectedChange.COUNTS,
    ProtectedChange.INSERTS,
    ProtectedChange.READINGS,
    ProtectedChange.JOBS,
    ProtectedChange.SCREEN,
    ProtectedChange.INPUTS,
    ProtectedChange.BACKUPS,
}
SERVICES = {
    ProtectedChange.MACHINE_FILE,
    ProtectedChange.RESTORE,
    ProtectedChange.SHARED_PLACE,
    ProtectedChange.PEOPLE,
}
WRITES = re.compile(
    r"\.(save_setting|save_settings|save_version|add_parts|reset_parts|import_programs_and_offsets|change_row)\("
    r"|\.(save_user|remove_user|remove_all_users|save_loaded_version|renamed|set_input|unlink)\("
    r"|\.(rename|write_text)\("
    r"|\b(write_program_file|write_new_file|copy_to_medium|write_atomically|store_received_program|ForceOutput|SetSpindleLimit)\("
)
BEHIND_A_RULE = {
    "compose/machine/accepted_machine.py": "asked by machine_records.py",
    "compose/runs/journal.py": "does what pages ask that have asked",
    "compose/part_data.py": "asked by part_options.py and part_model.py",
    "compose/machine/setup_file.py": "asked by setup_command.py",
    "extras/sharing/sharing_setup.py": "asked by share_command.py",
    "extras/access/sign_in.py": "asked by access_levels.py",
    "desk/persistence.py": "as journal.py",
    "desk/screen_settings.py": "asked by desk.py",
    "editor/edited_document.py": "asked by may_save of the editor; drafts are not saved",
    "extras/quality/sample_plan.py": "asked by features_section.py",
    "programs/run_history.py": "asked by counter_functions.py",
    "transfer/line_transfer.py": "asked by serial_command.py and serial_transfer.py",
}
NO_CHANGE = {
    "cli/actions/desktop_entry.py": "the menu of the system's user",
    "cli/json_reference/json_page.py": "a page of the manual",
    "cli/proofs/proof_cache.py": "proofs that can be made again",
    "cli/proofs/report_file.py": "a report, to a file of whoever asks",
    "desk/programs/recent_programs.py": "the paths of programs that were loaded",
    "extras/tour/tour_function.py": "starts turndesk tour, which has its own data folder",
    "extras/tour/tour_setup.py": "the store of the tour, and the mark that it was shown",
    "extras/quality/shift_command.py": "a report",
    "extras/tool_tables/export_command.py": "a tool table, to a file that the user names",
    "cli/trace_command.py": "setpoints, to a file of whoever asks",
    "compose/control/control_slot.py": "the socket of a control",
    "compose/control/live_control.py": "inputs of a machine that is simulated",
    "compose/control/control_server.py": "inputs of a machine that is simulated",
    "compose/control/unattended_notes.py": "the job that is interrupted",
    "compose/demo_store.py": "a store for trying",
    "compose/dialects_page.py": "a page of the manual",
    "compose/runs/headless_run.py": "inputs of a run that is simulated",
    "compose/machine/machine_setup.py": "which machine the screen was opened for",
    "compose/machine_file_page.py": "a page of the manual",
    "compose/backends/simulated_devices.py": "the other end of a machine that is simulated",
    "compose/runs/run_log.py": "old files of the machine's own log",
    "compose/thumbnails.py": "pictures that can be made again",
    "desk/daily_backup.py": "the machine's own backups",
    "desk/pages/first_job.py": "how far the first job has come",
    "jog/manual_functions.py": "coolant off: it brings to rest",
    "mdi/mdi_model.py": "the lines that were typed",
    "programs/atomic_files.py": "how a file is written; who calls it asks",
    "extras/quality/parts_data.py": "readings, to a file of whoever asks",
    "extras/quality/shift_function.py": "a report",
    "scope/recording_store.py": "how records are kept; asked by scope_files.py",
    "shopfloor/status_file.py": "what the machine does, for other programs",
    "special/setup_sheet_work.py": "the sheet on paper",
}


# --- the table -------------------------------------------------------------------------------------------


def test_each_level_allows_the_changes_of_the_access_table(room: Room) -> None:
    room.enter_people()
    may = {}
    for level in AccessLevel:
        room.access.access_level = level
        may[level] = {act for act in ProtectedChange if not room.access.find_refusal_reason(act)}
    assert may[AccessLevel.OPERATOR] == OPERATORS
    assert set(ProtectedChange) - may[AccessLevel.SETUP] == SERVICES
    assert may[AccessLevel.SERVICE] == set(ProtectedChange) == set(ACCESS_RULES)


def test_access_page_matches_the_access_table() -> None:
    assert (HOUSE / "docs" / "access.md").read_text("utf-8") == make_access_page()


@WHOLE_PRODUCT
@pytest.mark.parametrize("act", list(ProtectedChange))
def test_every_access_rule_is_used_in_the_program(act: ProtectedChange) -> None:
    """A rule that no page and no command asks for would be a promise that nobody keeps."""
    sources = (path.read_text("utf-8") for path in (HOUSE / "app").rglob("*.py"))
    assert any(f"ProtectedChange.{act.name}" in text for text in sources)


def test_every_module_that_writes_checks_a_rule_or_is_exempt() -> None:
    """A new writer of the store, the program folder, outputs or inputs comes to this list, or to a rule."""
    app = HOUSE / "app"
    texts = {path.relative_to(app).as_posix(): path.read_text("utf-8") for path in app.rglob("*.py")}
    writers = {name for name, text in texts.items() if WRITES.search(text) and "ProtectedChange." not in text}
    listed = {*BEHIND_A_RULE, *NO_CHANGE}
    absent = {name for name in listed if name.startswith("extras/") and name not in texts}
    assert writers == listed - absent


# --- off -------------------------------------------------------------------------------------------------


def test_access_is_neither_checked_nor_logged_without_users(room: Room) -> None:
    assert [room.access.find_refusal_reason(act) for act in ProtectedChange] == [""] * len(ProtectedChange)
    assert room.access.header_text == ""
    room.desk.offset_book.change_fields(OffsetKind.TOOL, 3, {"x": 1.0, "z": -1.0}, "typed")
    room.desk.program_runs.part_counter.program_name = "pin.nc"
    room.find(PartsCounterFunction).correct_part_count(1)
    room.settle()
    assert room.store.offsets.tool_offsets.read_history()[0].who == "operator"
    assert room.log("change") == []
    assert room.desk.prompt_notice == ""


# --- refusals --------------------------------------------------------------------------------------------


def test_access_refusal_names_the_required_level_and_how_to_get_it(room: Room) -> None:
    room.enter_people()
    why = room.desk.offset_book.change_fields(OffsetKind.TOOL, 3, {"x": 1.0, "z": -1.0}, "typed")
    assert why == wording("screen.level-needed", what="TOOL OFFSETS", level="SETUP", now="OPERATOR")
    room.settle()
    assert room.store.offsets.tool_offsets.read_rows() == {}


def test_stored_users_have_levels_even_if_sign_in_is_unavailable(room: Room) -> None:
    room.enter_people()
    with_sign_in = room.access.find_refusal_reason(ProtectedChange.TOOLS)
    session, room.access.sign_in_session = room.access.sign_in_session, None
    assert {act for act in ProtectedChange if not room.access.find_refusal_reason(act)} == OPERATORS
    assert room.access.find_refusal_reason(ProtectedChange.TOOLS) != with_sign_in
    room.access.update(room.desk.read_snapshot())
    room.access.record_activity()
    room.access.sign_in_session = session


def test_operator_may_change_wear_but_not_position(room: Room) -> None:
    room.store.offsets.tool_offsets.change_row(3, "touched off", {"x": 1.0, "z": -1.0}).result(LIMIT)
    room.enter_people()
    book = room.desk.offset_book
    assert shows(
        book.change_fields(OffsetKind.TOOL, 3, {"wear_x": 0.01, "x": 2.0}, "both"),
        "screen.level-needed",
        level="SETUP",
    )
    assert shows(book.undo_step(OffsetKind.TOOL, 3, 1), "screen.level-needed", level="SETUP")
    assert shows(book.clear_table(OffsetKind.ZERO, "all"), "screen.level-needed", level="SETUP")
    assert shows(book.set_master_tool(3, "master"), "screen.level-needed", level="SETUP")
    assert book.change_fields(OffsetKind.TOOL, 3, {"wear_x": 0.01}, "too large") == ""
    room.settle()
    assert book.change_fields(OffsetKind.SECONDARY, 1, {"x": -0.01}, "too large") == ""
    room.settle()
    assert (
        room.store.offsets.tool_offsets.read_rows()[3].wear_x,
        room.store.offsets.tool_offsets.read_rows()[3].x,
    ) == (
        0.01,
        1.0,
    )
    assert room.store.offsets.secondary_offsets.read_rows()[1].x == -0.01


def test_change_not_allowed_by_the_level_asks_no_confirmation(room: Room) -> None:
    room.store.offsets.tool_offsets.change_row(3, "touched off", {"x": 1.0, "z": -1.0}).result(LIMIT)
    room.desk.offset_book.read_store()
    room.enter_people()
    questions = ConfirmedOffsetChanges(OffsetHistory(room.desk, OffsetKind.TOOL))
    refusals = (
        questions.change_fields(OffsetKind.TOOL, 3, {"x": -1.0}, "typed"),
        questions.touch_off(3, TouchPosition(x=-1.0), "touched off"),
        questions.ask_to_toggle_master(3),
        questions.ask_to_undo_change(OffsetKind.TOOL, 3),
    )
    assert all(shows(why, "screen.level-needed", level="SETUP") for why in refusals)
    assert not room.desk.confirmation_key
    assert questions.change_fields(OffsetKind.TOOL, 3, {"wear_x": 1.0}, "typed") == ""
    assert room.desk.confirmation_key  # wear is the operator's, and this wear is large


def test_pages_without_offsets_also_refuse_protected_changes(room: Room) -> None:
    room.enter_people()
    programs, editor = (
        room.desk.page_registry.find_model(ProgramListModel),
        room.desk.page_registry.find_model(EditorModel),
    )
    assert programs is not None
    assert editor is not None
    assert shows(editor.find_save_refusal(), "screen.level-needed", what="PROGRAMS", level="SETUP")
    programs.program_transfer.open_chooser((), None, is_export=False)
    assert not programs.program_transfer.is_open
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    room.find(MachineFileFunction)._accept()
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="THE MACHINE FILE", level="SERVICE")
    room.sign_in("BEN")
    assert editor.find_save_refusal() == ""
    programs.program_transfer.open_chooser((), None, is_export=False)
    assert programs.program_transfer.is_open


def test_operator_may_lower_but_not_raise_the_spindle_limit(room: Room) -> None:
    room.enter_people()
    limit = room.find(SpindleLimitFunction)
    assert limit.accept_entry("1500")
    room.run()
    assert limit.accept_entry("1200")
    room.run()
    assert not limit.accept_entry("1500")
    assert shows(
        room.desk.prompt_notice,
        "screen.level-needed",
        what="HIGHER SPINDLE SPEED LIMIT",
        level="SETUP",
        now="OPERATOR",
    )
    limit.confirm_limit_removal()
    assert shows(room.desk.prompt_notice, "screen.level-needed", level="SETUP")
    room.run()
    assert room.desk.read_snapshot().spindle_limit_rpm == 1200.0
    room.sign_in("BEN")
    limit.confirm_limit_removal()
    limit._lifted()
    room.run()
    assert room.desk.read_snapshot().spindle_limit_rpm == 0.0
    assert room.log("change") == [
        (wording("log.spindle-limit", change="none → 1500 rpm"), "operator"),
        (wording("log.spindle-limit", change="1500 rpm → 1200 rpm"), "operator"),
        (wording("log.spindle-limit", change="1200 rpm → none"), "BEN"),
    ]


def test_manual_outputs_need_setup_level_and_lamp_test_does_not(room: Room) -> None:
    room.enter_people()
    page = room.find(SignalsFunction)
    page.list_kind = Shown.OUTPUTS
    page.marked = tuple(page.machine.outputs).index("coolant")
    room.desk.clear_prompt_line()
    page.activate_selected_row()
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="MANUAL OUTPUTS", level="SETUP")
    page._force("coolant", True)  # the level fell back while it was asked
    room.run()
    assert "coolant" not in room.desk.read_snapshot().outputs
    room.sign_in("BEN")
    page._force("coolant", True)
    room.run()
    assert "coolant" in room.desk.read_snapshot().outputs
    assert room.log("change") == [(wording("log.output-on-by-hand", name="coolant"), "BEN")]


def test_received_program_is_not_stored_after_level_expires(room: Room) -> None:
    room.enter_people()
    room.sign_in("BEN")
    line = room.find(SerialTransferFunction)
    line.received_program = ReceivedProgram(b"M30\n", "PIN", 1, "", False, 0, (), 0.0)
    room.access.sign_out()
    line._store()
    assert shows(room.desk.prompt_notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    assert line.received_program is not None
    assert not (line.own_folder / "PIN").exists()


def test_stop_and_reset_need_no_level(room: Room) -> None:
    room.enter_people()
    desk = room.desk
    desk.enable_drives()
    room.run()
    assert desk.read_snapshot().state is MachineState.IDLE
    desk.start_feed_hold()
    desk.station_keys.press_estop()
    room.run()
    assert desk.read_snapshot().state is MachineState.ESTOP
    desk.station_controls.estop(is_pressed=False)
    room.run()
    desk.reset_control()
    room.run()
    assert desk.read_snapshot().state is MachineState.DISABLED
    assert "LEVEL" not in desk.prompt_notice


# --- who did it ------------------------------------------------------------------------------------------


def test_every_history_has_the_user_name(room: Room) -> None:
    room.enter_people()
    room.sign_in("BEN")
    book, watch = room.desk.offset_book, room.desk.page_registry.find_model(ProductionMonitor)
    assert watch is not None
    for kind, number, values in (
        (OffsetKind.TOOL, 3, {"x": 1.0, "z": -1.0}),
        (OffsetKind.SECONDARY, 1, {"x": -0.01}),
        (OffsetKind.ZERO, 54, {"z": -120.0}),
        (OffsetKind.SHAPE, 3, {"kind": "turning"}),
        (OffsetKind.MILL_TOOL, 20, {"length": 80.0}),
        (OffsetKind.PRESET, 3, {"x": 5.0}),
    ):
        assert book.change_fields(kind, number, values, "set up") == ""
        room.settle()
        assert room.store.offsets.get_table(kind).read_history()[0].who == "BEN"
    room.journal.save_version("pin.nc", b"M30\n", "saved in the editor")
    assert room.store.programs.list_versions("pin.nc")[0].who == "BEN"
    watch.tool_life_monitor.record_insert_change(3, "worn", lambda _text: None)
    room.settle()
    with room.store.read() as connection:
        assert [row.who for row in read_insert_changes(connection, 9)] == ["BEN"]
    room.desk.program_runs.part_counter.program_name = "pin.nc"
    room.find(PartsCounterFunction).correct_part_count(1)
    assert room.log("change")[-1] == (
        wording("log.parts-changed", program="pin.nc", before=0, after=1),
        "BEN",
    )
    assert "change" in EVENT_FILTERS["OPERATOR"]


def test_changes_of_settings_sounds_and_notes_are_logged(room: Room) -> None:
    room.enter_people()
    room.sign_in("CARLA")
    room.desk.apply_setting("theme", "light")
    room.desk.select_next_readout()  # many times a shift: no line
    room.find(LampsAndSoundFunction)._choose(40, frozenset())
    sheet = room.find(SetupSheetFunction)
    room.desk.program_loader._now = replace(room.desk.program_loader.loaded_program, path=Path("pin.nc"))
    sheet._keep(["soft jaws"])
    sheet._keep(["soft jaws", "stop 12 mm"])
    sheet._keep(["stop 12 mm"])
    sheet.select_next_paper_size()
    texts = [text for text, who in room.log("change") if who == "CARLA"]
    assert texts[:5] == [
        wording("log.screen-setting", what="theme", before="system", after="light"),
        wording("log.sound-setting", before=0, after=40, silent="nothing"),
        wording("log.notes", program="pin.nc", note="'soft jaws'"),
        wording("log.notes", program="pin.nc", note="'stop 12 mm'"),
        wording("log.notes", program="pin.nc", note=wording("log.note-gone", note="'soft jaws'")),
    ]
    assert [begins(text, "log.paper-size") for text in texts[5:]] == [True]


def test_accepted_machine_file_is_logged_with_the_user_name(room: Room) -> None:
    room.enter_people()
    room.sign_in("ANNA")
    room.desk.changes.accept_changes()
    assert shows(room.log("machine")[-1][0], "desk.machine-file-accepted-by", name="ANNA")


# --- people ------------------------------------------------------------------------------------------------


def test_removed_user_loses_the_level(room: Room) -> None:
    room.enter_people()
    room.sign_in("BEN")
    room.journal.require_store().people.remove_user("BEN").result()
    room.access.reload()
    assert room.access.header_text == "OPERATOR"


def test_second_instance_uses_the_levels_of_the_first(room: Room, tmp_path: Path) -> None:
    room.enter_people()
    beside = Journal(tmp_path / "home")
    assert beside.people() == room.store.people.read_users()
    beside.close()


def test_last_service_user_can_only_be_removed_after_all_others(room: Room) -> None:
    room.enter_people()
    with pytest.raises(StoreError, match=pattern("desk.service-stays")):
        room.journal.require_store().people.remove_user("ANNA").result()
    for name in ("BEN", "CARLA", "ANNA"):
        room.journal.require_store().people.remove_user(name).result()
    room.access.reload()
    assert not room.access.user_list.is_access_restricted


def test_damaged_user_row_denies_access_and_is_reported(room: Room, tmp_path: Path) -> None:
    room.enter_people()
    with closing(sqlite3.connect(tmp_path / "home" / STORE_FILE_NAME)) as outside, outside:
        outside.execute("UPDATE people SET level = 3 WHERE name = 'CARLA'")
    room.access.reload()
    assert room.access.user_list.is_access_restricted
    assert room.access.user_list.find_user("CARLA") is None
    assert any(
        begins(text, "desk.not-as-saved", what=f"{wording('desk.pin-of')} CARLA")
        for text in room.store.find_damaged_rows()
    )


def test_store_of_an_older_version_has_no_levels_and_retains_its_log(tmp_path: Path) -> None:
    folder = tmp_path / "older"
    folder.mkdir()
    before = next(n for n, text in enumerate(database.load_migrations()) if "CREATE TABLE people" in text)
    with closing(sqlite3.connect(folder / STORE_FILE_NAME, isolation_level=None)) as connection:
        connection.execute(f"PRAGMA application_id = {database.APPLICATION_ID}")
        database.upgrade_tables(connection, database.load_migrations()[:before])
        connection.execute("INSERT INTO events (at, kind, text) VALUES ('2026-01-02', 'start', 'pin.nc')")
        connection.execute("INSERT INTO tool_offsets (number, x, z, r) VALUES (3, 1.0, -1.0, 0.0)")
    with Store.open(folder) as store:
        assert not store.people.read_users().is_access_restricted
        assert [(row.text, row.who) for row in store.events.read_events()] == [("pin.nc", "")]
        assert store.offsets.tool_offsets.read_rows()[3].x == 1.0
        assert store.find_damaged_rows() == ()
