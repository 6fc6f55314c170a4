"""Files in the program folder of this machine and their digests, for program sharing."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from app.desk.programs.program_folder import PROGRAM_EXTENSIONS
from core.extras.sharing.shared_versions import make_program_key
from core.extras.sharing.version_record import MAX_PROGRAM_BYTES
from core.input_file import format_file_size, read_input_bytes
from core.message import Message
from core.store.program_records import check_new_program_name
from core.store.store_errors import StoreError

_Stamp = tuple[int, int]  # time of the last change in nanoseconds, size in bytes
_GRAIN = 2_000_000_000  # ns: a file that was just written can change again without a new time


@dataclass(frozen=True, slots=True)
class ProgramFile:
    """Program file in the program folder, with the SHA-256 digest of its content."""

    name: str
    path: Path
    sha256_digest: str


@dataclass(slots=True)
class LocalProgramFiles:
    """Program files in the operator's program folder.

    A file is read again only if its time or size has changed.
    """

    folder: Path
    rejected_files: Mapping[str, str] = field(
        default_factory=dict
    )  # reason why a file is not shared, by file name
    program_keys: frozenset[str] = frozenset()  # keys of all files of the last scan, shared or not
    _read: dict[str, tuple[_Stamp, str]] = field(default_factory=dict)
    _seen: dict[str, _Stamp] = field(default_factory=dict)

    def read_files(self, *, is_settled: bool) -> dict[str, ProgramFile]:
        """Return the program files by program key.

        If ``is_settled`` is True, a file that is still being written is skipped until the next scan.
        """
        found, refused, stamps = dict[str, ProgramFile](), dict[str, str](), dict[str, _Stamp]()
        names = [path.name for path in _program_files(self.folder)]
        keys = [make_program_key(name) for name in names]
        for name, key in zip(names, keys, strict=True):
            path = self.folder / name
            try:
                status = path.stat()
                stamps[name] = stamp = status.st_mtime_ns, status.st_size
                why = _why_not(name, status.st_size, twice=keys.count(key) > 1)
                if not why and (not is_settled or stamp == self._seen.get(name, stamp)):
                    found[key] = ProgramFile(name, path, self._digest(path, stamp))
            except OSError as error:
                why = error.strerror or str(error)
            if why:
                refused[name] = why
        self.rejected_files, self._seen, self.program_keys = refused, stamps, frozenset(keys)
        return found

    def _digest(self, path: Path, stamp: _Stamp) -> str:
        before = self._read.get(path.name)
        if before is not None and before[0] == stamp:
            return before[1]
        digest = sha256(read_input_bytes(path, MAX_PROGRAM_BYTES)).hexdigest()
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
        if path.suffix.lower() in PROGRAM_EXTENSIONS and not path.name.startswith(".") and path.is_file()
    ]


def _why_not(name: str, size: int, *, twice: bool) -> str:
    if twice:
        return (
            "the name of another program on this control differs from the name of this "
            "program only in upper and lower case: rename one of the programs"
        )
    if size > MAX_PROGRAM_BYTES:
        return Message("the file is larger than {limit}", limit=format_file_size(MAX_PROGRAM_BYTES))
    try:
        check_new_program_name(name)
    except StoreError as error:
        return str(error)
    return ""
