"""The file of the program on the desk: whether the disk still holds the text that was read and proved.

What runs is the text on the desk. Who has changed the file since, at another computer of the shop, must
not believe that the new one will run.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

from app.desk.session import Loaded
from core.language.source import Source, SourceError, load_source

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
        """Begin to look."""
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
