"""Features, readings, tool lives, cycles and stops: kept, found again, exported, and not lost by a kill."""

from __future__ import annotations

import csv
import math
import subprocess
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from core.store import backup, database, store_connection
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_export import export_store
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import format_utc
from tests.coded import raises_code

SPIGOT = FeatureRow(0, "pin.nc", "SPIGOT", "diameter", 12.7, -0.02, 0.02, "tool", 3, 1, 10, 1)


def feature(store: Store, row: FeatureRow = SPIGOT) -> int:
    return store.write(lambda c: measured_parts.save_feature(c, row)).result(60)


def read(store: Store, of: int, part: int, value: float) -> int:
    row = ReadingRow(0, of, part, value, "mm", "", "typed", "")
    return store.write(lambda c: measured_parts.add_reading(c, row)).result(60)


def readings(store: Store, program: str = "pin.nc", limit: int = 100) -> list[ReadingRow]:
    with store.read() as connection:
        return list(measured_parts.read_readings(connection, program, limit))


def cycle(store: Store, key: str, part: int, **more: object) -> None:
    row = CycleRow(key, "pin.nc", part, f"2026-01-01T00:0{key}:00Z")._replace(**more)  # type: ignore[arg-type]
    store.write(lambda c: part_cycles.save_cycle(c, row)).result(60)


def test_feature_and_readings_are_listed_in_order_of_measurement(store: Store) -> None:
    of = feature(store)
    for part, value in ((1, 12.71), (3, 12.72), (2, 12.69)):
        read(store, of, part, value)
    assert [(row.part, row.value) for row in readings(store)] == [(1, 12.71), (3, 12.72), (2, 12.69)]
    assert [row.part for row in readings(store, limit=2)] == [3, 2], "the newest"
    with store.read() as connection:
        assert measured_parts.read_features(connection, "pin.nc") == (SPIGOT._replace(id=of),)
        assert measured_parts.read_features(connection, "other.nc") == ()


def test_removed_reading_is_not_counted_but_remains_in_file(store: Store) -> None:
    of = feature(store)
    wrong = read(store, of, 1, 99.0)
    read(store, of, 1, 12.7)
    store.write(lambda c: measured_parts.void_reading(c, wrong)).result(60)
    assert [row.value for row in readings(store)] == [12.7]
    with raises_code(StoreError, "already-removed"):
        store.write(lambda c: measured_parts.void_reading(c, wrong)).result(60)
    with store.read() as connection:
        assert connection.execute("SELECT count(*) FROM part_readings").fetchone() == (2,)


def test_retired_feature_frees_its_name_and_accepts_no_reading(store: Store) -> None:
    of = feature(store)
    store.write(lambda c: measured_parts.retire_feature(c, of)).result(60)
    with raises_code(StoreError, "feature-gone"):
        read(store, of, 1, 12.7)
    assert feature(store) != of


@pytest.mark.parametrize(
    ("row", "code", "value"),
    [
        (SPIGOT, "name-in-use", "SPIGOT"),
        (SPIGOT._replace(id=77, name="B"), "feature-gone", "B"),
        (SPIGOT._replace(name="B", number=33), "constraint", "number"),
        (SPIGOT._replace(name="B", low=1.0), "constraint", "high > low"),
        (SPIGOT._replace(name="B", kind="angle"), "constraint", "kind"),
    ],
)
def test_invalid_feature_is_rejected(store: Store, row: FeatureRow, code: str, value: str) -> None:
    feature(store)
    with raises_code(StoreError, code, value):
        feature(store, row)


def test_reading_that_is_not_a_number_is_rejected(store: Store) -> None:
    with raises_code(StoreError, "not-a-number"):
        read(store, feature(store), 1, math.nan)


def test_reading_is_linked_to_offsets_used_for_its_part(store: Store) -> None:
    """Part 1 before the wear, part 2 begun before it and ended after, part 3 after; part 9 is unknown."""
    of = feature(store)
    store.offsets.tool_offsets.change_row(3, "touched off", {"x": 1.0, "z": 2.0}).result(60)
    cycle(store, "1", 1)
    cycle(store, "2", 0)
    store.offsets.tool_offsets.change_row(3, "wear", {"wear_x": -0.01}).result(60)
    cycle(store, "2", 2, ended="2026-01-01T00:03:00Z")
    cycle(store, "3", 3)
    for part in (1, 2, 3, 9):
        read(store, of, part, 12.7)
    with store.read() as connection:
        last = measured_parts.read_last_corrections(connection)[("tool", 3, "x")]
        assert measured_parts.read_last_corrections(connection)[("tool", 3, "z")] < last, (
            "Z was only touched off"
        )
    known = [(row.part, row.offset_change) for row in readings(store)]
    assert [part for part, change in known if change >= last] == [3]
    assert known[-1] == (9, -1)


def test_corrections_are_listed_between_the_parts(store: Store) -> None:
    store.offsets.tool_offsets.change_row(3, "touched off", {"x": 1.0, "z": 2.0}).result(60)
    for part in (1, 2):
        cycle(store, str(part), part)
    store.offsets.tool_offsets.change_row(3, "wear", {"wear_x": -0.01}).result(60)
    cycle(store, "3", 3)
    store.offsets.tool_offsets.change_row(3, "remark", {"remark": "new"}).result(60)
    store.offsets.secondary_offsets.change_row(4, "D", {"x": 0.02}).result(60)
    with store.read() as connection:
        rows = part_cycles.read_corrections(connection, "pin.nc", 100)
    assert [(row.kind, row.number, row.was_x, row.x, row.part) for row in rows] == [
        ("tool", 3, 0.0, -0.01, 2),
        ("secondary", 4, 0.0, 0.02, 3),
    ]


def test_cycles_and_stops_are_stored(store: Store) -> None:
    cycle(store, "1", 0)
    cycle(store, "1", 1, ended="2026-01-01T00:02:00Z", seconds=58.5, outcome="COMPLETE")
    stop = ProductionStopRow("s1", "1", "pin.nc", "2026-01-01T00:01:30Z", 4.5, "FEED HOLD", 7)
    store.write(lambda c: part_cycles.save_stop(c, stop)).result(60)
    with store.read() as connection:
        (row,) = part_cycles.read_cycles(connection, "pin.nc", 10)
        assert (row.part, row.seconds, row.load) == (1, 58.5, None)
        assert part_cycles.read_stops(connection, None, 10) == (stop,)
        assert part_cycles.read_stops(connection, "other.nc", 10) == ()


def test_cycles_of_a_day_include_all_programs(store: Store) -> None:
    now = datetime.now(UTC)
    at = {hours: format_utc(now - timedelta(hours=hours)) for hours in (1, 2, 47, 49)}
    for hours, program in ((1, "other.nc"), (2, "pin.nc"), (47, "other.nc"), (49, "pin.nc")):
        started = at[hours]
        cycle(store, f"{hours}", 1, program=program, started=started, ended=started, seconds=8.0)
    with store.read() as connection:
        day = part_cycles.read_cycle_times_since(connection, format_utc(now - timedelta(hours=48)))
        assert {row.started for row in day} == {at[1], at[2], at[47]}
        assert {row.key for row in part_cycles.read_cycles(connection, "pin.nc", 10)} == {"2", "49"}


def test_insert_change_is_stored_with_parts_made(store: Store) -> None:
    store.write(lambda c: tool_lives.save_tool_life_limits(c, ToolLifeRow(3, 50, 1800.0, 0.8, True))).result(
        60
    )
    store.write(lambda c: tool_lives.save_insert_use(c, 3, 50, 1200.5)).result(60)
    with store.read() as connection:
        assert tool_lives.read_tool_lives(connection) == {
            3: ToolLifeRow(3, 50, 1800.0, 0.8, True, 50, 1200.5)
        }
    store.write(lambda c: tool_lives.record_insert_change(c, 3, "spent")).result(60)
    store.write(lambda c: tool_lives.record_insert_change(c, 7, "by eye")).result(60)
    with store.read() as connection:
        assert tool_lives.read_tool_lives(connection)[3] == ToolLifeRow(3, 50, 1800.0, 0.8, True, 0, 0.0)
        told = [
            (row.number, row.parts, row.seconds, row.why)
            for row in tool_lives.read_insert_changes(connection, 9)
        ]
    assert told == [(7, 0, 0.0, "by eye"), (3, 50, 1200.5, "spent")]


@pytest.mark.parametrize("number", [0, 33])
def test_tool_life_of_unknown_tool_is_rejected(store: Store, number: int) -> None:
    for operation in (
        lambda c: tool_lives.save_tool_life_limits(c, ToolLifeRow(number, 5)),
        lambda c: tool_lives.record_insert_change(c, number, ""),
    ):
        with raises_code(StoreError, "unknown-tool", f"T{number}"):
            store.write(operation).result(60)


def test_renamed_program_retains_measurements_and_cycles(store: Store) -> None:
    read(store, feature(store), 1, 12.7)
    cycle(store, "1", 1)
    store.programs.rename_program("pin.nc", "axle.nc").result(60)
    assert [row.value for row in readings(store, "axle.nc")] == [12.7]
    assert readings(store) == []
    with store.read() as connection:
        assert len(part_cycles.read_cycles(connection, "axle.nc", 9)) == 1


def test_features_with_same_name_in_two_programs_are_separate(store: Store) -> None:
    feature(store)
    feature(store, SPIGOT._replace(program="axle.nc"))
    store.programs.rename_program("pin.nc", "axle.nc").result(60)
    with store.read() as connection:
        assert [row.program for row in measured_parts.read_features(connection)] == ["axle.nc", "pin.nc"]


def test_export_and_backup_contain_measurements(store: Store, folder: Path, tmp_path: Path) -> None:
    read(store, feature(store), 7, 12.7)
    export_store(store, tmp_path / "out")
    with (tmp_path / "out" / "readings.csv").open(newline="", encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert (row["part"], row["value"], row["source"]) == ("7", "12.7", "typed")
    assert (tmp_path / "out" / "tool_lives.csv").read_text(encoding="utf-8").startswith("number,limit_parts,")
    backup.back_up_store(folder, tmp_path / "copy.db")
    assert backup.find_store_problems(tmp_path / "copy.db") == ()


def test_reading_without_its_feature_is_reported(store: Store, folder: Path) -> None:
    read(store, feature(store), 1, 12.7)
    store.close()
    with store_connection.connect_store(folder / STORE_FILE_NAME, is_read_only=False) as connection:
        connection.execute("PRAGMA foreign_keys = OFF")
        connection.execute("DELETE FROM part_features")
    assert any("part_readings" in problem for problem in backup.find_store_problems(folder / STORE_FILE_NAME))


def test_gap_in_migration_numbers_is_rejected(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A store that has counted past it would never get it."""
    for name in ("0001_a.sql", "0003_b.sql"):
        (tmp_path / name).write_text("SELECT 1;")
    monkeypatch.setattr(database, "_MIGRATIONS", tmp_path)
    with pytest.raises(RuntimeError, match=r"\[1, 3\]"):
        database.load_migrations()


WRITER = """
import sys
from pathlib import Path
from core.store.production import measured_parts, part_cycles
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow
from core.store.store import Store

store = Store.open(Path(sys.argv[1]))
row = FeatureRow(0, "pin.nc", "D", "diameter", 10.0, -0.1, 0.1, "tool", 1, 1, 0, 1)
of = store.write(lambda c: measured_parts.save_feature(c, row)).result()
number = 0
while True:
    number += 1
    cycle = CycleRow(str(number), "pin.nc", number, "2026", "2026", 1.0, "COMPLETE")
    save = lambda c: part_cycles.save_cycle(c, cycle)
    store.keep(lambda u: u.replace_operation(("cycle", cycle.key), save)).result()
    reading = ReadingRow(0, of, number, 10.0 + number, "mm", "", "typed", "")
    store.write(lambda c: measured_parts.add_reading(c, reading)).result()
    sys.stdout.write(f"{number}\\n")
    sys.stdout.flush()
"""


def test_kill_loses_no_acknowledged_reading(folder: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", WRITER, str(folder)], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        told = [process.stdout.readline() for _ in range(25)]
        process.kill()
        told += process.stdout.read().splitlines(keepends=True)
    last = int([line for line in told if line.endswith(b"\n")][-1])
    assert backup.find_store_problems(folder / STORE_FILE_NAME) == ()
    with Store.open(folder, read_only=True) as store:
        kept = readings(store, limit=10**6)
        assert len(kept) in (last, last + 1)
        assert [row.value for row in kept] == [10.0 + number for number in range(1, len(kept) + 1)]
        with store.read() as connection:
            assert len(part_cycles.read_cycles(connection, None, 10**6)) >= last
