"""Proofs that are kept: found again by what they depend on, so that nothing is proved twice.

A file is written aside and renamed: a process that is killed leaves no half of one. What is damaged all the
same does not unpack, and counts as not there.
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

LARGEST = 256 * 2**20  # bytes of all proofs together
_KEPT = 0.8  # of LARGEST, after the oldest have gone
_ASIDE = ".part"
_STALE = 3600.0  # s; a file aside that is so old was left by a process that has gone


class ProofCache:
    """The proofs of one job in the folder ``proofs`` of the data folder, by content."""

    def __init__(self, folder: Path, job: ProofJob, largest: int = LARGEST) -> None:
        self._folder, self._largest = folder, largest
        job_text = "\n".join((code_version(), plain(job)))
        self._job = sha256(job_text.encode()).digest()
        self._full = False

    def key(self, source: Source, own: object = None) -> str:
        """What the proof of a program depends on, in a name; ``own`` is what else counts for it alone."""
        text = plain((source.name, str(source.dialect), source.text, source.subprograms, own))
        return sha256(self._job + text.encode("utf-8", "surrogatepass")).hexdigest()

    def find(self, key: str) -> Proof | None:
        """The proof, or None where none is kept."""
        path = self._path(key)
        try:
            kept = json.loads(zlib.decompress(path.read_bytes()))
            os.utime(path)  # the oldest that nobody asks for go first
            return Proof(kept["report"], kept["section"])
        except (OSError, zlib.error, ValueError, KeyError, TypeError):
            return None

    def keep(self, key: str, proof: Proof) -> None:
        """Keep a proof; where the disk does not take it, that is told once, and nothing more is kept."""
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
        """Throw the oldest away when there are too many, and what killed processes have left."""
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
    used: float  # s since the epoch
    size: int


def _stamp(path: Path) -> tuple[float, int]:
    try:
        found = path.stat()
    except OSError:  # another process has thrown it away meanwhile
        return time.time(), 0
    return found.st_mtime, found.st_size


def plain(value: object) -> str:
    """A value as a text that is the same in every process: what a hash can be made of.

    Raises TypeError for what has no such text, such as a function.
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
