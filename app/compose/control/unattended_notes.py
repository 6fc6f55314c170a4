"""Files that a control without a screen writes: its events and its interrupted job."""

from __future__ import annotations

import json
import logging
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from core.executor.snapshot import InterruptedJob, convert_interrupted_job_to_json, parse_interrupted_job
from core.file_replacement import write_atomically
from core.message import pack_message, unpack_message
from core.store.production.part_cycles import CycleRow, ProductionRow, ProductionStopRow
from core.store.store_rows import EventOrigin, EventRow

_log = logging.getLogger(__name__)
NOTE_FILE_NAME = "interrupted.json"
EVENTS_FILE_NAME = "left_events.json"


def save_interruption_note(folder: Path, job: InterruptedJob | None) -> None:
    """Save a note with the interrupted job, or with None if no job was interrupted.

    A disk error is logged.
    """
    try:
        write_atomically(
            folder / NOTE_FILE_NAME,
            json.dumps(None if job is None else convert_interrupted_job_to_json(job)).encode(),
        )
    except OSError as error:
        _log.warning("the interrupted job cannot be kept in %s: %s", folder / NOTE_FILE_NAME, error)


def pop_interruption_note(folder: Path) -> tuple[bool, InterruptedJob | None]:
    """Return whether a control without a screen saved a note, and the interrupted job in the note.

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


def delete_interruption_note(folder: Path) -> None:
    """Delete the note of the interrupted job, because a connected screen has stored its contents."""
    with suppress(OSError):
        (folder / NOTE_FILE_NAME).unlink(missing_ok=True)


class UnconfirmedEvent(NamedTuple):
    """Event that no screen has confirmed, with its origin and the rows of cycles and stops it changed."""

    event_row: EventRow
    origin: EventOrigin
    production_rows: tuple[ProductionRow, ...] = ()


class UnconfirmedEvents(NamedTuple):
    """Events that no screen has confirmed, with their program."""

    program_name: str = ""
    events: tuple[UnconfirmedEvent, ...] = ()


def save_unconfirmed_events(folder: Path, unconfirmed_events: UnconfirmedEvents) -> None:
    """Save the events that no screen has confirmed. A disk error is logged."""
    program, events = unconfirmed_events
    saved = [[*row[:5], pack_message(row.text), *origin, rows] for row, origin, rows in events]
    try:
        write_atomically(folder / EVENTS_FILE_NAME, json.dumps([program, saved]).encode())
    except OSError as error:
        _log.warning("%d events cannot be kept in %s: %s", len(events), folder / EVENTS_FILE_NAME, error)


def pop_unconfirmed_events(folder: Path) -> UnconfirmedEvents:
    """Return the saved events that no screen has confirmed as stored, and delete their file."""
    path = folder / EVENTS_FILE_NAME
    try:
        program, events = json.loads(path.read_bytes())
        left = UnconfirmedEvents(str(program), tuple(_event(*each) for each in events))
    except FileNotFoundError:
        return UnconfirmedEvents()
    except (OSError, ValueError, TypeError) as error:
        _log.warning("the events in %s are lost: %s", path, error)
        left = UnconfirmedEvents()
    with suppress(OSError):
        path.unlink()
    return left


def _event(
    at: str,
    kind: str,
    text: str,
    line: int,
    record: str,
    packed: str,
    control: str,
    number: int,
    rows: Sequence[Sequence[object]] = (),
) -> UnconfirmedEvent:
    row = EventRow(str(at), str(kind), unpack_message(packed, str(text)), int(line), str(record))
    return UnconfirmedEvent(row, EventOrigin(str(control), int(number)), tuple(map(_production_row, rows)))


def _production_row(values: Sequence[object]) -> ProductionRow:
    """Return the row of a cycle or a stop. Raises TypeError or ValueError if the values do not form a row."""
    match values:
        case [
            str() as key,
            str() as program,
            int() as part,
            str() as started,
            str() | None as ended,
            int() | float() as seconds,
            str() as outcome,
            int() | float() | None as load,
        ]:
            return CycleRow(key, program, part, started, ended, seconds, outcome, load)
        case [
            str() as key,
            str() as cycle,
            str() as program,
            str() as at,
            int() | float() as seconds,
            str() as reason,
            int() as line,
        ]:
            return ProductionStopRow(key, cycle, program, at, seconds, reason, line)
        case _:
            raise ValueError("a row is neither a cycle nor a stop")
