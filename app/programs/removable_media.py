"""USB sticks and folders for import and export of programs, with free space and write errors.

The list of mounts comes from the kernel (``/proc/self/mountinfo``). On systems without this list, each
folder is tested for being a mount point.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.programs.program_folder import AcceptsName, is_program_name
from app.desk.status import formats
from app.desk.translation import tr
from app.programs.atomic_files import FileOperationError
from core.message import Message, join_messages

MEDIA_ROOTS = (Path("/media"), Path("/run/media"), Path("/mnt"))
MOUNT_TABLE = Path("/proc/self/mountinfo")
BLOCK_DEVICES = Path("/sys/dev/block")
_UNPLUGGED_ERRORS = frozenset(
    {errno.EIO, errno.ENODEV, errno.ENXIO, errno.ENOENT, errno.ENOTCONN, errno.ESTALE}
)
_DISK_FULL_ERRORS = frozenset({errno.ENOSPC, errno.EDQUOT})


@dataclass(frozen=True, slots=True)
class UsbStick:
    """Mounted removable medium, with its label and path.

    ``free_bytes`` is the free space in bytes. ``is_read_only`` is True for a read-only medium.
    """

    label: str
    path: Path
    free_bytes: int
    is_read_only: bool = False


@dataclass(frozen=True, slots=True)
class MountEntry:
    """A mounted file system in the kernel's list, with path, block device and read-only state."""

    path: Path
    device_number: str
    is_read_only: bool


def list_usb_sticks(
    media_roots: Sequence[Path] = MEDIA_ROOTS,
    is_mount_point: Callable[[Path], bool] = os.path.ismount,
    mount_table: Path = MOUNT_TABLE,
    block_devices: Path = BLOCK_DEVICES,
) -> tuple[UsbStick, ...]:
    """Return the mounted removable media, sorted by label.

    A folder that is not a mount point is ignored.
    """
    try:
        listed = tuple(_parse_mounts(mount_table.read_text(encoding="utf-8", errors="surrogateescape")))
    except OSError:
        listed = tuple(
            MountEntry(path, "", False) for root in media_roots for path in _mounted(root, is_mount_point)
        )
    found = {
        each.path: UsbStick(each.path.name, each.path, _free(each.path), each.is_read_only)
        for each in listed
        if _is_below(each.path, media_roots) or _is_removable(each.device_number, block_devices)
    }
    return tuple(sorted(found.values(), key=lambda stick: stick.label.lower()))


def _parse_mounts(text: str) -> Iterator[MountEntry]:
    """Yield the mounts in the list of the kernel.

    In the list, a blank in a name is written as an escape sequence with the octal code 040.
    """
    for line in text.splitlines():
        words = line.split()
        if len(words) < 6 or "-" not in words:
            continue
        path = words[4].encode("utf-8", "surrogateescape").decode("unicode_escape")
        path = path.encode("latin-1", "replace").decode("utf-8", "replace")
        options = {*words[5].split(","), *words[-1].split(",")}
        yield MountEntry(Path(path), words[2], "ro" in options)


def _is_below(path: Path, roots: Sequence[Path]) -> bool:
    """Return whether a path is one or two levels below a root, such as /media/STICK or /media/USER/STICK."""
    return any(root in path.parents and len(path.relative_to(root).parts) <= 2 for root in roots)


def _is_removable(device: str, blocks: Path) -> bool:
    """Return whether the disk of a mount is removable.

    For a partition, the disk that contains it is examined.
    """
    if not device or device.startswith("0:"):
        return False
    try:
        place = (blocks / device).resolve()
        flag_file = next((p for p in (place / "removable", place.parent / "removable") if p.is_file()), None)
        return flag_file is not None and flag_file.read_text().strip() == "1"
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
class TargetMedium:
    """Target folder of a copy, with the device number that the folder had when it was opened.

    The device number reveals an unplugged stick: its folder remains, but then belongs to the disk of the
    control.
    """

    folder: Path
    device_number: int

    @classmethod
    def from_folder(cls, folder: Path) -> TargetMedium:
        """Return the medium that is now mounted at a folder.

        Raise FileOperationError if the folder does not exist.
        """
        try:
            return cls(folder, folder.stat().st_dev)
        except OSError as error:
            raise FileOperationError(describe_media_error(error, folder)) from error

    def check_medium_present(self) -> None:
        """Raise FileOperationError if the medium was removed or replaced by another medium."""
        if TargetMedium.from_folder(self.folder).device_number != self.device_number:
            raise FileOperationError(describe_unplugged_medium(self.folder))

    def check_free_space(self, size_bytes: int) -> None:
        """Raise FileOperationError if fewer than ``size_bytes`` bytes are free."""
        free = _free(self.folder)
        if size_bytes > free:
            raise FileOperationError(
                tr(
                    Message(
                        "{place}: {size} NEEDED, ONLY {free} FREE. USE ANOTHER USB STICK",
                        place=self.folder.name,
                        size=formats.format_file_size(size_bytes),
                        free=formats.format_file_size(free),
                    )
                )
            )


def describe_unplugged_medium(folder: Path) -> str:
    """Return the message about a stick that was unplugged."""
    return tr(Message("{place} IS NO LONGER CONNECTED. PLUG IT IN AGAIN AND PRESS F2", place=folder.name))


def describe_media_error(error: OSError, folder: Path) -> str:
    """Return the message for the operator about a failed access to a medium."""
    if error.errno in _DISK_FULL_ERRORS:
        return tr(Message("{place} IS FULL. NO PARTIAL FILE LEFT. USE ANOTHER USB STICK", place=folder.name))
    if error.errno == errno.EROFS:
        words = tr("{place} IS WRITE-PROTECTED. UNLOCK IT OR USE ANOTHER USB STICK")
        return tr(Message(words, place=folder.name))
    if error.errno in _UNPLUGGED_ERRORS:
        return describe_unplugged_medium(folder)
    return tr(Message("{place}: {why}", place=folder.name, why=error.strerror or str(error)))


PARENT_NAME = ".."
MAX_LINES = 2000


@dataclass(frozen=True, slots=True)
class FolderEntry:
    """Line of the folder chooser: a location, a folder, the parent folder or a program."""

    name: str
    path: Path
    is_folder: bool
    size_bytes: int = 0
    is_read_only: bool = False  # a read-only place


@dataclass(slots=True)
class FolderChooser:
    """Chooser of a folder.

    ``current_folder`` is the open folder, or None while the list of locations is shown. ``list_entries`` can
    take a while.
    """

    home_folder: Path
    list_usb_sticks: Callable[[], Sequence[UsbStick]] = list_usb_sticks
    accepts_name: AcceptsName = is_program_name
    current_folder: Path | None = None
    top_folder: Path | None = None  # folder of the open place, where going up ends
    listed_entries: tuple[FolderEntry, ...] = ()
    selected_row: int = 0
    medium: TargetMedium | None = None  # the open place at the time of opening
    error_text: str = field(default="")

    def list_entries(self) -> tuple[FolderEntry, ...]:
        """Return the lines of the open folder.

        This runs on a worker. Raise FileOperationError if the folder cannot be read.
        """
        if self.current_folder is None:
            self.medium = None
            places = [
                FolderEntry(s.label, s.path, True, s.free_bytes, s.is_read_only)
                for s in self.list_usb_sticks()
            ]
            return (*places, FolderEntry(tr("THIS CONTROL"), self.home_folder, True))
        if self.medium is None:
            self.medium = TargetMedium.from_folder(self.top_folder or self.current_folder)
        self.medium.check_medium_present()
        try:
            return (
                FolderEntry(PARENT_NAME, self.current_folder.parent, True),
                *_inside(self.current_folder, self.accepts_name),
            )
        except OSError as error:
            raise FileOperationError(describe_media_error(error, self.current_folder)) from error

    def show_entries(self, lines: tuple[FolderEntry, ...]) -> None:
        """Show the lines that ``list_entries`` has returned."""
        self.listed_entries, self.error_text = lines, ""
        self.selected_row = min(self.selected_row, max(0, len(lines) - 1))

    def open_entry(self, line: FolderEntry) -> None:
        """Open a folder or its parent folder.

        The parent of the top folder of a location is the list of locations.
        """
        self.selected_row = 0
        if line.name == PARENT_NAME and self.current_folder == self.top_folder:
            self.current_folder = self.top_folder = None
        else:
            if self.current_folder is None:
                self.top_folder = line.path
            self.current_folder = line.path

    @property
    def selected_entry(self) -> FolderEntry | None:
        """Return the selected line, or None if no line is selected."""
        return (
            self.listed_entries[self.selected_row] if self.selected_row < len(self.listed_entries) else None
        )

    @property
    def program_paths(self) -> tuple[Path, ...]:
        """Return the paths of the programs in the open folder."""
        return tuple(line.path for line in self.listed_entries if not line.is_folder)


def _inside(folder: Path, takes: AcceptsName) -> list[FolderEntry]:
    paths = sorted(folder.iterdir(), key=lambda path: path.name.lower())[:MAX_LINES]
    seen = [path for path in paths if not path.name.startswith(".")]
    folders = [FolderEntry(path.name, path, True) for path in seen if path.is_dir()]
    files = [path for path in seen if takes(path.name) and path.is_file()]
    return folders + [FolderEntry(path.name, path, False, path.stat().st_size) for path in files]


def make_chooser_table(chooser: FolderChooser, title: str) -> TableContent:
    """Return the table of locations, folders and programs."""
    rows = tuple(
        TableRow(
            (
                line.name,
                "READ-ONLY" if line.is_read_only else "FOLDER" if line.is_folder else "PROGRAM",
                formats.format_file_size(line.size_bytes) if line.size_bytes else "",
            )
        )
        for line in chooser.listed_entries
    )
    where = str(chooser.current_folder) if chooser.current_folder else "LOCATIONS"
    return TableContent(
        join_messages("  ·  ", (title, where)),
        ("NAME", "", "FREE" if chooser.current_folder is None else "SIZE"),
        (0.64, 0.18, 0.18),
        rows,
        chooser.selected_row if rows else -1,
        notes=(chooser.error_text,) if chooser.error_text else (),
        untranslated_columns=frozenset({2} if chooser.current_folder is None else {0, 2}),
        numeric_columns=frozenset({2}),
    )
