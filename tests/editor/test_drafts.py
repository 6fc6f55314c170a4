"""What is typed survives a control that ends without a word; what was left in good order leaves nothing."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.editor.editor_model import EditorModel, EditorStage
from tests.editor.shop import GOOD, Memory, editor_in
from tests.texts import pattern, text

TYPED = GOOD.replace("Z-.5", "Z-.75")
LIMIT = 60.0
Start = Callable[[], EditorModel]


@pytest.fixture
def memory() -> Memory:
    return Memory()


@pytest.fixture
def start(tmp_path: Path, memory: Memory) -> Iterator[Start]:
    """Another control on the same folder."""
    editors: list[EditorModel] = []

    def begin() -> EditorModel:
        editors.append(editor_in(tmp_path, memory))
        return editors[-1]

    yield begin
    for editor in editors:
        editor.close()


def settle(editor: EditorModel) -> None:
    for _ in range(3):
        editor.worker.wait_for_results(LIMIT)
        editor.draft_store.worker.wait_for_results(LIMIT)
    editor.poll()


def program(editor: EditorModel, text: str = GOOD) -> Path:
    path = editor.programs_folder / "part.nc"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def type_in(editor: EditorModel, path: Path, *texts: str) -> None:
    editor.open_program(path)
    settle(editor)
    for typed in texts:
        editor.update_text(typed)
    settle(editor)


def drafts(editor: EditorModel) -> list[str]:
    folder = editor.draft_store.folder
    return sorted(each.name for each in folder.iterdir()) if folder.is_dir() else []


def test_text_typed_before_a_crash_is_in_the_history(start: Start, memory: Memory) -> None:
    dead = start()
    path = program(dead)
    type_in(dead, path, "G90\n", TYPED)
    after = start()  # nobody has closed the first
    after.open_program(path)
    settle(after)
    assert after.text == GOOD  # the file is what it was
    assert text("editor.in-history") in after.message
    assert memory.kept["part.nc"] == [(TYPED.encode(), "unsaved draft")]
    assert drafts(after) == []


def test_text_of_an_unsaved_new_file_is_recovered(start: Start, memory: Memory) -> None:
    dead = start()
    dead.offer_new_document("new.nc")
    dead.create_document()
    settle(dead)
    dead.update_text(TYPED)
    settle(dead)
    after = start()
    after.offer_new_document("new.nc")
    after.create_document()
    settle(after)
    assert after.stage is EditorStage.OPEN
    assert memory.kept["new.nc"][0][0] == TYPED.encode()


def test_saving_removes_the_draft(start: Start) -> None:
    editor = start()
    type_in(editor, program(editor), TYPED)
    assert drafts(editor) == ["part.nc.draft"]
    editor.save_document(TYPED)
    settle(editor)
    assert drafts(editor) == []


def test_discarding_changes_removes_the_draft(start: Start) -> None:
    editor = start()
    type_in(editor, program(editor), TYPED)
    editor.discard_and_leave(TYPED)
    editor.confirm_question(TYPED)
    settle(editor)
    assert editor.stage is EditorStage.CLOSED
    assert drafts(editor) == []


def test_undoing_all_changes_removes_the_draft(start: Start) -> None:
    editor = start()
    type_in(editor, program(editor), TYPED, GOOD)
    assert drafts(editor) == []


def test_closing_turndesk_with_unsaved_text_retains_the_draft(start: Start) -> None:
    editor = start()
    path = program(editor)
    editor.open_program(path)
    settle(editor)
    editor.update_text(TYPED)
    editor.close()
    assert (editor.draft_store.folder / "part.nc.draft").read_text() == TYPED


def test_draft_that_cannot_be_saved_in_history_stays_in_a_reported_file(start: Start, memory: Memory) -> None:
    dead = start()
    path = program(dead)
    type_in(dead, path, TYPED)
    memory.full = True
    after = start()
    after.open_program(path)
    settle(after)
    after.update_text(GOOD)
    settle(after)
    assert "part.nc.left: the disk is full" in after.message
    assert (after.draft_store.folder / "part.nc.left").read_text() == TYPED


def test_damaged_draft_is_set_aside_and_reported(start: Start) -> None:
    editor = start()
    path = program(editor)
    editor.draft_store.folder.mkdir()
    (editor.draft_store.folder / "part.nc.draft").write_bytes(b"G90\xff\n")
    type_in(editor, path, GOOD)
    assert "part.nc.left" in editor.message
    assert (editor.draft_store.folder / "part.nc.left").read_bytes() == b"G90\xff\n"


def test_unwritable_draft_folder_is_reported_and_editing_continues(start: Start) -> None:
    editor = start()
    path = program(editor)
    editor.draft_store.folder.write_text("a file where the folder should be")
    type_in(editor, path, TYPED)
    assert re.search(pattern("editor.safe-when-saved"), editor.message)
    assert editor.stage is EditorStage.OPEN
