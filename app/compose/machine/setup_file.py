"""A machine's setup in one file: store, settings, programs and machine file, for another desk; checked."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import tempfile
import zipfile
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import Self

from app.compose.machine.machine_setup import read_machine
from app.compose.machine.setup_archive import (
    BESIDE,
    FORMAT,
    MACHINE,
    MANIFEST,
    NO_ROOM,
    PROGRAMS,
    STORE,
    is_machine_file,
    problem,
    unpack,
)
from app.compose.runs.journal import UNDER_WAY
from app.desk.command_errors import CommandError, as_command_error, cannot_write
from app.desk.data_folder import data_folder
from core.file_placing import make_folder, put_in_place, restrict, write_in_place
from core.message import Message, error_code
from core.store import backup
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_file import FILE_NAME


@dataclass(frozen=True, slots=True)
class SetupTold:
    """Contents of a setup file; ``placed`` is where its machine file was put.

    ``left_out`` are files of the program folder that are neither programs nor drawings.
    """

    programs: int
    machine: str
    placed: Path | None = None
    left_out: tuple[str, ...] = ()


def save_setup(target: Path, machine_file: str | None) -> SetupTold:
    """Write the setup of this desk. Raises CommandError; then nothing is left under the name."""
    folder, machine = data_folder(), _machine_members(machine_file)
    if target.is_file() and not zipfile.is_zipfile(target):
        raise CommandError(
            Message("{target} already exists and is not a setup file; use a different name", target=target),
            "not-replaced",
        )
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
        made, part = Path(name) / "setup", target.with_name(target.name + ".part")
        members = {STORE: _copy_of_store(folder, Path(name))}
        members |= {f"{PROGRAMS}/{path}": folder / PROGRAMS / path for path in _programs(folder)}
        members |= machine
        left_out = _write(made, members)
        _check_loadable(made, target)
        try:
            shutil.copyfile(made, part)
            restrict(part)
            put_in_place(part, target)
        except OSError as error:
            with suppress(OSError):
                part.unlink(missing_ok=True)
            raise cannot_write(target, error) from error
    return replace(_told([each for each in members if each not in left_out]), left_out=left_out)


def _copy_of_store(folder: Path, beside: Path) -> Path:
    """Whole, and without the interrupted job and the people: those are a matter of one machine."""
    home = beside / "home"
    home.mkdir()
    with as_command_error(StoreError):
        backup.backup(folder, home / FILE_NAME)
        with Store.open(home) as store:
            store.settings.save_setting(UNDER_WAY, None).result()
            store.people.remove_all_people().result()
        backup.backup(home, beside / STORE)
    return beside / STORE


def _programs(folder: Path) -> list[str]:
    own = folder / PROGRAMS
    found = (path for path in own.rglob("*") if path.is_file() and not path.name.startswith("."))
    return sorted(path.relative_to(own).as_posix() for path in found)


def _machine_members(named: str | None) -> dict[str, Path]:
    """The machine file, which has to be good, and what lies beside it under its name."""
    if named is None:
        return {}
    path = Path(named)
    read_machine(str(path))
    if not path.is_file():
        raise CommandError(
            Message("{named} is included with TurnDesk; omit --machine, or specify a file", named=named),
            "shipped-machine",
        )
    beside = [path.with_suffix(ending) for ending in BESIDE]
    return {f"{MACHINE}/{each.name}": each for each in (path, *beside) if each.is_file()}


def _write(made: Path, members: dict[str, Path]) -> tuple[str, ...]:
    """Write the archive; return the programs left out. Raises CommandError if a file cannot be read."""
    try:
        left_out = [
            each for each in members if each.startswith(f"{PROGRAMS}/") and problem(each, members[each])
        ]
        members = {name: path for name, path in members.items() if name not in left_out}
        hashes = {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in members.items()}
        told = {"format": FORMAT, "made": datetime.now(UTC).isoformat(timespec="seconds"), "sha256": hashes}
        # A computer without a clock of its own dates its files before 1980, which ZIP cannot say.
        with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED, strict_timestamps=False) as file:
            file.writestr(MANIFEST, json.dumps(told, indent=1))
            for name, path in members.items():
                file.write(path, name)
    except OSError as error:
        if error.errno in NO_ROOM:
            raise CommandError(
                Message(
                    "not enough disk space in {parent} for a setup; free some space",
                    parent=made.parent.parent,
                ),
                "disk-full",
            ) from error
        raise CommandError(
            Message("{path} cannot be read: {cause}", path=error.filename, cause=error.strerror),
            "unreadable",
        ) from error
    return tuple(left_out)


def _check_loadable(made: Path, target: Path) -> None:
    """Raise CommandError if the archive is beyond what ``load_setup`` accepts."""
    try:
        with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
            unpack(made, Path(name))
    except CommandError as error:
        raise CommandError(str(error).replace(str(made), str(target)), error_code(error)) from error


def _told(names: list[str], placed: Path | None = None) -> SetupTold:
    machines = [PurePosixPath(name).name for name in names if name.startswith(f"{MACHINE}/")]
    machine = Message("machine file {path}", path=machines[0]) if machines else "no machine file"
    return SetupTold(sum(name.startswith(f"{PROGRAMS}/") for name in names), machine, placed)


# --- taken by another desk ----------------------------------------------------------------------------


def check_setup(source: Path) -> SetupTold:
    """Look through a setup file; changes nothing. Raises CommandError naming what is wrong with it."""
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
        return _told(unpack(source, Path(name)))


def load_setup(source: Path) -> tuple[SetupTold, Path | None]:
    """Take it, whole or not at all; and where the store is kept that was here, None: there was none.

    All files lie beside their places before the store is touched: what cannot be written changes nothing.
    Raises CommandError for a file that is not whole, and while a desk runs here.
    """
    folder, stamp = data_folder(), datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name, _Beside(stamp) as beside:
        names = unpack(source, Path(name))
        try:
            for each in names:
                if each != STORE:
                    beside.put(Path(name) / each, folder / each.replace(f"{MACHINE}/", "machines/", 1))
            kept = backup.restore(folder, Path(name) / STORE)
            beside.take_places()
        except StoreError as error:
            raise CommandError(str(error), error_code(error)) from error
        except OSError as error:
            where = error.filename or folder  # a full disk does not say which file it was
            raise cannot_write(where, error) from error
    return _told(names, beside.machine), kept


class _Beside:
    """Files that lie beside their places until all of them do; what has not taken its place then is gone."""

    def __init__(self, stamp: str) -> None:
        self._stamp = stamp
        self._places: dict[Path, Path] = {}
        self._kept: list[Path] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        for path in (*self._places, *(self._kept if kind else ())):
            with suppress(OSError):
                path.unlink(missing_ok=True)

    @property
    def machine(self) -> Path | None:
        """Where the machine file is put."""
        return next(
            (at for at in self._places.values() if at.parent.name == "machines" and is_machine_file(at)), None
        )

    def put(self, source: Path, target: Path) -> None:
        """Beside its place; another text that stands there is kept under a name of its own."""
        data = source.read_bytes()
        make_folder(target.parent)
        if target.exists() and (old := target.read_bytes()) != data:
            self._kept.append(target.with_name(f"{target.name}.replaced-{self._stamp}"))
            write_in_place(self._kept[-1], old)
        draft = target.with_name(f".{target.name}.{self._stamp}")
        self._places[draft] = target
        with draft.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())

    def take_places(self) -> None:
        """All of them, one after the other."""
        for draft, target in self._places.items():
            put_in_place(draft, target)
