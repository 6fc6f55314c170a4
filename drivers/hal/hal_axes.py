"""Axes on HAL: the setpoint queue is here, and the bridge and HAL play it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence

from core.ports import AxisSample, Cam, DriverError, Fault, Geared, Segments, Stop, at_rest
from drivers.hal.bridge.packets import number
from drivers.hal.bridge.packets import pieces_of as pieces_told
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_homing import HalTouch, Homing
from drivers.hal.hal_link import HalLink, told_fault
from drivers.port_parts import demand_axis, demand_no_fault, demand_no_homing, demand_power, demand_standstill
from drivers.setpoint_pieces import Piece
from drivers.setpoint_queue import check_limits, pieces_of
from drivers.spindle_gear import GearedQueue, Motion, Phase, Slides

_PAST = 0.5  # Age in s of setpoints that are still available.
_POWER = 1.5  # Seconds for the drives to switch on.
_STILL = 0.1  # Seconds without a count after which an axis is at standstill.
_SPEED_OVER = 0.05  # s
_NAN = float("nan")


class HalQueue(GearedQueue):
    """Geared setpoint queue for which the bridge decides when a cam has ended."""

    def follow(self, t: float, turns: float) -> Motion | None:
        """Return the setpoint for one sample of the spindle, or None without an active cam."""
        return None if self._gearing is None else self._gearing.play(t, t, turns)

    def left(self, t: float) -> None:
        """End the cam at time ``t``; the tail that follows by time has started."""
        if self._gearing is not None:
            self._leave(t, self._gearing)

    def braked(self, t: float, pieces: list[Piece]) -> None:
        """Replace the queue by a deceleration that the bridge has performed."""
        if self._gearing is not None:
            self.rest_at(pieces[0].p)
        self.replace(t, pieces)


class HalAxes:
    """``core.ports.AxisSink`` and ``Gear`` of HAL, used only by the thread that owns the bridge."""

    def __init__(self, config: HalConfig, link: HalLink, now: Callable[[], float]) -> None:
        self.config = config
        self._link = link
        self._now = now
        self.axes = tuple(axis.name for axis in config.axes)
        self.commit = config.commit
        self._driven = [n for n, axis in enumerate(config.axes) if axis.pins is not None]
        self.queue = HalQueue(Slides.of(config.axes, config.commit), (0.0,) * len(self.axes))
        self.zero = [0.0] * len(self.axes)  # Home positions in HAL's count.
        self._homed = [axis.absolute or axis.pins is None for axis in config.axes]
        self.homing: Homing | None = None
        self.fault: Fault | str = ""
        self.clearing: list[Callable[[], None]] = []  # Functions that clear the faults of other parts.
        self.connecting: list[Callable[[], None]] = []  # Functions to call after HAL was loaded again.
        self.spindle_at: tuple[float, float] | None = None  # Time and revolutions of the newest sample.
        self.index_at = 0.0  # Revolutions at the spindle's index in HAL's count.
        probe = config.probe
        self.touch = HalTouch(config.table.period, active_low=probe.active_low) if probe is not None else None
        # An axis that is used as the spindle and retains its count. None: C is engaged or does not exist.
        self._lent = next((n for n, axis in enumerate(config.axes) if axis.is_spindle), None)
        self.c_turns = False  # C turns to its position relative to the index.
        self.rps = 0.0
        self._on = False
        self._order = 0  # Number of the command after which the bridge's power report is valid.
        self._t = 0.0
        self._command = self._actual = (0.0,) * len(self.axes)
        self._moved = -math.inf  # Time of the last motion.
        self._still = self._actual
        self._brakings = 0.0
        self._samples: Callable[..., None] = _nobody
        self._marks = [n for n, axis in enumerate(config.axes) if axis.switch]
        self._turned: deque[tuple[float, float]] = deque()

    # --- data from the bridge -----------------------------------------------------------------------------

    def connected(self) -> None:
        """Handle a new connection to HAL, after which only absolute axes know their position."""
        self._homed = [axis.absolute or axis.pins is None for axis in self.config.axes]
        self._brakings = number(self._link.told, "brakings")
        self._on = False
        for forget in self.connecting:
            forget()
        self.take()
        self.queue.rest_at(self._actual)

    def keep_samples(self, keep: Callable[..., None]) -> None:
        """Set the function that receives each sample as a row of ``core.ports.SampleSource``."""
        self._samples = keep

    def take(self) -> None:
        """Process the samples that have been received."""
        axes, config = len(self._driven), self.config
        turning, telling = bool(config.spindle.pins.position), bool(config.spindle.pins.velocity)
        width = 1 + 2 * axes + turning + telling + len(self._marks) + (self.touch is not None)
        for told in self._link.take_rows():
            for at in range(0, len(told) - width + 1, width):
                self._sample(told[at : at + width], axes, turning=turning, telling=telling)

    def _sample(self, row: Sequence[float], axes: int, *, turning: bool, telling: bool) -> None:
        t = row[0]
        self._command = self._counted(row[1 : 1 + axes], t)
        self._actual = self._counted(row[1 + axes : 1 + 2 * axes], t)
        if turning:
            self.spindle_at = t, row[1 + 2 * axes]
            self.queue.follow(t, row[1 + 2 * axes] - self.index_at)
        if telling:
            self.rps = row[1 + 2 * axes + turning]
        elif turning:
            self._speed_of_turns(t, row[1 + 2 * axes])
        self._t = t
        bits = row[1 + 2 * axes + turning + telling :]
        if self.touch is not None:
            self.touch.see(t, self._actual, bool(bits[-1]))
        for index, on in zip(self._marks, bits[: len(self._marks)], strict=True):
            if self.homing is not None and self._homes(index):
                self.homing.see(self.raw(index), bool(on))
        moved = zip(self._actual, self._still, self.config.axes, strict=True)
        if any(abs(a - b) > 1.5 * axis.count for a, b, axis in moved):
            self._moved, self._still = t, self._actual
        self._samples(
            t,
            *self._command,
            *self._actual,
            *(_NAN,) * len(self.axes),
            60.0 * self.rps,
            row[1 + 2 * axes] - self.index_at if turning else _NAN,
            _NAN,
            self.queue.horizon(t) - t,
        )

    def _speed_of_turns(self, t: float, turns: float) -> None:
        """Calculate the speed in rev/s from the last samples, if HAL does not provide a velocity."""
        turned = self._turned
        turned.append((t, turns))
        while turned[0][0] < t - _SPEED_OVER:
            turned.popleft()
        since = t - turned[0][0]
        self.rps = (turns - turned[0][1]) / since if since > 0.0 else self.rps

    def _counted(self, raw: Sequence[float], t: float) -> tuple[float, ...]:
        """Convert HAL positions into those of the control; an axis without pins is at its queued position."""
        place = list(self.queue.demand_at(t)[0])
        for value, index in zip(raw, self._driven, strict=True):
            if index != self._lent:
                place[index] = value - self.zero[index]
        return tuple(place)

    def tick(self) -> None:
        """Supervise and home, without raising errors; errors become the fault."""
        self.take()
        told = self._link.told
        trouble = self._link.trouble or told_fault(told)
        if trouble and not self.fault:
            self.fault = trouble
            self._forget()
        if self._on and self._link.done(self._order) and told.get("on") is not True:
            self._taken_away()
        self._follow_bridge()
        self._home_on()
        self.queue.trim(self._now() - _PAST)

    def _follow_bridge(self) -> None:
        """Update the queue after the bridge has ended a cam or braked."""
        told = self._link.told
        if self.queue.meshed and told.get("geared") is False and "left" in told:
            left = told["left"]
            if isinstance(left, float | int):
                self.queue.left(float(left))
        count, numbers = number(told, "brakings"), told.get("braked")
        if count > self._brakings and isinstance(numbers, list) and numbers:
            self._brakings = count
            raw = pieces_told([float(each) for each in numbers], len(self._driven))
            pieces = [self._from_hal(piece) for piece in raw]
            self.queue.braked(pieces[0].t, pieces)

    def _taken_away(self) -> None:
        """Handle a loss of power by E-stop or a drive fault.

        Axes without an absolute encoder lose their home.
        """
        self._forget()
        for index in self._driven:
            self._homed[index] = self.config.axes[index].absolute

    def _forget(self) -> None:
        self._on, self.homing = False, None
        self.queue.rest_at(self._actual)

    # --- the port -----------------------------------------------------------------------------------------

    def now(self) -> float:
        """Return the time of the machine's clock in seconds."""
        return self._now()

    def horizon(self) -> float:
        """Return the end time of the setpoint queue, or the present time if it is empty."""
        return self.queue.horizon(self._now())

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at time ``t``."""
        return self.queue.demand_at(t)

    def splice(self, segments: Segments) -> None:
        """Splice setpoints into the queue. Raises DriverError if they are invalid or exceed axis limits."""
        self._need_power()
        demand_no_homing(self.homing.name if self.homing is not None else "")
        self._check(segments)
        self.queue.splice(segments, self._now())
        self._send("splice", pieces_of(segments, len(self.axes)))

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle. Raises DriverError without an encoder or for an invalid cam."""
        self._need_power()
        if self.spindle_at is None:
            raise DriverError(
                "HAL does not report the spindle position, so no axis can follow the spindle",
                "thread-no-encoder",
            )
        t, turns = self.spindle_at[0], self.spindle_at[1] - self.index_at
        self._check(cam.way._replace(v=cam.way.v * abs(self.rps) / 1.1))
        phase = Phase(t, turns, self.rps)
        self.queue.mesh(cam, phase, self._now())
        way = pieces_of(cam.way, len(self.axes))
        then = pieces_of(cam.then, len(self.axes)) if cam.then is not None else []
        self._send("mesh", [*way, *then], zero=cam.zero + self.index_at, sign=cam.sign, way=len(way))

    def geared(self) -> Geared | None:
        """Return the position of the axes on the cam, or None if they do not follow the spindle."""
        return self.queue.geared()

    def sample(self) -> AxisSample:
        """Return the state of the axes from HAL's last sample."""
        t, actual, powered = self._t, self._actual, self._powered
        demand = self._command if powered and self.homing is None else actual
        velocity = self.queue.demand_at(t)[1]
        return AxisSample(
            t=t,
            demand=demand,
            actual=actual,
            following_error=tuple([d - a for d, a in zip(demand, actual, strict=True)]),
            enabled=powered,
            homed=tuple([on and not self._homes(n) for n, on in enumerate(self._homed)]),
            moving=not self._link.blind
            and (self.homing is not None or self.c_turns or any(velocity) or self._rolls),
            fault=self.fault,
        )

    def enable(self, on: bool) -> None:
        """Switch the power on or off and wait. Raises DriverError if the E-stop chain does not close."""
        if not on:
            self._forget()
            if not self._link.lost:
                self._link.say("off")
            return
        demand_no_fault(self.fault)
        if self._powered:
            return
        self._order = self._link.say("enable")
        if not self._link.wait(lambda: self._link.told.get("powered") is True, _POWER):
            self._link.say("off")
            raise DriverError(
                "the drives stay off because HAL's E-stop chain does not close; check the E-stop "
                "button and look for faults",
                "no-power",
            )
        self.take()
        self.queue.rest_at(self._actual)
        self._on = True

    def stop(self, how: Stop) -> None:
        """Brake on the path within a few milliseconds, or switch off at once with ``Stop.OFF``."""
        if self._link.lost:
            self._forget()
            return
        if how is Stop.RAMP_HOLD and self._powered:
            self.homing = None
            self._link.say("brake")
            self.queue.brake(self._now() + self.commit, [axis.amax for axis in self.config.axes])
            return
        self._forget()
        self._link.say("off" if how is Stop.OFF else "ramp-off")

    def home(self, axis: str) -> None:
        """Start to home an axis; ``sample().homed`` becomes True when it is done. Raises DriverError."""
        demand_axis(axis, self.axes)
        index = self.axes.index(axis)
        figures = self.config.axes[index]
        if figures.absolute or figures.pins is None:
            return
        self._need_power()
        demand_standstill(axis, self.sample().moving)
        self._homed[index] = False
        self.homing = Homing(figures, index, self)

    def clear_fault(self) -> None:
        """Clear the fault; the drives remain off. Raises DriverError.

        HAL is loaded again if the bridge has ended, the servo thread has stopped or the board is not
        reachable. hm2_eth reconnects to a card only when it is loaded.
        """
        if self._link.told.get("stands") is True or self._link.is_stale:
            self._link.give_up()
        if self._link.lost:
            self._link.connect()
            self.connected()
        self._forget()
        order = self._link.say("clear")
        self._link.wait(lambda: self._link.done(order), 0.5)
        for clear in self.clearing:
            clear()
        self.fault = ""

    # --- for C on the spindle drive ------------------------------------------------------------------------

    def lend(self, axis: int | None, raw: float = 0.0, count: float = 0.0) -> None:
        """Release C to the spindle with an unchanged count, or engage C if ``axis`` is None.

        When C is engaged, ``raw`` is its position in HAL and ``count`` is its position in the control.
        """
        held, self._lent = self._lent, axis
        # HAL continues to play this setpoint, independent of the feedback.
        place = list(self.queue.demand_at(self._now())[0])
        if held is not None and axis is None:
            self.zero[held] = raw - count
            place[held] = count
            self._actual, self._still, self._command = (
                tuple([count if n == held else p for n, p in enumerate(each)])
                for each in (self._actual, self._actual, self._command)
            )
        self.queue.rest_at(place)

    # --- for homing ---------------------------------------------------------------------------------------

    def bit(self, name: str) -> bool:
        """Return a bit of the bridge by its pin, such as ``X.index``."""
        return self._link.bit(name)

    def figure(self, name: str) -> float:
        """Return a number of the bridge by its pin, such as ``X.index-at``."""
        return self._link.figure(name)

    def ask_index(self, pin: str, on: bool) -> None:
        """Request the index of an encoder, or cancel the request."""
        self._link.say("index", pin=pin, on=on)

    def let_limit(self, axis: str, on: bool) -> None:
        """Select whether the limit switch of an axis is ignored, as needed for homing on it."""
        self._link.say("homing", axis=axis, on=on)

    def move(self, segments: Segments) -> None:
        """Splice the setpoints of a homing. Raises DriverError."""
        self.queue.splice(segments, self._now())
        self._send("splice", pieces_of(segments, len(self.axes)))

    def halt(self) -> None:
        """Brake as soon as possible."""
        self._link.say("brake")

    def raw(self, index: int) -> float:
        """Return the position of an axis in HAL's count."""
        return self._actual[index] + self.zero[index]

    def found(self, index: int, zero: float) -> None:
        """Set the home position of an axis to ``zero`` in HAL's count."""
        leap = self.zero[index] - zero
        self.zero[index] = zero
        self._homed[index] = True
        self._actual, self._still, self._command = (
            tuple([p + leap if n == index else p for n, p in enumerate(each)])
            for each in (self._actual, self._still, self._command)
        )
        place = list(self.queue.demand_at(self._now())[0])
        place[index] += leap
        self.queue.rest_at(place)

    # --- inside -------------------------------------------------------------------------------------------

    def _homes(self, index: int) -> bool:
        return self.homing is not None and self.homing.index == index

    @property
    def _rolls(self) -> bool:
        """Whether an axis has moved recently, according to its feedback."""
        return self._t - self._moved < _STILL

    @property
    def _powered(self) -> bool:
        return self._on and self._link.told.get("powered") is True and not self.fault

    def _need_power(self) -> None:
        demand_power(self.fault, self._powered)

    def _check(self, segments: Segments) -> None:
        check_limits(segments, self.config.axes, self._homed, self._actual)

    def _send(self, what: str, pieces: Sequence[Piece], **values: object) -> None:
        self._link.say_pieces(what, [self._to_hal(piece) for piece in pieces], **values)

    def _to_hal(self, piece: Piece) -> Piece:
        p = tuple([piece.p[n] + self.zero[n] for n in self._driven])
        return Piece(
            piece.t, piece.dt, p, *(tuple([each[n] for n in self._driven]) for each in (piece.v, piece.a))
        )

    def _from_hal(self, piece: Piece) -> Piece:
        p, v, a = list(self.queue.demand_at(piece.t)[0]), [0.0] * len(self.axes), [0.0] * len(self.axes)
        for k, n in enumerate(self._driven):
            p[n], v[n], a[n] = piece.p[k] - self.zero[n], piece.v[k], piece.a[k]
        return Piece(piece.t, piece.dt, tuple(p), tuple(v), tuple(a))

    def _home_on(self) -> None:
        homing = self.homing
        if homing is None:
            return
        try:
            homing.step(self._now())
        except DriverError as error:
            self.fault = self.fault or error.fault
            self.stop(Stop.RAMP_OFF)
            return
        if homing.done:
            self.homing = None

    @property
    def resting(self) -> bool:
        """Whether the queue is empty and no axis moves."""
        return at_rest(self.queue.horizon(self._now()), self._now()) and not self._rolls


def _nobody(*_figures: float) -> None:
    """Ignore a sample."""
