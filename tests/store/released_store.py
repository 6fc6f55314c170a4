"""Stores of released versions as text: ``python -m tests.store.released_store`` writes that of this version.

The text is an SQL dump with the pragmas that identify a store. A released version has one file, which never
changes; the tests open it with the present version.
"""

from __future__ import annotations

import sqlite3
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import Future
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

from app import VERSION
from core.store.production import measured_parts, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.store import Store
from core.store.store_file import STORE_FILE_NAME
from core.store.user_records import UserRow

RELEASED = Path(__file__).with_name("released")
_PRAGMAS = ("application_id", "user_version")
AT = "2026-12-01T08:30:00.000Z"


def fill(store: Store) -> None:
    """Write something to each subject of a new store."""
    feature = FeatureRow(0, "peg.nc", "SPIGOT", "diameter", 12.7, -0.05, 0.05, "tool", 1, 1, 0, 1)
    of = store.write(partial(measured_parts.save_feature, row=feature)).result(60)
    reading = ReadingRow(0, of, 1, 12.69, "in", AT, "gauge", "mic")
    waiting: list[Future[Any]] = [
        store.write(partial(measured_parts.add_reading, row=reading)),
        store.write(partial(tool_lives.save_tool_life_limits, row=tool_lives.ToolLifeRow(1, 50))),
        store.offsets.tool_offsets.change_row(1, "first", {"x": 1.25, "z": -0.5}),
        store.offsets.tool_offsets.change_row(1, "wear", {"wear_x": -0.004}),
        store.programs.save_version("peg.nc", b"G90\nX1.25\nM30\n", "saved"),
        store.runs.record_run_start("peg.nc"),
        store.runs.add_parts("peg.nc"),
        store.cycles.record_row(CycleRow("c1", "peg.nc", 1, AT, AT, 50.0, "COMPLETE")),
        store.cycles.record_row(ProductionStopRow("s1", "c1", "peg.nc", AT, 4.0, "FEED HOLD", 7)),
        store.jobs.add_job("peg.nc", 3),
        store.events.log_event("start", "peg.nc"),
        store.settings.save_setting("theme", "dark"),
        store.people.save_user(UserRow("ANNA", 3, b"salt", b"hash")),
    ]
    for each in waiting:
        each.result(60)


def dump(path: Path) -> str:
    """Return a closed store as text."""
    with closing(sqlite3.connect(path)) as connection:
        pragmas = [
            f"PRAGMA {name} = {connection.execute(f'PRAGMA {name}').fetchone()[0]};" for name in _PRAGMAS
        ]
        return "\n".join([*pragmas, *connection.iterdump(), ""])


def restore(text: str, folder: Path) -> Path:
    """Create the store of a text in a new folder, and return its path."""
    folder.mkdir(mode=0o700)
    path = folder / STORE_FILE_NAME
    with closing(sqlite3.connect(path)) as connection:
        connection.executescript(text)
    path.chmod(0o600)
    return path


def main(argv: Sequence[str]) -> int:
    """Write the store of this version, or to the folder that is named."""
    folder = Path(argv[0]) if argv else RELEASED
    with tempfile.TemporaryDirectory() as work:
        with Store.open(Path(work)) as store:
            fill(store)
        (folder / f"{VERSION}.sql").write_text(dump(Path(work) / STORE_FILE_NAME), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
