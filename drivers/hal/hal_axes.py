"""The slides behind ``core.ports.AxisSink`` and ``Gear``: setpoints here, played by the bridge and HAL."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence

from core.faults import code_of
from core.message import Message
from core.ports import AxisSample, Cam, DriverError, Fault, Geared, Segments, Stop, at_rest
from drivers.hal.bridge.packets import number
from drivers.hal.bridge.packets import pieces_of as pieces_told
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_homing import Homing
from drivers.hal.hal_link import HalLink, told_fault
from drivers.hal.hal_touch import HalTouch
from drivers.setpoint_pieces import Piece
from drivers.setpoint_queue import Tolerance, check_limits, pieces_of
from drivers.spindle_gear import GearedQueue, Motion, Phase, Slides

_PAST = 0.5  # s of setpoints that may still be asked for
_POWER = 1.5  # s for the drives' power
_STILL = 0.1  # s without a count after which a slide stands
_SPEED_OVER = 0.05  # s
_NAN = float("nan")


class HalQueue(GearedQueue):
    """As GearedQueue, but the bridge says when the way over the spindle's turns is over."""

    def follow(self, t: float, turns: float) -> Motion | None:
        """One sample of the spindle while the slides follow it."""
        return None if self._gearing is None else self._gearing.play(t, t, turns)

    def left(self, t: float) -> None:
        """The way is over, and what goes on by time has begun."""
        if self._gearing is not None:
            self._leave(t, self._gearing)

    def braked(self, t: float, pieces: list[Piece]) -> None:
        """The bridge has braked by itself."""
        if self._gearing is not None:
            self.rest_at(pieces[0].p)
        self.replace(t, pieces)


class HalAxes:
    """Used by the one thread that owns the bridge."""

    def __init__(self, config: HalConfig, link: HalLink, now: Callable[[], float]) -> None:
        self.config = config
        self._link = link
        self._now = now
        self.axes = tuple(axis.name for axis in config.axes)
        self.commit = config.commit
        self._driven = [n for n, axis in enumerate(config.axes) if axis.pins is not None]
        slides = Slides(
            self.axes,
            tuple(axis.vmax for axis in config.axes),
            tuple(axis.amax for axis in config.axes),
            config.commit,
            Tolerance.of(config.axes),
        )
        self.queue = HalQueue(slides, (0.0,) * len(self.axes))
        self.zero = [0.0] * len(self.axes)  # where home is, as HAL counts
        self._homed = [axis.absolute or axis.pins is None for axis in config.axes]
        self.homing: Homing | None = None
        self.fault: Fault | str = ""
        self.clearing: list[Callable[[], None]] = []  # who else has something to forget
        self.connecting: list[Callable[[], None]] = []  # and when HAL has come up anew
        self.spindle_at: tuple[float, float] | None = None  # time and turns of the newest sample
        self.index_at = 0.0  # turns at which the spindle's index was, as HAL counts
        probe = config.probe
        self.touch = HalTouch(config.table.period, active_low=probe.active_low) if probe is not None else None
        # An axis that turns as the spindle: it stays at its count. None: it is held, or there is none.
        self._lent = next((n for n, axis in enumerate(config.axes) if axis.is_spindle), None)
        self.c_turns = False  # C has its count from the index, and is to turn to its place, or does
        self.rps = 0.0
        self._on = False
        self._order = 0  # the one after which the bridge's word on power counts
        self._t = 0.0
        self._command = self._actual = (0.0,) * len(self.axes)
        self._moved = -math.inf  # when a slide has moved last
        self._still = self._actual
        self._brakings = 0.0
        self._samples: Callable[..., None] = _nobody
        self._marks = [n for n, axis in enumerate(config.axes) if axis.switch]
        self._turned: deque[tuple[float, float]] = deque()

    # --- what comes from the bridge -----------------------------------------------------------------------

    def connected(self) -> None:
        """HAL has come up, or anew: only what is absolute knows where it is."""
        self._homed = [axis.absolute or axis.pins is None for axis in self.config.axes]
        self._brakings = number(self._link.told, "brakings")
        self._on = False
        for forget in self.connecting:
            forget()
        self.take()
        self.queue.rest_at(self._actual)

    def keep_samples(self, keep: Callable[..., None]) -> None:
        """Who wants each sample: time, demand, actual, turns/s, turns, how long the queue goes on."""
        self._samples = keep

    def take(self) -> None:
        """The samples that have come."""
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
        """Turns/s over the last samples, where HAL tells no velocity."""
        turned = self._turned
        turned.append((t, turns))
        while turned[0][0] < t - _SPEED_OVER:
            turned.popleft()
        since = t - turned[0][0]
        self.rps = (turns - turned[0][1]) / since if since > 0.0 else self.rps

    def _counted(self, raw: Sequence[float], t: float) -> tuple[float, ...]:
        """As the control counts; an axis without pins is where the queue has it."""
        place = list(self.queue.demand_at(t)[0])
        for value, index in zip(raw, self._driven, strict=True):
            if index != self._lent:
                place[index] = value - self.zero[index]
        return tuple(place)

    def tick(self) -> None:
        """Supervise and home. Raises nothing: what is wrong becomes the fault."""
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
        """What the bridge has begun or ended by itself."""
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
        """Power was taken away: E-stop, a drive's fault. Who only counts has lost its place."""
        self._forget()
        for index in self._driven:
            self._homed[index] = self.config.axes[index].absolute

    def _forget(self) -> None:
        self._on, self.homing = False, None
        self.queue.rest_at(self._actual)

    # --- the port -----------------------------------------------------------------------------------------

    def now(self) -> float:
        """The machine's clock."""
        return self._now()

    def horizon(self) -> float:
        """End of what is queued; now when nothing is."""
        return self.queue.horizon(self._now())

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Queued position and velocity at ``t``."""
        return self.queue.demand_at(t)

    def splice(self, segments: Segments) -> None:
        """Queue setpoints. Raises DriverError as the port says, and for what the axes cannot do."""
        self._need_power()
        if self.homing is not None:
            raise DriverError(
                Message("{name} is homing; wait until homing is complete", name=self.homing.name),
                reason="homing",
            )
        self._check(segments)
        self.queue.splice(segments, self._now())
        self._send("splice", pieces_of(segments, len(self.axes)))

    def mesh(self, cam: Cam) -> None:
        """Follow the spindle. Raises DriverError as the port says."""
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
        """Where on the cam the slides are."""
        return self.queue.geared()

    def sample(self) -> AxisSample:
        """The axes as HAL has sampled them last."""
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
        """Power on or off, and wait for it. Raises DriverError where the chain does not close."""
        if not on:
            self._forget()
            if not self._link.lost:
                self._link.say("off")
            return
        if self.fault:
            raise DriverError(
                Message(
                    "the drives stay off because of a fault ({fault}); clear the fault first",
                    fault=self.fault,
                ),
                "no-power",
            )
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
        """Brake on the path, as soon as HAL can be told: within some milliseconds; or off at once."""
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
        """Look for home; ``sample().homed`` says when it is found. Raises DriverError."""
        if axis not in self.axes:
            raise DriverError(Message("axis {axis} does not exist", axis=f"{axis!r}"), reason="no-axis")
        index = self.axes.index(axis)
        figures = self.config.axes[index]
        if figures.absolute or figures.pins is None:
            return
        self._need_power()
        if self.sample().moving:
            raise DriverError(
                Message(
                    "{axis} cannot home while an axis is moving; wait until all axes are at rest", axis=axis
                ),
                "homing",
                reason="axis-moves",
            )
        self._homed[index] = False
        self.homing = Homing(figures, index, self)

    def clear_fault(self) -> None:
        """Forget the fault; the drives stay off. Raises DriverError.

        HAL is loaded again where its bridge is gone, its thread has stopped or its board is not reached:
        hm2_eth returns to a card only then.
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

    # --- for C on the spindle's drive ----------------------------------------------------------------------

    def lend(self, axis: int | None, raw: float = 0.0, count: float = 0.0) -> None:
        """C is the spindle from here on, and keeps its count; ``axis`` None: it is held where HAL counts
        ``raw``, and ``count`` is what that is to the control.
        """
        held, self._lent = self._lent, axis
        place = list(self.queue.demand_at(self._now())[0])  # HAL goes on playing it, whatever is fed back
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
        """One of the bridge's bits, such as ``X.index``."""
        return self._link.bit(name)

    def figure(self, name: str) -> float:
        """One of its numbers, such as ``X.index-at``."""
        return self._link.figure(name)

    def ask_index(self, pin: str, on: bool) -> None:
        """Ask an encoder for its index, or no longer."""
        self._link.say("index", pin=pin, on=on)

    def let_limit(self, axis: str, on: bool) -> None:
        """Its limit switch is looked for: it stops nothing."""
        self._link.say("homing", axis=axis, on=on)

    def move(self, segments: Segments) -> None:
        """Setpoints of a homing. Raises DriverError."""
        self.queue.splice(segments, self._now())
        self._send("splice", pieces_of(segments, len(self.axes)))

    def halt(self) -> None:
        """Brake as soon as can be."""
        self._link.say("brake")

    def raw(self, index: int) -> float:
        """Where HAL counts this axis to be."""
        return self._actual[index] + self.zero[index]

    def found(self, index: int, zero: float) -> None:
        """Home is here, as HAL counts."""
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
        """Whether a slide has moved of late, by what it feeds back."""
        return self._t - self._moved < _STILL

    @property
    def _powered(self) -> bool:
        return self._on and self._link.told.get("powered") is True and not self.fault

    def _need_power(self) -> None:
        if self.fault:
            raise DriverError(
                Message("{fault}; clear the fault first", fault=self.fault), code_of(self.fault, "axis")
            )
        if not self._powered:
            raise DriverError("the drives are off; switch them on first", "power-lost")

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
        """Nothing is queued, and nothing moves."""
        return at_rest(self.queue.horizon(self._now()), self._now()) and not self._rolls


def _nobody(*_figures: float) -> None:
    """Wants no samples."""
