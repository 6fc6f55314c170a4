"""The editor's stages: what each request leads to, and what is refused in which words."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.editor import editor_messages as messages
from app.editor.editor import Editor, LeftProgram, Stage
from app.editor.versions import VersionHistory
from tests.editor.shop import GOOD, Memory, editor_in
from tests.texts import text


@pytest.fixture
def memory() -> Memory:
    return Memory()


@pytest.fixture
def left() -> list[LeftProgram]:
    return []


@pytest.fixture
def editor(tmp_path: Path, memory: Memory, left: list[LeftProgram]) -> Iterator[Editor]:
    editor = editor_in(tmp_path, memory, left.append)
    yield editor
    editor.close()


def settle(editor: Editor) -> None:
    editor.worker.settle(60.0)


def own(editor: Editor, name: str, text: str = GOOD) -> Path:
    """A program of the operator, open in the editor."""
    path = editor.programs / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    editor.open(path)
    settle(editor)
    return path


def test_an_unchanged_program_is_left_unchanged_and_without_a_version(
    editor: Editor, left: list[LeftProgram], memory: Memory
) -> None:
    path = own(editor, "part.nc")
    editor.leave(editor.text)
    assert (editor.stage, left, memory.kept) == (Stage.CLOSED, [LeftProgram(path, False, False, GOOD)], {})


def test_leaving_saves_and_keeps_the_old_and_the_new(
    editor: Editor, left: list[LeftProgram], memory: Memory
) -> None:
    path = own(editor, "part.nc")
    editor.leave(GOOD + "(END)\n")
    settle(editor)
    assert left == [LeftProgram(path, True, False, GOOD + "(END)\n")]
    assert path.read_text() == GOOD + "(END)\n"
    assert len(memory.kept["part.nc"]) == 2


def test_a_saving_that_fails_keeps_the_text_and_the_page(editor: Editor, left: list[LeftProgram]) -> None:
    path = own(editor, "part.nc")
    editor.leave("X1\0\n")
    settle(editor)
    assert editor.stage is Stage.OPEN
    assert left == []
    assert text("editor.zero-bytes", file="part.nc").split(":")[0] in editor.notice
    assert path.read_text() == GOOD


def test_a_file_that_is_gone_is_told(editor: Editor, tmp_path: Path) -> None:
    editor.open(tmp_path / "gone.nc")
    settle(editor)
    assert editor.stage is Stage.CLOSED
    assert "cannot be read" in editor.notice


def test_a_change_from_outside_is_replaced_only_by_the_answer(editor: Editor) -> None:
    path = own(editor, "part.nc")
    path.write_text("M02\n")
    for _ in range(3):
        editor.save("M30\n")
        settle(editor)
    assert path.read_text() == "M02\n"
    editor.answer("M30\n")
    settle(editor)
    assert path.read_text() == "M30\n"


def test_the_first_asking_says_what_happened(editor: Editor) -> None:
    path = own(editor, "part.nc")
    path.write_text("M02\n")
    editor.leave("M30\n")
    settle(editor)
    assert editor.notice == messages.CHANGED_OUTSIDE.format("part.nc")
    assert (editor.stage, path.read_text()) == (Stage.OPEN, "M02\n")


def test_a_new_file_does_not_take_a_name_that_is_there(editor: Editor) -> None:
    own(editor, "part.nc")
    editor.abandon(editor.text)
    editor.offer("part")
    editor.create()
    assert editor.notice == messages.THERE_ALREADY.format("part.nc")
    assert editor.stage is Stage.OFFERED


def test_a_sample_is_saved_under_a_free_name_only(editor: Editor, left: list[LeftProgram]) -> None:
    own(editor, "mine.nc", "M02\n")
    editor.abandon(editor.text)
    sample = editor.samples / "knob.nc"
    sample.write_text(GOOD)
    editor.open(sample)
    settle(editor)
    editor.leave(GOOD + "(X)\n")
    assert editor.stage is Stage.NAMING
    assert not editor.take_name("mine")
    assert not editor.take_name("a/b")
    assert editor.take_name("other")
    settle(editor)
    assert left == [LeftProgram(editor.programs / "other.nc", True, False, GOOD + "(X)\n")]
    assert sample.read_text() == GOOD


def test_a_sample_of_another_language_keeps_its_ending(editor: Editor) -> None:
    sample = editor.samples / "plate.h"
    sample.write_text("BEGIN PGM PLATE MM\nEND PGM PLATE MM\n")
    editor.open(sample)
    settle(editor)
    editor.leave(editor.text + "; X\n")
    assert editor.take_name("mine")
    settle(editor)
    assert (editor.programs / "mine.h").exists()


def test_a_new_program_has_the_ending_of_the_language_of_the_machine(editor: Editor) -> None:
    editor.usual_ending = ".h"
    editor.offer("roof")
    editor.create()
    assert editor.document is not None
    assert editor.document.name == "roof.h"


def test_a_version_that_cannot_be_kept_is_told_after_leaving(editor: Editor, memory: Memory) -> None:
    own(editor, "part.nc")
    memory.full = True
    editor.leave("M30\n")
    settle(editor)
    assert editor.stage is Stage.CLOSED
    assert editor.notice == messages.NOT_KEPT.format("the disk is full")


def test_history_compares_with_the_text_in_the_editor(editor: Editor, memory: Memory) -> None:
    memory.kept["part.nc"] = [(b"X1\r\nM30\r\n", "first"), (b"X2\nM30\n", "second")]
    history = VersionHistory(memory, editor.worker)
    history.look("part.nc", "X2\nM30\n")
    settle(editor)
    assert (history.number, history.words()) == (2, text("editor.same"))
    history.mark(99)
    settle(editor)
    assert (history.number, history.text) == (1, "X1\nM30\n")
    assert [row.sign for row in history.changes] == ["-", "+", " "]


def test_no_history_is_said(editor: Editor, memory: Memory) -> None:
    history = VersionHistory(memory, editor.worker)
    history.look("part.nc", "")
    settle(editor)
    assert history.words() == text("editor.no-version")
    history.mark(1)
    assert history.number == 0
