"""Programs that a program calls, read from the folders where they lie: what was proved is what runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from core.language.source import Dialect, Source, SourceError, load_source

_MOST_FILES = 500


def with_called_files(source: Source, folders: Sequence[Path]) -> Source:
    """The source with the programs that it and they call, as far as the folders hold them.

    A file that is missing or no text is left out: the call that needs it is an error of the program. OmniTurn
    programs call nothing outside themselves, and a source that has its programs already keeps them.
    """
    called = _calls_of(source.dialect)
    if called is None or source.subprograms:
        return source
    found: dict[str, Source] = {}
    waiting = [source]
    while waiting and len(found) < _MOST_FILES:
        for name in called(waiting.pop()):
            if name not in found and (read := _read(name, folders, source.dialect)) is not None:
                found[name] = read
                waiting.append(read)
    return replace(source, subprograms=tuple(found[name] for name in sorted(found)))


def _calls_of(dialect: Dialect) -> Callable[[Source], Iterator[str]] | None:
    """What gives the names of files, in capitals, that a source of this language calls."""
    if dialect is Dialect.SINUMERIK:
        from core.language.sinumerik.subprogram_files import called_files

        return called_files
    if dialect is Dialect.KLARTEXT:
        from core.language.klartext.named_files import called_programs

        return called_programs
    return None


def _read(name: str, folders: Sequence[Path], dialect: Dialect) -> Source | None:
    for path in _places(name, folders, dialect):
        try:
            if path.is_file():
                return load_source(path, dialect)
        except SourceError:
            return None
    return None


def _places(name: str, folders: Sequence[Path], dialect: Dialect) -> Iterator[Path]:
    """Where a file of this name may lie, the likeliest first: no folder is listed without need."""
    for each in (name, *_also(name, dialect)):
        for folder in folders:
            yield folder / each.lower()
            yield from _same_name(folder, each)


def _also(name: str, dialect: Dialect) -> tuple[str, ...]:
    """A main program of SINUMERIK may be called by its name, too."""
    return (str(Path(name).with_suffix(".MPF")),) if dialect is Dialect.SINUMERIK else ()


def _same_name(folder: Path, name: str) -> list[Path]:
    """Files of this name in any case."""
    try:
        return [path for path in folder.iterdir() if path.name.upper() == name]
    except OSError:
        return []
