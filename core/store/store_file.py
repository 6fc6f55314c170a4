"""Where the store lies in the data folder; whoever only asks that loads no database."""

from __future__ import annotations

from pathlib import Path

FILE_NAME = "turndesk.db"


def has_store(folder: Path) -> bool:
    """Whether anything was ever stored there; also where this user may not look: reading it tells so."""
    try:
        return (folder / FILE_NAME).exists()
    except PermissionError:
        return True
