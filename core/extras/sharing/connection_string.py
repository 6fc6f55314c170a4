"""A PostgreSQL connection string as libpq reads it: its name without secrets, TLS to other computers."""

from __future__ import annotations

import importlib.util
import os
import ssl
from collections.abc import Mapping
from ipaddress import ip_address
from pathlib import Path

from core.extras.sharing.sharing_errors import Cause
from core.message import Message

_SHOWN = ("service", "user", "host", "hostaddr", "port", "dbname")
_VERIFIED = {"verify-ca", "verify-full"}


def parsed(conninfo: str) -> dict[str, str]:
    """The parameters that libpq reads. Raises SharingError, which repeats none of them."""
    if importlib.util.find_spec("psycopg") is None:
        raise Cause.NO_PSYCOPG.error("")
    import psycopg  # noqa: PLC0415  optional, and only for those who share so
    from psycopg.conninfo import conninfo_to_dict  # noqa: PLC0415

    try:
        found = {key: str(value) for key, value in conninfo_to_dict(conninfo).items() if value}
    except psycopg.Error:  # its sentence has the words that libpq could not read
        found = {"port": "?"}
    # In an address, a sign of the password that is not written as %.. ends up in another parameter.
    misread = "://" in conninfo and "@" in found.get("host", "") + found.get("dbname", "")
    if misread or not found.get("port", "0").replace(",", "").isdigit():
        raise Cause.UNREADABLE.error("")
    return found


def shown(values: Mapping[str, str]) -> str:
    """The parameters that sentences may name; also whether the server's certificate goes unchecked."""
    named = " ".join(f"{key}={values[key]}" for key in _SHOWN if key in values)
    return (
        named
        if is_local(values) or values.get("sslmode") in _VERIFIED
        else Message("{named} (TLS certificate not verified)", named=named)
    )


def with_tls(values: Mapping[str, str]) -> dict[str, str]:
    """The parameters; a server elsewhere has to prove who it is, unless they or the system say otherwise."""
    found = dict(values)
    if is_local(values):
        return found
    found.setdefault("sslmode", os.environ.get("PGSSLMODE") or "verify-full")
    own = Path("~/.postgresql/root.crt").expanduser()
    if found["sslmode"] in _VERIFIED and not own.exists() and "PGSSLROOTCERT" not in os.environ:
        found.setdefault("sslrootcert", ssl.get_default_verify_paths().cafile or "system")
    return found


def is_local(values: Mapping[str, str]) -> bool:
    """Return whether the server is on this computer, as far as the parameters say."""
    if "service" in values:
        return False
    hosts = values.get("hostaddr") or values.get("host") or os.environ.get("PGHOST", "")
    return all(map(_is_here, hosts.split(",")))


def _is_here(host: str) -> bool:
    if host in {"", "localhost"} or host.startswith(("/", "@")):  # the latter are sockets
        return True
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False
