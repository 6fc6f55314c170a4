"""USB sticks and other removable media: which are mounted now, what is free, and why one cannot be written.

The kernel's own list of mounts tells (``/proc/self/mountinfo``); elsewhere folders are asked one by one.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.desk.status import formats
from app.desk.translation import tr
from app.programs.whole_file import FileError
from core.message import Message

ROOTS = (Path("/media"), Path("/run/media"), Path("/mnt"))
MOUNTS = Path("/proc/self/mountinfo")
BLOCKS = Path("/sys/dev/block")
_GONE = frozenset({errno.EIO, errno.ENODEV, errno.ENXIO, errno.ENOENT, errno.ENOTCONN, errno.ESTALE})
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT})


@dataclass(frozen=True, slots=True)
class Stick:
    """One medium: its label and where it is mounted; ``free`` bytes; ``locked``: it takes nothing."""

    label: str
    path: Path
    free: int
    locked: bool = False


@dataclass(frozen=True, slots=True)
class Mount:
    """One line of the kernel's list: where, of which block device, with which options."""

    path: Path
    device: str
    locked: bool


def sticks(
    roots: Sequence[Path] = ROOTS,
    mounted: Callable[[Path], bool] = os.path.ismount,
    mounts: Path = MOUNTS,
    blocks: Path = BLOCKS,
) -> tuple[Stick, ...]:
    """What is plugged in and mounted now, by label; a folder that is no mount is a medium that has gone."""
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
    """The mounts of the kernel's list; a blank in a name stands there as ``\\040``."""
    for line in text.splitlines():
        words = line.split()
        if len(words) < 6 or "-" not in words:
            continue
        path = words[4].encode("utf-8", "surrogateescape").decode("unicode_escape")
        path = path.encode("latin-1", "replace").decode("utf-8", "replace")
        options = {*words[5].split(","), *words[-1].split(",")}
        yield Mount(Path(path), words[2], "ro" in options)


def _below(path: Path, roots: Sequence[Path]) -> bool:
    """One or two levels down: /media/STICK of some systems, /media/USER/STICK of others."""
    return any(root in path.parents and len(path.relative_to(root).parts) <= 2 for root in roots)


def _removable(device: str, blocks: Path) -> bool:
    """Whether the disk of a mount is one that can be taken out; a partition asks the disk it is on."""
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


# --- the medium of a copy ---------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Medium:
    """The folder that is copied to or from, and its device as it was when it was opened.

    A stick that is pulled out leaves its folder behind, which is then one of the control's own disk.
    """

    folder: Path
    device: int

    @classmethod
    def of(cls, folder: Path) -> Medium:
        """As it is now. Raises FileError when it is gone."""
        try:
            return cls(folder, folder.stat().st_dev)
        except OSError as error:
            raise FileError(why_not(error, folder)) from error

    def check(self) -> None:
        """Raises FileError when another medium is there now, or none."""
        if Medium.of(self.folder).device != self.device:
            raise FileError(pulled_out(self.folder))

    def room_for(self, size: int) -> None:
        """Raises FileError when less than so many bytes are free, before anything is written."""
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
    """A stick that is not there any more."""
    return tr(Message("{place} IS NO LONGER CONNECTED. PLUG IT IN AGAIN AND PRESS F2", place=folder.name))


def why_not(error: OSError, folder: Path) -> str:
    """Why nothing can be read from or written to a medium, in the words of who holds it."""
    if error.errno in _FULL:
        return tr(Message("{place} IS FULL. NO PARTIAL FILE LEFT. USE ANOTHER USB STICK", place=folder.name))
    if error.errno == errno.EROFS:
        words = tr("{place} IS WRITE-PROTECTED. UNLOCK IT OR USE ANOTHER USB STICK")
        return tr(Message(words, place=folder.name))
    if error.errno in _GONE:
        return pulled_out(folder)
    return tr(Message("{place}: {why}", place=folder.name, why=error.strerror or str(error)))
