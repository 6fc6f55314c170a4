"""Sticks by the kernel's list of mounts, and why nothing can be written on one; nothing is lost."""

from __future__ import annotations

import errno
from dataclasses import replace
from pathlib import Path

import pytest

from app.programs.atomic_files import FileOperationError
from app.programs.import_export import export_programs
from app.programs.removable_media import (
    FolderChooser,
    TargetMedium,
    UsbStick,
    describe_media_error,
    list_usb_sticks,
)
from tests.texts import pattern
from tests.texts import text as wording

LINE = "{n} 28 {device} / {path} {options} shared:1 - vfat /dev/x {super}\n"


def listed(tmp_path: Path, *rows: tuple[str, str, str, str]) -> tuple[UsbStick, ...]:
    """What is found where the kernel lists these: device, path, options, those of the file system."""
    mounts, blocks = tmp_path / "mountinfo", tmp_path / "block"
    text = "".join(
        LINE.format(n=30 + n, device=device, path=path, options=options, super=of_system)
        for n, (device, path, options, of_system) in enumerate(rows)
    )
    mounts.write_text(text)
    for device, removable in (("8:1", "0"), ("8:17", "1")):
        disk = tmp_path / f"disk{device[2:]}"
        (disk / "part").mkdir(parents=True, exist_ok=True)
        (disk / "removable").write_text(removable + "\n")
        blocks.mkdir(exist_ok=True)
        if not (blocks / device).exists():
            (blocks / device).symlink_to(disk / "part")
    return list_usb_sticks((Path("/media"), Path("/run/media")), lambda _path: True, mounts, blocks)


def test_mounted_removable_media_are_listed(tmp_path: Path) -> None:
    found = listed(
        tmp_path,
        ("8:1", "/", "rw", "rw"),
        ("8:1", "/home", "rw", "rw"),
        ("0:40", "/proc", "rw", "rw"),
        ("0:41", "/media/ann/MY\\040STICK", "rw", "rw"),
        ("8:17", "/srv/usb", "rw", "rw"),
        ("0:42", "/media/a/b/c", "rw", "rw"),
    )
    assert [(stick.label, str(stick.path)) for stick in found] == [
        ("MY STICK", "/media/ann/MY STICK"),
        ("usb", "/srv/usb"),
    ]


@pytest.mark.parametrize(("options", "of_system"), [("ro,nosuid", "rw"), ("rw", "ro")])
def test_read_only_stick_is_marked(tmp_path: Path, options: str, of_system: str) -> None:
    (stick,) = listed(tmp_path, ("8:17", "/media/S", options, of_system))
    assert stick.is_read_only


def test_invalid_mount_lines_are_ignored(tmp_path: Path) -> None:
    (tmp_path / "mountinfo").write_text("nonsense\n1 2 3\n")
    assert list_usb_sticks((Path("/media"),), lambda _path: True, tmp_path / "mountinfo", tmp_path) == ()


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.ENOSPC, wording("programs.full", place="STICK")),
        (errno.EROFS, wording("programs.read-only", place="STICK")),
        (errno.EIO, wording("programs.pulled-out", place="STICK")),
        (errno.ENOENT, wording("programs.gone", place="STICK")),
        (errno.EACCES, "STICK: Permission denied"),
    ],
)
def test_media_error_is_described(number: int, words: str) -> None:
    assert describe_media_error(OSError(number, "Permission denied"), Path("/media/STICK")).startswith(words)


def made(folder: Path, *names: str) -> list[Path]:
    folder.mkdir()
    for name in names:
        (folder / name).write_text("M30\n")
    return [folder / name for name in names]


def test_leftover_folder_of_removed_stick_is_not_written(tmp_path: Path) -> None:
    sources, place = made(tmp_path / "own", "a.nc"), tmp_path / "STICK"
    place.mkdir()
    there = TargetMedium.from_folder(place)
    with pytest.raises(FileOperationError, match=pattern("programs.pulled-out")):
        export_programs(
            sources, place, may_overwrite=False, medium=replace(there, device_number=there.device_number + 1)
        )
    assert list(place.iterdir()) == []


def test_export_stops_when_stick_is_removed_between_programs(tmp_path: Path) -> None:
    sources, place = made(tmp_path / "own", "a.nc", "b.nc"), tmp_path / "STICK"
    place.mkdir()

    def told(done: int, _of: int) -> None:
        if done == 1:
            place.rename(tmp_path / "elsewhere")

    with pytest.raises(
        FileOperationError,
        match=pattern("programs.some-copied", done=1, of=2)
        + ": "
        + pattern("programs.pulled-out", place="STICK"),
    ):
        export_programs(sources, place, may_overwrite=False, report_progress=told)
    assert [path.name for path in (tmp_path / "elsewhere").iterdir()] == ["a.nc"]
    assert all(path.exists() for path in sources)


def test_lack_of_space_is_reported_before_writing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sources, place = made(tmp_path / "own", "a.nc", "b.nc"), tmp_path / "STICK"
    place.mkdir()
    monkeypatch.setattr("app.programs.removable_media._free", lambda _path: 7)
    with pytest.raises(
        FileOperationError, match=pattern("programs.no-room", place="STICK", size="8 B", free="7 B")
    ):
        export_programs(sources, place, may_overwrite=False)
    assert list(place.iterdir()) == []


def test_chooser_reports_removed_stick(tmp_path: Path) -> None:
    place = tmp_path / "STICK"
    place.mkdir()
    chooser = FolderChooser(tmp_path, lambda: (UsbStick("STICK", place, 5, is_read_only=True),))
    chooser.show_entries(chooser.list_entries())
    assert chooser.listed_entries[0].is_read_only
    chooser.open_entry(chooser.listed_entries[0])
    chooser.list_entries()
    place.rmdir()
    with pytest.raises(FileOperationError, match=pattern("programs.pulled-out")):
        chooser.list_entries()
