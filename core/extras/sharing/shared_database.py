"""Sharing of programs in a PostgreSQL database.

Rows are added in one transaction and never changed. Connection strings are interpreted as by libpq and
shown without secrets. Connections to other computers use TLS.
"""

from __future__ import annotations

import importlib.util
import os
import ssl
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from ipaddress import ip_address
from pathlib import Path
from typing import TYPE_CHECKING, Any

from core.extras.sharing.shared_location import (
    Found,
    PublishedVersion,
    SharingError,
    SharingErrorCause,
    make_database_label,
)
from core.extras.sharing.shared_versions import SharedVersion
from core.extras.sharing.version_record import (
    FORMAT_VERSION,
    MAX_PROGRAM_BYTES,
    MAX_RECORD_BYTES,
    MAX_STATE_BYTES,
    PublishedMachineState,
    RecordError,
    decode_machine_state,
    decode_version,
    encode_version,
    verify_text,
)
from core.message import Message

if TYPE_CHECKING:
    import psycopg


_SHOWN = ("service", "user", "host", "hostaddr", "port", "dbname")
_VERIFIED = {"verify-ca", "verify-full"}


def parse_conninfo(connection_string: str) -> dict[str, str]:
    """Return the parameters of a connection string.

    Raises SharingError if the string is invalid or psycopg is not installed; the message does not contain
    the parameters.
    """
    if importlib.util.find_spec("psycopg") is None:
        raise SharingErrorCause.NO_PSYCOPG.make_error("")
    import psycopg  # noqa: PLC0415  optional, and only for those who share so
    from psycopg.conninfo import conninfo_to_dict  # noqa: PLC0415

    try:
        found = {key: str(value) for key, value in conninfo_to_dict(connection_string).items() if value}
    except psycopg.Error:  # its message quotes the text that libpq could not read
        found = {"port": "?"}
    # In an address, a password character that is not percent-encoded ends up in another parameter.
    misread = "://" in connection_string and "@" in found.get("host", "") + found.get("dbname", "")
    if misread or not found.get("port", "0").replace(",", "").isdigit():
        raise SharingErrorCause.UNREADABLE.make_error("")
    return found


def get_display_parameters(values: Mapping[str, str]) -> str:
    """Return the connection parameters as text for messages, without secrets.

    A note is added if the server's certificate is not verified.
    """
    named = " ".join(f"{key}={values[key]}" for key in _SHOWN if key in values)
    return (
        named
        if is_server_local(values) or values.get("sslmode") in _VERIFIED
        else Message("{named} (TLS certificate not verified)", named=named)
    )


def require_tls(values: Mapping[str, str]) -> dict[str, str]:
    """Return the connection parameters, with TLS verification added for a server on another computer.

    TLS settings in the parameters or in environment variables take precedence.
    """
    found = dict(values)
    if is_server_local(values):
        return found
    found.setdefault("sslmode", os.environ.get("PGSSLMODE") or "verify-full")
    own = Path("~/.postgresql/root.crt").expanduser()
    if found["sslmode"] in _VERIFIED and not own.exists() and "PGSSLROOTCERT" not in os.environ:
        found.setdefault("sslrootcert", ssl.get_default_verify_paths().cafile or "system")
    return found


def is_server_local(values: Mapping[str, str]) -> bool:
    """Return whether the connection parameters refer to a server on this computer."""
    if "service" in values:
        return False
    hosts = values.get("hostaddr") or values.get("host") or os.environ.get("PGHOST", "")
    return all(map(_is_here, hosts.split(",")))


def _is_here(host: str) -> bool:
    if host in {"", "localhost"} or host.startswith(("/", "@")):  # / and @ begin the names of sockets
        return True
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


_LAYOUT = """
CREATE SCHEMA IF NOT EXISTS turndesk;
CREATE TABLE IF NOT EXISTS turndesk.layout (format integer PRIMARY KEY);
CREATE TABLE IF NOT EXISTS turndesk.versions (
    id text PRIMARY KEY, record bytea NOT NULL, program_text bytea NOT NULL
);
CREATE TABLE IF NOT EXISTS turndesk.desks (home text PRIMARY KEY, state bytea NOT NULL);
"""
_ADD = "INSERT INTO turndesk.versions VALUES (%s, %s, %s) ON CONFLICT DO NOTHING"
_TELL = "INSERT INTO turndesk.desks VALUES (%s, %s) ON CONFLICT (home) DO UPDATE SET state = excluded.state"
# Values that are too long are truncated, so that they are treated as strays.
_DESKS = "SELECT home, substr(state, 1, %s) FROM turndesk.desks"
_LIMITS = {
    "connect_timeout": 5,
    "application_name": "turndesk",
    "options": "-c statement_timeout=30s -c lock_timeout=10s -c synchronous_commit=on",
    "keepalives_idle": 10,
    "tcp_user_timeout": 15_000,  # ms, to detect a lost network
}
_AT_ONCE = 500  # records per query
# Messages of a server that rejects a connection. libpq returns them without a code. libpq may try twice, with
# and without TLS. The first matching cause in this table is the one to correct.
_AT_THE_DOOR: tuple[tuple[SharingErrorCause, tuple[str, ...]], ...] = (
    (SharingErrorCause.WRONG_PASSWORD, ("authentication failed", "no password supplied")),
    (SharingErrorCause.NOT_TRUSTED, ("certificate", "ssl error")),
    (SharingErrorCause.NO_TLS, ("does not support ssl",)),
    (SharingErrorCause.TLS_ONLY, ("no encryption",)),
    (SharingErrorCause.NO_RIGHT, ("no pg_hba.conf entry", "permission denied")),
    (SharingErrorCause.NOT_THERE, ("does not exist",)),
    (SharingErrorCause.FULL, ("no space left",)),
)
# Causes by the first characters of the server's error codes.
_CODES: tuple[tuple[SharingErrorCause, tuple[str, ...]], ...] = (
    (SharingErrorCause.NO_RIGHT, ("42501", "28", "25006")),
    (SharingErrorCause.NOT_BEGUN, ("42P01", "3F000")),
    (SharingErrorCause.OTHER, ("42", "22")),
    (SharingErrorCause.FULL, ("53100",)),
    (SharingErrorCause.NOT_THERE, ("3D000",)),
)


class SharedDatabase:
    """A PostgreSQL database in which machines share programs.

    ``conninfo`` is an address or a connection string of libpq, such as ``host=shop-pc dbname=shop
    user=lathe3``. Each call opens and closes a connection, so a restart of the server affects at most one
    call.
    """

    def __init__(self, conninfo: str) -> None:
        self.name, self._conninfo = (
            make_database_label("([sharing] postgresql in the machine file)"),
            conninfo,
        )
        with suppress(SharingError):  # reported when the database is used
            self.name = make_database_label(get_display_parameters(require_tls(parse_conninfo(conninfo))))

    def set_up(self) -> None:
        """Create the schema and the tables in one transaction."""
        with self._open_transaction(is_setup_required=False) as connection:
            connection.execute(_LAYOUT)
            connection.execute(
                "INSERT INTO turndesk.layout SELECT %s WHERE NOT EXISTS (SELECT 1 FROM turndesk.layout)",
                (FORMAT_VERSION,),
            )
            self._demand(connection)

    def read_contents(self, known_versions: Mapping[str, SharedVersion]) -> Found:
        """Return the ids of all versions, and the records of the versions that the caller does not know."""
        with self._open_transaction() as connection:
            there = {str(row[0]) for row in connection.execute("SELECT id FROM turndesk.versions")}
            wanted, fresh, strays = sorted(there - known_versions.keys()), list[SharedVersion](), list[str]()
            for first in range(0, len(wanted), _AT_ONCE):
                query = "SELECT id, substr(record, 1, %s) FROM turndesk.versions WHERE id = ANY(%s)"
                some = wanted[first : first + _AT_ONCE]
                for name, record in connection.execute(query, (MAX_RECORD_BYTES, some)):
                    try:
                        fresh.append(decode_version(name, bytes(record)))
                    except RecordError:
                        strays.append(name)
            desks = self._desks(connection, strays)
        return Found(frozenset(there - set(strays)), tuple(fresh), desks, tuple(strays))

    def publish_versions(self, versions: Sequence[PublishedVersion], state: PublishedMachineState) -> None:
        """Add versions and the state of this machine in one transaction.

        The method returns after the server has written the data to its disk.
        """
        with self._open_transaction() as connection:
            rows = [(each.version.id, encode_version(each.version), each.program_text) for each in versions]
            if rows:
                connection.cursor().executemany(_ADD, rows)
            connection.execute(_TELL, (state.machine_id, state.encode_state()))

    def read_text(self, version: SharedVersion) -> bytes:
        """Return the text of a version from its row, after checking it against its checksum."""
        query = "SELECT substr(program_text, 1, %s) FROM turndesk.versions WHERE id = %s"
        with self._open_transaction() as connection:
            row = connection.execute(query, (MAX_PROGRAM_BYTES + 1, version.id)).fetchone()
        try:
            return verify_text(version, bytes(row[0]) if row is not None else b"")
        except RecordError as error:
            raise SharingErrorCause.DAMAGED.make_error(self.name, error) from error

    @staticmethod
    def _desks(connection: psycopg.Connection, strays: list[str]) -> tuple[PublishedMachineState, ...]:
        found = []
        for home, state in connection.execute(_DESKS, (MAX_STATE_BYTES,)):
            try:
                found.append(decode_machine_state(home, bytes(state)))
            except RecordError:
                strays.append(home)
        return tuple(found)

    def _demand(self, connection: psycopg.Connection) -> None:
        row = connection.execute("SELECT max(format) FROM turndesk.layout").fetchone()
        number = row[0] if row is not None else None
        if number is None:
            raise SharingErrorCause.NOT_BEGUN.make_error(self.name)
        if number != FORMAT_VERSION:
            raise SharingErrorCause.NEWER.make_error(self.name, number)

    @contextmanager
    def _open_transaction(self, *, is_setup_required: bool = True) -> Iterator[psycopg.Connection]:
        """Open a connection with one transaction, and convert errors of the server to SharingError."""
        values: dict[str, Any] = require_tls(parse_conninfo(self._conninfo))
        import psycopg  # noqa: PLC0415  optional, and only for those who share so

        try:
            with psycopg.connect(**{**values, **_LIMITS}) as connection:
                if is_setup_required:
                    self._demand(connection)
                yield connection
        except psycopg.Error as error:
            raise self._refusal(error.sqlstate or "", str(error)) from error

    def _refusal(self, code: str, error_text: str) -> SharingError:
        lines = [line for line in error_text.splitlines() if line.strip()] or ["it failed"]
        for cause, begins in _CODES if code else ():
            if code.startswith(begins):
                return cause.make_error(self.name, _bare(lines[0]))
        for cause, signs in _AT_THE_DOOR if not code else ():
            said = next((line for line in lines if any(sign in line.lower() for sign in signs)), "")
            if said:
                return cause.make_error(self.name, _bare(said))
        return SharingErrorCause.AWAY.make_error(self.name, _bare(lines[0]))


def _bare(line: str) -> str:
    """Return only the cause from the message of a failed connection."""
    return line.rpartition(" failed: ")[2].removeprefix("FATAL:")
