"""Cache of proofs, found by everything on which they depend.

A file is written under a temporary name and renamed, so a killed process leaves no incomplete proof. A
damaged file cannot be decompressed and is ignored.
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

from app.cli.proofs.proof_work import Proof, code_version

if TYPE_CHECKING:
    from app.cli.proofs.proof_job import ProofJob
    from core.language.source import Source

LARGEST = 256 * 2**20  # bytes of all proofs
_KEPT = 0.8  # fraction of LARGEST after the oldest proofs have been deleted
_ASIDE = ".part"
_STALE = 3600.0  # s; an older temporary file was left by a process that has ended


class ProofCache:
    """Proofs of one job in the folder ``proofs`` of the data folder, by their contents."""

    def __init__(self, folder: Path, job: ProofJob, largest: int = LARGEST) -> None:
        self._folder, self._largest = folder, largest
        job_text = "\n".join((code_version(), plain(job)))
        self._job = sha256(job_text.encode()).digest()
        self._full = False

    def key(self, source: Source, own: object = None) -> str:
        """Return the key of a program's proof; ``own`` are data that apply only to this program."""
        text = plain((source.name, str(source.dialect), source.text, source.subprograms, own))
        return sha256(self._job + text.encode("utf-8", "surrogatepass")).hexdigest()

    def find(self, key: str) -> Proof | None:
        """Return the saved proof, or None."""
        path = self._path(key)
        try:
            kept = json.loads(zlib.decompress(path.read_bytes()))
            os.utime(path)  # marks the file as used, because the oldest files are deleted first
            return Proof(kept["report"], kept["section"])
        except (OSError, zlib.error, ValueError, KeyError, TypeError):
            return None

    def keep(self, key: str, proof: Proof) -> None:
        """Save a proof. The first disk error is reported, and no more proofs are then saved."""
        if self._full:
            return
        path = self._path(key)
        kept = {"report": proof.report, "section": proof.section}
        aside = path.with_name(f"{path.name}.{os.getpid()}{_ASIDE}")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            aside.write_bytes(zlib.compress(json.dumps(kept).encode()))
            aside.replace(path)
        except OSError as error:
            self._full = True
            aside.unlink(missing_ok=True)
            sys.stderr.write(f"turndesk: proofs cannot be stored in {self._folder} ({error.strerror})\n")

    def trim(self) -> None:
        """Delete the oldest proofs if the cache is too large, and temporary files of killed processes."""
        try:
            there = [_File(path, *_stamp(path)) for path in self._folder.glob("??/*")]
        except OSError:
            return
        stale = [f for f in there if f.path.suffix == _ASIDE and f.used < time.time() - _STALE]
        kept = sorted((f for f in there if f.path.suffix != _ASIDE), key=lambda f: f.used)
        size = sum(each.size for each in kept)
        if size > self._largest:
            while kept and size > _KEPT * self._largest:
                size -= kept[0].size
                stale.append(kept.pop(0))
        for each in stale:
            each.path.unlink(missing_ok=True)

    def _path(self, key: str) -> Path:
        return self._folder / key[:2] / key[2:]


@dataclass(frozen=True, slots=True)
class _File:
    path: Path
    used: float  # =
    size: int


def _stamp(path: Path) -> tuple[float, int]:
    try:
        found = path.stat()
    except OSError:  # another process has deleted the file
        return time.time(), 0
    return found.st_mtime, found.st_size


def plain(value: object) -> str:
    """Return a value as text that is identical in every process, for hashing.

    Raises TypeError for a value without such a text, such as a function.
    """
    match value:
        case Enum():
            return f"{type(value).__name__}.{value.name}"
        case None | bool() | int() | float() | str():
            return repr(value)
        case Mapping():
            return "{" + ",".join(sorted(f"{plain(k)}:{plain(v)}" for k, v in value.items())) + "}"
        case tuple() | list():
            return "[" + ",".join(map(plain, value)) + "]"
        case Set():
            return "<" + ",".join(sorted(map(plain, value))) + ">"
    if is_dataclass(value) and not isinstance(value, type):
        inner = ",".join(f"{each.name}={plain(getattr(value, each.name))}" for each in fields(value))
        return f"{type(value).__name__}({inner})"
    raise TypeError(f"{type(value).__name__} has no text that stays the same")
