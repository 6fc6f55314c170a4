"""Simulated CiA 402 drive of the spindle: velocity mode, and position modes where the spindle is also C."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_objects import HM, IP, NEW, PV, REACHED, DriveState
from drivers.canopen.drive_profiles import CIA402, DriveProfile
from drivers.simulators.canopen_axis_drive import AxisDrive
from drivers.simulators.plant_config import SimAxis
from drivers.simulators.servo_axis import Servo
from drivers.simulators.spindle_motor import SpindleMotor

EMCY_FAULT = 0x7120  # motor blocked
_INDEX = (33, 34)
_TURN = 360.0


class SpindleSlide(Servo):
    """Spindle as an axis in degrees that follows its setpoints exactly and homes on its index."""

    def __init__(self, axis: SimAxis, motor: SpindleMotor) -> None:
        super().__init__(axis)
        self._motor = motor
        self._zero = 0.0  # Motor angle in degrees at count 0.
        self.offset = 0.0  # Position in degrees after homing.

    @property
    def place(self) -> float:
        """The angle in degrees in the count of the drive."""
        return self._motor.turns * _TURN - self._zero

    def adopt(self) -> None:
        """Take over the motor's angle after the spindle has turned."""
        self.p, self.v = self.place, 0.0

    def seek(self, method: int) -> None:
        """Set the home position: the next index for an index method, otherwise the present position."""
        ahead = (math.floor(self._motor.turns + 1e-9) + 1) * _TURN - self._zero
        self.switch = ahead if method in _INDEX else self.p

    def follow(self, p: float, v: float, _dt: float) -> bool:
        """Move the spindle exactly to setpoint ``p``, ``v``; never trip."""
        self.p, self.v = p, v
        self._motor.turns = (p + self._zero) / _TURN
        return False

    def roll(self, _dt: float) -> None:
        """Do nothing, because the spindle motor advances separately."""

    def reference(self) -> None:
        """Make ``offset`` the count at the present position."""
        self._zero += self.p - self.offset
        self.p = self.offset


class SpindleDrive:
    """Simulated spindle drive; ``step`` is called with the time of the plant."""

    def __init__(
        self,
        motor: SpindleMotor,
        counts: int,
        emergency: Callable[[int], None],
        axis: SimAxis | None = None,
        profile: DriveProfile = CIA402,
    ) -> None:
        self.motor = motor
        self.emergency = emergency
        self.positions = axis is not None
        made = axis or SimAxis("C", 1.0, 1.0, 1.0, 1.0, 1.0)
        made = replace(made, count=_TURN / max(counts, 1))
        self.slide = SpindleSlide(made, motor)
        self.axis = AxisDrive(self.slide, emergency, profile, counts)
        self.power = self.axis.power
        self.mode = 0
        self.target = 0
        self._counts = counts
        self._ordered: int | None = None
        self.at = 0.0  # time of the last step, s
        self.values: dict[tuple[int, int], int] = {}
        self._readers: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020192,
            od.SUPPORTED: lambda: 0x64 if self.positions else 0x04,
            od.STATUS: lambda: self.axis.status() if self.as_axis else self.power.word | self._reached(),
            od.MODE_SHOWN: lambda: self.mode,
            od.VELOCITY: lambda: round(self.slide.v / 6.0 if self.as_axis else self.motor.speed),
            od.TORQUE: lambda: 0 if self.as_axis else round(10.0 * self.motor.load),
            od.POSITION: self._position,
        }

    @property
    def as_axis(self) -> bool:
        """Whether the mode of operation is interpolated position or homing."""
        return self.mode in {IP, HM}

    def read(self, index: int, _sub: int) -> int | None:
        """Return the value of an object that the drive calculates, or None if the stored value applies."""
        reader = self._readers.get(index)
        return None if reader is None else reader()

    def _position(self) -> int:
        counted = self.slide.place / _TURN * self._counts
        return (round(counted) + 2**31) % 2**32 - 2**31

    def _reached(self) -> int:
        return REACHED if abs(self.motor.speed - self.target) < 10 else 0

    def write(self, index: int, sub: int, value: int) -> None:
        """Apply an object value that the host has written."""
        self.values[index, sub] = value
        if index == od.MODE:
            self._change(value)
        elif index == od.TARGET_SPEED:
            self.target = value
        elif index != od.CONTROL:
            self.axis.write(index, sub, value)
        elif self.as_axis:
            if self.mode == HM and value & NEW and not self.power.last & NEW:
                self.slide.offset = self.values.get((od.HOME_OFFSET, 0), 0) * _TURN / self._counts
                self.slide.seek(self.values.get((od.HOME_METHOD, 0), 0))
            self.axis.write(index, sub, value)
        else:
            self.power.control(value)

    def _change(self, mode: int) -> None:
        """Change the mode of operation, only at standstill and while no positions are played."""
        if mode == self.mode or abs(self.motor.speed) > 1.0 or self.axis.playing:
            return
        self.mode = mode
        self.axis.write(od.MODE, 0, mode)
        if self.as_axis:
            self.slide.adopt()
            self.axis.p, self.axis.v = self.slide.p, 0.0

    def host_lost(self) -> None:
        """Quick stop after the loss of the host if the abort connection option is 3."""
        if self.values.get((od.ABORT_OPTION, 0), 0) == 3:
            self.power.quick_stop()

    def reset(self) -> None:
        """Clear power, mode, target and all stored values."""
        self.axis.reset()
        self.mode = self.target = 0
        self.values.clear()

    @property
    def rests(self) -> bool:
        """Whether further steps change nothing until a frame arrives or the motor's speed changes."""
        obeyed = self.power.powered == (self._ordered is not None)
        return obeyed and not self.as_axis and not self.power.braking

    def step(self, now: float) -> None:
        """Command the motor's speed by mode and power state, and end braking at standstill."""
        dt, self.at = now - self.at, now
        if self.motor.faults.fault and self.power.state is not DriveState.FAULT:
            self.power.trip()
            self.emergency(EMCY_FAULT)
        if self.as_axis:
            self.axis.step(dt)
            self._ordered = None
            return
        wanted = self.target if self.power.state is DriveState.ENABLED and self.mode == PV else 0
        if not self.power.powered:
            if self._ordered is not None:
                self.motor.cut(now)
                self._ordered = None
        elif wanted != self._ordered:
            self.motor.order(now, float(wanted))
            self._ordered = wanted
        if self.power.braking and abs(self.motor.speed) < 1.0:
            self.power.stopped()
