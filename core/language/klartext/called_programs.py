"""CALL PGM and cycle 12: the files that a Klartext program names."""

from __future__ import annotations

import re
from collections.abc import Iterator

from core.language.source import Source

ENDING = ".H"
_CALL = re.compile(r"CALL\s+PGM\s+(.+)|CYCL\s+DEF\s+12\.1\s+(?:PGM\s*)?(.+)", re.IGNORECASE)


def called_programs(source: Source) -> Iterator[str]:
    """Names of the files that the program calls, in capitals."""
    for text in source.lines:
        if "PGM" in text.upper() and (match := _CALL.search(text.split(";", 1)[0])):
            yield file_name(match.group(1) or match.group(2))


def file_name(named: str) -> str:
    r"""The file of a name as written: ``TNC:\PARTS\HOLE`` is HOLE.H."""
    name = named.strip().strip('"').replace("\\", "/").rsplit("/", 1)[-1].rsplit(":", 1)[-1].strip().upper()
    return name if "." in name else name + ENDING
