"""Program files: what the folders give, and a file that somebody else has changed."""

from __future__ import annotations

import errno
import os
from dataclasses import replace
from pathlib import Path

import pytest

from app.desk.programs import program_folder
from app.desk.programs.program_folder import ProgramFileMonitor, ProgramFolders
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from core.language.source import load_source
from drivers.wakeups import ManualClock
from tests.texts import begins


@pytest.fixture
def program_folders(tmp_path: Path) -> ProgramFolders:
    mine, samples = tmp_path / "mine", tmp_path / "samples"
    mine.mkdir()
    samples.mkdir()
    (mine / "PART1").write_text("G90")
    (mine / "part10.nc").write_text("G90")
    (samples / "part1").write_text("G90")
    (samples / "knob.nc").write_text("G90")
    (samples / "notes.md").write_text("no program")
    (samples / ".hidden").write_text("G90")
    return ProgramFolders((mine, samples, tmp_path / "not there"))


def test_the_operators_folder_hides_the_samples(program_folders: ProgramFolders) -> None:
    assert [entry.name for entry in program_folders.list_programs()] == ["knob.nc", "PART1", "part10.nc"]
    assert program_folders.find_path("part1") == program_folders.folders[0] / "PART1"


@pytest.mark.parametrize("typed", ["knob", "KNOB.NC", " knob.nc "])
def test_program_is_found_regardless_of_case_and_extension(
    program_folders: ProgramFolders, typed: str
) -> None:
    assert program_folders.find_path(typed) == program_folders.folders[1] / "knob.nc"


def test_path_is_used_as_given(program_folders: ProgramFolders) -> None:
    there = program_folders.folders[1] / "notes.md"
    assert program_folders.find_path(str(there)) == there


@pytest.mark.parametrize("typed", ["", "  ", "nosuch", "par", "/nowhere/knob.nc", "notes"])
def test_unknown_program_name_is_not_found(program_folders: ProgramFolders, typed: str) -> None:
    assert program_folders.find_path(typed) is None


def test_typed_text_filters_the_list(program_folders: ProgramFolders) -> None:
    assert [entry.name for entry in program_folders.find_matching_programs("PART")] == ["PART1", "part10.nc"]
    assert program_folders.find_matching_programs("xyz") == ()


# --- The file that was read, changed behind the desk's back by somebody else.


TEXT = "G90G94\nX.5F10\nM30\n"


def on_the_desk(path: Path) -> LoadedProgram:
    """What loading this file leaves on the desk."""
    return LoadedProgram(LoadingPhase.READY, path, source=load_source(path))


def touched(path: Path, text: str) -> None:
    """Written by somebody, a second later by the clock of the disk."""
    before = path.stat().st_mtime_ns if path.exists() else 0
    path.write_text(text)
    os.utime(path, ns=(before + 10**9, before + 10**9))


def test_unchanged_file_is_not_reported(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(TEXT)
    file = ProgramFileMonitor(lambda: on_the_desk(path))
    file.compare_files()
    assert file.difference_text == ""
    touched(path, TEXT)  # saved again as it was
    file.compare_files()
    assert file.difference_text == ""


def test_changed_file_is_reported_until_it_is_reloaded_or_restored(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(TEXT)
    desk = [on_the_desk(path)]
    file = ProgramFileMonitor(lambda: desk[0])
    file.compare_files()
    touched(path, TEXT.replace("X.5", "X1.5"))
    file.compare_files()
    assert begins(file.difference_text, "programs.changed-on-disk", name="part.nc")
    assert file.can_reload
    touched(path, TEXT)
    file.compare_files()
    assert file.difference_text == ""
    touched(path, TEXT.replace("X.5", "X2.5"))
    desk[0] = on_the_desk(path)
    file.compare_files()
    assert file.difference_text == ""


def test_missing_or_unreadable_file_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(TEXT)
    loaded = on_the_desk(path)
    file = ProgramFileMonitor(lambda: loaded)
    path.write_bytes(b"G90\0\0")
    file.compare_files()
    assert begins(file.difference_text, "programs.changed-on-disk", name="part.nc")
    path.unlink()
    file.compare_files()
    assert begins(file.difference_text, "programs.not-on-disk", name="part.nc")
    assert not file.can_reload


def test_change_in_a_called_subprogram_is_reported(tmp_path: Path) -> None:
    path, called = tmp_path / "ring.mpf", tmp_path / "cut.spf"
    path.write_text(TEXT)
    called.write_text("G1 X5\nM17\n")
    loaded = on_the_desk(path)
    assert loaded.source is not None
    loaded = replace(loaded, source=replace(loaded.source, subprograms=(load_source(called),)))
    file = ProgramFileMonitor(lambda: loaded)
    file.compare_files()
    assert file.difference_text == ""
    touched(called, "G1 X50\nM17\n")
    file.compare_files()
    assert begins(file.difference_text, "programs.changed-on-disk", name="cut.spf")


def test_monitor_without_a_program_reports_nothing() -> None:
    file = ProgramFileMonitor(LoadedProgram)
    file.compare_files()
    assert file.difference_text == ""


# --- A disk that cannot be read: the watch goes on, and says so.


@pytest.mark.parametrize("number", [errno.EACCES, errno.EIO, errno.ESTALE])
def test_unreadable_folder_is_reported_and_monitoring_continues(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    path = tmp_path / "part.nc"
    path.write_text(TEXT)
    loaded = on_the_desk(path)
    file = ProgramFileMonitor(lambda: loaded)

    def broken(*_args: object, **_named: object) -> object:
        raise OSError(number, os.strerror(number))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "stat", broken)
        patch.setattr(os, "open", broken)
        file.compare_files()
        assert begins(file.difference_text, "programs.unreadable", name="part.nc")
    file.compare_files()
    assert file.difference_text == ""
    touched(path, TEXT.replace("X.5", "X1.5"))
    file.compare_files()
    assert begins(file.difference_text, "programs.changed-on-disk", name="part.nc")


def test_file_monitor_survives_any_exception_of_a_check(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "part.nc"
    path.write_text(TEXT)
    loaded = on_the_desk(path)
    file = ProgramFileMonitor(lambda: loaded)

    def broken(_path: Path) -> object:
        raise RuntimeError("a network file system")

    with monkeypatch.context() as patch:
        patch.setattr(program_folder, "load_source", broken)
        file.check_file_safely()
        assert begins(file.difference_text, "programs.unreadable", name="part.nc")
    file.check_file_safely()
    assert file.difference_text == ""


def test_hanging_check_is_reported_while_it_hangs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "part.nc"
    path.write_text(TEXT)
    loaded, clock, seen = on_the_desk(path), ManualClock(), list[str]()
    file = ProgramFileMonitor(lambda: loaded, clock.now)

    def slow(_path: Path) -> object:
        seen.append(file.difference_text)
        clock.sleep_until(clock.now() + program_folder.CHECK_TIMEOUT_S + 1.0)
        seen.append(file.difference_text)
        return loaded.source

    monkeypatch.setattr(program_folder, "load_source", slow)
    file.compare_files()
    assert seen[0] == ""
    assert begins(seen[1], "programs.unreadable", name="part.nc")
    assert file.difference_text == ""


@pytest.mark.parametrize(("name", "known"), [("a.DXF", True), ("a.dxf.nc", False), ("dxf", False)])
def test_drawing_is_recognized_by_extensions_of_a_feature(name: str, known: bool) -> None:
    folders = ProgramFolders((), (".dxf",))
    assert folders.is_drawing_name(name) is known
    assert not ProgramFolders(()).is_drawing_name(name)


def test_drawings_are_listed_only_if_a_feature_reads_them(tmp_path: Path) -> None:
    for name in ("a.nc", "b.dxf", "c.pdf"):
        (tmp_path / name).write_text("")
    assert [each.name for each in ProgramFolders((tmp_path,), (".dxf",)).list_drawings()] == ["b.dxf"]
    assert ProgramFolders((tmp_path,)).list_drawings() == ()
    assert [each.name for each in ProgramFolders((tmp_path,), (".dxf",)).list_programs()] == ["a.nc"]
