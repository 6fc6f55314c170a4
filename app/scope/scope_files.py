"""File actions of the scope: save, open, overlay and delete records, and save pictures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from app.desk.translation import tr
from app.scope.recording_store import ZERO_INSTANT_KEY, RecordingFile, find_zero_time
from app.scope.scope_curves import RecordingCurves
from app.scope.scope_model import CURVES_ARE_LIVE_MESSAGE, ScopeModel, SidePanel
from core.access.access_table import ProtectedChange
from core.message import Message
from core.records.record import ScopeRecord


@dataclass(slots=True)
class ScopeFiles:
    """File actions on the recordings of one scope."""

    scope_model: ScopeModel

    def make_visible_record(self) -> ScopeRecord | None:
        """Return the record of the visible window, or show a message and return None.

        The result is None if the curves are live or the window contains no samples.
        """
        frozen = self.scope_model.frozen_curves
        if frozen is None:
            self.scope_model.desk.say(CURVES_ARE_LIVE_MESSAGE)
            return None
        begin, end = (
            frozen.zero_time_s + self.scope_model.time_window.begin_s,
            frozen.zero_time_s + self.scope_model.time_window.end_s,
        )
        cut = frozen.record.select_time_range(begin, end)
        if not len(cut.times_s):
            self.scope_model.desk.say(tr("THE RECORD CONTAINS NO SAMPLES FOR THIS TIME RANGE"))
            return None
        metadata = {**cut.about, ZERO_INSTANT_KEY: f"{frozen.zero_time_s - float(cut.times_s[0]):.6f}"}
        return replace(cut, about=metadata)

    def save_visible_record(self) -> None:
        """Save the visible window as a record."""
        record = self.make_visible_record()
        if record is not None:
            self.scope_model.file_worker.enqueue_work(
                lambda: self.scope_model.recording_store.save_dated_record(record),
                self._written,
                self.scope_model.desk.show_refusal,
            )

    def write_csv(self) -> None:
        """Write the visible window as a CSV table."""
        record = self.make_visible_record()
        if record is not None:
            self.scope_model.file_worker.enqueue_work(
                lambda: self.scope_model.recording_store.write_csv(record),
                self._written,
                self.scope_model.desk.show_refusal,
            )

    def _written(self, path: object) -> None:
        self.scope_model.desk.say(tr(Message("SAVED: {path}", path=path)))
        self.reload_files()

    def reload_files(self) -> None:
        """Update the list of recordings on the disk."""
        self.scope_model.file_worker.enqueue_work(
            self.scope_model.recording_store.list_files, self._listed, self.scope_model.desk.show_refusal
        )

    def _listed(self, files: tuple[RecordingFile, ...]) -> None:
        self.scope_model.recording_store.recording_files = files

    def open_alarm_recording(self, name: str) -> None:
        """Open the record of an alarm, even if the record is still being written."""
        recorder = self.scope_model.desk.desk_control.recordings
        folder, shelf = self.scope_model.recording_store.folder, self.scope_model.recording_store
        self.scope_model.side_panel = SidePanel.READINGS

        def read_alarm_record() -> ScopeRecord:
            return (
                recorder.open_alarm_record(name)
                if recorder is not None
                else shelf.read_recording(folder / name)
            )

        def show_alarm_record(record: ScopeRecord) -> None:
            self.scope_model.show_recording(record, name)

        self.scope_model.file_worker.enqueue_work(
            read_alarm_record, show_alarm_record, self.scope_model.desk.show_refusal
        )

    def open_file(self, file: RecordingFile) -> None:
        """Open a record from the disk."""
        path, shelf = file.path, self.scope_model.recording_store

        def show_opened_record(record: ScopeRecord) -> None:
            self.scope_model.side_panel = SidePanel.READINGS
            self.scope_model.show_recording(record, path.name)

        self.scope_model.file_worker.enqueue_work(
            lambda: shelf.read_recording(path), show_opened_record, self.scope_model.desk.show_refusal
        )

    def overlay_file(self, file: RecordingFile) -> None:
        """Overlay an earlier recording, with both zero times aligned.

        If this recording is already overlaid, remove it.
        """
        self.scope_model.desk.clear_prompt_line()
        if self.scope_model.overlay_name == file.path.name:
            self.scope_model.overlay_curves, self.scope_model.overlay_name = None, ""
            return
        path, shelf = file.path, self.scope_model.recording_store

        def set_overlay(record: ScopeRecord) -> None:
            self.scope_model.overlay_curves, self.scope_model.overlay_name = (
                RecordingCurves(record, find_zero_time(record)),
                path.name,
            )

        self.scope_model.file_worker.enqueue_work(
            lambda: shelf.read_recording(path), set_overlay, self.scope_model.desk.show_refusal
        )

    def delete_file(self, file: RecordingFile) -> None:
        """Delete a record file after confirmation."""
        if self.scope_model.desk.is_refused(ProtectedChange.RECORDS):
            return

        def report_deletion(_nothing: object) -> None:
            self.scope_model.desk.user_access.persistence.log_change(
                Message("record {path} deleted", path=file.path.name)
            )
            self.scope_model.desk.say(tr(Message("DELETED: {path}", path=file.path.name)))
            self.reload_files()

        def start_deletion() -> None:
            self.scope_model.file_worker.enqueue_work(
                lambda: self.scope_model.recording_store.delete_recording(file.path),
                report_deletion,
                self.scope_model.desk.show_refusal,
            )

        question = tr(Message("PRESS Y TO DELETE {path}, N TO KEEP IT", path=file.path.name))
        self.scope_model.desk.ask_operator(question, start_deletion)

    def write_picture(self, render_png: Callable[[], bytes]) -> None:
        """Save a picture of the page on a worker. ``render_png`` returns the PNG bytes."""
        shelf = self.scope_model.recording_store
        self.scope_model.file_worker.enqueue_work(
            lambda: shelf.write_picture(render_png()), self._written, self.scope_model.desk.show_refusal
        )
