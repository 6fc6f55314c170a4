"""Unpack a setup archive within limits, and check every file in it by its kind.

Nothing that the archive says about itself is trusted: bytes are counted while they are unpacked.
"""

from __future__ import annotations

import errno
import hashlib
import json
import struct
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import BinaryIO
from xml.parsers import expat

from app.compose.machine_setup import read_machine
from app.desk.command_errors import CommandError
from core.coded_error import CodedError, error_code
from core.drawings.drawing_file import is_drawing
from core.language.source import SourceError, source_of
from core.store import backup
from core.store.program_records import check_name
from core.store.store_errors import StoreError

_KIND = "turndesk setup "
FORMAT = f"{_KIND}1"
MANIFEST, STORE, PROGRAMS, MACHINE = "manifest.json", "store.db", "programs", "machine"
BESIDE = (".hal", ".xml")  # files that belong to a machine file and have its name
MOST_MEMBERS = 10_000
MOST_DEPTH = 8  # parts of a name: folders in each other, and the file
_MIB = 1024 * 1024
MOST_BYTES = {MANIFEST: 4 * _MIB, STORE: 512 * _MIB, PROGRAMS: 64 * _MIB, MACHINE: 16 * _MIB}
MOST_BYTES_OF_ALL = 1024 * _MIB
_MOST_BYTES_OF_DIRECTORY = 4 * _MIB  # of ZIP's own list of members
_CHUNK = _MIB
_END, _END_64 = 22, 20  # bytes: ZIP's last record without a comment, and the one of ZIP64 in front of it
NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
# Errors that Python raises for a damaged ZIP file: its structure, its compression, its manifest.
_DAMAGE = (
    zipfile.BadZipFile,
    zlib.error,
    struct.error,
    EOFError,
    KeyError,
    NotImplementedError,
    RuntimeError,
    ValueError,
)


def unpack(source: Path, folder: Path) -> list[str]:
    """Write the checked members of the archive below ``folder``; return their names. Raises CommandError."""
    try:
        with source.open("rb") as raw:
            _check_directory(source, raw)
            with zipfile.ZipFile(raw) as file:
                names = _Unpacking(source, file, folder).all()
    except OSError as error:
        if error.errno in NO_ROOM:
            raise CommandError(
                f"{folder.parent} has no room to unpack {source}; make room there", "disk-full"
            ) from error
        raise CommandError(f"{source} cannot be read: {error.strerror or error}", "unreadable") from error
    except _DAMAGE as error:
        raise CommandError(f"{source} is no setup file that can be read: {error}", "damaged-setup") from error
    _check_store(source, folder / STORE)
    for name in names:
        if (why := problem(name, folder / name)) is not None:
            raise CommandError(f"{source} holds {name}: {why}", error_code(why))
    return names


def problem(name: str, path: Path) -> CodedError | None:
    """Return why the file cannot be a member called ``name``, or None where it can. Raises OSError."""
    top = name.partition("/")[0]
    try:
        _check_place(name)
        if top == PROGRAMS:
            _check_program(path)
        elif top == MACHINE:
            _check_machine(path)
    except (CommandError, SourceError, StoreError) as error:
        return error
    return None


def is_machine_file(path: Path) -> bool:
    """Return whether a file of a machine's folder is the machine file itself."""
    return path.suffix not in BESIDE


class _Unpacking:
    """One archive on its way below ``folder``, with the bytes that were unpacked so far."""

    def __init__(self, source: Path, file: zipfile.ZipFile, folder: Path) -> None:
        self._source, self._file, self._folder = source, file, folder
        self._bytes = 0

    def all(self) -> list[str]:
        """Every member that the manifest lists, and no other."""
        self._take(MANIFEST)
        hashes = _hashes(self._source, json.loads((self._folder / MANIFEST).read_bytes()))
        self._check_names(list(hashes))
        for name, expected in hashes.items():
            if self._take(name) != expected:
                raise CommandError(
                    f"{self._source}: {name} is not what was saved; copy the file again", "damaged-member"
                )
        return list(hashes)

    def _check_names(self, names: list[str]) -> None:
        strange = sorted({*self._file.namelist()} - {*names, MANIFEST})
        for name in (*strange, *names):
            try:
                if name in strange:
                    raise _no_place()
                _check_place(name)
            except CodedError as error:
                raise CommandError(f"{self._source} holds {name}: {error}", error_code(error)) from error
        machines = [Path(name) for name in names if name.startswith(f"{MACHINE}/")]
        if len({each.stem for each in machines}) > 1 or sum(map(is_machine_file, machines)) not in {0, 1}:
            raise CommandError(f"{self._source} holds more than one machine", "foreign-member")

    def _take(self, name: str) -> str:
        """Unpack one member; return the SHA-256 of its bytes."""
        info = self._file.getinfo(name)
        if info.compress_type not in {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}:
            raise NotImplementedError(f"{name} is packed by another method")
        target, digest, size = self._folder / name, hashlib.sha256(), 0
        target.parent.mkdir(parents=True, exist_ok=True)
        with self._file.open(info) as packed, target.open("wb") as plain:
            while data := packed.read(_CHUNK):
                size += len(data)
                self._bytes += len(data)
                if size > MOST_BYTES[name.partition("/")[0]] or self._bytes > MOST_BYTES_OF_ALL:
                    raise CommandError(
                        f"{self._source} holds {name}, which is larger than a setup can be",
                        "member-too-large",
                    )
                digest.update(data)
                plain.write(data)
        return digest.hexdigest()


def _check_directory(source: Path, raw: BinaryIO) -> None:
    """Refuse a list of members that is too long before zipfile reads it as a whole."""
    size = raw.seek(0, 2)
    raw.seek(max(0, size - _END - _END_64))
    tail = raw.read()
    end, end_64 = tail[-_END:], tail[:-_END]
    if not end.startswith(b"PK\5\6"):
        raise zipfile.BadZipFile("its end is missing")
    (members, directory) = struct.unpack("<10xHL6x", end)
    if members > MOST_MEMBERS or directory > _MOST_BYTES_OF_DIRECTORY or end_64.startswith(b"PK\6\7"):
        raise CommandError(f"{source} holds more than {MOST_MEMBERS} files", "too-many-members")


def _hashes(source: Path, told: object) -> dict[str, str]:
    """The SHA-256 of every member as the manifest states it. Raises CommandError for another manifest."""
    form = told.get("format") if isinstance(told, dict) else None
    if isinstance(form, str) and form.startswith(_KIND) and form != FORMAT:
        raise CommandError(
            f"{source} was saved by another TurnDesk ({form}, here {FORMAT}); use that one", "other-version"
        )
    hashes = told.get("sha256") if isinstance(told, dict) else None
    if form != FORMAT or not isinstance(hashes, dict) or STORE not in hashes:
        raise CommandError(
            f"{source} is no setup of this kind ({FORMAT}); make it anew with 'setup save'", "not-a-setup"
        )
    return {str(name): str(value) for name, value in hashes.items()}


def _no_place() -> CommandError:
    return CommandError("it has no place in a setup", "foreign-member")


def _check_place(name: str) -> None:
    """Raise CommandError or StoreError for a name that no file of a setup has."""
    parts = PurePosixPath(name).parts
    if name == STORE:
        return
    if "/".join(parts) != name or len(parts) < 2 or parts[0] not in {PROGRAMS, MACHINE} or ".." in parts:
        raise _no_place()
    if len(parts) > (MOST_DEPTH if parts[0] == PROGRAMS else 2):
        raise CommandError("it is in too many folders", "too-deep")
    for part in parts[1:]:
        check_name(part)


def _check_store(source: Path, store: Path) -> None:
    try:
        found = backup.problems(store)
    except StoreError as error:
        raise CommandError(f"{source}: {error}", error_code(error)) from error
    if found:
        raise CommandError(f"{source}: {found[0]}; make it anew with 'turndesk setup save'", "damaged-store")


def _check_program(path: Path) -> None:
    """Raise SourceError for a file that is neither program text nor a drawing; an empty one is harmless."""
    data = path.read_bytes()
    if data and not (is_drawing(path.name) and b"\0" not in data):
        source_of(path.name, data)


def _check_machine(path: Path) -> None:
    """Raise CommandError for a machine file, a HAL file or an EtherCAT file that cannot be one."""
    if is_machine_file(path):
        read_machine(str(path))
        return
    data = path.read_bytes()
    try:
        if path.suffix == ".xml":
            expat.ParserCreate().Parse(data, True)
        whole = "\0" not in data.decode("utf-8")
    except (ValueError, expat.ExpatError):
        whole = False
    if not whole:
        raise CommandError(f"it is no {path.suffix[1:].upper()} file", "damaged-member")
