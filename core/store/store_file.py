"""The file name of the store, and the keys of the settings that are stored for each program."""

from __future__ import annotations

import os
from pathlib import Path

STORE_FILE_NAME = "turndesk.db"


def has_store(folder: Path) -> bool:
    """Return whether a file with the name of the store exists, even if it cannot be read.

    The result is also True for a pipe, or a link to a disk that is not mounted. It is True as well if the
    folder is such a link, or if this user has no permission for the folder. The error is reported when the
    store is read.
    """
    try:
        os.lstat(folder / STORE_FILE_NAME)
    except PermissionError:
        return True
    except OSError:
        return folder.is_symlink() and not folder.exists()
    return True


def resolve_link(path: Path) -> Path:
    """Return the target of a link, or ``path`` itself if it is not a link."""
    return path.resolve() if path.is_symlink() else path


def make_stock_setting_key(program: str) -> str:
    """Return the key of the setting that contains the stock of a program."""
    return f"stock:{program}"


def make_notes_setting_key(program: str) -> str:
    """Return the key of the setting that contains the setup notes of a program."""
    return f"notes:{program}"


def make_loaded_text_key(program: str) -> str:
    """Return the key of the setting that specifies which text was last loaded under a program name."""
    return f"text:{program}"


def make_part_setting_key(program: str) -> str:
    """Return the key of the setting that contains the stick-out and the silenced checks of a program."""
    return f"part:{program}"
