"""Program folders, and a monitor that detects changes of the loaded program's files.

``FILE TO BE PROCESSED`` lists the programs of these folders. Cycle Start runs the loaded text. If the file
is changed on another computer, the operator must see that the new text is not loaded.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.desk.programs.program_loading import LoadedProgram
from app.desk.translation import tr
from core.executor.raised_alarm import ErrorCatcher
from core.language.source import ProgramSource, SourceError, load_source
from core.message import Message

MAX_PROGRAM_COUNT = 2000  # Maximum number of listed programs in a folder.
PROGRAM_EXTENSIONS = frozenset({"", ".nc", ".txt", ".tap", ".cnc", ".prg", ".h", ".mpf", ".spf"})
_LISTED_EXTENSIONS = PROGRAM_EXTENSIONS | {".ngc"}  # The list also shows programs for LinuxCNC.


AcceptsName = Callable[[str], bool]
"""Function that returns whether a file with this name is to be included."""


def is_program_name(name: str) -> bool:
    """Return whether a file name has the extension of a program that is listed, copied and exported."""
    return Path(name).suffix.lower() in _LISTED_EXTENSIONS


@dataclass(frozen=True, slots=True)
class ListedProgram:
    """One program in the list, with its displayed name and its path."""

    name: str
    path: Path


class ProgramFolders:
    """Program folders in order of preference.

    A program in an earlier folder hides programs of the same name in later folders. ``drawing_extensions``
    are the file extensions of drawings from which a program can be made.
    """

    def __init__(self, folders: Sequence[Path], drawing_extensions: tuple[str, ...] = ()) -> None:
        self.folders = tuple(folders)
        self._drawing_endings = drawing_extensions

    def is_drawing_name(self, name: str) -> bool:
        """Return whether a file name has the extension of a drawing."""
        return name.lower().endswith(self._drawing_endings)

    def accepts_file_name(self, name: str) -> bool:
        """Return whether a file name has the extension of a program or a drawing."""
        return is_program_name(name) or self.is_drawing_name(name)

    def list_programs(self) -> tuple[ListedProgram, ...]:
        """Return the programs of all folders, sorted by name. A missing folder counts as empty."""
        return self._listed(is_program_name)

    def find_matching_programs(self, typed_text: str) -> tuple[ListedProgram, ...]:
        """Return the programs whose names contain the typed text."""
        part = typed_text.strip().lower()
        return tuple(entry for entry in self.list_programs() if part in entry.name.lower())

    def list_drawings(self) -> tuple[ListedProgram, ...]:
        """Return the drawings in the program folders, sorted by name."""
        return self._listed(self.is_drawing_name)

    def _listed(self, taken: AcceptsName) -> tuple[ListedProgram, ...]:
        seen: dict[str, ListedProgram] = {}
        for folder in self.folders:
            for path in _files(folder, taken):
                seen.setdefault(path.name.lower(), ListedProgram(path.name, path))
        return tuple(sorted(seen.values(), key=lambda entry: entry.name.lower()))

    def find_path(self, typed_name: str) -> Path | None:
        """Return the path of the program with the typed name, or None if the file does not exist.

        The name may be in upper or lower case, with or without its extension. It may also be a path.
        """
        name = typed_name.strip()
        if not name:
            return None
        path = Path(name).expanduser()
        if path.is_absolute() or len(path.parts) > 1:
            return path if path.is_file() else None
        wanted = name.lower()
        entries = self.list_programs()
        for entry in entries:
            if entry.name.lower() == wanted:
                return entry.path
        return next((e.path for e in entries if e.path.stem.lower() == wanted), None)


def _files(folder: Path, taken: AcceptsName) -> Iterator[Path]:
    try:
        paths = sorted(folder.iterdir(), key=lambda path: path.name.lower())
    except OSError:
        return
    good = (p for p in paths if taken(p.name) and not p.name.startswith(".") and p.is_file())
    for count, path in enumerate(good):
        if count >= MAX_PROGRAM_COUNT:
            return
        yield path


# --- the file on the disk -----------------------------------------------------------------------------


_log = logging.getLogger(__name__)
CHECK_INTERVAL_S = 2.0  # Seconds between two checks of the file.
CHECK_TIMEOUT_S = 5.0  # Seconds after which an unfinished check counts as an unreadable file.
FILE_MISSING_TEXT = "{name} IS NOT ON THE DISK. CYCLE START RUNS THE LOADED PROGRAM"
FILE_CHANGED_TEXT = "{name} HAS CHANGED. CYCLE START RUNS THE OLD VERSION"
FILE_UNREADABLE_TEXT = "CANNOT READ {name}: CHECK FOLDER. CYCLE START RUNS LOADED VERSION"
_Message = tuple[str, str]  # Message text and file name.
_NO_DIFFERENCE = ("", "")
_FileStamp = tuple[int, int]  # Modification time in ns and size in bytes, or an error number and -1.


class ProgramFileMonitor:
    """Monitor that compares the loaded text with the program's files in a separate thread.

    Access to a network drive may hang, and would then block the screen.
    """

    def __init__(
        self, read_loaded: Callable[[], LoadedProgram], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._loaded, self._clock = read_loaded, clock
        self._since: float | None = None  # Start time of the check in progress.
        self._wanted = threading.Event()
        # Source and files of the last comparison.
        self._seen: tuple[ProgramSource, tuple[_FileStamp, ...]] | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="program-file", daemon=True)
        self._found: tuple[ProgramSource | None, _Message] = (
            None,
            _NO_DIFFERENCE,
        )  # Compared source and message.

    @property
    def difference_text(self) -> str:
        """Return the message about the difference between the files and the loaded text.

        The message is empty if they are equal. If a file cannot be read, the message reports this.
        """
        loaded, since = self._loaded(), self._since
        if loaded.source is None:
            return ""
        if since is not None and self._clock() - since > CHECK_TIMEOUT_S:
            return tr(Message(FILE_UNREADABLE_TEXT, name=loaded.name))
        source, said = self._found
        return tr(Message(said[0], name=said[1])) if said[0] and source is loaded.source else ""

    @property
    def can_reload(self) -> bool:
        """Return whether a file differs from the loaded text and can be read again."""
        source, said = self._found
        return said[0] == FILE_CHANGED_TEXT and source is self._loaded().source

    def start(self) -> None:
        """Start the thread that checks the program's files."""
        self._thread.start()

    def close(self) -> None:
        """Stop checking. A check that hangs in the operating system continues on the daemon thread."""
        self._closing.set()
        self._wanted.set()

    def request_check(self) -> None:
        """Request an immediate check of the program file, because TurnDesk has just written it."""
        self._wanted.set()

    def compare_files(self) -> None:
        """Compare the files with the loaded text if a file was modified after the last check."""
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

    def _compare(self, source: ProgramSource, path: Path) -> None:
        texts = {path: source} | {path.parent / each.name: each for each in source.subprograms}
        stamps = tuple(_stamp(file) for file in texts)
        if self._seen is None or self._seen[0] is not source or self._seen[1] != stamps:
            found = ((_find_difference(file, text), file.name) for file, text in texts.items())
            said = next((each for each in found if each[0]), _NO_DIFFERENCE)
            # The file's time and size may not change, so read the file at every check.
            unread = said[0] == FILE_UNREADABLE_TEXT
            self._seen = None if unread else (source, stamps)
            self._found = (source, said)

    def _watch(self) -> None:
        while not self._closing.is_set():
            self._wanted.wait(CHECK_INTERVAL_S)
            self._wanted.clear()
            if not self._closing.is_set():
                self.check_file_safely()

    def check_file_safely(self) -> None:
        """Check the program's files once. If an exception occurs, the files are reported as unreadable."""
        with ErrorCatcher() as trial:
            self.compare_files()
        if trial.error is not None:
            _log.error("the program's file cannot be watched", exc_info=trial.error)
            loaded = self._loaded()
            self._seen, self._found = None, (loaded.source, (FILE_UNREADABLE_TEXT, loaded.name))


def _stamp(file: Path) -> _FileStamp:
    try:
        found = file.stat()
    except OSError as error:
        return error.errno or 0, -1
    return found.st_mtime_ns, found.st_size


def _find_difference(file: Path, read: ProgramSource) -> str:
    """Return the message that a file has changed or is unreadable, or else an empty string.

    The file counts as changed if its text differs from the loaded text.
    """
    try:
        now = load_source(file)
    except SourceError as error:
        return _describe_read_error(error)
    return "" if now.text == read.text else FILE_CHANGED_TEXT


def _describe_read_error(error: SourceError) -> str:
    """Return the message that the file of a program is missing, unreadable or changed.

    A file that can be read but is not a program counts as changed.
    """
    cause = error.__cause__
    if not isinstance(cause, OSError):
        return FILE_CHANGED_TEXT  # The file could be read, but is not a program.
    return (
        FILE_MISSING_TEXT
        if isinstance(cause, (FileNotFoundError, NotADirectoryError))
        else FILE_UNREADABLE_TEXT
    )
