"""USB sticks and folders as sources of programs: mounted media, free space and write errors.

The kernel's list of mounts (``/proc/self/mountinfo``) is used. On other systems, each folder is checked.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.pages.sheet import Row, Sheet
from app.desk.programs.program_folder import Takes, is_program
from app.desk.status import formats
from app.desk.translation import tr
from app.programs.whole_file import FileError
from core.message import Message, join_messages

ROOTS = (Path("/media"), Path("/run/media"), Path("/mnt"))
MOUNTS = Path("/proc/self/mountinfo")
BLOCKS = Path("/sys/dev/block")
_GONE = frozenset({errno.EIO, errno.ENODEV, errno.ENXIO, errno.ENOENT, errno.ENOTCONN, errno.ESTALE})
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


@dataclass(frozen=True, slots=True)
class Stick:
    """Mounted medium: label, path and ``free`` space in bytes. ``locked`` means read-only."""

    label: str
    path: Path
    free: int
    locked: bool = False


@dataclass(frozen=True, slots=True)
class Mount:
    """Entry of the kernel's list of mounts: path, block device and read-only state."""

    path: Path
    device: str
    locked: bool


def sticks(
    roots: Sequence[Path] = ROOTS,
    mounted: Callable[[Path], bool] = os.path.ismount,
    mounts: Path = MOUNTS,
    blocks: Path = BLOCKS,
) -> tuple[Stick, ...]:
    """Return the mounted removable media, sorted by label.

    A folder that is not a mount point is ignored.
    """
    try:
        listed = tuple(_listed(mounts.read_text(encoding="utf-8", errors="surrogateescape")))
    except OSError:
        listed = tuple(Mount(path, "", False) for root in roots for path in _mounted(root, mounted))
    found = {
        each.path: Stick(each.path.name, each.path, _free(each.path), each.locked)
        for each in listed
        if _below(each.path, roots) or _removable(each.device, blocks)
    }
    return tuple(sorted(found.values(), key=lambda stick: stick.label.lower()))


def _listed(text: str) -> Iterator[Mount]:
    r"""Yield the mounts of the kernel's list, which writes a blank in a name as ``\040``."""
    for line in text.splitlines():
        words = line.split()
        if len(words) < 6 or "-" not in words:
            continue
        path = words[4].encode("utf-8", "surrogateescape").decode("unicode_escape")
        path = path.encode("latin-1", "replace").decode("utf-8", "replace")
        options = {*words[5].split(","), *words[-1].split(",")}
        yield Mount(Path(path), words[2], "ro" in options)


def _below(path: Path, roots: Sequence[Path]) -> bool:
    """Return whether a path is one or two levels below a root, such as /media/STICK or /media/USER/STICK."""
    return any(root in path.parents and len(path.relative_to(root).parts) <= 2 for root in roots)


def _removable(device: str, blocks: Path) -> bool:
    """Return whether the disk of a mount is removable.

    A partition is looked up through its disk.
    """
    if not device or device.startswith("0:"):
        return False
    try:
        place = (blocks / device).resolve()
        told = next((p for p in (place / "removable", place.parent / "removable") if p.is_file()), None)
        return told is not None and told.read_text().strip() == "1"
    except OSError:
        return False


def _mounted(root: Path, mounted: Callable[[Path], bool]) -> Iterator[Path]:
    for path in _folders(root):
        if mounted(path):
            yield path
        else:
            yield from (below for below in _folders(path) if mounted(below))


def _folders(path: Path) -> list[Path]:
    try:
        return sorted(below for below in path.iterdir() if below.is_dir())
    except OSError:
        return []


def _free(path: Path) -> int:
    try:
        return shutil.disk_usage(path).free
    except OSError:
        return 0


# --- medium of a copy -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Medium:
    """Folder for a copy, with its device number at the time of opening.

    A stick that is unplugged leaves its folder, which then belongs to the disk of the control.
    """

    folder: Path
    device: int

    @classmethod
    def of(cls, folder: Path) -> Medium:
        """Return the present medium of a folder. Raises FileError if the folder does not exist."""
        try:
            return cls(folder, folder.stat().st_dev)
        except OSError as error:
            raise FileError(why_not(error, folder)) from error

    def check(self) -> None:
        """Raise FileError if another medium or no medium is present now."""
        if Medium.of(self.folder).device != self.device:
            raise FileError(pulled_out(self.folder))

    def room_for(self, size: int) -> None:
        """Raise FileError if fewer than ``size`` bytes are free."""
        free = _free(self.folder)
        if size > free:
            raise FileError(
                tr(
                    Message(
                        "{place}: {size} NEEDED, ONLY {free} FREE. USE ANOTHER USB STICK",
                        place=self.folder.name,
                        size=formats.file_size(size),
                        free=formats.file_size(free),
                    )
                )
            )


def pulled_out(folder: Path) -> str:
    """Return the message about a stick that was unplugged."""
    return tr(Message("{place} IS NO LONGER CONNECTED. PLUG IT IN AGAIN AND PRESS F2", place=folder.name))


def why_not(error: OSError, folder: Path) -> str:
    """Return the reason for a failed access to a medium as a message for the operator."""
    if error.errno in _FULL:
        return tr(Message("{place} IS FULL. NO PARTIAL FILE LEFT. USE ANOTHER USB STICK", place=folder.name))
    if error.errno == errno.EROFS:
        words = tr("{place} IS WRITE-PROTECTED. UNLOCK IT OR USE ANOTHER USB STICK")
        return tr(Message(words, place=folder.name))
    if error.errno in _GONE:
        return pulled_out(folder)
    return tr(Message("{place}: {why}", place=folder.name, why=error.strerror or str(error)))


UP = ".."
MOST = 2000


@dataclass(frozen=True, slots=True)
class FolderLine:
    """Line of the chooser: a place, a folder, the parent folder or a program."""

    name: str
    path: Path
    folder: bool
    size: int = 0
    locked: bool = False  # a read-only place


@dataclass(slots=True)
class FolderChooser:
    """Folder chooser.

    ``at`` is the open folder, or None for the list of places. ``look`` can take a while.
    """

    home: Path
    plugged: Callable[[], Sequence[Stick]] = sticks
    takes: Takes = is_program
    at: Path | None = None
    top: Path | None = None  # folder of the open place, where going up ends
    lines: tuple[FolderLine, ...] = ()
    marked: int = 0
    medium: Medium | None = None  # the open place at the time of opening
    trouble: str = field(default="")

    def look(self) -> tuple[FolderLine, ...]:
        """Return the lines of the open folder, on a worker.

        Raises FileError if the folder cannot be read.
        """
        if self.at is None:
            self.medium = None
            places = [FolderLine(s.label, s.path, True, s.free, s.locked) for s in self.plugged()]
            return (*places, FolderLine(tr("THIS CONTROL"), self.home, True))
        if self.medium is None:
            self.medium = Medium.of(self.top or self.at)
        self.medium.check()
        try:
            return (FolderLine(UP, self.at.parent, True), *_inside(self.at, self.takes))
        except OSError as error:
            raise FileError(why_not(error, self.at)) from error

    def show_lines(self, lines: tuple[FolderLine, ...]) -> None:
        """Show the lines that ``look`` has returned."""
        self.lines, self.trouble = lines, ""
        self.marked = min(self.marked, max(0, len(lines) - 1))

    def go(self, line: FolderLine) -> None:
        """Open a folder, its parent folder, or the list of places from the top of a place."""
        self.marked = 0
        if line.name == UP and self.at == self.top:
            self.at = self.top = None
        else:
            if self.at is None:
                self.top = line.path
            self.at = line.path

    @property
    def marked_line(self) -> FolderLine | None:
        """Selected line, or None."""
        return self.lines[self.marked] if self.marked < len(self.lines) else None

    @property
    def programs(self) -> tuple[Path, ...]:
        """Programs of the open folder."""
        return tuple(line.path for line in self.lines if not line.folder)


def _inside(folder: Path, takes: Takes) -> list[FolderLine]:
    paths = sorted(folder.iterdir(), key=lambda path: path.name.lower())[:MOST]
    seen = [path for path in paths if not path.name.startswith(".")]
    folders = [FolderLine(path.name, path, True) for path in seen if path.is_dir()]
    files = [path for path in seen if takes(path.name) and path.is_file()]
    return folders + [FolderLine(path.name, path, False, path.stat().st_size) for path in files]


def chooser_sheet(chooser: FolderChooser, title: str) -> Sheet:
    """Return the table of places, folders and programs."""
    rows = tuple(
        Row(
            (
                line.name,
                "READ-ONLY" if line.locked else "FOLDER" if line.folder else "PROGRAM",
                formats.file_size(line.size) if line.size else "",
            )
        )
        for line in chooser.lines
    )
    where = str(chooser.at) if chooser.at else "LOCATIONS"
    return Sheet(
        join_messages("  ·  ", (title, where)),
        ("NAME", "", "FREE" if chooser.at is None else "SIZE"),
        (0.64, 0.18, 0.18),
        rows,
        chooser.marked if rows else -1,
        notes=(chooser.trouble,) if chooser.trouble else (),
        raw=frozenset({2} if chooser.at is None else {0, 2}),
        figures=frozenset({2}),
    )
