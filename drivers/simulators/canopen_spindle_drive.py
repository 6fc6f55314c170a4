"""Simulated CiA 402 drive of the spindle, with a velocity mode.

If the spindle is also the C axis, the drive has position modes too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_objects import HM, IP, NEW, PV, REACHED, DriveState
from drivers.canopen.drive_profiles import CIA402_PROFILE, DriveProfile
from drivers.simulators.canopen_axis_drive import AxisDrive
from drivers.simulators.plant_config import SimAxis
from drivers.simulators.servo_axis import SimulatedServo
from drivers.simulators.spindle_motor import SpindleMotor

EMCY_FAULT = 0x7120  # motor blocked
_INDEX = (33, 34)
_DEGREES_PER_REV = 360.0


class SpindleServo(SimulatedServo):
    """Spindle as a rotary axis in degrees; it follows its setpoints exactly and homes on its index."""

    def __init__(self, axis: SimAxis, motor: SpindleMotor) -> None:
        super().__init__(axis)
        self._motor = motor
        self._zero = 0.0  # Motor angle in degrees at count 0.
        self.offset = 0.0  # Position in degrees after homing.

    @property
    def place(self) -> float:
        """Return the angle in degrees, as the drive counts it."""
        return self._motor.revolutions * _DEGREES_PER_REV - self._zero

    def copy_motor_angle(self) -> None:
        """Set the axis position to the motor angle; call this method after the spindle has turned."""
        self.p, self.v = self.place, 0.0

    def set_home_position(self, homing_method: int) -> None:
        """Set the home position: the next index, or the current position for a method without index."""
        ahead = (math.floor(self._motor.revolutions + 1e-9) + 1) * _DEGREES_PER_REV - self._zero
        self.switch = ahead if homing_method in _INDEX else self.p

    def follow_setpoint(self, position: float, velocity: float, _dt: float) -> bool:
        """Move the spindle exactly to ``position`` with ``velocity``, and return False.

        False means no trip: the simulated spindle never trips because of a following error.
        """
        self.p, self.v = position, velocity
        self._motor.revolutions = (position + self._zero) / _DEGREES_PER_REV
        return False

    def roll(self, _dt: float) -> None:
        """Do nothing, because the spindle motor advances separately."""

    def reference(self) -> None:
        """Set the count so that the current position is ``offset`` degrees."""
        self._zero += self.p - self.offset
        self.p = self.offset


class SimulatedSpindleDrive:
    """Simulated spindle drive; ``advance`` must be called with the time of the plant."""

    def __init__(
        self,
        motor: SpindleMotor,
        counts_per_rev: int,
        send_emergency: Callable[[int], None],
        axis: SimAxis | None = None,
        profile: DriveProfile = CIA402_PROFILE,
    ) -> None:
        self.motor = motor
        self.send_emergency = send_emergency
        self.can_position = axis is not None
        made = axis or SimAxis("C", 1.0, 1.0, 1.0, 1.0, 1.0)
        made = replace(made, count=_DEGREES_PER_REV / max(counts_per_rev, 1))
        self.spindle_servo = SpindleServo(made, motor)
        self.axis_drive = AxisDrive(self.spindle_servo, send_emergency, profile, counts_per_rev)
        self.power_states = self.axis_drive.power_states
        self.operation_mode = 0
        self.target_rpm = 0
        self._counts = counts_per_rev
        self._ordered: int | None = None
        self.last_step_s = 0.0  # time of the last step, s
        self.values: dict[tuple[int, int], int] = {}
        self._readers: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020192,
            od.SUPPORTED: lambda: 0x64 if self.can_position else 0x04,
            od.STATUS: lambda: (
                self.axis_drive.get_status_word()
                if self.is_in_axis_mode
                else self.power_states.status_word | self._reached()
            ),
            od.MODE_SHOWN: lambda: self.operation_mode,
            od.VELOCITY: lambda: round(
                self.spindle_servo.v / 6.0 if self.is_in_axis_mode else self.motor.speed
            ),
            od.ACTUAL_TORQUE: lambda: 0 if self.is_in_axis_mode else round(10.0 * self.motor.load_percent),
            od.POSITION: self._position,
        }

    @property
    def is_in_axis_mode(self) -> bool:
        """Return whether the drive is in interpolated position mode or homing mode."""
        return self.operation_mode in {IP, HM}

    def read(self, index: int, _sub: int) -> int | None:
        """Return the calculated value of an object, or None if the stored value is to be used."""
        reader = self._readers.get(index)
        return None if reader is None else reader()

    def _position(self) -> int:
        counted = self.spindle_servo.place / _DEGREES_PER_REV * self._counts
        return (round(counted) + 2**31) % 2**32 - 2**31

    def _reached(self) -> int:
        return REACHED if abs(self.motor.speed - self.target_rpm) < 10 else 0

    def write(self, index: int, subindex: int, value: int) -> None:
        """Apply a value that the host has written to an object."""
        self.values[index, subindex] = value
        if index == od.MODE:
            self._change_mode(value)
        elif index == od.TARGET_SPEED:
            self.target_rpm = value
        elif index != od.CONTROL:
            self.axis_drive.write(index, subindex, value)
        elif self.is_in_axis_mode:
            if self.operation_mode == HM and value & NEW and not self.power_states.last_control_word & NEW:
                self.spindle_servo.offset = (
                    self.values.get((od.HOME_OFFSET, 0), 0) * _DEGREES_PER_REV / self._counts
                )
                self.spindle_servo.set_home_position(self.values.get((od.HOME_METHOD, 0), 0))
            self.axis_drive.write(index, subindex, value)
        else:
            self.power_states.apply_control_word(value)

    def _change_mode(self, mode: int) -> None:
        """Change the mode of operation if the spindle is at standstill and executes no setpoints."""
        if mode == self.operation_mode or abs(self.motor.speed) > 1.0 or self.axis_drive.is_playing:
            return
        self.operation_mode = mode
        self.axis_drive.write(od.MODE, 0, mode)
        if self.is_in_axis_mode:
            self.spindle_servo.copy_motor_angle()
            self.axis_drive.setpoint_position, self.axis_drive.setpoint_velocity = self.spindle_servo.p, 0.0

    def handle_host_loss(self) -> None:
        """Make a quick stop after the loss of the host, if the abort connection option is 3."""
        if self.values.get((od.ABORT_OPTION, 0), 0) == 3:
            self.power_states.start_quick_stop()

    def reset(self) -> None:
        """Switch the power off, and clear the mode, the target and all stored values."""
        self.axis_drive.reset()
        self.operation_mode = self.target_rpm = 0
        self.values.clear()

    @property
    def is_idle(self) -> bool:
        """Return whether the drive will not change until a frame arrives or the motor speed changes."""
        obeyed = self.power_states.is_powered == (self._ordered is not None)
        return obeyed and not self.is_in_axis_mode and not self.power_states.is_braking

    def advance(self, now: float) -> None:
        """Command the motor speed that the mode and power state require; end braking at standstill."""
        dt, self.last_step_s = now - self.last_step_s, now
        if self.motor.faults.fault_text and self.power_states.state is not DriveState.FAULT:
            self.power_states.enter_fault()
            self.send_emergency(EMCY_FAULT)
        if self.is_in_axis_mode:
            self.axis_drive.advance(dt)
            self._ordered = None
            return
        wanted = (
            self.target_rpm
            if self.power_states.state is DriveState.OPERATION_ENABLED and self.operation_mode == PV
            else 0
        )
        if not self.power_states.is_powered:
            if self._ordered is not None:
                self.motor.remove_power(now)
                self._ordered = None
        elif wanted != self._ordered:
            self.motor.command_speed(now, float(wanted))
            self._ordered = wanted
        if self.power_states.is_braking and abs(self.motor.speed) < 1.0:
            self.power_states.end_braking()
