"""The server of the driver host, which handles messages and runs the drivers.

The server stops the machine if the control ends.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache, partial
from typing import TypeVar

import numpy as np

from core.faults import TrippedError
from core.message import Message as Text
from core.ports import DriverError, MachinePorts, StationState, StopMode, is_queue_finished
from drivers.driver_host.host_messages import (
    NO_NUMBERS,
    PROTOCOL_VERSION,
    Message,
    decode_cam,
    make_fault_entries,
    number,
    parse_segments,
)
from drivers.driver_host.trip_guard import TripGuard
from drivers.process_messages import text
from drivers.silence import (
    HOST_CONTROL_TIMEOUT_S,
    HOST_SLEEP_TIMEOUT_S,
    SilenceStop,
    StopSteps,
)

_Part = TypeVar("_Part")
# Text and reason code for each missing optional part of the machine.
_NO_C_REASON = "the spindle drive of this machine is not used as the C axis", "no-c"
_UNORIENTED = "this machine's spindle driver cannot orient the spindle to an angle", "no-orientation"
_NO_TOUCH = "this driver cannot capture the axis position at a touch signal", "no-touch"
_NO_GEAR = "this driver cannot synchronize the axes with the spindle", "no-gear"

# --- Commands that change the machine, by name; and actions at a simulated station.


def execute_command(ports: MachinePorts, head: Mapping[str, object]) -> None:
    """Execute one command of the control.

    Raises DriverError if the command is unknown or the drivers reject it.
    """
    on = head.get("on") is True
    acts: dict[str, Callable[[], None]] = {
        "enable": lambda: ports.axes.enable(on),
        "stop": lambda: ports.axes.stop(_how(text(head, "how"))),
        "home": lambda: ports.axes.home(text(head, "name")),
        "clear_fault": ports.axes.clear_fault,
        "run": lambda: ports.spindle.set_speed(number(head, "rpm")),
        "coast": ports.spindle.start_coasting,
        "hold": lambda: _require_part(ports.lock, *_NO_C_REASON).set_c_mode(on, head.get("orient") is True),
        "orient": lambda: _require_part(ports.orientation, *_UNORIENTED).orient_spindle(
            number(head, "angle"), int(number(head, "sense"))
        ),
        "release": lambda: _require_part(ports.orientation, *_UNORIENTED).release_spindle(),
        "write": lambda: ports.io.write(text(head, "name"), on),
        "safe": ports.io.switch_to_safe_state,
        "arm": lambda: _require_part(ports.touch, *_NO_TOUCH).arm_latch(),
    }
    order = acts.get(text(head, "what"))
    if order is None:
        raise DriverError(
            "the driver host does not recognize this command; check that the driver host "
            "and TurnDesk have the same version",
            reason="unknown-order",
        )
    order()


def call_station_control(controls: object | None, head: Mapping[str, object]) -> object:
    """Call a method of the simulated operator station by its name, and return its result.

    Raises DriverError if the machine has no simulated station, or if the method or its arguments are
    invalid.
    """
    name, values = text(head, "name"), head.get("values")
    use = None if name.startswith("_") or controls is None else getattr(controls, name, None)
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


def _require_part(part: _Part | None, missing: str, reason: str) -> _Part:
    """Return an optional part of the machine.

    Raises DriverError if the machine does not have this part.
    """
    if part is None:
        raise DriverError(missing, reason=reason)
    return part


def _how(word: str) -> StopMode:
    try:
        return StopMode(word)
    except ValueError as error:
        raise DriverError(
            "the driver host does not recognize the stop command '{word}'", reason="unknown-stop", word=word
        ) from error


CYCLE_PERIOD_S = 0.005  # Seconds between two cycles of the loop.
MAX_SLEEP_CYCLE_S = 0.2  # Maximum seconds between two cycles while the control sleeps.
MAX_CYCLE_GAP_S = 0.25  # Seconds without a cycle; modules set their error values after three heartbeats.
MAX_WAKEUP_DELAY_S = (
    0.05  # Seconds; the drives' queues buffer twice this time, and a splice of 6000 pieces takes 0.03 s.
)
_MAX_NOTES = 50
_MAX_REPLY_SAMPLES = 400  # Samples in one reply; a delayed control receives the rest with its next polls.
_STANDSTILL_RPM = 5.0  # rpm
_STATION_FIELDS = tuple(field.name for field in fields(StationState))


@dataclass(frozen=True, slots=True)
class DriverBundle:
    """Drivers of one machine and the functions that their loop calls.

    - ``run_cycle`` is called every few milliseconds and raises no error.
    - ``station_controls`` operate a simulated machine or the station on the screen.
    - ``get_idle_time`` returns for how many seconds no cycle is required; 0 means unknown. Its
      argument is True while the control sleeps.
    - ``has_sent_requests`` returns whether the last cycle sent requests whose replies are still to be read.
    """

    ports: MachinePorts
    run_cycle: Callable[[], object]
    close: Callable[[], None]
    station_controls: object | None = None
    # Due time of the next tick; None: every few milliseconds.
    get_next_tick_time: Callable[[], float | None] = lambda: None
    collect_driver_messages: Callable[[], Sequence[str]] = tuple  # Messages of the drivers for the control.
    get_idle_time: Callable[[bool], float] = lambda _asleep: 0.0
    has_sent_requests: Callable[[], bool] = lambda: False


class DriverHost:
    """Driver host, which handles messages and runs the drivers in one thread.

    If the control is silent, the driver host executes the setpoint queue to the end, where the axes are at
    rest. It then stops the spindle and sets the outputs to their safe states. This is a trip: no axis or
    spindle moves and no output switches on until the control has acknowledged the trip.

    ``is_orphaned`` means that the control has ended. The drives are then also switched off when the axes
    are at rest, and the driver host ends when the spindle is at standstill.
    """

    def __init__(
        self,
        drivers: DriverBundle,
        warnings: Sequence[str] = (),
        refresh_periods: Mapping[str, float] | None = None,
        ring_bell: Callable[[], None] = lambda: None,
    ) -> None:
        """Create the driver host.

        ``refresh_periods`` contains the refresh period in seconds of some outputs. An output is switched
        off if no message arrives for longer than its period. ``ring_bell`` is the function that wakes a
        sleeping control.
        """
        self._ring = ring_bell
        self.is_asleep = False  # The control has reported that it sleeps.
        self._slept = False  # The control slept at the last cycle.
        self._rung = False
        self._told: Callable[[], object] | None = None  # State of the last poll.
        self._driven = drivers
        self._ports = drivers.ports
        self._warnings = list(warnings)
        self._refresh = dict(refresh_periods or {})
        axes = self._ports.axes
        self._silence = SilenceStop(
            HOST_CONTROL_TIMEOUT_S,
            self._ports.clock.now(),
            StopSteps(
                self._resting,
                self._brake_waiting_cam,
                self._switch_off,
                lambda: self._carefully(lambda: axes.stop(StopMode.RAMP_OFF)),
                lambda: abs(self._ports.spindle.speed()) < _STANDSTILL_RPM,
            ),
        )
        self._latest = 0.0  # Maximum delay so far in s.
        self._answering = 0.0  # Duration of commands since the last cycle in s; some wait for a drive.
        self._notes: list[str] = []
        self._guard = TripGuard()
        self.is_orphaned = False
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

    @property
    def is_done(self) -> bool:
        """Return whether the control has ended and the machine is at rest and switched off."""
        return self._silence.is_done

    def handle_message(self, message: Message) -> Message:
        """Handle a message and return the reply.

        If the drivers reject the request, the reply contains the entry ``error``.
        """
        began = self._ports.clock.now()
        self._hear(began)
        what = text(message.header, "do")
        self.is_asleep = what == "rest" or (what == "look" and message.header.get("rests") is True)
        self._silence.timeout_s = HOST_SLEEP_TIMEOUT_S if self.is_asleep else HOST_CONTROL_TIMEOUT_S
        answer = self._answers.get(what)
        if answer is None:
            return _refused(
                "the driver host does not recognize this request; check that the driver host "
                "and TurnDesk have the same version",
                "unknown-request",
            )
        try:
            self._guard.require_request_allowed(message)
            return answer(message)
        except TrippedError as error:
            return Message({"tripped": str(error)}, NO_NUMBERS)
        except DriverError as error:
            return _refused(error.fault, error.reason)
        finally:
            ended = self._ports.clock.now()
            self._silence.hear(ended)
            self._answering += ended - began

    def run_cycle(self) -> None:
        """Run the drivers, and then check whether the control still sends messages."""
        self._driven.run_cycle()
        for note in self._driven.collect_driver_messages():
            self._note(note)
        if self._guard.is_c_requested:
            sample = self._ports.axes.sample()
            self._guard.record_c_state(is_enabled=sample.enabled, fault=sample.fault)
        now = self._ports.clock.now()
        self._expire_outputs(self._silence.measure(now))
        self._silence.advance(now, has_ended=self.is_orphaned)
        if self.is_asleep and not (self._rung or self._driven.has_sent_requests()) and self._has_news():
            self._rung = True
            self._ring()

    def _has_news(self) -> bool:
        """Return whether the state, ignoring its time values, has changed since the last poll."""
        try:
            return self._told is None or _without_times(self._read_state()) != self._told()
        except DriverError:
            return True

    def get_next_cycle_time(self, last_cycle_time: float) -> float:
        """Return the due time of the next cycle.

        If the control sleeps and the drivers are idle, the next cycle is delayed. ``last_cycle_time`` is
        the due time of the last cycle.
        """
        set_by_drivers = self._driven.get_next_tick_time()
        if set_by_drivers is not None:
            return set_by_drivers
        now, asleep = self._ports.clock.now(), self.is_asleep and not self.is_orphaned
        idle = self._driven.get_idle_time(asleep) if asleep or self._slept else 0.0
        self._slept = asleep
        if asleep and idle > 0.0:
            return now + min(idle, MAX_SLEEP_CYCLE_S)
        return max(last_cycle_time + CYCLE_PERIOD_S, now)

    def record_wakeup_delay(self, delay_s: float) -> None:
        """Record the wake-up delay of the loop.

        Each new maximum is reported once.
        """
        slept, self._answering = delay_s - self._answering, 0.0
        if slept > max(self._latest, MAX_WAKEUP_DELAY_S):
            self._latest = slept
            self._note(
                Text(
                    "the driver host woke up {late} ms late; check that it has real-time priority",
                    late=f"{1000 * slept:.0f}",
                )
            )
        if delay_s > MAX_CYCLE_GAP_S:
            self._trip(delay_s, spindle=self._resting())

    def _resting(self) -> bool:
        axes = self._ports.axes
        return not axes.sample().moving and is_queue_finished(axes.horizon(), axes.now())

    def _brake_waiting_cam(self) -> None:
        """Brake axes that follow a stopped spindle, because their queue would otherwise never end."""
        ports = self._ports
        follows = ports.gear is not None and ports.gear.geared() is not None
        if follows and not ports.axes.sample().moving and abs(ports.spindle.speed()) < _STANDSTILL_RPM:
            self._carefully(lambda: ports.axes.stop(StopMode.RAMP_HOLD))

    def _trip(self, silence_s: float, *, spindle: bool = True) -> None:
        """Set the outputs to their safe states, stop the spindle, and record what was on.

        The spindle is not stopped while a tool is in the cut or while the spindle is oriented. A spindle
        drive that is being engaged as the C axis is released, because it may turn. A C axis that is already
        engaged remains engaged. I/O modules that missed the heartbeat have already changed their outputs.
        """
        orientation, lock = self._ports.orientation, self._ports.lock
        spindle = spindle and not (orientation is not None and orientation.is_oriented())
        changes_to_c = spindle and self._guard.is_c_requested and lock is not None and not lock.is_c_ready()
        before = dict(self._ports.io.get_outputs())
        self._carefully(self._ports.io.switch_to_safe_state)
        if lock is not None and changes_to_c:
            self._carefully(partial(lock.set_c_mode, False))
        if spindle:
            self._carefully(lambda: self._ports.spindle.set_speed(0.0))
        after = self._ports.io.get_outputs()
        off = [name for name, on in before.items() if on and not after.get(name)]
        self._guard.record_trip(silence_s, off, is_spindle_stopped=spindle, is_c_canceled=changes_to_c)

    def _hear(self, now: float) -> None:
        if self._silence.check(now):
            silent = self._silence.measure(now)
            self._note(Text("no messages from TurnDesk for {seconds} s", seconds=f"{silent:.2f}"))
            self._guard.update_silence_duration(silent)
        self._silence.hear(now)

    def _expire_outputs(self, silence_s: float) -> None:
        """Switch off outputs that the control does not renew, without waiting for the axes to stop."""
        for name, longest in self._refresh.items():
            if silence_s > longest and self._ports.io.get_outputs().get(name):
                self._note(
                    Text(
                        "{output} was switched off: no messages from TurnDesk for {seconds} s",
                        output=name,
                        seconds=f"{silence_s:.2f}",
                    )
                )
                self._carefully(partial(self._ports.io.write, name, False))
                self._guard.record_output_switched_off(silence_s, name)

    def _switch_off(self) -> None:
        """Switch off the spindle and the outputs, because the control is silent and the axes are at rest."""
        self._note(
            "no messages were received from TurnDesk; the spindle is stopped and the "
            "outputs are in their safe state"
        )
        self._trip(self._silence.measure(self._ports.clock.now()))

    def _carefully(self, *steps: Callable[[], None]) -> None:
        for step in steps:
            try:
                step()
            except DriverError as error:
                self._note(Text("error while the driver host was stopping the machine: {error}", error=error))

    def _note(self, what: str) -> None:
        self._notes = [*self._notes[-_MAX_NOTES:], what]

    # --- replies ------------------------------------------------------------------------------------------

    def _hello(self, _message: Message) -> Message:
        axes = self._ports.axes
        head = {
            "version": PROTOCOL_VERSION,
            "axes": axes.axes,
            "commit": axes.commit,
            "gear": self._ports.gear is not None,
            "lock": self._ports.lock is not None,
            "orientation": self._ports.orientation is not None,
            "touch": self._ports.touch is not None,
            "samples": self._ports.samples.sample_rate_hz if self._ports.samples is not None else 0.0,
            "untraced": self._ports.untraced,
            "warnings": [*self._warnings, *self._ports.warnings],
        }
        return Message(head, NO_NUMBERS)

    def _read_state(self) -> dict[str, object]:
        """Return the complete observable state of the machine.

        Raises DriverError if the drivers cannot report the state.
        """
        ports, sample = self._ports, self._ports.axes.sample()
        station = ports.station.read_state()
        return {
            "sample": {**sample._asdict(), **make_fault_entries("fault", sample.fault, "axis")},
            "speed": ports.spindle.speed(),
            "spindle_lag": ports.spindle_lag(),
            "angle": ports.spindle.read_angle(),
            **make_fault_entries("spindle", ports.spindle.read_fault(), "spindle"),
            "inputs": dict(ports.io.inputs()),
            "outputs": dict(ports.io.get_outputs()),
            "station": {name: getattr(station, name) for name in _STATION_FIELDS},
            "geared": ports.gear.geared() if ports.gear is not None else None,
            "held": ports.lock is not None and ports.lock.is_c_ready(),
            "oriented": ports.orientation is not None and ports.orientation.is_oriented(),
            "trip": self._guard.active_trip,
            "latch": ports.touch.read_latch() if ports.touch is not None else None,
            "notes": self._notes,
            "unknown": sorted(ports.unknown()),
        }

    def _look(self, _message: Message) -> Message:
        state = self._read_state()
        self._notes, self._rung = [], False
        self._told = cache(partial(_without_times, {**state, "notes": []}))
        source = self._ports.samples
        sampled = source.take_samples(_MAX_REPLY_SAMPLES).ravel() if source is not None else NO_NUMBERS
        return Message(state, sampled)

    def _splice(self, message: Message) -> Message:
        self._driven.run_cycle()  # A long splice takes time, so the drives' queues are filled first.
        self._ports.axes.splice(parse_segments(message.numbers, len(self._ports.axes.axes)))
        return _value(0.0)

    def _demand(self, message: Message) -> Message:
        p, v = self._ports.axes.demand_at(number(message.header, "t"))
        return Message({}, np.array([*p, *v]))

    def _mesh(self, message: Message) -> Message:
        gear = _require_part(self._ports.gear, *_NO_GEAR)
        gear.mesh(decode_cam(message, len(self._ports.axes.axes)))
        return _value(0.0)

    def _act(self, message: Message) -> Message:
        if text(message.header, "what") == "acknowledge":
            self._guard.acknowledge_trip(number(message.header, "number"))
        else:
            execute_command(self._ports, message.header)
            self._guard.record_accepted_command(message)
        return _value(0.0)

    def _hand(self, message: Message) -> Message:
        return Message(
            {"value": call_station_control(self._driven.station_controls, message.header)}, NO_NUMBERS
        )


def _without_times(state: Mapping[str, object]) -> Mapping[str, object]:
    """Return a polled state without times.

    The age of the station is reduced to whether the station is silent.
    """
    sample, angle, station = state.get("sample"), state.get("angle"), state.get("station")
    assert isinstance(sample, dict)
    assert isinstance(station, dict)
    return {
        **state,
        "sample": {**sample, "t": 0.0},
        "angle": angle[1:] if isinstance(angle, tuple) else None,
        "station": {**station, "age": station["age"] > HOST_CONTROL_TIMEOUT_S},
    }


def _value(value: float) -> Message:
    return Message({"value": value}, NO_NUMBERS)


def _refused(why: str, reason: str = "") -> Message:
    return Message({**make_fault_entries("error", why, "driver"), "reason": reason}, NO_NUMBERS)
