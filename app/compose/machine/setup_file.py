"""Setup file, which contains a machine's complete setup for loading on another control.

The file contains the store with its settings, the programs and the machine file.
"""

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
    ARCHIVE_FORMAT,
    COMPANION_SUFFIXES,
    DISK_FULL_ERRORS,
    MACHINE,
    MANIFEST,
    PROGRAMS,
    STORE,
    find_member_error,
    is_machine_file,
    unpack_setup_archive,
)
from app.compose.runs.journal import INTERRUPTED_JOB_KEY
from app.desk.command_errors import CommandError, convert_to_command_error, make_write_error
from app.desk.data_folder import find_data_folder
from core.file_replacement import create_synced_folder, replace_atomically, restrict_access, write_atomically
from core.message import Message, get_error_code
from core.store import backup
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_file import STORE_FILE_NAME


@dataclass(frozen=True, slots=True)
class SetupContents:
    """Contents of a setup file. ``machine_path`` is the path at which its machine file was saved.

    ``omitted_files`` are files of the program folder that are neither programs nor drawings.
    """

    program_count: int
    machine_name: str
    machine_path: Path | None = None
    omitted_files: tuple[str, ...] = ()


def save_setup(target: Path, machine_file: str | None) -> SetupContents:
    """Write the setup of this control to a file and return its contents.

    Raises CommandError if the setup cannot be saved. No file remains after an error.
    """
    folder, machine = find_data_folder(), _list_machine_members(machine_file)
    if target.is_file() and not zipfile.is_zipfile(target):
        raise CommandError(
            Message("{target} already exists and is not a setup file; use a different name", target=target),
            "not-replaced",
        )
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
        made, part = Path(name) / "setup", target.with_name(target.name + ".part")
        members = {STORE: _copy_store(folder, Path(name))}
        members |= {f"{PROGRAMS}/{path}": folder / PROGRAMS / path for path in _programs(folder)}
        members |= machine
        left_out = _write_archive(made, members)
        _check_loadable(made, target)
        try:
            shutil.copyfile(made, part)
            restrict_access(part)
            replace_atomically(part, target)
        except OSError as error:
            with suppress(OSError):
                part.unlink(missing_ok=True)
            raise make_write_error(target, error) from error
    return replace(_told([each for each in members if each not in left_out]), omitted_files=left_out)


def _copy_store(folder: Path, staging: Path) -> Path:
    """Copy the store without the interrupted job and the users, because these belong to one machine."""
    home = staging / "home"
    home.mkdir()
    with convert_to_command_error(StoreError):
        backup.back_up_store(folder, home / STORE_FILE_NAME)
        with Store.open(home) as store:
            store.settings.save_setting(INTERRUPTED_JOB_KEY, None).result()
            store.people.remove_all_users().result()
        backup.back_up_store(home, staging / STORE)
    return staging / STORE


def _programs(folder: Path) -> list[str]:
    own = folder / PROGRAMS
    found = (path for path in own.rglob("*") if path.is_file() and not path.name.startswith("."))
    return sorted(path.relative_to(own).as_posix() for path in found)


def _list_machine_members(named: str | None) -> dict[str, Path]:
    """Return the machine file and those files in its folder that have the same stem, by member name.

    Raises CommandError if the machine file is invalid, or if ``named`` is the name of a shipped machine.
    """
    if named is None:
        return {}
    path = Path(named)
    read_machine(str(path))
    if not path.is_file():
        raise CommandError(
            Message("{named} is included with TurnDesk; omit --machine, or specify a file", named=named),
            "shipped-machine",
        )
    companion_paths = [path.with_suffix(ending) for ending in COMPANION_SUFFIXES]
    return {f"{MACHINE}/{each.name}": each for each in (path, *companion_paths) if each.is_file()}


def _write_archive(archive_path: Path, members: dict[str, Path]) -> tuple[str, ...]:
    """Write the setup archive, and return the member names of the programs that it omits.

    Raises CommandError if a file cannot be read, or if the disk is full.
    """
    try:
        left_out = [
            each
            for each in members
            if each.startswith(f"{PROGRAMS}/") and find_member_error(each, members[each])
        ]
        members = {name: path for name, path in members.items() if name not in left_out}
        hashes = {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in members.items()}
        manifest = {
            "format": ARCHIVE_FORMAT,
            "made": datetime.now(UTC).isoformat(timespec="seconds"),
            "sha256": hashes,
        }
        # A computer without a battery-backed clock may date files before 1980, which ZIP does not support.
        with zipfile.ZipFile(archive_path, "w", zipfile.ZIP_DEFLATED, strict_timestamps=False) as file:
            file.writestr(MANIFEST, json.dumps(manifest, indent=1))
            for name, path in members.items():
                file.write(path, name)
    except OSError as error:
        if error.errno in DISK_FULL_ERRORS:
            raise CommandError(
                Message(
                    "not enough disk space in {parent} for a setup; free some space",
                    parent=archive_path.parent.parent,
                ),
                "disk-full",
            ) from error
        raise CommandError(
            Message("{path} cannot be read: {cause}", path=error.filename, cause=error.strerror),
            "unreadable",
        ) from error
    return tuple(left_out)


def _check_loadable(path: Path, target: Path) -> None:
    """Raise CommandError if ``load_setup`` would reject the archive, for example because it is too large."""
    try:
        with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
            unpack_setup_archive(path, Path(name))
    except CommandError as error:
        raise CommandError(str(error).replace(str(path), str(target)), get_error_code(error)) from error


def _told(names: list[str], placed: Path | None = None) -> SetupContents:
    machines = [PurePosixPath(name).name for name in names if name.startswith(f"{MACHINE}/")]
    machine = Message("machine file {path}", path=machines[0]) if machines else "no machine file"
    return SetupContents(sum(name.startswith(f"{PROGRAMS}/") for name in names), machine, placed)


# --- Loading on another control -----------------------------------------------------------------------


def check_setup(source: Path) -> SetupContents:
    """Check a setup file without changing data. Raises CommandError for the first error."""
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
        return _told(unpack_setup_archive(source, Path(name)))


def load_setup(source: Path) -> tuple[SetupContents, Path | None]:
    """Load a complete setup, and return its contents and the path of the saved old store, or None.

    The path is None if there was no old store. All files are written to temporary paths before the store is
    changed. An error during writing therefore changes nothing. Raises CommandError if the file is damaged,
    if a file cannot be written, or while TurnDesk is running on this computer.
    """
    folder, stamp = find_data_folder(), datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name, _StagedFiles(stamp) as staged:
        names = unpack_setup_archive(source, Path(name))
        try:
            for each in names:
                if each != STORE:
                    staged.stage_file(Path(name) / each, folder / each.replace(f"{MACHINE}/", "machines/", 1))
            kept = backup.restore_store(folder, Path(name) / STORE)
            staged.move_to_targets()
        except StoreError as error:
            raise CommandError(str(error), get_error_code(error)) from error
        except OSError as error:
            where = error.filename or folder  # the error of a full disk does not name the file
            raise make_write_error(where, error) from error
    return _told(names, staged.machine_path), kept


class _StagedFiles:
    """Files that have temporary names in their target folders until all of them are complete.

    Incomplete files are deleted.
    """

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
    def machine_path(self) -> Path | None:
        """Return the final path of the machine file, or None if the setup has no machine file."""
        return next(
            (at for at in self._places.values() if at.parent.name == "machines" and is_machine_file(at)), None
        )

    def stage_file(self, source: Path, target: Path) -> None:
        """Write a file under a temporary name in its final folder.

        A different existing file is saved under a new name.
        """
        data = source.read_bytes()
        create_synced_folder(target.parent)
        if target.exists() and (old := target.read_bytes()) != data:
            self._kept.append(target.with_name(f"{target.name}.replaced-{self._stamp}"))
            write_atomically(self._kept[-1], old)
        draft = target.with_name(f".{target.name}.{self._stamp}")
        self._places[draft] = target
        with draft.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())

    def move_to_targets(self) -> None:
        """Move all files to their final paths."""
        for draft, target in self._places.items():
            replace_atomically(draft, target)
