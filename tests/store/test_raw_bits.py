"""Bits that a disk flips in indexes, histories, records of runs, measured parts and the tables as made."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from functools import partial
from pathlib import Path

import pytest

from core.store import backup, database, row_checksums
from core.store.damaged_rows import SCHEMA_CHANGED_MESSAGE, make_row_label
from core.store.production import job_queue, measured_parts
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import RunRow, ToolOffsetRow
from tests.coded import raises_code

PIN = FeatureRow(0, "pin.nc", "OD", "diameter", 12.0, -0.01, 0.02, "tool", 3, 1, 5, 3)


@pytest.fixture
def kept(folder: Path) -> Path:
    """T3 with a wear, a setting, a count, a run, a job under way, a feature with two readings."""
    with Store.open(folder) as store:
        store.offsets.tool_offsets.change_row(
            3, "touched", {"x": -12.7, "z": -2.5, "remark": "FINISHER"}
        ).result()
        store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": -0.02}).result()
        store.settings.save_setting("units", "metric").result()
        store.runs.add_parts("pin.nc", 40).result()
        store.runs.record_cycle("pin.nc", 33.25).result()
        job = store.write(lambda c: job_queue.add_job(c, "pin.nc", 500)).result()
        store.write(lambda c: job_queue.activate_job(c, job)).result()
        feature = store.write(lambda c: measured_parts.save_feature(c, PIN)).result()
        for value in (12.001, 12.004):
            reading = ReadingRow(0, feature, 3, value, "mm", "", "typed", "")
            store.write(partial(measured_parts.add_reading, row=reading)).result()
    return folder


def spoil(folder: Path, statement: str, *values: object) -> None:
    with closing(sqlite3.connect(folder / STORE_FILE_NAME)) as connection:
        connection.execute("PRAGMA ignore_check_constraints = ON")
        connection.execute(statement, values)
        connection.commit()


def spoil_page(folder: Path, root: str, before: bytes, after: bytes) -> None:
    """In the page where a table or an index begins, as a disk does it."""
    path = folder / STORE_FILE_NAME
    with closing(sqlite3.connect(path)) as connection:
        (page,) = connection.execute("SELECT rootpage FROM sqlite_master WHERE name = ?", (root,)).fetchone()
    content = bytearray(path.read_bytes())
    at = content.index(before, (page - 1) * 4096, page * 4096)
    content[at : at + len(before)] = after
    path.write_bytes(content)


# --- indexes -----------------------------------------------------------------------------------------------


def test_damaged_index_is_rebuilt_and_hides_nothing(kept: Path) -> None:
    spoil_page(kept, "sqlite_autoindex_settings_1", b"units", b"unitr")
    spoil_page(kept, "sqlite_autoindex_part_counts_1", b"pin.nc", b"pin.nb")
    assert "missing from index" in backup.find_store_problems(kept / STORE_FILE_NAME)[0]
    with Store.open(kept, read_only=True) as store:
        assert (store.settings.read_setting("units"), store.runs.read_part_count("pin.nc")) == ("metric", 40)
    with Store.open(kept) as store:
        assert store.repair_messages == (database.INDEX_REBUILT_MESSAGE,)
        assert store.events.read_events()[0].text == database.INDEX_REBUILT_MESSAGE
        store.runs.add_parts("pin.nc").result()
        assert (
            store.settings.read_setting("units"),
            store.runs.read_part_count("pin.nc"),
            store.find_damaged_rows(),
        ) == ("metric", 41, ())
    assert backup.find_all_store_problems(kept / STORE_FILE_NAME) == ()


def test_duplicate_keys_under_an_index_are_file_damage(kept: Path) -> None:
    spoil_page(kept, "settings", b"units", b"unitz")
    spoil_page(kept, "sqlite_autoindex_settings_1", b"units", b"unitq")
    spoil(kept, "INSERT INTO settings VALUES ('unitz', '1')")
    with raises_code(StoreError, "damaged"):
        Store.open(kept)


# --- what an undo takes its figures from -------------------------------------------------------------------


@pytest.mark.parametrize(
    "damage",
    [
        "old_x = -25.4",
        "old_z = -5",
        "new_wear_x = -0.04",
        "who = 'OPERATOS'",
        "kind = 'secondary'",
        "step = 1",
        "undoes = 1",
        "number = 4",
    ],
)
def test_damaged_history_entry_undoes_nothing(kept: Path, damage: str) -> None:
    spoil(kept, f"UPDATE offset_changes SET {damage} WHERE id = 2")
    assert backup.find_store_problems(kept / STORE_FILE_NAME) == ()
    [told] = backup.find_all_store_problems(kept / STORE_FILE_NAME)
    assert told.startswith(make_row_label("offset_changes", 2))
    with Store.open(kept) as store:
        with raises_code(StoreError, "damaged-history", "entry 2"):
            store.offsets.tool_offsets.undo_last_step().result()
        assert store.offsets.tool_offsets.read_rows() == {
            3: ToolOffsetRow(x=-12.7, z=-2.5, wear_x=-0.02, remark="FINISHER")
        }


def test_deleted_history_entry_is_detected(kept: Path) -> None:
    spoil(kept, "DELETE FROM offset_changes WHERE id = 2")
    assert backup.find_all_store_problems(kept / STORE_FILE_NAME)[0].startswith(
        make_row_label("offset_changes", 2)
    )
    with Store.open(kept) as store, raises_code(StoreError, "damaged-history", "entry 2"):
        store.offsets.tool_offsets.undo_last_step().result()


def test_history_is_usable_after_a_damaged_entry(kept: Path, tmp_path: Path) -> None:
    spoil(kept, "UPDATE offset_changes SET old_x = -25.4 WHERE id = 2")
    with Store.open(kept) as store:
        store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": -0.03}).result()
        assert [row.new for row in store.offsets.tool_offsets.undo_last_step().result()] == [
            ToolOffsetRow(x=-12.7, z=-2.5, wear_x=-0.02, remark="FINISHER")
        ]
        assert [row.id for row in store.offsets.tool_offsets.read_history(limit=2)] == [4, 3]
        with raises_code(StoreError, "damaged-history", "entry 2"):
            store.offsets.tool_offsets.read_history()
        backup.back_up_store(kept, tmp_path / "still.db")  # it makes no backup worthless
    assert backup.find_store_problems(tmp_path / "still.db") == ()


# --- counts of runs, features, readings --------------------------------------------------------------------


def test_damaged_part_count_is_not_shown(kept: Path) -> None:
    spoil(kept, "UPDATE part_counts SET count = 168")
    with Store.open(kept) as store:
        assert [(row.program, row.parts, row.cycles) for row in store.runs.read_run_records()] == [
            ("pin.nc", 0, 1)
        ]
        assert store.runs.read_part_count("pin.nc") == 0
        [told] = store.find_damaged_rows()
    assert told.startswith(make_row_label("part_counts", "pin.nc"))


def test_damaged_run_record_is_restarted(kept: Path) -> None:
    spoil(kept, "UPDATE runs SET best = 1.25")
    with Store.open(kept, read_only=True) as store:
        assert store.runs.read_run_records() == (RunRow("pin.nc", 40),)
    with Store.open(kept) as store:
        [told] = store.repair_messages
        assert told.startswith(make_row_label("runs", "pin.nc"))
        store.runs.record_cycle("pin.nc", 34.0).result()
        assert [(row.cycles, row.best) for row in store.runs.read_run_records()] == [(1, 34.0)]
    assert backup.find_all_store_problems(kept / STORE_FILE_NAME) == ()


@pytest.mark.parametrize(
    ("damage", "readings"),
    [("nominal = 12.5", 2), ("grows = -1", 2), ("number = 19", 2), ("grows = 7", 0), ("nominal = 'x'", 0)],
)
def test_damaged_feature_proposes_no_wear(kept: Path, damage: str, readings: int) -> None:
    spoil(kept, f"UPDATE part_features SET {damage}")
    assert backup.find_store_problems(kept / STORE_FILE_NAME)
    with Store.open(kept) as store:
        [told] = store.repair_messages
        assert told.startswith(make_row_label("part_features", "pin.nc OD"))
        with store.read() as connection:
            assert measured_parts.read_features(connection) == ()
        again = store.write(lambda c: measured_parts.save_feature(c, PIN)).result()
        with store.read() as connection:
            assert [row.id for row in measured_parts.read_features(connection)] == [again]
            assert len(measured_parts.read_readings_between(connection, "0", "9")) == readings
    assert backup.find_all_store_problems(kept / STORE_FILE_NAME) == ()


def test_damaged_reading_is_not_counted(kept: Path) -> None:
    spoil(kept, "UPDATE part_readings SET value = 12.104 WHERE id = 2")
    with Store.open(kept) as store, store.read() as connection:
        assert [row.value for row in measured_parts.read_readings(connection, "pin.nc", 9)] == [12.001]
        assert len(measured_parts.read_readings_between(connection, "0", "9")) == 1
    [told] = backup.find_all_store_problems(kept / STORE_FILE_NAME)
    assert told.startswith(make_row_label("part_readings", 2))


def test_text_with_damaged_type_is_not_used(kept: Path) -> None:
    spoil(kept, "UPDATE tool_offsets SET remark = CAST(remark AS BLOB)")
    spoil(kept, "UPDATE settings SET value = CAST(value AS BLOB)")
    with Store.open(kept, read_only=True) as store:
        assert (store.offsets.tool_offsets.read_rows(), store.settings.read_setting("units")) == ({}, None)
    with Store.open(kept) as store:
        assert store.offsets.tool_offsets.read_rows()[3].remark == "FINISHER"
        [told] = store.find_damaged_rows()
        assert told.startswith(make_row_label("settings", "units"))


def test_checksum_with_damaged_key_type_is_reported(kept: Path) -> None:
    """The setting read as never set, and nobody said so."""
    spoil(kept, "UPDATE row_sums SET key = CAST(key AS BLOB) WHERE tbl = 'settings'")
    assert len(backup.find_store_problems(kept / STORE_FILE_NAME)) == 2
    with Store.open(kept) as store:
        [told] = store.find_damaged_rows()
        assert told.startswith(make_row_label("settings", "units"))
        assert store.settings.read_setting("units") is None
        store.settings.save_setting("units", "metric").result()
        assert (store.settings.read_setting("units"), store.find_damaged_rows()) == ("metric", ())
    assert backup.find_all_store_problems(kept / STORE_FILE_NAME) == ()


def test_rows_swapped_with_their_checksums_are_not_used(kept: Path) -> None:
    """The number of a tool is in its sum."""
    with Store.open(kept) as store:
        store.offsets.tool_offsets.change_row(5, "touched", {"x": -25.4, "z": -5.0}).result()
    for table, key in (("tool_offsets", "number"), ("row_sums", "key")):
        of_tools = " AND tbl = 'tool_offsets'" if table == "row_sums" else ""
        for before, after in ((3, 30), (5, 3), (30, 5)):
            spoil(kept, f"UPDATE {table} SET {key} = ? WHERE {key} = ?{of_tools}", after, before)
    with Store.open(kept, read_only=True) as store:
        assert store.offsets.tool_offsets.read_rows() == {}
        assert [text.split()[0] for text in store.find_damaged_rows()] == ["T3", "T5"]
    with Store.open(kept) as store:
        assert store.offsets.tool_offsets.read_rows() == {}
        assert store.repair_messages == ()


# --- events, programs and versions -------------------------------------------------------------------------


@pytest.fixture
def told_of(kept: Path) -> Path:
    """A row in each table of what only grows."""
    shared = "INSERT INTO shared_versions VALUES (?, 'pin.nc', ?, 4, '', 'LATHE 1', ?, 'saved', 0)"
    version = ("a" * 64, "b" * 64, "2026-11-29T10:00:00Z")
    cycle = "INSERT INTO part_cycles (key, program, started, offset_change) VALUES ('k', 'pin.nc', 'now', 0)"
    stop = "INSERT INTO production_stops VALUES (1, 'k', '', 'pin.nc', 'now', 3.0, 'hold', 7)"
    with Store.open(kept) as store:
        store.events.log_event("alarm", "X OVERTRAVEL", 12, author="ANNA").result()
        store.programs.save_version("pin.nc", b"M30\n", "written", author="ANNA").result()
        store.write(lambda c: c.execute(shared, version)).result()
        store.write(
            lambda c: c.execute("INSERT INTO shared_here VALUES (?, ?)", ("pin.nc", version[0]))
        ).result()
        store.write(lambda c: c.execute(cycle)).result()
        store.write(lambda c: c.execute(stop)).result()
    assert backup.find_all_store_problems(kept / STORE_FILE_NAME) == ()
    return kept


@pytest.mark.parametrize(
    ("table", "damage"),
    [
        ("events", "text = 'X OVERTRAVEM'"),
        ("events", "line = 13"),
        ("events", "at = '2025-11-29'"),
        ("events", "who = 'ANNB'"),
        ("programs", "name = 'pin.nb'"),
        ("programs", "created = '1926'"),
        ("program_versions", "saved = '1926'"),
        ("program_versions", "why = 'writtem'"),
        ("program_versions", "number = 9"),
        ("program_versions", "who = ''"),
        ("part_cycles", "seconds = 2.0"),
        ("production_stops", "reason = 'holf'"),
        ("shared_versions", "desk = 'LATHE 3'"),
        ("shared_versions", "published = 1"),
    ],
)
def test_verify_reports_damage_in_any_table(told_of: Path, table: str, damage: str) -> None:
    """Texts of events and rows of versions were looked at by nobody."""
    spoil(told_of, f"UPDATE {table} SET {damage} WHERE rowid = (SELECT max(rowid) FROM {table})")
    with closing(sqlite3.connect(told_of / STORE_FILE_NAME)) as connection:
        key = connection.execute(
            f"SELECT max({row_checksums.CHECKSUMMED_TABLES[table]}) FROM {table}"
        ).fetchone()[0]
    assert backup.find_store_problems(told_of / STORE_FILE_NAME) == ()  # it makes no backup worthless
    [told] = backup.find_all_store_problems(told_of / STORE_FILE_NAME)
    assert told.startswith(make_row_label(table, key))


@pytest.mark.parametrize("table", ["events", "programs", "part_cycles", "shared_here"])
def test_deleted_row_is_detected(told_of: Path, table: str) -> None:
    spoil(told_of, f"DELETE FROM {table} WHERE rowid = (SELECT max(rowid) FROM {table})")
    assert backup.find_all_store_problems(told_of / STORE_FILE_NAME)


def test_every_table_has_checksums(folder: Path) -> None:
    """A new table comes to the list of them."""
    with Store.open(folder) as store, store.read() as connection:
        tables = connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
    assert {name for (name,) in tables} - {"row_sums", "sqlite_sequence"} == set(
        row_checksums.CHECKSUMMED_TABLES
    )


# --- tables as they are made, and stores of before ---------------------------------------------------------


def test_damaged_default_value_of_column_is_reported(kept: Path) -> None:
    content = (kept / STORE_FILE_NAME).read_bytes()
    assert content.count(b"DEFAULT 0.9 ") == 1
    (kept / STORE_FILE_NAME).write_bytes(content.replace(b"DEFAULT 0.9 ", b"DEFAULT 0.1 "))
    [told] = backup.find_all_store_problems(kept / STORE_FILE_NAME)
    assert told == SCHEMA_CHANGED_MESSAGE


def test_older_store_gets_checksums_for_its_histories(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was damaged before stays so, and what had no sum yet is believed as it is."""
    with closing(sqlite3.connect(kept / STORE_FILE_NAME)) as connection:
        later = [
            table
            for table in row_checksums.CHECKSUMMED_TABLES
            if table not in row_checksums.list_tables_with_checksums(14)
        ]
        for table in (*later, "sqlite_master"):
            connection.execute("DELETE FROM row_sums WHERE tbl = ?", (table,))
        connection.execute("ALTER TABLE events DROP COLUMN message")
        connection.execute("PRAGMA user_version = 14")
        connection.commit()
    spoil(kept, "UPDATE part_counts SET count = 168")
    spoil(kept, "UPDATE runs SET best = 1.25")
    with Store.open(kept) as store:
        assert store.repair_messages == ()
        [told] = store.find_damaged_rows()
        assert told.startswith(make_row_label("part_counts", "pin.nc"))
        assert [row.best for row in store.runs.read_run_records()] == [1.25]
        assert len(store.offsets.tool_offsets.read_history()) == 2
    spoil(kept, "UPDATE offset_changes SET old_x = 7 WHERE id = 2")
    spoil(kept, "UPDATE part_counts SET count = 40")
    assert len(backup.find_all_store_problems(kept / STORE_FILE_NAME)) == 1
    assert database.check_store_file(kept / STORE_FILE_NAME, is_thorough=True) == len(
        database.load_migrations()
    )
