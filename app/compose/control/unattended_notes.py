"""Files in the data folder with the events and the interrupted job of a control without a screen."""

from __future__ import annotations

import json
import logging
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from core.executor.snapshot import InterruptedJob, interrupted_job_from_json, interrupted_job_to_json
from core.file_replacement import write_atomically
from core.message import pack_message, unpack_message
from core.store.store_rows import EventOrigin, EventRow

_log = logging.getLogger(__name__)
NOTE_FILE = "interrupted.json"
EVENTS_FILE = "left_events.json"


def save_note(folder: Path, job: InterruptedJob | None) -> None:
    """Save the interrupted job, or None if no job is interrupted. A disk error is logged."""
    try:
        write_atomically(
            folder / NOTE_FILE, json.dumps(None if job is None else interrupted_job_to_json(job)).encode()
        )
    except OSError as error:
        _log.warning("the interrupted job cannot be kept in %s: %s", folder / NOTE_FILE, error)


def read_note(folder: Path) -> tuple[bool, InterruptedJob | None]:
    """Return whether a control without a screen has saved a note, and the interrupted job of the note.

    The note is deleted.
    """
    path = folder / NOTE_FILE
    try:
        value = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return False, None
    with suppress(OSError):
        path.unlink()
    return True, interrupted_job_from_json(value)


def remove_note(folder: Path) -> None:
    """Delete the note, because a connected screen has stored its contents."""
    with suppress(OSError):
        (folder / NOTE_FILE).unlink(missing_ok=True)


class LeftEvents(NamedTuple):
    """Events that no screen has confirmed, with the program and the origin of each event."""

    program: str = ""
    rows: tuple[EventRow, ...] = ()
    origins: tuple[EventOrigin, ...] = ()


def save_events(folder: Path, left: LeftEvents) -> None:
    """Save the events that no screen has confirmed. A disk error is logged."""
    program, rows, origins = left
    events = [[*row[:5], pack_message(row.text), *origin] for row, origin in zip(rows, origins, strict=True)]
    try:
        write_atomically(folder / EVENTS_FILE, json.dumps([program, events]).encode())
    except OSError as error:
        _log.warning("%d events cannot be kept in %s: %s", len(events), folder / EVENTS_FILE, error)


def pop_events(folder: Path) -> LeftEvents:
    """Return the events that no screen has confirmed, and delete their file."""
    path = folder / EVENTS_FILE
    try:
        program, events = json.loads(path.read_bytes())
        left = LeftEvents(
            str(program),
            tuple(_row(*each[:6]) for each in events),
            tuple(EventOrigin(str(control), int(number)) for *_, control, number in events),
        )
    except FileNotFoundError:
        return LeftEvents()
    except (OSError, ValueError, TypeError) as error:
        _log.warning("the events in %s are lost: %s", path, error)
        left = LeftEvents()
    with suppress(OSError):
        path.unlink()
    return left


def _row(at: str, kind: str, text: str, line: int, record: str, packed: str) -> EventRow:
    return EventRow(str(at), str(kind), unpack_message(packed, str(text)), int(line), str(record))
