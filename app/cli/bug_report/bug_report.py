"""Bug report on the installation, machine file and program, with the latest crash and log lines."""

from __future__ import annotations

import getpass
import os
import platform
import socket
import sqlite3
import tomllib
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import NamedTuple

import resources
from app import VERSION
from app.cli.bug_report.private_texts import (
    format_message_without_names,
    mask_machine_file,
    mask_program_texts,
    remove_scope_record_name,
)
from app.cli.bug_report.replaced_names import PrivateValueReplacer
from app.compose.machine.machine_setup import read_machine_file_in_use
from app.desk.command_errors import CommandError
from app.desk.data_folder import find_data_folder
from core.message import CodedError, Message
from core.store.store import Store

MAX_LOG_LINES = 40  # newest lines of each log
_MOST_BYTES = 200_000  # of a program, a machine file or a crash file
_PACKAGES = ("PySide6-Essentials", "numpy", "pyqtgraph", "pyserial", "canopen", "python-can", "psycopg")
_DISPLAY = ("XDG_SESSION_TYPE", "QT_QPA_PLATFORM", "LANG")
_WITH_NAMES = ("who", "program", "person")
"""Columns of any store table that contain user names or program names."""


class ReportPart(NamedTuple):
    """One titled part of the bug report."""

    title: str
    text: str


class _StoredData(NamedTuple):
    """Data from the TurnDesk store that the bug report uses."""

    user_names: frozenset[str] = frozenset()
    program_names: frozenset[str] = frozenset()
    machine_file: str | None = None
    latest_program: tuple[str, str] | None = None  # name and text of the program that was started last
    event_texts: tuple[str, ...] = ()
    damage_text: str = ""


def generate_bug_report(machine_file: str | None = None, program: Path | None = None) -> str:
    """Return the text of the bug report. Raises CommandError if a named file cannot be read.

    Without ``machine_file``, the report contains the machine file in use. Without ``program``, it contains
    the program that was started last.
    """
    stored = _stored()
    programs = {*stored.program_names, *_names_in(find_data_folder() / "programs")} | (
        {program.name} if program else set()
    )
    replacements = PrivateValueReplacer(
        people={*stored.user_names, *_users()},
        programs={*programs, *_names_of_runs()},
        computers={socket.gethostname(), platform.node()},
        public=_shipped_names(),
    )
    parts = [
        ReportPart("TurnDesk", f"turndesk {VERSION}\n{_system()}"),
        ReportPart("Store", stored.damage_text or "can be read"),
        *_machine_part(machine_file or stored.machine_file, replacements, named=machine_file is not None),
        *_program_part(program, stored.latest_program),
        *_log_parts(stored.event_texts),
    ]
    return "\n".join(f"== {part.title} ==\n{replacements(part.text).rstrip()}\n" for part in parts)


def _system() -> str:
    lines = [f"{platform.system()} {platform.release()} {platform.machine()}"]
    with suppress(OSError):
        lines.append(platform.freedesktop_os_release().get("PRETTY_NAME", ""))
    lines += [f"Python {platform.python_version()}, {os.cpu_count()} CPU cores"]
    for package in _PACKAGES:
        with suppress(PackageNotFoundError):
            lines.append(f"{package} {version(package)}")
    lines += [f"{name}={os.environ[name]}" for name in _DISPLAY if os.environ.get(name)]
    return "\n".join(lines)


def _users() -> Iterator[str]:
    """Yield the login name and the full name of the user who runs this process."""
    with suppress(OSError, KeyError, ImportError):
        yield getpass.getuser()
    with suppress(ImportError, KeyError):
        import pwd  # Linux and macOS only

        entry = pwd.getpwuid(os.getuid())
        full = entry.pw_gecos.partition(",")[0]
        yield from (entry.pw_name, full, *full.split())


def _stored() -> _StoredData:
    """Return the store's data for the report.

    If the store cannot be read, the result contains only the error code.
    """
    try:
        with Store.open(find_data_folder(), read_only=True) as store:
            with store.read() as connection:
                people, programs = _stored_names(connection)
            runs = sorted(
                (row for row in store.runs.read_run_records() if row.started),
                key=lambda row: row.started or "",
            )
            events = store.events.read_events(limit=MAX_LOG_LINES)
            machine = read_machine_file_in_use(store.settings)
            return _StoredData(
                frozenset(people),
                frozenset(programs),
                machine,
                _latest(store, runs[-1].program) if runs else None,
                tuple(
                    f"{row.at} {row.kind} line {row.line}: {format_message_without_names(row.text)}"
                    for row in events
                ),
            )
    except CodedError as error:
        return _StoredData(damage_text=f"cannot be read: {error.code}")


def _latest(store: Store, name: str) -> tuple[str, str] | None:
    with suppress(CodedError):
        return name, store.programs.load_version(name).decode("utf-8", "replace")
    return None


def _stored_names(connection: sqlite3.Connection) -> tuple[set[str], set[str]]:
    """Return the user names and the program names that occur in any table of the store."""
    people = _texts(connection, "people", "name")
    programs = _texts(connection, "programs", "name")
    for (table,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall():
        columns = {str(row[1]) for row in connection.execute(f'PRAGMA table_info("{table}")')}
        for column in columns.intersection(_WITH_NAMES):
            (programs if column == "program" else people).update(_texts(connection, table, column))
    return people - {"command line"}, programs


def _texts(connection: sqlite3.Connection, table: str, column: str) -> set[str]:
    rows = connection.execute(f'SELECT DISTINCT "{column}" FROM "{table}"')
    return {row[0] for row in rows if isinstance(row[0], str) and row[0].strip()}


def _names_in(folder: Path) -> Iterator[str]:
    with suppress(OSError):
        yield from sorted(path.name for path in folder.iterdir())


def _names_of_runs() -> Iterator[str]:
    """Yield the program names that appear in the file names of run logs.

    The file name ``20260102T030405000000-PIN``, for example, contains the program name PIN.
    """
    for path in (find_data_folder() / "logs").glob("*.jsonl"):
        yield path.stem.partition("-")[2]


@cache
def _shipped_names() -> frozenset[str]:
    folder = Path(resources.__file__).parent
    shipped = (path.name for each in ("machines", "programs") for path in (folder / each).iterdir())
    return frozenset(shipped)


@cache
def _shipped_strings() -> frozenset[str]:
    """Return all strings and names in the shipped machine files, which are public."""
    found: set[str] = set()

    def add_strings(value: object) -> None:
        if isinstance(value, str):
            found.add(value)
        elif isinstance(value, dict):
            for each in value.values():
                add_strings(each)
        elif isinstance(value, list):
            for each in value:
                add_strings(each)

    for path in sorted((Path(resources.__file__).parent / "machines").glob("*.toml")):
        add_strings(tomllib.loads(path.read_text(encoding="utf-8")))
    return frozenset(found)


def _machine_part(
    place: str | None, replacements: PrivateValueReplacer, *, named: bool
) -> Iterator[ReportPart]:
    """Yield the report part with the machine file.

    Raises CommandError if the user named a file that cannot be read.
    """
    if place is None:
        yield ReportPart("Machine file", "the shipped simulated lathe")
    elif not Path(place).exists() and place.removesuffix(".toml") in resources.list_machine_names():
        yield ReportPart("Machine file", f"shipped: {place}")
    else:
        text = _read(Path(place), must_exist=named)
        yield ReportPart("Machine file", mask_machine_file(text, _shipped_strings(), replacements))


def _program_part(path: Path | None, latest: tuple[str, str] | None) -> Iterator[ReportPart]:
    if path is not None:
        yield ReportPart(f"Program {path.suffix}", mask_program_texts(_read(path, must_exist=True)))
    elif latest is not None:
        yield ReportPart(
            f"Program that was started last {Path(latest[0]).suffix}", mask_program_texts(latest[1])
        )


def _log_parts(events: tuple[str, ...]) -> Iterator[ReportPart]:
    folder = find_data_folder() / "logs"
    if crash := _newest(folder, "crash-*.txt"):
        yield ReportPart("Newest crash file", _read(crash, must_exist=False))
    if (log := folder / "turndesk.log").is_file():
        yield ReportPart("Log of faults", _last_lines(log, str))
    if run := _newest(folder, "*.jsonl"):
        yield ReportPart("Newest run without a screen", _last_lines(run, remove_scope_record_name))
    if events:
        yield ReportPart("Newest events", "\n".join(events))


def _newest(folder: Path, pattern: str) -> Path | None:
    with suppress(OSError):
        return max(folder.glob(pattern), key=lambda path: path.stat().st_mtime, default=None)
    return None


def _last_lines(path: Path, change: Callable[[str], str]) -> str:
    return "\n".join(change(line) for line in _read(path, must_exist=False).splitlines()[-MAX_LOG_LINES:])


def _read(path: Path, *, must_exist: bool) -> str:
    """Return the end of a text file. Raises CommandError if a required file cannot be read."""
    try:
        with path.open("rb") as file:
            file.seek(max(0, path.stat().st_size - _MOST_BYTES))
            return file.read(_MOST_BYTES).decode("utf-8", "replace")
    except OSError as error:
        if must_exist:
            raise CommandError(
                Message("{file} cannot be read: {cause}", file=path, cause=error.strerror), "cannot-read"
            ) from error
        return "cannot be read"
