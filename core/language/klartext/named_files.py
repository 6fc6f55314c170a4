"""Files to which a Klartext program refers: programs, datum tables (.D) and point tables (.PNT).

A table consists of ``BEGIN NAME.D MM``, a line with the column names, one line per row, and ``[END]``. A
cell extends from the start of its column name to the start of the next name. An empty cell has no value.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from core.language.source import ProgramSource

TABLE_EXTENSIONS = (".D", ".PNT")
_NAME = re.compile(r"[A-Z0-9_]+")
_INCH = re.compile(r"BEGIN\s.*\bINCH\b", re.IGNORECASE)

TableRow = dict[str, float]


def is_table_file(name: str) -> bool:
    """Return whether a file name is the name of a table."""
    return name.upper().endswith(TABLE_EXTENSIONS)


def read_table_rows(source: ProgramSource) -> dict[int, TableRow]:
    """Return the rows by number in file order, with values by column name and lengths in mm.

    Rows that FADE hides are omitted. The result is empty if the file has no column names.
    """
    lines = source.lines
    head = next((at for at, text in enumerate(lines) if text.strip().upper().startswith("NR")), None)
    if head is None:
        return {}
    scale = 25.4 if any(_INCH.match(text) for text in lines[:head]) else 1.0
    columns = [(match.group(), match.start()) for match in _NAME.finditer(lines[head].upper())]
    found: dict[int, TableRow] = {}
    for text in lines[head + 1 :]:
        cells = _cells(text, columns)
        if not cells.get("NR", "").isdecimal() or cells.get("FADE", "N").upper()[:1] in {"Y", "1"}:
            continue
        found[int(cells["NR"])] = {
            name: number * (scale if name in {"X", "Y", "Z"} else 1.0)
            for name, cell in cells.items()
            if name != "NR" and (number := _number(cell)) is not None
        }
    return found


def _cells(text: str, columns: Sequence[tuple[str, int]]) -> dict[str, str]:
    """Return the cells of a row that contain a value.

    A row number may start to the left of the name of its column.
    """
    if len(split := text.split()) == len(columns):
        return {name: cell for (name, _), cell in zip(columns, split, strict=True)}
    ends = [start for _, start in columns[1:]] + [len(text)]
    starts = [0, *(start for _, start in columns[1:])]
    cut = {name: text[a:b].strip() for (name, _), a, b in zip(columns, starts, ends, strict=True)}
    return {name: cell for name, cell in cut.items() if cell}


def _number(cell: str) -> float | None:
    try:
        return float(cell.replace(",", "."))
    except ValueError:
        return None


PROGRAM_EXTENSION = ".H"
_CALL = re.compile(
    r"(?:CALL\s+PGM|SEL\s+(?:PGM|TABLE|PATTERN))\s+(.+)|CYCL\s+DEF\s+12\.1\s+(?:PGM\s*|%\s*)?(.+)",
    re.IGNORECASE,
)
_IN_TEXT = re.compile(r'"([^"]*\.(?:H|D|PNT))"', re.IGNORECASE)  # string that may contain a file name
_CONTOUR_DEF_PATTERN = re.compile(r"CONTOUR\s+DEF\s", re.IGNORECASE)
_QUOTED = re.compile(r'"([^"]+)"')
_HINTS = ("PGM", "TABLE", "PATTERN", "12.1", "CONTOUR")


def find_called_programs(source: ProgramSource) -> Iterator[str]:
    """Yield the names, in capitals, of the files that the program calls or selects."""
    for text in source.lines:
        if not any(hint in text.upper() for hint in _HINTS):
            continue
        code = text.split(";", 1)[0]
        if match := _CALL.search(code):
            yield normalize_file_name(next(filter(None, match.groups())))
        if _CONTOUR_DEF_PATTERN.search(code):
            yield from (normalize_file_name(quoted) for quoted in _QUOTED.findall(code))
            continue
        for quoted in _IN_TEXT.findall(code):
            yield normalize_file_name(quoted)


def normalize_file_name(written_name: str) -> str:
    """Return the file name in capitals without its folder, with the extension .H if it has no extension."""
    name = (
        written_name.strip()
        .strip('"')
        .replace("\\", "/")
        .rsplit("/", 1)[-1]
        .rsplit(":", 1)[-1]
        .strip()
        .upper()
    )
    return name if "." in name else name + PROGRAM_EXTENSION
