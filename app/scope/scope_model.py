"""The scope: what it shows of the machine, live or frozen, its trigger and cursors, a record laid over.

Nothing is computed on the screen's thread: ``look`` asks a worker for the next picture, takes the last.
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

MOST_SHOWN = 8  # curves; inputs and outputs come beside them
MOST_LOGIC = 12
FROZEN = 60.0  # s that are taken when the curves are frozen, or three windows
LEVEL_FOR = 1.0  # s after which level lines are looked at again where nothing seems to have happened
ZOOM = 1.5  # a step of a lane's range
FORGOTTEN = tr("CURVES ARE LIVE. F2: FREEZE THEM FIRST")
NO_SAMPLES = tr("NO SCOPE DATA ON THIS MACHINE. F9: OPEN A SCOPE RECORD")


class Side(Enum):
    """What stands beside the curves."""

    READINGS = "readings"
    CURVES = "curves"
    TRIGGER = "trigger"
    FILES = "files"


@dataclass(slots=True)
class Scope:
    """``live`` is the ring of the last minutes; None: only files can be looked at."""

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
    marked: int = 0  # which of the curves shown is the one that keys act on
    pixels: int = 800
    sight: Sight = field(default_factory=Sight)
    signals: tuple[Signal, ...] = ()
    frozen: RecordCurves | None = None
    overlay: RecordCurves | None = None
    name: str = ""  # of the file that is open
    over_name: str = ""  # of the one that is laid over
    armed: bool = False
    _armed_at: float = -np.inf  # of the samples' clock
    _ranges: dict[Quantity, Range] = field(default_factory=dict)  # chosen by hand
    _released: float | None = None
    _drawn: object = None  # what was last asked for of a record
    _carried: LiveCurves | None = None
    _asked: tuple[Wanted, Snapshot, float] | None = None  # for the last live picture, and when

    def __post_init__(self) -> None:
        if self.live is not None:
            self._carried = LiveCurves(self.live)
            self.signals = signals_of(self.live.channels)
            self.window.most = (-self.live.lasts, 0.0)
        self.chosen = first_chosen(self.signals)

    @property
    def is_live(self) -> bool:
        """Whether the curves roll."""
        return self.frozen is None

    @property
    def metric(self) -> bool:
        """Whether lengths are shown in mm, as everywhere on the desk."""
        return self.desk.settings.units.metric(self.desk.snapshot().modal.metric)

    @property
    def shown(self) -> tuple[Signal, ...]:
        """The signals that are shown, in the order of the list."""
        return tuple(each for each in self.signals if each.key in self.chosen)

    @property
    def marked_signal(self) -> Signal | None:
        """The curve that keys act on."""
        shown = self.shown
        return shown[min(self.marked, len(shown) - 1)] if shown else None

    # --- every frame ---------------------------------------------------------------------------------

    def look(self) -> None:
        """Take the picture that has come, and ask for the next; called once a frame."""
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
        """The next live picture, or, once a trigger's window is full, the frozen one."""
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
        """Level lines of a machine that tells what it told when they were asked for, not long ago."""
        if self._asked is None or self.sight.level is None or self.armed:
            return False
        asked, snapshot, at = self._asked
        recent = self.desk.clock.seconds() - at < LEVEL_FOR
        return recent and asked == wanted and snapshot.tells_as(self.desk.snapshot())

    def _take(self, sight: Sight, of: tuple[Trigger, float] | None = None) -> None:
        """``of``: the trigger looked for, and when it was armed; set anew meanwhile, it releases nothing."""
        if sight.live is not self.is_live:
            return  # it was asked for before
        self.sight = sight
        if self.armed and self._released is None and of == (self.trigger, self._armed_at):
            self._released = sight.released

    # --- live and frozen -----------------------------------------------------------------------------

    @property
    def has_samples(self) -> bool:
        """Whether there is something to freeze, or something frozen."""
        live = self.live is not None and bool(np.isfinite(self.live.last))
        return self.frozen is not None or live

    def freeze_key(self) -> None:
        """F2: freeze what is seen, or let the curves roll again."""
        self.desk.clear()
        if self.frozen is not None:
            self.go_live()
        elif not self.has_samples:
            self.desk.say(NO_SAMPLES)
        else:
            self._freeze_at(None, self.window.span)

    def go_live(self) -> None:
        """The curves roll; an armed trigger waits again."""
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
        """Take what was sampled about an instant, or the last samples; the worker copies it."""
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
        """Look at a record from now on; ``window`` in seconds of its instant 0, else all of it."""
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
        """Of another machine there may be others; what is not there is not shown."""
        self.signals = signals
        there = {each.key for each in signals}
        kept = tuple(each for each in self.chosen if each in there)
        self.chosen = kept or first_chosen(signals)
        self._ranges.clear()

    # --- curves --------------------------------------------------------------------------------------

    def toggle(self, signal: Signal) -> None:
        """Show a curve, or no longer."""
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
        """Keys act on this curve."""
        self.marked = max(0, min(number, len(self.shown) - 1))

    def stretch(self, steps: int, quantity: Quantity | None = None) -> None:
        """The lane of the marked curve nearer (positive) or farther, about its middle."""
        self.stretch_by(ZOOM**steps, quantity)

    def stretch_by(self, factor: float, quantity: Quantity | None = None) -> None:
        """The lane nearer by a factor."""
        self._change_range(quantity, lambda low, high: _about(low, high, 1.0 / factor))

    def shift(self, steps: float, quantity: Quantity | None = None) -> None:
        """The lane's window up by so many tenths."""

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
        """All of a record, and every lane by its curves."""
        self.desk.clear()
        self._ranges.clear()
        if self.frozen is not None:
            self.window.whole()

    # --- the window ----------------------------------------------------------------------------------

    def zoom(self, steps: int, at: float | None = None) -> None:
        """Nearer or farther by steps, about an instant, the moved cursor or the middle."""
        if at is None and self.cursors.shown:
            at = self.cursors.times[self.cursors.at]
        self.window.zoom(steps, 0.0 if self.is_live else at)

    def magnify(self, factor: float, at: float) -> None:
        """As two fingers spread."""
        self.window.magnify(factor, 0.0 if self.is_live else at)

    def pan(self, by: float) -> None:
        """So many seconds later; curves that roll are frozen first."""
        if self.is_live:
            self.freeze_key()
            return
        self.window.pan(by)

    def pan_steps(self, steps: int) -> None:
        """By tenths of the window."""
        self.pan(steps * PAN * self.window.span)

    # --- cursors -------------------------------------------------------------------------------------

    def cursors_key(self) -> None:
        """F5: two cursors, or none again. They stand on frozen curves."""
        self.desk.clear()
        if self.cursors.shown:
            self.cursors.at = -1
        elif self.is_live:
            self.desk.say(FORGOTTEN)
        else:
            self.cursors.put_into(self.window)

    def step_cursor(self, pixels: int) -> None:
        """The moved cursor by so many pixels; the window goes along."""
        now = self.cursors.times[self.cursors.at]
        to = now + pixels * self.window.span / max(1, self.pixels)
        self.cursors.move(max(self.window.most[0], min(to, self.window.most[1])))
        self.window.show(self.cursors.times[self.cursors.at])

    # --- trigger -------------------------------------------------------------------------------------

    def set_trigger(self, trigger: Trigger) -> None:
        """Another trigger; it is armed as long as it is one and the curves roll."""
        self.trigger = trigger
        self._arm()

    def _arm(self) -> None:
        """From this sample on: what was sampled before, or while the curves stood, releases nothing."""
        self.armed = self.trigger.when is not When.OFF and self.is_live
        self._armed_at = self.live.last if self.live is not None else -np.inf
        self._released = None

    @property
    def trigger_words(self) -> str:
        """How it stands with the trigger."""
        if self.trigger.when is When.OFF:
            return ""
        if self._released is not None:
            return tr("TRIGGERED")
        return tr("ARMED") if self.armed else tr("TRIGGER NOT ARMED. F2: ARM")

    # --- files ---------------------------------------------------------------------------------------

    def what_is_seen(self) -> Record | None:
        """The record between the edges of the window; None, and said, while the curves are live."""
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
        """What is seen, as a record that can be opened again."""
        record = self.what_is_seen()
        if record is not None:
            self.filing.queue(lambda: self.shelf.keep(record), self._written, self.desk.refuse)

    def write_csv(self) -> None:
        """What is seen, as a table."""
        record = self.what_is_seen()
        if record is not None:
            self.filing.queue(lambda: self.shelf.write_csv(record), self._written, self.desk.refuse)

    def _written(self, path: object) -> None:
        self.desk.say(tr(Message("SAVED: {path}", path=path)))
        self.list_files()

    def list_files(self) -> None:
        """Look what is there."""
        self.filing.queue(self.shelf.look, self._listed, self.desk.refuse)

    def _listed(self, files: tuple[Kept, ...]) -> None:
        self.shelf.files = files

    def open_alarm(self, name: str) -> None:
        """The seconds before an alarm; it may still be being written."""
        recorder = self.desk.control.recordings
        folder, shelf = self.shelf.folder, self.shelf
        self.side = Side.READINGS

        def work() -> Record:
            return recorder.alarm_record(name) if recorder is not None else shelf.open(folder / name)

        def done(record: Record) -> None:
            self.show_record(record, name)

        self.filing.queue(work, done, self.desk.refuse)

    def open(self, kept: Kept) -> None:
        """Look at a record of the disk."""
        path, shelf = kept.path, self.shelf

        def done(record: Record) -> None:
            self.side = Side.READINGS
            self.show_record(record, path.name)

        self.filing.queue(lambda: shelf.open(path), done, self.desk.refuse)

    def lay_over(self, kept: Kept) -> None:
        """An earlier record over this one, their instants 0 upon each other; the same again takes it away."""
        self.desk.clear()
        if self.over_name == kept.path.name:
            self.overlay, self.over_name = None, ""
            return
        path, shelf = kept.path, self.shelf

        def done(record: Record) -> None:
            self.overlay, self.over_name = RecordCurves(record, instant_of(record)), path.name

        self.filing.queue(lambda: shelf.open(path), done, self.desk.refuse)

    def delete(self, kept: Kept) -> None:
        """Take a file away, after asking."""
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
        """A picture of the page, made into a file by a worker: ``png`` gives its bytes there."""
        shelf = self.shelf
        self.filing.queue(lambda: shelf.write_picture(png()), self._written, self.desk.refuse)

    def close(self) -> None:
        """End the workers; what is being written is written."""
        self.worker.close()
        self.filing.close()


def _about(low: float, high: float, factor: float) -> Range:
    middle, half = 0.5 * (low + high), 0.5 * (high - low) * factor
    return middle - half, middle + half
