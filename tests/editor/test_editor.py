"""The editor's stages: what each request leads to, and what is refused in which words."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.editor import editor_messages as messages
from app.editor.editor_model import ClosedProgram, EditorModel, EditorStage
from app.editor.version_history import VersionHistory
from tests.editor.shop import GOOD, Memory, editor_in
from tests.texts import text


@pytest.fixture
def memory() -> Memory:
    return Memory()


@pytest.fixture
def left() -> list[ClosedProgram]:
    return []


@pytest.fixture
def editor(tmp_path: Path, memory: Memory, left: list[ClosedProgram]) -> Iterator[EditorModel]:
    editor = editor_in(tmp_path, memory, left.append)
    yield editor
    editor.close()


def settle(editor: EditorModel) -> None:
    editor.worker.wait_for_results(60.0)


def own(editor: EditorModel, name: str, text: str = GOOD) -> Path:
    """A program of the operator, open in the editor."""
    path = editor.programs_folder / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    editor.open_program(path)
    settle(editor)
    return path


def test_unchanged_program_is_not_written_and_gets_no_version(
    editor: EditorModel, left: list[ClosedProgram], memory: Memory
) -> None:
    path = own(editor, "part.nc")
    editor.save_and_leave(editor.text)
    assert (editor.stage, left, memory.kept) == (
        EditorStage.CLOSED,
        [ClosedProgram(path, False, False, GOOD)],
        {},
    )


def test_leaving_saves_the_program_and_both_versions(
    editor: EditorModel, left: list[ClosedProgram], memory: Memory
) -> None:
    path = own(editor, "part.nc")
    editor.save_and_leave(GOOD + "(END)\n")
    settle(editor)
    assert left == [ClosedProgram(path, True, False, GOOD + "(END)\n")]
    assert path.read_text() == GOOD + "(END)\n"
    assert len(memory.kept["part.nc"]) == 2


def test_failed_save_leaves_the_text_and_the_editor_open(
    editor: EditorModel, left: list[ClosedProgram]
) -> None:
    path = own(editor, "part.nc")
    editor.save_and_leave("X1\0\n")
    settle(editor)
    assert editor.stage is EditorStage.OPEN
    assert left == []
    assert text("editor.zero-bytes", file="part.nc").split(":")[0] in editor.message
    assert path.read_text() == GOOD


def test_missing_file_is_reported(editor: EditorModel, tmp_path: Path) -> None:
    editor.open_program(tmp_path / "gone.nc")
    settle(editor)
    assert editor.stage is EditorStage.CLOSED
    assert "cannot be read" in editor.message


def test_file_changed_on_disk_is_replaced_only_after_confirmation(editor: EditorModel) -> None:
    path = own(editor, "part.nc")
    path.write_text("M02\n")
    for _ in range(3):
        editor.save_document("M30\n")
        settle(editor)
    assert path.read_text() == "M02\n"
    editor.confirm_question("M30\n")
    settle(editor)
    assert path.read_text() == "M30\n"


def test_first_save_of_a_file_changed_on_disk_reports_the_change(editor: EditorModel) -> None:
    path = own(editor, "part.nc")
    path.write_text("M02\n")
    editor.save_and_leave("M30\n")
    settle(editor)
    assert editor.message == messages.CHANGED_ON_DISK.format("part.nc")
    assert (editor.stage, path.read_text()) == (EditorStage.OPEN, "M02\n")


def test_new_file_is_not_saved_under_an_existing_name(editor: EditorModel) -> None:
    own(editor, "part.nc")
    editor.discard_and_leave(editor.text)
    editor.offer_new_document("part")
    editor.create_document()
    assert editor.message == messages.NAME_EXISTS.format("part.nc")
    assert editor.stage is EditorStage.OFFERED


def test_a_sample_is_saved_under_a_free_name_only(editor: EditorModel, left: list[ClosedProgram]) -> None:
    own(editor, "mine.nc", "M02\n")
    editor.discard_and_leave(editor.text)
    sample = editor.samples_folder / "knob.nc"
    sample.write_text(GOOD)
    editor.open_program(sample)
    settle(editor)
    editor.save_and_leave(GOOD + "(X)\n")
    assert editor.stage is EditorStage.NAMING
    assert not editor.save_under_name("mine")
    assert not editor.save_under_name("a/b")
    assert editor.save_under_name("other")
    settle(editor)
    assert left == [ClosedProgram(editor.programs_folder / "other.nc", True, False, GOOD + "(X)\n")]
    assert sample.read_text() == GOOD


def test_sample_of_another_language_retains_its_extension(editor: EditorModel) -> None:
    sample = editor.samples_folder / "plate.h"
    sample.write_text("BEGIN PGM PLATE MM\nEND PGM PLATE MM\n")
    editor.open_program(sample)
    settle(editor)
    editor.save_and_leave(editor.text + "; X\n")
    assert editor.save_under_name("mine")
    settle(editor)
    assert (editor.programs_folder / "mine.h").exists()


def test_new_program_has_the_extension_of_the_machine_language(editor: EditorModel) -> None:
    editor.default_extension = ".h"
    editor.offer_new_document("roof")
    editor.create_document()
    assert editor.document is not None
    assert editor.document.name == "roof.h"


def test_version_that_cannot_be_saved_is_reported_after_leaving(editor: EditorModel, memory: Memory) -> None:
    own(editor, "part.nc")
    memory.full = True
    editor.save_and_leave("M30\n")
    settle(editor)
    assert editor.stage is EditorStage.CLOSED
    assert editor.message == messages.VERSION_NOT_SAVED.format("the disk is full")


def test_history_compares_with_the_text_in_the_editor(editor: EditorModel, memory: Memory) -> None:
    memory.kept["part.nc"] = [(b"X1\r\nM30\r\n", "first"), (b"X2\nM30\n", "second")]
    history = VersionHistory(memory, editor.worker)
    history.open_history("part.nc", "X2\nM30\n")
    settle(editor)
    assert (history.number, history.words()) == (2, text("editor.same"))
    history.mark(99)
    settle(editor)
    assert (history.number, history.text) == (1, "X1\nM30\n")
    assert [row.sign for row in history.changes] == ["-", "+", " "]


def test_program_without_history_is_reported(editor: EditorModel, memory: Memory) -> None:
    history = VersionHistory(memory, editor.worker)
    history.open_history("part.nc", "")
    settle(editor)
    assert history.words() == text("editor.no-version")
    history.mark(1)
    assert history.number == 0
