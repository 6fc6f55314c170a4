"""Detection of lost changes in a damaged SQLite write-ahead log.

After a crash or a power failure, the latest changes exist only in the log. SQLite reads the log up to the
first entry with a wrong checksum and silently ignores the rest, so one flipped bit can undo later changes. An
unfinished change at the end of the log is not damage, because its write was never confirmed.
"""

from __future__ import annotations

import sqlite3
import struct
from contextlib import closing
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from core.file_placing import restrict, write_in_place
from core.message import Message
from core.store.store_connection import companions, connect, has_log, in_use
from core.store.store_errors import StoreError, why

_HEAD = struct.Struct(">8I")  # magic, version, page size, sequence number, two salts, two checksums
_FRAME = struct.Struct(">6I")  # page number, number of pages after a commit, two salts, two checksums
_MAGIC = 0x377F0682  # the lowest bit is 1 if the checksums use big-endian words
_TAKEN = struct.Struct("=I")  # number of entries that SQLite accepts, stored in its index
_TAKEN_AT = 16
_SMALLEST = 512  # bytes in the smallest page
_WORD = 0xFFFFFFFF

Pair = tuple[int, int]


class _Frame(NamedTuple):
    """An entry of the log, with the data from which its checksum is calculated.

    ``ends`` is true for the last entry of a change.
    """

    ends: bool
    salts: Pair
    sums: Pair
    summed: bytes  # page number and size, followed by the page


def lost_changes(log: Path, index: Path) -> int:
    """Return the number of complete changes in ``log`` that SQLite ignores according to its ``index``.

    A reader must have the store open, and no process may write the store. Raises OSError if a file cannot be
    read.
    """
    with log.open("rb") as file:
        head, content = file.read(_HEAD.size), file.read()
    if len(content) < _FRAME.size + _SMALLEST:
        return 0
    magic, _, page, _, *rest = _HEAD.unpack(head)
    frames = _frames(content, page) if _SMALLEST <= page <= 65536 else []
    if not _is_whole(head, magic):
        return sum(frame.ends and frame.salts == frames[0].salts for frame in frames) or 1
    salts, sums = tuple(rest[:2]), tuple(rest[2:])
    taken = _TAKEN.unpack_from(index.read_bytes()[: _TAKEN_AT + _TAKEN.size], _TAKEN_AT)[0]
    before = frames[taken - 1].sums if taken else sums
    behind = frames[taken:]
    ends = [at for at, frame in enumerate(behind) if frame.ends and _one_is_equal(frame.salts, salts)]
    if len(ends) == 1 and _is_torn(behind[: ends[0] + 1], before, salts, _order(magic)):
        return 0
    return len(ends)


def _frames(content: bytes, page: int) -> list[_Frame]:
    step = _FRAME.size + page
    found = []
    for at in range(0, len(content) - step + 1, step):
        _, size, *rest = _FRAME.unpack_from(content, at)
        summed = content[at : at + 8] + content[at + _FRAME.size : at + step]
        found.append(_Frame(bool(size), (rest[0], rest[1]), (rest[2], rest[3]), summed))
    return found


def _one_is_equal(its: Pair, salts: tuple[int, ...]) -> bool:
    """Return whether one of two salts matches the log's salts.

    An entry of an earlier use of the log has two different salts. An entry with one damaged salt still has
    one that matches.
    """
    return its[0] == salts[0] or its[1] == salts[1]


# --- A power failure during the last write leaves parts of it. The write was never confirmed, so this is not
# damage.


def _is_torn(frames: list[_Frame], before: Pair, salts: tuple[int, ...], order: str) -> bool:
    """Return whether parts of the last change never reached the disk.

    The result is False if a single damaged word explains the wrong checksums. A disk writes whole sectors,
    whereas a bit that flips later is in one word and has a known effect on the checksums.
    """
    if not all(_one_is_equal(frame.salts, salts) for frame in frames):
        return True
    wrong = []
    for frame in frames:
        one, two = _sums(frame.summed, before, order)
        wrong.append(((frame.sums[0] - one) & _WORD, (frame.sums[1] - two) & _WORD))
        before = frame.sums
    bad = [at for at, each in enumerate(wrong) if each != (0, 0)]
    # the damaged checksum is also the start value of the next checksum
    if len(bad) == 2 and bad[1] == bad[0] + 1:
        return 0 not in wrong[bad[0]]
    return len(bad) > 1 or (len(bad) == 1 and not _is_one_word(wrong[bad[0]], len(frames[0].summed)))


def _is_one_word(wrong: Pair, size: int) -> bool:
    """Return whether one damaged word of an entry or of its checksum explains the error of the checksums."""
    if 0 in wrong:
        return True
    effects = [(1, 1), (0, 1)]  # effects of the two words of the last pair on both checksums
    for _ in range(size // 8):
        if any((wrong[0] * b - wrong[1] * a) & _WORD == 0 for a, b in effects):
            return True
        effects = [((a + b) & _WORD, (a + 2 * b) & _WORD) for a, b in effects]
    return False


def _is_whole(head: bytes, magic: int) -> bool:
    """Return whether the header of a log matches its checksum."""
    return magic & ~1 == _MAGIC and _sums(head[:24], (0, 0), _order(magic)) == struct.unpack(">2I", head[24:])


def _order(magic: int) -> str:
    return ">" if magic & 1 else "<"


def _sums(summed: bytes, before: Pair, order: str) -> Pair:
    """Return SQLite's checksums over pairs of words, continued from ``before``."""
    one, two = before
    words = struct.unpack(f"{order}{len(summed) // 4}I", summed)
    for first, second in zip(words[::2], words[1::2], strict=True):
        one = (one + first + two) & _WORD
        two = (two + second + one) & _WORD
    return one, two


def check_log(path: Path, reader: sqlite3.Connection) -> None:
    """Raise StoreError if changes in the log cannot be read and TurnDesk is not running.

    A running TurnDesk has already reported the damage. The check is then skipped, because it opens and closes
    SQLite's index (see ``check_header``).
    """
    if in_use(path.parent):
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


def put_damaged_log_aside(path: Path) -> tuple[str, ...]:
    """Save a copy of a log that has lost changes before the log is overwritten.

    The result is a message that reports the lost changes, or () if the log is intact. Raises StoreError.
    """
    log, _ = companions(path)
    with closing(connect(path, read_only=True)) as reader:
        lost = _changes_lost(path, reader)
    if not lost:
        return ()
    kept = path.with_name(f"{path.stem}-damaged-log-{datetime.now(UTC):%Y%m%dT%H%M%SZ}")
    try:
        write_in_place(kept, log.read_bytes())
        restrict(kept)
    except OSError as error:
        raise why(kept, error) from error
    with closing(connect(path, read_only=False)) as writer:
        writer.execute("PRAGMA wal_checkpoint(TRUNCATE)")
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
    log, index = companions(path)
    if not has_log(path):
        return 0
    try:
        reader.execute(
            "SELECT count(*) FROM sqlite_master"
        ).fetchone()  # makes SQLite determine how much of the log is valid
        return lost_changes(log, index)
    except sqlite3.Error as error:
        raise why(path, error) from error
    except FileNotFoundError:
        return 0  # the writing process has just closed the log


def _changes(count: int) -> str:
    return "the last saved change" if count == 1 else Message("the last {count} saved changes", count=count)
