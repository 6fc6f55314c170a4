"""Server of the driver host, which handles messages and runs the drivers.

The server stops the machine if the control ends.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache, partial
from typing import TypeVar

import numpy as np

from core.faults import Trip, TrippedError
from core.message import Message as Text
from core.ports import DriverError, MachinePorts, StationState, Stop, at_rest
from drivers.driver_host.host_messages import (
    NOTHING,
    VERSION,
    Message,
    cam_of,
    number,
    segments,
    text,
    with_code,
)

_Part = TypeVar("_Part")
# Text and reason code for each missing optional part of the machine.
_NO_C = "the spindle drive of this machine is not used as the C axis", "no-c"
_UNORIENTED = "this machine's spindle driver cannot orient the spindle to an angle", "no-orientation"
_NO_TOUCH = "this driver cannot capture the axis position at a touch signal", "no-touch"
_NO_GEAR = "this driver cannot synchronize the axes with the spindle", "no-gear"

# --- Commands that change the machine, by name; and actions at a simulated station.


def act(ports: MachinePorts, head: Mapping[str, object]) -> None:
    """Execute one command. Raises DriverError if it is unknown or the drivers reject it."""
    on = head.get("on") is True
    acts: dict[str, Callable[[], None]] = {
        "enable": lambda: ports.axes.enable(on),
        "stop": lambda: ports.axes.stop(_how(text(head, "how"))),
        "home": lambda: ports.axes.home(text(head, "name")),
        "clear_fault": ports.axes.clear_fault,
        "run": lambda: ports.spindle.run(number(head, "rpm")),
        "coast": ports.spindle.coast,
        "hold": lambda: _demanded(ports.lock, *_NO_C).hold(on, head.get("orient") is True),
        "orient": lambda: _demanded(ports.orientation, *_UNORIENTED).orient(
            number(head, "angle"), int(number(head, "sense"))
        ),
        "release": lambda: _demanded(ports.orientation, *_UNORIENTED).release(),
        "write": lambda: ports.io.write(text(head, "name"), on),
        "safe": ports.io.safe,
        "arm": lambda: _demanded(ports.touch, *_NO_TOUCH).arm(),
    }
    order = acts.get(text(head, "what"))
    if order is None:
        raise DriverError(
            "the driver host does not recognize this command; check that the driver host "
            "and TurnDesk have the same version",
            reason="unknown-order",
        )
    order()


def use_hand(hands: object | None, head: Mapping[str, object]) -> object:
    """Call a method of the simulated station by its name. Raises DriverError if this is not possible."""
    name, values = text(head, "name"), head.get("values")
    use = None if name.startswith("_") or hands is None else getattr(hands, name, None)
    if not callable(use) or not isinstance(values, list):
        raise DriverError("this machine has no simulated operator station", reason="no-station")
    try:
        return use(*values)
    except TypeError as error:
        raise DriverError(
            "the simulated operator station does not support {name} with {values}",
            reason="wrong-values",
            name=name,
            values=values,
        ) from error


def _demanded(part: _Part | None, missing: str, reason: str) -> _Part:
    """Return an optional part of the machine. Raises DriverError if it is missing."""
    if part is None:
        raise DriverError(missing, reason=reason)
    return part


def _how(word: str) -> Stop:
    try:
        return Stop(word)
    except ValueError as error:
        raise DriverError(
            "the driver host does not recognize the stop command '{word}'", reason="unknown-stop", word=word
        ) from error


# --- Functions that the driver host has switched off, which stay off until the control acknowledges.


_MOVES = frozenset(("splice", "mesh"))


class TripGuard:
    """Guard that rejects requests of the control after a trip, until it is acknowledged."""

    def __init__(self) -> None:
        self.tripped: Trip | None = None
        self._count = 0
        self._turns = False  # The control has commanded the spindle to turn.

    def demand_allowed(self, message: Message) -> None:
        """Raise TrippedError for a motion, start or output while a trip is not acknowledged."""
        what = text(message.head, "what")
        turns = what == "orient" or (what == "run" and number(message.head, "rpm") != 0.0)
        switches = what == "write" and message.head.get("on") is True
        if self.tripped is not None and (
            text(message.head, "do") in _MOVES or what == "home" or turns or switches
        ):
            raise TrippedError(
                Text(
                    "the driver host received no messages for {seconds} s and stopped the machine",
                    seconds=f"{self.tripped.away:.2f}",
                )
            )
        if what in {"run", "coast", "orient", "release"}:
            self._turns = turns

    def trip(self, away: float, outputs: Sequence[str], *, spindle: bool) -> None:
        """Record that outputs and the spindle were switched off, unless nothing was on."""
        turned = self._turns and spindle
        self._turns = self._turns and not spindle
        if turned or outputs:
            self._tripped(away, turned, outputs)

    def fell(self, away: float, output: str) -> None:
        """Record that one output was switched off because it was not renewed."""
        self._tripped(away, False, [output])

    def back_after(self, away: float) -> None:
        """Update the duration of the silence when the control sends messages again."""
        if self.tripped is not None:
            self.tripped = self.tripped._replace(away=max(away, self.tripped.away))

    def acknowledge(self, count: float) -> None:
        """Clear the trip with this number, but not a later one."""
        if self.tripped is not None and self.tripped.number == count:
            self.tripped = None

    def _tripped(self, away: float, spindle: bool, outputs: Sequence[str]) -> None:
        self._count += 1
        before = self.tripped or Trip(0, 0.0, False, ())
        on = tuple(dict.fromkeys((*before.outputs, *outputs)))
        self.tripped = Trip(self._count, max(away, before.away), spindle or before.spindle, on)


PERIOD = 0.005  # Seconds between two cycles of the loop.
RESTS = 0.2  # Maximum seconds between two cycles while the control sleeps.
AWAY = 0.25  # Seconds without a cycle; modules set their error values after three heartbeats.
LATE = 0.05  # Seconds; the drives' queues buffer twice this time, and a splice of 6000 pieces takes 0.03 s.
SILENT = 0.2  # Seconds without a message after which the control counts as stalled.
ASLEEP = 0.5  # The same for a sleeping control, when nothing is on.
_NOTES = 50
_ROWS = 400  # Samples in one reply; a delayed control receives the rest with its next polls.
_STANDS = 5.0  # rpm
_STATION = tuple(field.name for field in fields(StationState))
_RUNS_DOWN = 8.0  # Maximum wait in s for a spindle to brake.


@dataclass(frozen=True, slots=True)
class Driven:
    """Set of drivers that one loop owns; ``tick`` is called every few milliseconds and raises no error.

    ``hands`` are the controls of a simulated machine or of the station on the screen. ``idle`` returns the
    seconds without a required cycle, for a sleeping control or not; 0 means unknown. ``asked`` returns
    whether the last cycle has sent requests whose replies the next one reads.
    """

    ports: MachinePorts
    tick: Callable[[], object]
    close: Callable[[], None]
    hands: object | None = None
    # Due time of the next tick; None: every few milliseconds.
    wake: Callable[[], float | None] = lambda: None
    notes: Callable[[], Sequence[str]] = tuple  # Messages of the drivers for the control.
    idle: Callable[[bool], float] = lambda _asleep: 0.0
    asked: Callable[[], bool] = lambda: False


class DriverHost:
    """Driver host that handles messages and runs the drivers, in one thread.

    If the control is silent, its queue is played to the end, which is at rest. Then the spindle stops and the
    outputs change to their safe states. This is a trip: nothing moves or switches on until the control has
    acknowledged it. ``orphaned`` means that the control has ended. The drives are then also switched off at
    rest, and the driver host is done when the spindle is at standstill.
    """

    def __init__(
        self,
        driven: Driven,
        warnings: Sequence[str] = (),
        refresh: Mapping[str, float] | None = None,
        ring: Callable[[], None] = lambda: None,
    ) -> None:
        """Create the driver host; ``ring`` wakes a control that sleeps.

        ``refresh``: outputs that are switched off after this number of seconds without a message.
        """
        self._ring = ring
        self.asleep = False  # The control has reported that it sleeps.
        self._slept = False  # The control slept at the last cycle.
        self._rung = False
        self._told: Callable[[], object] | None = None  # State of the last poll.
        self._driven = driven
        self._ports = driven.ports
        self._warnings = list(warnings)
        self._refresh = dict(refresh or {})
        self._heard = self._ports.clock.now()
        self._parted = False
        self._parted_at = 0.0
        self._latest = 0.0  # Maximum delay so far in s.
        self._answering = 0.0  # Duration of commands since the last cycle in s; some wait for a drive.
        self._notes: list[str] = []
        self._guard = TripGuard()
        self.orphaned = False
        self.done = False  # Orphaned, at rest and switched off.
        self._answers: Mapping[str, Callable[[Message], Message]] = {
            "hello": self._hello,
            "look": self._look,
            "splice": self._splice,
            "demand": self._demand,
            "horizon": lambda _: _value(self._ports.axes.horizon()),
            "mesh": self._mesh,
            "do": self._act,
            "hand": self._hand,
            "rest": lambda _: _value(0.0),
        }

    def handle(self, message: Message) -> Message:
        """Handle a message and return the reply; a rejection by the drivers is returned as ``error``."""
        self._hear()
        began = self._heard
        what = text(message.head, "do")
        self.asleep = what == "rest" or (what == "look" and message.head.get("rests") is True)
        answer = self._answers.get(what)
        if answer is None:
            return _refused(
                "the driver host does not recognize this request; check that the driver host "
                "and TurnDesk have the same version",
                "unknown-request",
            )
        try:
            self._guard.demand_allowed(message)
            return answer(message)
        except TrippedError as error:
            return Message({"tripped": str(error)}, NOTHING)
        except DriverError as error:
            return _refused(error.fault, error.reason)
        finally:
            self._heard = self._ports.clock.now()
            self._answering += self._heard - began

    def tick(self) -> None:
        """Run the drivers, then check whether the control still sends messages."""
        self._driven.tick()
        for note in self._driven.notes():
            self._note(note)
        silent = self._ports.clock.now() - self._heard
        self._let_fall(silent)
        if self.orphaned or silent > self._longest:
            self._without_control()
        if self.asleep and not (self._rung or self._driven.asked()) and self._has_news():
            self._rung = True
            self._ring()

    def _has_news(self) -> bool:
        """Return whether a poll would differ from the last one, apart from times."""
        try:
            return self._told is None or _timeless(self._state()) != self._told()
        except DriverError:
            return True

    @property
    def _longest(self) -> float:
        return ASLEEP if self.asleep else SILENT

    def next_round(self, last: float) -> float:
        """Return the due time of the next cycle, later if the control sleeps and the drivers are idle.

        ``last`` is the due time of the last cycle.
        """
        set_by_drivers = self._driven.wake()
        if set_by_drivers is not None:
            return set_by_drivers
        now, asleep = self._ports.clock.now(), self.asleep and not self.orphaned
        idle = self._driven.idle(asleep) if asleep or self._slept else 0.0
        self._slept = asleep
        if asleep and idle > 0.0:
            return now + min(idle, RESTS)
        return max(last + PERIOD, now)

    def late(self, seconds: float) -> None:
        """Note the wake-up delay of the loop; each new maximum is reported once."""
        slept, self._answering = seconds - self._answering, 0.0
        if slept > max(self._latest, LATE):
            self._latest = slept
            self._note(
                Text(
                    "the driver host woke up {late} ms late; check that it has real-time priority",
                    late=f"{1000 * slept:.0f}",
                )
            )
        if seconds > AWAY:
            self._trip(seconds, spindle=self._resting())

    def _resting(self) -> bool:
        axes = self._ports.axes
        return not axes.sample().moving and at_rest(axes.horizon(), axes.now())

    def _stands_in_thread(self) -> bool:
        """Return whether axes that follow the spindle wait for a stopped spindle, so the queue never ends."""
        gear = self._ports.gear
        follows = gear is not None and gear.geared() is not None
        return follows and not self._ports.axes.sample().moving and abs(self._ports.spindle.speed()) < _STANDS

    def _trip(self, away: float, *, spindle: bool = True) -> None:
        """Set the outputs to their safe states, stop the spindle, and record the functions that were on.

        The spindle is not stopped while a tool is in the cut, or while it is oriented. Modules that missed
        the heartbeat have already changed their outputs.
        """
        orientation = self._ports.orientation
        spindle = spindle and not (orientation is not None and orientation.oriented())
        before = dict(self._ports.io.outputs())
        self._carefully(self._ports.io.safe)
        if spindle:
            self._carefully(lambda: self._ports.spindle.run(0.0))
        after = self._ports.io.outputs()
        off = [name for name, on in before.items() if on and not after.get(name)]
        self._guard.trip(away, off, spindle=spindle)

    def _hear(self) -> None:
        now = self._ports.clock.now()
        if now - self._heard > self._longest:
            silent = f"{now - self._heard:.2f}"
            self._note(Text("no messages from TurnDesk for {seconds} s", seconds=silent))
            self._guard.back_after(now - self._heard)
        self._heard = now
        self._parted = False

    def _let_fall(self, silent: float) -> None:
        """Switch off outputs that are not renewed, without waiting for the axes to rest."""
        for name, longest in self._refresh.items():
            if silent > longest and self._ports.io.outputs().get(name):
                self._note(
                    Text(
                        "{output} was switched off: no messages from TurnDesk for {seconds} s",
                        output=name,
                        seconds=f"{silent:.2f}",
                    )
                )
                self._carefully(partial(self._ports.io.write, name, False))
                self._guard.fell(silent, name)

    def _without_control(self) -> None:
        """Stop the machine without a control, after the queue has ended at rest."""
        axes = self._ports.axes
        if not self._resting():
            if self._stands_in_thread():
                self._carefully(lambda: axes.stop(Stop.RAMP_HOLD))
            return
        if not self._parted:
            self._parted = True
            self._note(
                "no messages were received from TurnDesk; the spindle is stopped and the "
                "outputs are in their safe state"
            )
            self._trip(axes.now() - self._heard)
            self._parted_at = axes.now()
        if self.orphaned and not self.done:
            self._carefully(lambda: axes.stop(Stop.RAMP_OFF))
            # Closing removes the spindle's power, so a turning spindle would coast.
            waited = axes.now() - self._parted_at
            self.done = abs(self._ports.spindle.speed()) < _STANDS or waited > _RUNS_DOWN

    def _carefully(self, *steps: Callable[[], None]) -> None:
        for step in steps:
            try:
                step()
            except DriverError as error:
                self._note(Text("error while the driver host was stopping the machine: {error}", error=error))

    def _note(self, what: str) -> None:
        self._notes = [*self._notes[-_NOTES:], what]

    # --- replies ------------------------------------------------------------------------------------------

    def _hello(self, _message: Message) -> Message:
        axes = self._ports.axes
        head = {
            "version": VERSION,
            "axes": axes.axes,
            "commit": axes.commit,
            "gear": self._ports.gear is not None,
            "lock": self._ports.lock is not None,
            "orientation": self._ports.orientation is not None,
            "touch": self._ports.touch is not None,
            "samples": self._ports.samples.rate if self._ports.samples is not None else 0.0,
            "untraced": self._ports.untraced,
            "warnings": [*self._warnings, *self._ports.warnings],
        }
        return Message(head, NOTHING)

    def _state(self) -> dict[str, object]:
        """Return the complete observable state. Raises DriverError."""
        ports, sample = self._ports, self._ports.axes.sample()
        station = ports.station.snapshot()
        return {
            "sample": {**sample._asdict(), **with_code("fault", sample.fault, "axis")},
            "speed": ports.spindle.speed(),
            "spindle_lag": ports.spindle_lag(),
            "angle": ports.spindle.angle(),
            **with_code("spindle", ports.spindle.fault(), "spindle"),
            "inputs": dict(ports.io.inputs()),
            "outputs": dict(ports.io.outputs()),
            "station": {name: getattr(station, name) for name in _STATION},
            "geared": ports.gear.geared() if ports.gear is not None else None,
            "held": ports.lock is not None and ports.lock.held(),
            "oriented": ports.orientation is not None and ports.orientation.oriented(),
            "trip": self._guard.tripped,
            "latch": ports.touch.latched() if ports.touch is not None else None,
            "notes": self._notes,
            "unknown": sorted(ports.unknown()),
        }

    def _look(self, _message: Message) -> Message:
        state = self._state()
        self._notes, self._rung = [], False
        self._told = cache(partial(_timeless, {**state, "notes": []}))
        source = self._ports.samples
        sampled = source.take(_ROWS).ravel() if source is not None else NOTHING
        return Message(state, sampled)

    def _splice(self, message: Message) -> Message:
        self._driven.tick()  # A long splice takes time, so the drives' queues are filled first.
        self._ports.axes.splice(segments(message.numbers, len(self._ports.axes.axes)))
        return _value(0.0)

    def _demand(self, message: Message) -> Message:
        p, v = self._ports.axes.demand_at(number(message.head, "t"))
        return Message({}, np.array([*p, *v]))

    def _mesh(self, message: Message) -> Message:
        gear = _demanded(self._ports.gear, *_NO_GEAR)
        gear.mesh(cam_of(message, len(self._ports.axes.axes)))
        return _value(0.0)

    def _act(self, message: Message) -> Message:
        if text(message.head, "what") == "acknowledge":
            self._guard.acknowledge(number(message.head, "number"))
        else:
            act(self._ports, message.head)
        return _value(0.0)

    def _hand(self, message: Message) -> Message:
        return Message({"value": use_hand(self._driven.hands, message.head)}, NOTHING)


def _timeless(state: Mapping[str, object]) -> Mapping[str, object]:
    """Return a polled state without times; the age of the station is reduced to whether it is silent."""
    sample, angle, station = state.get("sample"), state.get("angle"), state.get("station")
    assert isinstance(sample, dict)
    assert isinstance(station, dict)
    return {
        **state,
        "sample": {**sample, "t": 0.0},
        "angle": angle[1:] if isinstance(angle, tuple) else None,
        "station": {**station, "age": station["age"] > SILENT},
    }


def _value(value: float) -> Message:
    return Message({"value": value}, NOTHING)


def _refused(why: str, reason: str = "") -> Message:
    return Message({**with_code("error", why, "driver"), "reason": reason}, NOTHING)
