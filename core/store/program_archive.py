"""The programs of an open store and all their versions."""

from __future__ import annotations

import sqlite3
from typing import TYPE_CHECKING

from core.store import program_records
from core.store.production import job_queue
from core.store.production.run_records import LoadedTexts
from core.store.store_access import StoreAccess
from core.store.store_rows import ProgramRow, VersionRow

if TYPE_CHECKING:
    from concurrent.futures import Future


class ProgramArchive:
    """Programs by name, each with its versions. Methods raise StoreError as described in ``StoreAccess``."""

    def __init__(self, store: StoreAccess, loaded: LoadedTexts) -> None:
        self._store, self._loaded = store, loaded

    def list_programs(self) -> tuple[ProgramRow, ...]:
        """Return all programs by name, with their newest version."""
        return self._store.query(program_records.listing)

    def list_versions(self, name: str) -> tuple[VersionRow, ...]:
        """Return every version of a program, newest first; () for an unknown program."""
        return self._store.query(program_records.versions, name)

    def load_version(self, name: str, version: int | None = None) -> bytes:
        """Return the text of a version as it was saved; None: of the newest version.

        Raise StoreError for an unknown version and for one that does not match its checksum.
        """
        return self._store.query(program_records.load, name, version)

    def save_version(self, name: str, text: bytes, why: str, *, who: str = "") -> Future[int]:
        """Save a version; the result is its number. A text equal to the newest version is not saved again."""
        return self._store.write(lambda c: program_records.save(c, name, text, why, who))

    def keep_loaded_version(self, name: str, text: bytes, why: str) -> Future[None]:
        """Save a version that is about to run. Runs of this name are then recorded for this text."""
        key = program_records.key_of_bytes(text)
        self._loaded.add(name, key)

        def operation(connection: sqlite3.Connection) -> None:
            job_queue.load_text(connection, name, key)
            program_records.save(connection, name, text, why)

        return self._store.keep_latest(("text", name), operation)

    def rename_program(self, old: str, new: str) -> Future[None]:
        """Give a program another name, with its versions and notes. Its run record belongs to its text."""
        self._loaded.rename(old, new)
        return self._store.write(lambda c: program_records.renamed(c, old, new))
