"""Loading of all called programs together with the main program.

This ensures that the program that is executed is exactly the program that was proved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from core.language.source import Dialect, ProgramSource, SourceError, load_source

_MAX_FILES = 500


def load_called_files(source: ProgramSource, folders: Sequence[Path]) -> ProgramSource:
    """Return the source with all programs that it calls directly or indirectly.

    Files that are missing or are not text are omitted, so that the call causes an error in the program.
    OmniTurn programs do not call other files. A source that already contains its called programs is
    returned unchanged.
    """
    called = _call_finder(source.dialect)
    if called is None or source.subprograms:
        return source
    found: dict[str, ProgramSource] = {}
    waiting = [source]
    while waiting and len(found) < _MAX_FILES:
        for name in called(waiting.pop()):
            if name not in found and (read := _read(name, folders, source.dialect)) is not None:
                found[name] = read
                waiting.append(read)
    return replace(source, subprograms=tuple(found[name] for name in sorted(found)))


def _call_finder(dialect: Dialect) -> Callable[[ProgramSource], Iterator[str]] | None:
    """Return the function that finds the files that a source of this dialect calls.

    The function yields the file names in capitals. Returns None if the dialect does not call files.
    """
    if dialect is Dialect.SINUMERIK:
        from core.language.sinumerik.subprogram_files import find_called_files

        return find_called_files
    if dialect is Dialect.KLARTEXT:
        from core.language.klartext.named_files import find_called_programs

        return find_called_programs
    return None


def _read(name: str, folders: Sequence[Path], dialect: Dialect) -> ProgramSource | None:
    for path in _candidate_paths(name, folders, dialect):
        try:
            if path.is_file():
                return load_source(path, dialect)
        except SourceError:
            return None
    return None


def _candidate_paths(name: str, folders: Sequence[Path], dialect: Dialect) -> Iterator[Path]:
    """Yield the possible paths of a file, starting with the most likely path.

    The paths are generated one by one, so that folders are listed only if necessary.
    """
    for each in (name, *_alternative_names(name, dialect)):
        for folder in folders:
            yield folder / each.lower()
            yield from _same_name(folder, each)


def _alternative_names(name: str, dialect: Dialect) -> tuple[str, ...]:
    """Return the other file names to which a call may refer, such as NAME.MPF in SINUMERIK."""
    return (str(Path(name).with_suffix(".MPF")),) if dialect is Dialect.SINUMERIK else ()


def _same_name(folder: Path, name: str) -> list[Path]:
    """Return the files in the folder that have this name, without regard to case."""
    try:
        return [path for path in folder.iterdir() if path.name.upper() == name]
    except OSError:
        return []
