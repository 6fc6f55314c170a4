"""What the scope has recorded, for whoever reads it: the last minutes in memory, and the files of alarms."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from core.message import Message
from core.records.record import Record, RecordError
from core.records.record_file import open_record
from core.records.record_ring import Ring

KEPT = 50  # records of alarms


class Recordings:
    """The ring and the folder of the records; any thread may read.

    ``folder`` is None where nothing is written. ``trouble`` says why the file is not written; the record is
    then in memory alone.
    """

    def __init__(self, ring: Ring, folder: Path | None, trouble: str = "") -> None:
        self.ring, self.folder, self.trouble = ring, folder, trouble

    def latest(self, since: float, names: Collection[str] | None = None) -> Record:
        """Return what was sampled after ``since``, seconds of the clock; ``names``: these channels alone."""
        return self.ring.latest(since, names)

    def between(self, begin: float, end: float, names: Collection[str] | None = None) -> Record:
        """Return the samples from ``begin`` up to and with ``end``, seconds of the clock."""
        return self.ring.between(begin, end, names)

    def is_saving(self, _name: str) -> bool:
        """Return whether the record of this alarm is still to be written."""
        return False

    def alarm_record(self, name: str) -> Record:
        """Return the record of an alarm by the name in its log entry; not for the screen's thread.

        Raises RecordError while it is still being written, and for one that is no longer kept.
        """
        if self.is_saving(name):
            raise RecordError("the record of this alarm is still being saved; try again in 2 s")
        if self.folder is None or Path(name).name != name or not (self.folder / name).exists():
            raise RecordError(
                Message("this alarm record was deleted; only the newest {saved} are stored", saved=KEPT)
            )
        return open_record(self.folder / name)
