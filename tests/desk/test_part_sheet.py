"""The page PART: what is said of the stock and kept, what is refused, and checks that are silenced."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

import pytest

import resources
from app.compose.machine.machine_files import load_machine, parse_machine
from app.compose.program_proving import create_loading_steps
from app.compose.stored_offsets import Offsets
from app.desk.arithmetic import InvalidEntryError
from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import LoadingPhase, ProgramLoader
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.desk.stored_part import StoredPart, load_stored_part
from app.part.part_model import PartPageModel, PartPageTable
from app.part.part_tables import make_table
from app.part.stock_entry import StockEntry, StockField, StockKind
from core.executor.commands import Command
from core.executor.snapshot import MachineState, Snapshot
from core.language.diagnostics import Diagnostic, Severity
from core.machine.machine_model import Machine
from core.part.stock_spec import parse_stock_specification
from core.proving.checks.part_checks import PART_CHECKS
from core.store.store_errors import StoreError
from tests.desk.test_part_found import LIMIT, SHAFT, SLIP, TOOLS, TURNING
from tests.texts import begins, shows
from tests.texts import text as wording


class Bench:
    """The page of a desk that loads real programs."""

    def __init__(
        self, folder: Path, of_machine: frozenset[str] = frozenset(), model: Machine | None = None
    ) -> None:
        self.state, self.folder = MachineState.IDLE, folder
        self.keep, posted = Persistence(), list[Command]()
        steps = create_loading_steps(
            load_machine(None),
            lambda: Offsets(TOOLS, {}, {}),
            read_shapes=lambda: {1: TURNING},
            read_stored_part=partial(load_stored_part, self.keep.read_setting),
        )
        self.desk = Desk(
            DeskControl(posted.append, lambda: Snapshot(state=self.state)),
            ProgramLoader(steps, posted.append),
            ProgramFolders((folder,)),
            machine=DeskMachine(machine=model),
        )
        self.page = PartPageModel(self.desk, self.keep, frozenset(PART_CHECKS), of_machine)
        self.shown: list[Diagnostic] = []
        self.page.show_location = self.shown.append
        self.desk.page_registry.attach_model(self.page)

    def load(self, text: str, name: str = "part.nc") -> None:
        (self.folder / name).write_text(text)
        self.desk.program_loader.start_loading(self.folder / name)
        self.settle()

    def settle(self) -> None:
        self.page.worker.wait_for_results(LIMIT)
        self.desk.program_loader.wait_until_loaded(LIMIT)
        self.page.poll()

    def types(self, text: str) -> None:
        for key in text:
            assert self.page.handle_key(key), key
        assert self.page.handle_key("Enter")
        self.settle()

    def press(self, *keys: str) -> None:
        for key in keys:
            named = self.page.make_function_keys().get(key)
            if named is not None:
                named.action()
            else:
                self.page.handle_key(key)
        self.settle()

    @property
    def kept(self) -> StoredPart:
        return load_stored_part(self.keep.read_setting, "part.nc")

    @property
    def cells(self) -> Mapping[str, tuple[str, ...]]:
        return {row.cells[0]: row.cells[1:] for row in make_table(self.page).rows}


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path)
    yield made
    made.desk.close()


# --- the stock in fields ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "words",
    ["bar:1", "bar:0.75:3+0.02", "bar:25mm", "tube:1:0.5:2.5", "profile:/a/blank.csv+0.1", "after:/b/op1.nc"],
)
def test_stored_stock_is_shown_as_it_was_entered(words: str) -> None:
    entry = StockEntry.from_stored_part(StoredPart(words, 20.0))
    assert entry.words == words
    assert entry.stick_out == 20.0
    assert entry.missing_field is None


def test_stock_text_has_the_lengths_that_were_typed() -> None:
    entry = StockEntry(StockKind.TUBE).typed(StockField.DIAMETER, "1+1/8", is_metric=False)
    entry = entry.typed(StockField.BORE, "10", is_metric=True)
    spec = parse_stock_specification(entry.words)
    assert (spec.diameter, spec.bore) == (pytest.approx(28.575, abs=1e-6), pytest.approx(10.0))


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (StockField.DIAMETER, "-1"),
        (StockField.DIAMETER, "1/0"),
        (StockField.STICK_OUT, "41"),
        (StockField.BORE, "1"),
    ],
)
def test_impossible_stock_dimension_is_rejected(name: StockField, text: str) -> None:
    with pytest.raises(InvalidEntryError):
        StockEntry(StockKind.TUBE, diameter=25.4).typed(name, text, is_metric=False)


# --- saying it ----------------------------------------------------------------------------------------


def test_bar_stock_is_entered_saved_and_used_for_the_proof(bench: Bench) -> None:
    bench.load(SLIP)
    assert bench.desk.program_loader.loaded_program.phase is LoadingPhase.READY
    bench.press("F2")
    assert bench.page.shown_table is PartPageTable.STOCK
    assert bench.cells["STOCK"] == ("–", "BAR")  # what is assumed stands beside it
    bench.press("Right")
    assert bench.kept == StoredPart()  # without a diameter it is none yet
    assert make_table(bench.page).notes == (wording("desk.still-to-say", field="DIAMETER"),)
    bench.press("Down")
    bench.types("1")
    assert bench.kept.stock_text == "bar:1"
    assert bench.cells["DIAMETER"] == ("1.00000", "")
    assert (
        bench.desk.program_loader.loaded_program.phase is LoadingPhase.REFUSED
    )  # the tool has a shape: nothing is assumed
    bench.press("Down", "Down")
    bench.types(".02")
    assert bench.kept.stock_text == "bar:1+0.02"
    bench.press("Down")
    bench.types(".8")
    assert bench.kept == StoredPart("bar:1+0.02", pytest.approx(20.32))
    assert shows(make_table(bench.page).notes[0], "desk.needs-clamping")


def test_entered_stock_can_be_cleared(bench: Bench) -> None:
    bench.load(SLIP)
    bench.press("F2", "Right", "Down")
    bench.types("1")
    bench.press("F6")
    assert bench.kept == StoredPart()
    assert bench.desk.program_loader.loaded_program.phase is LoadingPhase.READY
    assert shows(bench.desk.prompt_notice, "desk.stock-forgotten")
    bench.press("F6")
    assert bench.desk.prompt_notice == wording("desk.no-stock")


def test_stock_file_is_found_next_to_the_program_and_saved_with_full_path(bench: Bench) -> None:
    (bench.folder / "blank.csv").write_text("-2,.5\n0,.5\n")
    bench.load(SHAFT)
    bench.press("F2", "Left", "Left")
    assert bench.cells["STOCK"][0] == "PROFILE"
    bench.press("Down", "Enter")
    assert bench.page.is_entering_text
    bench.types("gone.csv")
    assert shows(bench.desk.prompt_notice, "desk.no-file-beside", name="gone.csv")
    bench.press(*["Back"] * 8)
    bench.types("blank.csv")
    assert bench.kept.stock_text == f"profile:{bench.folder / 'blank.csv'}"
    part = bench.desk.program_loader.loaded_program.part_proof
    assert part is not None
    assert part.report is not None
    assert part.report.stock is not None
    assert part.report.stock.max_radius_mm == pytest.approx(12.7)


@pytest.mark.parametrize("text", ["-1", "1..", ""])
def test_invalid_length_changes_nothing(bench: Bench, text: str) -> None:
    bench.load(SHAFT)
    bench.press("F2", "Right", "Down")
    bench.types(text)
    assert begins(bench.desk.prompt_notice, "screen.refused")
    assert bench.kept == StoredPart()


def test_stock_cannot_be_changed_while_the_program_runs(bench: Bench) -> None:
    bench.load(SLIP)
    bench.state = MachineState.RUN
    bench.press("F4")
    assert shows(bench.desk.prompt_notice, "desk.stock-between-cycles")
    assert not bench.page.is_entering_text
    bench.press("F2", "Right")
    assert bench.cells["STOCK"][0] == "–"
    assert bench.kept == StoredPart()


def test_stock_cannot_be_entered_on_a_mill(tmp_path: Path) -> None:
    mill = parse_machine(resources.read_machine_file("ac-table-mill.toml"), "mill")
    bench = Bench(tmp_path, model=mill)
    bench.load(SHAFT)
    bench.press("F2", "Right")
    assert bench.desk.prompt_notice == wording("desk.no-part-on-mill")
    assert bench.kept == StoredPart()
    bench.desk.close()


def test_stock_cannot_be_entered_without_a_program(bench: Bench) -> None:
    bench.page.poll()
    assert make_table(bench.page).rows == ()
    bench.press("F2", "Right")
    assert shows(bench.desk.prompt_notice, "screen.load-program-for-stock")
    assert not bench.page.accepts_key("1")


def test_failure_to_save_the_stock_is_reported(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_given: object) -> None:
        raise StoreError("the disk is full")

    bench.load(SHAFT)
    monkeypatch.setattr(Persistence, "save_settings", full)
    bench.press("F2", "Right", "Down")
    bench.types("1")
    assert bench.desk.prompt_notice == wording("screen.not-kept", why="the disk is full")
    assert bench.desk.program_loader.loaded_program.phase is LoadingPhase.READY


# --- findings -----------------------------------------------------------------------------------------


def test_finding_is_listed_with_its_remedy_and_shows_its_location(bench: Bench) -> None:
    bench.load(SLIP)
    (row,) = make_table(bench.page).rows
    assert row.cells[:2] == ("11", "rapid-into-stock")
    assert wording("desk.left-on") in " ".join(make_table(bench.page).notes)
    bench.press("Enter")
    assert [found.line for found in bench.shown] == [11]


def test_check_is_disabled_with_a_reason_and_enabled_again(bench: Bench) -> None:
    bench.load(SLIP)
    bench.press("F4")
    assert make_table(bench.page).entry_prompt == wording("desk.why-silenced", check="rapid-into-stock")
    bench.types("")
    assert shows(bench.desk.prompt_notice, "desk.reason-needed")
    bench.types("drilled before")
    assert bench.kept.silenced_checks == {"rapid-into-stock": "drilled before"}
    (found,) = bench.desk.program_loader.loaded_program.diagnostics
    assert (found.severity, found.downgrade_reason) == (Severity.NOTE, "drilled before")
    assert bench.page.make_function_keys()["F4"].label == "UNDO"
    bench.press("F4")
    assert bench.kept == StoredPart()
    assert bench.desk.program_loader.loaded_program.diagnostics[0].severity is Severity.WARNING


def test_escape_leaves_the_check_on(bench: Bench) -> None:
    bench.load(SLIP)
    bench.press("F4")
    bench.page.handle_key("x")
    assert bench.page.handle_escape()
    assert not bench.page.is_entering_text
    assert bench.kept == StoredPart()
    assert not bench.page.handle_escape()


def test_interpreter_findings_cannot_be_disabled(bench: Bench) -> None:
    bench.load("G90G94F100\nT1\nX.5Q7\nM30\n")
    assert bench.page.selected_finding is not None
    bench.press("F4")
    assert shows(bench.desk.prompt_notice, "desk.only-part-checks")
    assert not bench.page.is_entering_text


def test_check_disabled_by_the_machine_file_cannot_be_enabled_here(tmp_path: Path) -> None:
    bench = Bench(tmp_path, frozenset({"rapid-into-stock"}))
    bench.load(SLIP)
    bench.press("F4")
    assert shows(bench.desk.prompt_notice, "desk.machine-silences", check="rapid-into-stock")
    bench.desk.close()
