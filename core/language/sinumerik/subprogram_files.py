"""Subprograms: in the same file behind %_N_NAME_SPF lines, or as NAME.spf beside the main program."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.source import Dialect, Source, SourceError, load_source

HEADER = re.compile(r"\s*%_N_([A-Z0-9_]+)_(MPF|SPF)\s*(?:;.*)?", re.IGNORECASE)
ENDING = ".spf"
# Nearly all lines begin with a number, or with a letter and a number; only the others can be calls.
_MAY_CALL = re.compile(
    r"\s*(?:/[0-9]?)?\s*(?:[N:][0-9]+)?\s*(?:\w+\s*:)?\s*(?:L[0-9]|[A-Z_]{2})", re.IGNORECASE
)
_MOST_FILES = 500


class Section(NamedTuple):
    """One program of a file: its name (empty: the file's own), and its lines as indices into the source."""

    name: str
    lines: range


def sections(source: Source) -> list[Section]:
    """The programs of a file; the first is the main program."""
    heads = [
        (i, match[1].upper()) for i, line in enumerate(source.lines) if (match := HEADER.fullmatch(line))
    ]
    if not heads:
        return [Section("", range(len(source.lines)))]
    ends = [i for i, _ in heads[1:]] + [len(source.lines)]
    found = [Section(name, range(i + 1, end)) for (i, name), end in zip(heads, ends, strict=True)]
    before = range(heads[0][0])
    holds_code = any(source.lines[i].split(";", 1)[0].strip() for i in before)
    return [Section("", before), *found] if holds_code else found


def with_subprograms(source: Source, folders: Sequence[Path]) -> Source:
    """The source with the subprograms that it and they call, as far as the folders hold them.

    A file that is missing or no text is left out: the call that needs it is an error of the program.
    """
    found: dict[str, Source] = {}
    waiting = [source]
    while waiting and len(found) < _MOST_FILES:
        reading = waiting.pop()
        inside = {section.name for section in sections(reading)}
        for name in _called(reading):
            if name not in found and name not in inside and (read := _read(name, folders)) is not None:
                found[name] = read
                waiting.append(read)
    return replace(source, subprograms=tuple(found[name] for name in sorted(found)))


def program_name(source: Source) -> str:
    """The name by which a program calls this file."""
    return Path(source.name).stem.upper()


def _called(source: Source) -> Iterator[str]:
    for number, text in enumerate(source.lines, start=1):
        if _MAY_CALL.match(text) and (call := lex_line(number, text).call):
            yield call


def _read(name: str, folders: Sequence[Path]) -> Source | None:
    for folder in folders:
        for path in (folder / f"{name}{ENDING}".lower(), *_same_name(folder, name)):
            try:
                if path.is_file():
                    return load_source(path, Dialect.SINUMERIK)
            except SourceError:
                return None
    return None


def _same_name(folder: Path, name: str) -> list[Path]:
    """Files of this name in any case."""
    try:
        return [path for path in folder.iterdir() if path.name.upper() == f"{name}{ENDING}".upper()]
    except OSError:
        return []
