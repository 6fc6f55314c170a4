"""Programs of other controls in the list of programs and in the editor."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.desk.desk import Desk
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFolders
from app.extras.convert.convert_function import ConvertFunction, recognize_control_name
from app.programs.program_list_model import ProgramListModel, make_program_details, make_program_table
from app.programs.program_rows import list_programs
from app.screen import page_table
from app.special.special_functions import SpecialFunctionsModel
from tests.screen.desks import desk_on
from tests.screen.editor.writer import Writer
from tests.screen.fake import FakeMachine
from tests.screen.hands import Key, window_on
from tests.texts import shows
from tests.texts import text as wording

FANUC = "%\nO1\nG20G99\nT0101\nG97S500M03\nG00X1.Z.1\nG01Z-1.F.01\nM30\n%\n"
OMNITURN = "G90G94F300G70G72\nT1\nG00X1Z.1\nM30\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "OLD.NC").write_text(FANUC)
    (tmp_path / "own.nc").write_text(OMNITURN)
    return tmp_path


@pytest.fixture
def writer(qtbot: QtBot, machine: FakeMachine, folder: Path) -> Iterator[Writer]:
    desk = desk_on(machine, folder)
    with window_on(qtbot, desk, machine) as window:
        yield Writer(qtbot, window, desk, machine)


def controls(folder: Path) -> dict[str, str]:
    """Return the recognized control of each listed file."""
    found = list_programs(ProgramFolders((folder,)), folder, Persistence(), recognize_control_name)
    return {each.name: each.control_name for each in found}


# --- the list of programs ---------------------------------------------------------------------------------


def test_the_list_shows_the_control_of_a_program(writer: Writer) -> None:
    assert writer.frame.open_page(page_table.PROGRAMS)
    model = writer.desk.page_registry.find_model(ProgramListModel)
    assert model is not None
    writer.sees(lambda: len(model.listed_programs) == 2)
    table = make_program_table(model)
    assert table.column_heads[:2] == ("NAME", "CONTROL")
    assert [row.cells[:2] for row in table.rows] == [("OLD.NC", "FANUC-A"), ("own.nc", "")]
    assert dict(make_program_details(model.listed_programs[0]))["TYPE"] == "FANUC-A PROGRAM"
    writer.type("own")
    assert make_program_table(model).column_heads[:2] == ("NAME", "CHANGED")


def test_enter_on_a_recognized_program_proposes_the_conversion(writer: Writer) -> None:
    assert writer.frame.open_page(page_table.PROGRAMS)
    writer.sees(lambda: len(_listed(writer)) == 2)
    writer.key(Key.Key_Home)
    writer.key(Key.Key_Return)
    writer.sees(lambda: shows(writer.prompt(), "convert.another-control"))
    assert writer.front == page_table.AUTOMATIC


def _listed(writer: Writer) -> Sequence[object]:
    model = writer.desk.page_registry.find_model(ProgramListModel)
    return model.listed_programs if model is not None else ()


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("late.nc", (b"(" + b"X" * 8000 + b")\n") * 3 + FANUC.encode()),  # follows the first 16 kB
        ("part.mpf", FANUC.encode()),  # the extension names another language
        ("binary.nc", b"O1\0G50S1000T0101\n"),
        ("empty.nc", b""),
        ("utf16.nc", FANUC.encode("utf-16")),
    ],
)
def test_other_files_are_listed_without_a_control(tmp_path: Path, name: str, data: bytes) -> None:
    (tmp_path / name).write_bytes(data)
    assert controls(tmp_path) == {name: ""}


def test_a_file_is_read_again_only_after_a_change(tmp_path: Path) -> None:
    """The new text has the size of the old one, so only the time of the file shows the change."""
    file, spaces = tmp_path / "OLD.NC", " " * (len(FANUC) - len(OMNITURN))
    file.write_text(FANUC)
    before = file.stat()
    assert controls(tmp_path) == {"OLD.NC": "FANUC-A"}
    file.write_text(OMNITURN + spaces)
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert controls(tmp_path) == {"OLD.NC": "FANUC-A"}
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns + 1_000_000_000))
    assert controls(tmp_path) == {"OLD.NC": ""}


def test_without_the_feature_no_file_is_recognized(folder: Path) -> None:
    found = list_programs(ProgramFolders((folder,)), folder, Persistence())
    assert {each.control_name for each in found} == {""}


# --- the editor -------------------------------------------------------------------------------------------


def open_in_editor(writer: Writer, name: str) -> None:
    writer.desk.program_choice.load_path(folder_of(writer) / name)
    writer.sees(lambda: not writer.desk.program_loader.loaded_program.is_busy)
    writer.sees(lambda: name != "OLD.NC" or shows(writer.prompt(), "convert.another-control"))
    writer.key(Key.Key_F3)
    writer.sees(lambda: writer.front == page_table.EDITOR and bool(writer.text()))
    writer.sees(writer.proved)


def folder_of(writer: Writer) -> Path:
    return writer.desk.program_choice.program_folders.folders[0]


def shown_function(desk: Desk) -> object:
    model = desk.page_registry.find_model(SpecialFunctionsModel)
    return model.shown_function if model is not None else None


def paste(writer: Writer, text: str) -> None:
    clipboard = QApplication.clipboard()
    clipboard.setText(text)
    writer.editor.text_field.selectAll()
    writer.editor.text_field.paste()
    writer.sees(writer.proved)


def test_an_opened_program_is_converted_with_f6(writer: Writer, folder: Path) -> None:
    open_in_editor(writer, "OLD.NC")
    writer.sees(lambda: shows(writer.prompt(), "convert.edited-program", control="FANUC"))
    assert writer.editor.make_key_labels()[5] == "CONVERT"
    writer.key(Key.Key_F6)
    writer.sees(lambda: writer.front == page_table.SPECIAL)
    function = shown_function(writer.desk)
    assert isinstance(function, ConvertFunction)
    assert function.program is not None
    assert function.program[0].text == FANUC
    writer.sees(lambda: bool(function.make_function_keys()["F6"].barred) is False)
    assert (folder / "OLD.NC").read_text() == FANUC


def test_a_pasted_program_is_saved_and_converted_but_not_loaded(writer: Writer, folder: Path) -> None:
    open_in_editor(writer, "own.nc")
    assert writer.editor.make_key_labels()[5] == "NEXT ERROR"
    paste(writer, FANUC)
    writer.sees(lambda: shows(writer.prompt(), "convert.edited-program", control="FANUC"))
    before = writer.desk.program_loader.loaded_program.source
    writer.key(Key.Key_F6)
    writer.sees(lambda: writer.front == page_table.SPECIAL)
    assert (folder / "own.nc").read_text() == FANUC
    function = shown_function(writer.desk)
    assert isinstance(function, ConvertFunction)
    assert function.program is not None
    assert function.program[0].text == FANUC
    assert writer.desk.program_loader.loaded_program.source is before  # the saved text is not loaded
    assert writer.frame.open_page(page_table.AUTOMATIC)  # closing the page returns to the loaded program
    assert function.program[0].text == OMNITURN


def test_esc_dismisses_the_notice_until_the_next_such_text(writer: Writer) -> None:
    open_in_editor(writer, "OLD.NC")
    writer.sees(lambda: writer.editor.make_key_labels()[5] == "CONVERT")
    writer.key(Key.Key_Escape)
    assert writer.front == page_table.EDITOR
    assert writer.editor.make_key_labels()[5] == "NEXT ERROR"
    writer.type("G")  # still the same program
    writer.sees(writer.proved)
    assert writer.editor.make_key_labels()[5] == "NEXT ERROR"
    paste(writer, OMNITURN)
    paste(writer, FANUC)
    writer.sees(lambda: writer.editor.make_key_labels()[5] == "CONVERT")


def test_an_omniturn_program_with_an_error_is_not_proposed(writer: Writer) -> None:
    open_in_editor(writer, "own.nc")
    paste(writer, OMNITURN.replace("Z.1", "Z.1.1"))
    assert writer.editor.finding_list.findings.error_count
    assert not shows(writer.prompt(), "convert.edited-program")
    assert writer.editor.make_key_labels()[5] == "NEXT ERROR"


def test_a_discarded_text_is_not_converted(writer: Writer, folder: Path) -> None:
    open_in_editor(writer, "own.nc")
    paste(writer, FANUC)
    writer.sees(lambda: writer.editor.make_key_labels()[5] == "CONVERT")
    writer.key(Key.Key_F10)
    writer.key(Key.Key_F6)  # confirms that the changes are discarded
    writer.sees(lambda: writer.front == page_table.AUTOMATIC)
    assert (folder / "own.nc").read_text() == OMNITURN
    assert not isinstance(shown_function(writer.desk), ConvertFunction)


def test_a_text_that_may_not_be_saved_is_not_converted(writer: Writer, folder: Path) -> None:
    open_in_editor(writer, "own.nc")
    paste(writer, FANUC)
    writer.sees(lambda: writer.editor.make_key_labels()[5] == "CONVERT")
    writer.editor.editor.find_save_refusal = lambda: wording("convert.program-not-converted")
    writer.key(Key.Key_F6)
    writer.sees(lambda: shows(writer.prompt(), "convert.program-not-converted"))
    assert writer.front == page_table.EDITOR
    assert (folder / "own.nc").read_text() == OMNITURN


def test_without_the_feature_the_editor_has_no_notice(writer: Writer) -> None:
    writer.desk.page_registry.program_conversion = None
    open_in_editor(writer, "OLD.NC")
    assert not shows(writer.prompt(), "convert.edited-program")
    assert writer.editor.make_key_labels()[5] == "NEXT ERROR"
