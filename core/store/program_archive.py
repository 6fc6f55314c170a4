"""The programs of an open store and all their versions."""

from __future__ import annotations

import sqlite3
from typing import TYPE_CHECKING

from core.store import program_records
from core.store.production import job_queue
from core.store.production.run_records import LoadedProgramTexts
from core.store.store_access import StoreAccess
from core.store.store_rows import ProgramRow, ProgramVersionRow

if TYPE_CHECKING:
    from concurrent.futures import Future


class ProgramArchive:
    """Programs by name, each with all its versions.

    Methods raise StoreError as described in ``StoreAccess``.
    """

    def __init__(self, store: StoreAccess, loaded: LoadedProgramTexts) -> None:
        self._store, self._loaded = store, loaded

    def list_programs(self) -> tuple[ProgramRow, ...]:
        """Return all programs with their newest version, sorted by name."""
        return self._store.run_query(program_records.read_programs)

    def list_versions(self, name: str) -> tuple[ProgramVersionRow, ...]:
        """Return every version of a program, newest first, or () for an unknown program."""
        return self._store.run_query(program_records.read_versions, name)

    def load_version(self, name: str, version: int | None = None) -> bytes:
        """Return the text of a version as it was saved.

        If ``version`` is None, the newest version is returned. Raises StoreError if the version is unknown
        or does not match its checksum.
        """
        return self._store.run_query(program_records.load_version, name, version)

    def save_version(self, name: str, text: bytes, reason: str, *, author: str = "") -> Future[int]:
        """Save a new version of a program.

        The result is the version number. A text that equals the newest version is not saved again.
        """
        return self._store.write(
            lambda c: program_records.save_program_version(c, name, text, reason, author)
        )

    def save_loaded_version(self, name: str, text: bytes, reason: str) -> Future[None]:
        """Save the version that is about to run.

        Later runs under this name are recorded for this text.
        """
        key = program_records.make_bytes_record_key(text)
        self._loaded.record_loaded_text(name, key)

        def write_loaded_version(connection: sqlite3.Connection) -> None:
            job_queue.record_loaded_text(connection, name, key)
            program_records.save_program_version(connection, name, text, reason)

        return self._store.store_latest_operation(("text", name), write_loaded_version)

    def rename_program(self, old_name: str, new_name: str) -> Future[None]:
        """Rename a program together with its versions, run record and notes."""
        self._loaded.rename_program(old_name, new_name)
        return self._store.write(lambda c: program_records.transfer_records(c, old_name, new_name))
