"""Access to the data of the scope: the last minutes in memory, and the record files of alarms."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from core.message import Message
from core.records.record import RecordError, ScopeRecord
from core.records.record_file import open_record
from core.records.record_ring import ScopeRing

MAX_ALARM_RECORDS = 50  # records of alarms that are stored


class ScopeRecordings:
    """The ring of the last minutes and the folder of the record files, readable from any thread.

    ``folder`` is None if no files are written. If the ring file cannot be written, the samples are only in
    memory, and ``storage_error`` is the reason.
    """

    def __init__(self, ring: ScopeRing, folder: Path | None, storage_error: str = "") -> None:
        self.ring, self.folder, self.storage_error = ring, folder, storage_error

    def get_record_since(self, start_time_s: float, names: Collection[str] | None = None) -> ScopeRecord:
        """Return the samples after ``start_time_s``, a time of the machine clock in seconds.

        ``names`` selects channels; None selects all channels.
        """
        return self.ring.get_record_since(start_time_s, names)

    def get_record_between(
        self, start_time_s: float, end_time_s: float, names: Collection[str] | None = None
    ) -> ScopeRecord:
        """Return the samples from ``start_time_s`` to ``end_time_s``, inclusive, in seconds of the clock.

        ``names`` selects channels; None selects all channels.
        """
        return self.ring.get_record_between(start_time_s, end_time_s, names)

    def is_saving_record(self, _name: str) -> bool:
        """Return whether the record of this alarm is still being written."""
        return False

    def open_alarm_record(self, name: str) -> ScopeRecord:
        """Return the record of an alarm by the file name in its log entry.

        Do not call this function in the thread of the operator screen. Raises RecordError while the record
        is being written, if the record has been deleted, and if its file cannot be read or is damaged.
        """
        if self.is_saving_record(name):
            raise RecordError("the record of this alarm is still being saved; try again in 2 s")
        if self.folder is None or Path(name).name != name or not (self.folder / name).exists():
            raise RecordError(
                Message(
                    "this alarm record was deleted; only the newest {saved} are stored",
                    saved=MAX_ALARM_RECORDS,
                )
            )
        return open_record(self.folder / name)
