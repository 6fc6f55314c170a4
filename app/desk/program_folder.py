"""Program files: the folders that ``FILE TO BE PROCESSED`` picks from, and whether the disk still holds what
was read.

What runs is the text on the desk. Who has changed the file since, at another computer of the shop, must not
believe that the new one will run.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.desk.program_loading import Loaded
from core.drawings.drawing_file import is_drawing
from core.language.source import Source, SourceError, load_source

LISTED = 2000  # a folder with more programs than this is typed into, not looked through
ENDINGS = frozenset({"", ".nc", ".txt", ".tap", ".cnc", ".prg", ".h", ".mpf", ".spf"})


@dataclass(frozen=True, slots=True)
class ListedProgram:
    """One program: how the list names it, and where it is."""

    name: str
    path: Path


class ProgramFolders:
    """Program folders in the order of preference; a name in an earlier one hides the same in a later."""

    def __init__(self, folders: Sequence[Path]) -> None:
        self.folders = tuple(folders)

    def entries(self) -> tuple[ListedProgram, ...]:
        """What can be picked, by name; folders that are not there are empty."""
        seen: dict[str, ListedProgram] = {}
        for folder in self.folders:
            for path in _files(folder, lambda name: Path(name).suffix.lower() in ENDINGS):
                seen.setdefault(path.name.lower(), ListedProgram(path.name, path))
        return tuple(sorted(seen.values(), key=lambda entry: entry.name.lower()))

    def matching(self, typed: str) -> tuple[ListedProgram, ...]:
        """The entries whose name holds what was typed."""
        part = typed.strip().lower()
        return tuple(entry for entry in self.entries() if part in entry.name.lower())

    def drawings(self) -> tuple[ListedProgram, ...]:
        """The drawings beside the programs, by name: what a program can be made of."""
        seen: dict[str, ListedProgram] = {}
        for folder in self.folders:
            for path in _files(folder, is_drawing):
                seen.setdefault(path.name.lower(), ListedProgram(path.name, path))
        return tuple(sorted(seen.values(), key=lambda entry: entry.name.lower()))

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


def _files(folder: Path, taken: Callable[[str], bool]) -> Iterator[Path]:
    try:
        paths = sorted(folder.iterdir(), key=lambda path: path.name.lower())
    except OSError:
        return
    good = (p for p in paths if taken(p.name) and not p.name.startswith(".") and p.is_file())
    for count, path in enumerate(good):
        if count >= LISTED:
            return
        yield path


# --- the file on the disk -----------------------------------------------------------------------------


LOOK = 2.0  # seconds between two looks at the disk
GONE = "{name} IS NOT ON THE DISK ANY MORE: WHAT IS SHOWN IS WHAT RUNS"
CHANGED = "{name} HAS CHANGED ON THE DISK: F2 READS IT ANEW, THE START RUNS WHAT IS SHOWN"
_Stamp = tuple[int, int]  # time of the last change in nanoseconds, bytes


class ProgramFile:
    """Looks at the file now and then, on a thread of its own: a share that hangs keeps nobody waiting."""

    def __init__(self, loaded: Callable[[], Loaded]) -> None:
        self._loaded = loaded
        self._seen: tuple[Source, tuple[_Stamp | None, ...]] | None = None  # whose files were compared last
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="program-file", daemon=True)
        self.differs = ""

    def start(self) -> None:
        """Begin to look at the file, on a thread of its own."""
        self._thread.start()

    def close(self) -> None:
        """Look no more; a look that hangs in the system is left behind."""
        self._closing.set()

    def look(self) -> None:
        """Compare the files with what was read, where one has been touched since the last look."""
        loaded = self._loaded()
        source, path = loaded.source, loaded.path
        if source is None or path is None:
            self._seen, self.differs = None, ""
            return
        texts = {path: source} | {path.parent / each.name: each for each in source.subprograms}
        stamps = tuple(_stamp(file) for file in texts)
        if self._seen is None or self._seen[0] is not source or self._seen[1] != stamps:
            self._seen = (source, stamps)
            self.differs = next(filter(None, (_difference(file, text) for file, text in texts.items())), "")

    def _watch(self) -> None:
        while not self._closing.wait(LOOK):
            self.look()


def _stamp(file: Path) -> _Stamp | None:
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size


def _difference(file: Path, read: Source) -> str:
    """What is to be told of this file; empty when it holds what was read."""
    try:
        now = load_source(file)
    except SourceError:
        return (CHANGED if file.exists() else GONE).format(name=file.name)
    return "" if now.text == read.text else CHANGED.format(name=file.name)
