"""The control's side of the feeder: ``core.ports`` as messages; a feeder that is gone is a fault."""

from __future__ import annotations

import logging
import queue
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import numpy as np

from core.ports import (
    ALL_UNKNOWN,
    AxisSample,
    Cam,
    Clock,
    DriverError,
    Fault,
    FloatArray,
    Geared,
    Latch,
    MachinePorts,
    Segments,
    StationState,
    Stop,
    Trip,
    TrippedError,
    Unknown,
    code_of,
)
from drivers.feeder.feeder_messages import (
    NOTHING,
    VERSION,
    Message,
    cam_message,
    fault_of,
    floats,
    items,
    number,
    rows,
    text,
    texts,
)
from drivers.reopening import Opening
from drivers.wakeup import Bell

_log = logging.getLogger(__name__)
_FRESH = 0.002  # s for which one look serves all ports
_RESTS = 0.02  # s for which it does while the control sleeps: one tick, and what is new rings
_BATCHES = 200  # of samples that wait for whoever records them


class Link(Protocol):
    """Carries a request to the feeder and its answer back; ``files`` are what can be waited for."""

    @property
    def files(self) -> Sequence[int]: ...

    def ask(self, message: Message) -> Message:
        """Raises DriverError when there is no answer."""
        ...

    def hang_up(self) -> None:
        """From any thread: nothing is said or heard any more."""
        ...

    def close(self) -> None: ...


def cleared(link: Link) -> Link:
    """The Reset that has asked for another feeder is meant for its drives too. Raises DriverError."""
    answer = link.ask(Message({"do": "do", "what": "clear_fault"}, NOTHING))
    if why := fault_of(answer.head, "error", "driver"):
        raise DriverError(why)
    return link


class Line:
    """Requests in words, and the last look at everything.

    ``again`` begins to start another feeder in the place of one that is gone: there is no other way back.
    ``bell`` is rung by the feeder too, while the control sleeps.
    """

    def __init__(
        self,
        link: Link,
        clock: Clock,
        again: Callable[[], Opening[Link]] | None = None,
        bell: Bell | None = None,
    ) -> None:
        self._link = link
        self._again = again
        self._opening: Opening[Link] | None = None
        self.clock = clock
        self.bell = bell
        self._asleep = self._sleeps = False  # as the feeder has been told, and as the next look says
        self.fault: Fault | str = ""  # why the feeder cannot be asked any more
        self._state: Mapping[str, object] = {}
        self._at = -1.0
        self._posted: queue.SimpleQueue[Message] = queue.SimpleQueue()
        self.sampled: deque[FloatArray] = deque(maxlen=_BATCHES)  # since they were last taken

    def ask(self, message: Message) -> Message:
        """The answer. Raises DriverError with what the drivers refuse, or that the feeder is gone."""
        if self.fault:
            raise DriverError(self.fault)
        if self._opening is not None:
            raise DriverError("the feeder is being started again", "feeder-gone")
        self._asleep = False
        try:
            answer = self._link.ask(message)
        except DriverError as error:
            self.fault = error.fault
            raise
        if "tripped" in answer.head:
            raise TrippedError(text(answer.head, "tripped"))
        if why := fault_of(answer.head, "error", "driver"):
            raise DriverError(why)
        return answer

    def order(self, what: str, **values: object) -> None:
        """Something that changes the machine; the next look is a new one."""
        self._at = -1.0
        self.ask(Message({"do": "do", "what": what, **values}, NOTHING))

    def post(self, message: Message) -> None:
        """From any thread: goes out before the next look, unanswered."""
        self._posted.put(message)
        if self.bell is not None:
            self.bell.ring()

    def sleep(self) -> None:
        """Until anything but a look is asked for the feeder rings for what is new. Raises DriverError."""
        if not self._asleep:
            self.ask(Message({"do": "rest"}, NOTHING))
        self._asleep = self._sleeps = True

    def awake(self) -> None:
        """Looks come as ever, and the next one is a new one."""
        self._sleeps, self._at = False, -1.0

    @property
    def files(self) -> Sequence[int]:
        """Of the link: nothing comes there that is not asked for, but its end."""
        return self._link.files

    def look(self, *, anew: bool = False) -> Mapping[str, object]:
        """Everything that can be seen, of this tick; the last known when the feeder is gone."""
        if self._opening is not None:
            self._reopen(self._opening)
        now = self.clock.now()
        fresh = _RESTS if self._asleep else _FRESH
        if not self.lost and (anew or not 0.0 <= now - self._at < fresh):
            try:
                while not self._posted.empty():
                    self.ask(self._posted.get())
                sleeps, self._sleeps = self._sleeps, False
                answer = self.ask(Message({"do": "look", "rests": sleeps}, NOTHING))
                self._asleep = sleeps
                self._state = answer.head
                if len(answer.numbers):
                    self.sampled.append(answer.numbers)
            except DriverError as error:
                self.fault = self.fault or error.fault
            self._at = now
            for note in texts(self._state.get("notes")):
                _log.warning("feeder: %s", note)
        return self._state

    @property
    def lost(self) -> bool:
        """Whether there is no feeder to ask."""
        return self.fault != "" or self._opening is not None

    def restart(self) -> None:
        """Begin to start another feeder; why that fails is the next fault. Raises DriverError where there is
        none to start.
        """
        if self._again is None:
            raise DriverError(f"{self.fault}; start the control again", code_of(self.fault, "feeder-gone"))
        self.fault, self._opening = "", self._again()

    def greet(self) -> Mapping[str, object]:
        """What the feeder says of itself. Raises DriverError for one of another version."""
        hello = self.ask(Message({"do": "hello"}, NOTHING)).head
        if hello.get("version") != VERSION:
            raise DriverError(
                f"the feeder speaks version {hello.get('version')}, this control {VERSION}: end the control,"
                " and start it again once its installation is whole"
            )
        return hello

    def _reopen(self, opening: Opening[Link]) -> None:
        try:
            link = opening.take()
            if link is None:
                return
            self._link, self._opening, self._at = link, None, -1.0
            self._state = {}
            self.greet()
        except DriverError as error:
            self._opening, self.fault = None, error.fault

    def unknown(self) -> frozenset[Unknown]:
        """What the drivers do not hear of; of a feeder that is gone nothing is known."""
        if self.lost:
            return ALL_UNKNOWN
        return frozenset(map(Unknown, texts(self.look().get("unknown"))))

    def hang_up(self) -> None:
        """From any thread: the feeder sees that its control is gone, and stops the machine for good."""
        self._link.hang_up()

    def close(self) -> None:
        """End it."""
        self._link.close()


# --- ``core.ports`` through the feeder: each call a message.


class _OnLine:
    """What asks the feeder."""

    def __init__(self, line: Line) -> None:
        self._line = line


class FeederAxes(_OnLine):
    """``core.ports.AxisSink``."""

    def __init__(self, line: Line, hello: Mapping[str, object]) -> None:
        super().__init__(line)
        self.axes = tuple(texts(hello.get("axes")))
        self.commit = number(hello, "commit")

    def now(self) -> float:
        """The machine's clock: the same in both processes."""
        return self._line.clock.now()

    def horizon(self) -> float:
        """End of what is queued."""
        return number(self._line.ask(Message({"do": "horizon"}, NOTHING)).head, "value")

    def splice(self, segments: Segments) -> None:
        """Queue setpoints. Raises DriverError as the port says."""
        self._line.ask(Message({"do": "splice"}, rows(segments)))

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Queued position and velocity at ``t``."""
        numbers = self._line.ask(Message({"do": "demand", "t": t}, NOTHING)).numbers.tolist()
        half = len(self.axes)
        return tuple(numbers[:half]), tuple(numbers[half:])

    def sample(self) -> AxisSample:
        """The axes now. A feeder that is gone is a fault of all of them."""
        raw = self._line.look(anew=True).get("sample")
        shown = raw if isinstance(raw, dict) else {}
        none = (0.0,) * len(self.axes)
        return AxisSample(
            t=number(shown, "t") if shown else self.now(),
            demand=floats(shown.get("demand", none)),
            actual=floats(shown.get("actual", none)),
            following_error=floats(shown.get("following_error", none)),
            enabled=shown.get("enabled") is True and not self._line.lost,
            homed=tuple(one is True for one in items(shown.get("homed"))) or (False,) * len(self.axes),
            moving=shown.get("moving") is True and not self._line.lost,
            fault=self._line.fault or fault_of(shown, "fault", "axis"),
        )

    def enable(self, on: bool) -> None:
        """Drives on or off."""
        self._line.order("enable", on=on)

    def stop(self, how: Stop) -> None:
        """The drives' own stop."""
        self._line.order("stop", how=how.value)

    def home(self, axis: str) -> None:
        """Start homing."""
        self._line.order("home", name=axis)

    def clear_fault(self) -> None:
        """Forget the fault; a feeder that is gone is started again. Raises DriverError."""
        if self._line.fault:
            self._line.restart()
        else:
            self._line.order("clear_fault")


class FeederGear(_OnLine):
    """``core.ports.Gear``."""

    def mesh(self, cam: Cam) -> None:
        """Follow the spindle. Raises DriverError."""
        self._line.ask(cam_message(cam))

    def geared(self) -> Geared | None:
        """Where on its cam the feeder's driver is."""
        shown = self._line.look(anew=True).get("geared")
        return None if shown is None or self._line.lost else Geared(*floats(shown))


class FeederSpindle(_OnLine):
    """``core.ports.Spindle``."""

    def run(self, rpm: float) -> None:
        """Turn at ``rpm``, signed."""
        self._line.order("run", rpm=rpm)

    def coast(self) -> None:
        """No torque."""
        self._line.order("coast")

    def speed(self) -> float:
        """Measured rpm; what is not known counts as standing."""
        shown = self._line.look()
        return number(shown, "speed") if shown else 0.0

    def angle(self) -> tuple[float, float] | None:
        """(time, turns) from the encoder, or None without one."""
        shown = self._line.look().get("angle")
        if shown is None:
            return None
        t, turns = floats(shown)
        return t, turns

    def fault(self) -> str:
        """What is wrong with it."""
        return self._line.fault or fault_of(self._line.look(), "spindle", "spindle")


class FeederWakeup(_OnLine):
    """``core.ports.Wakeup``: the feeder goes on looking, and rings."""

    def __init__(self, line: Line, bell: Bell) -> None:
        super().__init__(line)
        self._bell = bell
        self.ring = bell.ring

    def settled(self) -> bool:
        """Whatever changes there, it rings."""
        return not self._line.lost

    def wait(self, seconds: float) -> bool:
        """Until it rings, so long at most; whether it has. A feeder that ends rings too."""
        try:
            self._line.sleep()
        except DriverError:
            return True  # the next look tells why
        rung = self._bell.wait(seconds, self._line.files)
        if rung:
            self._line.awake()
        return rung


class FeederSamples(_OnLine):
    """``core.ports.SampleSource``: they have come with the looks."""

    def __init__(self, line: Line, hello: Mapping[str, object]) -> None:
        super().__init__(line)
        self.rate = number(hello, "samples")
        self._width = 5 + 3 * len(texts(hello.get("axes")))

    def take(self, most: int = 8192) -> FloatArray:  # noqa: ARG002  an answer has few enough
        """What has come since; what does not fit is none."""
        waiting = self._line.sampled
        told = [waiting.popleft() for _ in range(len(waiting))]
        whole = [rows.reshape(-1, self._width) for rows in told if not len(rows) % self._width]
        return np.concatenate(whole) if whole else np.empty((0, self._width))


class FeederLock(_OnLine):
    """``core.ports.SpindleHold``."""

    def hold(self, on: bool, orient: bool = False) -> None:
        """Ask for the spindle's drive as C, or let it turn again."""
        self._line.order("hold", on=on, orient=orient)

    def held(self) -> bool:
        """Whether C may move."""
        return self._line.look().get("held") is True and not self._line.lost


class FeederOrientation(_OnLine):
    """``core.ports.SpindleOrientation``."""

    def orient(self, angle: float, sense: int = 0) -> None:
        """Ask for an angle."""
        self._line.order("orient", angle=angle, sense=sense)

    def release(self) -> None:
        """Hold it no longer."""
        self._line.order("release")

    def oriented(self) -> bool:
        """Whether it is held at its angle; of a feeder that is gone, as it last was."""
        return self._line.look().get("oriented") is True


class FeederIO(_OnLine):
    """``core.ports.DigitalIO``."""

    def inputs(self) -> Mapping[str, bool]:
        """All inputs by name."""
        return _flags(self._line.look().get("inputs"))

    def outputs(self) -> Mapping[str, bool]:
        """All outputs as last written."""
        return _flags(self._line.look().get("outputs"))

    def write(self, name: str, on: bool) -> None:
        """Switch one output."""
        self._line.order("write", name=name, on=on)

    def safe(self) -> None:
        """Every output to its safe state."""
        self._line.order("safe")


class FeederStation(_OnLine):
    """``core.ports.Station``."""

    def snapshot(self) -> StationState:
        """The station now; without the feeder nothing is pressed, and it has been silent for ever."""
        shown = self._line.look().get("station")
        if self._line.lost or not isinstance(shown, dict):
            return StationState(age=float("inf"))
        return StationState(**shown)


class FeederTouch(_OnLine):
    """``core.ports.TouchInput``."""

    def arm(self) -> None:
        """Forget what was kept."""
        self._line.order("arm")

    def latched(self) -> Latch | None:
        """The first touch since."""
        shown = self._line.look().get("latch")
        if shown is None or self._line.lost:
            return None
        t, place, late = items(shown)
        (t_s, late_s) = floats([t, late])
        return Latch(t_s, floats(place), late_s)


class FeederTrips(_OnLine):
    """``core.ports.Tripping``."""

    def tripped(self) -> Trip | None:
        """What the feeder has switched off since it was last acknowledged."""
        shown = self._line.look().get("trip")
        if shown is None:
            return None
        count, away, spindle, outputs, found = items(shown)
        (away_s,) = floats([away])
        (number_,) = floats([count])
        return Trip(int(number_), away_s, spindle is True, tuple(texts(outputs)), found is True)

    def acknowledge(self, trip: Trip) -> None:
        """It may go on: the control knows."""
        self._line.order("acknowledge", number=trip.number)


def feeder_ports(line: Line) -> MachinePorts:
    """The ports of whatever the feeder drives. Raises DriverError when it does not answer."""
    hello = line.greet()
    return MachinePorts(
        clock=line.clock,
        axes=FeederAxes(line, hello),
        spindle=FeederSpindle(line),
        io=FeederIO(line),
        station=FeederStation(line),
        warnings=tuple(texts(hello.get("warnings"))),
        gear=FeederGear(line) if hello.get("gear") is True else None,
        lock=FeederLock(line) if hello.get("lock") is True else None,
        orientation=FeederOrientation(line) if hello.get("orientation") is True else None,
        trips=FeederTrips(line),
        halt=line.hang_up,
        untraced=str(hello.get("untraced") or ""),
        samples=FeederSamples(line, hello) if hello.get("samples") else None,
        wakeup=FeederWakeup(line, line.bell) if line.bell is not None else None,
        unknown=line.unknown,
        touch=FeederTouch(line) if hello.get("touch") is True else None,
    )


def _flags(value: object) -> dict[str, bool]:
    return {name: on is True for name, on in value.items()} if isinstance(value, dict) else {}


# --- The hands at a station that lives in the feeder: the simulated one, or the one on the screen.


def _hand(name: str) -> Callable[..., None]:
    """The method of this name at that station: it goes out with the executor's next look, nobody waits."""

    def use(self: FeederHands, *values: object) -> None:
        self.post(name, *values)

    return use


class FeederHands(_OnLine):
    """Any thread may act; what an act means stands at ``app.desk.station_hands.StationPanel``."""

    press_left, release_left = _hand("press_left"), _hand("release_left")
    press_right, release_right = _hand("press_right"), _hand("release_right")
    press_hold, release_hold = _hand("press_hold"), _hand("release_hold")
    press_estop, release_estop = _hand("press_estop"), _hand("release_estop")
    set_spindle_auto, set_spindle_pot = _hand("set_spindle_auto"), _hand("set_spindle_pot")
    set_feed_pot, turn_handwheel = _hand("set_feed_pot"), _hand("turn_handwheel")

    def set_input(self, name: str, on: bool) -> None:
        """Make an input of a simulated machine true or false, at once. Raises DriverError."""
        self._line.ask(_act("set_input", name, on))

    def post(self, name: str, *values: object) -> None:
        """Use the method of this name at the station."""
        self._line.post(_act(name, *values))


def _act(name: str, *values: object) -> Message:
    return Message({"do": "hand", "name": name, "values": list(values)}, NOTHING)
