"""Copies that are whole, or are not; folders that cannot be read; names that will not do."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from app.desk.persistence import Persistence
from app.programs import import_export
from app.programs.copy_rename_delete import checked_name, delete_program, rename_program
from app.programs.import_export import Carried, export_programs, import_programs
from app.programs.removable_media import UP, FolderChooser, Stick
from app.programs.whole_file import FileError
from tests.programs_page.test_run_history import Kept
from tests.texts import pattern


class Keeping(Kept):
    """Versions are kept."""

    def save_version(self, name: str, text: bytes, why: str) -> int:
        self.told.append((name, text, why))
        return 1


def made(folder: Path, **texts: str) -> list[Path]:
    folder.mkdir(exist_ok=True)
    paths = []
    for name, text in texts.items():
        paths.append(folder / f"{name}.nc")
        paths[-1].write_text(text)
    return paths


def test_nothing_is_written_while_one_stands_there_with_another_text(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n", b="M02\n")
    own = tmp_path / "own"
    made(own, b="M00\n")
    carried = import_programs(sources, own, Keeping(), lambda _path: "", replace=False)
    assert carried == Carried(differing=("b.nc",))
    assert not (own / "a.nc").exists()


def test_the_same_text_is_no_quarrel(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n")
    own = tmp_path / "own"
    made(own, a="M30\n")
    keep = Keeping()
    assert import_programs(sources, own, keep, lambda _path: "", replace=False).done == ("a.nc",)
    assert keep.told == []


def test_where_versions_are_not_kept_nothing_is_replaced(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n")
    own = tmp_path / "own"
    made(own, a="M00\n")
    with pytest.raises(FileError, match=pattern("programs.not-replaced")):
        import_programs(sources, own, Persistence(), lambda _path: "", replace=True)
    assert (own / "a.nc").read_text() == "M00\n"


def test_one_bad_file_keeps_all_of_them_out(tmp_path: Path) -> None:
    sources = made(tmp_path / "stick", a="M30\n")
    bad = tmp_path / "stick" / "b.nc"
    bad.write_bytes(b"\x00\x01" * 40)
    with pytest.raises(FileError, match=pattern("programs.no-program", name="b.nc")):
        import_programs([*sources, bad], tmp_path / "own", Keeping(), lambda _path: "", replace=False)
    assert not (tmp_path / "own").exists()


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_export, "LARGEST", 3)
    sources = made(tmp_path / "stick", a="M30\n")
    with pytest.raises(FileError, match=pattern("programs.too-large")):
        export_programs(sources, tmp_path, replace=False)


def test_a_copy_that_does_not_read_back_is_no_copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sources = made(tmp_path / "own", a="M30\n")
    stick = tmp_path / "stick"
    stick.mkdir()
    real = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: b"" if ".unfinished" in str(path) else real(path))
    with pytest.raises(FileError, match=pattern("programs.bad-stick")):
        export_programs(sources, stick, replace=False)
    assert list(stick.iterdir()) == []


def test_a_full_stick_leaves_no_half_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sources = made(tmp_path / "own", a="M30\n")
    stick = tmp_path / "stick"
    stick.mkdir()

    def full(_handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(
        FileError,
        match=pattern("programs.some-copied", done=0, of=1) + ": " + pattern("programs.full", place="stick"),
    ):
        export_programs(sources, stick, replace=False)
    assert list(stick.iterdir()) == []


@pytest.mark.parametrize(
    ("typed", "name"),
    [("part", "part.nc"), (" part ", "part.nc"), ("part.TXT", "part.TXT"), ("3.5", "3.5.nc")],
)
def test_a_name_gets_the_ending_it_lacks(typed: str, name: str) -> None:
    assert checked_name(typed, Path("like.nc")) == name


@pytest.mark.parametrize("typed", ["", "  ", "a/b", "..", ".hidden", "a:b", "x" * 300])
def test_a_name_that_will_not_do(typed: str) -> None:
    with pytest.raises(FileError):
        checked_name(typed, Path("like.nc"))


def test_another_case_of_letters_is_another_name_of_the_same_file(tmp_path: Path) -> None:
    (path,) = made(tmp_path / "own", a="M30\n")
    assert rename_program(path, "A", Persistence()) == "A.nc"
    with pytest.raises(FileError, match=pattern("programs.same-name")):
        rename_program(path.with_name("A.nc"), "A.nc", Persistence())


def test_what_cannot_be_kept_is_not_deleted(tmp_path: Path) -> None:
    (path,) = made(tmp_path / "own", a="M30\n")
    with pytest.raises(FileError, match=pattern("programs.not-deleted")):
        delete_program(path, Persistence())
    assert path.exists()


def test_the_chooser_goes_in_and_up_to_the_places(tmp_path: Path) -> None:
    (tmp_path / "stick").mkdir()
    made(tmp_path / "stick" / "jobs", a="M30\n")
    (tmp_path / "stick" / "jobs" / ".hidden.nc").write_text("")
    (tmp_path / "stick" / "jobs" / "photo.jpg").write_text("")
    chooser = FolderChooser(tmp_path, lambda: (Stick("STICK", tmp_path / "stick", 5),))
    chooser.show_lines(chooser.look())
    assert [line.name for line in chooser.lines] == ["STICK", "THIS CONTROL"]
    for name in ("STICK", "jobs"):
        chooser.go(next(line for line in chooser.lines if line.name == name))
        chooser.show_lines(chooser.look())
    assert [line.name for line in chooser.lines] == [UP, "a.nc"]
    assert [path.name for path in chooser.programs] == ["a.nc"]
    for _ in range(2):
        chooser.go(chooser.lines[0])
        chooser.show_lines(chooser.look())
    assert chooser.at is None
