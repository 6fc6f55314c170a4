"""Changes that SQLite's log has and cannot read any more: it passes them over without a word, and we do not.

After a kill or a power cut what was saved last is in the log alone. SQLite takes its entries as far as their
sums fit; one flipped bit takes back whatever was saved behind it. What an unfinished change leaves there is
no damage: nobody was told that it is kept.
"""

from __future__ import annotations

import struct
from pathlib import Path

_HEAD = struct.Struct(">8I")  # magic, version, page size, sequence, two salts, two sums
_FRAME = struct.Struct(">6I")  # page, pages of the store behind a commit, two salts, two sums
_MAGIC = 0x377F0682  # its lowest bit: whether sums are made of words with the highest byte first
_TAKEN = struct.Struct("=I")  # how many entries SQLite takes, in its index
_TAKEN_AT = 16


def lost_changes(log: Path, index: Path) -> int:
    """How many finished changes stand in ``log`` behind what SQLite takes of it, by its ``index``.

    Somebody reads the store meanwhile, and nobody writes it. Raises OSError.
    """
    with log.open("rb") as file:
        head = file.read(_HEAD.size)
        if len(head) < _HEAD.size:
            return 0
        magic, _, page, _, *salts, _, _ = _HEAD.unpack(head)
        frames = _frames(file.read(), page) if 512 <= page <= 65536 else []
    if not _is_whole(head, magic):
        first = frames[0][2:] if frames else ()
        return sum(bool(size) and tuple(its) == tuple(first) for _, size, *its in frames) or 1
    taken = _TAKEN.unpack_from(index.read_bytes()[: _TAKEN_AT + _TAKEN.size], _TAKEN_AT)[0]
    return sum(bool(size) and _one_is_equal(its, salts) for _, size, *its in frames[taken:])


def _frames(content: bytes, page: int) -> list[tuple[int, ...]]:
    step = _FRAME.size + page
    return [_FRAME.unpack_from(content, at)[:4] for at in range(0, len(content) - step + 1, step)]


def _one_is_equal(its: list[int], salts: list[int]) -> bool:
    """An entry of an earlier round of the log has two other salts; one whose salt is flipped has one."""
    return its[0] == salts[0] or its[1] == salts[1]


def _is_whole(head: bytes, magic: int) -> bool:
    """Whether the head of a log has its own sum."""
    if magic & ~1 != _MAGIC:
        return False
    words = struct.unpack(f"{'>' if magic & 1 else '<'}6I", head[:24])
    one = two = 0
    for first, second in zip(words[::2], words[1::2], strict=True):
        one = (one + first + two) & 0xFFFFFFFF
        two = (two + second + one) & 0xFFFFFFFF
    return (one, two) == struct.unpack(">2I", head[24:])
