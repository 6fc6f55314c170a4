"""Settings of the store: JSON values by key."""

from __future__ import annotations

import json
import sqlite3
from typing import TYPE_CHECKING

from core.message import Message
from core.store import row_checksums
from core.store.store_access import StoreAccess
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from concurrent.futures import Future


def read_setting(connection: sqlite3.Connection, key: str) -> object:
    """Return the value that is stored under ``key``.

    The result is None if the value is not set or does not match its checksum.
    """
    row = row_checksums.read_intact_row(connection, "settings", key)
    return json.loads(str(row_checksums.decode_values(row)[1])) if row else None


def save_setting(connection: sqlite3.Connection, key: str, value: object) -> None:
    """Store a value under ``key``, or delete the key if the value is None.

    Raises StoreError if JSON cannot represent the value.
    """
    if value is None:
        connection.execute("DELETE FROM settings WHERE key = ?", (key,))
        return
    text = encode_setting(key, value)
    connection.execute(
        "INSERT INTO settings VALUES (?, ?) ON CONFLICT (key) DO UPDATE SET value = excluded.value",
        (key, text),
    )


def encode_setting(key: str, value: object) -> str:
    """Return a value as JSON.

    Raises StoreError, with ``key`` in the message, if JSON cannot represent the value.
    """
    try:
        return json.dumps(value, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise StoreError(
            Message("the setting {key} cannot be stored: {error}", key=key, error=error), "unstorable-setting"
        ) from error


class Settings:
    """Settings of an open store. Methods raise StoreError as described in ``StoreAccess``."""

    def __init__(self, store: StoreAccess) -> None:
        self._store = store

    def read_setting(self, key: str) -> object:
        """Return the value that is stored under ``key``, or None if it is not set."""
        return self._store.run_query(read_setting, key)

    def save_setting(self, key: str, value: object) -> Future[None]:
        """Store a value under ``key``, or delete the key if the value is None.

        Raises StoreError if JSON cannot represent the value.
        """
        encode_setting(key, value)
        return self._store.store_latest_operation(("setting", key), lambda c: save_setting(c, key, value))
