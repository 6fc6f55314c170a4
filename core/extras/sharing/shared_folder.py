"""Sharing of programs in a folder, with one file for each version and one file for each machine.

A file is added completely or not at all. Files on a network drive are not locked. Each machine writes only
version files and its own state file. The contents of a version file do not depend on the machine that
writes it.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from core.extras.sharing.shared_location import (
    Found,
    PublishedVersion,
    SharingErrorCause,
    make_folder_label,
    make_sharing_error,
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
    is_version_id,
    verify_text,
)
from core.input_file import NotAFileError, TooLargeError, read_input_bytes
from core.message import Message

MARKER_FILE_NAME = (
    "turndesk-share.json"  # identifies a shared folder; an empty mount point does not have this file
)
VERSIONS, DESKS = "versions", "desks"
MAX_VERSION_FILE_BYTES = MAX_RECORD_BYTES + 1 + MAX_PROGRAM_BYTES  # bytes, largest file of a version
_ENDING, _STATE, _WRITING = ".version", ".json", ".writing-"


class SharedFolder:
    """A folder in which machines share programs.

    A version file contains the record, a line end and the text.
    """

    def __init__(self, folder: Path) -> None:
        self.name = make_folder_label(folder)
        self._folder = folder
        self._sizes: dict[str, int] = {}  # file sizes by id of the version

    @property
    def marker_path(self) -> Path:
        """Return the path of the marker file, which identifies a folder for shared programs."""
        return self._folder / MARKER_FILE_NAME

    def set_up(self) -> None:
        """Set up an existing folder for shared programs.

        A missing folder is not created, because its network drive may only be unmounted.
        """
        with self._system():
            if not self.marker_path.exists():
                os.stat(self._folder)
                for each in (VERSIONS, DESKS):
                    (self._folder / each).mkdir(exist_ok=True)
                self._write(self.marker_path, json.dumps({"format": FORMAT_VERSION}).encode())
            self._demand()

    def read_contents(self, known_versions: Mapping[str, SharedVersion]) -> Found:
        """Return the versions in the folder. Files of versions known to the caller are not opened."""
        with self._system():
            self._demand()
            there, fresh, strays = set[str](), list[SharedVersion](), list[str]()
            for path in _files(self._folder / VERSIONS):
                name = path.name.removesuffix(_ENDING)
                if not path.name.endswith(_ENDING) or not is_version_id(name):
                    strays.append(path.name)
                    continue
                version = _read_version_file(path) if name not in known_versions else None
                if version is not None:
                    fresh.append(version)
                if version is not None or (
                    name in known_versions and self._has_expected_size(path, known_versions[name])
                ):
                    there.add(name)
                else:
                    strays.append(path.name)
            desks, bad = self._desks()
            return Found(frozenset(there), tuple(fresh), desks, (*strays, *bad))

    def publish_versions(self, versions: Sequence[PublishedVersion], state: PublishedMachineState) -> None:
        """Add version files and the state of this machine.

        Each file is synced before it gets its final name.
        """
        with self._system():
            self._demand()
            self._clear(state.machine_id)
            for version, text in versions:
                self._add(version, text, state.machine_id)
            _to_disk(self._folder / VERSIONS)
            self._write(
                self._folder / DESKS / f"{state.machine_id}{_STATE}", state.encode_state(), state.machine_id
            )
            _to_disk(self._folder / DESKS)

    def read_text(self, version: SharedVersion) -> bytes:
        """Return the text of a version from its file, after checking it against its checksum."""
        path = self._folder / VERSIONS / f"{version.id}{_ENDING}"
        with self._system():
            self._demand()
            _, _, text = read_input_bytes(path, MAX_VERSION_FILE_BYTES).partition(b"\n")
            try:
                return verify_text(version, text)
            except RecordError as error:
                raise SharingErrorCause.DAMAGED.make_error(self.name, error) from error

    def _has_expected_size(self, path: Path, version: SharedVersion) -> bool:
        """Return whether a version file has the expected size.

        A truncated file is published again by a machine that has the text.
        """
        size = self._sizes.setdefault(version.id, len(encode_version(version)) + 1 + version.size)
        return path.stat().st_size == size

    def _add(self, version: SharedVersion, text: bytes, home: str) -> None:
        path = self._folder / VERSIONS / f"{version.id}{_ENDING}"
        whole = encode_version(version) + b"\n" + text
        if path.exists():
            with suppress(OSError):
                if read_input_bytes(path, len(whole)) == whole:
                    return
            path.replace(path.with_name(f"{path.name}.damaged"))  # saved for analysis
        self._write(path, whole, home)

    def _write(self, path: Path, data: bytes, home: str = "") -> None:
        draft = path.with_name(f"{_WRITING}{home}-{path.name}")
        with draft.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(path)

    def _clear(self, machine_id: str) -> None:
        """Remove this machine's temporary files that remained after a power failure."""
        for folder in (VERSIONS, DESKS):
            for path in (self._folder / folder).glob(f"{_WRITING}{machine_id}-*"):
                path.unlink(missing_ok=True)

    def _desks(self) -> tuple[tuple[PublishedMachineState, ...], list[str]]:
        found, strays = [], list[str]()
        for path in _files(self._folder / DESKS):
            home = path.name.removesuffix(_STATE)
            try:
                found.append(decode_machine_state(home, read_input_bytes(path, MAX_STATE_BYTES)))
            except (RecordError, OSError):
                strays.append(path.name)
        return tuple(found), strays

    def _demand(self) -> None:
        """Raise an error unless the folder is set up for shared programs in this format.

        Raises SharingError if the marker file is missing or damaged, or if its format differs from
        ``FORMAT_VERSION``. Raises OSError if the folder or the marker file cannot be read.
        """
        os.stat(self._folder)
        try:
            data = read_input_bytes(self.marker_path, MAX_RECORD_BYTES)
        except FileNotFoundError:
            raise SharingErrorCause.NOT_BEGUN.make_error(self.name) from None
        except (NotAFileError, TooLargeError) as error:
            raise SharingErrorCause.OTHER.make_error(
                self.name, Message("{mark}: {cause}", mark=MARKER_FILE_NAME, cause=error.strerror)
            ) from error
        number: object = None
        with suppress(ValueError, RecursionError, AttributeError):
            number = json.loads(data).get("format")
        if not isinstance(number, int):
            raise SharingErrorCause.OTHER.make_error(
                self.name, Message("{mark} is damaged", mark=MARKER_FILE_NAME)
            )
        if number != FORMAT_VERSION:
            raise SharingErrorCause.NEWER.make_error(self.name, number)

    @contextmanager
    def _system(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise make_sharing_error(self.name, error) from error


def _files(folder: Path) -> list[Path]:
    """Return the files in the folder, except files that are being written."""
    paths = (Path(entry.path) for entry in os.scandir(folder))
    return sorted(path for path in paths if not path.name.startswith(_WRITING))


def _read_version_file(path: Path) -> SharedVersion | None:
    """Return the version in a file, or None if the file is incomplete or invalid."""
    try:
        record, _, text = read_input_bytes(path, MAX_VERSION_FILE_BYTES).partition(b"\n")
        version = decode_version(path.name.removesuffix(_ENDING), record)
        verify_text(version, text)
    except (RecordError, OSError):
        return None
    return version


def _to_disk(folder: Path) -> None:
    if sys.platform == "win32":
        return  # Windows cannot open folders; their names are synced with the file
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
