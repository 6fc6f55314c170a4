"""Atomic replacement of files and folders, syncing to disk, and access restriction of private files."""

from __future__ import annotations

import errno
import os
import stat
import sys
from contextlib import suppress
from pathlib import Path

PRIVATE_FILE_MODE = 0o600  # mode of new files
_OWNER = 0o700


def replace_atomically(finished: Path, path: Path) -> None:
    """Rename ``finished`` to ``path`` in one step that survives a power failure.

    The data is on the disk before the rename, and the new name is on the disk when the function returns.
    Raises OSError, also if ``path`` is a device or a pipe.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise OSError(errno.EINVAL, "this path is a device or a pipe, not a file", str(path))
    sync_file(finished)
    finished.replace(path)
    sync_folder(path.parent)


def write_atomically(path: Path, data: bytes) -> None:
    """Write ``data`` to a file in one step; create its folder if necessary.

    ``path`` always refers to either the complete old file or the complete new file. A failed write leaves
    no temporary file. Raises OSError if the file cannot be written.
    """
    create_synced_folder(path.parent)
    unfinished = path.with_name(f".{path.name}.new")
    try:
        unfinished.write_bytes(data)
        replace_atomically(unfinished, path)
    except OSError:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)
        raise


def move_folder_into_place(finished: Path, folder: Path) -> None:
    """Rename a completely written folder to ``folder`` and sync its contents and name to the disk.

    ``folder`` must be missing or empty. Raises OSError if syncing or renaming fails.
    """
    for inside in (*finished.rglob("*"), finished):
        if inside.is_dir():
            sync_folder(inside)
        else:
            sync_file(inside)
    finished.replace(folder)
    sync_folder(folder.parent)


def create_synced_folder(folder: Path) -> None:
    """Create a folder and its parents, and sync each name to the disk. Raises OSError on failure."""
    if folder.is_dir():
        return
    create_synced_folder(folder.parent)
    folder.mkdir(exist_ok=True)
    sync_folder(folder.parent)


def sync_folder(folder: Path) -> None:
    """Sync the file names in a folder to the disk. Raises OSError on failure."""
    if sys.platform == "win32":
        return  # Windows cannot open folders, but journals their names
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def sync_all_files() -> None:
    """Sync all written files to the disk.

    The function does nothing on Windows, which does not support this.
    """
    if hasattr(os, "sync"):
        os.sync()


def sync_file(path: Path) -> None:
    """Sync the contents of a file to the disk. Raises OSError on failure."""
    # Windows syncs only files that are open for writing. On other systems the file may be read-only.
    with path.open("r+b" if sys.platform == "win32" else "rb") as file:
        os.fsync(file.fileno())


def restrict_access(path: Path) -> None:
    """Remove the access rights of all other users from a file or folder.

    A file of another owner remains unchanged. A folder to which all users may write, such as /tmp, also
    remains unchanged.
    """
    with suppress(OSError):
        mode = stat.S_IMODE(path.stat().st_mode)
        if mode & ~_OWNER and not mode & stat.S_ISVTX:
            path.chmod(mode & _OWNER)


def restrict_folder_access(folder: Path) -> None:
    """Remove the access rights of all other users from a folder and the files directly in it.

    A missing folder is ignored.
    """
    if not folder.is_dir():
        return
    restrict_access(folder)
    with suppress(OSError):
        for path in folder.iterdir():
            if path.is_file() and not path.is_symlink():
                restrict_access(path)
