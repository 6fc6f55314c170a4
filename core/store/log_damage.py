"""Changes that SQLite's log has and cannot read any more: it passes them over without a word, and we do not.

After a kill or a power cut what was saved last is in the log alone. SQLite takes its entries as far as their
sums fit; one flipped bit takes back whatever was saved behind it. What an unfinished change leaves there is
no damage: nobody was told that it is kept.
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

_HEAD = struct.Struct(">8I")  # magic, version, page size, sequence, two salts, two sums
_FRAME = struct.Struct(">6I")  # page, pages of the store behind a commit, two salts, two sums
_MAGIC = 0x377F0682  # its lowest bit: whether sums are made of words with the highest byte first
_TAKEN = struct.Struct("=I")  # how many entries SQLite takes, in its index
_TAKEN_AT = 16
_SMALLEST = 512  # bytes of a page
_WORD = 0xFFFFFFFF

Pair = tuple[int, int]


class _Frame(NamedTuple):
    """An entry of the log: whether it ends a change, and what its sum is made of."""

    ends: bool
    salts: Pair
    sums: Pair
    summed: bytes  # page number and size, then the page


def lost_changes(log: Path, index: Path) -> int:
    """How many finished changes stand in ``log`` behind what SQLite takes of it, by its ``index``.

    Somebody reads the store meanwhile, and nobody writes it. Raises OSError.
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
    """An entry of an earlier round of the log has two other salts; one whose salt is flipped has one."""
    return its[0] == salts[0] or its[1] == salts[1]


# --- A power cut within the last write leaves parts of it: it was never acknowledged, and is no damage.


def _is_torn(frames: list[_Frame], before: Pair, salts: tuple[int, ...], order: str) -> bool:
    """Return whether parts of the last change never came to the disk; False for one word that is damaged.

    A disk writes whole sectors, and a bit that flips later is in one word: its effect on the sums of an entry
    is known.
    """
    if not all(_one_is_equal(frame.salts, salts) for frame in frames):
        return True
    wrong = []
    for frame in frames:
        one, two = _sums(frame.summed, before, order)
        wrong.append(((frame.sums[0] - one) & _WORD, (frame.sums[1] - two) & _WORD))
        before = frame.sums
    bad = [at for at, each in enumerate(wrong) if each != (0, 0)]
    if len(bad) == 2 and bad[1] == bad[0] + 1:  # a sum itself is where the next one begins
        return 0 not in wrong[bad[0]]
    return len(bad) > 1 or (len(bad) == 1 and not _is_one_word(wrong[bad[0]], len(frames[0].summed)))


def _is_one_word(wrong: Pair, size: int) -> bool:
    """Return whether one word of an entry, or of its sum, explains by how much its sums are wrong."""
    if 0 in wrong:
        return True
    effects = [(1, 1), (0, 1)]  # of the two words of the last pair, on both sums
    for _ in range(size // 8):
        if any((wrong[0] * b - wrong[1] * a) & _WORD == 0 for a, b in effects):
            return True
        effects = [((a + b) & _WORD, (a + 2 * b) & _WORD) for a, b in effects]
    return False


def _is_whole(head: bytes, magic: int) -> bool:
    """Whether the head of a log has its own sum."""
    return magic & ~1 == _MAGIC and _sums(head[:24], (0, 0), _order(magic)) == struct.unpack(">2I", head[24:])


def _order(magic: int) -> str:
    return ">" if magic & 1 else "<"


def _sums(summed: bytes, before: Pair, order: str) -> Pair:
    """SQLite's sums over pairs of words, going on from ``before``."""
    one, two = before
    words = struct.unpack(f"{order}{len(summed) // 4}I", summed)
    for first, second in zip(words[::2], words[1::2], strict=True):
        one = (one + first + two) & _WORD
        two = (two + second + one) & _WORD
    return one, two


def check_log(path: Path, reader: sqlite3.Connection) -> None:
    """Raises StoreError where changes in the log can be read no more, and no desk runs that has told it.

    Beside a desk nothing is looked at: that opens SQLite's index and closes it (see ``check_header``).
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
    """A copy of a log that has lost changes, before it is written over; tell what is lost."""
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
        ).fetchone()  # SQLite looks how far it takes the log
        return lost_changes(log, index)
    except sqlite3.Error as error:
        raise why(path, error) from error
    except FileNotFoundError:
        return 0  # whoever wrote it has just closed it


def _changes(count: int) -> str:
    return "the last saved change" if count == 1 else Message("the last {count} saved changes", count=count)
