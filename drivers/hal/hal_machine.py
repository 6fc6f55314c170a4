"""The machine behind HAL: connected, then ticked by the one loop that owns its bridge."""

from __future__ import annotations

from collections.abc import Callable

from core.ports import ALL_UNKNOWN, Clock, DriverError, FloatArray, MachinePorts, Unknown
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_link import HalLink
from drivers.hal.hal_session import BridgeLink, bridge_config
from drivers.hal.hal_spindle import HalOrientation, HalSpindle, HalSpindleC
from drivers.hal.hal_terminals import HalTerminals
from drivers.sample_log import KEPT, SampleLog


class HalSamples:
    """``core.ports.SampleSource``: every period of the servo thread."""

    def __init__(self, axes: HalAxes, period: float) -> None:
        self.rate = 1.0 / period
        self._log = SampleLog(len(axes.axes))
        axes.keep_samples(self._log.add)

    def take(self, most: int = KEPT) -> FloatArray:
        """What has come since."""
        return self._log.take(most)


class HalMachine:
    """Connects when made. Raises DriverError with the first pin that is not as the machine file says."""

    def __init__(
        self,
        config: HalConfig,
        clock: Clock,
        open_link: Callable[[], BridgeLink],
        idle: Callable[[], object] | None = None,
    ) -> None:
        self.config = config
        self.clock = clock
        self.link = HalLink(open_link, clock, bridge_config(config), idle)
        self.axes = HalAxes(config, self.link, clock.now)
        self.spindle = HalSpindle(config, self.link, self.axes)
        self.c = _spindle_as_c(config, self.axes, self.spindle, self.link)
        turned = config.spindle.turned and bool(config.spindle.pins.orient)
        self.orientation = HalOrientation(self.axes, self.spindle, self.link) if turned else None
        self.axes.clearing.append(self.spindle.index.clear)
        self.axes.connecting.append(self.spindle.index.forget)
        self.io = HalTerminals(config, self.link, clock.now)
        self.samples = HalSamples(self.axes, config.table.period)
        try:
            self.link.connect()
        except DriverError:
            self.link.close()
            raise
        self.axes.connected()

    @property
    def ports(self) -> MachinePorts:
        """What the executor drives; the terminals are the operator station too."""
        follows = self.config.spindle.encoder and bool(self.config.spindle.pins.position)
        return MachinePorts(
            clock=self.clock,
            axes=self.axes,
            spindle=self.spindle,
            io=self.io,
            station=self.io,
            gear=self.axes if follows else None,
            lock=self.c,
            orientation=self.orientation,
            touch=self.axes.touch,
            samples=self.samples,
            unknown=self.unknown,
            warnings=self.link.warnings,
        )

    def unknown(self) -> frozenset[Unknown]:
        """Without a word of the bridge, or of HAL to it, nothing is known."""
        return ALL_UNKNOWN if self.link.blind else frozenset()

    def tick(self) -> None:
        """One round: take in, supervise, say that this side lives. Call it every few milliseconds."""
        self.link.pump()
        self.axes.tick()
        self.spindle.tick()
        if self.c is not None:
            self.c.tick()
        if self.orientation is not None:
            self.orientation.tick()
        self.link.beat()

    def close(self) -> None:
        """The bridge brakes, stops the spindle and takes the power; HAL is taken down."""
        self.link.close()


def _spindle_as_c(config: HalConfig, axes: HalAxes, spindle: HalSpindle, link: HalLink) -> HalSpindleC | None:
    """None where C has a drive of its own, or there is none."""
    number = next((n for n, axis in enumerate(config.axes) if axis.is_spindle), None)
    if number is None:
        return None
    told = "spindle.in_position_mode" if config.spindle.pins.in_position_mode else ""
    return HalSpindleC(axes, spindle, link, number, told)
