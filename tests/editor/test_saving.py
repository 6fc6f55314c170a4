"""Saving: the whole file or none of it, every version kept, nothing of anybody else's lost."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from app.editor.edited_document import (
    CHANGED_EXTERNALLY,
    MAX_LINES,
    TextTooLongError,
    create_document,
    open_document,
    save_document,
)
from app.programs.atomic_files import FileOperationError, write_program_file
from core.language.source import SourceError
from tests.coded import raises_code
from tests.editor.shop import GOOD, Memory


@pytest.fixture
def part(tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    path.write_text(GOOD)
    return path


def test_replacing_a_file_preserves_mode_and_leaves_no_temporary_file(part: Path) -> None:
    part.chmod(0o640)
    write_program_file(part, b"M30\n")
    assert part.read_bytes() == b"M30\n"
    assert part.stat().st_mode & 0o777 == 0o640
    assert list(part.parent.iterdir()) == [part]


def test_a_link_stays_a_link(part: Path) -> None:
    link = part.parent / "link.nc"
    link.symlink_to(part)
    write_program_file(link, b"M30\n")
    assert link.is_symlink()
    assert part.read_bytes() == b"M30\n"


@pytest.mark.parametrize("data", [b"X1\0\n", b"  \n", b"X" * 9000 + b"\n", b"X\xff\n"])
def test_text_that_cannot_be_read_back_is_rejected_and_file_is_unchanged(part: Path, data: bytes) -> None:
    with pytest.raises(FileOperationError):
        write_program_file(part, data)
    assert part.read_text() == GOOD
    assert list(part.parent.iterdir()) == [part]


def test_unusable_folder_raises_cannot_write(part: Path) -> None:
    with raises_code(FileOperationError, "cannot-write"):
        write_program_file(part / "below.nc", b"M30\n")


def test_failed_write_leaves_old_file_unchanged(part: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_file: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with raises_code(FileOperationError, "cannot-write", os.strerror(errno.ENOSPC)):
        write_program_file(part, b"M30\n")
    assert part.read_text() == GOOD
    assert list(part.parent.iterdir()) == [part]


def test_dos_line_endings_are_preserved(tmp_path: Path) -> None:
    path = tmp_path / "dos.nc"
    path.write_bytes(b"X1\r\nM30\r\n")
    document = open_document(path, tmp_path / "samples")
    assert document.text == "X1\nM30\n"
    assert save_document(document, "X2\nM30", Memory(), may_overwrite=False) == ""
    assert path.read_bytes() == b"X2\r\nM30\r\n"


@pytest.mark.parametrize(
    "data", [b"(\x94LFL\x8aCHE)\nM30\n\x1a", b"\xef\xbb\xbfX1\n", b"(\xd6L)\nX1", b"X1\rM30\r"]
)
def test_legacy_file_is_archived_before_saving_and_read_again(tmp_path: Path, data: bytes) -> None:
    path, memory = tmp_path / "old.nc", Memory()
    path.write_bytes(data)
    document = open_document(path, tmp_path / "samples")
    assert save_document(document, document.text + "(NEW)", memory, may_overwrite=False) == ""
    assert memory.kept["old.nc"][0][0] == data  # the very bytes that were there
    assert open_document(path, tmp_path / "samples").text.startswith(document.text + "(NEW)")


def test_external_change_is_shown_first_and_archived(part: Path) -> None:
    document, memory = open_document(part, part.parent / "samples"), Memory()
    part.write_text("M02\n")
    assert save_document(document, "M30\n", memory, may_overwrite=False) == CHANGED_EXTERNALLY
    assert part.read_text() == "M02\n"
    assert save_document(document, "M30\n", memory, may_overwrite=True) == ""
    assert [text for text, _why in memory.kept["part.nc"]] == [b"M02\n", b"M30\n"]


def test_external_change_is_not_overwritten_when_archive_is_full(part: Path) -> None:
    document = open_document(part, part.parent / "samples")
    part.write_text("M02\n")
    assert save_document(document, "M30\n", Memory(full=True), may_overwrite=True) == CHANGED_EXTERNALLY
    assert part.read_text() == "M02\n"


def test_full_archive_does_not_prevent_saving(part: Path) -> None:
    document = open_document(part, part.parent / "samples")
    assert save_document(document, "M30\n", Memory(full=True), may_overwrite=False) == "the disk is full"
    assert part.read_text() == "M30\n"


def test_new_document_does_not_overwrite_a_file_created_meanwhile(tmp_path: Path) -> None:
    document = create_document(tmp_path, "part", ".nc")
    (tmp_path / "part.nc").write_text("M02\n")
    assert save_document(document, "M30\n", Memory(), may_overwrite=False) == CHANGED_EXTERNALLY


def test_sample_file_is_read_only_and_empty_file_can_be_opened(tmp_path: Path) -> None:
    (tmp_path / "empty.nc").write_text("")
    assert open_document(tmp_path / "empty.nc", tmp_path).is_read_only
    assert open_document(tmp_path / "empty.nc", tmp_path / "samples").text == ""


def test_binary_file_is_not_opened(tmp_path: Path) -> None:
    (tmp_path / "picture.nc").write_bytes(b"\x89PNG\0\0")
    with raises_code(SourceError, "file-binary"):
        open_document(tmp_path / "picture.nc", tmp_path)


def test_a_text_too_long_for_the_field_is_not_opened(tmp_path: Path) -> None:
    (tmp_path / "long.nc").write_text("X1\n" * MAX_LINES)
    with raises_code(TextTooLongError, "too-long", 2000000):
        open_document(tmp_path / "long.nc", tmp_path)
    (tmp_path / "long.nc").write_text("X1\n" * (MAX_LINES - 1))
    assert open_document(tmp_path / "long.nc", tmp_path).text
