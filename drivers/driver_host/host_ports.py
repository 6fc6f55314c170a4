"""The control's side of the driver host: ``core.ports`` and the station's hands as messages to it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from core.faults import Trip
from core.ports import (
    AxisSample,
    Cam,
    DriverError,
    FloatArray,
    Geared,
    Latch,
    MachinePorts,
    Segments,
    StationState,
    Stop,
)
from drivers.driver_host.host_line import Line
from drivers.driver_host.host_messages import (
    NOTHING,
    Message,
    cam_message,
    fault_of,
    floats,
    items,
    number,
    rows,
    texts,
)
from drivers.operator_station import PostedHands
from drivers.waiting import Bell


class _OnLine:
    """What asks the driver host."""

    def __init__(self, line: Line) -> None:
        self._line = line


class HostAxes(_OnLine):
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
        """The axes now. A driver host that is gone is a fault of all of them."""
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
        """Forget the fault; a driver host that is gone is started again. Raises DriverError."""
        if self._line.fault:
            self._line.restart()
        else:
            self._line.order("clear_fault")


class HostGear(_OnLine):
    """``core.ports.Gear``."""

    def mesh(self, cam: Cam) -> None:
        """Follow the spindle. Raises DriverError."""
        self._line.ask(cam_message(cam))

    def geared(self) -> Geared | None:
        """Where on its cam the driver host's driver is."""
        shown = self._line.look(anew=True).get("geared")
        return None if shown is None or self._line.lost else Geared(*floats(shown))


class HostSpindle(_OnLine):
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

    def lag(self) -> float:
        """Return the seconds by which the wire to the spindle's drive delays commands and speeds."""
        shown = self._line.look()
        return number(shown, "spindle_lag") if shown else 0.0

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


class HostWakeup(_OnLine):
    """``core.ports.Wakeup``: the driver host goes on looking, and rings."""

    def __init__(self, line: Line, bell: Bell) -> None:
        super().__init__(line)
        self._bell = bell
        self.ring = bell.ring

    def settled(self) -> bool:
        """Whatever changes there, it rings."""
        return not self._line.lost

    def wait(self, seconds: float) -> bool:
        """Until it rings, so long at most; whether it has. A driver host that ends rings too."""
        try:
            self._line.sleep()
        except DriverError:
            return True  # the next look tells why
        rung = self._bell.wait(seconds, self._line.files)
        if rung:
            self._line.awake()
        return rung


class HostSamples(_OnLine):
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


class HostLock(_OnLine):
    """``core.ports.SpindleHold``."""

    def hold(self, on: bool, orient: bool = False) -> None:
        """Ask for the spindle's drive as C, or let it turn again."""
        self._line.order("hold", on=on, orient=orient)

    def held(self) -> bool:
        """Whether C may move."""
        return self._line.look().get("held") is True and not self._line.lost


class HostOrientation(_OnLine):
    """``core.ports.SpindleOrientation``."""

    def orient(self, angle: float, sense: int = 0) -> None:
        """Ask for an angle."""
        self._line.order("orient", angle=angle, sense=sense)

    def release(self) -> None:
        """Hold it no longer."""
        self._line.order("release")

    def oriented(self) -> bool:
        """Whether it is held at its angle; of a driver host that is gone, as it last was."""
        return self._line.look().get("oriented") is True


class HostIO(_OnLine):
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


class HostStation(_OnLine):
    """``core.ports.Station``."""

    def snapshot(self) -> StationState:
        """The station now; without the driver host nothing is pressed, and it has been silent for ever."""
        shown = self._line.look().get("station")
        if self._line.lost or not isinstance(shown, dict):
            return StationState(age=float("inf"))
        return StationState(**shown)


class HostTouch(_OnLine):
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


class HostTrips(_OnLine):
    """``core.faults.Tripping``."""

    def tripped(self) -> Trip | None:
        """What the driver host has switched off since it was last acknowledged."""
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


def host_ports(line: Line) -> MachinePorts:
    """The ports of whatever the driver host drives. Raises DriverError when it does not answer."""
    hello, spindle = line.greet(), HostSpindle(line)
    return MachinePorts(
        clock=line.clock,
        axes=HostAxes(line, hello),
        spindle=spindle,
        spindle_lag=spindle.lag,
        io=HostIO(line),
        station=HostStation(line),
        warnings=tuple(texts(hello.get("warnings"))),
        gear=HostGear(line) if hello.get("gear") is True else None,
        lock=HostLock(line) if hello.get("lock") is True else None,
        orientation=HostOrientation(line) if hello.get("orientation") is True else None,
        trips=HostTrips(line),
        halt=line.hang_up,
        untraced=str(hello.get("untraced") or ""),
        samples=HostSamples(line, hello) if hello.get("samples") else None,
        wakeup=HostWakeup(line, line.bell) if line.bell is not None else None,
        unknown=line.unknown,
        touch=HostTouch(line) if hello.get("touch") is True else None,
    )


def _flags(value: object) -> dict[str, bool]:
    return {name: on is True for name, on in value.items()} if isinstance(value, dict) else {}


# --- The hands at a station that lives in the driver host: the simulated one, or the one on the screen.


class HostHands(PostedHands):
    """Any thread may act; what an act means stands at ``app.desk.station_hands.StationPanel``."""

    def __init__(self, line: Line) -> None:
        self._line = line

    def set_input(self, name: str, on: bool) -> None:
        """Make an input of a simulated machine true or false, at once. Raises DriverError."""
        self._line.ask(_act("set_input", name, on))

    def post(self, name: str, *values: object) -> None:
        """Use the method of this name at the station."""
        self._line.post(_act(name, *values))


def _act(name: str, *values: object) -> Message:
    return Message({"do": "hand", "name": name, "values": list(values)}, NOTHING)
