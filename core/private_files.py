"""Files that only their owner may read, whatever the umask is. Windows keeps its own rights."""

from __future__ import annotations

import stat
from contextlib import suppress
from pathlib import Path

NEW_FILE = 0o600  # of a file that is about to be made
_OWNER = 0o700


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
