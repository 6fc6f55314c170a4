"""Levels: off they change nothing, on they refuse with the way out, and the history says who did it."""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import pytest

import resources
from app.compose.journal import Journal
from app.compose.screen_desk import desk_and_executor
from app.compose.stored_offsets import stored_offsets
from app.desk.access import Access
from app.desk.access_reset import WAIT
from app.desk.desk import Desk
from app.editor.editor import Editor
from app.offsets.offset_history import OffsetHistory
from app.offsets.offset_questions import OffsetQuestions
from app.production.parts_watch import PartsWatch
from app.programs.program_list import ProgramList
from app.special.access_levels import AccessLevels
from app.special.inputs_outputs import InputsOutputs
from app.special.inputs_outputs import Kind as Shown
from app.special.lamps_and_sound import LampsAndSound
from app.special.logged_events import FILTERS
from app.special.machine_file_acceptance import MachineFileAcceptance
from app.special.parts_counter import PartsCounterFunction
from app.special.setup_sheet_function import SetupSheetFunction
from app.special.special_functions import SpecialFunction, SpecialFunctions
from app.special.spindle_limit import SpindleSpeedLimit
from app.transfer.line_transfer import Received
from app.transfer.serial_transfer import SerialTransfer
from core.access import pins
from core.access.access_page import page
from core.access.access_table import RULES, Act, Level
from core.access.pins import Hashed, PinError, WrongPins, check_pin, hashed, is_pin, wait_after
from core.executor.executor import Executor
from core.executor.snapshot import State
from core.store import database
from core.store.people import PersonRow
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_file import FILE_NAME
from core.store.store_rows import Kind
from core.store.tool_lives import insert_changes
from core.store.touch_off import Touch
from drivers.clocks import StepClock
from tests.extras.features import all_installed
from tests.texts import begins, pattern, shows
from tests.texts import text as wording

T = TypeVar("T", bound=SpecialFunction)
HOUSE = Path(__file__).parents[2]
LIMIT = 60.0
TODAY = pins.COST  # before a test makes it cheap
PINS = {"ANNA": "4711", "BEN": "2580", "CARLA": "9035"}
LEVELS = {"ANNA": Level.SERVICE, "BEN": Level.SETUP, "CARLA": Level.OPERATOR}
OPERATORS = {Act.WEAR, Act.COUNTS, Act.INSERTS, Act.READINGS, Act.JOBS, Act.SCREEN, Act.INPUTS, Act.BACKUPS}
SERVICES = {Act.MACHINE_FILE, Act.RESTORE, Act.SHARED_PLACE, Act.PEOPLE}
WRITES = re.compile(
    r"\.(save_setting|keep_settings|set_setting|save_version|correct_parts|reset_parts|import_all|set_offset)\("
    r"|\.(keep_person|remove_person|remove_people|keep_program|renamed|set_input|unlink|rename|write_text)\("
    r"|\b(write_whole|write_new|write_out|write_in_place|store_new|ForceOutput|SpindleLimit)\("
)
BEHIND_A_RULE = {
    "compose/accepted_machine.py": "asked by machine_file_acceptance.py",
    "compose/journal.py": "does what pages ask that have asked",
    "compose/kept_stock.py": "asked by part_options.py and part_sheet.py",
    "compose/setup_file.py": "asked by setup_command.py",
    "extras/sharing/sharing_desk.py": "asked by share_command.py",
    "desk/access.py": "asked by access_levels.py",
    "desk/persistence.py": "as journal.py",
    "desk/screen_settings.py": "asked by desk.py",
    "editor/document.py": "asked by may_save of the editor",
    "extras/quality/sample_plan.py": "asked by features_section.py",
    "special/part_count.py": "asked by parts_counter.py",
    "transfer/line_transfer.py": "asked by serial_command.py and serial_transfer.py",
}
NO_CHANGE = {
    "cli/desktop_entry.py": "the menu of the system's user",
    "cli/json_page.py": "a page of the manual",
    "cli/proof_cache.py": "proofs that can be made again",
    "cli/report_file.py": "a report, to a file of whoever asks",
    "extras/quality/shift_command.py": "a report",
    "cli/trace_command.py": "setpoints, to a file of whoever asks",
    "compose/demo_store.py": "a store for trying",
    "compose/dialects_page.py": "a page of the manual",
    "compose/headless_run.py": "inputs of a run that is simulated",
    "compose/machine_in_use.py": "which machine the screen was opened for",
    "compose/machine_file_page.py": "a page of the manual",
    "compose/played_machine.py": "the other end of a machine that is simulated",
    "compose/run_log.py": "old files of the machine's own log",
    "compose/thumbnails.py": "pictures that can be made again",
    "desk/daily_backup.py": "the machine's own backups",
    "desk/first_job.py": "how far the first job has come",
    "editor/drafts.py": "what is typed and not saved",
    "jog/hand_functions.py": "coolant off: it brings to rest",
    "mdi/mdi_line.py": "the lines that were typed",
    "programs/whole_file.py": "how a file is written; who calls it asks",
    "extras/quality/readings_file.py": "readings, to a file of whoever asks",
    "extras/quality/shift_function.py": "a report",
    "scope/record_shelf.py": "how records are kept; asked by scope_model.py",
    "shopfloor/status_file.py": "what the machine does, for other programs",
    "special/setup_sheet_work.py": "the sheet on paper",
}


@dataclass
class Room:
    desk: Desk
    executor: Executor
    clock: StepClock
    journal: Journal
    at: float = 1000.0

    @property
    def access(self) -> Access:
        return self.desk.access

    @property
    def store(self) -> Store:
        store = self.journal._store
        assert store is not None
        return store

    def run(self, ticks: int = 20) -> None:
        for _ in range(ticks):
            self.clock.advance(0.01)
            self.executor.tick()
        self.desk.look()

    def settle(self) -> None:
        """Until what was asked of workers and of the disk is there."""
        self.access.worker.settle(LIMIT)
        self.store.write(lambda _connection: None).result(LIMIT)
        self.desk.look()
        self.desk.book.poll()

    def find(self, kind: type[T]) -> T:
        special = self.desk.attached(SpecialFunctions)
        assert special is not None
        return next(each for each in special.functions if isinstance(each, kind))

    def enter_people(self) -> None:
        for name, pin in PINS.items():
            self.journal.keep_person(PersonRow(name, LEVELS[name], *hashed(pin)))
        self.access.reload()

    def sign_in(self, name: str, pin: str = "") -> None:
        row = self.access.people.named(name)
        assert row is not None
        self.access.sign_in(row, pin or PINS[name])
        self.settle()

    def log(self, kind: str) -> list[tuple[str, str]]:
        self.settle()
        return [(row.text, row.who) for row in self.store.events(kinds={kind})][::-1]


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Room]:
    file = tmp_path / "own.toml"
    file.write_text(resources.machine_file("gt75.toml"))
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    clock, journal = StepClock(), Journal.at_home()
    desk, executor = desk_and_executor(str(file), stored_offsets, clock, journal)
    made = Room(desk, executor, clock, journal)
    made.access.clock = lambda: made.at
    made.run(2)
    yield made
    desk.close()
    journal.close()


# --- the table -------------------------------------------------------------------------------------------


def test_each_level_may_what_stands_in_the_table(room: Room) -> None:
    room.enter_people()
    may = {}
    for level in Level:
        room.access.level = level
        may[level] = {act for act in Act if not room.access.refusal(act)}
    assert may[Level.OPERATOR] == OPERATORS
    assert set(Act) - may[Level.SETUP] == SERVICES
    assert may[Level.SERVICE] == set(Act) == set(RULES)


def test_the_page_is_the_table() -> None:
    assert (HOUSE / "docs" / "access.md").read_text("utf-8") == page()


@all_installed
@pytest.mark.parametrize("act", list(Act))
def test_somebody_asks_for_every_act(act: Act) -> None:
    """A rule that no page and no command asks for would be a promise that nobody keeps."""
    sources = (path.read_text("utf-8") for path in (HOUSE / "app").rglob("*.py"))
    assert any(f"Act.{act.name}" in text for text in sources)


def test_whoever_writes_asks_a_rule_or_is_known_to_need_none() -> None:
    """A new writer of the store, the program folder, outputs or inputs comes to this list, or to a rule."""
    app = HOUSE / "app"
    texts = {path.relative_to(app).as_posix(): path.read_text("utf-8") for path in app.rglob("*.py")}
    writers = {name for name, text in texts.items() if WRITES.search(text) and "Act." not in text}
    listed = {*BEHIND_A_RULE, *NO_CHANGE}
    absent = {name for name in listed if name.startswith("extras/") and name not in texts}
    assert writers == listed - absent


# --- off -------------------------------------------------------------------------------------------------


def test_without_people_nothing_is_asked_and_nothing_more_is_logged(room: Room) -> None:
    assert [room.access.refusal(act) for act in Act] == [""] * len(Act)
    assert room.access.words == ""
    room.desk.book.change(Kind.TOOL, 3, {"x": 1.0, "z": -1.0}, "typed")
    room.desk.counter.program = "pin.nc"
    room.find(PartsCounterFunction).correct(1)
    room.settle()
    assert room.store.history(Kind.TOOL)[0].who == "operator"
    assert room.log("change") == []
    assert room.desk.notice == ""


# --- refusals --------------------------------------------------------------------------------------------


def test_a_refusal_says_which_level_and_how_to_get_it(room: Room) -> None:
    room.enter_people()
    why = room.desk.book.change(Kind.TOOL, 3, {"x": 1.0, "z": -1.0}, "typed")
    assert why == wording("screen.level-needed", what="TOOL OFFSETS", level="SETUP", now="OPERATOR")
    room.settle()
    assert room.store.tools() == {}


def test_wear_is_the_operators_and_position_is_not(room: Room) -> None:
    room.store.set_tool(3, "touched off", x=1.0, z=-1.0).result(LIMIT)
    room.enter_people()
    book = room.desk.book
    assert shows(
        book.change(Kind.TOOL, 3, {"wear_x": 0.01, "x": 2.0}, "both"), "screen.level-needed", level="SETUP"
    )
    assert shows(book.undo(Kind.TOOL, 3, 1), "screen.level-needed", level="SETUP")
    assert shows(book.clear(Kind.ZERO, "all"), "screen.level-needed", level="SETUP")
    assert shows(book.choose_master(3, "master"), "screen.level-needed", level="SETUP")
    assert book.change(Kind.TOOL, 3, {"wear_x": 0.01}, "too large") == ""
    room.settle()
    assert book.change(Kind.SECONDARY, 1, {"x": -0.01}, "too large") == ""
    room.settle()
    assert (room.store.tools()[3].wear_x, room.store.tools()[3].x) == (0.01, 1.0)
    assert room.store.secondary()[1].x == -0.01


def test_nothing_is_asked_that_the_level_does_not_allow(room: Room) -> None:
    room.store.set_tool(3, "touched off", x=1.0, z=-1.0).result(LIMIT)
    room.desk.book.read()
    room.enter_people()
    questions = OffsetQuestions(OffsetHistory(room.desk, Kind.TOOL))
    refusals = (
        questions.change(Kind.TOOL, 3, {"x": -1.0}, "typed"),
        questions.touch_off(3, Touch(x=-1.0), "touched off"),
        questions.choose_master(3),
        questions.undo(Kind.TOOL, 3),
    )
    assert all(shows(why, "screen.level-needed", level="SETUP") for why in refusals)
    assert not room.desk.asked
    assert questions.change(Kind.TOOL, 3, {"wear_x": 1.0}, "typed") == ""
    assert room.desk.asked  # wear is the operator's, and this wear is large


def test_pages_without_a_book_refuse_too(room: Room) -> None:
    room.enter_people()
    programs, editor = room.desk.attached(ProgramList), room.desk.attached(Editor)
    assert programs is not None
    assert editor is not None
    assert shows(editor.may_save(), "screen.level-needed", what="PROGRAMS", level="SETUP")
    programs.transfer.begin((), None, out=False)
    assert not programs.transfer.open
    assert shows(room.desk.notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    room.find(MachineFileAcceptance)._accept()
    assert shows(room.desk.notice, "screen.level-needed", what="THE MACHINE FILE", level="SERVICE")
    room.sign_in("BEN")
    assert editor.may_save() == ""
    programs.transfer.begin((), None, out=False)
    assert programs.transfer.open


def test_a_lower_spindle_limit_is_everybodys_and_a_higher_one_is_not(room: Room) -> None:
    room.enter_people()
    limit = room.find(SpindleSpeedLimit)
    assert limit.take("1500")
    room.run()
    assert limit.take("1200")
    room.run()
    assert not limit.take("1500")
    assert shows(
        room.desk.notice,
        "screen.level-needed",
        what="HIGHER SPINDLE SPEED LIMIT",
        level="SETUP",
        now="OPERATOR",
    )
    limit.lift()
    assert shows(room.desk.notice, "screen.level-needed", level="SETUP")
    room.run()
    assert room.desk.snapshot().spindle_limit == 1200.0
    room.sign_in("BEN")
    limit.lift()
    limit._lifted()
    room.run()
    assert room.desk.snapshot().spindle_limit == 0.0
    assert room.log("change") == [
        (wording("log.spindle-limit", change="none → 1500 rpm"), "operator"),
        (wording("log.spindle-limit", change="1500 rpm → 1200 rpm"), "operator"),
        (wording("log.spindle-limit", change="1200 rpm → none"), "BEN"),
    ]


def test_outputs_by_hand_are_of_setup_and_the_lamp_test_is_not(room: Room) -> None:
    room.enter_people()
    page = room.find(InputsOutputs)
    page.kind = Shown.OUTPUTS
    page.marked = tuple(page.machine.outputs).index("coolant")
    room.desk.clear()
    page.act()
    assert shows(room.desk.notice, "screen.level-needed", what="MANUAL OUTPUTS", level="SETUP")
    page._force("coolant", True)  # the level fell back while it was asked
    room.run()
    assert "coolant" not in room.desk.snapshot().outputs
    room.sign_in("BEN")
    page._force("coolant", True)
    room.run()
    assert "coolant" in room.desk.snapshot().outputs
    assert room.log("change") == [(wording("log.output-on-by-hand", name="coolant"), "BEN")]


def test_what_has_come_by_the_line_is_not_stored_when_the_level_fell_back(room: Room) -> None:
    room.enter_people()
    room.sign_in("BEN")
    line = room.find(SerialTransfer)
    line.received = Received(b"M30\n", "PIN", 1, "", False, 0, (), 0.0)
    room.access.sign_out()
    line._store()
    assert shows(room.desk.notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    assert line.received is not None
    assert not (line.own / "PIN").exists()


def test_what_stops_the_machine_is_behind_no_level(room: Room) -> None:
    room.enter_people()
    desk = room.desk
    desk.enable()
    room.run()
    assert desk.snapshot().state is State.IDLE
    desk.feed_hold()
    desk.estop()
    room.run()
    assert desk.snapshot().state is State.ESTOP
    desk.hands.estop(pressed=False)
    room.run()
    desk.reset()
    room.run()
    assert desk.snapshot().state is State.DISABLED
    assert "LEVEL" not in desk.notice


def test_who_has_gone_away_finishes_nothing_by_other_hands(room: Room) -> None:
    """What was begun in a level is not ended by whoever finds it open when that level has fallen back."""
    room.enter_people()
    room.sign_in("ANNA")
    levels, programs = room.find(AccessLevels), room.desk.attached(ProgramList)
    assert programs is not None
    levels.keys()["F3"].action()
    typed(levels, "eve", "3", "1357")
    programs.transfer.begin((), None, out=False)
    room.at += 600.0
    room.run(1)
    typed(levels, "1357")
    assert shows(room.desk.notice, "screen.level-needed", what="USERS AND PINS", level="SERVICE")
    room.desk.clear()
    programs.transfer.worker.settle(LIMIT)
    programs.transfer._carry((HOUSE / "setup.cfg",), HOUSE, replace=True)
    assert shows(room.desk.notice, "screen.level-needed", what="PROGRAMS", level="SETUP")
    assert not programs.transfer.worker.busy
    room.settle()
    assert room.access.people.named("EVE") is None


# --- who did it ------------------------------------------------------------------------------------------


def test_every_history_has_the_name(room: Room) -> None:
    room.enter_people()
    room.sign_in("BEN")
    book, watch = room.desk.book, room.desk.attached(PartsWatch)
    assert watch is not None
    for kind, number, values in (
        (Kind.TOOL, 3, {"x": 1.0, "z": -1.0}),
        (Kind.SECONDARY, 1, {"x": -0.01}),
        (Kind.ZERO, 54, {"z": -120.0}),
        (Kind.SHAPE, 3, {"kind": "turning"}),
        (Kind.MILL_TOOL, 20, {"length": 80.0}),
        (Kind.PRESET, 3, {"x": 5.0}),
    ):
        assert book.change(kind, number, values, "set up") == ""
        room.settle()
        assert room.store.history(kind)[0].who == "BEN"
    room.journal.save_version("pin.nc", b"M30\n", "saved in the editor")
    assert room.store.versions("pin.nc")[0].who == "BEN"
    watch.lives.change_insert(3, "worn", lambda _text: None)
    room.settle()
    with room.store.read() as connection:
        assert [row.who for row in insert_changes(connection, 9)] == ["BEN"]
    room.desk.counter.program = "pin.nc"
    room.find(PartsCounterFunction).correct(1)
    assert room.log("change")[-1] == (
        wording("log.parts-changed", program="pin.nc", before=0, after=1),
        "BEN",
    )
    assert "change" in FILTERS["OPERATOR"]


def test_settings_sounds_and_notes_are_lines_of_the_log(room: Room) -> None:
    room.enter_people()
    room.sign_in("CARLA")
    room.desk.choose_setting("theme", "light")
    room.desk.next_readout()  # many times a shift: no line
    room.find(LampsAndSound)._choose(40, frozenset())
    sheet = room.find(SetupSheetFunction)
    room.desk.session._now = replace(room.desk.session.now, path=Path("pin.nc"))
    sheet._keep(["soft jaws"])
    sheet._keep(["soft jaws", "stop 12 mm"])
    sheet._keep(["stop 12 mm"])
    sheet.next_paper()
    texts = [text for text, who in room.log("change") if who == "CARLA"]
    assert texts[:5] == [
        wording("log.screen-setting", what="theme", before="dark", after="light"),
        wording("log.sound-setting", before=0, after=40, silent="nothing"),
        wording("log.notes", program="pin.nc", note="'soft jaws'"),
        wording("log.notes", program="pin.nc", note="'stop 12 mm'"),
        wording("log.notes", program="pin.nc", note=wording("log.note-gone", note="'soft jaws'")),
    ]
    assert [begins(text, "log.paper-size") for text in texts[5:]] == [True]


def test_an_accepted_machine_file_has_the_name(room: Room) -> None:
    room.enter_people()
    room.sign_in("ANNA")
    room.desk.changes.accept()
    assert shows(room.log("machine")[-1][0], "desk.machine-file-accepted-by", name="ANNA")


# --- signing in ------------------------------------------------------------------------------------------


def test_the_header_says_who_is_in_force(room: Room) -> None:
    room.enter_people()
    assert room.access.words == "OPERATOR"
    room.sign_in("BEN")
    assert room.access.words.replace("\u2068", "").replace("\u2069", "") == "BEN · SETUP"
    room.access.sign_out()
    assert room.access.words == "OPERATOR"
    assert room.log("access") == [
        (wording("log.signed-in", name="BEN", level="SETUP"), "BEN"),
        (wording("log.signed-out", name="BEN", why=""), "BEN"),
    ]


def test_wrong_pins_wait_longer_and_longer_and_are_logged(room: Room) -> None:
    room.enter_people()
    for _ in range(3):
        room.sign_in("BEN", "0815")
    assert shows(room.desk.notice, "desk.wrong-pin", seconds=5)
    room.sign_in("BEN")  # the right one, but too early
    assert room.access.name == ""
    assert room.desk.notice == wording("desk.too-many-pins", seconds=5)
    room.at += 5.0
    room.sign_in("BEN")
    assert room.access.name == "BEN"
    assert room.log("access")[2] == (wording("log.wrong-pin", name="BEN", count=3), "operator")


def test_a_new_start_does_not_forget_how_many_were_wrong(room: Room) -> None:
    room.enter_people()
    for _ in range(3):
        room.sign_in("BEN", "0815")
    room.settle()
    again = Access(room.journal, clock=lambda: 7.0)
    assert again.wrong.left(7.0) == 5.0


def test_the_waits_are_bounded() -> None:
    assert [wait_after(count) for count in range(12)] == [0, 0, 0, 5, 10, 20, 40, 80, 160, 300, 300, 300]
    wrong = WrongPins()
    for moment in (0.0, 1.0, 2.0):
        wrong.wrong(moment)
    assert wrong.left(4.0) == 3.0
    wrong.right()
    assert wrong.left(4.0) == 0.0


@pytest.mark.parametrize("pin", ["", "123", "1234567890123", "12a4", "1111", "12 34", "١٢٣٤"])
def test_what_is_no_pin_is_refused(pin: str) -> None:
    with pytest.raises(PinError):
        check_pin(pin)


def test_what_is_kept_of_a_pin_is_scrypt() -> None:
    """RFC 7914, chapter 12: the third vector has the N, r and p of older hashes, and our length in front."""
    old = "7023bdcb3afd7348461c06cd81fd38ebfda8fbba904f8e3ea9b543f6545da1f2"
    for kept in (
        Hashed(b"SodiumChloride", bytes.fromhex(old)),
        Hashed(b"SodiumChloride", bytes((14, 8, 1)) + bytes.fromhex(old)),
        hashed("pleaseletmein", b"SodiumChloride"),
    ):
        assert is_pin("pleaseletmein", kept)
        assert not is_pin("pleaseletmeIn", kept)
    assert hashed("4711") != hashed("4711")  # each has a salt of its own


def test_a_try_costs_what_half_a_second_holds() -> None:
    """Older hashes took 0.03 s of an idle core: 32 times the work is 0.9 s."""
    work = TODAY.r * TODAY.p << TODAY.log2_n
    assert work >= 32 * (8 * 1 << 14)


@pytest.mark.parametrize("damage", [b"", b"\x04\x08", bytes(31), bytes(34), bytes(40)])
def test_no_pin_fits_a_hash_of_another_length(damage: bytes) -> None:
    assert not is_pin("4711", Hashed(b"salt", damage))


def test_an_old_hash_is_made_anew_when_its_pin_is_entered(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    room.enter_people()
    old = room.access.people.rows
    monkeypatch.setattr(pins, "COST", pins.Cost(5, 8, 1))
    room.sign_in("BEN", "9999")
    assert room.store.people().rows == old
    room.at += 300.0
    room.sign_in("BEN")
    now = room.store.people().named("BEN")
    assert now is not None
    assert (room.access.name, room.access.people.named("BEN")) == ("BEN", now)
    assert now.hash[:3] == bytes((5, 8, 1))
    assert is_pin(PINS["BEN"], Hashed(now.salt, now.hash))
    assert {row for row in old if row.name != "BEN"} < set(room.store.people().rows)


def test_who_has_no_pin_is_let_in_by_none(room: Room) -> None:
    room.journal.keep_person(PersonRow("DORA", Level.SERVICE, b"", b""))
    room.access.reload()
    room.sign_in("DORA", "4711")
    assert room.access.name == ""
    assert begins(room.desk.notice, "desk.no-pin", name="DORA")


def test_the_store_does_not_hold_the_pin(room: Room, tmp_path: Path) -> None:
    room.journal.keep_person(PersonRow("DORA", Level.SERVICE, *hashed("660391827455")))
    room.settle()
    for path in (tmp_path / "home").glob("turndesk.db*"):
        assert b"660391827455" not in path.read_bytes()


# --- time ------------------------------------------------------------------------------------------------


def test_a_level_falls_back_and_says_so_before(room: Room) -> None:
    room.enter_people()
    room.sign_in("ANNA")
    room.at += 569.0
    room.desk.clear()
    room.run(1)
    assert room.desk.notice == ""
    room.at += 1.0
    room.run(1)
    assert shows(room.desk.notice, "desk.level-ends", seconds=30)
    room.access.used()
    room.at += 599.0
    room.run(1)
    assert room.access.name == "ANNA"
    room.at += 1.0
    room.run(1)
    assert (room.access.name, room.access.level) == ("", Level.OPERATOR)
    assert shows(room.desk.notice, "desk.was-away")
    assert room.log("access")[-1] == (
        wording("log.signed-out", name="ANNA", why=wording("log.without-input", minutes=10)),
        "ANNA",
    )


def test_who_is_taken_away_is_not_in_force_any_more(room: Room) -> None:
    room.enter_people()
    room.sign_in("BEN")
    room.journal.remove_person("BEN")
    room.access.reload()
    assert room.access.words == "OPERATOR"


def test_levels_come_back_with_a_store_that_was_away_at_the_start(room: Room, tmp_path: Path) -> None:
    """Else whoever was there then could enter himself as the first one, beside those of the store."""
    room.enter_people()
    store, room.journal._store = room.journal._store, None
    folder, room.journal._folder = room.journal._folder, damaged_home(tmp_path)
    room.desk.access = again = Access(room.journal, clock=lambda: room.at)
    again.level = Level.OPERATOR
    assert (again.people.on, again.people.rows) == (True, ())
    room.journal._store, room.journal._folder = store, folder
    room.at += 1.0
    room.run(1)
    assert shows(again.refusal(Act.PEOPLE), "screen.level-needed", level="SERVICE")
    assert [row.name for row in again.people.rows] == ["ANNA", "BEN", "CARLA"]
    again.close()


def damaged_home(tmp_path: Path) -> Path:
    folder = tmp_path / "damaged"
    folder.mkdir()
    (folder / FILE_NAME).write_bytes(b"SQLite format 3")
    return folder


def test_people_that_cannot_be_read_leave_the_strictest_level(room: Room, tmp_path: Path) -> None:
    room.journal._store, store = None, room.journal._store
    room.journal._folder = damaged_home(tmp_path)
    room.access.reload()
    may = {act for act in Act if not room.access.refusal(act)}
    assert may == OPERATORS
    reset = room.find(AccessLevels).service_reset
    assert reset.why_not(room.desk.snapshot()) == wording("desk.press-e-stop-first")
    reset.reset()
    room.access.worker.settle(LIMIT)
    room.at += 2.0
    room.run(1)
    assert [room.access.refusal(act) for act in Act] == [""] * len(Act)
    room.journal._store = store


def test_a_second_desk_has_the_levels_of_the_first(room: Room, tmp_path: Path) -> None:
    room.enter_people()
    beside = Journal(tmp_path / "home")
    assert beside.people() == room.store.people()
    beside.close()


# --- people ----------------------------------------------------------------------------------------------


def typed(levels: AccessLevels, *texts: str) -> None:
    for text in texts:
        for sign in text:
            levels.typed(sign)
        levels.typed("Enter")


def test_the_first_one_is_of_service_and_switches_levels_on(room: Room) -> None:
    levels = room.find(AccessLevels)
    levels.keys()["F3"].action()
    typed(levels, "anna", "4711")
    assert levels.sheet(room.desk.snapshot()).question == wording("desk.same-pin-again")
    typed(levels, "4711")
    room.settle()
    assert [(row.name, row.level) for row in room.access.people.rows] == [("ANNA", 3)]
    levels.keys()["F3"].action()
    assert shows(room.desk.notice, "screen.level-needed", what="USERS AND PINS", level="SERVICE")
    typed(levels, "", "4711")  # Return on her name, and her PIN
    room.settle()
    levels.keys()["F3"].action()
    typed(levels, "Ben", "2", "2580", "2580")
    room.settle()
    assert [(row.name, row.level) for row in room.access.people.rows] == [("ANNA", 3), ("BEN", 2)]
    assert room.log("access")[-1] == (wording("log.entered", name="BEN", level="SETUP"), "ANNA")


def test_two_different_pins_keep_nothing(room: Room) -> None:
    levels = room.find(AccessLevels)
    levels.keys()["F3"].action()
    typed(levels, "anna", "4711", "4712")
    room.settle()
    assert not room.access.people.on
    assert wording("desk.two-different-pins").upper() in room.desk.notice.upper()


def test_a_pin_is_not_shown(room: Room) -> None:
    room.enter_people()
    levels = room.find(AccessLevels)
    levels.act()
    for sign in "4711":
        levels.typed(sign)
    assert levels.sheet(room.desk.snapshot()).text == "●●●●"
    assert not levels.takes("x")
    levels.left()
    assert levels.entry.text == ""


def test_one_of_service_stays(room: Room) -> None:
    room.enter_people()
    with pytest.raises(StoreError, match=pattern("desk.service-stays")):
        room.journal.remove_person("ANNA")
    for name in ("BEN", "CARLA", "ANNA"):
        room.journal.remove_person(name)
    room.access.reload()
    assert not room.access.people.on


def test_a_damaged_row_lets_nobody_in_and_switches_nothing_off(room: Room, tmp_path: Path) -> None:
    room.enter_people()
    with closing(sqlite3.connect(tmp_path / "home" / FILE_NAME)) as outside, outside:
        outside.execute("UPDATE people SET level = 3 WHERE name = 'CARLA'")
    room.access.reload()
    assert room.access.people.on
    assert room.access.people.named("CARLA") is None
    assert any(
        begins(text, "desk.not-as-saved", what=f"{wording('desk.pin-of')} CARLA")
        for text in room.store.damaged()
    )


def test_a_store_of_before_has_no_levels_and_keeps_its_log(tmp_path: Path) -> None:
    folder = tmp_path / "older"
    folder.mkdir()
    before = next(n for n, text in enumerate(database.migrations()) if "CREATE TABLE people" in text)
    with closing(sqlite3.connect(folder / FILE_NAME, isolation_level=None)) as connection:
        connection.execute(f"PRAGMA application_id = {database.APPLICATION_ID}")
        database.migrate(connection, database.migrations()[:before])
        connection.execute("INSERT INTO events (at, kind, text) VALUES ('2026-01-02', 'start', 'pin.nc')")
        connection.execute("INSERT INTO tool_offsets (number, x, z, r) VALUES (3, 1.0, -1.0, 0.0)")
    with Store.open(folder) as store:
        assert not store.people().on
        assert [(row.text, row.who) for row in store.events()] == [("pin.nc", "")]
        assert store.tools()[3].x == 1.0
        assert store.damaged() == ()


# --- service reset ---------------------------------------------------------------------------------------


def pressed(room: Room) -> Callable[[], None]:
    room.enter_people()
    room.desk.estop()
    room.run()
    levels = room.find(AccessLevels)
    levels.keys()["F9"].action()
    assert begins(room.desk.notice, "desk.take-all-pins-away")
    levels.service_reset.begin()
    return levels.service_reset.begin


def test_ten_minutes_of_estop_take_all_pins_away(room: Room) -> None:
    pressed(room)
    room.at += WAIT - 1.0
    room.run(1)
    assert room.access.people.on
    assert room.access.words == wording("desk.pins-reset-in", time="0:01")
    room.at += 1.0
    room.run(1)
    room.settle()
    assert not room.access.people.on
    assert room.access.words == ""
    told = [text for text, _who in room.log("access")]
    assert begins(told[0], "desk.reset-begun")
    assert told[-1] == wording("desk.reset-done")


def test_the_reset_needs_the_estop_and_ends_with_it(room: Room) -> None:
    room.enter_people()
    room.find(AccessLevels).ask_reset()
    assert begins(room.desk.notice, "desk.e-stop-for-reset")
    pressed(room)
    room.at += 300.0
    room.run(1)
    room.desk.hands.estop(pressed=False)
    room.run()
    room.at += WAIT
    room.run(1)
    room.settle()
    assert room.access.people.on
    assert room.log("access")[-1][0] == wording("desk.reset-given-up")


def test_a_pin_ends_the_reset(room: Room) -> None:
    pressed(room)
    room.sign_in("ANNA")
    room.run(1)
    room.at += WAIT
    room.run(1)
    room.settle()
    assert room.access.people.on
