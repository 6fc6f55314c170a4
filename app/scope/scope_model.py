"""Model of the scope, with live or frozen curves, trigger, cursors and an overlaid record.

All curves are calculated on a worker. ``poll`` stores the last finished picture and requests the next one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import partial

import numpy as np

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.translation import tr
from app.scope.recording_store import ZERO_INSTANT_KEY, RecordingStore, find_zero_time
from app.scope.scope_curves import (
    LiveCurves,
    LiveSamples,
    PictureRequest,
    RecordingCurves,
    ScopePicture,
    ValueRange,
)
from app.scope.signals import Quantity, ScopeSignal, find_default_signal_keys, list_signals
from app.scope.time_window import PAN_STEP_FRACTION, TimeCursors, TimeWindow, Trigger, TriggerEvent
from core.executor.snapshot import Snapshot
from core.message import Message
from core.records.record import ScopeRecord

MAX_CURVES = 8  # curves; inputs and outputs are counted separately
MAX_LOGIC_CURVES = 12
MIN_FROZEN_TIME_S = 60.0  # minimum seconds that are frozen; otherwise three windows
CONSTANT_UPDATE_S = 1.0  # seconds after which constant curves are updated even without a change
ZOOM_STEP = 1.5  # factor of one step of a lane's range
CURVES_ARE_LIVE_MESSAGE = tr("CURVES ARE LIVE. F2: FREEZE THEM FIRST")
NO_SAMPLES_MESSAGE = tr("NO SCOPE DATA ON THIS MACHINE. F9: OPEN A SCOPE RECORD")


class SidePanel(Enum):
    """Tables and values that the area next to the curves can show."""

    READINGS = "readings"
    CURVES = "curves"
    TRIGGER = "trigger"
    FILES = "files"


@dataclass(slots=True)
class ScopeModel:
    """Model of the scope page.

    ``live_samples`` is the ring buffer, or None if only files can be shown.
    """

    desk: Desk
    live_samples: LiveSamples | None
    recording_store: RecordingStore
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-scope"))
    file_worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-records"))
    time_window: TimeWindow = field(default_factory=TimeWindow)
    cursors: TimeCursors = field(default_factory=TimeCursors)
    trigger: Trigger = field(default_factory=Trigger)
    side_panel: SidePanel = SidePanel.READINGS
    selected_signal_keys: tuple[str, ...] = ()
    marked: int = 0  # index of the displayed curve on which keys act
    chart_width_px: int = 800
    picture: ScopePicture = field(default_factory=ScopePicture)
    signals: tuple[ScopeSignal, ...] = ()
    frozen_curves: RecordingCurves | None = None
    overlay_curves: RecordingCurves | None = None
    recording_name: str = ""  # name of the open file
    overlay_name: str = ""  # name of the overlaid file
    is_armed: bool = False
    _armed_at: float = -np.inf  # on the clock of the samples
    _ranges: dict[Quantity, ValueRange] = field(default_factory=dict)  # set by the user
    _released: float | None = None
    _drawn: object = None  # last request for a record
    _carried: LiveCurves | None = None
    # request, snapshot and time of the last live picture
    _asked: tuple[PictureRequest, Snapshot, float] | None = None

    def __post_init__(self) -> None:
        if self.live_samples is not None:
            self._carried = LiveCurves(self.live_samples)
            self.signals = list_signals(self.live_samples.channels)
            self.time_window.limits_s = (-self.live_samples.buffer_duration_s, 0.0)
        self.selected_signal_keys = find_default_signal_keys(self.signals)

    @property
    def is_live(self) -> bool:
        """Return whether the curves are live."""
        return self.frozen_curves is None

    @property
    def metric(self) -> bool:
        """Return whether lengths are displayed in mm."""
        return self.desk.settings_store.display_units.metric(self.desk.read_snapshot().modal.metric)

    @property
    def shown(self) -> tuple[ScopeSignal, ...]:
        """Return the displayed signals, in the same order as in the signal list."""
        return tuple(each for each in self.signals if each.key in self.selected_signal_keys)

    @property
    def selected_signal(self) -> ScopeSignal | None:
        """Return the signal to which the keys apply, or None if no signal is displayed."""
        shown = self.shown
        return shown[min(self.marked, len(shown) - 1)] if shown else None

    # --- every frame ---------------------------------------------------------------------------------

    def poll(self) -> None:
        """Store the finished picture, and request the next picture.

        This is called once a frame.
        """
        self.worker.deliver_results()
        self.file_worker.deliver_results()
        if self.worker.is_busy:
            return
        wanted = self._wanted()
        if self.frozen_curves is None:
            self._request_picture(wanted)
        elif (self.frozen_curves, self.overlay_curves, wanted) != self._drawn:
            self._drawn = (self.frozen_curves, self.overlay_curves, wanted)
            frozen, overlay = self.frozen_curves, self.overlay_curves
            self.worker.request_work(
                lambda _: frozen.make_picture(wanted, overlay), self._accept_picture, self.desk.say
            )

    def _wanted(self) -> PictureRequest:
        cursors = self.cursors.times_s if self.cursors.shown and self.frozen_curves is not None else None
        trigger = self.trigger if self.is_armed and self._released is None else Trigger()
        if self.frozen_curves is None:
            self.time_window.begin_s, self.time_window.end_s = -self.time_window.window_span_s, 0.0
        return PictureRequest(
            self.shown,
            self.time_window.begin_s,
            self.time_window.end_s,
            self.chart_width_px,
            self.metric,
            trigger,
            cursors,
            dict(self._ranges),
            self._armed_at,
        )

    def _request_picture(self, wanted: PictureRequest) -> None:
        """Request the next live picture, or freeze the curves when all samples after the trigger exist."""
        carried, live, overlay = self._carried, self.live_samples, self.overlay_curves
        if carried is None or live is None:
            return
        released = self._released
        if (
            released is not None
            and live.newest_time_s
            >= released + (1.0 - self.trigger.fraction_before_event) * wanted.window_span_s
        ):
            self._released = None
            self._freeze_window(released, wanted.window_span_s)
            return
        if not self._is_unchanged(wanted):
            self._asked = wanted, self.desk.read_snapshot(), self.desk.clock.read_seconds()
            taken = partial(self._accept_picture, of=(wanted.trigger, wanted.armed))
            self.worker.request_work(lambda _: carried.make_picture(wanted, overlay), taken, self.desk.say)

    def _is_unchanged(self, wanted: PictureRequest) -> bool:
        """Return whether the picture can be reused because all curves are constant.

        If the machine state does not change, the picture remains valid for a short time.
        """
        if self._asked is None or self.picture.constant_values is None or self.is_armed:
            return False
        asked, snapshot, at = self._asked
        recent = self.desk.clock.read_seconds() - at < CONSTANT_UPDATE_S
        return recent and asked == wanted and snapshot.equals_except_time(self.desk.read_snapshot())

    def _accept_picture(self, sight: ScopePicture, of: tuple[Trigger, float] | None = None) -> None:
        """Store a picture from the worker.

        ``of`` is the trigger with which the picture was requested. If the trigger has changed since then,
        the trigger time of the picture is ignored. A picture is not stored if it was requested before a
        change between live and frozen curves.
        """
        if sight.is_live is not self.is_live:
            return  # requested before the change between live and frozen
        self.picture = sight
        if self.is_armed and self._released is None and of == (self.trigger, self._armed_at):
            self._released = sight.trigger_time_s

    # --- live and frozen -----------------------------------------------------------------------------

    @property
    def has_samples(self) -> bool:
        """Return whether a frozen record exists, or samples that can be frozen."""
        live = self.live_samples is not None and bool(np.isfinite(self.live_samples.newest_time_s))
        return self.frozen_curves is not None or live

    def toggle_freeze(self) -> None:
        """Handle F2: freeze the curves, or return to live curves."""
        self.desk.clear_prompt_line()
        if self.frozen_curves is not None:
            self.return_to_live_curves()
        elif not self.has_samples:
            self.desk.say(NO_SAMPLES_MESSAGE)
        else:
            self._freeze_window(None, self.time_window.window_span_s)

    def return_to_live_curves(self) -> None:
        """Show live curves again, and rearm the trigger."""
        if self.live_samples is None:
            self.desk.say(NO_SAMPLES_MESSAGE)
            return
        span = self.time_window.window_span_s
        self.frozen_curves, self.recording_name, self._drawn, self._released = None, "", None, None
        self.cursors.active_index = -1
        self.time_window.limits_s = (-self.live_samples.buffer_duration_s, 0.0)
        self.time_window.end_s = 0.0
        self.time_window.begin_s = -min(span, self.live_samples.buffer_duration_s)
        self._arm_trigger()
        self._set_signals(list_signals(self.live_samples.channels))

    def _freeze_window(self, instant: float | None, span: float) -> None:
        """Freeze the samples around a given time, or the latest samples if no time is given.

        The worker copies the samples.
        """
        live = self.live_samples
        assert live is not None
        most = max(MIN_FROZEN_TIME_S, 3.0 * span)

        def copy_samples(_request: object) -> ScopeRecord:
            end = live.newest_time_s
            record = live.read_samples_between(end - most, end)
            if instant is None or not len(record.times_s):
                return record
            metadata = {**record.about, ZERO_INSTANT_KEY: f"{instant - float(record.times_s[0]):.6f}"}
            return replace(record, about=metadata)

        def show_frozen_record(record: ScopeRecord) -> None:
            before = 1.0 if instant is None else self.trigger.fraction_before_event
            self.is_armed = False
            self.show_recording(record, "", (-before * span, (1.0 - before) * span))

        self.worker.request_work(copy_samples, show_frozen_record, self.desk.say)

    def show_recording(
        self, record: ScopeRecord, recording_name: str, window: tuple[float, float] | None = None
    ) -> None:
        """Show a recorded period instead of live curves.

        ``window`` is in seconds relative to the zero time of the record. None shows the whole record.
        """
        if not len(record.times_s):
            self.desk.say(tr("THE RECORD CONTAINS NO SAMPLES FOR THIS TIME RANGE"))
            return
        zero = find_zero_time(record)
        self.frozen_curves, self.recording_name, self._drawn = (
            RecordingCurves(record, zero),
            recording_name,
            None,
        )
        self.is_armed, self._released = False, None
        self.cursors.active_index = -1
        self.time_window.limits_s = (float(record.times_s[0]) - zero, float(record.times_s[-1]) - zero)
        self.time_window.show_whole_record()
        if window is not None:
            self.time_window.begin_s, self.time_window.end_s = window
        self._set_signals(list_signals(record.channels))

    def _set_signals(self, signals: tuple[ScopeSignal, ...]) -> None:
        """Replace the available signals, and hide curves whose signal no longer exists."""
        self.signals = signals
        there = {each.key for each in signals}
        kept = tuple(each for each in self.selected_signal_keys if each in there)
        self.selected_signal_keys = kept or find_default_signal_keys(signals)
        self._ranges.clear()

    # --- curves --------------------------------------------------------------------------------------

    def toggle_curve(self, signal: ScopeSignal) -> None:
        """Show or hide the curve of a signal."""
        self.desk.clear_prompt_line()
        if signal.key in self.selected_signal_keys:
            self.selected_signal_keys = tuple(
                each for each in self.selected_signal_keys if each != signal.key
            )
            return
        logic = signal.quantity is Quantity.LOGIC_LEVEL
        alike = [each for each in self.shown if (each.quantity is Quantity.LOGIC_LEVEL) is logic]
        most = MAX_LOGIC_CURVES if logic else MAX_CURVES
        if len(alike) >= most:
            text = tr("{most} CURVES IS THE MAXIMUM. REMOVE A CURVE FIRST")
            self.desk.say(tr(Message(text, most=most)))
            return
        self.selected_signal_keys = (*self.selected_signal_keys, signal.key)

    def mark(self, index: int) -> None:
        """Select the curve to which the keys apply."""
        self.marked = max(0, min(index, len(self.shown) - 1))

    def zoom_lane(self, steps: int, quantity: Quantity | None = None) -> None:
        """Magnify the lane of the selected curve around its middle by a number of steps.

        Negative steps make the curve smaller.
        """
        self.magnify_lane(ZOOM_STEP**steps, quantity)

    def magnify_lane(self, factor: float, quantity: Quantity | None = None) -> None:
        """Magnify a lane by a factor."""
        self._change_range(quantity, lambda low, high: _about(low, high, 1.0 / factor))

    def shift_lane(self, steps: float, quantity: Quantity | None = None) -> None:
        """Move the range of a lane upward by a number of steps, each 10 % of the range."""

        def shift_range(low: float, high: float) -> ValueRange:
            by = PAN_STEP_FRACTION * steps * (high - low)
            return low + by, high + by

        self._change_range(quantity, shift_range)

    def _change_range(self, quantity: Quantity | None, change: Callable[[float, float], ValueRange]) -> None:
        marked = self.selected_signal
        quantity = quantity or (marked.quantity if marked is not None else None)
        if quantity is None or quantity is Quantity.LOGIC_LEVEL or quantity not in self.picture.lane_ranges:
            return
        now = self._ranges.get(quantity, self.picture.lane_ranges[quantity])
        self._ranges[quantity] = change(*now)

    def show_whole_record(self) -> None:
        """Show the whole record, with all lanes scaled to their curves."""
        self.desk.clear_prompt_line()
        self._ranges.clear()
        if self.frozen_curves is not None:
            self.time_window.show_whole_record()

    # --- the window ----------------------------------------------------------------------------------

    def zoom_window(self, steps: int, time_s: float | None = None) -> None:
        """Zoom in or out by a number of steps, around a time, the selected cursor or the middle."""
        if time_s is None and self.cursors.shown:
            time_s = self.cursors.times_s[self.cursors.active_index]
        self.time_window.zoom_window(steps, 0.0 if self.is_live else time_s)

    def magnify_window(self, factor: float, time_s: float) -> None:
        """Magnify the time window by the factor of a pinch gesture, around a time."""
        self.time_window.magnify(factor, 0.0 if self.is_live else time_s)

    def pan_window(self, shift_s: float) -> None:
        """Move the time window by a number of seconds.

        If the curves are live, freeze them instead.
        """
        if self.is_live:
            self.toggle_freeze()
            return
        self.time_window.pan_window(shift_s)

    def pan_window_by_steps(self, step_count: int) -> None:
        """Move the time window by a number of steps of 10 % of its width."""
        self.pan_window(step_count * PAN_STEP_FRACTION * self.time_window.window_span_s)

    # --- cursors -------------------------------------------------------------------------------------

    def toggle_cursors(self) -> None:
        """Handle F5: show or hide the two cursors on frozen curves."""
        self.desk.clear_prompt_line()
        if self.cursors.shown:
            self.cursors.active_index = -1
        elif self.is_live:
            self.desk.say(CURVES_ARE_LIVE_MESSAGE)
        else:
            self.cursors.place_in_window(self.time_window)

    def step_cursor(self, step_px: int) -> None:
        """Move the selected cursor by a number of pixels.

        The window then moves as far as necessary to show the cursor.
        """
        now = self.cursors.times_s[self.cursors.active_index]
        to = now + step_px * self.time_window.window_span_s / max(1, self.chart_width_px)
        self.cursors.move_cursor(max(self.time_window.limits_s[0], min(to, self.time_window.limits_s[1])))
        self.time_window.show_time(self.cursors.times_s[self.cursors.active_index])

    # --- trigger -------------------------------------------------------------------------------------

    def set_trigger(self, trigger: Trigger) -> None:
        """Set the trigger, and arm it while the curves are live."""
        self.trigger = trigger
        self._arm_trigger()

    def _arm_trigger(self) -> None:
        """Arm the trigger, starting at the newest sample.

        Earlier samples do not fire the trigger.
        """
        self.is_armed = self.trigger.trigger_event is not TriggerEvent.OFF and self.is_live
        self._armed_at = self.live_samples.newest_time_s if self.live_samples is not None else -np.inf
        self._released = None

    @property
    def trigger_state_text(self) -> str:
        """Return the state of the trigger as text."""
        if self.trigger.trigger_event is TriggerEvent.OFF:
            return ""
        if self._released is not None:
            return tr("TRIGGERED")
        return tr("ARMED") if self.is_armed else tr("TRIGGER NOT ARMED. F2: ARM")

    def close(self) -> None:
        """Finish pending writes, and stop the workers."""
        self.worker.close()
        self.file_worker.close()


def _about(low: float, high: float, factor: float) -> ValueRange:
    middle, half = 0.5 * (low + high), 0.5 * (high - low) * factor
    return middle - half, middle + half
