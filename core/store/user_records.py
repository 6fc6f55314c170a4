"""The users of the machine, with their names, access levels and hashed PINs."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from core.message import Message
from core.store import row_checksums
from core.store.store_access import StoreAccess
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from concurrent.futures import Future

MAX_NAME_LENGTH = 20


class UserRow(NamedTuple):
    """One user with a name, an access level and a hashed PIN.

    ``level`` is a value of ``core.access.access_table.AccessLevel``.
    """

    name: str
    level: int
    salt: bytes
    hash: bytes

    @property
    def has_pin(self) -> bool:
        """Return whether the user has a PIN.

        Users from a restored backup have no PIN.
        """
        return bool(self.hash)


class UserList(NamedTuple):
    """The list of users.

    ``has_damaged_row`` is True if a row does not match its checksum. The user of a damaged row cannot log
    in.
    """

    rows: tuple[UserRow, ...] = ()
    has_damaged_row: bool = False

    @property
    def is_access_restricted(self) -> bool:
        """Return whether the access levels apply.

        They apply if the list contains a user or a damaged row.
        """
        return bool(self.rows) or self.has_damaged_row

    def find_user(self, name: str) -> UserRow | None:
        """Return the user with this name, or None if the name is unknown.

        Case is ignored.
        """
        return next((row for row in self.rows if row.name.casefold() == name.strip().casefold()), None)


def read_user_list(connection: sqlite3.Connection) -> UserList:
    """Return the list of users, in descending order of their levels."""
    rows = [
        UserRow(str(name), level, salt, hashed)
        for name, (_, level, salt, hashed) in row_checksums.read_intact_rows(connection, "people").items()
        if isinstance(level, int) and isinstance(salt, bytes) and isinstance(hashed, bytes)
    ]
    damaged = bool(row_checksums.find_broken_rows(connection, "people"))
    return UserList(tuple(sorted(rows, key=lambda row: (-row.level, row.name))), damaged)


def normalize_user_name(name: str) -> str:
    """Return a user name in capitals, as it is stored. Raises StoreError if the name is invalid."""
    name = " ".join(name.split()).upper()
    if not name or len(name) > MAX_NAME_LENGTH or not name.isprintable():
        raise StoreError(
            Message("a name must have 1 to {name_longest} characters", name_longest=MAX_NAME_LENGTH),
            "invalid-name",
        )
    return name


def save_user(connection: sqlite3.Connection, row: UserRow) -> None:
    """Add a user, or replace the level and PIN of a user.

    Raises StoreError if the name is invalid, or if no user with SERVICE level would remain.
    """
    row = row._replace(name=normalize_user_name(row.name))
    connection.execute("DELETE FROM people WHERE name = ?", (row.name,))
    connection.execute("INSERT INTO people VALUES (?, ?, ?, ?)", row)
    _demand_service(connection)


def remove_user(connection: sqlite3.Connection, name: str) -> None:
    """Remove a user.

    The last user in the list may be removed. Raises StoreError if the name is unknown, or if other users
    remain and none of them has SERVICE level.
    """
    if not connection.execute("DELETE FROM people WHERE name = ?", (name,)).rowcount:
        raise StoreError(Message("{name} is not in the list of users", name=name), "unknown-person")
    _demand_service(connection)


def remove_all_users(connection: sqlite3.Connection) -> int:
    """Remove all users, which also disables the access levels, and return the number of removed users."""
    return connection.execute("DELETE FROM people").rowcount


def replace_all_users(connection: sqlite3.Connection, rows: Iterable[UserRow]) -> None:
    """Replace all users with the users in ``rows``."""
    connection.execute("DELETE FROM people")
    connection.executemany("INSERT INTO people VALUES (?, ?, ?, ?)", rows)


def erase_pins(connection: sqlite3.Connection) -> None:
    """Erase all PINs from a copy of the store, including its free pages. Names and levels remain."""
    rows = (
        read_user_list(connection).rows
        if row_checksums.list_checksummed_columns(connection, "people")
        else ()
    )
    if rows:
        row_checksums.create_checksum_triggers(connection)
        replace_all_users(connection, [row._replace(salt=b"", hash=b"") for row in rows])
        connection.execute("VACUUM")


def _demand_service(connection: sqlite3.Connection) -> None:
    """Raise StoreError if the list has users but none with SERVICE level.

    Only a user with SERVICE level can add other users.
    """
    levels = {level for (level,) in connection.execute("SELECT level FROM people")}
    if levels and max(levels) < 3:
        raise StoreError(
            "the list of users must contain one user with SERVICE level who can add the others; "
            "add this user first",
            "last-service-person",
        )


class UserRecords:
    """The list of users of an open store. Methods raise StoreError as described in ``StoreAccess``."""

    def __init__(self, store: StoreAccess) -> None:
        self._store = store

    def read_users(self) -> UserList:
        """Return all users.

        Without users, access is not restricted.
        """
        return self._store.run_query(read_user_list)

    def save_user(self, row: UserRow) -> Future[None]:
        """Add a user, or replace the level and PIN of a user.

        The future raises StoreError for an invalid name, and if no user with SERVICE level would remain.
        """
        return self._store.write(lambda c: save_user(c, row))

    def remove_user(self, name: str) -> Future[None]:
        """Remove a user.

        The last user in the list may be removed. The future raises StoreError if the name is unknown, or if
        other users remain and none of them has SERVICE level.
        """
        return self._store.write(lambda c: remove_user(c, name))

    def remove_all_users(self) -> Future[int]:
        """Remove all users, which also disables the access levels.

        The result is the number of removed users.
        """
        return self._store.write(remove_all_users)
