"""Cache of proofs, in which the key of a proof is a hash of all data that affect the proof.

A file is written under a temporary name and then renamed, so that a killed process does not leave an
incomplete proof. A damaged file cannot be decompressed and is ignored.
"""

from __future__ import annotations

import json
import os
import sys
import time
import zlib
from collections.abc import Mapping, Set
from dataclasses import dataclass, fields, is_dataclass
from enum import Enum
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.proofs.proof_work import Proof, get_code_hash

if TYPE_CHECKING:
    from app.cli.proofs.proof_job import ProofJob
    from core.language.source import ProgramSource

MAX_CACHE_BYTES = 256 * 2**20  # bytes of all proofs
_TRIM_FRACTION = 0.8  # fraction of LARGEST after the oldest proofs have been deleted
_TEMPORARY_SUFFIX = ".part"
_STALE_AGE_S = 3600.0  # s; an older temporary file was left by a process that has ended


class ProofCache:
    """Saved proofs of one proof job, in the folder ``proofs`` of the data folder.

    The file name of a proof is a hash of the data on which the proof depends.
    """

    def __init__(self, folder: Path, job: ProofJob, max_bytes: int = MAX_CACHE_BYTES) -> None:
        self._folder, self._largest = folder, max_bytes
        job_text = "\n".join((get_code_hash(), format_for_hash(job)))
        self._job = sha256(job_text.encode()).digest()
        self._full = False

    def get_cache_key(self, source: ProgramSource, program_data: object = None) -> str:
        """Return the cache key of a program's proof.

        ``program_data`` are further data of this program on which the proof depends.
        """
        text = format_for_hash(
            (source.name, str(source.dialect), source.text, source.subprograms, program_data)
        )
        return sha256(self._job + text.encode("utf-8", "surrogatepass")).hexdigest()

    def find_proof(self, key: str) -> Proof | None:
        """Return the saved proof, or None if the cache does not contain a valid proof."""
        path = self._path(key)
        try:
            kept = json.loads(zlib.decompress(path.read_bytes()))
            os.utime(path)  # marks the file as used, because the oldest files are deleted first
            return Proof(kept["report"], kept["section"])
        except (OSError, zlib.error, ValueError, KeyError, TypeError):
            return None

    def save_proof(self, key: str, proof: Proof) -> None:
        """Save a proof. The first disk error is reported, and then no more proofs are saved."""
        if self._full:
            return
        path = self._path(key)
        kept = {"report": proof.report_json, "section": proof.report_section}
        aside = path.with_name(f"{path.name}.{os.getpid()}{_TEMPORARY_SUFFIX}")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            aside.write_bytes(zlib.compress(json.dumps(kept).encode()))
            aside.replace(path)
        except OSError as error:
            self._full = True
            aside.unlink(missing_ok=True)
            sys.stderr.write(f"turndesk: proofs cannot be stored in {self._folder} ({error.strerror})\n")

    def delete_oldest_proofs(self) -> None:
        """Delete the oldest proofs if the cache is too large.

        Temporary files of killed processes are also deleted.
        """
        try:
            there = [_CacheFile(path, *_stamp(path)) for path in self._folder.glob("??/*")]
        except OSError:
            return
        stale = [
            f
            for f in there
            if f.path.suffix == _TEMPORARY_SUFFIX and f.last_used_time_s < time.time() - _STALE_AGE_S
        ]
        kept = sorted(
            (f for f in there if f.path.suffix != _TEMPORARY_SUFFIX), key=lambda f: f.last_used_time_s
        )
        size = sum(each.size_bytes for each in kept)
        if size > self._largest:
            while kept and size > _TRIM_FRACTION * self._largest:
                size -= kept[0].size_bytes
                stale.append(kept.pop(0))
        for each in stale:
            each.path.unlink(missing_ok=True)

    def _path(self, key: str) -> Path:
        return self._folder / key[:2] / key[2:]


@dataclass(frozen=True, slots=True)
class _CacheFile:
    path: Path
    last_used_time_s: float  # =
    size_bytes: int


def _stamp(path: Path) -> tuple[float, int]:
    try:
        found = path.stat()
    except OSError:  # another process has deleted the file
        return time.time(), 0
    return found.st_mtime, found.st_size


def format_for_hash(value: object) -> str:
    """Return a value as text for hashing that is identical in every process.

    Raises TypeError for a value without such a text, such as a function.
    """
    match value:
        case Enum():
            return f"{type(value).__name__}.{value.name}"
        case None | bool() | int() | float() | str():
            return repr(value)
        case Mapping():
            return (
                "{"
                + ",".join(sorted(f"{format_for_hash(k)}:{format_for_hash(v)}" for k, v in value.items()))
                + "}"
            )
        case tuple() | list():
            return "[" + ",".join(map(format_for_hash, value)) + "]"
        case Set():
            return "<" + ",".join(sorted(map(format_for_hash, value))) + ">"
    if is_dataclass(value) and not isinstance(value, type):
        inner = ",".join(
            f"{each.name}={format_for_hash(getattr(value, each.name))}" for each in fields(value)
        )
        return f"{type(value).__name__}({inner})"
    raise TypeError(f"{type(value).__name__} has no text that stays the same")
