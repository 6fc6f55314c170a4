"""Which text a program's record belongs to.

Counts, runs and proofs are stored by the SHA-256 of the text, never by a file name. The setting
``text:NAME`` states which text was last loaded under a name. A name without one has rows of an older
version of TurnDesk, which stored them by name.
"""

from __future__ import annotations

import json
import sqlite3
from hashlib import sha256

from core.store import event_log
from core.store.program_settings import text_key

PREFIX = "sha256:"  # no file name contains a colon


def key_of_text(text: str) -> str:
    """Return the key under which the record of this program text is stored."""
    return key_of_bytes(text.encode("utf-8", "surrogateescape"))


def key_of_bytes(data: bytes) -> str:
    """Return the same for a stored version."""
    return PREFIX + sha256(data).hexdigest()


def key_of(connection: sqlite3.Connection, program: str) -> str:
    """Return the record key of a name; a key is returned as it is."""
    if program.startswith(PREFIX):
        return program
    stored = event_log.setting(connection, text_key(program))
    return stored if isinstance(stored, str) and stored.startswith(PREFIX) else program


def names(connection: sqlite3.Connection) -> dict[str, str]:
    """Return the record key of every name that has one."""
    rows = connection.execute("SELECT key, value FROM settings WHERE key LIKE ? || '%'", (text_key(""),))
    found = ((str(key).removeprefix(text_key("")), _loaded(value)) for key, value in rows)
    return {name: key for name, key in found if key}


def _loaded(value: object) -> str:
    try:
        key = json.loads(str(value))
    except ValueError:
        return ""  # a damaged row, which is reported when the store is opened
    return key if isinstance(key, str) and key.startswith(PREFIX) else ""


def adopt(connection: sqlite3.Connection, program: str) -> None:
    """Move rows that an older version stored by name to the text that was proved then, if it is known."""
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
            f"UPDATE OR IGNORE {table} SET program = ? WHERE program = ?", (f"{PREFIX}{row[0]}", program)
        )
