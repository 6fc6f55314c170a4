"""Model of the scope: live or frozen curves, trigger, cursors and an overlaid record.

All curves are calculated on a worker. ``look`` requests the next picture and stores the last one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import partial

import numpy as np

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.translation import tr
from app.scope.record_shelf import INSTANT, Kept, RecordShelf, instant_of
from app.scope.scope_curves import LiveCurves, LiveSamples, Range, RecordCurves, Sight, Wanted
from app.scope.signals import Quantity, Signal, first_chosen, signals_of
from app.scope.time_window import PAN, Cursors, Trigger, When, Window
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.message import Message
from core.records.record import Record

MOST_SHOWN = 8  # curves; inputs and outputs are counted separately
MOST_LOGIC = 12
FROZEN = 60.0  # minimum seconds that are frozen; otherwise three windows
LEVEL_FOR = 1.0  # seconds after which constant curves are updated even without a change
ZOOM = 1.5  # factor of one step of a lane's range
FORGOTTEN = tr("CURVES ARE LIVE. F2: FREEZE THEM FIRST")
NO_SAMPLES = tr("NO SCOPE DATA ON THIS MACHINE. F9: OPEN A SCOPE RECORD")


class Side(Enum):
    """Content of the area next to the curves."""

    READINGS = "readings"
    CURVES = "curves"
    TRIGGER = "trigger"
    FILES = "files"


@dataclass(slots=True)
class Scope:
    """Model of the scope page.

    ``live`` is the ring buffer, or None if only files can be shown.
    """

    desk: Desk
    live: LiveSamples | None
    shelf: RecordShelf
    worker: Latest = field(default_factory=lambda: Latest("editing-scope"))
    filing: Latest = field(default_factory=lambda: Latest("editing-records"))
    window: Window = field(default_factory=Window)
    cursors: Cursors = field(default_factory=Cursors)
    trigger: Trigger = field(default_factory=Trigger)
    side: Side = Side.READINGS
    chosen: tuple[str, ...] = ()
    marked: int = 0  # index of the displayed curve on which keys act
    pixels: int = 800
    sight: Sight = field(default_factory=Sight)
    signals: tuple[Signal, ...] = ()
    frozen: RecordCurves | None = None
    overlay: RecordCurves | None = None
    name: str = ""  # name of the open file
    over_name: str = ""  # name of the overlaid file
    armed: bool = False
    _armed_at: float = -np.inf  # on the clock of the samples
    _ranges: dict[Quantity, Range] = field(default_factory=dict)  # set by the user
    _released: float | None = None
    _drawn: object = None  # last request for a record
    _carried: LiveCurves | None = None
    # request, snapshot and time of the last live picture
    _asked: tuple[Wanted, Snapshot, float] | None = None

    def __post_init__(self) -> None:
        if self.live is not None:
            self._carried = LiveCurves(self.live)
            self.signals = signals_of(self.live.channels)
            self.window.most = (-self.live.lasts, 0.0)
        self.chosen = first_chosen(self.signals)

    @property
    def is_live(self) -> bool:
        """Whether the curves are live."""
        return self.frozen is None

    @property
    def metric(self) -> bool:
        """Whether lengths are displayed in mm."""
        return self.desk.settings.units.metric(self.desk.snapshot().modal.metric)

    @property
    def shown(self) -> tuple[Signal, ...]:
        """Displayed signals in the order of the list."""
        return tuple(each for each in self.signals if each.key in self.chosen)

    @property
    def marked_signal(self) -> Signal | None:
        """Signal on which keys act, or None."""
        shown = self.shown
        return shown[min(self.marked, len(shown) - 1)] if shown else None

    # --- every frame ---------------------------------------------------------------------------------

    def look(self) -> None:
        """Store the finished picture and request the next one; called once per frame."""
        self.worker.poll()
        self.filing.poll()
        if self.worker.busy:
            return
        wanted = self._wanted()
        if self.frozen is None:
            self._follow(wanted)
        elif (self.frozen, self.overlay, wanted) != self._drawn:
            self._drawn = (self.frozen, self.overlay, wanted)
            frozen, overlay = self.frozen, self.overlay
            self.worker.ask(lambda _: frozen.sight(wanted, overlay), self._take, self.desk.say)

    def _wanted(self) -> Wanted:
        cursors = self.cursors.times if self.cursors.shown and self.frozen is not None else None
        trigger = self.trigger if self.armed and self._released is None else Trigger()
        if self.frozen is None:
            self.window.begin, self.window.end = -self.window.span, 0.0
        return Wanted(
            self.shown,
            self.window.begin,
            self.window.end,
            self.pixels,
            self.metric,
            trigger,
            cursors,
            dict(self._ranges),
            self._armed_at,
        )

    def _follow(self, wanted: Wanted) -> None:
        """Request the next live picture, or freeze the curves once the trigger's window is full."""
        carried, live, overlay = self._carried, self.live, self.overlay
        if carried is None or live is None:
            return
        released = self._released
        if released is not None and live.last >= released + (1.0 - self.trigger.before) * wanted.span:
            self._released = None
            self._freeze_at(released, wanted.span)
            return
        if not self._stays(wanted):
            self._asked = wanted, self.desk.snapshot(), self.desk.clock.seconds()
            taken = partial(self._take, of=(wanted.trigger, wanted.armed))
            self.worker.ask(lambda _: carried.sight(wanted, overlay), taken, self.desk.say)

    def _stays(self, wanted: Wanted) -> bool:
        """Return whether the picture of constant curves is still valid.

        The picture is valid for a short time while the machine state is unchanged.
        """
        if self._asked is None or self.sight.level is None or self.armed:
            return False
        asked, snapshot, at = self._asked
        recent = self.desk.clock.seconds() - at < LEVEL_FOR
        return recent and asked == wanted and snapshot.tells_as(self.desk.snapshot())

    def _take(self, sight: Sight, of: tuple[Trigger, float] | None = None) -> None:
        """Store a picture.

        ``of`` is the trigger of the request, ignored if the trigger has changed since.
        """
        if sight.live is not self.is_live:
            return  # requested before the change between live and frozen
        self.sight = sight
        if self.armed and self._released is None and of == (self.trigger, self._armed_at):
            self._released = sight.released

    # --- live and frozen -----------------------------------------------------------------------------

    @property
    def has_samples(self) -> bool:
        """Whether there are samples to freeze or a frozen record."""
        live = self.live is not None and bool(np.isfinite(self.live.last))
        return self.frozen is not None or live

    def freeze_key(self) -> None:
        """Freeze the curves, or return to live curves (F2)."""
        self.desk.clear()
        if self.frozen is not None:
            self.go_live()
        elif not self.has_samples:
            self.desk.say(NO_SAMPLES)
        else:
            self._freeze_at(None, self.window.span)

    def go_live(self) -> None:
        """Return to live curves and rearm the trigger."""
        if self.live is None:
            self.desk.say(NO_SAMPLES)
            return
        span = self.window.span
        self.frozen, self.name, self._drawn, self._released = None, "", None, None
        self.cursors.at = -1
        self.window.most = (-self.live.lasts, 0.0)
        self.window.end = 0.0
        self.window.begin = -min(span, self.live.lasts)
        self._arm()
        self._other_signals(signals_of(self.live.channels))

    def _freeze_at(self, instant: float | None, span: float) -> None:
        """Freeze the samples around an instant, or the last samples, copied by the worker."""
        live = self.live
        assert live is not None
        most = max(FROZEN, 3.0 * span)

        def take(_request: object) -> Record:
            end = live.last
            record = live.between(end - most, end)
            if instant is None or not len(record.times):
                return record
            told = {**record.about, INSTANT: f"{instant - float(record.times[0]):.6f}"}
            return replace(record, about=told)

        def done(record: Record) -> None:
            before = 1.0 if instant is None else self.trigger.before
            self.armed = False
            self.show_record(record, "", (-before * span, (1.0 - before) * span))

        self.worker.ask(take, done, self.desk.say)

    def show_record(self, record: Record, name: str, window: tuple[float, float] | None = None) -> None:
        """Show a record.

        ``window`` is in seconds relative to its instant 0, and None shows everything.
        """
        if not len(record.times):
            self.desk.say(tr("THE RECORD CONTAINS NO SAMPLES FOR THIS TIME RANGE"))
            return
        zero = instant_of(record)
        self.frozen, self.name, self._drawn = RecordCurves(record, zero), name, None
        self.armed, self._released = False, None
        self.cursors.at = -1
        self.window.most = (float(record.times[0]) - zero, float(record.times[-1]) - zero)
        self.window.whole()
        if window is not None:
            self.window.begin, self.window.end = window
        self._other_signals(signals_of(record.channels))

    def _other_signals(self, signals: tuple[Signal, ...]) -> None:
        """Replace the available signals and remove displayed signals that no longer exist."""
        self.signals = signals
        there = {each.key for each in signals}
        kept = tuple(each for each in self.chosen if each in there)
        self.chosen = kept or first_chosen(signals)
        self._ranges.clear()

    # --- curves --------------------------------------------------------------------------------------

    def toggle(self, signal: Signal) -> None:
        """Show or hide a curve."""
        self.desk.clear()
        if signal.key in self.chosen:
            self.chosen = tuple(each for each in self.chosen if each != signal.key)
            return
        logic = signal.quantity is Quantity.LOGIC
        alike = [each for each in self.shown if (each.quantity is Quantity.LOGIC) is logic]
        most = MOST_LOGIC if logic else MOST_SHOWN
        if len(alike) >= most:
            text = tr("{most} CURVES IS THE MAXIMUM. REMOVE A CURVE FIRST")
            self.desk.say(tr(Message(text, most=most)))
            return
        self.chosen = (*self.chosen, signal.key)

    def mark(self, number: int) -> None:
        """Select the curve on which keys act."""
        self.marked = max(0, min(number, len(self.shown) - 1))

    def stretch(self, steps: int, quantity: Quantity | None = None) -> None:
        """Magnify the lane of the selected curve around its middle. Negative steps reduce it."""
        self.stretch_by(ZOOM**steps, quantity)

    def stretch_by(self, factor: float, quantity: Quantity | None = None) -> None:
        """Magnify a lane by a factor."""
        self._change_range(quantity, lambda low, high: _about(low, high, 1.0 / factor))

    def shift(self, steps: float, quantity: Quantity | None = None) -> None:
        """Move the range of a lane up by steps of 10 %."""

        def change(low: float, high: float) -> Range:
            by = PAN * steps * (high - low)
            return low + by, high + by

        self._change_range(quantity, change)

    def _change_range(self, quantity: Quantity | None, change: Callable[[float, float], Range]) -> None:
        marked = self.marked_signal
        quantity = quantity or (marked.quantity if marked is not None else None)
        if quantity is None or quantity is Quantity.LOGIC or quantity not in self.sight.ranges:
            return
        now = self._ranges.get(quantity, self.sight.ranges[quantity])
        self._ranges[quantity] = change(*now)

    def fit(self) -> None:
        """Show the whole record, with all lanes scaled to their curves."""
        self.desk.clear()
        self._ranges.clear()
        if self.frozen is not None:
            self.window.whole()

    # --- the window ----------------------------------------------------------------------------------

    def zoom(self, steps: int, at: float | None = None) -> None:
        """Zoom in or out by steps, around a time, the selected cursor or the middle."""
        if at is None and self.cursors.shown:
            at = self.cursors.times[self.cursors.at]
        self.window.zoom(steps, 0.0 if self.is_live else at)

    def magnify(self, factor: float, at: float) -> None:
        """Magnify by the factor of a pinch gesture."""
        self.window.magnify(factor, 0.0 if self.is_live else at)

    def pan(self, by: float) -> None:
        """Move the window by a number of seconds. Live curves are frozen first."""
        if self.is_live:
            self.freeze_key()
            return
        self.window.pan(by)

    def pan_steps(self, steps: int) -> None:
        """Move the window by steps of 10 %."""
        self.pan(steps * PAN * self.window.span)

    # --- cursors -------------------------------------------------------------------------------------

    def cursors_key(self) -> None:
        """Show or hide the two cursors on frozen curves (F5)."""
        self.desk.clear()
        if self.cursors.shown:
            self.cursors.at = -1
        elif self.is_live:
            self.desk.say(FORGOTTEN)
        else:
            self.cursors.put_into(self.window)

    def step_cursor(self, pixels: int) -> None:
        """Move the selected cursor by pixels. The window follows."""
        now = self.cursors.times[self.cursors.at]
        to = now + pixels * self.window.span / max(1, self.pixels)
        self.cursors.move(max(self.window.most[0], min(to, self.window.most[1])))
        self.window.show(self.cursors.times[self.cursors.at])

    # --- trigger -------------------------------------------------------------------------------------

    def set_trigger(self, trigger: Trigger) -> None:
        """Set the trigger, and arm it while the curves are live."""
        self.trigger = trigger
        self._arm()

    def _arm(self) -> None:
        """Arm the trigger from the newest sample on. Earlier samples do not fire it."""
        self.armed = self.trigger.when is not When.OFF and self.is_live
        self._armed_at = self.live.last if self.live is not None else -np.inf
        self._released = None

    @property
    def trigger_words(self) -> str:
        """State of the trigger as text."""
        if self.trigger.when is When.OFF:
            return ""
        if self._released is not None:
            return tr("TRIGGERED")
        return tr("ARMED") if self.armed else tr("TRIGGER NOT ARMED. F2: ARM")

    # --- files ---------------------------------------------------------------------------------------

    def what_is_seen(self) -> Record | None:
        """Return the record of the visible window, or None with a message while the curves are live."""
        frozen = self.frozen
        if frozen is None:
            self.desk.say(FORGOTTEN)
            return None
        begin, end = frozen.zero + self.window.begin, frozen.zero + self.window.end
        cut = frozen.record.between(begin, end)
        if not len(cut.times):
            self.desk.say(tr("THE RECORD CONTAINS NO SAMPLES FOR THIS TIME RANGE"))
            return None
        told = {**cut.about, INSTANT: f"{frozen.zero - float(cut.times[0]):.6f}"}
        return replace(cut, about=told)

    def save(self) -> None:
        """Save the visible window as a record."""
        record = self.what_is_seen()
        if record is not None:
            self.filing.queue(lambda: self.shelf.keep(record), self._written, self.desk.refuse)

    def write_csv(self) -> None:
        """Write the visible window as a CSV table."""
        record = self.what_is_seen()
        if record is not None:
            self.filing.queue(lambda: self.shelf.write_csv(record), self._written, self.desk.refuse)

    def _written(self, path: object) -> None:
        self.desk.say(tr(Message("SAVED: {path}", path=path)))
        self.list_files()

    def list_files(self) -> None:
        """Update the list of files."""
        self.filing.queue(self.shelf.look, self._listed, self.desk.refuse)

    def _listed(self, files: tuple[Kept, ...]) -> None:
        self.shelf.files = files

    def open_alarm(self, name: str) -> None:
        """Open the record of an alarm, which may still be in the process of writing."""
        recorder = self.desk.control.recordings
        folder, shelf = self.shelf.folder, self.shelf
        self.side = Side.READINGS

        def work() -> Record:
            return recorder.alarm_record(name) if recorder is not None else shelf.open(folder / name)

        def done(record: Record) -> None:
            self.show_record(record, name)

        self.filing.queue(work, done, self.desk.refuse)

    def open(self, kept: Kept) -> None:
        """Open a record from the disk."""
        path, shelf = kept.path, self.shelf

        def done(record: Record) -> None:
            self.side = Side.READINGS
            self.show_record(record, path.name)

        self.filing.queue(lambda: shelf.open(path), done, self.desk.refuse)

    def lay_over(self, kept: Kept) -> None:
        """Overlay an earlier record, aligned at instant 0.

        The same record again removes the overlay.
        """
        self.desk.clear()
        if self.over_name == kept.path.name:
            self.overlay, self.over_name = None, ""
            return
        path, shelf = kept.path, self.shelf

        def done(record: Record) -> None:
            self.overlay, self.over_name = RecordCurves(record, instant_of(record)), path.name

        self.filing.queue(lambda: shelf.open(path), done, self.desk.refuse)

    def delete(self, kept: Kept) -> None:
        """Delete a record file after confirmation."""
        if self.desk.refused(Act.RECORDS):
            return

        def gone(_nothing: object) -> None:
            self.desk.access.persistence.note_change(Message("record {path} deleted", path=kept.path.name))
            self.desk.say(tr(Message("DELETED: {path}", path=kept.path.name)))
            self.list_files()

        def yes() -> None:
            self.filing.queue(lambda: self.shelf.delete(kept.path), gone, self.desk.refuse)

        question = tr(Message("PRESS Y TO DELETE {path}, N TO KEEP IT", path=kept.path.name))
        self.desk.ask(question, yes)

    def write_picture(self, png: Callable[[], bytes]) -> None:
        """Save a picture of the page on a worker. ``png`` returns its bytes."""
        shelf = self.shelf
        self.filing.queue(lambda: shelf.write_picture(png()), self._written, self.desk.refuse)

    def close(self) -> None:
        """Stop the workers after pending writes are finished."""
        self.worker.close()
        self.filing.close()


def _about(low: float, high: float, factor: float) -> Range:
    middle, half = 0.5 * (low + high), 0.5 * (high - low) * factor
    return middle - half, middle + half
