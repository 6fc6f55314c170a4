"""Extraction of a setup archive, with size limits and a check of every file.

Sizes that the archive declares are not trusted. Bytes are counted during extraction.
"""

from __future__ import annotations

import errno
import hashlib
import json
import struct
import zipfile
from pathlib import Path, PurePosixPath
from typing import BinaryIO
from xml.parsers import expat

from app.compose.machine.machine_setup import read_machine
from app.compose.optional_features import list_drawing_suffixes
from app.desk.command_errors import CommandError
from core.input_file import TooLargeError, convert_exceptions, open_input_file, read_input_bytes
from core.language.source import SourceError, decode_source
from core.message import CodedError, Message, get_error_code
from core.store import backup
from core.store.program_records import check_program_name
from core.store.store_errors import StoreError

_FORMAT_PREFIX = "turndesk setup "
ARCHIVE_FORMAT = f"{_FORMAT_PREFIX}1"
MANIFEST, STORE, PROGRAMS, MACHINE = "manifest.json", "store.db", "programs", "machine"
COMPANION_SUFFIXES = (".hal", ".xml")  # suffixes of files that belong to a machine file and have its name
MAX_MEMBER_COUNT = 10_000
MAX_DEPTH = 8  # parts of a name: nested folders and the file
_MIB = 1024 * 1024
MAX_BYTES_BY_KIND = {MANIFEST: 4 * _MIB, STORE: 512 * _MIB, PROGRAMS: 64 * _MIB, MACHINE: 16 * _MIB}
MAX_TOTAL_BYTES = 1024 * _MIB
_MAX_PACKED_BYTES = 1024 * _MIB
_MAX_DIRECTORY_BYTES = 4 * _MIB  # size of ZIP's central directory
_CHUNK = _MIB
_END, _END_64 = 22, 20  # bytes of ZIP's end record without a comment, and of the ZIP64 locator in front of it
DISK_FULL_ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def unpack_setup_archive(source: Path, folder: Path) -> list[str]:
    """Extract the checked members of the archive to ``folder`` and return their names.

    Raises CommandError if the archive is invalid, too large or unreadable, or if the disk is full.
    """
    with (
        convert_exceptions(lambda error: _not_unpacked(source, folder, error)),
        open_input_file(source, _MAX_PACKED_BYTES) as raw,
    ):
        _check_directory(source, raw)
        with zipfile.ZipFile(raw) as file:
            names = _Extraction(source, file, folder).extract_all_members()
    _check_store(source, folder / STORE)
    for name in names:
        if (why := find_member_error(name, folder / name)) is not None:
            raise CommandError(
                Message("{source} contains {name}: {error}", source=source, name=name, error=why),
                get_error_code(why),
            )
    return names


def _not_unpacked(source: Path, folder: Path, error: Exception) -> CommandError:
    if isinstance(error, TooLargeError):
        return CommandError(
            Message(
                "{source} is not a setup file: {cause}; check the name",
                source=source,
                cause=error.strerror,
            ),
            "too-large",
        )
    if isinstance(error, OSError) and error.errno in DISK_FULL_ERRORS:
        return CommandError(
            Message(
                "not enough disk space in {parent} to unpack {source}; free some space",
                parent=folder.parent,
                source=source,
            ),
            "disk-full",
        )
    if isinstance(error, OSError):
        return CommandError(
            Message("{path} cannot be read: {cause}", path=source, cause=error.strerror or error),
            "unreadable",
        )
    return CommandError(
        Message("{source} is not a readable setup file: {error}", source=source, error=error),
        "damaged-setup",
    )


def find_member_error(name: str, path: Path) -> CodedError | None:
    """Return the error if a file is not valid as the archive member ``name``, or None if it is valid.

    Raises OSError if the file cannot be read.
    """
    top = name.partition("/")[0]
    try:
        _check_path(name)
        if top == PROGRAMS:
            _check_program(path)
        elif top == MACHINE:
            _check_machine(path)
    except (CommandError, SourceError, StoreError) as error:
        return error
    except TooLargeError as error:
        return CommandError(str(error.strerror), "member-too-large")
    return None


def is_machine_file(path: Path) -> bool:
    """Return whether a file is a machine file and not one of the HAL or EtherCAT files in its folder."""
    return path.suffix not in COMPANION_SUFFIXES


class _Extraction:
    """Extraction of one setup archive, which counts the extracted bytes."""

    def __init__(self, source: Path, file: zipfile.ZipFile, folder: Path) -> None:
        self._source, self._file, self._folder = source, file, folder
        self._bytes = 0

    def extract_all_members(self) -> list[str]:
        """Extract every member that the manifest lists, and return the members' names."""
        self._extract(MANIFEST)
        hashes = _parse_hashes(self._source, json.loads((self._folder / MANIFEST).read_bytes()))
        self._check_names(list(hashes))
        for name, expected in hashes.items():
            if self._extract(name) != expected:
                raise CommandError(
                    Message(
                        "{source}: {name} differs from the file that was saved; copy the setup file again",
                        source=self._source,
                        name=name,
                    ),
                    "damaged-member",
                )
        return list(hashes)

    def _check_names(self, names: list[str]) -> None:
        strange = sorted({*self._file.namelist()} - {*names, MANIFEST})
        for name in (*strange, *names):
            try:
                if name in strange:
                    raise _no_place()
                _check_path(name)
            except CodedError as error:
                raise CommandError(
                    Message("{source} contains {name}: {error}", source=self._source, name=name, error=error),
                    get_error_code(error),
                ) from error
        machines = [Path(name) for name in names if name.startswith(f"{MACHINE}/")]
        if len({each.stem for each in machines}) > 1 or sum(map(is_machine_file, machines)) not in {0, 1}:
            raise CommandError(
                Message("{source} contains more than one machine", source=self._source), "foreign-member"
            )

    def _extract(self, name: str) -> str:
        """Extract one member and return the SHA-256 hash of its bytes."""
        info = self._file.getinfo(name)
        if info.compress_type not in {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}:
            raise NotImplementedError(Message("{name} is compressed with an unsupported method", name=name))
        target, digest, size = self._folder / name, hashlib.sha256(), 0
        target.parent.mkdir(parents=True, exist_ok=True)
        with self._file.open(info) as packed, target.open("wb") as plain:
            while data := packed.read(_CHUNK):
                size += len(data)
                self._bytes += len(data)
                if size > MAX_BYTES_BY_KIND[name.partition("/")[0]] or self._bytes > MAX_TOTAL_BYTES:
                    raise CommandError(
                        Message(
                            "{source} contains {name}, which is too large for a setup",
                            source=self._source,
                            name=name,
                        ),
                        "member-too-large",
                    )
                digest.update(data)
                plain.write(data)
        return digest.hexdigest()


def _check_directory(source: Path, raw: BinaryIO) -> None:
    """Check the size of the central directory before zipfile reads it.

    Raises CommandError if the directory is too large, lists too many files or has the ZIP64 format. Raises
    BadZipFile if the end record of the archive is missing.
    """
    size = raw.seek(0, 2)
    raw.seek(max(0, size - _END - _END_64))
    tail = raw.read()
    end, end_64 = tail[-_END:], tail[:-_END]
    if not end.startswith(b"PK\5\6"):
        raise zipfile.BadZipFile("the end of the file is missing")
    (members, directory) = struct.unpack("<10xHL6x", end)
    if members > MAX_MEMBER_COUNT or directory > _MAX_DIRECTORY_BYTES or end_64.startswith(b"PK\6\7"):
        raise CommandError(
            Message(
                "{source} contains more than {most_members} files",
                source=source,
                most_members=MAX_MEMBER_COUNT,
            ),
            "too-many-members",
        )


def _parse_hashes(source: Path, manifest: object) -> dict[str, str]:
    """Return the SHA-256 hash of every member from the manifest.

    Raises CommandError if the manifest is invalid or was written by a different version.
    """
    form = manifest.get("format") if isinstance(manifest, dict) else None
    if isinstance(form, str) and form.startswith(_FORMAT_PREFIX) and form != ARCHIVE_FORMAT:
        raise CommandError(
            Message(
                "{source} was saved by another version of TurnDesk (format {form}; this "
                "version uses {format}); use that version",
                source=source,
                form=form,
                format=ARCHIVE_FORMAT,
            ),
            "other-version",
        )
    hashes = manifest.get("sha256") if isinstance(manifest, dict) else None
    if form != ARCHIVE_FORMAT or not isinstance(hashes, dict) or STORE not in hashes:
        raise CommandError(
            Message(
                "{source} does not have the required setup format ({format}); save the setup again "
                "with 'setup save'",
                source=source,
                format=ARCHIVE_FORMAT,
            ),
            "not-a-setup",
        )
    return {str(name): str(value) for name, value in hashes.items()}


def _no_place() -> CommandError:
    return CommandError("this file does not belong in a setup", "foreign-member")


def _check_path(name: str) -> None:
    """Raise CommandError or StoreError if a setup file may not contain a member of this name."""
    parts = PurePosixPath(name).parts
    if name == STORE:
        return
    if "/".join(parts) != name or len(parts) < 2 or parts[0] not in {PROGRAMS, MACHINE} or ".." in parts:
        raise _no_place()
    if len(parts) > (MAX_DEPTH if parts[0] == PROGRAMS else 2):
        raise CommandError("the file is nested in too many folders", "too-deep")
    for part in parts[1:]:
        check_program_name(part)


def _check_store(source: Path, store: Path) -> None:
    try:
        found = backup.find_store_problems(store)
    except StoreError as error:
        raise CommandError(
            Message("{source}: {error}", source=source, error=error), get_error_code(error)
        ) from error
    if found:
        raise CommandError(
            Message(
                "{source}: {value}; save the setup again with 'turndesk setup save'",
                source=source,
                value=found[0],
            ),
            "damaged-store",
        )


def _check_program(path: Path) -> None:
    """Raise SourceError if a file is neither a program text nor a drawing. Empty files are accepted.

    Raises OSError if the file cannot be read, and TooLargeError if it is larger than the limit for
    programs.
    """
    data = read_input_bytes(path, MAX_BYTES_BY_KIND[PROGRAMS])
    drawing = path.name.lower().endswith(list_drawing_suffixes())
    if data and not (drawing and b"\0" not in data):
        decode_source(path.name, data)


def _check_machine(path: Path) -> None:
    """Raise CommandError if a machine file, HAL file or EtherCAT file is invalid.

    A machine file that cannot be read also causes CommandError. Raises OSError if another file cannot be
    read, and TooLargeError if it is larger than the limit for machine files.
    """
    if is_machine_file(path):
        read_machine(str(path))
        return
    data = read_input_bytes(path, MAX_BYTES_BY_KIND[MACHINE])
    try:
        if path.suffix == ".xml":
            expat.ParserCreate().Parse(data, True)
        whole = "\0" not in data.decode("utf-8")
    except (ValueError, expat.ExpatError):
        whole = False
    if not whole:
        raise CommandError(
            Message("this is not a valid {suffix} file", suffix=path.suffix[1:].upper()), "damaged-member"
        )
