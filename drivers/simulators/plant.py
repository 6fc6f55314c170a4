"""Simulated lathe that catches up with the clock on each call, so that it needs no thread.

The model advances on a grid of fixed times. Its behavior does not depend on the time of the calls.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping

import numpy as np

from core.ports import BoolArray, Cam, Clock, DriverError, Fault, FloatArray, Segments, StationState, Stop
from drivers.operator_station import Panel
from drivers.port_parts import SampleLog, demand_no_fault, demand_no_homing, demand_power
from drivers.setpoint_queue import straight
from drivers.simulators.foreseen_motion import ForeseenMotion, foresee
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_terminals import Terminals, ToolSetter
from drivers.simulators.servo_axis import Servo, check_cam, check_drives
from drivers.simulators.spindle_motor import SpindleMotor
from drivers.spindle_gear import GearedQueue, Phase, Slides
from drivers.waiting import Touch, Wakeup

_NEVER = float("inf")
Motion = tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]
_PAST = 0.1  # Age in s of setpoints that are still available.
_HALT = 0.2  # s
_HOME_SETTLE = 0.2  # s between the end of a homing move and the reference
# Columns of a sample: speed, turns and load of the spindle, and the end of the queue.
_FREE = (0.0, 0.0, 0.0, 0.0)
_AT_REST = 0.1  # Seconds between two samples of a machine at rest.


class Plant:
    """Simulated axes, spindle, terminals and operator station with one lock, callable from any thread."""

    def __init__(self, config: SimConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.lock = threading.RLock()
        self.wakeup = Wakeup(self.settled)
        self.touch = Touch(self.lock, self.wakeup.ring)  # For operator actions and for faults.
        self.servos = tuple(Servo(axis, config.step) for axis in config.axes)
        self.names = tuple(axis.name for axis in config.axes)
        self.spindle = SpindleMotor(config.spindle)
        self.terminals = Terminals(config.outputs, config.inputs, config.collet, config.seed)
        self.terminals.setter = ToolSetter(config.setter) if config.setter is not None else None
        self.panel = Panel(config.palms, config.start_pulse, config.seed)
        self.queue = GearedQueue(Slides.of(config.axes, config.commit), self._readings())
        self.enabled = False
        self.fault: str = ""
        self._off_at = _NEVER
        self._homing: tuple[Servo, float] | None = None
        self.due: Callable[[float], None] | None = None  # Applies the scheduled faults that are due.
        self.log: SampleLog | None = None  # Samples of all grid points from the first request on.
        self._turned: tuple[float, ...] = (
            0.0,
            0.0,
            0.0,
        )  # speed, turns and load of the spindle at the present grid point
        self._changed = True  # The last sample was not at rest.
        self._k = int(clock.now() / config.step)
        self.spindle.t = clock.now()
        self._hands: tuple[StationState, Mapping[str, bool]] | None = None
        # Number of changes at the last reading. None: they can change at any time.
        self._hands_at: int | None = None
        self._looked_at = -_NEVER  # Time of the last call of `advance` in s.
        self._ahead: ForeseenMotion | None = None

    @property
    def t(self) -> float:
        """The time of the model in seconds, which is the last grid point that was calculated."""
        return self._k * self.config.step

    def advance(self) -> float:
        """Advance the model to the present time of the clock and return this time in seconds."""
        now = self.clock.now()
        with self.lock:
            if now == self._looked_at:
                return now
            self._break(now)
            self._looked_at = now
            last = int(now / self.config.step + 1e-6)
            if last > self._k:
                self._slides(last)
                self.queue.trim(self.t - _PAST)
            if now > self.spindle.t:
                self.spindle.advance(now)
        return now

    def hands(self, t: float) -> tuple[StationState, Mapping[str, bool]]:
        """Return the state of the operator station and the inputs at time ``t`` in seconds.

        They are read again only if they may have changed since the last call.
        """
        changes = self.touch.count + self.terminals.writes
        if self._hands is None or changes != self._hands_at:
            still = self.terminals.setter is None and self.terminals.settled(t) and self.panel.settled(t)
            self._hands_at = changes if still else None
            self._hands = self.panel.state(t), self.terminals.read(t)
        return self._hands

    def settled(self) -> bool:
        """Return whether the machine changes no more until an operator or a test acts.

        A machine with scheduled faults is never settled.
        """
        with self.lock:
            now = self.advance()
            waits = self.due is not None or self._off_at < _NEVER or self._homing is not None
            moves = waits or not self.spindle.still or not self._resting()
            return not moves and self.terminals.settled(now) and self.panel.settled(now)

    def _break(self, now: float) -> None:
        """Apply the faults that are due at ``now``. The callback is suspended to prevent recursion."""
        due, self.due = self.due, None
        if due is not None:
            due(now)
            self.due = due

    def splice(self, segments: Segments) -> None:
        """Splice setpoints into the queue. Raises DriverError if the drives cannot follow them."""
        with self.lock:
            now = self.advance()
            self._need_power()
            check_drives(segments, self.servos, self.spindle.speed)
            self.queue.splice(segments, now)

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle along ``cam``. Raises DriverError if the drives cannot do so."""
        with self.lock:
            now = self.advance()
            self._need_power()
            check_cam(cam, self.servos, self.spindle.speed)
            self.queue.mesh(cam, Phase(now, self.spindle.counted, self.spindle.speed / 60.0), now)

    def power(self, on: bool) -> None:
        """Switch the drives on at the present position, or off.

        Raises DriverError when switching on in E-stop or with a fault.
        """
        with self.lock:
            self.advance()
            if not on:
                self._power_off()
                return
            if self.panel.estop:
                raise DriverError(
                    "the drives stay off while the E-stop is pressed; release the E-stop first", "no-power"
                )
            demand_no_fault(self.fault)
            if not self.enabled:
                self.queue.rest_at(self._readings())
            self.enabled, self._off_at = True, _NEVER

    def stop(self, how: Stop) -> None:
        """Stop the axes by the ramps of the drives, independently of the host's path."""
        with self.lock:
            now = self.advance()
            self._homing = None
            if how is Stop.OFF:
                self._power_off()
            elif self.enabled:
                ends = self.queue.brake(now, [axis.amax for axis in self.config.axes])
                if how is Stop.RAMP_OFF or self._off_at < _NEVER:
                    self._off_at = ends

    def home(self, name: str) -> None:
        """Start to home one axis; an absolute axis returns at once.

        Raises DriverError without power, while homing or while an axis moves.
        """
        with self.lock:
            now = self.advance()
            self._need_power()
            index = self.names.index(name)
            servo = self.servos[index]
            if servo.axis.absolute:
                return
            rest, velocity = self.queue.demand_at(now)
            if any(velocity) or self._homing is not None:
                raise DriverError(
                    "{axis} cannot home while an axis is moving; wait until all axes are at rest",
                    reason="axis-moves",
                    axis=name,
                )
            pieces = straight(
                now + self.config.commit,
                rest,
                index,
                to=servo.switch,
                speed=servo.axis.home_speed,
                accel=servo.axis.amax,
            )
            self.queue.splice(pieces, now)
            self._homing = (servo, self.queue.horizon(now) + _HOME_SETTLE)

    def press_estop(self) -> None:
        """Brake the axes, remove their power and let the spindle coast, as the E-stop circuit does."""
        with self.touch:
            now = self.advance()
            self.panel.estop = True
            self.stop(Stop.RAMP_OFF)
            self.spindle.cut(now)

    def halt(self) -> None:
        """Stop the axes and the spindle and set the outputs to their safe states, from any thread.

        Raises DriverError if the lock is not available within 0.2 s.
        """
        if not self.lock.acquire(timeout=_HALT):
            raise DriverError("no response from the simulated machine")
        try:
            self.stop(Stop.RAMP_OFF)
            self.spindle.order(self.advance(), 0.0, coast=True)
            self.terminals.safe(self.clock.now())
        finally:
            self.lock.release()

    def trip(self, fault: str) -> None:
        """Record a drive fault, and brake and switch off all axes."""
        self.fault = self.fault or fault
        self.stop(Stop.RAMP_OFF)

    def clear_fault(self) -> None:
        """Clear the fault; the drives remain off until they are enabled again."""
        self.advance()
        self.fault = ""
        for servo in self.servos:
            servo.over = 0.0

    def _readings(self) -> tuple[float, ...]:
        return tuple(servo.reading for servo in self.servos)

    def _need_power(self) -> None:
        demand_power(self.fault, self.enabled and self._off_at >= _NEVER)
        demand_no_homing(self._homing[0].axis.name if self._homing is not None else "")

    def _power_off(self) -> None:
        self.enabled, self._off_at, self._homing = False, _NEVER, None
        self.queue.rest_at(self._readings())
        for servo in self.servos:
            servo.power_lost()

    def _slides(self, last: int) -> None:
        """Move the axes to grid point ``last``. Axes at rest are not calculated step by step."""
        while self._k < last:
            if self.t >= self._off_at:
                self._power_off()
            if self._resting():
                self._rest(last)
            elif not (self._undisturbed() and self._glide(last)):
                self._step()
            self._reference()

    def _rest(self, last: int) -> None:
        """Advance the time to grid point ``last``, or to the time when the drives switch off."""
        self.spindle.cuts = False
        if self.spindle.slips:
            self.spindle.cut_load(self.t, cutting=False)
        until = max(self._k + 1, int(min(self._off_at / self.config.step + 1, last)))
        if self.log is not None:
            self._sample_rest(until)
        self._k = until

    def _undisturbed(self) -> bool:
        """Return whether the axes only follow setpoints in time and nothing requires single steps."""
        ordered = self.enabled and self._off_at == _NEVER and self._homing is None and not self.fault
        return (
            ordered
            and self.terminals.setter is None
            and not self.spindle.faults.belt
            and not self.queue.meshed
        )

    def _glide(self, last: int) -> bool:
        """Move along the present setpoint piece, at most to grid point ``last``.

        Return False if the piece must be calculated step by step.
        """
        ahead = self._ahead
        piece, until = self.queue.piece_at(self.t)
        if ahead is None or not ahead.holds(piece, until, self._k):
            ahead = self._ahead = foresee(self.servos, piece, until, self._k, self.config.step)
        if ahead is None:
            return False
        last = min(last, ahead.last)
        if self.log is not None:
            self._sample_ahead(ahead, last)
        ahead.move_to(last)
        self._k = last
        self.spindle.cuts = self.cuts()
        return True

    def _resting(self) -> bool:
        if not self.enabled:
            return all(servo.v == 0.0 for servo in self.servos)
        if self.queue.meshed or self.queue.horizon(self.t) > self.t:
            return False
        rest, _ = self.queue.demand_at(self.t)
        settled = [servo.settle(p) for servo, p in zip(self.servos, rest, strict=True)]
        return all(settled)

    def _step(self) -> None:
        dt, t = self.config.step, self.t
        if not self.enabled:
            self._sample(t, None)
            self._k += 1
            for servo in self.servos:
                servo.roll(dt)
        else:
            p, v, demand = self._setpoint(t)
            self._sample(t, demand)
            self._k += 1
            self._servos_follow(p, v, dt)
        if self.terminals.setter is not None:
            x, z = (self.servos[self.names.index(name)].where for name in "XZ")
            self.terminals.setter.look(self.t, x, z, self._readings())
        self.spindle.cuts = self.cuts()
        if self.spindle.faults.belt:
            self.spindle.cut_load(self.t, cutting=self.spindle.cuts)
        self._turn()

    def _servos_follow(self, p: tuple[float, ...], v: tuple[float, ...], dt: float) -> bool:
        """Advance all axes by one step toward setpoint ``p``, ``v``. Return whether a drive has a fault."""
        for servo, position, speed in zip(self.servos, p, v, strict=True):
            if servo.follow(position, speed, dt) and not self.fault:
                self.fault = Fault("{axis}: following error", "following", axis=servo.axis.name)
        if self.fault and self._off_at == _NEVER:
            self._off_at = self.queue.brake(self.t, [axis.amax for axis in self.config.axes])
        return bool(self.fault)

    def cuts(self) -> bool:
        """Return whether an axis moves at a cutting feed."""
        return any(servo.cuts for servo in self.servos)

    def _setpoint(self, t: float) -> Motion:
        """Return the position sent to the drives, the velocity and the queued position at ``t``.

        With the gear, the position sent to the drives compensates for their following error.
        """
        if not self.queue.meshed:
            p, v = self.queue.demand_at(t)
            return p, v, p
        if t > self.spindle.t:
            self.spindle.advance(t)
        p, v, a = self.queue.play(t, self.spindle.t, self.spindle.counted)
        return tuple(servo.lead(*each) for servo, *each in zip(self.servos, p, v, a, strict=True)), v, p

    # --- samples for the scope ----------------------------------------------------------------------------

    def _sample(self, t: float, demand: tuple[float, ...] | None) -> None:
        """Sample the present grid point; without power, the demand is the measured position."""
        if self.log is None:
            return
        actual = [servo.reading for servo in self.servos]
        load = [servo.load for servo in self.servos]
        left = self.queue.horizon(t) - t
        self.log.add(t, *(demand or actual), *actual, *load, *self._turned, left)
        self._changed = True

    def _sample_turning(self, demand: tuple[float, ...] | None, until: int) -> None:
        """Sample the turning spindle up to grid point ``until``, exclusive, while the axes are at rest."""
        assert self.log is not None
        actual = self._readings()
        row = [0.0, *(demand or actual), *actual, *(servo.load for servo in self.servos), *_FREE]
        rows = np.tile(np.array(row), (until - self._k, 1))
        rows[:, 0] = np.arange(self._k, until) * self.config.step
        self._turn_ahead(rows, np.zeros(len(rows), dtype=np.bool_))
        self.log.extend(rows)
        self._k, self._changed = until, True

    def _sample_ahead(self, ahead: ForeseenMotion, last: int) -> None:
        """Sample all grid points of a predicted motion up to ``last``, exclusive."""
        assert self.log is not None
        rows = ahead.rows(self._k, last)
        self._turn_ahead(rows, ahead.cuts(self._k + 1, last + 1))
        rows[:, -1] = self.queue.horizon(self.t) - rows[:, 0]
        self.log.extend(rows)
        self._changed = True

    def _turn_ahead(self, rows: FloatArray, cuts: BoolArray) -> None:
        """Fill the spindle columns of ``rows``, and turn the spindle to one grid point after the last row.

        ``cuts`` states for each grid point after the first whether a tool cuts.
        """
        rows[:, -4:-1] = self._turned
        if self._turned[0] or not self.spindle.still:
            following = self.spindle.turn(rows[:, 0] + self.config.step, cuts)
            rows[1:, -4:-1] = following[:-1]
            self._turned = tuple(following[-1].tolist())

    def _sample_rest(self, until: int) -> None:
        """Sample the resting axes up to grid point ``until``.

        While the spindle is at rest too, the interval between samples is 0.1 s.
        """
        assert self.log is not None
        demand = self.queue.demand_at(self.t)[0] if self.enabled else None
        while self._k < until:
            turns = not self.spindle.still or self._turned[0] != 0.0
            if self.spindle.even and not self.spindle.still:
                self._sample_turning(demand, until)
                return
            if turns or self._changed or self.t >= self.log.last + _AT_REST:
                self._sample(self.t, demand)
                self._changed = turns
            if not turns:
                return
            self._k += 1
            self._turn()

    def _turn(self) -> None:
        """Advance the spindle to the present grid point for the samples."""
        if self.log is not None and (self._turned[0] or not self.spindle.still):
            if self.t > self.spindle.t:
                self.spindle.advance(self.t)
            self._turned = self.spindle.speed, self.spindle.counted, self.spindle.load

    def _reference(self) -> None:
        if self._homing is not None and self.t >= self._homing[1]:
            self._homing[0].reference()
            self._homing = None
            self.queue.rest_at(self._readings())
