"""What was interrupted while no screen was connected: a file in the data folder, for the next start."""

from __future__ import annotations

import json
import logging
from contextlib import suppress
from pathlib import Path

from core.executor.snapshot import InterruptedJob, of_plain, plain
from core.file_placing import write_in_place

_log = logging.getLogger(__name__)
NAME = "interrupted.json"


def save_note(folder: Path, job: InterruptedJob | None) -> None:
    """Keep the interrupted job, None: that nothing is interrupted. A disk that fails is logged."""
    try:
        write_in_place(folder / NAME, json.dumps(None if job is None else plain(job)).encode())
    except OSError as error:
        _log.warning("the interrupted job cannot be kept in %s: %s", folder / NAME, error)


def take_note(folder: Path) -> tuple[bool, InterruptedJob | None]:
    """Return whether there is a note of a control that had no screen, and its job; it is removed then."""
    path = folder / NAME
    try:
        value = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return False, None
    with suppress(OSError):
        path.unlink()
    return True, of_plain(value)


def remove_note(folder: Path) -> None:
    """Remove the note: a screen is connected, whose store has it."""
    with suppress(OSError):
        (folder / NAME).unlink(missing_ok=True)
