"""The store without its database: where it lies, and the settings that are kept of a program."""

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


def stock_key(program: str) -> str:
    """The setting that holds the stock of a program."""
    return f"stock:{program}"


def notes_key(program: str) -> str:
    """The setting that holds what the setup person has noted about a program."""
    return f"notes:{program}"


def text_key(program: str) -> str:
    """Return the setting that states which text was last loaded under this name."""
    return f"text:{program}"


def part_key(program: str) -> str:
    """The setting that holds what else is kept of a program's part: stick-out and silenced checks."""
    return f"part:{program}"
