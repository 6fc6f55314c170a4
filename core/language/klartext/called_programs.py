"""CALL PGM, SEL PGM, cycle 12, SEL TABLE and SEL PATTERN: the files that a Klartext program names."""

from __future__ import annotations

import re
from collections.abc import Iterator

from core.language.source import Source

ENDING = ".H"
_CALL = re.compile(
    r"(?:CALL\s+PGM|SEL\s+(?:PGM|TABLE|PATTERN))\s+(.+)|CYCL\s+DEF\s+12\.1\s+(?:PGM\s*|%\s*)?(.+)",
    re.IGNORECASE,
)
_IN_TEXT = re.compile(r'"([^"]*\.(?:H|D|PNT))"', re.IGNORECASE)  # of a text that may name a file
_OF_CONTOURS = re.compile(r"CONTOUR\s+DEF\s", re.IGNORECASE)
_QUOTED = re.compile(r'"([^"]+)"')
_HINTS = ("PGM", "TABLE", "PATTERN", "12.1", "CONTOUR")


def called_programs(source: Source) -> Iterator[str]:
    """Names of the files that the program calls or selects, in capitals."""
    for text in source.lines:
        if not any(hint in text.upper() for hint in _HINTS):
            continue
        code = text.split(";", 1)[0]
        if match := _CALL.search(code):
            yield file_name(next(filter(None, match.groups())))
        if _OF_CONTOURS.search(code):
            yield from (file_name(quoted) for quoted in _QUOTED.findall(code))
            continue
        for quoted in _IN_TEXT.findall(code):
            yield file_name(quoted)


def file_name(named: str) -> str:
    r"""The file of a name as written: ``TNC:\PARTS\HOLE`` is HOLE.H."""
    name = named.strip().strip('"').replace("\\", "/").rsplit("/", 1)[-1].rsplit(":", 1)[-1].strip().upper()
    return name if "." in name else name + ENDING
