"""Copies that are whole, or are not; folders that cannot be read; names that will not do."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from app.desk.persistence import Persistence
from app.programs import import_export
from app.programs.atomic_files import FileOperationError
from app.programs.import_export import TransferResult, export_programs, import_programs
from app.programs.program_commands import add_missing_extension, delete_program, rename_program
from app.programs.removable_media import PARENT_NAME, FolderChooser, UsbStick
from tests.programs_page.test_run_history import Kept
from tests.texts import pattern


class Keeping(Kept):
    """Versions are kept."""

    def save_version(self, name: str, text: bytes, reason: str) -> int:
        self.told.append((name, text, reason))
        return 1


def made(folder: Path, **texts: str) -> list[Path]:
    folder.mkdir(exist_ok=True)
    paths = []
    for name, text in texts.items():
        paths.append(folder / f"{name}.nc")
        paths[-1].write_text(text)
    return paths


def test_nothing_is_copied_when_one_program_differs_at_destination(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n", b="M02\n")
    own = tmp_path / "own"
    made(own, b="M00\n")
    carried = import_programs(sources, own, Keeping(), lambda _path: "", may_overwrite=False)
    assert carried == TransferResult(conflicting_names=("b.nc",))
    assert not (own / "a.nc").exists()


def test_identical_program_at_destination_is_accepted(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n")
    own = tmp_path / "own"
    made(own, a="M30\n")
    keep = Keeping()
    assert import_programs(sources, own, keep, lambda _path: "", may_overwrite=False).copied_names == (
        "a.nc",
    )
    assert keep.told == []


def test_programs_are_not_replaced_without_version_storage(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n")
    own = tmp_path / "own"
    made(own, a="M00\n")
    with pytest.raises(FileOperationError, match=pattern("programs.not-replaced")):
        import_programs(sources, own, Persistence(), lambda _path: "", may_overwrite=True)
    assert (own / "a.nc").read_text() == "M00\n"


def test_one_invalid_file_prevents_whole_import(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n")
    bad = tmp_path / "stick" / "b.nc"
    bad.write_bytes(b"\x00\x01" * 40)
    with pytest.raises(FileOperationError, match=pattern("programs.no-program", name="b.nc")):
        import_programs([*sources, bad], tmp_path / "own", Keeping(), lambda _path: "", may_overwrite=False)
    assert not (tmp_path / "own").exists()


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_export, "MAX_FILE_BYTES", 3)
    sources = made(tmp_path / "stick", a="M30\n")
    with pytest.raises(FileOperationError, match=pattern("programs.too-large")):
        export_programs(sources, tmp_path, may_overwrite=False)


def test_copy_that_cannot_be_verified_is_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sources = made(tmp_path / "own", a="M30\n")
    stick = tmp_path / "stick"
    stick.mkdir()
    real = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: b"" if ".unfinished" in str(path) else real(path))
    with pytest.raises(FileOperationError, match=pattern("programs.bad-stick")):
        export_programs(sources, stick, may_overwrite=False)
    assert list(stick.iterdir()) == []


def test_a_full_stick_leaves_no_half_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sources = made(tmp_path / "own", a="M30\n")
    stick = tmp_path / "stick"
    stick.mkdir()

    def full(_handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(
        FileOperationError,
        match=pattern("programs.some-copied", done=0, of=1) + ": " + pattern("programs.full", place="stick"),
    ):
        export_programs(sources, stick, may_overwrite=False)
    assert list(stick.iterdir()) == []


@pytest.mark.parametrize(
    ("typed", "name"),
    [("part", "part.nc"), (" part ", "part.nc"), ("part.TXT", "part.TXT"), ("3.5", "3.5.nc")],
)
def test_missing_extension_is_added_to_name(typed: str, name: str) -> None:
    assert add_missing_extension(typed, Path("like.nc")) == name


@pytest.mark.parametrize("typed", ["", "  ", "a/b", "..", ".hidden", "a:b", "aux", "x" * 300])
def test_invalid_name_is_rejected(typed: str) -> None:
    with pytest.raises(FileOperationError):
        add_missing_extension(typed, Path("like.nc"))


def test_rename_that_changes_only_case_is_rejected(tmp_path: Path) -> None:
    (path,) = made(tmp_path / "own", a="M30\n")
    assert rename_program(path, "A", Persistence()) == "A.nc"
    with pytest.raises(FileOperationError, match=pattern("programs.same-name")):
        rename_program(path.with_name("A.nc"), "A.nc", Persistence())


def test_program_that_cannot_be_archived_is_not_deleted(tmp_path: Path) -> None:
    (path,) = made(tmp_path / "own", a="M30\n")
    with pytest.raises(FileOperationError, match=pattern("programs.not-deleted")):
        delete_program(path, Persistence())
    assert path.exists()


def test_folder_chooser_enters_folders_and_returns_to_places(tmp_path: Path) -> None:
    (tmp_path / "stick").mkdir()
    made(tmp_path / "stick" / "jobs", a="M30\n")
    (tmp_path / "stick" / "jobs" / ".hidden.nc").write_text("")
    (tmp_path / "stick" / "jobs" / "photo.jpg").write_text("")
    chooser = FolderChooser(tmp_path, lambda: (UsbStick("STICK", tmp_path / "stick", 5),))
    chooser.show_entries(chooser.list_entries())
    assert [line.name for line in chooser.listed_entries] == ["STICK", "THIS CONTROL"]
    for name in ("STICK", "jobs"):
        chooser.open_entry(next(line for line in chooser.listed_entries if line.name == name))
        chooser.show_entries(chooser.list_entries())
    assert [line.name for line in chooser.listed_entries] == [PARENT_NAME, "a.nc"]
    assert [path.name for path in chooser.program_paths] == ["a.nc"]
    for _ in range(2):
        chooser.open_entry(chooser.listed_entries[0])
        chooser.show_entries(chooser.list_entries())
    assert chooser.current_folder is None
