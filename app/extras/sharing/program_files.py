"""The program files of this machine as they are shared: which, what they hold, and which are not."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from app.desk.programs.program_folder import ENDINGS
from core.extras.sharing.shared_versions import key_of
from core.extras.sharing.version_record import MOST_BYTES
from core.input_file import input_bytes
from core.message import Message
from core.store.program_records import check_name
from core.store.store_errors import StoreError

_Stamp = tuple[int, int]  # time of the last change in nanoseconds, bytes
_GRAIN = 2_000_000_000  # ns: a file that has just been written may change once more and keep its time


@dataclass(frozen=True, slots=True)
class SharedFile:
    """One program file; ``digest`` is SHA-256 of what it holds."""

    name: str
    path: Path
    digest: str


@dataclass(slots=True)
class FilesOfMachine:
    """The operator's folder. A file is read again only when its time or size has changed."""

    folder: Path
    refused: Mapping[str, str] = field(default_factory=dict)  # why a file is not shared, by its name
    present: frozenset[str] = frozenset()  # keys of all files of the last look, shared or not
    _read: dict[str, tuple[_Stamp, str]] = field(default_factory=dict)
    _seen: dict[str, _Stamp] = field(default_factory=dict)

    def look(self, *, settled: bool) -> dict[str, SharedFile]:
        """Files by the key of their program.

        ``settled``: what is being written is left for the next look, when it has stopped changing.
        """
        found, refused, stamps = dict[str, SharedFile](), dict[str, str](), dict[str, _Stamp]()
        names = [path.name for path in _program_files(self.folder)]
        keys = [key_of(name) for name in names]
        for name, key in zip(names, keys, strict=True):
            path = self.folder / name
            try:
                status = path.stat()
                stamps[name] = stamp = status.st_mtime_ns, status.st_size
                why = _why_not(name, status.st_size, twice=keys.count(key) > 1)
                if not why and (not settled or stamp == self._seen.get(name, stamp)):
                    found[key] = SharedFile(name, path, self._digest(path, stamp))
            except OSError as error:
                why = error.strerror or str(error)
            if why:
                refused[name] = why
        self.refused, self._seen, self.present = refused, stamps, frozenset(keys)
        return found

    def _digest(self, path: Path, stamp: _Stamp) -> str:
        before = self._read.get(path.name)
        if before is not None and before[0] == stamp:
            return before[1]
        digest = sha256(input_bytes(path, MOST_BYTES)).hexdigest()
        if time.time_ns() - stamp[0] > _GRAIN:
            self._read[path.name] = stamp, digest
        return digest


def _program_files(folder: Path) -> list[Path]:
    try:
        paths = sorted(folder.iterdir())
    except OSError:
        return []
    return [
        path
        for path in paths
        if path.suffix.lower() in ENDINGS and not path.name.startswith(".") and path.is_file()
    ]


def _why_not(name: str, size: int, *, twice: bool) -> str:
    if twice:
        return (
            "the name of another program on this control differs from the name of this "
            "program only in upper and lower case: rename one of the programs"
        )
    if size > MOST_BYTES:
        return Message("the file is larger than {most_bytes} MB", most_bytes=MOST_BYTES // 2**20)
    try:
        check_name(name)
    except StoreError as error:
        return str(error)
    return ""
