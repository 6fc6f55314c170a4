"""Subprograms of SINUMERIK programs.

A subprogram is in the same file after a %_N_NAME_SPF line, or is a file NAME.spf in the main program's
folder.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import LexedBlock
from core.language.source import ProgramSource

HEADER_PATTERN = re.compile(r"\s*%_N_([A-Z0-9_]+)_(MPF|SPF)\s*(?:;.*)?", re.IGNORECASE)
SUBPROGRAM_EXTENSION = ".SPF"
PROGRAM_NAME_PATTERN = re.compile(r"[A-Z_][A-Z0-9_]{1,30}")
# Nearly all lines begin with a number or with a letter and a number. Only other lines can be calls.
_MAY_CALL = re.compile(
    r"\s*(?:/[0-9]?)?\s*(?:[N:][0-9]+)?\s*(?:\w+\s*:)?\s*(?:L[0-9]|[A-Z_]{2})", re.IGNORECASE
)


class ProgramSection(NamedTuple):
    """One program of a file, with its name and its line indices.

    The name of the file's main text is an empty string.
    """

    name: str
    line_range: range


def split_sections(source: ProgramSource) -> list[ProgramSection]:
    """Return the programs of a file, starting with the main program."""
    heads = [
        (i, match[1].upper())
        for i, line in enumerate(source.lines)
        if (match := HEADER_PATTERN.fullmatch(line))
    ]
    if not heads:
        return [ProgramSection("", range(len(source.lines)))]
    ends = [i for i, _ in heads[1:]] + [len(source.lines)]
    found = [ProgramSection(name, range(i + 1, end)) for (i, name), end in zip(heads, ends, strict=True)]
    before = range(heads[0][0])
    holds_code = any(source.lines[i].split(";", 1)[0].strip() for i in before)
    return [ProgramSection("", before), *found] if holds_code else found


def find_called_files(source: ProgramSource) -> Iterator[str]:
    """Yield the names (in capitals) of the files of called subprograms that are not in the file itself."""
    inside = {section.name for section in split_sections(source)}
    for number, text in enumerate(source.lines, start=1):
        if not _MAY_CALL.match(text):
            continue
        line = lex_line(number, text)
        for name in _names(line):
            if name not in inside:
                yield f"{name}{SUBPROGRAM_EXTENSION}"


def _names(line: LexedBlock) -> Iterator[str]:
    """Yield the names of the programs that a line calls or passes to a cycle as a contour."""
    if line.called_name:
        yield line.called_name
        for argument in line.arguments or ():
            if argument.text and PROGRAM_NAME_PATTERN.fullmatch(argument.text.upper()):
                yield argument.text.upper()


def derive_program_name(source: ProgramSource) -> str:
    """Return the name by which a program calls this file."""
    return Path(source.name).stem.upper()
