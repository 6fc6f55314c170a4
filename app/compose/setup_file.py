"""A machine's setup in one file: store, settings, programs and machine file, for another desk; checked."""

from __future__ import annotations

import hashlib
import json
import shutil
import tempfile
import zipfile
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath

from app.compose.journal import UNDER_WAY
from app.compose.machine_setup import read_machine
from app.desk.command_errors import CommandError
from app.desk.data_folder import data_folder
from core.file_placing import put_in_place, write_in_place
from core.store import backup
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_file import FILE_NAME

FORMAT = "turndesk setup 1"
MANIFEST, STORE, PROGRAMS, MACHINE = "manifest.json", "store.db", "programs", "machine"
MOST = 512 * 1024 * 1024  # bytes of one member: more is no setup of ours
_BESIDE = (".hal", ".xml")  # what lies beside a machine file under its name, and belongs to it


@dataclass(frozen=True, slots=True)
class SetupTold:
    """What a setup file holds; ``placed`` is where its machine file was put."""

    programs: int
    machine: str
    placed: Path | None = None


def save_setup(target: Path, machine_file: str | None) -> SetupTold:
    """Write the setup of this desk. Raises CommandError; then nothing is left under the name."""
    folder, machine = data_folder(), _machine_members(machine_file)
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
        made, part = Path(name) / "setup", target.with_name(target.name + ".part")
        members = {STORE: _copy_of_store(folder, Path(name))}
        members |= {f"{PROGRAMS}/{path}": folder / PROGRAMS / path for path in _programs(folder)}
        members |= machine
        try:
            _write(made, members)
            shutil.copyfile(made, part)
            put_in_place(part, target)
        except OSError as error:
            with suppress(OSError):
                part.unlink(missing_ok=True)
            raise CommandError(f"{target} cannot be written: {error.strerror}") from error
    return _told(list(members))


def _copy_of_store(folder: Path, beside: Path) -> Path:
    """Whole, and without the interrupted job: that is a matter of one machine."""
    home = beside / "home"
    home.mkdir()
    try:
        backup.backup(folder, home / FILE_NAME)
        with Store.open(home) as store:
            store.set_setting(UNDER_WAY, None).result()
        backup.backup(home, beside / STORE)
    except StoreError as error:
        raise CommandError(str(error)) from error
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
    beside = [path.with_suffix(ending) for ending in _BESIDE]
    return {f"{MACHINE}/{each.name}": each for each in (path, *beside) if each.is_file()}


def _write(part: Path, members: dict[str, Path]) -> None:
    hashes = {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in members.items()}
    told = {"format": FORMAT, "made": datetime.now(UTC).isoformat(timespec="seconds"), "sha256": hashes}
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(MANIFEST, json.dumps(told, indent=1))
        for name, path in members.items():
            file.write(path, name)


def _told(names: list[str], placed: Path | None = None) -> SetupTold:
    machines = [PurePosixPath(name).name for name in names if name.startswith(f"{MACHINE}/")]
    machine = f"machine file {machines[0]}" if machines else "no machine file"
    return SetupTold(sum(name.startswith(f"{PROGRAMS}/") for name in names), machine, placed)


# --- taken by another desk ----------------------------------------------------------------------------


def check_setup(source: Path) -> SetupTold:
    """Look through a setup file; changes nothing. Raises CommandError naming what is wrong with it."""
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
        return _told(_unpacked(source, Path(name)))


def load_setup(source: Path) -> tuple[SetupTold, Path | None]:
    """Take it, whole or not at all; and where the store is kept that was here, None: there was none.

    Raises CommandError for a file that is not whole, and while a desk runs here.
    """
    folder, stamp = data_folder(), datetime.now(UTC).strftime("%Y%m%dT%H%M%SZ")
    with tempfile.TemporaryDirectory(prefix="turndesk-") as name:
        names = _unpacked(source, Path(name))
        try:
            kept = backup.restore(folder, Path(name) / STORE)
        except StoreError as error:
            raise CommandError(str(error)) from error
        placed = None
        try:
            for each in names:
                if each != STORE:
                    at = _put(Path(name) / each, folder / each.replace(f"{MACHINE}/", "machines/", 1), stamp)
                    placed = at if each.startswith(f"{MACHINE}/") and each.endswith(".toml") else placed
        except OSError as error:
            raise CommandError(f"{error.filename} cannot be written: {error.strerror}") from error
    return _told(names, placed), kept


def _unpacked(source: Path, folder: Path) -> list[str]:
    """Every member checked and written below ``folder``; their names."""
    try:
        with zipfile.ZipFile(source) as file:
            names = _checked(source, file, folder)
    except OSError as error:
        raise CommandError(f"{source} cannot be read: {error.strerror or error}") from error
    except (zipfile.BadZipFile, KeyError, ValueError) as error:
        raise CommandError(f"{source} is no setup file that can be read: {error}") from error
    try:
        found = backup.problems(folder / STORE)
    except StoreError as error:
        raise CommandError(f"{source}: {error}") from error
    if found:
        raise CommandError(f"{source}: {found[0]}; make it anew with 'turndesk setup save'")
    for name in names:
        if name.startswith(f"{MACHINE}/") and name.endswith(".toml"):
            read_machine(str(folder / name))
    return names


def _checked(source: Path, file: zipfile.ZipFile, folder: Path) -> list[str]:
    told = json.loads(file.read(MANIFEST))
    if not isinstance(told, dict) or told.get("format") != FORMAT or STORE not in told.get("sha256", {}):
        raise CommandError(f"{source} is no setup of this kind ({FORMAT}); make it anew with 'setup save'")
    hashes: dict[str, str] = told["sha256"]
    for name, expected in hashes.items():
        at = PurePosixPath(name)
        top = at.parts[0] if len(at.parts) > 1 else ""
        if name != STORE and (top not in {PROGRAMS, MACHINE} or ".." in at.parts or "\\" in name):
            raise CommandError(f"{source} holds {name}, which has no place in a setup")
        if file.getinfo(name).file_size > MOST:
            raise CommandError(f"{source} holds {name}, which is larger than a setup can be")
        data = file.read(name)
        if hashlib.sha256(data).hexdigest() != expected:
            raise CommandError(f"{source}: {name} is not what was saved; copy the file again")
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    return list(hashes)


def _put(source: Path, target: Path, stamp: str) -> Path:
    """In its place; another text that stands there is kept beside it."""
    data = source.read_bytes()
    if target.exists() and (old := target.read_bytes()) != data:
        write_in_place(target.with_name(f"{target.name}.replaced-{stamp}"), old)
    write_in_place(target, data)
    return target
