"""Program files: the folders that ``FILE TO BE PROCESSED`` picks from, and whether the disk still holds what
was read.

What runs is the text on the desk. Who has changed the file since, at another computer of the shop, must not
believe that the new one will run.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.desk.programs.program_loading import Loaded
from app.desk.translation import tr
from core.executor.raised_alarm import Attempt
from core.language.source import Source, SourceError, load_source
from core.message import Message

LISTED = 2000  # a folder with more programs than this is typed into, not looked through
ENDINGS = frozenset({"", ".nc", ".txt", ".tap", ".cnc", ".prg", ".h", ".mpf", ".spf"})


Takes = Callable[[str], bool]
"""Whether a file of this name is one of those that are wanted."""


def is_program(name: str) -> bool:
    """Whether a file is a program, by its ending."""
    return Path(name).suffix.lower() in ENDINGS


@dataclass(frozen=True, slots=True)
class ListedProgram:
    """One program: how the list names it, and where it is."""

    name: str
    path: Path


class ProgramFolders:
    """Program folders in the order of preference; a name in an earlier one hides the same in a later.

    ``drawing_endings``: of the drawings from which a program can be made.
    """

    def __init__(self, folders: Sequence[Path], drawing_endings: tuple[str, ...] = ()) -> None:
        self.folders = tuple(folders)
        self._drawing_endings = drawing_endings

    def is_drawing(self, name: str) -> bool:
        """Whether a file is a drawing, by its ending."""
        return name.lower().endswith(self._drawing_endings)

    def takes(self, name: str) -> bool:
        """Whether a file is a program or a drawing, by its ending."""
        return is_program(name) or self.is_drawing(name)

    def entries(self) -> tuple[ListedProgram, ...]:
        """What can be picked, by name; folders that are not there are empty."""
        return self._listed(is_program)

    def matching(self, typed: str) -> tuple[ListedProgram, ...]:
        """The entries whose name holds what was typed."""
        part = typed.strip().lower()
        return tuple(entry for entry in self.entries() if part in entry.name.lower())

    def drawings(self) -> tuple[ListedProgram, ...]:
        """The drawings beside the programs, by name: what a program can be made of."""
        return self._listed(self.is_drawing)

    def _listed(self, taken: Takes) -> tuple[ListedProgram, ...]:
        seen: dict[str, ListedProgram] = {}
        for folder in self.folders:
            for path in _files(folder, taken):
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


def _files(folder: Path, taken: Takes) -> Iterator[Path]:
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


_log = logging.getLogger(__name__)
LOOK = 2.0  # seconds between two looks at the disk
HANGS = 5.0  # seconds after which a look that has not returned counts as a file that cannot be read
GONE = "{name} IS NOT ON THE DISK. CYCLE START RUNS THE LOADED PROGRAM"
CHANGED = "{name} HAS CHANGED. F2: RELOAD. CYCLE START RUNS THE OLD VERSION"
UNREADABLE = "CANNOT READ {name}: CHECK FOLDER. CYCLE START RUNS LOADED VERSION"
_Said = tuple[str, str]  # the text, and the name of the file in it
_SAME = ("", "")
_Stamp = tuple[int, int]  # time of the last change in nanoseconds, bytes; an error number and -1


class ProgramFile:
    """Looks at the file now and then, on a thread of its own: a share that hangs keeps nobody waiting."""

    def __init__(self, loaded: Callable[[], Loaded], clock: Callable[[], float] = time.monotonic) -> None:
        self._loaded, self._clock = loaded, clock
        self._since: float | None = None  # when the look that is under way began
        self._wanted = threading.Event()
        self._seen: tuple[Source, tuple[_Stamp, ...]] | None = None  # whose files were compared last
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="program-file", daemon=True)
        self._found: tuple[Source | None, _Said] = (None, _SAME)  # of which text, and what is to be said

    @property
    def differs(self) -> str:
        """How the files differ from the loaded text, or that they cannot be read; empty while they agree."""
        loaded, since = self._loaded(), self._since
        if loaded.source is None:
            return ""
        if since is not None and self._clock() - since > HANGS:
            return tr(Message(UNREADABLE, name=loaded.name))
        source, said = self._found
        return tr(Message(said[0], name=said[1])) if said[0] and source is loaded.source else ""

    def start(self) -> None:
        """Begin to look at the file, on a thread of its own."""
        self._thread.start()

    def close(self) -> None:
        """Look no more; a look that hangs in the system is left behind."""
        self._closing.set()
        self._wanted.set()

    def hurry(self) -> None:
        """Look at once: the file has just been written here."""
        self._wanted.set()

    def look(self) -> None:
        """Compare the files with what was read, where one has been touched since the last look."""
        loaded = self._loaded()
        source, path = loaded.source, loaded.path
        if source is None or path is None:
            self._seen = None
            return
        self._since = self._clock()
        try:
            self._compare(source, path)
        finally:
            self._since = None

    def _compare(self, source: Source, path: Path) -> None:
        texts = {path: source} | {path.parent / each.name: each for each in source.subprograms}
        stamps = tuple(_stamp(file) for file in texts)
        if self._seen is None or self._seen[0] is not source or self._seen[1] != stamps:
            found = ((_difference(file, text), file.name) for file, text in texts.items())
            said = next((each for each in found if each[0]), _SAME)
            unread = said[0] == UNREADABLE  # its stamp may not change: read it at every look
            self._seen = None if unread else (source, stamps)
            self._found = (source, said)

    def _watch(self) -> None:
        while not self._closing.is_set():
            self._wanted.wait(LOOK)
            self._wanted.clear()
            if not self._closing.is_set():
                self.watch_once()

    def watch_once(self) -> None:
        """Look; the watch survives whatever the look raises, and shows that the file cannot be read."""
        with Attempt() as trial:
            self.look()
        if trial.error is not None:
            _log.error("the program's file cannot be watched", exc_info=trial.error)
            loaded = self._loaded()
            self._seen, self._found = None, (loaded.source, (UNREADABLE, loaded.name))


def _stamp(file: Path) -> _Stamp:
    try:
        found = file.stat()
    except OSError as error:
        return error.errno or 0, -1
    return found.st_mtime_ns, found.st_size


def _difference(file: Path, read: Source) -> str:
    """Return what is to be said of this file; empty if it contains what was read."""
    try:
        now = load_source(file)
    except SourceError as error:
        return _no_text(error)
    return "" if now.text == read.text else CHANGED


def _no_text(error: SourceError) -> str:
    """What is to be said of a file from which no program text could be read."""
    cause = error.__cause__
    if not isinstance(cause, OSError):
        return CHANGED  # it was read, and is no program
    return GONE if isinstance(cause, (FileNotFoundError, NotADirectoryError)) else UNREADABLE
