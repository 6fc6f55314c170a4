"""F10 by keys alone: spindle limit, parts counter, outputs, log, settings; and everything that is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtTest import QTest

from app.compose.runs.journal import Journal
from app.desk.data_folder import find_data_folder
from app.desk.desk import Desk
from app.programs.removable_media import UsbStick
from app.screen import page_table
from app.special.backup_and_restore import RESTORE_REFUSAL, BackupFunction
from app.special.inputs_outputs import SWITCH_REFUSAL
from app.special.special_view import SpecialFunctionsPage
from core.access.access_table import AccessLevel, ProtectedChange
from core.executor.commands import FeedHold, ForceOutput, SetSpindleLimit, SetSwitch
from core.executor.snapshot import Alarm, LogEvent, MachineState
from core.store.backup import BackupCheckResult
from core.store.store_errors import StoreError
from core.store.user_records import UserRow
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key
from tests.screen.typist import CTRL
from tests.screen.yes import yes
from tests.texts import begins, opening, shows
from tests.texts import text as wording


@pytest.fixture
def desk(machine: FakeMachine, journal: Journal) -> Desk:
    return desk_on(machine, keep=journal, book=journal.book())


def open_function(hands: Hands, number: int) -> SpecialFunctionsPage:
    hands.key(Key.Key_F10)
    hands.type(str(number))
    hands.key(Key.Key_Return)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    hands.sees(lambda: page.model.inside and page.table_panel.table is not None)
    return page


def cells(page: SpecialFunctionsPage, row: int) -> tuple[str, ...]:
    return page.table_panel.table.rows[row].cells


def test_list_is_navigated_by_arrows_and_closed_by_esc(hands: Hands) -> None:
    hands.key(Key.Key_F10)
    assert hands.frame.title_line.page_title == page_table.SPECIAL
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    hands.key(Key.Key_Down)
    assert page.model.shown_function.name == "PARTS COUNTER"
    hands.key(Key.Key_Return)
    assert page.model.inside
    hands.key(Key.Key_Escape)
    assert not page.model.inside
    hands.key(Key.Key_Escape)
    assert hands.frame.current_page is hands.page


def test_spindle_limit_is_calculated_and_applies_until_restart(hands: Hands) -> None:
    page = open_function(hands, 1)
    hands.type("1000+250")
    hands.key(Key.Key_Return)
    assert SetSpindleLimit(1250.0) in hands.machine.posted
    hands.sees(lambda: cells(page, 1)[1] == "1250")
    hands.key(Key.Key_F4)
    assert begins(hands.prompt(), "screen.lift-limit")
    yes(hands.window)
    hands.sees(lambda: cells(page, 1)[1] == "NONE")


@pytest.mark.parametrize(
    ("typed", "why"),
    [
        (
            "9000",
            wording("screen.refused", why=wording("screen.rpm-not-between", rpm=9000, low=50, high=3500)),
        ),
        ("0", wording("screen.refused", why=opening("screen.rpm-not-between", rpm=0))),
        ("", wording("screen.refused", why=wording("screen.nothing-entered"))),
        (
            "12,5",
            wording(
                "screen.refused",
                why=wording("screen.no-number", what=",", entry="12,5", hint=wording("screen.decimal-point")),
            ),
        ),
    ],
)
def test_spindle_limit_out_of_range_is_rejected(hands: Hands, typed: str, why: str) -> None:
    open_function(hands, 1)
    hands.type(typed)
    hands.key(Key.Key_Return)
    assert hands.prompt().startswith(why)
    assert not any(isinstance(command, SetSpindleLimit) for command in hands.machine.posted)


def test_clearing_a_limit_that_is_not_set_shows_message(hands: Hands) -> None:
    open_function(hands, 1)
    hands.key(Key.Key_F4)
    assert hands.prompt() == wording("screen.no-limit")


def test_reached_target_stops_cycle_repeat_and_is_reported(hands: Hands, journal: Journal) -> None:
    hands.load("pin")
    page = open_function(hands, 2)
    hands.type("2")
    hands.key(Key.Key_Return)
    hands.sees(lambda: cells(page, 1) == ("PART TARGET", "2"))
    hands.machine.now = replace(
        hands.machine.now, parts=1, cycle_repeat=True, counts=True, state=MachineState.WAIT
    )
    hands.sees(lambda: SetSwitch("cycle_repeat", False) in hands.machine.posted)
    assert begins(hands.prompt(), "screen.last-part-of-target")
    hands.machine.now = replace(hands.machine.now, parts=2, state=MachineState.IDLE)
    hands.sees(lambda: hands.prompt() == wording("screen.target-reached", count=2, target=2))
    assert hands.desk.program_runs.part_counter.part_count_text == "2/2"
    hands.key(Key.Key_F4)
    yes(hands.window)
    hands.sees(lambda: hands.desk.program_runs.part_counter.part_count_text == "0/2")


def test_counter_without_program_is_rejected(hands: Hands) -> None:
    open_function(hands, 2)
    hands.type("5")
    hands.key(Key.Key_Return)
    assert begins(hands.prompt(), "screen.choose-program-for-count")
    hands.key(Key.Key_F4)
    assert begins(hands.prompt(), "screen.choose-program-for-count")


@pytest.mark.parametrize("typed", ["1.5", "-3", "99999999"])
def test_invalid_number_of_parts_is_rejected(hands: Hands, typed: str) -> None:
    hands.load("pin")
    open_function(hands, 2)
    hands.type(typed)
    hands.key(Key.Key_Return)
    assert shows(hands.prompt(), "screen.no-number-of-parts")


def test_target_below_parts_made_is_rejected(hands: Hands, journal: Journal) -> None:
    for event in (LogEvent(0.0, "load", "pin.nc"), *(LogEvent(0.0, "part", "part"),) * 3):
        journal.hear(event)
    hands.sees(lambda: journal.runs.read_part_count("pin.nc") == 3)
    hands.load("pin")
    open_function(hands, 2)
    hands.sees(lambda: hands.desk.program_runs.part_counter.part_count == 3)
    hands.type("2")
    hands.key(Key.Key_Return)
    assert hands.prompt() == wording("screen.parts-made-already", made=3)


def test_an_output_is_switched_after_asking(hands: Hands) -> None:
    page = open_function(hands, 3)
    assert cells(page, 0) == ("coolant", "OUT-1", "OFF", "M08 M09")
    hands.key(Key.Key_Return)
    assert hands.prompt() == wording("screen.switch-on", name="coolant")
    hands.key(Key.Key_Escape)
    hands.key(Key.Key_Return)
    hands.key(Key.Key_Return)
    assert not any(isinstance(command, ForceOutput) for command in hands.machine.posted)
    yes(hands.window)
    assert ForceOutput("coolant", True) in hands.machine.posted
    hands.sees(lambda: cells(page, 0)[2] == "ON")


def test_moving_mark_cancels_question(hands: Hands) -> None:
    open_function(hands, 3)
    hands.key(Key.Key_Return)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert "collet" in hands.prompt()
    assert not any(isinstance(command, ForceOutput) for command in hands.machine.posted)


@pytest.mark.parametrize(
    "state", [MachineState.RUN, MachineState.HOLD, MachineState.JOG, MachineState.FAULT, MachineState.ESTOP]
)
def test_output_is_not_switched_while_machine_is_busy(hands: Hands, state: MachineState) -> None:
    open_function(hands, 3)
    hands.machine.now = replace(hands.machine.now, state=state)
    hands.key(Key.Key_Return)
    hands.key(Key.Key_Return)
    assert hands.desk.prompt_notice == SWITCH_REFUSAL
    assert not any(isinstance(command, ForceOutput) for command in hands.machine.posted)


def test_inputs_and_lamps_are_seen_and_not_switched(hands: Hands) -> None:
    page = open_function(hands, 3)
    hands.machine.now = replace(hands.machine.now, inputs=frozenset({"TB2-5"}))
    hands.key(Key.Key_F4)
    hands.sees(
        lambda: ("TB2-5", "TB2-5", "ON", "M91 M92") in [row.cells for row in page.table_panel.table.rows]
    )
    hands.key(Key.Key_Return)
    assert hands.prompt() == wording("screen.only-outputs-switched")
    hands.key(Key.Key_F4)
    hands.sees(lambda: page.table_panel.table.title == "MACHINE LAMPS")


def test_a_drive_shows_its_fault(hands: Hands) -> None:
    page = open_function(hands, 4)
    hands.machine.fault(Alarm(102, "following", "FOLLOWING ERROR", "Z is 2.1 off its setpoint", "free it"))
    hands.sees(lambda: cells(page, 1)[7] == "102")
    assert [cells(page, row)[0] for row in range(4)] == ["X", "Z", "C", "S"]
    assert (cells(page, 0)[1], cells(page, 0)[7]) == ("OFF", "—")


def test_the_log_is_searched_and_filtered(hands: Hands, journal: Journal) -> None:
    for kind, text in (("start", "pin.nc"), ("alarm", "FOLLOWING ERROR: Z"), ("switch", "single block on")):
        journal.hear(LogEvent(0.0, kind, text))
    page = open_function(hands, 5)
    hands.sees(lambda: len(page.table_panel.table.rows) == 3)
    hands.key(Key.Key_F5)
    hands.sees(lambda: [row.cells[1] for row in page.table_panel.table.rows] == ["alarm"])
    for _ in range(3):
        hands.key(Key.Key_F5)
    QTest.keyClick(hands.window, Key.Key_F, CTRL)
    hands.type("BLOCK h")
    hands.sees(lambda: page.table_panel.table.rows == ())
    assert hands.frame.accepts_text("h")
    hands.key(Key.Key_Backspace)
    hands.key(Key.Key_Backspace)
    hands.sees(lambda: [row.cells[2] for row in page.table_panel.table.rows] == ["single block on"])
    hands.key(Key.Key_Return)
    assert not hands.frame.accepts_text("h")
    assert len(page.table_panel.table.rows) == 1
    hands.key(Key.Key_Escape)
    hands.sees(lambda: len(page.table_panel.table.rows) == 3)


def test_backup_is_created_and_restored(hands: Hands, journal: Journal) -> None:
    store = hands.desk.offset_book.store
    assert store is not None
    store.settings.save_setting("mark", "before").result(60)
    page = open_function(hands, 6)
    hands.sees(lambda: len(page.table_panel.table.rows) >= 1)
    hands.key(Key.Key_Return)
    hands.sees(lambda: shows(hands.prompt(), "screen.backup-is-whole"))
    hands.sees(
        lambda: (
            len(page.table_panel.table.rows) >= 2 and cells(page, 1)[1] == wording("screen.restore-is-whole")
        )
    )
    store.settings.save_setting("mark", "after").result(60)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert begins(hands.prompt(), "screen.restore")
    yes(hands.window)
    hands.sees(lambda: begins(hands.prompt(), "screen.restored"))
    assert journal.read_setting("mark") == "before"
    assert hands.desk.offset_book.store is not store
    journal.hear(LogEvent(0.0, "start", "after the restore"))
    hands.sees(lambda: [e.text for e in journal.events("after the", (), 9)] == ["after the restore"])


def test_backup_list_shows_condition_of_each_backup(hands: Hands, journal: Journal) -> None:
    store = hands.desk.offset_book.store
    assert store is not None
    store.offsets.tool_offsets.change_row(3, "x", {"x": 1.0, "z": 0.0}).result(60)
    page = open_function(hands, 6)
    hands.sees(lambda: len(page.table_panel.table.rows) >= 1)
    backups = page.model.shown_function
    assert isinstance(backups, BackupFunction)
    folder = backups.listed_locations[0].path
    folder.mkdir(parents=True, exist_ok=True)
    journal.backup(folder / "2026-11-23-good.turndesk.db")
    (folder / "2026-11-22-bad.turndesk.db").write_bytes(b"no store any more")
    store.offsets.tool_offsets.change_row(3, "x", {"x": 2.0}).result(60)
    hands.key(Key.Key_F4)
    said = ["RESTORE (BACKUP IS INTACT)", "CANNOT RESTORE: BACKUP DAMAGED"]
    hands.sees(lambda: [row.cells[1] for row in page.table_panel.table.rows[1:3]] == said)
    hands.key(Key.Key_Down)
    hands.sees(
        lambda: page.table_panel.table.notes[0] == wording("screen.other-than-now", what="tool offsets 1")
    )
    hands.key(Key.Key_Return)
    assert shows(hands.prompt(), "screen.restore", what="tool offsets 1")
    hands.key(Key.Key_Escape)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert shows(hands.desk.prompt_notice, "screen.refused")
    assert shows(hands.desk.prompt_notice, "screen.not-a-database")
    assert store.offsets.tool_offsets.read_rows()[3].x == 2.0


@pytest.mark.parametrize("row", [0, 1])
def test_only_backup_on_stick_mentions_the_stick(hands: Hands, row: int, tmp_path: Path) -> None:
    page = open_function(hands, 6)
    backups = page.model.shown_function
    assert isinstance(backups, BackupFunction)
    backups.list_media = lambda: (UsbStick("STICK", tmp_path, 1_000_000),)
    hands.key(Key.Key_F4)
    hands.sees(lambda: len(page.table_panel.table.rows) == 2)
    for _ in range(row):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    hands.sees(lambda: shows(hands.prompt(), "screen.backup-on-stick" if row else "screen.backup-is-whole"))


def test_backup_next_to_damaged_data_refers_to_restore_command(
    hands: Hands, journal: Journal, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unreadable(_source: object) -> BackupCheckResult:
        raise StoreError("the file is damaged", "damaged")

    monkeypatch.setattr(journal, "check_backup", unreadable)
    folder = find_data_folder() / "backups"
    folder.mkdir(parents=True, exist_ok=True)
    journal.backup(folder / "2026-11-23-good.turndesk.db")
    page = open_function(hands, 6)
    hands.sees(lambda: [row.cells[1] for row in page.table_panel.table.rows[1:2]] == ["NOT CHECKED"])
    hands.key(Key.Key_Down)
    hands.sees(lambda: page.table_panel.table.notes[0] == "the file is damaged")
    hands.key(Key.Key_Return)
    assert "turndesk store restore" in hands.desk.prompt_notice


def test_restore_leaves_access_levels_on(hands: Hands, journal: Journal) -> None:
    """A backup of the time before levels switched them off."""
    page = open_function(hands, 6)
    hands.sees(lambda: len(page.table_panel.table.rows) >= 1)
    backups = page.model.shown_function
    assert isinstance(backups, BackupFunction)
    folder = backups.listed_locations[0].path
    folder.mkdir(parents=True, exist_ok=True)
    journal.backup(folder / "2026-11-23-before.turndesk.db")
    journal.require_store().people.save_user(UserRow("ANNA", 3, b"salt", b"hash")).result()
    access = hands.desk.user_access
    access.reload()
    hands.key(Key.Key_F4)
    hands.sees(
        lambda: (
            [row.cells[1] for row in page.table_panel.table.rows[1:2]] == [wording("screen.restore-is-whole")]
        )
    )
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert hands.desk.prompt_notice == access.find_refusal_reason(ProtectedChange.RESTORE) != ""
    access.user_name, access.access_level = "ANNA", AccessLevel.SERVICE
    access.record_activity()
    hands.key(Key.Key_Return)
    yes(hands.window)
    hands.sees(lambda: shows(hands.desk.prompt_notice, "screen.restored"))
    access.reload()
    assert [row.name for row in access.user_list.rows] == ["ANNA"]
    hands.sees(lambda: len(journal.require_store().events.read_events(kinds={"change"})) > 0)
    [row] = journal.require_store().events.read_events(kinds={"change"})
    assert (row.who, row.text.startswith("restored; ")) == ("ANNA", True)


def test_restore_is_rejected_while_machine_is_busy(hands: Hands) -> None:
    page = open_function(hands, 6)
    hands.sees(lambda: len(page.table_panel.table.rows) >= 1)
    hands.key(Key.Key_Return)
    hands.sees(lambda: len(page.table_panel.table.rows) >= 2 and not page.model.worker.is_busy)
    hands.machine.now = replace(hands.machine.now, state=MachineState.HOLD)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert hands.desk.prompt_notice == RESTORE_REFUSAL


def test_settings_apply_at_once_and_are_saved(hands: Hands, journal: Journal) -> None:
    page = open_function(hands, 7)
    hands.key(Key.Key_Return)
    hands.key(Key.Key_Return)
    hands.sees(
        lambda: (
            hands.frame.readout_line.status is not None
            and "MM" in hands.frame.readout_line.status.position.unit
        )
    )
    assert cells(page, 0)[1] == "MM"
    for _ in range(3):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    hands.sees(lambda: hands.window.theme.palette.name == "light")
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert hands.frame.station_dock is not None
    hands.sees(lambda: hands.frame.station_dock is not None and hands.frame.station_dock.isHidden())
    wanted = {"units": "MM", "theme": "light", "dock": False, "language": "en", "readout": "POSITION"}

    def all_kept() -> bool:
        kept = journal.read_setting("screen")
        return isinstance(kept, dict) and wanted.items() <= kept.items()

    hands.sees(all_kept)


def test_station_with_pressed_estop_cannot_be_hidden(hands: Hands) -> None:
    open_function(hands, 7)
    hands.key(Key.Key_E)
    for _ in range(4):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert begins(hands.desk.prompt_notice, "screen.release-station-e-stop")
    assert hands.desk.settings_store.current_settings.dock


def test_hold_and_estop_work_during_an_entry(hands: Hands) -> None:
    open_function(hands, 1)
    hands.type("12")
    hands.machine.now = replace(hands.machine.now, state=MachineState.RUN)
    hands.window.start_feed_hold()
    assert FeedHold() in hands.machine.posted
    hands.window.press_estop()
    hands.sees_state(MachineState.ESTOP)


def test_uncounted_run_is_not_last_part_of_target(hands: Hands, journal: Journal) -> None:
    hands.load("pin")
    page = open_function(hands, 2)
    hands.type("1")
    hands.key(Key.Key_Return)
    hands.sees(lambda: cells(page, 1) == ("PART TARGET", "1"))
    hands.machine.now = replace(hands.machine.now, cycle_repeat=True, counts=False, state=MachineState.WAIT)
    hands.window.refresh()
    assert SetSwitch("cycle_repeat", False) not in hands.machine.posted


def test_no_count_is_switched_by_key_and_touch_and_lights_lamp(hands: Hands) -> None:
    assert not any(lamp.label == "NO COUNT" for lamp in hands.frame.strip.lamps)
    hands.key(Key.Key_P)
    assert hands.machine.now.no_count
    hands.sees(lambda: any(lamp.label == "NO COUNT" and lamp.is_lit for lamp in hands.frame.strip.lamps))
    open_function(hands, 2)
    hands.key(Key.Key_F5)
    assert not hands.machine.now.no_count


def test_part_count_is_corrected_by_hand(hands: Hands, journal: Journal) -> None:
    hands.load("pin")
    page = open_function(hands, 2)
    hands.key(Key.Key_F3)
    assert hands.prompt() == wording("screen.count-is-nought")
    hands.key(Key.Key_F2)
    hands.key(Key.Key_F2)
    hands.key(Key.Key_F3)
    hands.sees(lambda: cells(page, 0) == ("PARTS MADE", "1"))
    hands.sees(lambda: journal.runs.read_part_count("pin.nc") == 1)


def test_part_count_cannot_be_corrected_without_program(hands: Hands) -> None:
    open_function(hands, 2)
    hands.key(Key.Key_F2)
    assert begins(hands.prompt(), "screen.choose-program-for-count")


def test_list_rows_are_touch_sized_and_can_be_scrolled(hands: Hands) -> None:
    """At 600 lines not all fit: the foot leafs without opening anything, 0 is the tenth function."""
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    items, count = page.function_list, len(page.model.functions)
    items.grab()  # drawn
    assert 1 < items.rows < count
    items.scroll_by(items.rows)
    assert items.first_row == min(items.rows, count - items.rows)
    items.scroll_by(99)
    assert items.first_row == count - items.rows
    assert not page.model.inside
    items.scroll_by(-99)
    assert items.first_row == 0
    hands.type("10")
    assert not page.model.inside
    assert page.model.at == 9
    items.grab()  # drawn: the tenth is in sight
    assert items.first_row <= 9 < items.first_row + items.rows


def test_a_simulated_input_is_switched_and_one_of_the_station_is_not(hands: Hands) -> None:
    switched: list[tuple[str, bool]] = []
    hands.desk.desk_control.set_input = lambda name, on: switched.append((name, on))
    page = open_function(hands, 3)
    hands.machine.now = replace(
        hands.machine.now, state=MachineState.WAIT
    )  # also while a program waits for it
    hands.key(Key.Key_F4)
    hands.sees(lambda: page.table_panel.table.title == "INPUTS")
    names = [row.cells[0] for row in page.table_panel.table.rows]
    page.model.shown_function.marked = names.index("guard")
    hands.key(Key.Key_Return)
    assert switched == [("guard", True)]
    page.model.shown_function.marked = names.index("estop")
    hands.key(Key.Key_Return)
    assert len(switched) == 1
    assert shows(hands.prompt(), "screen.output-follows-machine")


def test_lamps_and_sound_share_one_table_and_are_off_by_default(hands: Hands) -> None:
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    page._enter([each.name for each in page.model.functions].index("LAMPS AND SOUND"))
    assert (
        wording("screen.volume", volume="OFF")
        in page.model.shown_function.make_table(hands.desk.read_snapshot()).notes
    )
    hands.sees(lambda: cells(page, 3)[1:] == ("AMBER BLINKING + BUZZER 1 s", "ON"))
    hands.key(Key.Key_F4)
    assert hands.prompt() == wording("screen.volume-nought")
    hands.key(Key.Key_F3)
    assert (
        wording("screen.volume", volume="20 %")
        in page.model.shown_function.make_table(hands.desk.read_snapshot()).notes
    )
    hands.key(Key.Key_Return)
    hands.sees(lambda: cells(page, 0)[2] == "OFF")
    hands.key(Key.Key_F5)
    assert hands.prompt() == wording("screen.no-lamps")


@pytest.mark.parametrize("number", range(1, 17))
def test_every_function_is_opened_by_its_number_and_return(hands: Hands, number: int) -> None:
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    if number > len(page.model.functions):
        pytest.skip("this desk has fewer functions")
    hands.type(str(number))
    assert (page.model.at, page.model.inside) == (number - 1, False)
    assert not page.has_text_field()


def test_digits_of_function_number_are_not_typed_into_a_field(hands: Hands) -> None:
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    for digit in "14" * 3 + "25":
        hands.type(digit)
        assert page.table_panel.table.text == ""
    assert not page.model.inside
    hands.key(Key.Key_Down)
    hands.type("0")
    assert shows(
        hands.desk.prompt_notice, "screen.no-such-function", number="0", last=len(page.model.functions)
    )


def test_next_digit_replaces_rejected_speed(hands: Hands) -> None:
    page = open_function(hands, 1)
    hands.type("199999999999")
    hands.key(Key.Key_Return)
    assert (
        page.table_panel.table.is_entry_rejected
        or page.model.shown_function.make_table(hands.machine.now).is_entry_rejected
    )
    hands.type("2")
    assert page.model.shown_function.make_table(hands.machine.now).text == "2"
    hands.key(Key.Key_Delete)
    hands.type("199999999999")
    hands.key(Key.Key_Return)
    hands.key(Key.Key_Backspace)  # corrects it instead
    hands.type("2")
    assert page.model.shown_function.make_table(hands.machine.now).text == "199999999992"
