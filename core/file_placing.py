"""Files that are there whole or not at all, whatever cuts the writing off, and private files."""

from __future__ import annotations

import errno
import os
import stat
import sys
from contextlib import suppress
from pathlib import Path

NEW_FILE = 0o600  # of a file that is about to be made
_OWNER = 0o700


def put_in_place(finished: Path, path: Path) -> None:
    """``finished`` gets the name ``path`` in one step that survives a power cut.

    Its bytes are on the disk before it has the name, and the name before this is back. Raises OSError, also
    where the name is that of a device or a pipe: a file would take its place.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise OSError(errno.EINVAL, "this path is a device or a pipe, not a file", str(path))
    bytes_to_disk(finished)
    finished.replace(path)
    folder_to_disk(path.parent)


def write_in_place(path: Path, data: bytes) -> None:
    """A file with these bytes, in a folder that is made where it is missing. Raises OSError.

    At every moment the old one or the new one has the name; what could not be written leaves nothing.
    """
    make_folder(path.parent)
    unfinished = path.with_name(f".{path.name}.new")
    try:
        unfinished.write_bytes(data)
        put_in_place(unfinished, path)
    except OSError:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)
        raise


def folder_in_place(finished: Path, folder: Path) -> None:
    """The same for a folder with all that is in it; ``folder`` is not there, or empty. Raises OSError."""
    for inside in (*finished.rglob("*"), finished):
        if inside.is_dir():
            folder_to_disk(inside)
        else:
            bytes_to_disk(inside)
    finished.replace(folder)
    folder_to_disk(folder.parent)


def make_folder(folder: Path) -> None:
    """The folder, and those above it, each on the disk under its name. Raises OSError."""
    if folder.is_dir():
        return
    make_folder(folder.parent)
    folder.mkdir(exist_ok=True)
    folder_to_disk(folder.parent)


def folder_to_disk(folder: Path) -> None:
    """The names in a folder are on the disk. Raises OSError."""
    if sys.platform == "win32":
        return  # Windows opens no folders; its own journal keeps the names
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def all_to_disk() -> None:
    """Everything that was written anywhere, where the system can be asked for that; Windows cannot."""
    if hasattr(os, "sync"):
        os.sync()


def bytes_to_disk(path: Path) -> None:
    """What is in a file is on the disk. Raises OSError."""
    # Windows brings to the disk only what is open for writing; elsewhere a file may be read-only.
    with path.open("r+b" if sys.platform == "win32" else "rb") as file:
        os.fsync(file.fileno())


def restrict(path: Path) -> None:
    """Take the rights of all other users away from a file or a folder.

    A file of another owner stays as it is, and so does a folder like /tmp, in which every user may write.
    """
    with suppress(OSError):
        mode = stat.S_IMODE(path.stat().st_mode)
        if mode & ~_OWNER and not mode & stat.S_ISVTX:
            path.chmod(mode & _OWNER)


def restrict_folder(folder: Path) -> None:
    """Restrict a folder and the files directly in it. Do nothing if the folder does not exist."""
    if not folder.is_dir():
        return
    restrict(folder)
    with suppress(OSError):
        for path in folder.iterdir():
            if path.is_file() and not path.is_symlink():
                restrict(path)
