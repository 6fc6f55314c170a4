"""Assembly of the SCOPE page, which shows recorded signals."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from app.desk.data_folder import RECORDS_FOLDER_NAME, find_data_folder
from app.desk.desk import Desk
from core.records.record import Channel, ScopeRecord
from core.records.recordings import ScopeRecordings

if TYPE_CHECKING:
    from app.scope.scope_curves import LiveSamples
    from app.scope.scope_model import ScopeModel


@dataclass(frozen=True, slots=True)
class RecordedSamples:
    """Adapter through which the SCOPE page reads the recorder's ring buffer."""

    recorder: ScopeRecordings

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Return the recorded channels."""
        return self.recorder.ring.layout.channels

    @property
    def newest_time_s(self) -> float:
        """Return the time of the newest sample, in seconds."""
        return self.recorder.ring.samples.last_time_s

    @property
    def buffer_duration_s(self) -> float:
        """Return the duration of the ring buffer, in seconds."""
        return self.recorder.ring.layout.duration_s

    def read_samples_between(
        self, start_s: float, end_s: float, channel_names: Collection[str] | None = None
    ) -> ScopeRecord:
        """Return the samples from ``start_s`` to ``end_s`` inclusive."""
        return self.recorder.get_record_between(start_s, end_s, channel_names)


def register_scope(desk: Desk, live_samples: LiveSamples | None) -> None:
    """Register the SCOPE page with ``live_samples``, or with the samples of the control if it is None.

    Without a source of samples, the page shows only saved records. Its model is created when the operator
    first opens the page.
    """
    desk.page_registry.attach_lazy_model(
        "app.scope.scope_model.ScopeModel", partial(_scope, desk, live_samples)
    )
    desk.page_registry.set_recording_opener(partial(_open_alarm_recording, desk))


def _scope(desk: Desk, live: LiveSamples | None) -> ScopeModel:
    from app.scope.recording_store import RecordingStore
    from app.scope.scope_model import ScopeModel
    from core.records.record_file import open_record, save_record, write_csv_lines

    recordings = desk.desk_control.recordings
    if live is None and recordings is not None:
        live = RecordedSamples(recordings)
    return ScopeModel(
        desk,
        live,
        RecordingStore(find_data_folder() / RECORDS_FOLDER_NAME, save_record, open_record, write_csv_lines),
    )


def _open_alarm_recording(desk: Desk, name: str) -> None:
    from app.scope.scope_files import ScopeFiles
    from app.scope.scope_model import ScopeModel

    scope = desk.page_registry.find_model(ScopeModel)
    assert scope is not None
    ScopeFiles(scope).open_alarm_recording(name)
