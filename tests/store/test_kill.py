"""Killed in the middle of writing: what was acknowledged is there, nothing is there by half."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from core.store import backup
from core.store.store import Store
from core.store.store_file import STORE_FILE_NAME

KILLS = 5
ACKNOWLEDGED = 25  # of each process before it is killed; the next transactions are then in flight

# One transaction writes a version of the program and an offset that must belong together.
WRITER = """
import sys
from pathlib import Path
from core.store import program_records
from core.store.offsets import offset_tables
from core.store.store_rows import OffsetKind
from core.store.store import Store

store = Store.open(Path(sys.argv[1]))
number = len(store.programs.list_versions("part"))

def both(connection):
    program_records.save_program_version(connection, "part", b"%d " % number * 2000, "kill")
    wanted = {"x": float(number % 1000)}
    reason = offset_tables.ChangeReason("kill", "test")
    offset_tables.change_row(connection, OffsetKind.TOOL, 1, reason, wanted)

while True:
    number += 1
    store.write(both).result()
    sys.stdout.write(f"{number}\\n")
    sys.stdout.flush()
"""


def _write_and_kill(folder: Path) -> int:
    """Starts a writer and kills it; answers the last number that it said was stored."""
    with subprocess.Popen([sys.executable, "-c", WRITER, str(folder)], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        told = [process.stdout.readline() for _ in range(ACKNOWLEDGED)]
        process.kill()
        told += process.stdout.read().splitlines(keepends=True)
    assert process.returncode == -9
    return int([line for line in told if line.endswith(b"\n")][-1])


def test_killed_writer_loses_no_acknowledged_change(folder: Path) -> None:
    for _ in range(KILLS):
        last = _write_and_kill(folder)
        assert backup.find_store_problems(folder / STORE_FILE_NAME) == ()
        with Store.open(folder, read_only=True) as store:
            versions = store.programs.list_versions("part")
            assert [row.number for row in versions] == list(range(len(versions), 0, -1))
            newest = versions[0].number
            assert newest in (last, last + 1)  # one may have been stored and not yet told
            assert store.programs.load_version("part") == b"%d " % newest * 2000
            assert store.offsets.tool_offsets.read_rows()[1].x == newest % 1000
            assert len(store.offsets.read_history(limit=10**6)) == newest
