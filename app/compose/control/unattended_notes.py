"""Files that a control without a screen writes: its events and its interrupted job."""

from __future__ import annotations

import json
import logging
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from core.executor.snapshot import InterruptedJob, convert_interrupted_job_to_json, parse_interrupted_job
from core.file_replacement import write_atomically
from core.message import pack_message, unpack_message
from core.store.store_rows import EventOrigin, EventRow

_log = logging.getLogger(__name__)
NOTE_FILE_NAME = "interrupted.json"
EVENTS_FILE_NAME = "left_events.json"


def save_note(folder: Path, job: InterruptedJob | None) -> None:
    """Save a note of the interrupted job, or of None if no job is interrupted. Log a disk error."""
    try:
        write_atomically(
            folder / NOTE_FILE_NAME,
            json.dumps(None if job is None else convert_interrupted_job_to_json(job)).encode(),
        )
    except OSError as error:
        _log.warning("the interrupted job cannot be kept in %s: %s", folder / NOTE_FILE_NAME, error)


def read_note(folder: Path) -> tuple[bool, InterruptedJob | None]:
    """Return whether a note was saved by a control without a screen, and its interrupted job.

    The note is then deleted.
    """
    path = folder / NOTE_FILE_NAME
    try:
        value = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return False, None
    with suppress(OSError):
        path.unlink()
    return True, parse_interrupted_job(value)


def remove_note(folder: Path) -> None:
    """Delete the note of the interrupted job, because a connected screen has stored its contents."""
    with suppress(OSError):
        (folder / NOTE_FILE_NAME).unlink(missing_ok=True)


class UnconfirmedEvents(NamedTuple):
    """Events that no screen has confirmed as stored, each with its program and origin."""

    program: str = ""
    event_rows: tuple[EventRow, ...] = ()
    origins: tuple[EventOrigin, ...] = ()


def save_events(folder: Path, unconfirmed_events: UnconfirmedEvents) -> None:
    """Save the events that no screen has confirmed as stored. Log a disk error."""
    program, rows, origins = unconfirmed_events
    events = [[*row[:5], pack_message(row.text), *origin] for row, origin in zip(rows, origins, strict=True)]
    try:
        write_atomically(folder / EVENTS_FILE_NAME, json.dumps([program, events]).encode())
    except OSError as error:
        _log.warning("%d events cannot be kept in %s: %s", len(events), folder / EVENTS_FILE_NAME, error)


def pop_events(folder: Path) -> UnconfirmedEvents:
    """Return the saved events that no screen has confirmed as stored, and delete their file."""
    path = folder / EVENTS_FILE_NAME
    try:
        program, events = json.loads(path.read_bytes())
        left = UnconfirmedEvents(
            str(program),
            tuple(_row(*each[:6]) for each in events),
            tuple(EventOrigin(str(control), int(number)) for *_, control, number in events),
        )
    except FileNotFoundError:
        return UnconfirmedEvents()
    except (OSError, ValueError, TypeError) as error:
        _log.warning("the events in %s are lost: %s", path, error)
        left = UnconfirmedEvents()
    with suppress(OSError):
        path.unlink()
    return left


def _row(at: str, kind: str, text: str, line: int, record: str, packed: str) -> EventRow:
    return EventRow(str(at), str(kind), unpack_message(packed, str(text)), int(line), str(record))
