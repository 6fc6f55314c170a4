"""Backup, restore, export, verify."""

from __future__ import annotations

import csv
import errno
import sqlite3
import tomllib
from hashlib import sha256
from pathlib import Path
from typing import NoReturn

import pytest

from core.store import backup, store_export
from core.store.offsets.offset_tables import ChangeReason
from core.store.store import Store, StoreError
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import OffsetKind, SecondaryOffsetRow, ToolOffsetRow
from tests.coded import raises_code


def fill(store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 31.75, "z": -12.7, "nose_radius": 0.381})
    store.offsets.secondary_offsets.change_row(4, "wear", {"x": -0.0127})
    store.programs.save_version("PIN.nc", b"G90\r\nM30\r\n", "new")
    store.events.log_event("start", 'PIN.nc, "first" part').result()


def test_backup_of_a_store_in_use_restores_elsewhere(store: Store, folder: Path, tmp_path: Path) -> None:
    fill(store)
    target = tmp_path / "b.db"
    backup.back_up_store(folder, target)
    store.offsets.tool_offsets.change_row(1, "later", {"x": 1.0}).result()
    assert backup.restore_store(tmp_path / "other", target) is None
    with Store.open(tmp_path / "other") as other:
        assert other.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(31.75, -12.7, 0.381)}
        assert other.programs.load_version("PIN.nc") == b"G90\r\nM30\r\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["b.db", "home", "other"]


def test_restore_saves_the_replaced_store(folder: Path, tmp_path: Path) -> None:
    with Store.open(folder) as store:
        fill(store)
    backup.back_up_store(folder, tmp_path / "b.db")
    with Store.open(folder) as store:
        store.offsets.tool_offsets.change_row(1, "later", {"x": 1.0}).result()
    kept = backup.restore_store(folder, tmp_path / "b.db")
    assert kept is not None
    assert kept.parent == folder
    with Store.open(folder) as store:
        assert store.offsets.tool_offsets.read_rows()[1].x == 31.75
    connection = sqlite3.connect(kept)
    assert connection.execute("SELECT x FROM tool_offsets").fetchall() == [(1.0,)]
    connection.close()


def test_restore_replaces_damaged_store_and_saves_its_bytes(folder: Path, tmp_path: Path) -> None:
    with Store.open(folder) as store:
        fill(store)
    backup.back_up_store(folder, tmp_path / "b.db")
    (folder / STORE_FILE_NAME).write_bytes(b"rubbish" * 1000)
    kept = backup.restore_store(folder, tmp_path / "b.db")
    assert kept is not None
    assert kept.read_bytes() == b"rubbish" * 1000
    with Store.open(folder) as store:
        assert store.offsets.tool_offsets.read_rows()[1].x == 31.75


def test_restore_while_the_store_is_in_use_is_refused(store: Store, folder: Path, tmp_path: Path) -> None:
    fill(store)
    backup.back_up_store(folder, tmp_path / "b.db")
    with raises_code(StoreError, "in-use"):
        backup.restore_store(folder, tmp_path / "b.db")


@pytest.mark.parametrize("content", [b"", b"G90\r\n" * 100, b"SQLite format 3\0" + b"\0" * 200])
def test_restore_of_file_that_is_not_a_backup_changes_nothing(
    store: Store, folder: Path, tmp_path: Path, content: bytes
) -> None:
    fill(store)
    store.close()
    before = (folder / STORE_FILE_NAME).read_bytes()
    (tmp_path / "b.db").write_bytes(content)
    with pytest.raises(StoreError):
        backup.restore_store(folder, tmp_path / "b.db")
    assert (folder / STORE_FILE_NAME).read_bytes() == before


def test_restore_of_damaged_backup_is_rejected(folder: Path, tmp_path: Path) -> None:
    with Store.open(folder) as store:
        fill(store)
    target = tmp_path / "b.db"
    backup.back_up_store(folder, target)
    target.write_bytes(target.read_bytes().replace(b"G90\r\nM30", b"G91\r\nM30"))
    with raises_code(StoreError, "damaged-backup", "'PIN.nc' version 1"):
        backup.restore_store(folder, target)


def test_backup_never_overwrites_file_that_is_not_a_backup(
    store: Store, folder: Path, tmp_path: Path
) -> None:
    fill(store)
    precious = tmp_path / "part.nc"
    precious.write_bytes(b"G90")
    with raises_code(StoreError, "not-a-database"):
        backup.back_up_store(folder, precious)
    assert precious.read_bytes() == b"G90"
    with raises_code(StoreError, "store-itself"):
        backup.back_up_store(folder, folder / STORE_FILE_NAME)


def test_backup_without_store_or_target_folder_is_rejected(folder: Path, tmp_path: Path) -> None:
    with raises_code(StoreError, "no-store"):
        backup.back_up_store(folder, tmp_path / "b.db")
    with Store.open(folder) as store:
        fill(store)
    with raises_code(StoreError, "cannot-write"):
        backup.back_up_store(folder, tmp_path / "none" / "b.db")


def test_files_next_to_backup_or_export_are_not_changed(store: Store, folder: Path, tmp_path: Path) -> None:
    fill(store)
    (tmp_path / "b.db.new").write_text("mine")
    (tmp_path / "out.new").mkdir()
    backup.back_up_store(folder, tmp_path / "b.db")
    store_export.export_store(store, tmp_path / "out")
    assert (tmp_path / "b.db.new").read_text() == "mine"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["b.db", "b.db.new", "home", "out", "out.new"]


def test_export_of_damaged_program_leaves_no_files(store: Store, tmp_path: Path) -> None:
    fill(store)
    store.write(lambda c: c.execute("UPDATE program_versions SET text = X'58'").close()).result()
    with raises_code(StoreError, "damaged-version"):
        store_export.export_store(store, tmp_path / "out")
    assert [path.name for path in tmp_path.iterdir()] == ["home"]


def test_backup_replaces_an_older_backup(store: Store, folder: Path, tmp_path: Path) -> None:
    fill(store)
    target = tmp_path / "b.db"
    backup.back_up_store(folder, target)
    first = sha256(target.read_bytes()).digest()
    store.offsets.tool_offsets.change_row(2, "x", {"x": 1.0}).result()
    backup.back_up_store(folder, target)
    assert sha256(target.read_bytes()).digest() != first
    assert backup.find_store_problems(target) == ()


def test_export_is_plain_files(store: Store, tmp_path: Path) -> None:
    fill(store)
    assert store_export.export_store(store, tmp_path / "out") == 1
    assert (tmp_path / "out/programs/PIN.nc").read_bytes() == b"G90\r\nM30\r\n"
    offsets = tomllib.loads((tmp_path / "out/offsets.toml").read_text())
    assert offsets["tool"]["1"] == {
        **{"x": 1.25, "z": -0.5, "nose_radius": 0.015, "wear_x": 0.0, "wear_z": 0.0},
        **{"quadrant": 0, "remark": "", "master": False},
    }
    assert offsets["secondary"]["4"] == {"x": -0.0005, "z": 0.0, "r": 0.0}
    with (tmp_path / "out/events.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["at", "kind", "text", "line", "record", "who"]
    assert rows[1][1:] == ["start", 'PIN.nc, "first" part', "0", "", ""]


def test_exported_programs_can_be_imported(store: Store, tmp_path: Path) -> None:
    fill(store)
    store_export.export_store(store, tmp_path / "out")
    with Store.open(tmp_path / "other") as other:
        rows = {4: SecondaryOffsetRow(-0.0127, 0.0, 0.0)}
        programs = store_export.read_exported_programs(tmp_path / "out")
        values = {OffsetKind.SECONDARY: {number: row._asdict() for number, row in rows.items()}}
        other.write(
            lambda c: store_export.import_programs_and_offsets(
                c, programs, values, ChangeReason("import", "import")
            )
        ).result()
        assert other.programs.load_version("PIN.nc") == b"G90\r\nM30\r\n"
        assert other.offsets.secondary_offsets.read_rows() == rows
        assert other.offsets.read_history()[0].who == "import"


def test_export_into_folder_that_is_not_empty_is_rejected(store: Store, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out/precious").write_text("x")
    with raises_code(StoreError, "folder-not-empty"):
        store_export.export_store(store, tmp_path / "out")
    with raises_code(StoreError, "not-an-export"):
        store_export.read_exported_programs(tmp_path / "out")
    assert (tmp_path / "out/precious").read_text() == "x"


def test_verify_finds_damaged_text_and_orphaned_rows(folder: Path) -> None:
    with Store.open(folder) as store:
        fill(store)
    path = folder / STORE_FILE_NAME
    assert backup.find_store_problems(path) == ()
    with sqlite3.connect(path) as connection:
        connection.execute("UPDATE program_versions SET text = X'58'")
        connection.execute("INSERT INTO program_versions VALUES (9, 77, 1, X'', '', '', '', '')")
    connection.close()
    told = " ".join(backup.find_store_problems(path))
    assert "'PIN.nc' version 1 " in told
    assert " program_versions " in told


# --- a folder that changes or cannot be written -----------------------------------------------------------


def fail(*_given: object, **_options: object) -> NoReturn:
    raise PermissionError(errno.EACCES, "Permission denied")


def test_log_that_cannot_be_removed_leaves_the_old_store(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store.open(folder) as store:
        fill(store)
    backup.back_up_store(folder, tmp_path / "b.db")
    before = (folder / STORE_FILE_NAME).read_bytes()
    unlink = Path.unlink

    def keep_log(path: Path, missing_ok: bool = False) -> None:
        if path.name == f"{STORE_FILE_NAME}-wal":
            fail()
        unlink(path, missing_ok=missing_ok)

    with monkeypatch.context() as locked:
        locked.setattr(Path, "unlink", keep_log)
        with raises_code(StoreError, "cannot-write", f"{STORE_FILE_NAME}-wal"):
            backup.restore_store(folder, tmp_path / "b.db")
    assert (folder / STORE_FILE_NAME).read_bytes() == before


def test_file_that_cannot_be_compared_with_the_store_is_an_error(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store.open(folder) as store:
        fill(store)
    backup.back_up_store(folder, tmp_path / "b.db")
    before = (tmp_path / "b.db").read_bytes()
    monkeypatch.setattr(Path, "samefile", fail)
    with raises_code(StoreError, "forbidden"):
        backup.restore_store(folder, tmp_path / "b.db")
    with raises_code(StoreError, "forbidden"):
        backup.back_up_store(folder, tmp_path / "b.db")
    assert (tmp_path / "b.db").read_bytes() == before
