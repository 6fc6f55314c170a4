"""Where the store lies in the data folder; whoever only asks that loads no database."""

from __future__ import annotations

import os
from pathlib import Path

FILE_NAME = "turndesk.db"


def has_store(folder: Path) -> bool:
    """Return whether anything has the store's name: also a pipe, or a link whose disk is not mounted.

    True also where the folder is such a link, or closed to this user. Reading it reports what is wrong.
    """
    try:
        os.lstat(folder / FILE_NAME)
    except PermissionError:
        return True
    except OSError:
        return folder.is_symlink() and not folder.exists()
    return True


def real_path(path: Path) -> Path:
    """Return the file that a link leads to; ``path`` itself if it is not a link."""
    return path.resolve() if path.is_symlink() else path
