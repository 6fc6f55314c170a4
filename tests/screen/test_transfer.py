"""F10 RS-232 by keys alone: settings, a program out, a program in under a new name; and what is refused."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Generic, TypeVar

import pytest
from pytestqt.qtbot import QtBot

from app.compose.runs.journal import Journal
from app.desk.status.prompt_line import MessageKind
from app.special.special_functions import SpecialFunctionsModel
from app.special.special_view import SpecialFunctionsPage
from app.transfer.line_transfer import ReceivedProgram
from app.transfer.serial_transfer import SerialTransferFunction
from core.executor.commands import FeedHold
from core.executor.snapshot import MachineState
from core.machine.serial_and_backup_tables import SerialLineModel
from core.ports import DriverError
from tests.attached import attached
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key, window_on
from tests.screen.yes import yes
from tests.texts import shows, text

DEFAULT = SerialLineModel("/dev/ttyUSB0", 9600, 7, "E", 1, "xonxoff", "%", "\r\n")
CAME = ReceivedProgram(b"O77\nM30\n", "O77.nc", 2, "ab" * 32, False, 3, (), 1.5)
T = TypeVar("T")
WAIT = 60.0


@dataclass(frozen=True)
class Reach:
    transferred_byte_count: int = 640
    total_byte_count: int = 1280
    transferred_line_count: int = 20
    wait_reason: str = "held"
    leading_text: str = ""


class Script(Generic[T]):
    """A transfer that goes on until the test lets it end, or somebody gives it up."""

    def __init__(self, answer: T, fails: Exception | None) -> None:
        self.progress = Reach()
        self.answer, self.fails = answer, fails
        self.go = threading.Event()
        self.cancelled = False

    def cancel(self) -> None:
        self.cancelled = True
        self.go.set()

    def run_transfer(self) -> T:
        assert self.go.wait(WAIT)
        if self.cancelled:
            raise DriverError("cancelled")
        if self.fails is not None:
            raise self.fails
        return self.answer


@dataclass
class FakeLines:
    """A program that goes out, or ``CAME``; ``fails`` instead, where it is given."""

    fails: Exception | None = None
    job: Script[int] | Script[ReceivedProgram] | None = None
    said: list[tuple[SerialLineModel, Path | None]] = field(default_factory=list)

    def list_ports(self) -> list[tuple[str, str]]:
        return [("/dev/ttyS0", ""), ("/dev/ttyUSB0", "adapter")]

    def make_send_transfer(self, settings: SerialLineModel, path: Path) -> Script[int]:
        self.said.append((settings, path))
        job = self.job = Script(1280, self.fails)
        return job

    def make_receive_transfer(self, settings: SerialLineModel) -> Script[ReceivedProgram]:
        self.said.append((settings, None))
        job = self.job = Script(CAME, self.fails)
        return job


@pytest.fixture
def lines() -> FakeLines:
    return FakeLines()


@pytest.fixture
def hands(
    qtbot: QtBot, machine: FakeMachine, journal: Journal, lines: FakeLines, tmp_path: Path
) -> Iterator[Hands]:
    """A desk whose machine has a line for programs."""
    desk = desk_on(machine, keep=journal)
    section = SerialTransferFunction(desk, journal, lines, DEFAULT, tmp_path / "own")
    special = attached(desk, SpecialFunctionsModel)
    functions = list(special.functions)
    (line,) = (number for number, each in enumerate(functions) if each.name == section.name)
    functions[line].close()
    functions[line] = section
    special.functions = functions
    with window_on(qtbot, desk, machine) as window:
        made = Hands(qtbot, window, desk, machine)
        made.key(Key.Key_F10)
        made.type("9")
        made.key(Key.Key_Return)
        made.sees(lambda: page(made).model.inside and section.port_names != ())
        yield made


def page(hands: Hands) -> SpecialFunctionsPage:
    shown = hands.frame.current_page
    assert isinstance(shown, SpecialFunctionsPage)
    return shown


def cells(hands: Hands) -> dict[str, str]:
    return {row.cells[0]: row.cells[1] for row in page(hands).table_panel.table.rows}


def test_settings_are_changed_by_arrows_and_saved_by_return(hands: Hands, journal: Journal) -> None:
    assert cells(hands)["BITS, PARITY, STOP BITS"] == "7E1"
    hands.key(Key.Key_Return)
    hands.sees(lambda: cells(hands)["PORT"] == "/dev/ttyS0")
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    hands.sees(lambda: cells(hands)["BITS, PARITY, STOP BITS"] == "7E2")

    def kept() -> bool:
        value = journal.read_setting("rs232")
        return isinstance(value, dict) and (value["port"], value["stop"]) == ("/dev/ttyS0", 2)

    hands.sees(kept)


def test_received_program_gets_new_name_and_starts_nothing(
    hands: Hands, lines: FakeLines, tmp_path: Path
) -> None:
    hands.key(Key.Key_F5)
    hands.sees(lambda: cells(hands).get("STATUS") == text("screen.xoff"))
    assert cells(hands)["DONE"] == "50%"
    assert lines.job is not None
    posted = len(hands.machine.posted)
    lines.job.go.set()
    hands.sees(lambda: page(hands).table_panel.table.entry_prompt == text("screen.name-of-new-program"))
    assert page(hands).table_panel.table.text == "O77.nc"
    assert cells(hands)["PROVED"] == "NO ERRORS"
    hands.key(Key.Key_Delete)
    hands.type("new")
    hands.key(Key.Key_Return)
    target = tmp_path / "own" / "new.nc"
    hands.sees(target.exists)
    assert target.read_bytes() == CAME.program_bytes
    assert shows(hands.desk.prompt_notice, "screen.stored-as-new")
    assert len(hands.machine.posted) == posted


def test_existing_name_is_rejected_and_received_program_remains(
    hands: Hands, lines: FakeLines, tmp_path: Path
) -> None:
    (tmp_path / "own").mkdir()
    old = tmp_path / "own" / "O77.nc"
    old.write_bytes(b"OLD\n")
    hands.key(Key.Key_F5)
    assert lines.job is not None
    lines.job.go.set()
    hands.sees(lambda: page(hands).table_panel.table.text == "O77-2.nc")
    hands.key(Key.Key_Delete)
    hands.type("o77")
    hands.key(Key.Key_Return)
    hands.sees(lambda: shows(hands.desk.prompt_notice, "screen.name-is-there"))
    assert old.read_bytes() == b"OLD\n"
    assert page(hands).table_panel.table.entry_prompt == text("screen.name-of-new-program")


def test_received_program_is_discarded_after_confirmation(
    hands: Hands, lines: FakeLines, tmp_path: Path
) -> None:
    hands.key(Key.Key_F5)
    assert lines.job is not None
    lines.job.go.set()
    hands.sees(lambda: page(hands).table_panel.table.entry_prompt != "")
    hands.key(Key.Key_F6)
    hands.sees(lambda: shows(hands.desk.prompt_notice, "screen.throw-away-received"))
    assert page(hands).table_panel.table.entry_prompt != ""
    yes(hands.window)
    hands.sees(lambda: page(hands).table_panel.table.entry_prompt == "")
    assert not (tmp_path / "own").exists()


def test_canceled_reception_saves_nothing(hands: Hands, lines: FakeLines, tmp_path: Path) -> None:
    hands.key(Key.Key_F5)
    hands.sees(lambda: "STATUS" in cells(hands))
    hands.key(Key.Key_F6)
    hands.sees(lambda: text("screen.nothing-kept", why="cancelled") in hands.desk.prompt_notice)
    assert "PORT" in cells(hands)
    assert not (tmp_path / "own").exists()


def test_transfer_error_is_reported(hands: Hands, lines: FakeLines) -> None:
    lines.fails = DriverError("parity error in line 7")
    hands.key(Key.Key_F5)
    assert lines.job is not None
    lines.job.go.set()
    hands.sees(lambda: text("screen.nothing-kept", why="parity error in line 7") in hands.desk.prompt_notice)
    assert hands.desk.prompt_line.notice_kind is MessageKind.REFUSAL


def test_missing_serial_port_is_reported(hands: Hands) -> None:
    section = page(hands).model.shown_function
    assert isinstance(section, SerialTransferFunction)
    port, section.port_names = section.line_settings.port, ()
    hands.key(Key.Key_Return)
    assert shows(hands.desk.prompt_notice, "screen.no-serial-port")
    assert section.line_settings.port == port
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)  # the other settings need none
    assert not shows(hands.desk.prompt_notice, "screen.no-serial-port")


def test_nothing_is_sent_without_loaded_program(hands: Hands, lines: FakeLines) -> None:
    hands.key(Key.Key_F4)
    hands.sees(lambda: shows(hands.desk.prompt_notice, "screen.nothing-to-send"))
    assert lines.said == []


def test_loaded_program_is_sent(hands: Hands, lines: FakeLines) -> None:
    assert hands.desk.program_choice.load_by_name("pin.nc")
    hands.sees(lambda: hands.desk.program_loader.loaded_program.path is not None)
    hands.key(Key.Key_F4)
    hands.sees(lambda: lines.job is not None)
    assert lines.job is not None
    lines.job.go.set()
    hands.sees(lambda: text("screen.is-sent", name="pin.nc", count=1280) in hands.desk.prompt_notice)
    assert hands.desk.prompt_line.notice_kind is MessageKind.SUCCESS
    (said,) = lines.said
    assert said[1] is not None
    assert said[1].name == "pin.nc"


def test_reception_continues_while_other_pages_are_open(hands: Hands, lines: FakeLines) -> None:
    hands.key(Key.Key_F5)
    hands.sees(lambda: "STATUS" in cells(hands))
    hands.key(Key.Key_Escape)
    hands.key(Key.Key_Escape)
    assert lines.job is not None
    assert not lines.job.cancelled
    lines.job.go.set()
    hands.key(Key.Key_F10)
    hands.type("9")
    hands.key(Key.Key_Return)
    hands.sees(lambda: page(hands).table_panel.table.entry_prompt != "")


def test_letters_name_received_program_while_another_one_runs(
    hands: Hands, lines: FakeLines, tmp_path: Path
) -> None:
    hands.key(Key.Key_F5)
    assert lines.job is not None
    lines.job.go.set()
    hands.sees(lambda: page(hands).table_panel.table.entry_prompt != "")
    hands.machine.now = replace(hands.machine.now, state=MachineState.WAIT)
    hands.type("hec")
    assert FeedHold() not in hands.machine.posted
    assert not hands.desk.station_controls.is_estop_pressed
    assert not hands.machine.now.cycle_repeat
    assert page(hands).table_panel.table.text == "O77.nchec"
    hands.machine.idle()
