"""What each program has done: last run, cycle times, last proof. One row a program."""

from __future__ import annotations

import sqlite3

from core.store.programs import check_name
from core.store.rows import RunRow, utc_now


def all_of(connection: sqlite3.Connection) -> tuple[RunRow, ...]:
    """Every program that was run, proved or counted, by name."""
    rows = connection.execute(
        "SELECT names.program, coalesce(count, 0), started, coalesce(outcome, ''), coalesce(cycles, 0),"
        " best, latest, proved, coalesce(proof, ''), planned"
        " FROM (SELECT program FROM runs UNION SELECT program FROM part_counts) AS names"
        " LEFT JOIN runs ON runs.program = names.program"
        " LEFT JOIN part_counts ON part_counts.program = names.program ORDER BY names.program"
    )
    return tuple(RunRow(*row) for row in rows)


def started(connection: sqlite3.Connection, program: str, at: str = "") -> None:
    """A run begins, now if not said otherwise."""
    _row(connection, program)
    connection.execute(
        "UPDATE runs SET started = ?, outcome = '' WHERE program = ?", (at or utc_now(), program)
    )


def ended(connection: sqlite3.Connection, program: str, outcome: str) -> None:
    """How the run ended."""
    _row(connection, program)
    connection.execute("UPDATE runs SET outcome = ? WHERE program = ?", (outcome, program))


def cut_off(connection: sqlite3.Connection, outcome: str) -> tuple[str, ...]:
    """Runs that began and never ended get this outcome; their programs."""
    rows = connection.execute(
        "UPDATE runs SET outcome = ? WHERE started IS NOT NULL AND coalesce(outcome, '') = ''"
        " RETURNING program",
        (outcome,),
    )
    return tuple(sorted(program for (program,) in rows))


def finished(
    connection: sqlite3.Connection,
    program: str,
    seconds: float,
    *,
    count: int = 1,
    best: float | None = None,
) -> None:
    """Whole cycles: the time of the last one, and the best of all of them."""
    _row(connection, program)
    connection.execute(
        "UPDATE runs SET cycles = cycles + ?3, latest = ?1, best = min(coalesce(best, ?4), ?4)"
        " WHERE program = ?2",
        (seconds, program, count, seconds if best is None else best),
    )


def proved(
    connection: sqlite3.Connection, program: str, result: str, planned: float | None, at: str = ""
) -> None:
    """What proving found, and the cycle time that it reckons with; None: none."""
    _row(connection, program)
    connection.execute(
        "UPDATE runs SET proved = ?, proof = ?, planned = ? WHERE program = ?",
        (at or utc_now(), result, planned, program),
    )


def renamed(connection: sqlite3.Connection, old: str, new: str) -> None:
    """Versions, count and record go with a program that gets another name.

    Versions that are kept under the new name already stay, and then those of the old name stay too.
    """
    check_name(new)
    connection.execute(
        "UPDATE programs SET name = ?2 WHERE name = ?1 AND NOT EXISTS"
        " (SELECT 1 FROM programs WHERE name = ?2)",
        (old, new),
    )
    for table in ("runs", "part_counts"):
        connection.execute(f"DELETE FROM {table} WHERE program = ?", (new,))
        connection.execute(f"UPDATE {table} SET program = ? WHERE program = ?", (new, old))


def _row(connection: sqlite3.Connection, program: str) -> None:
    connection.execute("INSERT INTO runs (program) VALUES (?) ON CONFLICT DO NOTHING", (program,))
