"""Damage as disks, cables, other programs and people do it to a file; the same for the same seed."""

from __future__ import annotations

import io
import random
import re
import zipfile
from collections.abc import Callable

from tests.fuzz.fuzz_target import Target

_LONGEST = 1_000_000  # bytes
_NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?")
_NUMBERS = (
    b"nan", b"NaN", b"inf", b"-inf", b"1e308", b"-1e309", b"1e999999", b"1e-320", b"0", b"-1", b"-0.0", b"1",
    b"9" * 25, b"9" * 5000, b"18446744073709551616", b"-9223372036854775809", b"0x1p9", b"1,5", b"1_0", b"",
    b"x", b"\xd9\xa3", b"true", b"null",
)  # fmt: skip
_PIECES = (
    b"\0", b"\r", b"\n", b"\xff\xfe", b"\xef\xbb\xbf", b"\xc3", b"\xed\xa0\x80", b"\x1a", b"\x1b[2J", b"%s%n",
    b"\"", b"'", b"<", b"&amp;", b"&x;", b"]]>", b"=", b";", b"(", b")", b"[", b"]", b"{", b"}", b"\\",
    b"../",
)  # fmt: skip
_NESTS = ((b"(", b")"), (b"[", b"]"), (b"{", b"}"), (b"<g>", b"</g>"), (b'{"a":', b"}"), (b"-", b""))

Edit = Callable[[bytes, random.Random], bytes]


def damaged(target: Target, data: bytes, chance: random.Random) -> bytes:
    """A good input with one to three damages, most of them of the kind that the target knows."""
    for _ in range(chance.choice((1, 1, 2, 3))):
        edit = target.mutate if target.mutate is not None and chance.random() < 0.6 else chance.choice(EDITS)
        data = edit(data, chance)[:_LONGEST]
    return data


def flipped(data: bytes, chance: random.Random) -> bytes:
    """A few bits are others."""
    found = bytearray(data)
    for _ in range(chance.randrange(1, 9)):
        if found:
            found[chance.randrange(len(found))] ^= 1 << chance.randrange(8)
    return bytes(found)


def cut(data: bytes, chance: random.Random) -> bytes:
    """The end is missing, or a piece of the middle."""
    first, last = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    return data[:first] + (data[last:] if chance.randrange(2) else b"")


def doubled(data: bytes, chance: random.Random) -> bytes:
    """A piece is there again, perhaps many times, perhaps elsewhere."""
    first = chance.randrange(len(data) + 1)
    piece = data[first : first + chance.choice((1, 10, 100, 1000))]
    at = chance.choice((first, chance.randrange(len(data) + 1)))
    return data[:at] + piece * chance.choice((1, 1, 3, 50)) + data[at:]


def renumbered(data: bytes, chance: random.Random) -> bytes:
    """A number is huge, or is none."""
    places = [found.span() for found in _NUMBER.finditer(data[:_LONGEST])]
    if not places:
        return data
    first, last = chance.choice(places)
    return data[:first] + chance.choice(_NUMBERS) + data[last:]


def with_piece(data: bytes, chance: random.Random) -> bytes:
    """Something stands in it that has no place there."""
    at = chance.randrange(len(data) + 1)
    return data[:at] + chance.choice(_PIECES) * chance.choice((1, 1, 2, 300)) + data[at:]


def nested(data: bytes, chance: random.Random) -> bytes:
    """Brackets in brackets, thousands deep; a piece of the text is the innermost."""
    first, last = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    last = min(last, first + 200)
    (opens, closes), deep = chance.choice(_NESTS), chance.choice((3, 40, 1500, 20_000))
    return data[:first] + opens * deep + data[first:last] + closes * deep + data[last:]


def recoded(data: bytes, chance: random.Random) -> bytes:
    """The text in another encoding, or with other line ends."""
    text = data.decode("utf-8", "replace")
    coding = chance.choice(("utf-16", "utf-32", "utf-7", "utf-8-sig", "cp1252", "cp037"))
    if chance.randrange(2):
        return text.encode(coding, "replace")
    return data.replace(b"\n", chance.choice((b"\r", b"\r\n", b"\0", b"\x85", b"\n\n")))


EDITS: tuple[Edit, ...] = (flipped, cut, doubled, renumbered, with_piece, nested, recoded)


def in_archive(data: bytes, chance: random.Random) -> bytes:
    """A member of a ZIP archive is damaged, and packed again, so that its sums are right."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
    except Exception:  # noqa: BLE001 - it was damaged before
        return flipped(data, chance)
    name = chance.choice(sorted(members)) if members else "about.npy"
    what = chance.randrange(8)
    if what == 0:
        members.pop(name, None)
    elif what == 1:
        members[chance.choice(("../x", "a\\b", "x" * 300, "/", "programs/../../x", "about"))] = b"1"
    else:
        members[name] = chance.choice(EDITS)(members.get(name, b"1"), chance)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, content in members.items():
            archive.writestr(each, content)
    return out.getvalue()
