"""CONVERT PROGRAM in F10: recognition of the loaded program, settings, preview and the new file."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from app.desk.desk import Desk
from app.extras.convert.convert_function import ConvertFunction
from app.extras.convert.screen_conversion import ProgramControl, list_targets
from app.special.special_view import SpecialFunctionsPage
from core.extras.convert.source_options import SourceControl
from core.language.diagnostics import Severity
from core.language.source import Dialect
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key
from tests.texts import shows

PART = "%\nO1\nG99\nT0101\nG97S500M03\nG00X1000Z100\nG01Z-1.F.01\nM77\nM30\n%\n"

CORRECT_PART = PART.replace("M77\n", "").replace("X1000Z100", "X1.Z.1").replace("G99", "G20G99")


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
    assert rows(hands, function)[1] == ("TARGET", "OMNITURN")
    set_row(hands, function, 2, "INCH")
    set_row(hands, function, 3, "1 mm OR .1 in")
    hands.sees(lambda: any("M77" in row[1] for row in rows(hands, function)[7:]))
    hands.key(Key.Key_F6)
    assert not (folder / "OLD-omniturn.nc").exists()
    set_row(hands, function, 6, "M77")
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    assert ("L6", "G00X.1Z.01(L6)") in rows(hands, function)
    hands.key(Key.Key_F6)
    hands.sees(lambda: shows(hands.prompt(), "convert.saved-not-loaded", name="OLD-omniturn.nc"))
    assert (folder / "OLD.NC").read_text() == PART
    assert hands.desk.program_loader.loaded_program.name == "OLD.NC"  # the new file is not loaded
    load(hands, folder / "OLD-omniturn.nc")
    found = hands.desk.program_loader.loaded_program.diagnostics
    assert not [each for each in found if each.severity is Severity.ERROR]


def test_a_fanuc_program_is_converted_to_sinumerik(hands: Hands, folder: Path) -> None:
    (folder / "OLD.NC").write_text(CORRECT_PART)
    load(hands, folder / "OLD.NC")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    set_row(hands, function, 1, "SINUMERIK")
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    hands.key(Key.Key_F6)
    hands.sees(lambda: shows(hands.prompt(), "convert.saved-for-export", name="OLD-sinumerik.mpf"))
    text = (folder / "OLD-sinumerik.mpf").read_text()
    assert "G700" in text  # inches
    assert "T1 D1" in text  # the tool with offset 1
    assert not (folder / "OLD-omniturn.nc").exists()


@pytest.mark.parametrize(
    ("target", "name", "line"),
    [
        # 1 in on the diameter; LinuxCNC starts the offset with G43, Fanuc has T with the offset number
        ("LINUXCNC", "own-linuxcnc.ngc", "T1 M6 G43"),
        ("FANUC", "own-fanuc.nc", "T0101"),
    ],
)
def test_an_omniturn_program_is_converted_for_another_lathe(
    hands: Hands, folder: Path, target: str, name: str, line: str
) -> None:
    load(hands, folder / "own.nc")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    assert rows(hands, function)[:5] == [
        ("CONTROL", "OMNITURN"),
        ("TARGET", "LINUXCNC"),
        ("UNIT WITHOUT G20 OR G21", "NOT USED"),
        ("X1000 WITHOUT A POINT IS", "NOT USED"),
        ("X IS", "NOT USED"),
    ]
    set_row(hands, function, 1, target)
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    hands.key(Key.Key_F6)
    hands.sees(lambda: shows(hands.prompt(), "convert.saved-for-export", name=name))
    assert any(row.startswith(line) for row in (folder / name).read_text().splitlines())
    assert hands.desk.program_loader.loaded_program.name == "own.nc"
    assert [each.name for each in hands.desk.program_choice.program_folders.find_matching_programs(name)]


def test_settings_of_other_controls_are_rejected_for_an_omniturn_program(hands: Hands, folder: Path) -> None:
    load(hands, folder / "own.nc")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    before = function.settings
    for row in (2, 3, 4):
        function.marked = row
        hands.key(Key.Key_Return)
        assert shows(hands.prompt(), "convert.no-effect")
    assert function.settings == before


def test_an_omniturn_program_with_an_input_is_not_converted(hands: Hands, folder: Path) -> None:
    (folder / "own.nc").write_text("G90G94F300G70G72\nT1\nG00X1Z.1\nM91P4\nM30\n}4\nM99\n")
    load(hands, folder / "own.nc")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.not-converted"))
    hands.key(Key.Key_F6)
    assert shows(hands.prompt(), "convert.program-not-converted")
    assert not list(folder.glob("own-*"))


def test_a_target_that_the_control_does_not_have_is_not_used(hands: Hands, folder: Path) -> None:
    """FANUC is a target of OmniTurn programs only, so the default applies to the program of a Fanuc."""
    load(hands, folder / "own.nc")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    set_row(hands, function, 1, "FANUC")
    function.marked = 0
    set_row(hands, function, 0, "FANUC-A")
    hands.sees(lambda: shows(note(hands, function), "convert.not-converted"))
    assert rows(hands, function)[1] == ("TARGET", "OMNITURN")


def test_settings_do_not_apply_to_another_program(hands: Hands, folder: Path) -> None:
    load(hands, folder / "OLD.NC")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.not-converted"))
    set_row(hands, function, 0, "FANUC-B")
    set_row(hands, function, 1, "SINUMERIK")
    set_row(hands, function, 2, "INCH")
    set_row(hands, function, 3, "1 mm OR .1 in")
    (folder / "OLD.NC").write_text(PART.replace("M77", "M78"))
    load(hands, folder / "OLD.NC")  # the same program after a correction
    assert rows(hands, function)[:4] == [
        ("CONTROL", "FANUC-B"),
        ("TARGET", "SINUMERIK"),
        ("UNIT WITHOUT G20 OR G21", "INCH"),
        ("X1000 WITHOUT A POINT IS", "1 mm OR .1 in"),
    ]
    (folder / "OTHER.NC").write_text(PART)
    load(hands, folder / "OTHER.NC")
    hands.sees(lambda: shows(note(hands, function), "convert.not-converted"))
    assert rows(hands, function)[1:4] == [
        ("TARGET", "OMNITURN"),
        ("UNIT WITHOUT G20 OR G21", "NOT SPECIFIED"),
        ("X1000 WITHOUT A POINT IS", "NOT SPECIFIED"),
    ]
    assert function.control is None


def test_a_level_that_may_not_save_programs_gets_no_file(
    hands: Hands, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    load(hands, folder / "own.nc")
    function = open_function(hands)
    hands.sees(lambda: shows(note(hands, function), "convert.proved"))
    monkeypatch.setattr(Desk, "is_refused", lambda _self, _change: True)
    hands.key(Key.Key_F6)
    assert not list(folder.glob("own-*"))


@pytest.mark.parametrize(
    ("control", "language", "targets"),
    [
        (SourceControl.HAAS, "omniturn", ["omniturn", "sinumerik"]),
        (SourceControl.HAAS, "sinumerik", ["sinumerik", "omniturn"]),
        (Dialect.OMNITURN, "omniturn", ["linuxcnc", "fanuc", "sinumerik"]),
        (Dialect.OMNITURN, "sinumerik", ["sinumerik", "linuxcnc", "fanuc"]),
    ],
)
def test_the_language_of_the_machine_is_the_default(
    control: ProgramControl, language: str, targets: list[str]
) -> None:
    assert list_targets(control, language) == tuple(targets)


def test_an_existing_file_is_not_overwritten(hands: Hands, folder: Path) -> None:
    (folder / "OLD.NC").write_text(CORRECT_PART)
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
    hands.sees(lambda: any(word in row[1] for row in rows(hands, function)[7:]))
    for _ in range(6):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert rows(hands, function)[6][1] == shown


def test_an_omniturn_program_is_not_announced(hands: Hands, folder: Path) -> None:
    load(hands, folder / "own.nc")
    hands.sees(lambda: bool(hands.prompt()))
    assert not shows(hands.prompt(), "convert.another-control")


def test_without_a_program_there_is_nothing_to_convert(hands: Hands) -> None:
    function = open_function(hands)
    assert shows(note(hands, function), "convert.choose-first")
    hands.key(Key.Key_Return)
    assert rows(hands, function) == []
