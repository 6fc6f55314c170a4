"""CONVERT PROGRAM in F10: recognition of the loaded program, settings, preview and the new file."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from app.desk.desk import Desk
from app.extras.convert.convert_function import ConvertFunction
from app.special.special_view import SpecialFunctionsPage
from core.language.diagnostics import Severity
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key
from tests.texts import shows

PART = "%\nO1\nG99\nT0101\nG97S500M03\nG00X1000Z100\nG01Z-1.F.01\nM77\nM30\n%\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "OLD.NC").write_text(PART)
    (tmp_path / "own.nc").write_text("G90G94F300G70G72\nT1\nG00X1Z.1\nM30\n")
    return tmp_path


@pytest.fixture
def desk(machine: FakeMachine, journal: Journal, folder: Path) -> Desk:
    return desk_on(machine, folder, keep=journal)


def load(hands: Hands, path: Path) -> None:
    hands.desk.program_choice.load_path(path)
    hands.sees(lambda: not hands.desk.program_loader.loaded_program.is_busy)


def open_function(hands: Hands) -> ConvertFunction:
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    names = [each.name for each in page.model.functions]
    page._enter(names.index("CONVERT PROGRAM"))
    function = page.model.shown_function
    assert isinstance(function, ConvertFunction)
    return function


def rows(hands: Hands, function: ConvertFunction) -> list[tuple[str, ...]]:
    return [each.cells for each in function.make_table(hands.desk.read_snapshot()).rows]


def note(hands: Hands, function: ConvertFunction) -> str:
    return function.make_table(hands.desk.read_snapshot()).notes[0]


def set_row(hands: Hands, function: ConvertFunction, row: int, value: str) -> None:
    """Select a setting, and press Enter until it has this value."""
    while function.marked < row:
        hands.key(Key.Key_Down)
    for _ in range(8):
        if rows(hands, function)[row][1] == value:
            return
        hands.key(Key.Key_Return)
    raise AssertionError(rows(hands, function)[row])


def test_a_program_of_another_control_is_converted_and_saved(hands: Hands, folder: Path) -> None:
    load(hands, folder / "OLD.NC")
    hands.sees(lambda: shows(hands.prompt(), "convert.another-control"))
    assert hands.desk.program_loader.loaded_program.blocking_errors  # it cannot be started
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.not-converted"))
    assert rows(hands, function)[0][1] == "FANUC-A"
    set_row(hands, function, 1, "INCH")
    set_row(hands, function, 2, "1 mm OR .1 in")
    hands.sees(lambda: any("M77" in row[1] for row in rows(hands, function)[6:]))
    hands.key(Key.Key_F6)
    assert not (folder / "OLD-omniturn.nc").exists()
    set_row(hands, function, 5, "M77")
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    assert ("L6", "G00X.1Z.01(L6)") in rows(hands, function)
    hands.key(Key.Key_F6)
    hands.sees(lambda: hands.desk.program_loader.loaded_program.name == "OLD-omniturn.nc")
    assert (folder / "OLD.NC").read_text() == PART
    hands.sees(lambda: not hands.desk.program_loader.loaded_program.is_busy)
    found = hands.desk.program_loader.loaded_program.diagnostics
    assert not [each for each in found if each.severity is Severity.ERROR]


def test_an_existing_file_is_not_overwritten(hands: Hands, folder: Path) -> None:
    (folder / "OLD.NC").write_text(
        PART.replace("M77\n", "").replace("X1000Z100", "X1.Z.1").replace("G99", "G20G99")
    )
    (folder / "OLD-omniturn.nc").write_text("M30\n")
    load(hands, folder / "OLD.NC")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    hands.key(Key.Key_F6)
    hands.sees(lambda: shows(hands.prompt(), "convert.name-in-use"))
    assert (folder / "OLD-omniturn.nc").read_text() == "M30\n"
    assert hands.desk.program_loader.loaded_program.name == "OLD.NC"


@pytest.mark.parametrize(
    ("word", "shown"),
    [("M#101", "M77"), ("M77.", "M77"), ("M[#101-.5]", "NONE"), ("M-77", "NONE"), ("M1234567", "NONE")],
)
def test_only_a_whole_m_code_is_left_out(hands: Hands, folder: Path, word: str, shown: str) -> None:
    part = PART.replace("X1000Z100", "X1.Z.1").replace("G99", "G20G99\n#101=77").replace("M77", word)
    (folder / "OLD.NC").write_text(part)
    load(hands, folder / "OLD.NC")
    function = open_function(hands)
    hands.sees(lambda: any(word in row[1] for row in rows(hands, function)[6:]))
    for _ in range(5):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert rows(hands, function)[5][1] == shown


def test_an_omniturn_program_is_not_announced(hands: Hands, folder: Path) -> None:
    load(hands, folder / "own.nc")
    hands.sees(lambda: bool(hands.prompt()))
    assert not shows(hands.prompt(), "convert.another-control")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.not-recognized"))
    hands.key(Key.Key_F6)
    assert not list(folder.glob("*omniturn*"))


def test_without_a_program_there_is_nothing_to_convert(hands: Hands) -> None:
    function = open_function(hands)
    assert shows(note(hands, function), "convert.choose-first")
    hands.key(Key.Key_Return)
    assert rows(hands, function) == []
