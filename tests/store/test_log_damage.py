"""The log that a kill or a power cut leaves: what SQLite passes over in it without a word is told."""

from __future__ import annotations

import errno
import shutil
import sqlite3
import struct
from pathlib import Path
from typing import Any, NoReturn

import pytest

from core.store import backup, log_damage, store_connection
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_file import STORE_FILE_NAME
from tests.coded import raises_code
from tests.texts import text

LOG = f"{STORE_FILE_NAME}-wal"
FRAME = 24 + 4096


@pytest.fixture
def killed(tmp_path: Path) -> Path:
    """As it is found behind a kill: a whole store, and four wears that stand in the log alone."""
    home, found = tmp_path / "home", tmp_path / "found"
    with Store.open(home) as store:
        store.offsets.tool_offsets.change_row(3, "touched", {"x": -12.7, "z": -2.5}).result()
    with Store.open(home) as store:
        for number in range(1, 5):
            store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": -0.01 * number}).result()
        found.mkdir()
        for name in (STORE_FILE_NAME, LOG):
            shutil.copy(home / name, found)
    return found


def flip(found: Path, at: int) -> None:
    content = bytearray((found / LOG).read_bytes())
    content[at] ^= 1
    (found / LOG).write_bytes(content)


def commits(found: Path) -> list[int]:
    """Where the entries stand that end a change."""
    content = (found / LOG).read_bytes()
    places = range(32, len(content), FRAME)
    return [at for at in places if struct.unpack_from(">I", content, at + 4)[0]]


def left_beside(found: Path) -> list[str]:
    return [path.name for path in found.iterdir() if "damaged-log" in path.name]


def test_a_whole_log_is_read_to_its_end(killed: Path) -> None:
    assert len(commits(killed)) == 4
    assert backup.find_store_problems(killed / STORE_FILE_NAME) == ()
    with Store.open(killed) as store:
        assert (store.offsets.tool_offsets.read_rows()[3].wear_x, store.repair_messages) == (-0.04, ())
    assert left_beside(killed) == []


def test_unfinished_change_is_not_damage(killed: Path, tmp_path: Path) -> None:
    """Nobody was told that it is kept: cut off at any byte before the entry that ends it is complete."""
    whole, last = (killed / LOG).read_bytes(), commits(killed)[-1]
    for end in (last + FRAME - 1, last + 24, last + 3, last, last - 1, last - FRAME + 7):
        there = tmp_path / str(end)
        shutil.copytree(killed, there)
        (there / LOG).write_bytes(whole[:end])
        with Store.open(there) as store:
            assert (store.offsets.tool_offsets.read_rows()[3].wear_x, store.repair_messages) == (-0.03, ())


@pytest.mark.parametrize("at", [0, 5, 12, 17, 21, 25, 31, 32 + 9, 32 + 13, 32 + 17, 32 + 24, 32 + 3000])
def test_flipped_bit_in_log_reverts_nothing_without_a_report(killed: Path, at: int) -> None:
    """SQLite alone goes back to the offset of before, and calls the store whole."""
    flip(killed, at)
    content = (killed / LOG).read_bytes()
    with raises_code(StoreError, "damaged-log", text("log.lost-changes", count=4)):
        backup.find_store_problems(killed / STORE_FILE_NAME)
    with raises_code(StoreError, "damaged-log"):
        Store.open(killed, read_only=True)
    with Store.open(killed) as store:
        [told] = store.repair_messages
        assert store.offsets.tool_offsets.read_rows()[3].wear_x == 0.0
        assert store.events.read_events()[0].text == told
    assert text("log.lost-changes", count=4) in told
    [kept] = left_beside(killed)
    assert kept in told
    assert (killed / kept).read_bytes() == content


def test_damage_to_last_change_is_detected(killed: Path) -> None:
    flip(killed, commits(killed)[-1] + 24 + 100)
    with Store.open(killed) as store:
        assert left_beside(killed)[0] in store.repair_messages[0]
        assert store.offsets.tool_offsets.read_rows()[3].wear_x == -0.03


def test_log_damage_is_reported_once(killed: Path) -> None:
    flip(killed, 32 + 3000)
    with Store.open(killed) as store:
        store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": -0.05}).result()
    with Store.open(killed) as store:
        assert (store.repair_messages, store.offsets.tool_offsets.read_rows()[3].wear_x) == ((), -0.05)
    assert backup.find_store_problems(killed / STORE_FILE_NAME) == ()
    assert len(left_beside(killed)) == 1


def test_reader_is_not_blocked_by_running_writer(killed: Path) -> None:
    """What its log holds is that desk's; a change that is just being written is no damage."""
    with Store.open(killed) as store:
        store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": -0.05}).result()
        log = bytearray((killed / LOG).read_bytes())
        torn = struct.pack(">II", 2, 9) + bytes(log[16:24]) + bytes(FRAME - 16)
        with (killed / LOG).open("ab") as file:
            file.write(torn)
        assert store_connection.is_open_for_writing(killed)
        with Store.open(killed, read_only=True) as beside:
            assert beside.offsets.tool_offsets.read_rows()[3].wear_x == -0.05
    assert not store_connection.is_open_for_writing(killed)


# --- a power cut within a write that was never acknowledged ---------------------------------------------


def last_change(found: Path) -> range:
    """The bytes of the last change in the log."""
    *_, before, last = commits(found)
    return range(before + FRAME, last + FRAME)


def torn(found: Path, at: int, sectors: int, with_what: bytes) -> None:
    """Sectors of the log that the disk did not write any more."""
    content = bytearray((found / LOG).read_bytes())
    start = at // 512 * 512
    content[start : start + 512 * sectors] = with_what * (512 * sectors)
    (found / LOG).write_bytes(content)


@pytest.mark.parametrize("with_what", [b"\0", b"o"])
@pytest.mark.parametrize(("frame", "sectors"), [(0, 3), (0, 8), (1, 3), (1, 9), (-1, 3)])
def test_missing_sectors_of_last_change_are_not_damage(
    killed: Path, frame: int, sectors: int, with_what: bytes
) -> None:
    """It was reported as a damaged log with a lost change, and nobody was told that the change is kept."""
    places = range(last_change(killed).start, last_change(killed).stop, FRAME)
    torn(killed, places[frame] + FRAME - 1400, sectors, with_what)  # cells are at the end of a page
    assert backup.find_store_problems(killed / STORE_FILE_NAME) == ()
    with Store.open(killed, read_only=True) as store:
        assert store.offsets.tool_offsets.read_rows()[3].wear_x == -0.03
    with Store.open(killed) as store:
        assert (store.offsets.tool_offsets.read_rows()[3].wear_x, store.repair_messages) == (-0.03, ())
    assert left_beside(killed) == []


def test_missing_entry_of_last_change_is_not_damage(killed: Path) -> None:
    content = bytearray((killed / LOG).read_bytes())
    start = last_change(killed).start
    content[start : start + FRAME] = bytes(FRAME)
    (killed / LOG).write_bytes(content)
    with Store.open(killed) as store:
        assert (store.offsets.tool_offsets.read_rows()[3].wear_x, store.repair_messages) == (-0.03, ())


@pytest.mark.parametrize("into", [0, 5, 9, 13, 17, 21, 24, 27, 600, 2001, 24 + 4095])
@pytest.mark.parametrize("frame", [0, 1, -1])
def test_missing_byte_of_acknowledged_change_is_detected(killed: Path, frame: int, into: int) -> None:
    """Whatever entry of it, whatever of the entry: its head, its salts, its sums, its page."""
    places = range(last_change(killed).start, last_change(killed).stop, FRAME)
    content = bytearray((killed / LOG).read_bytes())
    content[places[frame] + into] ^= 0xA5
    (killed / LOG).write_bytes(content)
    with raises_code(StoreError, "damaged-log"):
        Store.open(killed, read_only=True)


def test_missing_sectors_of_earlier_change_are_damage(killed: Path) -> None:
    """A change is acknowledged before the next one is written."""
    torn(killed, commits(killed)[1] + 600, 2, b"o")
    with raises_code(StoreError, "damaged-log", text("log.lost-changes", count=3)):
        backup.find_store_problems(killed / STORE_FILE_NAME)


def test_log_with_header_only_has_lost_nothing(killed: Path) -> None:
    (killed / LOG).write_bytes(bytes(32))
    with Store.open(killed) as store:
        assert (store.offsets.tool_offsets.read_rows()[3].wear_x, store.repair_messages) == (0.0, ())


def test_log_entry_of_an_earlier_round_is_not_reported_missing(killed: Path) -> None:
    """SQLite begins at the front again, and what stood there behind it stays: with other salts."""
    content = bytearray((killed / LOG).read_bytes())
    old = bytearray(content[32 : 32 + FRAME])
    old[8:16] = bytes(8)
    (killed / LOG).write_bytes(content + old)
    with Store.open(killed) as store:
        assert (store.offsets.tool_offsets.read_rows()[3].wear_x, store.repair_messages) == (-0.04, ())


# --- a log that the system or SQLite does not let be read -------------------------------------------------


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (PermissionError(errno.EACCES, "Permission denied"), "forbidden"),
        (OSError(errno.EIO, "Input/output error"), "disk-failing"),
    ],
)
def test_log_that_cannot_be_read_is_an_error_of_the_store(
    killed: Path, monkeypatch: pytest.MonkeyPatch, error: OSError, code: str
) -> None:
    def fail(*_paths: Path) -> NoReturn:
        raise error

    monkeypatch.setattr(log_damage, "count_lost_changes", fail)
    with raises_code(StoreError, code):
        backup.find_store_problems(killed / STORE_FILE_NAME)
    with raises_code(StoreError, code):
        Store.open(killed, read_only=True)
    with raises_code(StoreError, code):
        Store.open(killed)


def test_log_that_its_writer_removes_meanwhile_has_lost_nothing(
    killed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_paths: Path) -> NoReturn:
        raise FileNotFoundError(errno.ENOENT, "No such file or directory")

    monkeypatch.setattr(log_damage, "count_lost_changes", fail)
    assert backup.find_store_problems(killed / STORE_FILE_NAME) == ()


@pytest.mark.parametrize("size", [0, 16, 19])
def test_index_that_is_too_short_is_an_error(killed: Path, tmp_path: Path, size: int) -> None:
    index = tmp_path / "index"
    index.write_bytes(bytes(size))
    with pytest.raises(OSError, match="too short"):
        log_damage.count_lost_changes(killed / LOG, index)


def test_damaged_log_that_cannot_be_emptied_is_an_error_of_the_store(
    killed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:

    class Full(sqlite3.Connection):
        def execute(self, sql: str, *values: Any) -> NoReturn:
            del sql, values
            error = sqlite3.OperationalError("database or disk is full")
            error.sqlite_errorcode = sqlite3.SQLITE_FULL
            raise error

    def connect_full(path: Path, *, is_read_only: bool) -> sqlite3.Connection:
        return store_connection.connect_store(path, is_read_only=True) if is_read_only else Full(":memory:")

    monkeypatch.setattr(log_damage, "connect_store", connect_full)
    flip(killed, 32 + 3000)
    content = (killed / LOG).read_bytes()
    with raises_code(StoreError, "disk-full"):
        Store.open(killed)
    [kept] = left_beside(killed)
    assert (killed / kept).read_bytes() == content
