"""Simulated CiA 402 drive of an axis, with power states, modes of operation, PVT queue and faults."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable

from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_objects import BIT_12, CSP, HM, IP, NEW, PP, REACHED, DriveState
from drivers.canopen.drive_profiles import CIA402_PROFILE, DriveProfile, RecordFormat
from drivers.canopen.drive_set import unpack_copley_segment, unpack_epos2_record
from drivers.canopen.pvt_mode import interpolate_hermite
from drivers.simulators.servo_axis import SimulatedServo

# --- Power states of a CiA 402 drive with the transitions of the profile.


_STATUS_BITS = {
    DriveState.NOT_READY_TO_SWITCH_ON: 0x00,
    DriveState.SWITCH_ON_DISABLED: 0x40,
    DriveState.READY_TO_SWITCH_ON: 0x21,
    DriveState.SWITCHED_ON: 0x23,
    DriveState.OPERATION_ENABLED: 0x27,
    DriveState.QUICK_STOP_ACTIVE: 0x07,
    DriveState.FAULT_REACTION_ACTIVE: 0x0F,
    DriveState.FAULT: 0x08,
}
_SWITCH_ON_TRANSITIONS = frozenset(
    (
        (0x07, DriveState.READY_TO_SWITCH_ON),
        (0x0F, DriveState.READY_TO_SWITCH_ON),
        (0x07, DriveState.OPERATION_ENABLED),
    )
)
_VOLTAGE, _REMOTE = 0x10, 0x200
_POWERED_STATES = frozenset(
    (DriveState.OPERATION_ENABLED, DriveState.QUICK_STOP_ACTIVE, DriveState.FAULT_REACTION_ACTIVE)
)


class PowerStateMachine:
    """Power state machine of a CiA 402 drive.

    ``is_sto_active`` is the state of the hardware input STO (safe torque off).
    """

    def __init__(self, handle_power_up: Callable[[], None]) -> None:
        self.state = DriveState.SWITCH_ON_DISABLED
        self.last_control_word = 0  # control word
        self.is_sto_active = False
        self.refuses_power = False  # A drive that does not switch on, for tests.
        self._powered_up = handle_power_up

    @property
    def is_powered(self) -> bool:
        """Return whether the drive supplies current to the motor."""
        return self.state in _POWERED_STATES

    @property
    def is_braking(self) -> bool:
        """Return whether the drive is braking to standstill after a quick stop or a fault."""
        return self.state in {DriveState.QUICK_STOP_ACTIVE, DriveState.FAULT_REACTION_ACTIVE}

    @property
    def status_word(self) -> int:
        """Return the status word bits that represent the current state."""
        return _STATUS_BITS[self.state] | _VOLTAGE | _REMOTE

    def apply_control_word(self, word: int) -> None:
        """Apply a control word, which causes at most one transition of the CiA 402 state machine."""
        rising = word & 0x80 and not self.last_control_word & 0x80
        self.last_control_word = word
        if self.state is DriveState.FAULT:
            self.state = DriveState.SWITCH_ON_DISABLED if rising else self.state
        elif not word & 0x02:
            self.switch_off()
        elif not word & 0x04:
            self.start_quick_stop()
        elif self.state in {
            DriveState.SWITCH_ON_DISABLED,
            DriveState.READY_TO_SWITCH_ON,
            DriveState.SWITCHED_ON,
            DriveState.OPERATION_ENABLED,
        }:
            self._step(word)

    def start_quick_stop(self) -> None:
        """Brake if the motor has power; otherwise switch the drive off."""
        if self.state is DriveState.OPERATION_ENABLED:
            self.state = DriveState.QUICK_STOP_ACTIVE
        elif not self.is_powered and self.state is not DriveState.FAULT:
            self.state = DriveState.SWITCH_ON_DISABLED

    def switch_off(self) -> None:
        """Switch the power off without braking, unless the drive is in a fault state."""
        if self.state not in {DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE}:
            self.state = DriveState.SWITCH_ON_DISABLED

    def enter_fault(self) -> None:
        """Enter the fault state, after braking if the motor has power."""
        self.state = DriveState.FAULT_REACTION_ACTIVE if self.is_powered else DriveState.FAULT

    def end_braking(self) -> None:
        """End the braking at standstill: enter the fault state after a fault, otherwise switch off."""
        self.state = (
            DriveState.FAULT
            if self.state is DriveState.FAULT_REACTION_ACTIVE
            else DriveState.SWITCH_ON_DISABLED
        )

    def _step(self, word: int) -> None:
        command = word & 0x0F
        if self.is_sto_active or self.refuses_power:
            return
        if command == 0x06:
            self.state = DriveState.READY_TO_SWITCH_ON
        elif (command, self.state) in _SWITCH_ON_TRANSITIONS:
            self.state = DriveState.SWITCHED_ON
        elif command == 0x0F and self.state is DriveState.SWITCHED_ON:
            self.state = DriveState.OPERATION_ENABLED
            self._powered_up()


MAX_QUEUED_RECORD_COUNT = 64  # records
EMCY_UNDERFLOW, EMCY_OVERFLOW, EMCY_FOLLOWING = 0xFF0C, 0xFF0D, 0x8611
_SUPPORTED_MODES = 0x01 | 0x20 | 0x40 | 0x80  # PP, HM, IP, CSP in 0x6502
_HOME_SETTLE = 0.1  # s


class AxisDrive:
    """Simulated axis drive; ``advance`` must be called for each millisecond of the plant."""

    def __init__(
        self,
        servo: SimulatedServo,
        send_emergency: Callable[[int], None],
        profile: DriveProfile = CIA402_PROFILE,
        counts_per_rev: int = 0,
    ) -> None:
        self.servo_axis = servo
        self.send_emergency = send_emergency
        self.profile = profile
        # Counts/s per unit of the drive's velocities.
        self.velocity_scale = counts_per_rev / 60.0 if counts_per_rev else 1.0
        self.is_interpolating = False  # Interpolates between values of 60C1; enabled by bit 4.
        self._left = 0.0  # Seconds to the target in a mode with one target per SYNC.
        self._next = 0  # count of the next segment
        self.power_states = PowerStateMachine(self._hold_position)
        self.operation_mode = 0
        self.target_counts = 0
        self.setpoint_position, self.setpoint_velocity = servo.p, 0.0  # demand, mm
        self.record_queue: deque[tuple[int, int, int]] = deque()
        self.min_queued_record_count = (
            MAX_QUEUED_RECORD_COUNT  # Fewest records that remained in the queue, for tests.
        )
        self.is_playing = False
        self.is_homed = False
        self._now: tuple[int, int, int] = (0, 0, 0)
        self._in = 0.0  # Seconds since the start of the present record.
        self._homing = False
        self._settled = 0.0
        self._pending = False  # A new target must be acknowledged.
        self._going = False
        self.values: dict[tuple[int, int], int] = {}
        self.read_second_encoder: Callable[[], int] | None = None  # counts of a second encoder input
        self._readers: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020192,
            od.SUPPORTED: lambda: _SUPPORTED_MODES,
            od.STATUS: self.get_status_word,
            od.MODE_SHOWN: lambda: self.operation_mode,
            od.POSITION: lambda: round(servo.reading / servo.axis.count),
            od.ACTUAL_TORQUE: lambda: round(10.0 * servo.load),
            od.FOLLOWING: self._following_error,
        }

    # --- objects ------------------------------------------------------------------------------------------

    def read(self, index: int, _sub: int) -> int | None:
        """Return the calculated value of an object, or None if the stored value is to be used."""
        reader = self._readers.get(index)
        if reader is not None:
            return reader()
        if index == od.SECOND_POSITION and self.read_second_encoder is not None:
            return (self.read_second_encoder() + 2**31) % 2**32 - 2**31
        return None

    def _following_error(self) -> int:
        """Return the setpoint minus the position in counts, or 0 without power."""
        return (
            round((self.setpoint_position - self.servo_axis.reading) / self.servo_axis.axis.count)
            if self.power_states.is_powered
            else 0
        )

    def write(self, index: int, subindex: int, value: int) -> None:
        """Store a value that the host has written to an object, and apply its effect."""
        self.values[index, subindex] = value
        if index == od.CONTROL:
            self._control(value)
        elif index == od.MODE and not self.is_playing and not self._homing:
            self.operation_mode = value
        elif index in {od.TARGET, od.IP_RECORD}:
            self.target_counts, self._left = value, self._setpoint_period()
        elif self.profile.record_queue is not None and index == self.profile.record_queue.object_index:
            self._push(value)
        elif index == od.BUFFER and subindex == 6 and value == 0:
            self.record_queue.clear()

    def handle_host_loss(self) -> None:
        """React to the loss of the host as the abort connection option specifies.

        Options 1 and 2 cause a fault, and option 3 causes a quick stop.
        """
        if self.values.get((od.ABORT_OPTION, 0), 0) == 3:
            self.power_states.start_quick_stop()
        elif self.values.get((od.ABORT_OPTION, 0), 0) in {1, 2}:
            self.power_states.enter_fault()

    def reset(self) -> None:
        """Clear the volatile values, as a restart does.

        An incremental encoder also loses its home reference.
        """
        self.power_states.switch_off()
        self.operation_mode, self.is_playing, self._homing, self._going = 0, False, False, False
        self.is_interpolating = False
        self.record_queue.clear()
        self.values.clear()
        self.servo_axis.handle_power_loss()

    def get_status_word(self) -> int:
        """Return the status word (object 6041h)."""
        word = self.power_states.status_word
        if (
            self.is_playing
            or self.is_interpolating
            or (self._pending and self.operation_mode == PP)
            or (self.is_homed and self.operation_mode == HM)
        ):
            word |= BIT_12
        if not self.is_playing and not self._homing and not self._going and self.setpoint_velocity == 0.0:
            word |= REACHED
        return word

    # --- motion -------------------------------------------------------------------------------------------

    @property
    def is_idle(self) -> bool:
        """Return whether the drive will not change until a frame arrives or the axis is moved externally."""
        servo = self.servo_axis
        if servo.v or self.setpoint_velocity:
            return False
        if not self.power_states.is_powered:
            return True
        busy = self.power_states.is_braking or self.is_playing or self._homing or self._going
        if busy or servo.p != self.setpoint_position or not servo.sound:
            return False
        return not self._steps_to_target or self.setpoint_position == self.target_counts * servo.axis.count

    def advance(self, seconds: float) -> None:
        """Advance the drive and its axis by ``seconds``."""
        if not self.power_states.is_powered:
            self.is_playing = self._homing = self._going = self.is_interpolating = False
            self.servo_axis.roll(seconds)
            self.setpoint_position, self.setpoint_velocity = self.servo_axis.reading, 0.0
            return
        if self.power_states.is_braking:
            self._brake(seconds)
        elif self.is_playing:
            self._play(seconds)
        elif self._homing:
            self._search_home(seconds)
        elif self._going:
            self._move_toward(self.target_counts * self.servo_axis.axis.count, seconds)
        elif self._steps_to_target:
            self._step_to_target(seconds)
        if self.servo_axis.follow_setpoint(self.setpoint_position, self.setpoint_velocity, seconds):
            self._fail(EMCY_FOLLOWING)
        if self.setpoint_velocity == 0.0:
            self.servo_axis.settle_at_setpoint(self.setpoint_position)

    def _control(self, word: int) -> None:
        before = self.power_states.last_control_word
        self.power_states.apply_control_word(word)
        rising = word & NEW and not before & NEW
        if self.power_states.state is not DriveState.OPERATION_ENABLED:
            return
        self.is_interpolating = self.operation_mode == IP and self._is_cyclic() and bool(word & NEW)
        if self.operation_mode == IP:
            if rising and not self.is_playing and self.record_queue:
                self._now, self._in, self.is_playing = self.record_queue.popleft(), 0.0, True
        elif self.operation_mode == HM:
            if rising:
                self._homing, self.is_homed, self._settled = True, False, 0.0
            elif not word & NEW:
                self._homing, self.setpoint_velocity = False, 0.0
        elif self.operation_mode == PP:
            if rising:
                self._going = True
            self._pending = bool(word & NEW)

    def _is_cyclic(self) -> bool:
        """Return whether the interpolated mode uses one setpoint per SYNC instead of queued records."""
        return self.values.get((od.IP_SUBMODE, 0), 0) == 0

    def _setpoint_period(self) -> float:
        """Return the time between two setpoints in seconds."""
        return float(self.values.get((od.IP_TIME, 1), 0) * 10.0 ** self.values.get((od.IP_TIME, 2), -3))

    @property
    def _steps_to_target(self) -> bool:
        return self.operation_mode == CSP or self.is_interpolating

    def _step_to_target(self, dt: float) -> None:
        """Move linearly to the target within one setpoint period, and then stay at the target."""
        goal, before = self.target_counts * self.servo_axis.axis.count, self.setpoint_position
        self.setpoint_position += (goal - self.setpoint_position) * min(dt / max(self._left, dt), 1.0)
        self._left = max(self._left - dt, 0.0)
        self.setpoint_velocity = (self.setpoint_position - before) / dt

    def _push(self, value: int) -> None:
        data, queue = value.to_bytes(8, "little"), self.profile.record_queue
        if queue is None or queue.record_format is RecordFormat.EPOS2:
            self._queue(unpack_epos2_record(data))
        elif data[0] & 0x80:
            self._execute_command(data[0])
        else:
            number, ms, speed, place = unpack_copley_segment(data)
            if number != self._next % 8:
                self._fail(EMCY_OVERFLOW)
            self._next += 1
            self._queue((ms, round(speed), place))

    def _execute_command(self, code: int) -> None:
        """Apply a command code to the queue of a Copley drive."""
        if code == 0x80:
            self.record_queue.clear()
        elif code == 0x83:
            self._next = 0

    def _queue(self, record: tuple[int, int, int]) -> None:
        if len(self.record_queue) >= MAX_QUEUED_RECORD_COUNT:
            self._fail(EMCY_OVERFLOW)
        else:
            self.record_queue.append(record)

    def _play(self, dt: float) -> None:
        count = self.servo_axis.axis.count
        self._in += dt
        while self._in > 0.001 * self._now[0] + 1e-9 or self._now[0] == 0:
            if self._now[0] == 0:
                self.is_playing, self.setpoint_position, self.setpoint_velocity = (
                    False,
                    self._now[2] * count,
                    0.0,
                )
                return
            if not self.record_queue:
                self._fail(EMCY_UNDERFLOW)
                return
            self._in -= 0.001 * self._now[0]
            self._now = self.record_queue.popleft()
        self.min_queued_record_count = min(self.min_queued_record_count, len(self.record_queue))
        if not self.record_queue:
            self._fail(EMCY_UNDERFLOW)
            return
        ms, v0, p0 = self._now
        _, v1, p1 = self.record_queue[0]
        copley = (
            self.profile.record_queue is not None
            and self.profile.record_queue.record_format is RecordFormat.COPLEY
        )
        unit = 1.0 if copley else self.velocity_scale
        before = self.setpoint_position
        self.setpoint_position = count * interpolate_hermite(
            p0, unit * v0, p1, unit * v1, 0.001 * ms, self._in / (0.001 * ms)
        )
        self.setpoint_velocity = (self.setpoint_position - before) / dt

    def _move_toward(self, goal: float, dt: float) -> None:
        """Move to ``goal`` in profile position mode, within the profile speed and acceleration."""
        count = self.servo_axis.axis.count
        accel = max(self.values.get((od.PROFILE_ACCEL, 0), 0), 1) * count
        accel *= self.velocity_scale if self.profile.uses_rpm else 1.0
        top = max(self.values.get((od.PROFILE_SPEED, 0), 0), 1) * count * self.velocity_scale
        left = goal - self.setpoint_position
        wanted = math.copysign(min(top, math.sqrt(2.0 * accel * abs(left))), left)
        self.setpoint_velocity += min(
            max(wanted - self.setpoint_velocity, -accel * dt * 1.05), accel * dt * 1.05
        )
        if abs(left) <= abs(self.setpoint_velocity) * dt or abs(left) < 0.5 * count:
            self.setpoint_position, self.setpoint_velocity, self._going = goal, 0.0, False
        else:
            self.setpoint_position += self.setpoint_velocity * dt

    def _search_home(self, dt: float) -> None:
        """Move to the home switch at the first homing speed, and set the reference at standstill."""
        remaining_travel = self.servo_axis.switch - self.setpoint_position
        speed = (
            max(self.values.get((od.HOME_SPEEDS, 1), 0), 1) * self.velocity_scale * self.servo_axis.axis.count
        )
        self.setpoint_velocity = math.copysign(min(speed, abs(remaining_travel) / dt), remaining_travel)
        self.setpoint_position += self.setpoint_velocity * dt
        if abs(remaining_travel) > 1e-9:
            return
        self.setpoint_velocity = 0.0
        self._settled += dt
        if self._settled >= _HOME_SETTLE:
            self.servo_axis.reference()
            self.setpoint_position, self._homing, self.is_homed = self.servo_axis.p, False, True

    def _brake(self, dt: float) -> None:
        drop = self.servo_axis.axis.amax * dt
        self.setpoint_velocity = (
            0.0
            if abs(self.setpoint_velocity) <= drop
            else self.setpoint_velocity - math.copysign(drop, self.setpoint_velocity)
        )
        self.setpoint_position += self.setpoint_velocity * dt
        self.is_playing = self._homing = self._going = self.is_interpolating = False
        if self.setpoint_velocity == 0.0 and abs(self.servo_axis.v) < 0.1:
            self.power_states.end_braking()

    def _hold_position(self) -> None:
        """Make the current position the setpoint, and clear the record queue, as after power-up."""
        self.setpoint_position, self.setpoint_velocity = self.servo_axis.reading, 0.0
        self.record_queue.clear()

    def _fail(self, code: int) -> None:
        self.power_states.enter_fault()
        self.is_playing = False
        self.record_queue.clear()
        self.send_emergency(code)
