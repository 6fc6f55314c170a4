"""Simulated CiA 402 drive of an axis: power states, modes of operation, PVT queue and faults."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable

from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_objects import BIT_12, CSP, HM, IP, NEW, PP, REACHED, DriveState
from drivers.canopen.drive_profiles import CIA402, DriveProfile, Records
from drivers.canopen.driven_axes import unpacked, unpacked_segment
from drivers.canopen.pvt_mode import hermite
from drivers.simulators.servo_axis import Servo

# --- Power states of a CiA 402 drive with the transitions of the profile.


_BITS = {
    DriveState.NOT_READY: 0x00,
    DriveState.OFF: 0x40,
    DriveState.READY: 0x21,
    DriveState.ON: 0x23,
    DriveState.ENABLED: 0x27,
    DriveState.QUICK_STOP: 0x07,
    DriveState.REACTING: 0x0F,
    DriveState.FAULT: 0x08,
}
_ON = frozenset(((0x07, DriveState.READY), (0x0F, DriveState.READY), (0x07, DriveState.ENABLED)))
_VOLTAGE, _REMOTE = 0x10, 0x200
_POWERED = frozenset((DriveState.ENABLED, DriveState.QUICK_STOP, DriveState.REACTING))


class PowerStates:
    """Power state machine of a CiA 402 drive; ``sto`` is the state of the hardware input STO."""

    def __init__(self, powered_up: Callable[[], None]) -> None:
        self.state = DriveState.OFF
        self.last = 0  # control word
        self.sto = False
        self.refuses = False  # A drive that does not switch on, for tests.
        self._powered_up = powered_up

    @property
    def powered(self) -> bool:
        """Whether the motor has current."""
        return self.state in _POWERED

    @property
    def braking(self) -> bool:
        """Whether the drive is braking to standstill after a quick stop or a fault."""
        return self.state in {DriveState.QUICK_STOP, DriveState.REACTING}

    @property
    def word(self) -> int:
        """The bits of the status word for the present state."""
        return _BITS[self.state] | _VOLTAGE | _REMOTE

    def control(self, word: int) -> None:
        """Apply a control word, which causes at most one transition of the CiA 402 state machine."""
        rising = word & 0x80 and not self.last & 0x80
        self.last = word
        if self.state is DriveState.FAULT:
            self.state = DriveState.OFF if rising else self.state
        elif not word & 0x02:
            self.off()
        elif not word & 0x04:
            self.quick_stop()
        elif self.state in {DriveState.OFF, DriveState.READY, DriveState.ON, DriveState.ENABLED}:
            self._step(word)

    def quick_stop(self) -> None:
        """Brake if the motor has power; otherwise switch off."""
        if self.state is DriveState.ENABLED:
            self.state = DriveState.QUICK_STOP
        elif not self.powered and self.state is not DriveState.FAULT:
            self.state = DriveState.OFF

    def off(self) -> None:
        """Switch off without braking, except in a fault state."""
        if self.state not in {DriveState.FAULT, DriveState.REACTING}:
            self.state = DriveState.OFF

    def trip(self) -> None:
        """Enter the fault state, after braking if the motor has power."""
        self.state = DriveState.REACTING if self.powered else DriveState.FAULT

    def stopped(self) -> None:
        """End braking at standstill: in the fault state after a fault, otherwise off."""
        self.state = DriveState.FAULT if self.state is DriveState.REACTING else DriveState.OFF

    def _step(self, word: int) -> None:
        command = word & 0x0F
        if self.sto or self.refuses:
            return
        if command == 0x06:
            self.state = DriveState.READY
        elif (command, self.state) in _ON:
            self.state = DriveState.ON
        elif command == 0x0F and self.state is DriveState.ON:
            self.state = DriveState.ENABLED
            self._powered_up()


QUEUE = 64  # records
EMCY_UNDERFLOW, EMCY_OVERFLOW, EMCY_FOLLOWING = 0xFF0C, 0xFF0D, 0x8611
_MODES = 0x01 | 0x20 | 0x40 | 0x80  # PP, HM, IP, CSP in 0x6502
_HOME_SETTLE = 0.1  # s


class AxisDrive:
    """Simulated axis drive; ``step`` is called once per millisecond of the plant."""

    def __init__(
        self,
        servo: Servo,
        emergency: Callable[[int], None],
        profile: DriveProfile = CIA402,
        counts_per_rev: int = 0,
    ) -> None:
        self.servo = servo
        self.emergency = emergency
        self.profile = profile
        # Counts/s per unit of the drive's velocities.
        self.unit = counts_per_rev / 60.0 if counts_per_rev else 1.0
        self.interpolates = False  # Interpolates between values of 60C1; enabled by bit 4.
        self._left = 0.0  # Seconds to the target in a mode with one target per SYNC.
        self._next = 0  # count of the next segment
        self.power = PowerStates(self._hold)
        self.mode = 0
        self.target = 0
        self.p, self.v = servo.p, 0.0  # demand, mm
        self.queue: deque[tuple[int, int, int]] = deque()
        self.least = QUEUE  # Fewest records that remained in the queue, for tests.
        self.playing = False
        self.homed = False
        self._now: tuple[int, int, int] = (0, 0, 0)
        self._in = 0.0  # Seconds since the start of the present record.
        self._homing = False
        self._settled = 0.0
        self._pending = False  # A new target must be acknowledged.
        self._going = False
        self.values: dict[tuple[int, int], int] = {}
        self.second: Callable[[], int] | None = None  # counts of a second encoder input
        self._readers: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020192,
            od.SUPPORTED: lambda: _MODES,
            od.STATUS: self.status,
            od.MODE_SHOWN: lambda: self.mode,
            od.POSITION: lambda: round(servo.reading / servo.axis.count),
            od.TORQUE: lambda: round(10.0 * servo.load),
            od.FOLLOWING: self._following_error,
        }

    # --- objects ------------------------------------------------------------------------------------------

    def read(self, index: int, _sub: int) -> int | None:
        """Return the value of an object that the drive calculates, or None if the stored value applies."""
        reader = self._readers.get(index)
        if reader is not None:
            return reader()
        if index == od.SECOND_POSITION and self.second is not None:
            return (self.second() + 2**31) % 2**32 - 2**31
        return None

    def _following_error(self) -> int:
        """Return setpoint minus position in counts; 0 without power."""
        return round((self.p - self.servo.reading) / self.servo.axis.count) if self.power.powered else 0

    def write(self, index: int, sub: int, value: int) -> None:
        """Apply an object value that the host has written."""
        self.values[index, sub] = value
        if index == od.CONTROL:
            self._control(value)
        elif index == od.MODE and not self.playing and not self._homing:
            self.mode = value
        elif index in {od.TARGET, od.IP_RECORD}:
            self.target, self._left = value, self._period()
        elif self.profile.queue is not None and index == self.profile.queue.object:
            self._push(value)
        elif index == od.BUFFER and sub == 6 and value == 0:
            self.queue.clear()

    def host_lost(self) -> None:
        """React to a lost host by the abort connection option: 1 and 2 are a fault, 3 is a quick stop."""
        if self.values.get((od.ABORT_OPTION, 0), 0) == 3:
            self.power.quick_stop()
        elif self.values.get((od.ABORT_OPTION, 0), 0) in {1, 2}:
            self.power.trip()

    def reset(self) -> None:
        """Clear volatile values, and the reference of an incremental encoder."""
        self.power.off()
        self.mode, self.playing, self._homing, self._going = 0, False, False, False
        self.interpolates = False
        self.queue.clear()
        self.values.clear()
        self.servo.power_lost()

    def status(self) -> int:
        """Return the status word, object 0x6041."""
        word = self.power.word
        if (
            self.playing
            or self.interpolates
            or (self._pending and self.mode == PP)
            or (self.homed and self.mode == HM)
        ):
            word |= BIT_12
        if not self.playing and not self._homing and not self._going and self.v == 0.0:
            word |= REACHED
        return word

    # --- motion -------------------------------------------------------------------------------------------

    @property
    def rests(self) -> bool:
        """Whether further steps change nothing until a frame arrives or the axis is moved externally."""
        servo = self.servo
        if servo.v or self.v:
            return False
        if not self.power.powered:
            return True
        busy = self.power.braking or self.playing or self._homing or self._going
        if busy or servo.p != self.p or not servo.sound:
            return False
        return not self._steps_to_target or self.p == self.target * servo.axis.count

    def step(self, dt: float) -> None:
        """Advance the drive and its axis by ``dt`` seconds."""
        if not self.power.powered:
            self.playing = self._homing = self._going = self.interpolates = False
            self.servo.roll(dt)
            self.p, self.v = self.servo.reading, 0.0
            return
        if self.power.braking:
            self._brake(dt)
        elif self.playing:
            self._play(dt)
        elif self._homing:
            self._look_for_home(dt)
        elif self._going:
            self._towards(self.target * self.servo.axis.count, dt)
        elif self._steps_to_target:
            self._step_to_target(dt)
        if self.servo.follow(self.p, self.v, dt):
            self._fail(EMCY_FOLLOWING)
        if self.v == 0.0:
            self.servo.settle(self.p)

    def _control(self, word: int) -> None:
        before = self.power.last
        self.power.control(word)
        rising = word & NEW and not before & NEW
        if self.power.state is not DriveState.ENABLED:
            return
        self.interpolates = self.mode == IP and self._cyclic() and bool(word & NEW)
        if self.mode == IP:
            if rising and not self.playing and self.queue:
                self._now, self._in, self.playing = self.queue.popleft(), 0.0, True
        elif self.mode == HM:
            if rising:
                self._homing, self.homed, self._settled = True, False, 0.0
            elif not word & NEW:
                self._homing, self.v = False, 0.0
        elif self.mode == PP:
            if rising:
                self._going = True
            self._pending = bool(word & NEW)

    def _cyclic(self) -> bool:
        """Return whether interpolated mode takes one setpoint per SYNC instead of queued records."""
        return self.values.get((od.IP_SUBMODE, 0), 0) == 0

    def _period(self) -> float:
        """Return the time between two setpoints in seconds."""
        return float(self.values.get((od.IP_TIME, 1), 0) * 10.0 ** self.values.get((od.IP_TIME, 2), -3))

    @property
    def _steps_to_target(self) -> bool:
        return self.mode == CSP or self.interpolates

    def _step_to_target(self, dt: float) -> None:
        """Move linearly to the target within one period, then stay there."""
        goal, before = self.target * self.servo.axis.count, self.p
        self.p += (goal - self.p) * min(dt / max(self._left, dt), 1.0)
        self._left = max(self._left - dt, 0.0)
        self.v = (self.p - before) / dt

    def _push(self, value: int) -> None:
        data, queue = value.to_bytes(8, "little"), self.profile.queue
        if queue is None or queue.records is Records.EPOS2:
            self._queue(unpacked(data))
        elif data[0] & 0x80:
            self._order(data[0])
        else:
            number, ms, speed, place = unpacked_segment(data)
            if number != self._next % 8:
                self._fail(EMCY_OVERFLOW)
            self._next += 1
            self._queue((ms, round(speed), place))

    def _order(self, code: int) -> None:
        """Apply a command code to the queue of a Copley drive."""
        if code == 0x80:
            self.queue.clear()
        elif code == 0x83:
            self._next = 0

    def _queue(self, record: tuple[int, int, int]) -> None:
        if len(self.queue) >= QUEUE:
            self._fail(EMCY_OVERFLOW)
        else:
            self.queue.append(record)

    def _play(self, dt: float) -> None:
        count = self.servo.axis.count
        self._in += dt
        while self._in > 0.001 * self._now[0] + 1e-9 or self._now[0] == 0:
            if self._now[0] == 0:
                self.playing, self.p, self.v = False, self._now[2] * count, 0.0
                return
            if not self.queue:
                self._fail(EMCY_UNDERFLOW)
                return
            self._in -= 0.001 * self._now[0]
            self._now = self.queue.popleft()
        self.least = min(self.least, len(self.queue))
        if not self.queue:
            self._fail(EMCY_UNDERFLOW)
            return
        ms, v0, p0 = self._now
        _, v1, p1 = self.queue[0]
        copley = self.profile.queue is not None and self.profile.queue.records is Records.COPLEY
        unit = 1.0 if copley else self.unit
        before = self.p
        self.p = count * hermite(p0, unit * v0, p1, unit * v1, 0.001 * ms, self._in / (0.001 * ms))
        self.v = (self.p - before) / dt

    def _towards(self, goal: float, dt: float) -> None:
        """Move to ``goal`` in profile position mode, within the profile's speed and acceleration."""
        count = self.servo.axis.count
        accel = max(self.values.get((od.PROFILE_ACCEL, 0), 0), 1) * count
        accel *= self.unit if self.profile.rpm else 1.0
        top = max(self.values.get((od.PROFILE_SPEED, 0), 0), 1) * count * self.unit
        left = goal - self.p
        wanted = math.copysign(min(top, math.sqrt(2.0 * accel * abs(left))), left)
        self.v += min(max(wanted - self.v, -accel * dt * 1.05), accel * dt * 1.05)
        if abs(left) <= abs(self.v) * dt or abs(left) < 0.5 * count:
            self.p, self.v, self._going = goal, 0.0, False
        else:
            self.p += self.v * dt

    def _look_for_home(self, dt: float) -> None:
        """Move to the home switch at the first homing speed, and set the reference after a standstill."""
        way = self.servo.switch - self.p
        speed = max(self.values.get((od.HOME_SPEEDS, 1), 0), 1) * self.unit * self.servo.axis.count
        self.v = math.copysign(min(speed, abs(way) / dt), way)
        self.p += self.v * dt
        if abs(way) > 1e-9:
            return
        self.v = 0.0
        self._settled += dt
        if self._settled >= _HOME_SETTLE:
            self.servo.reference()
            self.p, self._homing, self.homed = self.servo.p, False, True

    def _brake(self, dt: float) -> None:
        drop = self.servo.axis.amax * dt
        self.v = 0.0 if abs(self.v) <= drop else self.v - math.copysign(drop, self.v)
        self.p += self.v * dt
        self.playing = self._homing = self._going = self.interpolates = False
        if self.v == 0.0 and abs(self.servo.v) < 0.1:
            self.power.stopped()

    def _hold(self) -> None:
        """Start at the present position with an empty queue after power-up."""
        self.p, self.v = self.servo.reading, 0.0
        self.queue.clear()

    def _fail(self, code: int) -> None:
        self.power.trip()
        self.playing = False
        self.queue.clear()
        self.emergency(code)
