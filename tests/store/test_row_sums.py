"""A sum beside every row: what was flipped on the disk is put right, or not used and told."""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from app.compose.stored_offsets import read_stored_offsets
from app.desk.command_errors import CommandError
from core.store import backup, database, program_records, row_checksums
from core.store.damaged_rows import make_row_label
from core.store.production.tool_lives import ToolLifeRow, read_tool_lives, save_insert_use
from core.store.store import Store
from core.store.store_file import STORE_FILE_NAME, make_stock_setting_key
from core.store.store_rows import ToolOffsetRow
from tests.coded import raises_code

FILE = STORE_FILE_NAME


@pytest.fixture
def kept(folder: Path) -> Path:
    """T1 and T3, D2, G54, a setting, a count, a tool's life."""
    with Store.open(folder) as store:
        store.offsets.tool_offsets.change_row(1, "touched", {"x": 1.0, "z": 2.0}).result()
        store.offsets.tool_offsets.change_row(
            3, "touched", {"x": -12.7, "z": -2.5, "remark": "FINISHER"}
        ).result()
        store.offsets.secondary_offsets.change_row(2, "wear", {"x": 0.01}).result()
        store.settings.save_setting("units", "metric").result()
        store.runs.add_parts("pin.nc").result()
        store.runs.add_parts("pin.nc").result()
        store.write(lambda c: save_insert_use(c, 3, 40, 120.5)).result()
    return folder


@contextmanager
def outside(folder: Path) -> Iterator[sqlite3.Connection]:
    """Another program, or a bad sector: nothing of ours looks on."""
    with closing(sqlite3.connect(folder / FILE)) as connection:
        yield connection
        connection.commit()


def flipped(value: float) -> float:
    """One bit of it, the lowest of the exponent: half as much, or twice."""
    bits = struct.unpack("<Q", struct.pack("<d", value))[0] ^ (1 << 52)
    return float(struct.unpack("<d", struct.pack("<Q", bits))[0])


def flip(folder: Path, table: str, column: str, where: str) -> None:
    with outside(folder) as connection:
        before = connection.execute(f"SELECT {column} FROM {table} WHERE {where}").fetchone()[0]
        connection.execute(f"UPDATE {table} SET {column} = ? WHERE {where}", (flipped(before),))


def test_undamaged_store_has_no_problems(kept: Path) -> None:
    assert backup.find_store_problems(kept / FILE) == ()
    with Store.open(kept) as store:
        assert (store.repair_messages, store.find_damaged_rows()) == ((), ())


def test_flipped_bit_is_not_used_as_an_offset(kept: Path) -> None:
    flip(kept, "tool_offsets", "z", "number = 3")
    with Store.open(kept, read_only=True) as store:
        assert set(store.offsets.tool_offsets.read_rows()) == {1}
        [told] = store.find_damaged_rows()
        assert told.startswith("T3 ")
    assert backup.find_store_problems(kept / FILE)[0].startswith("T3 ")


def test_history_repairs_offset_when_store_opens(kept: Path) -> None:
    flip(kept, "tool_offsets", "z", "number = 3")
    with Store.open(kept) as store:
        assert store.offsets.tool_offsets.read_rows()[3] == ToolOffsetRow(-12.7, -2.5, remark="FINISHER")
        [told] = store.repair_messages
        assert told.startswith("T3 ")
        assert store.events.read_events(told)[0].kind == "warning"
    with Store.open(kept) as store:
        assert store.repair_messages == ()


def test_deleted_row_is_restored(kept: Path) -> None:
    with outside(kept) as connection:
        connection.execute("DELETE FROM tool_offsets WHERE number = 1")
    with Store.open(kept) as store:
        assert store.offsets.tool_offsets.read_rows()[1] == ToolOffsetRow(1.0, 2.0)


def test_damaged_checksum_loses_nothing(kept: Path) -> None:
    with outside(kept) as connection:
        connection.execute("UPDATE row_sums SET sha256 = 'ab' || substr(sha256, 3)")
    with Store.open(kept) as store:
        assert store.offsets.tool_offsets.read_rows()[3].x == -12.7
        assert store.offsets.secondary_offsets.read_rows()[2].x == 0.01


def test_row_and_history_with_same_damage_are_not_used(kept: Path) -> None:
    with outside(kept) as connection:
        connection.execute("UPDATE tool_offsets SET x = 5.0 WHERE number = 3")
        connection.execute("UPDATE offset_changes SET new_x = 6.0 WHERE number = 3")
    with Store.open(kept) as store:
        assert set(store.offsets.tool_offsets.read_rows()) == {1}
        store.offsets.tool_offsets.change_row(3, "entered anew", {"x": -12.7, "z": -2.5}).result()
        assert store.find_damaged_rows() == ()
        assert store.offsets.tool_offsets.read_rows()[3].z == -2.5


def test_nothing_is_proved_with_a_damaged_offset(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(kept))
    assert 3 in read_stored_offsets().tool_offsets
    flip(kept, "secondary_offsets", "x", "number = 2")
    with raises_code(CommandError, "damaged-row", "D2"):
        read_stored_offsets()


def test_damaged_mill_preset_is_rejected(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(kept))
    with Store.open(kept) as store:
        store.settings.save_setting("preset", 3).result()
    read_stored_offsets()
    with outside(kept) as connection:
        connection.execute("UPDATE settings SET value = '2' WHERE key = 'preset'")
    with raises_code(CommandError, "damaged-row", "preset"):
        read_stored_offsets()


@pytest.mark.parametrize("damage", ["'abc'", "x'ff00'", "NULL || ''"])
def test_value_of_wrong_type_rejects_only_its_own_row(kept: Path, damage: str) -> None:
    with outside(kept) as connection:
        connection.execute("PRAGMA ignore_check_constraints = ON")
        connection.execute(f"UPDATE tool_offsets SET x = coalesce({damage}, '') WHERE number = 3")
    with Store.open(kept, read_only=True) as store:
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(1.0, 2.0)}


def test_text_of_wrong_type_hides_no_other_row(kept: Path) -> None:
    with outside(kept) as connection:
        connection.execute("UPDATE tool_offsets SET remark = CAST(x'46ff4e' AS TEXT) WHERE number = 3")
        connection.execute("UPDATE settings SET value = CAST(x'22ff22' AS TEXT) WHERE key = 'units'")
    with Store.open(kept, read_only=True) as store:
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(1.0, 2.0)}
        assert store.settings.read_setting("units") is None
    with Store.open(kept) as store:
        assert store.offsets.tool_offsets.read_rows()[3].remark == "FINISHER"


def test_damaged_settings_counts_and_tool_lives_are_not_used(kept: Path) -> None:
    with outside(kept) as connection:
        connection.execute("UPDATE settings SET value = '\"inch\"' WHERE key = 'units'")
        connection.execute("UPDATE part_counts SET count = 66")
        connection.execute("UPDATE tool_lives SET parts = 8")
    with Store.open(kept) as store:
        assert (store.settings.read_setting("units"), store.runs.read_part_count("pin.nc")) == (None, 0)
        told = store.find_damaged_rows()
        rows = (
            make_row_label("tool_lives", 3),
            make_row_label("part_counts", "pin.nc"),
            make_row_label("settings", "units"),
        )
        assert [each.startswith(row) for each, row in zip(told, rows, strict=True)] == [True] * 3
        store.settings.save_setting("units", "metric").result()
        store.runs.reset_parts("pin.nc").result()
        store.write(lambda c: save_insert_use(c, 3, 40, 120.5)).result()
        assert store.find_damaged_rows() == ()
        assert (store.settings.read_setting("units"), store.runs.read_part_count("pin.nc")) == ("metric", 0)


def test_many_changes_in_one_transaction_see_each_other(kept: Path) -> None:
    def twice(connection: sqlite3.Connection) -> int:
        program_records.add_parts(connection, "pin.nc", 3, "2026-11-23T00:00:00Z")
        program_records.add_parts(connection, "pin.nc", 3, "2026-11-23T00:00:00Z")
        return program_records.read_part_count(connection, "pin.nc")

    with Store.open(kept) as store:
        assert store.write(twice).result() == 8
        assert store.find_damaged_rows() == ()


def test_rollback_also_reverts_checksums(kept: Path) -> None:
    def fails(connection: sqlite3.Connection) -> None:
        connection.execute("UPDATE tool_offsets SET x = 9 WHERE number = 1")
        raise ZeroDivisionError

    with Store.open(kept) as store:
        with pytest.raises(ZeroDivisionError):
            store.write(fails).result()
        assert store.find_damaged_rows() == ()
        assert store.offsets.tool_offsets.read_rows()[1].x == 1.0


def test_renamed_program_retains_valid_rows(kept: Path) -> None:
    with Store.open(kept) as store:
        store.programs.save_version("pin.nc", b"M30\n", "kept").result()
        store.settings.save_setting(make_stock_setting_key("pin.nc"), "bar:1").result()
        store.programs.rename_program("pin.nc", "pin2.nc").result()
        assert store.runs.read_part_count("pin2.nc") == 2
        assert store.settings.read_setting(make_stock_setting_key("pin2.nc")) == "bar:1"
        assert store.find_damaged_rows() == ()


def test_older_store_gets_checksums(tmp_path: Path) -> None:
    old = database.load_migrations()[:10]
    with closing(sqlite3.connect(tmp_path / FILE, isolation_level=None)) as connection:
        connection.execute(f"PRAGMA application_id = {database.APPLICATION_ID}")
        database.upgrade_tables(connection, old)
        connection.execute("INSERT INTO tool_offsets (number, x, z, r) VALUES (7, 1.5, -2.5, 0.4)")
    with Store.open(tmp_path) as store:
        assert store.offsets.tool_offsets.read_rows()[7].x == 1.5
        assert store.find_damaged_rows() == ()
    flip(tmp_path, "tool_offsets", "x", "number = 7")
    with Store.open(tmp_path) as store:  # it has no history
        assert store.offsets.tool_offsets.read_rows() == {}
        assert len(store.find_damaged_rows()) == 1


def test_damage_before_migration_remains_detected(kept: Path) -> None:
    with outside(kept) as connection:
        connection.execute("UPDATE tool_lives SET parts = 8")
    newer = (*database.load_migrations(), "ALTER TABLE tool_lives ADD COLUMN more REAL NOT NULL DEFAULT 0;")
    with closing(sqlite3.connect(kept / FILE, isolation_level=None)) as connection:
        database.upgrade_tables(connection, newer)
        assert row_checksums.find_all_broken_rows(connection) == {("tool_lives", 3)}
        save_insert_use(connection, 3, 40, 1.0)
        assert row_checksums.find_all_broken_rows(connection) == frozenset()


def test_tool_life_is_read_as_saved(kept: Path) -> None:
    with Store.open(kept) as store, store.read() as connection:
        assert read_tool_lives(connection)[3] == ToolLifeRow(3, parts=40, seconds=120.5)


def test_concurrent_save_does_not_look_like_damage(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A wear entered while the desk reads its offsets: they are those of before, or those behind it."""
    with Store.open(kept) as store:
        sums = row_checksums._sums

        def saved_meanwhile(
            connection: sqlite3.Connection, table: str, since: int | None
        ) -> dict[row_checksums.RowKey, str]:
            monkeypatch.setattr(row_checksums, "_sums", sums)
            store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": -0.01}).result()
            return sums(connection, table)

        monkeypatch.setattr(row_checksums, "_sums", saved_meanwhile)
        assert store.offsets.tool_offsets.read_rows()[3].wear_x == 0.0
        assert store.offsets.tool_offsets.read_rows()[3].wear_x == -0.01
