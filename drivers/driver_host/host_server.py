"""The driver host: answers the control, runs the drivers, stops the machine if the control ends."""

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
# Why an optional part of the machine is missing, and the reason.
_NO_C = "the spindle drive of this machine is not used as the C axis", "no-c"
_UNORIENTED = "this machine's spindle driver cannot orient the spindle to an angle", "no-orientation"
_NO_TOUCH = "this driver cannot capture the axis position at a touch signal", "no-touch"
_NO_GEAR = "this driver cannot synchronize the axes with the spindle", "no-gear"

# --- Orders that change the machine, by the words of a request; and the hands at a simulated station.


def act(ports: MachinePorts, head: Mapping[str, object]) -> None:
    """Carry one order out. Raises DriverError for one that is not known, or that the drivers refuse."""
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
    """A hand at the simulated station, by the name of its method. Raises DriverError."""
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
    """Return an optional part of the machine. Raises DriverError with why it is ``missing``."""
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


# --- What the driver host has switched off by itself, and that nothing goes on before the control knows it.


_MOVES = frozenset(("splice", "mesh"))


class TripGuard:
    """Between the requests of the control and the drivers."""

    def __init__(self) -> None:
        self.tripped: Trip | None = None
        self._count = 0
        self._turns = False  # the control wants the spindle to turn

    def demand_allowed(self, message: Message) -> None:
        """Raises TrippedError for what would move, turn or switch on, while a trip is not acknowledged."""
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
        """Outputs were switched off, and the spindle; that nothing was on is no trip."""
        turned = self._turns and spindle
        self._turns = self._turns and not spindle
        if turned or outputs:
            self._tripped(away, turned, outputs)

    def fell(self, away: float, output: str) -> None:
        """One output that nobody renewed."""
        self._tripped(away, False, [output])

    def back_after(self, away: float) -> None:
        """The control speaks again."""
        if self.tripped is not None:
            self.tripped = self.tripped._replace(away=max(away, self.tripped.away))

    def acknowledge(self, count: float) -> None:
        """The control has taken note of this trip, and of no later one."""
        if self.tripped is not None and self.tripped.number == count:
            self.tripped = None

    def _tripped(self, away: float, spindle: bool, outputs: Sequence[str]) -> None:
        self._count += 1
        before = self.tripped or Trip(0, 0.0, False, ())
        on = tuple(dict.fromkeys((*before.outputs, *outputs)))
        self.tripped = Trip(self._count, max(away, before.away), spindle or before.spindle, on)


PERIOD = 0.005  # s between two rounds of the loop
RESTS = 0.2  # s at most while the control sleeps
AWAY = 0.25  # s without a round of its own: modules take their error values after three heartbeats
LATE = 0.05  # s; the drives' queues hold twice this, and a splice of 6000 pieces takes 0.03
SILENT = 0.2  # s without a word after which the control counts as stalled
ASLEEP = 0.5  # s after which one that sleeps does: nothing is on then
_NOTES = 50
_ROWS = 400  # samples in one answer: what a late control has missed comes with its next looks
_STANDS = 5.0  # rpm
_STATION = tuple(field.name for field in fields(StationState))
_RUNS_DOWN = 8.0  # s for a spindle to brake; one that has not by then is let go


@dataclass(frozen=True, slots=True)
class Driven:
    """A set of drivers that one loop owns; ``tick`` is called every few milliseconds and raises nothing.

    ``hands`` is a simulated machine's handle, or the station on the screen. ``idle``: for how many seconds
    they need no round, told whether the control sleeps and wants nothing; 0 where they cannot tell.
    ``asked``: whether the last round has asked for what the next one takes in.
    """

    ports: MachinePorts
    tick: Callable[[], object]
    close: Callable[[], None]
    hands: object | None = None
    wake: Callable[[], float | None] = lambda: None  # when the next tick is due; None: every few milliseconds
    notes: Callable[[], Sequence[str]] = tuple  # what the drivers have to tell the control
    idle: Callable[[bool], float] = lambda _asleep: 0.0
    asked: Callable[[], bool] = lambda: False


class DriverHost:
    """``handle`` one message, ``tick`` between them. All by one thread.

    A silent control is played to the end of its queue, which is at rest; then the spindle stops and the
    outputs go to their safe states: it has tripped, and neither moves nor switches on anything until the
    control has acknowledged that. ``orphaned``: it will never speak again; at rest the drives go off too,
    and once the spindle stands the driver host is done.
    """

    def __init__(
        self,
        driven: Driven,
        warnings: Sequence[str] = (),
        refresh: Mapping[str, float] | None = None,
        ring: Callable[[], None] = lambda: None,
    ) -> None:
        """``refresh``: outputs that fall after so many seconds without a word of the control.

        ``ring`` wakes a control that sleeps.
        """
        self._ring = ring
        self.asleep = False  # the control is, by its own word
        self._slept = False  # and was at the last round
        self._rung = False
        self._told: Callable[[], object] | None = None  # with the last look
        self._driven = driven
        self._ports = driven.ports
        self._warnings = list(warnings)
        self._refresh = dict(refresh or {})
        self._heard = self._ports.clock.now()
        self._parted = False
        self._parted_at = 0.0
        self._latest = 0.0  # s, the worst lateness so far
        self._answering = 0.0  # s that orders have taken since the last round: some wait for a drive
        self._notes: list[str] = []
        self._guard = TripGuard()
        self.orphaned = False
        self.done = False  # orphaned, at rest, switched off
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
        """The answer; what the drivers refuse comes back as ``error``."""
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
        """Drivers first, then whether the control still speaks."""
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
        """Whether a look would tell anything else than the last one did, but for times."""
        try:
            return self._told is None or _timeless(self._state()) != self._told()
        except DriverError:
            return True

    @property
    def _longest(self) -> float:
        return ASLEEP if self.asleep else SILENT

    def next_round(self, last: float) -> float:
        """When it is due, behind one that was due at ``last``: later where the control sleeps and the drivers
        need none.
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
        """How late the loop has woken up; what is worth telling is told, each record once."""
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
        """Whether slides that follow the spindle wait for one that turns no more: their queue never ends."""
        gear = self._ports.gear
        follows = gear is not None and gear.geared() is not None
        return follows and not self._ports.axes.sample().moving and abs(self._ports.spindle.speed()) < _STANDS

    def _trip(self, away: float, *, spindle: bool = True) -> None:
        """Outputs safe, as modules have made them already that missed our heartbeat, and the spindle stopped
        unless a tool is still in the cut, or it stands and is held at its angle. What was on is what the
        control has to be told.
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
        """Outputs that nobody renews do not wait for the slides to rest."""
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
        """The queue ends at rest by itself; what does not, is stopped once it is over."""
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
            # Closing takes the spindle's power: while it turns it would run on unbraked.
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

    # --- answers ------------------------------------------------------------------------------------------

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
        """Everything that can be seen. Raises DriverError."""
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
        self._driven.tick()  # a long one takes a while: the drives' queues are filled before
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
    """A look without its times; of the station's age it is told whether that is silent."""
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
