"""Assembly of the SCOPE page."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from app.desk.data_folder import RECORDS, data_folder
from app.desk.desk import Desk
from core.records.record import Channel, Record
from core.records.recordings import Recordings

if TYPE_CHECKING:
    from app.scope.scope_curves import LiveSamples
    from app.scope.scope_model import Scope


@dataclass(frozen=True, slots=True)
class RecordedSamples:
    """Adapter that lets the page read the recorder's ring."""

    recorder: Recordings

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Recorded channels."""
        return self.recorder.ring.recorded.channels

    @property
    def last(self) -> float:
        """Time of the newest sample, in seconds."""
        return self.recorder.ring.samples.last

    @property
    def lasts(self) -> float:
        """Duration of the ring in seconds."""
        return self.recorder.ring.recorded.lasts

    def between(self, begin: float, end: float, names: Collection[str] | None = None) -> Record:
        """Return the samples from ``begin`` to ``end`` inclusive."""
        return self.recorder.between(begin, end, names)


def register_scope(desk: Desk, live: LiveSamples | None) -> None:
    """Register the scope with ``live`` samples, or with those of the control.

    Without either, the scope shows only files. The scope is created when the operator first opens its page.
    """
    desk.pages.attach_later("app.scope.scope_model.Scope", partial(_scope, desk, live))
    desk.pages.set_record_opener(lambda name: _scope_of(desk).open_alarm(name))


def _scope(desk: Desk, live: LiveSamples | None) -> Scope:
    from app.scope.record_shelf import RecordShelf
    from app.scope.scope_model import Scope
    from core.records.record_file import open_record, save_record, write_csv

    recordings = desk.control.recordings
    if live is None and recordings is not None:
        live = RecordedSamples(recordings)
    return Scope(desk, live, RecordShelf(data_folder() / RECORDS, save_record, open_record, write_csv))


def _scope_of(desk: Desk) -> Scope:
    from app.scope.scope_model import Scope

    scope = desk.pages.find(Scope)
    assert scope is not None
    return scope
