"""The smallest driver that the contract accepts. Copy this file to begin a driver.

``Board`` is the controller at the other end of the cable, here simulated. A driver talks to a real one
instead. ``BoardAxes``, ``BoardSpindle``, ``BoardIO`` and ``board_ports`` are the driver: they belong in
``drivers/NAME/``. ``Skeleton`` is the test rig, and stays in this folder.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import ClassVar

from app.compose.backends.simulated_backend import create_sim_config
from app.compose.machine.machine_files import load_machine
from core.message import Message
from core.ports import (
    ALL_UNKNOWN_PARTS,
    AxisSample,
    Clock,
    DriverError,
    Fault,
    MachinePorts,
    MotionSegments,
    StopMode,
    UnknownPart,
)
from drivers.operator_station import OnScreenStation
from drivers.setpoint_queue import JunctionTolerance, SetpointQueue, check_setpoint_limits
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_terminals import SimulatedTerminals
from drivers.simulators.spindle_motor import SpindleMotor
from drivers.wakeups import ManualClock
from tests.drivers.contract import rig
from tests.drivers.contract.simulated import unhomed, with_probe
from tests.drivers.contract.world import Readings

NEVER = float("inf")
HOMING = 0.3  # s that the board needs to home an axis


class Board:
    """A board with step drives, a spindle and terminals. Without its cable it switches everything off."""

    def __init__(self, config: SimConfig) -> None:
        self.place = (0.0,) * len(config.axes)  # mm or degrees, counted in steps
        self.powered = self.estop = self.cut = False
        self.motor = SpindleMotor(config.spindle)
        self.terminals = SimulatedTerminals(config.outputs, config.inputs, config.collet, config.random_seed)

    def switch_off(self, now: float) -> None:
        """Remove the power of the axes and the spindle."""
        self.powered = False
        self.motor.remove_power(now)


class BoardAxes:
    """``core.ports.AxisSink``: a queue of setpoints in this computer. All calls come from one thread."""

    def __init__(self, config: SimConfig, clock: Clock, board: Board) -> None:
        self.axes = tuple(axis.name for axis in config.axes)
        self.commit = config.commit_time_s
        self.now = clock.now
        self.fault = ""
        self._config, self._board = config, board
        self._queue = SetpointQueue(
            self.axes, board.place, config.commit_time_s, JunctionTolerance.from_axes(config.axes)
        )
        self._homed = [axis.absolute for axis in config.axes]
        self._homing: tuple[int, float] | None = None  # axis, and when the board has homed it
        self._off_at = NEVER

    def poll(self) -> float:
        """Send the setpoint that is due, and return the time. A real driver does this in its own loop."""
        now, board = self.now(), self._board
        if board.cut and not self.fault:
            self.fault = Fault("the board does not respond; check its cable", "controller-lost")
        if board.powered:
            board.place = self._queue.get_commanded_state(min(now, self._off_at))[0]
            if now >= self._off_at:
                board.powered = False
        if not board.powered:
            self._power_lost()
        elif self._homing is not None and now >= self._homing[1]:
            self._reference(self._homing[0])
        return now

    def horizon(self) -> float:
        """Return the end of the last motion in the queue."""
        return self._queue.get_end_time(self.poll())

    def splice(self, segments: MotionSegments) -> None:
        """Queue setpoints. Raises DriverError."""
        now = self.poll()
        self._need_power()
        check_setpoint_limits(segments, self._config.axes, self._homed)
        self._queue.splice_segments(segments, now)

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued position and velocity at ``t``."""
        self.poll()
        return self._queue.get_commanded_state(time_s)

    def sample(self) -> AxisSample:
        """Return the counted position; a step drive does not report a following error."""
        now, place = self.poll(), self._board.place
        return AxisSample(
            t=now,
            demand=place,
            actual=place,
            following_error=(0.0,) * len(place),
            enabled=self._board.powered,
            homed=tuple(self._homed),
            moving=any(self._queue.get_commanded_state(now)[1]) or self._homing is not None,
            fault=self.fault,
        )

    def enable(self, is_on: bool) -> None:
        """Switch the drives. Raises DriverError in E-stop and after a fault."""
        self.poll()
        if is_on and self._board.estop:
            raise DriverError("the drives stay off while the E-stop is pressed", "no-power")
        if is_on and self.fault:
            raise DriverError(self.fault)
        self._board.powered = is_on
        self.poll()

    def stop(self, mode: StopMode) -> None:
        """Brake, or remove the power at once."""
        now = self.poll()
        self._homing = None
        if mode is StopMode.OFF:
            self.enable(False)
        elif self._board.powered:
            ends = self._queue.brake_to_rest(now, [axis.amax for axis in self._config.axes])
            if mode is StopMode.RAMP_OFF:
                self._off_at = ends

    def home(self, axis: str) -> None:
        """Make the board home one axis. Raises DriverError."""
        if axis not in self.axes:
            raise DriverError(Message("axis {axis} does not exist", axis=f"{axis!r}"), reason="no-axis")
        now, n = self.poll(), self.axes.index(axis)
        self._need_power()
        if not self._config.axes[n].absolute:
            self._homing = (n, now + HOMING)

    def clear_fault(self) -> None:
        """Clear the fault if the board responds again."""
        if not self._board.cut:
            self.fault = ""

    def _need_power(self) -> None:
        if self.fault:
            raise DriverError(self.fault)
        if not self._board.powered or self._off_at < NEVER:
            raise DriverError("the drives are off; switch them on first", "power-lost")
        if self._homing is not None:
            raise DriverError("an axis is homing; wait until it is at rest", reason="homing")

    def _power_lost(self) -> None:
        """Forget the setpoints, and the home of each axis that only counts."""
        self._queue.reset_to_position(self._board.place)
        self._homed = [axis.absolute for axis in self._config.axes]
        self._homing, self._off_at = None, NEVER

    def _reference(self, homed: int) -> None:
        self._board.place = tuple(0.0 if n == homed else p for n, p in enumerate(self._board.place))
        self._queue.reset_to_position(self._board.place)
        self._homed[homed], self._homing = True, None


class BoardSpindle:
    """``core.ports.Spindle`` without an encoder: threads are rejected before the start."""

    def __init__(self, axes: BoardAxes, board: Board, rpm_max: float) -> None:
        self._axes, self._board, self._rpm_max = axes, board, rpm_max

    def set_speed(self, rpm: float) -> None:
        """Turn, M03 is positive. Raises DriverError in E-stop and after a fault, except for 0."""
        now = self._axes.poll()
        if rpm and (self._board.estop or self._axes.fault):
            raise DriverError("the spindle stays off: E-stop or fault", "spindle-off")
        self._board.motor.command_speed(now, min(max(rpm, -self._rpm_max), self._rpm_max))

    def start_coasting(self) -> None:
        """Remove the torque."""
        self._board.motor.command_speed(self._axes.poll(), 0.0, should_coast=True)

    def speed(self) -> float:
        """Return the speed, rpm."""
        self._board.motor.advance_to(self._axes.poll())
        return self._board.motor.speed

    def read_angle(self) -> None:
        """Return no angle."""

    def read_fault(self) -> str:
        """Return the fault of the inverter, of which this board knows nothing."""
        return ""


class BoardIO:
    """``core.ports.DigitalIO`` at the terminals of the board."""

    def __init__(self, axes: BoardAxes, board: Board) -> None:
        self._axes, self._terminals = axes, board.terminals

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs."""
        return self._terminals.read_inputs(self._axes.poll())

    def get_outputs(self) -> Mapping[str, bool]:
        """Return all outputs."""
        return dict(self._terminals.output_states)

    def write(self, name: str, is_on: bool) -> None:
        """Switch an output. Raises DriverError for a name that the machine file does not have."""
        self._terminals.write(name, is_on, self._axes.poll())

    def switch_to_safe_state(self) -> None:
        """Switch every output to its safe state."""
        self._terminals.switch_to_safe_state(self._axes.poll())


def board_ports(config: SimConfig, clock: Clock, board: Board) -> MachinePorts:
    """Return the ports of a machine whose operator station is on the screen."""
    axes = BoardAxes(config, clock, board)
    io = BoardIO(axes, board)
    return MachinePorts(
        clock=clock,
        axes=axes,
        spindle=BoardSpindle(axes, board, config.spindle.max_rpm),
        io=io,
        station=OnScreenStation(clock, io.inputs),
        unknown=lambda: ALL_UNKNOWN_PARTS if board.cut else frozenset[UnknownPart](),
    )


# --- The rig: the same machine for the tests of the contract.


class BoardWorld:
    """The machine at the board, and the operator at it."""

    def __init__(self, ports: MachinePorts, board: Board) -> None:
        self._ports, self._board = ports, board
        assert isinstance(ports.station, OnScreenStation)
        self.press_start, self.press_hold = ports.station.press_start, ports.station.press_hold
        self.release_hold, self.set_feed_pot = ports.station.release_hold, ports.station.set_feed_pot
        self.set_spindle_auto = ports.station.set_spindle_auto
        self.set_input = board.terminals.set_input

    def place(self) -> tuple[float, float]:
        """Return X and Z, mm."""
        x, z, *_ = self._ports.axes.sample().actual
        return x, z

    def rpm(self) -> float:
        """Return the speed of the motor."""
        return self._ports.spindle.speed()

    def outputs(self) -> Readings:
        """Return the states of all outputs."""
        return dict(self._board.terminals.output_states)

    def press_estop(self) -> None:
        """Open the chain: the relay removes the power."""
        self._ports.axes.sample()
        self._board.estop = True
        self._board.switch_off(self._ports.clock.now())
        self.set_input("estop", True)

    def release_estop(self) -> None:
        """Close the chain."""
        self._board.estop = False
        self.set_input("estop", False)

    def open_collet(self) -> None:
        """Open it by hand."""
        self._board.terminals.is_collet_sensor_stuck = True
        self.set_input("collet_closed", False)

    def silence_station(self) -> None:
        """Raise: the station has no cable."""
        raise NotImplementedError

    def spindle_ignores_stop(self) -> None:
        """Make the inverter ignore stops."""
        self._board.motor.faults.is_stop_ignored = True

    def spindle_dies(self) -> None:
        """Make the belt slip."""
        self._board.motor.faults.speed_fraction = 0.3


_SIMULATED = "the simulated board is in this process: its cable can only be cut"


class Skeleton(rig.Rig):
    """The board on a clock that the test moves."""

    faults: ClassVar[Mapping[str, rig.Fault]] = {
        "cable out": rig.Fault(0.02, 0.02, "controller-lost", "cable", unknown=ALL_UNKNOWN_PARTS)
    }
    missing: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(("silence", "garbage", "late answers", "node reboot", "bus-off"), _SIMULATED),
        **dict.fromkeys(("dead reader", "two masters"), _SIMULATED),
        "blocks": "its motion is planned here",
        "slides": "step drives do not report their position",
        "station": "its buttons are on the screen",
    }
    hold = 0.15

    def __init__(self, *, homing: bool = False) -> None:
        machine = with_probe(load_machine(None))
        self.machine = unhomed(machine) if homing else machine
        config, self.clock = create_sim_config(self.machine), ManualClock()
        self.board = Board(config)
        self.ports = board_ports(config, self.clock, self.board)
        self.world = BoardWorld(self.ports, self.board)

    def alone(self, dt: float) -> None:
        """Let time pass."""
        self.clock.advance(dt)

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """Return how each fault is caused."""
        return {"cable out": self._pull}

    def _pull(self) -> None:
        self.ports.axes.sample()
        self.board.cut = True
        self.board.switch_off(self.clock.now())
        self.board.terminals.switch_to_safe_state(self.clock.now())

    def switch_output(self, name: str, on: bool) -> None:
        """Switch an output by hand."""
        self.board.terminals.output_states[name] = on

    def mend(self) -> None:
        """Connect the cable."""
        self.board.cut = False

    def close(self) -> None:
        """Close nothing."""
