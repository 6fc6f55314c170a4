"""Ports and station controls of the control's side, which send messages to the driver host."""

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
    """Base class of the ports on a connection."""

    def __init__(self, line: Line) -> None:
        self._line = line


class HostAxes(_OnLine):
    """``core.ports.AxisSink`` of the driver host."""

    def __init__(self, line: Line, hello: Mapping[str, object]) -> None:
        super().__init__(line)
        self.axes = tuple(texts(hello.get("axes")))
        self.commit = number(hello, "commit")

    def now(self) -> float:
        """Return the time of the machine's clock in seconds, which is the same in both processes."""
        return self._line.clock.now()

    def horizon(self) -> float:
        """Return the end time of the setpoint queue."""
        return number(self._line.ask(Message({"do": "horizon"}, NOTHING)).head, "value")

    def splice(self, segments: Segments) -> None:
        """Splice setpoints into the queue. Raises DriverError if the driver rejects them."""
        self._line.ask(Message({"do": "splice"}, rows(segments)))

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at time ``t``."""
        numbers = self._line.ask(Message({"do": "demand", "t": t}, NOTHING)).numbers.tolist()
        half = len(self.axes)
        return tuple(numbers[:half]), tuple(numbers[half:])

    def sample(self) -> AxisSample:
        """Return the present state of the axes; a lost driver host is a fault of all axes."""
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
        """Switch the drives on or off."""
        self._line.order("enable", on=on)

    def stop(self, how: Stop) -> None:
        """Stop the axes by the drives."""
        self._line.order("stop", how=how.value)

    def home(self, axis: str) -> None:
        """Start to home an axis."""
        self._line.order("home", name=axis)

    def clear_fault(self) -> None:
        """Clear the fault, or restart a lost driver host. Raises DriverError."""
        if self._line.fault:
            self._line.restart()
        else:
            self._line.order("clear_fault")


class HostGear(_OnLine):
    """``core.ports.Gear`` of the driver host."""

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle. Raises DriverError."""
        self._line.ask(cam_message(cam))

    def geared(self) -> Geared | None:
        """Return the position of the axes on the cam, or None if they do not follow the spindle."""
        shown = self._line.look(anew=True).get("geared")
        return None if shown is None or self._line.lost else Geared(*floats(shown))


class HostSpindle(_OnLine):
    """``core.ports.Spindle`` of the driver host."""

    def run(self, rpm: float) -> None:
        """Turn the spindle at ``rpm``, signed."""
        self._line.order("run", rpm=rpm)

    def coast(self) -> None:
        """Remove the torque."""
        self._line.order("coast")

    def speed(self) -> float:
        """Return the measured speed in rpm, or 0 if it is unknown."""
        shown = self._line.look()
        return number(shown, "speed") if shown else 0.0

    def lag(self) -> float:
        """Return the seconds by which the line to the spindle drive delays commands and speeds."""
        shown = self._line.look()
        return number(shown, "spindle_lag") if shown else 0.0

    def angle(self) -> tuple[float, float] | None:
        """Return a (time, revolutions) pair of the encoder, or None without an encoder."""
        shown = self._line.look().get("angle")
        if shown is None:
            return None
        t, turns = floats(shown)
        return t, turns

    def fault(self) -> str:
        """Return the fault of the spindle, or an empty text."""
        return self._line.fault or fault_of(self._line.look(), "spindle", "spindle")


class HostWakeup(_OnLine):
    """``core.ports.Wakeup`` of the driver host, which polls the drivers and sends wake-ups."""

    def __init__(self, line: Line, bell: Bell) -> None:
        super().__init__(line)
        self._bell = bell
        self.ring = bell.ring

    def settled(self) -> bool:
        """Return whether the driver host sends a wake-up for each change."""
        return not self._line.lost

    def wait(self, seconds: float) -> bool:
        """Wait for a wake-up or the end of the driver host; return whether there was one."""
        try:
            self._line.sleep()
        except DriverError:
            return True  # The next poll has the reason.
        rung = self._bell.wait(seconds, self._line.files)
        if rung:
            self._line.awake()
        return rung


class HostSamples(_OnLine):
    """``core.ports.SampleSource`` of the driver host, whose polls contain the samples."""

    def __init__(self, line: Line, hello: Mapping[str, object]) -> None:
        super().__init__(line)
        self.rate = number(hello, "samples")
        self._width = 5 + 3 * len(texts(hello.get("axes")))

    def take(self, most: int = 8192) -> FloatArray:  # noqa: ARG002  an answer has few enough
        """Return the samples since the last call; batches of the wrong length are ignored."""
        waiting = self._line.sampled
        told = [waiting.popleft() for _ in range(len(waiting))]
        whole = [rows.reshape(-1, self._width) for rows in told if not len(rows) % self._width]
        return np.concatenate(whole) if whole else np.empty((0, self._width))


class HostLock(_OnLine):
    """``core.ports.SpindleHold`` of the driver host."""

    def hold(self, on: bool, orient: bool = False) -> None:
        """Engage the spindle drive as C, or release it."""
        self._line.order("hold", on=on, orient=orient)

    def held(self) -> bool:
        """Return whether C may move."""
        return self._line.look().get("held") is True and not self._line.lost


class HostOrientation(_OnLine):
    """``core.ports.SpindleOrientation`` of the driver host."""

    def orient(self, angle: float, sense: int = 0) -> None:
        """Turn the spindle to an angle in degrees."""
        self._line.order("orient", angle=angle, sense=sense)

    def release(self) -> None:
        """Cancel the orientation."""
        self._line.order("release")

    def oriented(self) -> bool:
        """Return whether the spindle is at the commanded angle; after a loss, the last known state."""
        return self._line.look().get("oriented") is True


class HostIO(_OnLine):
    """``core.ports.DigitalIO`` of the driver host."""

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs by name."""
        return _flags(self._line.look().get("inputs"))

    def outputs(self) -> Mapping[str, bool]:
        """Return all outputs by name."""
        return _flags(self._line.look().get("outputs"))

    def write(self, name: str, on: bool) -> None:
        """Switch one output."""
        self._line.order("write", name=name, on=on)

    def safe(self) -> None:
        """Set every output to its safe state."""
        self._line.order("safe")


class HostStation(_OnLine):
    """``core.ports.Station`` of the driver host."""

    def snapshot(self) -> StationState:
        """Return the present state of the station; after a loss, no button is pressed and the age is inf."""
        shown = self._line.look().get("station")
        if self._line.lost or not isinstance(shown, dict):
            return StationState(age=float("inf"))
        return StationState(**shown)


class HostTouch(_OnLine):
    """``core.ports.TouchInput`` of the driver host."""

    def arm(self) -> None:
        """Clear the latched touch."""
        self._line.order("arm")

    def latched(self) -> Latch | None:
        """Return the first touch since ``arm``, or None."""
        shown = self._line.look().get("latch")
        if shown is None or self._line.lost:
            return None
        t, place, late = items(shown)
        (t_s, late_s) = floats([t, late])
        return Latch(t_s, floats(place), late_s)


class HostTrips(_OnLine):
    """``core.faults.Tripping`` of the driver host."""

    def tripped(self) -> Trip | None:
        """Return the functions that the driver host has switched off since the last acknowledgment.

        The result is None without a trip.
        """
        shown = self._line.look().get("trip")
        if shown is None:
            return None
        count, away, spindle, outputs, found = items(shown)
        (away_s,) = floats([away])
        (number_,) = floats([count])
        return Trip(int(number_), away_s, spindle is True, tuple(texts(outputs)), found is True)

    def acknowledge(self, trip: Trip) -> None:
        """Acknowledge a trip, so that the machine may continue."""
        self._line.order("acknowledge", number=trip.number)


def host_ports(line: Line) -> MachinePorts:
    """Build the ports of the driver host. Raises DriverError without a reply."""
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


# --- Controls of a station in the driver host: the simulated one, or the one on the screen.


class HostHands(PostedHands):
    """Station controls whose actions are sent to the driver host, from any thread.

    ``app.desk.station_hands.StationPanel`` explains the actions.
    """

    def __init__(self, line: Line) -> None:
        self._line = line

    def set_input(self, name: str, on: bool) -> None:
        """Set an input of a simulated machine at once. Raises DriverError."""
        self._line.ask(_act("set_input", name, on))

    def post(self, name: str, *values: object) -> None:
        """Send the name of a station method and its arguments, without waiting."""
        self._line.post(_act(name, *values))


def _act(name: str, *values: object) -> Message:
    return Message({"do": "hand", "name": name, "values": list(values)}, NOTHING)
