"""Sharing of programs in a folder, with one file for each version and one for each machine.

Files are added completely or not at all. Files on a network drive are not locked. Each machine writes only
its own files and version files, whose contents do not depend on the machine that writes them.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from core.extras.sharing.shared_place import Cause, Found, Published, folder_at, of_system
from core.extras.sharing.shared_versions import SharedVersion
from core.extras.sharing.version_record import (
    FORMAT,
    LONGEST_RECORD,
    LONGEST_STATE,
    MOST_BYTES,
    DeskState,
    RecordError,
    checked_text,
    is_id,
    read_state,
    read_version,
    written,
)
from core.input_file import NotAFileError, TooLargeError, input_bytes
from core.message import Message

MARK = "turndesk-share.json"  # identifies a shared folder; an empty mount point does not have this file
VERSIONS, DESKS = "versions", "desks"
LONGEST = LONGEST_RECORD + 1 + MOST_BYTES  # bytes, largest file of a version
_ENDING, _STATE, _WRITING = ".version", ".json", ".writing-"


class SharedFolder:
    """A folder that all machines can access. A version file has the record, a line end and the text."""

    def __init__(self, folder: Path) -> None:
        self.name = folder_at(folder)
        self._folder = folder
        self._sizes: dict[str, int] = {}  # file sizes by id of the version

    @property
    def mark(self) -> Path:
        """Path of the file that identifies a folder with shared programs."""
        return self._folder / MARK

    def begin(self) -> None:
        """Set up the folder, which must exist, so that a folder that is not mounted is never created."""
        with self._system():
            if not self.mark.exists():
                os.stat(self._folder)
                for each in (VERSIONS, DESKS):
                    (self._folder / each).mkdir(exist_ok=True)
                self._write(self.mark, json.dumps({"format": FORMAT}).encode())
            self._demand()

    def look(self, known: Mapping[str, SharedVersion]) -> Found:
        """Return the versions in the folder; only files of unknown versions are opened."""
        with self._system():
            self._demand()
            there, fresh, strays = set[str](), list[SharedVersion](), list[str]()
            for path in _files(self._folder / VERSIONS):
                name = path.name.removesuffix(_ENDING)
                if not path.name.endswith(_ENDING) or not is_id(name):
                    strays.append(path.name)
                    continue
                version = _version_in(path) if name not in known else None
                if version is not None:
                    fresh.append(version)
                if version is not None or (name in known and self._is_whole(path, known[name])):
                    there.add(name)
                else:
                    strays.append(path.name)
            desks, bad = self._desks()
            return Found(frozenset(there), tuple(fresh), desks, (*strays, *bad))

    def put(self, versions: Sequence[Published], state: DeskState) -> None:
        """Add version files and this machine's state; each file is synced before it gets its name."""
        with self._system():
            self._demand()
            self._clear(state.home)
            for version, text in versions:
                self._add(version, text, state.home)
            _to_disk(self._folder / VERSIONS)
            self._write(self._folder / DESKS / f"{state.home}{_STATE}", state.written(), state.home)
            _to_disk(self._folder / DESKS)

    def text(self, version: SharedVersion) -> bytes:
        """Return the text of a version from its file, checked against its checksum."""
        path = self._folder / VERSIONS / f"{version.id}{_ENDING}"
        with self._system():
            self._demand()
            _, _, text = input_bytes(path, LONGEST).partition(b"\n")
            try:
                return checked_text(version, text)
            except RecordError as error:
                raise Cause.DAMAGED.error(self.name, error) from error

    def _is_whole(self, path: Path, version: SharedVersion) -> bool:
        """Return whether a version file has the expected size.

        A truncated file is published again by a machine that has the text.
        """
        size = self._sizes.setdefault(version.id, len(written(version)) + 1 + version.size)
        return path.stat().st_size == size

    def _add(self, version: SharedVersion, text: bytes, home: str) -> None:
        path = self._folder / VERSIONS / f"{version.id}{_ENDING}"
        whole = written(version) + b"\n" + text
        if path.exists():
            with suppress(OSError):
                if input_bytes(path, len(whole)) == whole:
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

    def _clear(self, home: str) -> None:
        """Remove unfinished files of this machine that a power failure left."""
        for folder in (VERSIONS, DESKS):
            for path in (self._folder / folder).glob(f"{_WRITING}{home}-*"):
                path.unlink(missing_ok=True)

    def _desks(self) -> tuple[tuple[DeskState, ...], list[str]]:
        found, strays = [], list[str]()
        for path in _files(self._folder / DESKS):
            home = path.name.removesuffix(_STATE)
            try:
                found.append(read_state(home, input_bytes(path, LONGEST_STATE)))
            except (RecordError, OSError):
                strays.append(path.name)
        return tuple(found), strays

    def _demand(self) -> None:
        """Raise SharingError if the folder is not set up for shared programs or has a newer format."""
        os.stat(self._folder)
        try:
            data = input_bytes(self.mark, LONGEST_RECORD)
        except FileNotFoundError:
            raise Cause.NOT_BEGUN.error(self.name) from None
        except (NotAFileError, TooLargeError) as error:
            raise Cause.OTHER.error(
                self.name, Message("{mark}: {cause}", mark=MARK, cause=error.strerror)
            ) from error
        number: object = None
        with suppress(ValueError, RecursionError, AttributeError):
            number = json.loads(data).get("format")
        if not isinstance(number, int):
            raise Cause.OTHER.error(self.name, Message("{mark} is damaged", mark=MARK))
        if number != FORMAT:
            raise Cause.NEWER.error(self.name, number)

    @contextmanager
    def _system(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise of_system(self.name, error) from error


def _files(folder: Path) -> list[Path]:
    """Return the files in the folder, except files that are being written."""
    paths = (Path(entry.path) for entry in os.scandir(folder))
    return sorted(path for path in paths if not path.name.startswith(_WRITING))


def _version_in(path: Path) -> SharedVersion | None:
    """Return the version in a file; None if the file is incomplete or invalid."""
    try:
        record, _, text = input_bytes(path, LONGEST).partition(b"\n")
        version = read_version(path.name.removesuffix(_ENDING), record)
        checked_text(version, text)
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
