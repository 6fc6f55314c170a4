"""What a kill leaves of a save: gone when the next one writes there, and never what is being written."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from app.programs.atomic_files import write_new_file, write_program_file
from core.file_lock import create_unfinished_file, create_unfinished_folder, remove_abandoned_files
from core.store import backup, database
from core.store.store import Store, StoreError
from core.store.store_export import export_store
from tests.coded import raises_code

_KILLED = """
import os, signal, sys
from pathlib import Path
from core.file_lock import {how}
with {how}(Path(sys.argv[1])) as place:
    (place / "half.nc" if place.is_dir() else place).write_bytes(b"half")
    if not place.is_dir():
        for ending in ("-journal", "-wal", "-shm"):
            place.with_name(place.name + ending).write_bytes(b"SQLite's")
    os.kill(os.getpid(), signal.SIGKILL)
"""


def killed(how: str, target: Path) -> None:
    """A process of its own is killed in the middle of a save."""
    ended = subprocess.run([sys.executable, "-c", _KILLED.format(how=how), str(target)], check=False)
    assert ended.returncode == -signal.SIGKILL
    assert any(path.name.startswith(f".{target.name}.") for path in target.parent.iterdir())


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_killed_program_save_leaves_nothing_after_next_save(tmp_path: Path) -> None:
    killed("create_unfinished_folder", tmp_path / "pin.nc")
    killed("create_unfinished_folder", tmp_path / "bushing.nc")
    write_program_file(tmp_path / "other.nc", b"M30\n")
    assert names(tmp_path) == ["other.nc"]
    killed("create_unfinished_folder", tmp_path / "other.nc")
    write_new_file(tmp_path / "new.nc", b"M30\n")
    assert names(tmp_path) == ["new.nc", "other.nc"]


def test_killed_backup_leaves_nothing_after_next_backup(folder: Path, tmp_path: Path) -> None:
    with Store.open(folder):
        pass
    stick = tmp_path / "stick"
    stick.mkdir()
    killed("create_unfinished_file", stick / "monday.db")
    backup.back_up_store(folder, stick / "tuesday.db")
    assert names(stick) == ["tuesday.db"]


def test_killed_restore_leaves_nothing_after_store_opens(folder: Path, tmp_path: Path) -> None:
    with Store.open(folder):
        pass
    killed("create_unfinished_file", folder / "turndesk.db")
    killed("create_unfinished_file", folder / "turndesk-replaced-x.db")
    with Store.open(folder):
        assert names(folder)[0] == "turndesk.db"
        assert not [name for name in names(folder) if "unfinished" in name]


def test_killed_export_leaves_nothing_after_next_export(store: Store, tmp_path: Path) -> None:
    there = tmp_path / "exports"
    there.mkdir()
    killed("create_unfinished_folder", there / "june")
    export_store(store, there / "july")
    assert names(there) == ["july"]


def test_killed_copy_of_older_version_has_no_final_name(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half a file would be taken for the way back."""
    scripts = database.load_migrations()
    monkeypatch.setattr(database, "load_migrations", lambda: scripts[:-1])
    with Store.open(folder) as store:
        store.offsets.tool_offsets.change_row(3, "touched", {"x": 1.0}).result()
    monkeypatch.setattr(database, "load_migrations", lambda: scripts)

    def cut(_finished: Path, _target: Path) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(database, "replace_atomically", cut)
        with raises_code(StoreError, "disk-full"):
            Store.open(folder)
    assert not [name for name in names(folder) if "version" in name or "unfinished" in name]
    with Store.open(folder) as store:
        assert store.offsets.tool_offsets.read_rows()[3].x == 1.0
    assert backup.find_store_problems(folder / f"turndesk-version-{len(scripts) - 1}.db") == ()


def test_unfinished_files_of_another_process_are_not_removed(tmp_path: Path) -> None:
    with (
        create_unfinished_file(tmp_path / "a.db") as file,
        create_unfinished_folder(tmp_path / "b.nc") as folder,
    ):
        file.write_bytes(b"half")
        for ending in ("-journal", "-wal", "-shm"):
            file.with_name(f"{file.name}{ending}").write_bytes(b"SQLite's")
        (folder / "b.nc").write_bytes(b"half")
        remove_abandoned_files(tmp_path)
        assert (file.read_bytes(), (folder / "b.nc").read_bytes()) == (b"half", b"half")
        assert len(names(tmp_path)) == 5
        for ending in ("-journal", "-wal", "-shm"):
            file.with_name(f"{file.name}{ending}").unlink()
    assert names(tmp_path) == []


def test_other_files_are_not_removed(tmp_path: Path) -> None:
    for name in ("x.unfinished", ".hidden", ".b.new", "pin.nc"):
        (tmp_path / name).write_bytes(b"theirs")
    remove_abandoned_files(tmp_path)
    remove_abandoned_files(tmp_path / "nowhere")
    assert names(tmp_path) == [".b.new", ".hidden", "pin.nc", "x.unfinished"]


def test_restore_without_disk_space_leaves_nothing(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store.open(folder):
        pass
    backup.back_up_store(folder, tmp_path / "good.db")

    def full(_source: Path, target: Path) -> None:
        target.write_bytes(b"as far as it went")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(shutil, "copy2", full)
    with raises_code(StoreError, "disk-full"):
        backup.restore_store(folder, tmp_path / "good.db")
    assert names(folder) == ["turndesk.db", "turndesk.lock"]
