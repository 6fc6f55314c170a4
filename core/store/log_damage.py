"""Detection of lost changes in a damaged SQLite write-ahead log.

After a crash or a power failure, the latest changes exist only in the log. SQLite reads the log up to the
first entry with a wrong checksum and silently ignores the rest, so one flipped bit can undo later changes. An
unfinished change at the end of the log is not damage, because its write was never confirmed.
"""

from __future__ import annotations

import errno
import sqlite3
import struct
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from core.file_replacement import restrict_access, write_atomically
from core.message import Message
from core.store.store_connection import (
    connect_store,
    get_log_and_index_paths,
    has_write_ahead_log,
    is_open_for_writing,
)
from core.store.store_errors import StoreError, why

_HEAD = struct.Struct(">8I")  # magic, version, page size, sequence number, two salts, two checksums
_FRAME = struct.Struct(">6I")  # page number, number of pages after a commit, two salts, two checksums
_MAGIC = 0x377F0682  # the lowest bit is 1 if the checksums use big-endian words
_FRAME_COUNT_STRUCT = struct.Struct("=I")  # number of entries that SQLite accepts, stored in its index
_FRAME_COUNT_OFFSET = 16
_SMALLEST = 512  # bytes in the smallest page
_WORD = 0xFFFFFFFF

Pair = tuple[int, int]


class _LogFrame(NamedTuple):
    """An entry (frame) of the write-ahead log, with the data for its checksum.

    ``is_commit`` is True for the last entry of a change.
    """

    is_commit: bool
    salts: Pair
    sums: Pair
    checksummed_data: bytes  # page number and size, followed by the page


def count_lost_changes(log: Path, index: Path) -> int:
    """Return the number of complete changes in ``log`` that SQLite ignores according to its ``index``.

    While this function runs, a reader must have the store open, and no process may write to the store.
    Raises OSError if a file cannot be read or the index is too short.
    """
    with log.open("rb") as file:
        head, content = file.read(_HEAD.size), file.read()
    if len(content) < _FRAME.size + _SMALLEST:
        return 0
    magic, _, page, _, *rest = _HEAD.unpack(head)
    frames = _frames(content, page) if _SMALLEST <= page <= 65536 else []
    if not _has_valid_header(head, magic):
        return sum(frame.is_commit and frame.salts == frames[0].salts for frame in frames) or 1
    salts, sums = tuple(rest[:2]), tuple(rest[2:])
    with index.open("rb") as file:
        counted = file.read(_FRAME_COUNT_OFFSET + _FRAME_COUNT_STRUCT.size)
    if len(counted) < _FRAME_COUNT_OFFSET + _FRAME_COUNT_STRUCT.size:
        raise OSError(errno.EIO, "the index of the log is too short", str(index))
    (taken,) = _FRAME_COUNT_STRUCT.unpack_from(counted, _FRAME_COUNT_OFFSET)
    before = frames[taken - 1].sums if taken else sums
    tail = frames[taken:]
    ends = [at for at, frame in enumerate(tail) if frame.is_commit and _has_equal_salt(frame.salts, salts)]
    if len(ends) == 1 and _is_torn(tail[: ends[0] + 1], before, salts, _order(magic)):
        return 0
    return len(ends)


def _frames(content: bytes, page: int) -> list[_LogFrame]:
    step = _FRAME.size + page
    found = []
    for at in range(0, len(content) - step + 1, step):
        _, size, *rest = _FRAME.unpack_from(content, at)
        summed = content[at : at + 8] + content[at + _FRAME.size : at + step]
        found.append(_LogFrame(bool(size), (rest[0], rest[1]), (rest[2], rest[3]), summed))
    return found


def _has_equal_salt(its: Pair, salts: tuple[int, ...]) -> bool:
    """Return whether at least one of an entry's two salts matches the salts of the log.

    An entry of an earlier use of the log has two different salts. If one salt of a current entry is
    damaged, the other salt still matches.
    """
    return its[0] == salts[0] or its[1] == salts[1]


# --- A power failure during the last write leaves parts of it. The write was never confirmed, so this is not
# damage.


def _is_torn(frames: list[_LogFrame], previous_sums: Pair, salts: tuple[int, ...], order: str) -> bool:
    """Return whether parts of the last change were never written to the disk.

    The result is False if a single damaged word explains the wrong checksums. A disk writes whole sectors,
    whereas a bit that flips later affects one word and has a known effect on the checksums.
    """
    if not all(_has_equal_salt(frame.salts, salts) for frame in frames):
        return True
    wrong = []
    for frame in frames:
        one, two = _calculate_checksums(frame.checksummed_data, previous_sums, order)
        wrong.append(((frame.sums[0] - one) & _WORD, (frame.sums[1] - two) & _WORD))
        previous_sums = frame.sums
    bad = [at for at, each in enumerate(wrong) if each != (0, 0)]
    # the damaged checksum is also the start value of the next checksum
    if len(bad) == 2 and bad[1] == bad[0] + 1:
        return 0 not in wrong[bad[0]]
    return len(bad) > 1 or (
        len(bad) == 1 and not _is_one_word(wrong[bad[0]], len(frames[0].checksummed_data))
    )


def _is_one_word(checksum_differences: Pair, size: int) -> bool:
    """Return whether one damaged word of an entry or its checksum explains the checksum error."""
    if 0 in checksum_differences:
        return True
    effects = [(1, 1), (0, 1)]  # effects of the two words of the last pair on both checksums
    for _ in range(size // 8):
        if any((checksum_differences[0] * b - checksum_differences[1] * a) & _WORD == 0 for a, b in effects):
            return True
        effects = [((a + b) & _WORD, (a + 2 * b) & _WORD) for a, b in effects]
    return False


def _has_valid_header(head: bytes, magic: int) -> bool:
    """Return whether the header of a log matches its checksum."""
    return magic & ~1 == _MAGIC and _calculate_checksums(head[:24], (0, 0), _order(magic)) == struct.unpack(
        ">2I", head[24:]
    )


def _order(magic: int) -> str:
    return ">" if magic & 1 else "<"


def _calculate_checksums(checksummed_data: bytes, previous_sums: Pair, order: str) -> Pair:
    """Return SQLite's checksums over pairs of words, continued from ``previous_sums``."""
    one, two = previous_sums
    words = struct.unpack(f"{order}{len(checksummed_data) // 4}I", checksummed_data)
    for first, second in zip(words[::2], words[1::2], strict=True):
        one = (one + first + two) & _WORD
        two = (two + second + one) & _WORD
    return one, two


def check_log_is_readable(path: Path, reader: sqlite3.Connection) -> None:
    """Raise StoreError if changes in the log cannot be read and TurnDesk is not running.

    A running TurnDesk has already reported the damage. The check is then skipped, because it opens and
    closes SQLite's index (see ``database.check_store_header``).
    """
    if is_open_for_writing(path.parent):
        return
    lost = _changes_lost(path, reader)
    if lost:
        raise StoreError(
            Message(
                "{path}: the log of this database is damaged, and {lost} cannot be read. Start "
                "turndesk once to save a copy of the log and continue with the earlier data, "
                "or restore a backup",
                path=path,
                lost=_changes(lost),
            ),
            "damaged-log",
        )


def save_damaged_log(path: Path) -> tuple[str, ...]:
    """Save a copy of a log whose latest changes are lost, before the log is overwritten.

    The result is a message that reports the lost changes, or () if the log is intact. Raises StoreError if
    the log cannot be examined or emptied, or if the copy cannot be saved.
    """
    log, _ = get_log_and_index_paths(path)
    with closing(connect_store(path, is_read_only=True)) as reader:
        lost = _changes_lost(path, reader)
    if not lost:
        return ()
    kept = path.with_name(f"{path.stem}-damaged-log-{datetime.now(UTC):%Y%m%dT%H%M%SZ}")
    try:
        write_atomically(kept, log.read_bytes())
        restrict_access(kept)
    except OSError as error:
        raise why(kept, error) from error
    try:
        with closing(connect_store(path, is_read_only=False)) as writer:
            writer.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    except sqlite3.Error as error:
        raise why(path, error) from error
    return (
        (
            Message(
                "the log of the data store was damaged and lost {lost} made before the control shut "
                "down. Check offsets, counts and settings before you make a part; the log is saved "
                "as {saved}",
                lost=_changes(lost),
                saved=kept.name,
            )
        ),
    )


def _changes_lost(path: Path, reader: sqlite3.Connection) -> int:
    log, index = get_log_and_index_paths(path)
    if not has_write_ahead_log(path):
        return 0
    try:
        reader.execute(
            "SELECT count(*) FROM sqlite_master"
        ).fetchone()  # makes SQLite determine how much of the log is valid
        return count_lost_changes(log, index)
    except FileNotFoundError:
        return 0  # the writing process has just closed the log
    except (sqlite3.Error, OSError) as error:
        raise why(path, error) from error


def _changes(count: int) -> str:
    return "the last saved change" if count == 1 else Message("the last {count} saved changes", count=count)
