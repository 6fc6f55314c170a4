"""The whole machine on one bus: connected in order, then ticked by the one loop that owns it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.ports import ALL_UNKNOWN, Clock, DriverError, FloatArray, MachinePorts, Spindle, Stop, Unknown
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_encoder import CanEncoder, MeasuredSpindle
from drivers.canopen.canopen_objects import DriveState
from drivers.canopen.canopen_spindle import CanopenSpindle
from drivers.canopen.canopen_terminals import CanopenIO
from drivers.canopen.cia402_drives import Drive402
from drivers.canopen.spindle_as_c import SpindleC
from drivers.sample_log import KEPT, SampleLog

_NAN = float("nan")
_UNTRACED = (
    'the drives plan single moves by themselves ([canopen] mode = "pp"): no test can be played to them'
)
_FIRST = 0.5  # s in which everything must have answered a first SYNC


class CanopenSamples:
    """``core.ports.SampleSource``: what the drives have answered to each SYNC."""

    def __init__(self, axes: CanopenAxes, spindle: Spindle, sync: float) -> None:
        self.rate = 1.0 / sync
        self._axes, self._spindle = axes, spindle
        self._log = SampleLog(len(axes.axes))

    def note(self, now: float) -> None:
        """Keep the answers of a SYNC that is newer than the last."""
        if self._axes.drives.seen <= self._log.last:
            return
        sample, angle = self._axes.sample(), self._spindle.angle()
        turns = angle[1] if angle is not None else _NAN
        load = (_NAN,) * len(sample.actual)
        left = self._axes.queue.horizon(now) - now
        self._log.add(
            sample.t, *sample.demand, *sample.actual, *load, self._spindle.speed(), turns, _NAN, left
        )

    def take(self, most: int = KEPT) -> FloatArray:
        """What has been kept since."""
        return self._log.take(most)


class CanopenMachine:
    """Connects when made. Raises DriverError with the first node that is not as the machine file says."""

    def __init__(self, config: CanopenConfig, clock: Clock, idle: Callable[[], None] | None = None) -> None:
        self.config = config
        self.clock = clock
        self.bus = Bus(config.bus, clock, idle)
        self._next = clock.now()
        try:
            self.axes = CanopenAxes(config, self.bus)
            self.spindle = CanopenSpindle(config.spindle, self.bus) if config.spindle else None
            drives = {axis.config.name: axis.drive for axis in self.axes.drives.axes}
            self.io = CanopenIO(config, self.bus, drives)
            self.axes.clearing = [self.io.clear_fault]
            if self.spindle is not None:
                self.axes.clearing.append(self.spindle.clear_fault)
            self.encoder = self._encoder(drives)
            self.c = self._spindle_c()
            self.samples = CanopenSamples(self.axes, self._turning, config.bus.sync)
            self._connect()
        except DriverError:
            self.bus.close()
            raise

    def _encoder(self, drives: Mapping[str, Drive402]) -> CanEncoder | None:
        config = self.config.encoder
        if config is None:
            return None
        encoder = CanEncoder(config, self.bus, None if config.node else drives[config.name])
        self.axes.clearing.append(encoder.clear_fault)
        return encoder

    def _spindle_c(self) -> SpindleC | None:
        if self.spindle is None or self.config.spindle is None or not self.config.spindle.is_c:
            return None
        found = SpindleC(self.axes, self.spindle, "C")
        self.axes.clearing.append(found.clear_fault)
        return found

    @property
    def _turning(self) -> Spindle:
        return self.spindle or MeasuredSpindle(self.encoder)

    @property
    def ports(self) -> MachinePorts:
        """What the executor drives; the terminals are the operator station too."""
        return MachinePorts(
            clock=self.clock,
            axes=self.axes,
            spindle=self._turning,
            io=self.io,
            station=self.io,
            lock=self.c,
            samples=self.samples,
            unknown=self.unknown,
            untraced=_UNTRACED if self.config.mode == "pp" else "",
            warnings=tuple(each for axis in self.axes.drives.axes for each in axis.drive.setup.warnings),
        )

    def unknown(self) -> frozenset[Unknown]:
        """What has not answered of late; of a bus that has failed nothing is known."""
        if self.bus.trouble:
            return ALL_UNKNOWN
        found: set[Unknown] = set()
        if any(axis.drive.silent for axis in self.axes.drives.axes):
            found.add(Unknown.SLIDES)
        if self.spindle is not None and self.spindle.drive.silent:
            found.add(Unknown.SPINDLE)
        if any(module.silent for module in self.io.modules.values()):
            found |= {Unknown.OUTPUTS, Unknown.INPUTS}
        return frozenset(found)

    def tick(self) -> None:
        """One round: take in, supervise, feed, send, SYNC. Call it every few milliseconds."""
        self.bus.pump()
        now = self.clock.now()
        self.axes.tick(now)
        self.samples.note(now)
        if self.bus.trouble:
            return
        try:
            self.axes.beside = self.io.tick(now) or (self.c.trouble if self.c is not None else "")
            if self.spindle is not None:
                self.spindle.tick()
            if self.c is not None:
                self.c.tick(now)
            if self.encoder is not None:
                self.encoder.look()
            if now >= self._next or self.axes.follower.urgent:
                self._next = max(self._next, now - self.config.bus.sync) + self.config.bus.sync
                self.axes.follower.urgent = False
                self._exchange()
        except DriverError as error:
            self.bus.lost(str(error))

    def close(self) -> None:
        """Power off as far as the bus still works, and let it go."""
        if not self.bus.trouble:
            self.axes.stop(Stop.RAMP_OFF)
            self.io.safe()
            if self.spindle is not None:
                self.spindle.coast()
                if self.spindle.drive not in self.axes.drives.drives:
                    self.spindle.drive.goal = DriveState.OFF  # also on its way to C
                self._exchange()
        self.bus.close()

    def _connect(self) -> None:
        """NMT start only after all have been configured."""
        self.axes.connect()
        if self.spindle is not None:
            self.spindle.connect()
        if self.encoder is not None:
            self.encoder.connect()
        self.io.connect()
        self.axes.drives.operational()
        if self.spindle is not None:
            self.spindle.drive.operational()
        if self.encoder is not None:
            self.encoder.operational()
        self.io.operational()
        self.bus.beat(at_once=True)
        self._exchange()
        self.bus.wait(self._answered, _FIRST)

    def _answered(self) -> bool:
        drives = [axis.drive for axis in self.axes.drives.axes]
        if self.spindle is not None:
            drives.append(self.spindle.drive)
        silent = [drive.missing for drive in drives] + [m.missing for m in self.io.modules.values()]
        if self.encoder is not None:
            silent.append(self.encoder.missing)
        return not any(silent)

    def _exchange(self) -> None:
        self.axes.drives.command()
        if self.spindle is not None and self.spindle.drive not in self.axes.drives.drives:
            self.spindle.drive.command()
        if self.encoder is not None:
            self.encoder.sync_sent()
        for module in self.io.modules.values():
            module.sync_sent()
        self.bus.synchronise()
