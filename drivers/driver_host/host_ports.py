"""Ports and station controls on the control's side, which send messages to the driver host."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from core.faults import DriverHostTrip
from core.ports import (
    AxisSample,
    Cam,
    DriverError,
    FloatArray,
    GearState,
    MachinePorts,
    MotionSegments,
    StationState,
    StopMode,
    TouchLatch,
)
from drivers.driver_host.host_connection import HostConnection
from drivers.driver_host.host_messages import (
    NO_NUMBERS,
    Message,
    encode_cam,
    flatten_segments,
    number,
    parse_floats,
    parse_list,
    parse_strings,
    read_fault,
)
from drivers.operator_station import PostedControls
from drivers.wakeups import ProcessWakeup


class _HostPort:
    """The base class of ports that use a connection to the driver host."""

    def __init__(self, connection: HostConnection) -> None:
        self._line = connection


class HostAxes(_HostPort):
    """Axis port (``core.ports.AxisSink``) that sends its calls to the driver host."""

    def __init__(self, connection: HostConnection, properties: Mapping[str, object]) -> None:
        super().__init__(connection)
        self.axes = tuple(parse_strings(properties.get("axes")))
        self.commit = number(properties, "commit")

    def now(self) -> float:
        """Return the time of the machine's clock in seconds, which is the same in both processes."""
        return self._line.clock.now()

    def horizon(self) -> float:
        """Return the end time of the setpoint queue in seconds."""
        return number(self._line.send_request(Message({"do": "horizon"}, NO_NUMBERS)).header, "value")

    def splice(self, segments: MotionSegments) -> None:
        """Splice setpoints into the queue.

        Raises DriverError if the driver rejects the setpoints.
        """
        self._line.send_request(Message({"do": "splice"}, flatten_segments(segments)))

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at ``time_s``."""
        numbers = self._line.send_request(Message({"do": "demand", "t": time_s}, NO_NUMBERS)).numbers.tolist()
        half = len(self.axes)
        return tuple(numbers[:half]), tuple(numbers[half:])

    def sample(self) -> AxisSample:
        """Return the current state of the axes.

        A lost driver host is a fault of all axes.
        """
        raw = self._line.poll_state(is_forced=True).get("sample")
        shown = raw if isinstance(raw, dict) else {}
        none = (0.0,) * len(self.axes)
        return AxisSample(
            t=number(shown, "t") if shown else self.now(),
            demand=parse_floats(shown.get("demand", none)),
            actual=parse_floats(shown.get("actual", none)),
            following_error=parse_floats(shown.get("following_error", none)),
            enabled=shown.get("enabled") is True and not self._line.is_host_unavailable,
            homed=tuple(one is True for one in parse_list(shown.get("homed"))) or (False,) * len(self.axes),
            moving=shown.get("moving") is True and not self._line.is_host_unavailable,
            fault=self._line.fault or read_fault(shown, "fault", "axis"),
        )

    def enable(self, is_on: bool) -> None:
        """Switch the drives on or off."""
        self._line.send_command("enable", on=is_on)

    def stop(self, mode: StopMode) -> None:
        """Stop the axes in the given stop mode; the drives perform the stop."""
        self._line.send_command("stop", how=mode.value)

    def home(self, axis: str) -> None:
        """Start homing an axis."""
        self._line.send_command("home", name=axis)

    def clear_fault(self) -> None:
        """Clear the fault, or restart a lost driver host.

        Raises DriverError if the fault cannot be cleared.
        """
        if self._line.fault:
            self._line.restart_host()
        else:
            self._line.send_command("clear_fault")


class HostSpindleGear(_HostPort):
    """Port for axes that follow the spindle (``core.ports.SpindleGear``), via the driver host."""

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle on a cam, a path over spindle revolutions.

        Raises DriverError if the driver rejects the cam.
        """
        self._line.send_request(encode_cam(cam))

    def geared(self) -> GearState | None:
        """Return the position of the axes on the cam, or None if they do not follow the spindle."""
        shown = self._line.poll_state(is_forced=True).get("geared")
        return None if shown is None or self._line.is_host_unavailable else GearState(*parse_floats(shown))


class HostSpindle(_HostPort):
    """Spindle port (``core.ports.Spindle``) that sends its calls to the driver host."""

    def set_speed(self, rpm: float) -> None:
        """Run the spindle at the signed speed ``rpm``."""
        self._line.send_command("run", rpm=rpm)

    def start_coasting(self) -> None:
        """Remove the torque, so that the spindle coasts to a stop."""
        self._line.send_command("coast")

    def speed(self) -> float:
        """Return the measured speed in rpm, or 0 if it is unknown."""
        shown = self._line.poll_state()
        return number(shown, "speed") if shown else 0.0

    def get_line_delay(self) -> float:
        """Return the delay in seconds of commands and speeds on the line to the spindle drive."""
        shown = self._line.poll_state()
        return number(shown, "spindle_lag") if shown else 0.0

    def read_angle(self) -> tuple[float, float] | None:
        """Return the time and the revolutions of the spindle encoder, or None without an encoder."""
        shown = self._line.poll_state().get("angle")
        if shown is None:
            return None
        t, turns = parse_floats(shown)
        return t, turns

    def read_fault(self) -> str:
        """Return the fault of the spindle, or an empty string if there is no fault."""
        return self._line.fault or read_fault(self._line.poll_state(), "spindle", "spindle")


class HostWakeup(_HostPort):
    """Port through which the driver host wakes a sleeping control (``core.ports.WakeupSignal``).

    While the control sleeps, the driver host polls the drivers.
    """

    def __init__(self, connection: HostConnection, wakeup_bell: ProcessWakeup) -> None:
        super().__init__(connection)
        self._bell = wakeup_bell
        self.request_poll = wakeup_bell.send_wakeup

    def can_rely_on_wakeups(self) -> bool:
        """Return whether the control may sleep, because the driver host reports each change."""
        return not self._line.is_host_unavailable

    def wait_for_wakeup(self, seconds: float) -> bool:
        """Wait for a wake-up or the end of the driver host, and return whether either occurred."""
        try:
            self._line.enter_sleep()
        except DriverError:
            return True  # The next poll has the reason.
        rung = self._bell.wait_for_wakeup(seconds, self._line.disconnect_file_descriptors)
        if rung:
            self._line.leave_sleep()
        return rung


class HostSampleSource(_HostPort):
    """Scope samples (``core.ports.SampleSource``) that the driver host adds to its poll replies."""

    def __init__(self, connection: HostConnection, properties: Mapping[str, object]) -> None:
        super().__init__(connection)
        self.sample_rate_hz = number(properties, "samples")
        self._width = 5 + 3 * len(parse_strings(properties.get("axes")))

    def take_samples(self, max_rows: int = 8192) -> FloatArray:  # noqa: ARG002  an answer has few enough
        """Return the samples since the last call.

        Batches of the wrong length are ignored.
        """
        waiting = self._line.sample_batches
        batches = [waiting.popleft() for _ in range(len(waiting))]
        whole = [rows.reshape(-1, self._width) for rows in batches if not len(rows) % self._width]
        return np.concatenate(whole) if whole else np.empty((0, self._width))


class HostSpindleCAxis(_HostPort):
    """Port for the spindle drive as C axis (``core.ports.SpindleCAxis``), via the driver host."""

    def set_c_mode(self, is_enabled: bool, should_orient: bool = False) -> None:
        """Engage the spindle drive as the C axis, or release it."""
        self._line.send_command("hold", on=is_enabled, orient=should_orient)

    def is_c_ready(self) -> bool:
        """Return whether the C axis may move."""
        return self._line.poll_state().get("held") is True and not self._line.is_host_unavailable


class HostOrientingSpindle(_HostPort):
    """Port that orients the spindle (``core.ports.OrientingSpindle``), via the driver host."""

    def orient_spindle(self, angle: float, direction: int = 0) -> None:
        """Orient the spindle to an angle in degrees."""
        self._line.send_command("orient", angle=angle, sense=direction)

    def release_spindle(self) -> None:
        """Cancel the orientation of the spindle."""
        self._line.send_command("release")

    def is_oriented(self) -> bool:
        """Return whether the spindle is at the commanded angle.

        After a loss of the driver host, this is the last known state.
        """
        return self._line.poll_state().get("oriented") is True


class HostIO(_HostPort):
    """Input and output port (``core.ports.DigitalIO``) that sends its calls to the driver host."""

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs by name."""
        return _flags(self._line.poll_state().get("inputs"))

    def get_outputs(self) -> Mapping[str, bool]:
        """Return all outputs by name."""
        return _flags(self._line.poll_state().get("outputs"))

    def write(self, name: str, is_on: bool) -> None:
        """Switch one output on or off."""
        self._line.send_command("write", name=name, on=is_on)

    def switch_to_safe_state(self) -> None:
        """Set every output to its safe state."""
        self._line.send_command("safe")


class HostStation(_HostPort):
    """Operator station (``core.ports.OperatorStation``) as the driver host last reported it."""

    def read_state(self) -> StationState:
        """Return the current state of the station.

        After a loss of the driver host, no button is pressed and the age is inf.
        """
        shown = self._line.poll_state().get("station")
        if self._line.is_host_unavailable or not isinstance(shown, dict):
            return StationState(age=float("inf"))
        return StationState(**shown)


class HostTouchInput(_HostPort):
    """Probe port (``core.ports.TouchInput``) that reads the touches latched by the driver host."""

    def arm_latch(self) -> None:
        """Clear the latched touch, so that the next touch is latched."""
        self._line.send_command("arm")

    def read_latch(self) -> TouchLatch | None:
        """Return the first touch since ``arm_latch``, or None without a touch."""
        shown = self._line.poll_state().get("latch")
        if shown is None or self._line.is_host_unavailable:
            return None
        t, place, late = parse_list(shown)
        (t_s, late_s) = parse_floats([t, late])
        return TouchLatch(t_s, parse_floats(place), late_s)


class HostTripMonitor(_HostPort):
    """Port that reads and acknowledges trips of the driver host (``core.faults.TrippingDriverHost``)."""

    def get_active_trip(self) -> DriverHostTrip | None:
        """Return the unacknowledged trip with the functions that it switched off, or None."""
        shown = self._line.poll_state().get("trip")
        if shown is None:
            return None
        count, away, spindle, outputs, found = parse_list(shown)
        (away_s,) = parse_floats([away])
        (number_,) = parse_floats([count])
        return DriverHostTrip(
            int(number_), away_s, spindle is True, tuple(parse_strings(outputs)), found is True
        )

    def acknowledge_trip(self, trip: DriverHostTrip) -> None:
        """Acknowledge a trip, so that the machine may continue."""
        self._line.send_command("acknowledge", number=trip.trip_number)


def create_host_ports(connection: HostConnection) -> MachinePorts:
    """Return the ports of the driver host.

    Raises DriverError if the driver host does not reply, or uses another version of the protocol.
    """
    hello, spindle = connection.read_host_properties(), HostSpindle(connection)
    return MachinePorts(
        clock=connection.clock,
        axes=HostAxes(connection, hello),
        spindle=spindle,
        spindle_lag=spindle.get_line_delay,
        io=HostIO(connection),
        station=HostStation(connection),
        warnings=tuple(parse_strings(hello.get("warnings"))),
        gear=HostSpindleGear(connection) if hello.get("gear") is True else None,
        lock=HostSpindleCAxis(connection) if hello.get("lock") is True else None,
        orientation=HostOrientingSpindle(connection) if hello.get("orientation") is True else None,
        trip_monitor=HostTripMonitor(connection),
        halt_machine=connection.disconnect,
        untraced=str(hello.get("untraced") or ""),
        samples=HostSampleSource(connection, hello) if hello.get("samples") else None,
        wakeup=HostWakeup(connection, connection.wakeup_bell) if connection.wakeup_bell is not None else None,
        unknown=connection.find_unknown_parts,
        touch=HostTouchInput(connection) if hello.get("touch") is True else None,
    )


def _flags(value: object) -> dict[str, bool]:
    return {name: on is True for name, on in value.items()} if isinstance(value, dict) else {}


# --- Controls of a station in the driver host: the simulated one, or the one on the screen.


class HostStationControls(PostedControls):
    """Station controls whose actions are sent to the driver host, from any thread.

    ``app.desk.station_controls.StationPanel`` describes the actions.
    """

    def __init__(self, connection: HostConnection) -> None:
        self._line = connection

    def set_input(self, name: str, on: bool) -> None:
        """Set an input of a simulated machine immediately.

        Raises DriverError if the driver host rejects the action.
        """
        self._line.send_request(_act("set_input", name, on))

    def post_action(self, name: str, *values: object) -> None:
        """Send the name of a station method and its arguments, without waiting for a reply."""
        self._line.post_message(_act(name, *values))


def _act(name: str, *values: object) -> Message:
    return Message({"do": "hand", "name": name, "values": list(values)}, NO_NUMBERS)
