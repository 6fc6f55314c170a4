"""The demo: sample offsets that may be changed, in a store that is nobody's machine."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from app.cli.main import main
from app.compose.demo_store import find_demo_program, open_demo_data_folder
from app.compose.machine.machine_setup import create_power_up_setup, read_machine
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import create_offset_book, read_stored_offsets
from app.desk.command_errors import CommandError
from app.desk.pages.first_job import FirstJobCard
from app.desk.programs.program_choice import LAST_PROGRAM_SETTING
from app.desk.stored_part import EMPTY_STORED_PART, load_stored_part
from core.language.diagnostics import Severity
from core.language.source import load_source
from core.message import CodedError
from core.proving.prove_program import prove
from core.store.store import Store
from tests.coded import raises_code

INCH = 25.4


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A data folder of its own; the demo's place in the environment ends with the test."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    return tmp_path


def test_demo_offsets_match_the_samples_and_can_be_changed(home: Path) -> None:
    folder = open_demo_data_folder(None)
    assert folder == home / "demo"
    journal = Journal.open_default()
    book = create_offset_book(read_stored_offsets, journal)
    assert not book.lock_reason
    assert book.tool_offsets[1].x == pytest.approx(-0.5 * INCH)
    journal.close()
    assert not (home / "turndesk.db").exists()  # nothing of it in the store of the machine


def test_lathe_demo_has_specified_stock_in_a_collet(home: Path) -> None:
    with Store.open(open_demo_data_folder(None), read_only=True) as store:
        kept = load_stored_part(store.settings.read_setting, "bushing.nc")
        assert load_stored_part(store.settings.read_setting, "pinbar.nc") == EMPTY_STORED_PART
    assert (kept.stock_text, kept.stick_out_mm) == ("tube:1.0:.4:2.4", pytest.approx(1.2 * INCH))
    assert read_machine(None).clamping.diameter == pytest.approx(2.5 * INCH)


def test_mill_demo_tool_table_has_all_tools_of_its_samples(home: Path) -> None:
    """It showed 0 for tools whose length counted."""
    with Store.open(open_demo_data_folder("bc-table-mill")) as store:
        lengths = {
            number: (row.length, round(row.radius, 3))
            for number, row in store.offsets.mill_tools.read_rows().items()
        }
    assert lengths == {6: (3.5 * INCH, 2.5), 8: (4.0 * INCH, 4.25), 20: (3.0 * INCH, 6.0)}


def test_changes_in_demo_are_retained_when_it_is_reopened(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store.open(open_demo_data_folder(None)) as store:
        store.offsets.tool_offsets.change_row(1, values={"x": 3.0}, why="test", who="test").result()
    monkeypatch.setenv("TURNDESK_HOME", str(home))  # the next start
    with Store.open(open_demo_data_folder(None), read_only=True) as store:
        assert store.offsets.tool_offsets.read_rows()[1].x == 3.0


def test_demo_is_rejected_for_a_real_machine(home: Path) -> None:
    with raises_code(CommandError, "real-machine", "gt75-grblhal.toml"):
        open_demo_data_folder("gt75-grblhal")
    assert os.environ["TURNDESK_HOME"] == str(home)
    assert not (home / "demo").exists()


@pytest.mark.parametrize("argv", [["--demo", "offsets", "show"], ["offsets", "show", "--demo"]])
def test_a_command_uses_the_data_of_the_demo(
    argv: list[str], home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(argv) == 0
    assert capsys.readouterr().out.startswith("T1  X -0.50000")
    assert not (home / "turndesk.db").exists()


def test_conflicting_kiosk_version_and_demo_options_are_rejected(
    home: Path, refusals: list[CodedError]
) -> None:
    assert main(["--kiosk", "offsets", "show"]) == 2
    assert main(["--version", "--demo"]) == 2
    assert main(["--demo", "prove", "part.nc", "--machine", "gt75-grblhal"]) == 2
    assert [each.code for each in refusals] == ["screen-option", "version-alone", "real-machine"]


MILLS = ("ac-table-mill", "bc-table-mill", "fork-head-mill", "head-table-mill")


@pytest.mark.parametrize("machine", [None, "sinumerik-modulo", "sinumerik-linear", *MILLS])
def test_demo_program_proves_without_errors_on_its_machine(machine: str | None) -> None:
    """A mill's desk began with a lathe's part, which it refuses."""
    source = load_source(Path(find_demo_program(machine)))
    found = read_machine(machine)
    report = prove(source, create_power_up_setup(found, tool_offsets={}, secondary_offsets={}), found)
    assert [each for each in report.diagnostics if each.severity is Severity.ERROR] == []
    assert str(source.dialect) == found.mdi_language


def test_demo_reopens_with_last_program_and_first_job_step(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    open_demo_data_folder(None)
    own = home / "demo" / "mine.nc"
    own.write_text("M30\n")
    journal = Journal.open_default()
    card = FirstJobCard(3)
    card.save_step(journal)
    journal.save_setting(LAST_PROGRAM_SETTING, str(own))
    journal.close()
    monkeypatch.setenv("TURNDESK_HOME", str(home))  # the next start
    open_demo_data_folder(None)
    assert find_demo_program(None) == str(own)
    journal = Journal.open_default()
    assert FirstJobCard.from_store(journal).step_index == 3
    journal.close()
    own.unlink()
    assert Path(find_demo_program(None)).name == "bushing.nc"
