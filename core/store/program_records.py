"""Stored records of programs: versions, part counts, runs, proofs and settings.

Counts, runs and proofs are stored by the SHA-256 of the text and not by the file name. The setting
``text:NAME`` specifies which text was last loaded under a name. If a name has no such setting, its rows
come from an older version of TurnDesk, which stored them by name.
"""

from __future__ import annotations

import json
import sqlite3
from hashlib import sha256

from core.message import Message
from core.store import row_checksums, settings
from core.store.store_errors import StoreError
from core.store.store_file import (
    make_loaded_text_key,
    make_notes_setting_key,
    make_part_setting_key,
    make_stock_setting_key,
)
from core.store.store_rows import ProgramRow, ProgramVersionRow, RunRow, get_utc_now_text

_NAME_BYTES = 200
_FORBIDDEN = frozenset('/\\:*?"<>|')
_PORT_DIGITS = "123456789¹²³"
_DEVICE_NAMES = frozenset(
    ("CON", "PRN", "AUX", "NUL", *(f"{port}{digit}" for port in ("COM", "LPT") for digit in _PORT_DIGITS))
)
RECORD_KEY_PREFIX = "sha256:"  # no file name contains a colon


def check_program_name(name: str) -> None:
    """Raise StoreError if a program name has invalid characters for a file name, or is too long.

    For a new name, also call ``check_new_program_name``.
    """
    if name.strip() != name or name in {"", ".", ".."} or not name.isprintable():
        raise _make_invalid_name_error(name)
    if _FORBIDDEN & set(name) or len(name.encode()) > _NAME_BYTES:
        raise _make_invalid_name_error(name)


def check_new_program_name(name: str) -> None:
    """Raise StoreError if the name would not be a valid file name on every common operating system.

    Windows removes a final period and reserves the names of devices, with any extension. Files and records
    that already exist may have such names.
    """
    check_program_name(name)
    if name.endswith("."):
        raise _make_invalid_name_error(name)
    if name.partition(".")[0].rstrip().upper() in _DEVICE_NAMES:
        raise StoreError(
            Message("Windows reserves the name {name} for a device; use another name", name=f"{name!r}"),
            "device-name",
        )


def _make_invalid_name_error(name: str) -> StoreError:
    return StoreError(
        Message(
            "{name} is not a valid program name; use letters, digits, periods, dashes and spaces",
            name=f"{name!r}",
        ),
        "invalid-name",
    )


def save_program_version(
    connection: sqlite3.Connection, name: str, text: bytes, reason: str, author: str = ""
) -> int:
    """Save ``text`` as the newest version, and return the version number.

    A text that equals the newest version is not saved again. Raises StoreError if the name is invalid.
    """
    check_program_name(name)
    now, digest = get_utc_now_text(), sha256(text).hexdigest()
    connection.execute(
        "INSERT INTO programs (name, created) VALUES (?, ?) ON CONFLICT DO NOTHING", (name, now)
    )
    program = connection.execute("SELECT id FROM programs WHERE name = ?", (name,)).fetchone()[0]
    last = connection.execute(
        "SELECT number, sha256 FROM program_versions WHERE program = ? ORDER BY number DESC LIMIT 1",
        (program,),
    ).fetchone()
    if last is not None and last[1] == digest:
        return int(last[0])
    number = int(last[0]) + 1 if last else 1
    connection.execute(
        "INSERT INTO program_versions (program, number, text, sha256, saved, why, who)"
        " VALUES (?, ?, ?, ?, ?, ?, ?)",
        (program, number, text, digest, now, reason, author),
    )
    return number


def read_programs(connection: sqlite3.Connection) -> tuple[ProgramRow, ...]:
    """Return all programs with their newest version, sorted by name."""
    rows = connection.execute(
        "SELECT name, created, max(number), saved"
        " FROM programs JOIN program_versions ON program = programs.id"
        " GROUP BY programs.id ORDER BY name"
    )
    return tuple(ProgramRow(*row) for row in rows)


def read_versions(connection: sqlite3.Connection, name: str) -> tuple[ProgramVersionRow, ...]:
    """Return every version of a program, newest first, or () for an unknown program."""
    rows = connection.execute(
        "SELECT number, sha256, saved, why, length(text), who FROM program_versions"
        " JOIN programs ON program = programs.id WHERE name = ? ORDER BY number DESC",
        (name,),
    )
    return tuple(ProgramVersionRow(*row) for row in rows)


def load_version(connection: sqlite3.Connection, name: str, version: int | None) -> bytes:
    """Return the text of a version.

    If ``version`` is None, the newest version is returned. Raises StoreError if the version is unknown or
    does not match its checksum.
    """
    row = connection.execute(
        "SELECT number, text, sha256 FROM program_versions JOIN programs ON program = programs.id"
        " WHERE name = ? AND (number = ? OR ? IS NULL) ORDER BY number DESC LIMIT 1",
        (name, version, version),
    ).fetchone()
    if row is None:
        template = (
            "the data store has no program {name}; see the list of programs and versions"
            if version is None
            else "the data store has no version {version} of program {name}; see the list of programs and "
            "versions"
        )
        raise StoreError(Message(template, name=f"{name!r}", version=version), "no-program")
    number, text, digest = row
    if not _matches_checksum(text, digest):
        shown = _flatten_number(number)
        raise StoreError(
            Message(
                "{name} version {value} does not match its checksum; load another version or "
                "restore a backup",
                name=f"{name!r}",
                value=shown,
            ),
            "damaged-version",
        )
    return bytes(text)


def find_damaged_versions(connection: sqlite3.Connection) -> tuple[str, ...]:
    """Return the name and number of every version whose text does not match its checksum."""
    rows = connection.execute(
        "SELECT name, number, text, sha256 FROM program_versions JOIN programs ON program = programs.id"
    )
    return tuple(
        Message("{name} version {number}", name=f"{name!r}", number=_flatten_number(number))
        for name, number, text, digest in rows
        if not _matches_checksum(text, digest)
    )


def _flatten_number(number: object) -> str:
    """Return a version number as one line of text, because a damaged number can be any text."""
    return " ".join(str(number).split())


def _matches_checksum(text: object, digest: object) -> bool:
    """Return whether a stored text matches its checksum. Values that are not bytes never match."""
    return isinstance(text, bytes) and sha256(text).hexdigest() == digest


def read_part_count(connection: sqlite3.Connection, program: str) -> int:
    """Return the number of parts made since the last reset of the count, or 0 if the row is damaged."""
    row = row_checksums.read_intact_row(connection, "part_counts", find_loaded_text_key(connection, program))
    return _count(row[1]) if row else 0


def _count(value: row_checksums.ColumnValue) -> int:
    return value if isinstance(value, int) else 0


def add_parts(connection: sqlite3.Connection, program: str, added_count: int, counted_at: str) -> None:
    """Add ``added_count`` parts to the part count.

    A negative ``added_count`` subtracts parts, down to zero.
    """
    program = find_loaded_text_key(connection, program)
    count = max(0, read_part_count(connection, program) + added_count)
    connection.execute(
        "INSERT INTO part_counts VALUES (?1, ?2, ?3)"
        " ON CONFLICT (program) DO UPDATE SET count = ?2, last = ?3",
        (program, count, counted_at),
    )


def reset_parts(connection: sqlite3.Connection, program: str) -> None:
    """Reset the part count of a program to zero."""
    key = find_loaded_text_key(connection, program)
    connection.execute("DELETE FROM part_counts WHERE program = ?", (key,))


def read_run_records(connection: sqlite3.Connection) -> tuple[RunRow, ...]:
    """Return the run record of each program name, sorted by name.

    Each record is that of the text that was last loaded under the name. Damaged rows are omitted.
    """
    records, names = read_run_records_by_text(connection), read_keys_by_name(connection)
    names |= {key: key for key in records if not key.startswith(RECORD_KEY_PREFIX) and key not in names}
    return tuple(records[key]._replace(program=name) for name, key in sorted(names.items()) if key in records)


def read_run_records_by_text(connection: sqlite3.Connection) -> dict[str, RunRow]:
    """Return the run record of each program text, by record key. Damaged rows are omitted."""
    runs = row_checksums.read_intact_rows(connection, "runs")
    counts = row_checksums.read_intact_rows(connection, "part_counts")
    return {str(key): _run(str(key), runs.get(key), counts.get(key)) for key in runs.keys() | counts.keys()}


def _run(program: str, run: row_checksums.RowValues | None, count: row_checksums.RowValues | None) -> RunRow:
    parts = _count(count[1]) if count else 0
    return (
        RunRow._make((program, parts, *row_checksums.decode_values(run[1:])))
        if run
        else RunRow(program, parts)
    )


def record_run_start(connection: sqlite3.Connection, program: str, started_at: str) -> None:
    """Record that a run of the program started at ``started_at``."""
    key = _row(connection, program)
    connection.execute("UPDATE runs SET started = ?, outcome = '' WHERE program = ?", (started_at, key))


def record_run_outcome(connection: sqlite3.Connection, program: str, outcome: str) -> None:
    """Record the outcome of the last run of a program."""
    key = _row(connection, program)
    connection.execute("UPDATE runs SET outcome = ? WHERE program = ?", (outcome, key))


def record_interrupted_runs(connection: sqlite3.Connection, outcome: str) -> tuple[str, ...]:
    """Record ``outcome`` for all runs that have no end, and return the names of their programs."""
    rows = connection.execute(
        "UPDATE runs SET outcome = ? WHERE started IS NOT NULL AND coalesce(outcome, '') = ''"
        " RETURNING program",
        (outcome,),
    )
    names = {key: name for name, key in read_keys_by_name(connection).items()}
    return tuple(sorted(names.get(program, program) for (program,) in rows))


def record_complete_cycles(
    connection: sqlite3.Connection,
    program: str,
    last_cycle_time_s: float,
    cycle_count: int,
    shortest_cycle_time_s: float,
) -> None:
    """Record complete cycles, with the time of the last cycle and the shortest time, in seconds.

    A stored shortest time of zero is replaced, because older versions stored zero for a part that was
    finished after a restart.
    """
    key = _row(connection, program)
    connection.execute(
        "UPDATE runs SET cycles = cycles + ?3, latest = ?1, best = min(coalesce(nullif(best, 0.0), ?4), ?4)"
        " WHERE program = ?2",
        (last_cycle_time_s, key, cycle_count, shortest_cycle_time_s),
    )


def record_proof(
    connection: sqlite3.Connection, program: str, result: str, cycle_time_s: float | None, proved_at: str
) -> None:
    """Record the result of a proof at ``proved_at`` and its calculated cycle time (s), if known."""
    key = _row(connection, program)
    connection.execute(
        "UPDATE runs SET proved = ?, proof = ?, planned = ? WHERE program = ?",
        (proved_at, result, cycle_time_s, key),
    )


def transfer_records(connection: sqlite3.Connection, old_name: str, new_name: str) -> None:
    """Transfer the versions, counts, run records, settings and measured features to a new name.

    If the new name already has versions or features, these remain, and those of the old name are not
    transferred. Raises StoreError if the new name is invalid.
    """
    check_new_program_name(new_name)
    connection.execute(
        "UPDATE programs SET name = ?2 WHERE name = ?1 AND NOT EXISTS"
        " (SELECT 1 FROM programs WHERE name = ?2)",
        (old_name, new_name),
    )
    for table in ("part_cycles", "production_stops", "jobs"):
        connection.execute(f"UPDATE {table} SET program = ? WHERE program = ?", (new_name, old_name))
    connection.execute(
        "UPDATE part_features SET program = ?2 WHERE program = ?1 AND NOT EXISTS"
        " (SELECT 1 FROM part_features WHERE program = ?2 AND retired = 0)",
        (old_name, new_name),
    )
    for table in ("runs", "part_counts"):
        connection.execute(f"DELETE FROM {table} WHERE program = ?", (new_name,))
        connection.execute(f"UPDATE {table} SET program = ? WHERE program = ?", (new_name, old_name))
    for key in (make_stock_setting_key, make_part_setting_key, make_notes_setting_key, make_loaded_text_key):
        connection.execute("DELETE FROM settings WHERE key = ?", (key(new_name),))
        connection.execute("UPDATE settings SET key = ? WHERE key = ?", (key(new_name), key(old_name)))


def _row(connection: sqlite3.Connection, program: str) -> str:
    """Return the record key of a program, and create its row in the table ``runs`` if it is missing."""
    key = find_loaded_text_key(connection, program)
    connection.execute("INSERT INTO runs (program) VALUES (?) ON CONFLICT DO NOTHING", (key,))
    return key


def make_text_record_key(text: str) -> str:
    """Return the record key of a program text."""
    return make_bytes_record_key(text.encode("utf-8", "surrogateescape"))


def make_bytes_record_key(data: bytes) -> str:
    """Return the record key of a stored version that is given as bytes."""
    return RECORD_KEY_PREFIX + sha256(data).hexdigest()


def find_loaded_text_key(connection: sqlite3.Connection, program: str) -> str:
    """Return the record key of the text that was last loaded under a name.

    If ``program`` is a record key, it is returned unchanged.
    """
    if program.startswith(RECORD_KEY_PREFIX):
        return program
    stored = settings.read_setting(connection, make_loaded_text_key(program))
    return stored if isinstance(stored, str) and stored.startswith(RECORD_KEY_PREFIX) else program


def read_keys_by_name(connection: sqlite3.Connection) -> dict[str, str]:
    """Return the record keys of all program names that have a record key."""
    rows = connection.execute(
        "SELECT key, value FROM settings WHERE key LIKE ? || '%'", (make_loaded_text_key(""),)
    )
    found = ((str(key).removeprefix(make_loaded_text_key("")), _loaded(value)) for key, value in rows)
    return {name: key for name, key in found if key}


def _loaded(value: object) -> str:
    try:
        key = json.loads(str(value))
    except ValueError:
        return ""  # a damaged row, which is reported when the store is opened
    return key if isinstance(key, str) and key.startswith(RECORD_KEY_PREFIX) else ""


def assign_rows_to_text(connection: sqlite3.Connection, program: str) -> None:
    """Assign rows that an older version stored by program name to the program text of the last proof.

    Nothing changes if this text is unknown.
    """
    row = connection.execute(
        "SELECT sha256 FROM program_versions JOIN programs ON program = programs.id"
        " WHERE name = ?1 AND saved <= coalesce((SELECT proved FROM runs WHERE program = ?1), '')"
        " ORDER BY number DESC LIMIT 1",
        (program,),
    ).fetchone()
    if row is None:
        return
    for table in ("runs", "part_counts"):
        connection.execute(
            f"UPDATE OR IGNORE {table} SET program = ? WHERE program = ?",
            (f"{RECORD_KEY_PREFIX}{row[0]}", program),
        )
