"""What the editor needs from the rest of the house."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from app.desk.session import Workshop
from core.store.errors import StoreError
from core.store.rows import VersionRow


class Archive(Protocol):
    """The versions of programs. Called on the editor's worker only; each raises StoreError."""

    def versions(self, name: str) -> Sequence[VersionRow]:
        """Every version of a program, newest first."""
        ...

    def text_of(self, name: str, version: int) -> bytes:
        """One of them, as it was kept."""
        ...

    def keep_version(self, name: str, text: bytes, why: str) -> int:
        """Keep another, and answer its number when it is on the disk; the same text again is no new one."""
        ...


class NoArchive:
    """Where nothing is kept: scripts, and a desk whose store cannot be opened."""

    def versions(self, _name: str) -> Sequence[VersionRow]:
        """None."""
        return ()

    def text_of(self, name: str, version: int) -> bytes:
        """There is none."""
        raise StoreError(f"no version {version} of {name} is kept here")

    def keep_version(self, _name: str, _text: bytes, _why: str) -> int:
        """It is not kept."""
        return 0


@dataclass(frozen=True, slots=True)
class Bench:
    """``workshop`` proves without keeping anything, ``programs`` is the operator's own folder."""

    workshop: Workshop
    archive: Archive
    programs: Path
    samples: Path
