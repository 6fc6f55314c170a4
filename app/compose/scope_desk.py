"""The scope of a desk: its page with the recorder behind it, and the folder of its records."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from app.desk.data_folder import RECORDS, data_folder
from app.desk.desk import Desk
from app.jog.drive_test_model import DriveTests
from app.scope.analyses import Analyses
from app.scope.record_shelf import RecordShelf
from app.scope.scope_curves import LiveSamples
from app.scope.scope_model import Scope
from core.executor.recorder import Recorder
from core.records.record import Channel, Record
from core.records.record_file import open_record, save_record, write_csv


@dataclass(frozen=True, slots=True)
class RecordedSamples:
    """The recorder's ring, as the page reads it."""

    recorder: Recorder

    @property
    def channels(self) -> tuple[Channel, ...]:
        """What is recorded."""
        return self.recorder.ring.recorded.channels

    @property
    def last(self) -> float:
        """Time of the newest sample."""
        return self.recorder.ring.samples.last

    @property
    def lasts(self) -> float:
        """Seconds that are kept."""
        return self.recorder.ring.recorded.lasts

    def between(self, begin: float, end: float, names: Collection[str] | None = None) -> Record:
        """The samples from ``begin`` up to and with ``end``."""
        return self.recorder.between(begin, end, names)


def give_scope(desk: Desk, live: LiveSamples | None = None) -> None:
    """The page SCOPE on ``live``, or on what the desk's recorder samples; with neither it has files alone."""
    if live is None and desk.recorder is not None:
        live = RecordedSamples(desk.recorder)
    shelf = RecordShelf(data_folder() / RECORDS, save_record, open_record, write_csv)
    scope = Scope(desk, live, shelf)
    desk.attach(scope)
    desk.open_record = scope.open_alarm
    slides = {axis.name: axis for axis in desk.lathe.axes} if desk.lathe is not None else {}
    desk.attach(Analyses(scope, slides, desk.lathe.spindle if desk.lathe is not None else None))
    if desk.lathe is not None:
        desk.attach(DriveTests(desk, scope, desk.lathe))
