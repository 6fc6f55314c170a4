"""A store whose bytes and cells were changed: refused, or told row by row, and never a traceback."""

from __future__ import annotations

import random
import shutil
import sqlite3
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing, suppress
from functools import cache, partial
from pathlib import Path

from app.production.parts_book import read_production_data
from core.store import backup
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_export import export_store
from core.store.store_file import STORE_FILE_NAME, make_stock_setting_key
from core.store.store_rows import OffsetKind
from tests.fuzz.fuzz_target import Target

_EDIT = 6  # bytes of one change
_CELLS = (None, 0, -1, 2**63 - 1, 1e308, float("inf"), "x", "", "{", b"\xff\x00", "1", True, 33, "a\nb")


@cache
def _good() -> Path:
    """The folder of a store that has something in each table."""
    fast = Path("/dev/shm")
    home = Path(tempfile.mkdtemp(prefix="fuzz-store-", dir=fast if fast.is_dir() else None)) / "good"
    with Store.open(home) as store:
        for number in (1, 3, 101):
            store.offsets.tool_offsets.change_row(
                number % 32 + 1, "touched off", {"x": 1.0 * number, "z": -2.0}
            ).result()
        store.offsets.secondary_offsets.change_row(2, "worn", {"x": -0.01}).result()
        store.programs.save_version("part.nc", b"G90\nM30\n" * 100, "written").result()
        store.events.log_event("alarm", "alarm 101 x line 3: X", 3).result()
        store.runs.add_parts("part.nc").result()
        store.runs.record_run_start("part.nc").result()
        store.settings.save_setting("target:part.nc", 10).result()
        row = FeatureRow(0, "part.nc", "PIN", "diameter", 10.0, -0.1, 0.1, "tool", 1, 1, 0, 1)
        store.write(lambda c: measured_parts.save_feature(c, row)).result()
        reading = ReadingRow(0, 1, 1, 10.0, "mm", "", "typed", "")
        store.write(lambda c: measured_parts.add_reading(c, reading)).result()
        store.write(lambda c: tool_lives.save_tool_life_limits(c, ToolLifeRow(1, limit_parts=5))).result()
    return home


def good_store() -> bytes:
    """Return a backup of it."""
    copy = _good().with_name("copy.db")
    backup.back_up_store(_good(), copy)
    return copy.read_bytes()


def _spoilt(data: bytes) -> Path:
    """A copy with the changes that the bytes tell: of a cell, or of a byte of the file."""
    home = _good().with_name("spoilt")
    shutil.rmtree(home, ignore_errors=True)
    shutil.copytree(_good(), home)
    path = home / STORE_FILE_NAME
    flips = []
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        tables = [row[0] for row in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        for at in range(0, len(data) - _EDIT + 1, _EDIT):
            which, table, row, column, value, _ = data[at : at + _EDIT]
            if which & 1:
                flips.append(data[at + 1 : at + _EDIT])
                continue
            with suppress(sqlite3.Error, ZeroDivisionError):  # a table without rows
                name = tables[table % len(tables)]
                columns = [each[1] for each in connection.execute(f"PRAGMA table_info({name})")]
                rows = [each[0] for each in connection.execute(f"SELECT rowid FROM {name}")]
                connection.execute(
                    f"UPDATE {name} SET {columns[column % len(columns)]} = ? WHERE rowid = ?",
                    (_CELLS[value % len(_CELLS)], rows[row % len(rows)]),
                )
    content = bytearray(path.read_bytes())
    for flip in flips:
        content[int.from_bytes(flip[:4], "big") % len(content)] ^= flip[4]
    path.write_bytes(content)
    return home


def _measured(store: Store) -> None:
    """Read everything that is kept of measured parts."""
    with store.read() as connection:
        measured_parts.read_features(connection, "part.nc")
        measured_parts.read_readings(connection, "part.nc", 1000)
        measured_parts.read_last_corrections(connection)
        part_cycles.read_cycles(connection, "part.nc", 1000)
        part_cycles.read_stops(connection, None, 1000)
        part_cycles.read_corrections(connection, "part.nc", 1000)
        part_cycles.read_cycle_times_since(connection, "2026-01-01T00:00:00Z")
    for tools in (OffsetKind.TOOL, OffsetKind.MILL_TOOL):
        read_production_data(store, "part.nc", tools, {})


def _read(data: bytes) -> Iterator[str]:
    """Opened as the desk opens it, and everything read that a page shows; each may refuse in a sentence."""
    home = _spoilt(data)
    with suppress(StoreError):
        yield from backup.find_store_problems(home / STORE_FILE_NAME)
    with Store.open(home) as store:
        yield from store.repair_messages
        yield from store.find_damaged_rows()
        readers: tuple[Callable[[], object], ...] = (
            *(store.offsets.get_table(kind).read_rows for kind in OffsetKind),
            *(partial(store.offsets.get_table(kind).read_history, 50) for kind in OffsetKind),
            store.programs.list_programs, lambda: store.programs.list_versions("part.nc"),
            lambda: store.programs.load_version("part.nc"), store.events.read_events,
            store.runs.read_run_records, store.jobs.read_jobs, lambda: store.runs.read_part_count("part.nc"),
            lambda: store.settings.read_setting("target:part.nc"),
            lambda: store.settings.read_setting("under_way"),
            lambda: store.settings.read_setting(make_stock_setting_key("part.nc")), lambda: _measured(store),
            lambda: export_store(store, home / "out"),
            lambda: store.offsets.tool_offsets.change_row(5, "x", {"x": 1.0}).result(),
            lambda: store.runs.add_parts("part.nc").result(), lambda: store.offsets.undo_last_step().result(),
            lambda: store.programs.rename_program("part.nc", "other.nc").result(),
            lambda: backup.back_up_store(home, home / "copy.db"),
        )  # fmt: skip
        for reader in readers:
            try:
                reader()
            except StoreError as error:
                yield str(error)


def _edits(data: bytes, chance: random.Random) -> bytes:
    """Another change behind those that are there, mostly of a cell."""
    edit = bytes([chance.randrange(8) == 0, *(chance.randrange(256) for _ in range(_EDIT - 1))])
    return data[: chance.randrange(8) * _EDIT] + edit


def _seeds() -> Iterable[bytes]:
    return (bytes(_EDIT), bytes([1, 0, 0, 0, 24, 255]), bytes([0, 1, 0, 2, 6, 0]), b"")


STORE = Target("store file", _seeds, _read, (StoreError,), _edits)
