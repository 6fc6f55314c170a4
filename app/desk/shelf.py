"""The shelf that ``FILE TO BE PROCESSED`` picks from: the operator's folder first, then the samples."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

LISTED = 2000  # a folder with more programs than this is typed into, not looked through
ENDINGS = frozenset({"", ".nc", ".txt", ".tap", ".cnc", ".prg", ".h", ".mpf", ".spf"})


@dataclass(frozen=True, slots=True)
class Entry:
    """One program: how the list names it, and where it is."""

    name: str
    path: Path


class Shelf:
    """Program folders in the order of preference; a name in an earlier one hides the same in a later."""

    def __init__(self, folders: Sequence[Path]) -> None:
        self.folders = tuple(folders)

    def entries(self) -> tuple[Entry, ...]:
        """What can be picked, by name; folders that are not there are empty."""
        seen: dict[str, Entry] = {}
        for folder in self.folders:
            for path in _programs(folder):
                seen.setdefault(path.name.lower(), Entry(path.name, path))
        return tuple(sorted(seen.values(), key=lambda entry: entry.name.lower()))

    def matching(self, typed: str) -> tuple[Entry, ...]:
        """The entries whose name holds what was typed."""
        part = typed.strip().lower()
        return tuple(entry for entry in self.entries() if part in entry.name.lower())

    def find(self, typed: str) -> Path | None:
        """The program that a typed name means: any case, with or without its ending; or a path.

        None when there is no such file.
        """
        name = typed.strip()
        if not name:
            return None
        path = Path(name).expanduser()
        if path.is_absolute() or len(path.parts) > 1:
            return path if path.is_file() else None
        wanted = name.lower()
        entries = self.entries()
        for entry in entries:
            if entry.name.lower() == wanted:
                return entry.path
        return next((e.path for e in entries if e.path.stem.lower() == wanted), None)


def _programs(folder: Path) -> Iterator[Path]:
    try:
        paths = sorted(folder.iterdir(), key=lambda path: path.name.lower())
    except OSError:
        return
    good = (p for p in paths if p.suffix.lower() in ENDINGS and not p.name.startswith(".") and p.is_file())
    for count, path in enumerate(good):
        if count >= LISTED:
            return
        yield path
