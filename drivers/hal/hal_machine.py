"""The machine behind HAL: connected, then ticked by the one loop that owns its bridge.

Its inputs, outputs, pots and operator station are on HAL's pins, by the names of the machine file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.ports import ALL_UNKNOWN, Clock, DriverError, FloatArray, MachinePorts, StationState, Unknown
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_link import HalLink
from drivers.hal.hal_session import BridgeLink, bridge_config
from drivers.hal.hal_spindle import HalOrientation, HalSpindle, HalSpindleC
from drivers.operator_station import station_of
from drivers.port_parts import KEPT, SampleLog, demand_output, output_of


class HalTerminals:
    """``core.ports.DigitalIO`` and ``Station``."""

    def __init__(self, config: HalConfig, link: HalLink, now: Callable[[], float]) -> None:
        self._config = config
        self._link = link
        self._now = now
        self._written: dict[str, tuple[bool, int]] = {}  # orders that the bridge has not carried out yet

    def inputs(self) -> Mapping[str, bool]:
        """All inputs by name; active is True."""
        told = self._link.told.get("in")
        raw = told if isinstance(told, list) else [False] * len(self._config.inputs)
        wired = zip(self._config.inputs.items(), raw, strict=True)
        return {name: on is not each.active_low for (name, each), on in wired}

    def outputs(self) -> Mapping[str, bool]:
        """All outputs as they are at HAL's pins."""
        told = self._link.told.get("is")
        real = told if isinstance(told, list) else [False] * len(self._config.outputs)
        found = {name: on is True for name, on in zip(self._config.outputs, real, strict=True)}
        for name, (on, order) in list(self._written.items()):
            if self._link.done(order):
                del self._written[name]
            else:
                found[name] = on
        return found

    def write(self, name: str, on: bool) -> None:
        """Switch one output. Raises DriverError."""
        output = output_of(name, self._config.outputs)
        demand_output(name, on, self._link.trouble)
        chained = output.safe is not None and not output.lamp
        if chained and on is not output.safe and self._link.told.get("ok") is not True:
            raise DriverError(
                "output {name} does not change because the E-stop chain is open; press Reset",
                "output",
                name=name,
            )
        self._say(name, on)

    def safe(self) -> None:
        """Every output to its safe state."""
        if self._link.lost:
            return
        order = self._link.say("safe")
        for name, output in self._config.outputs.items():
            if output.safe is not None:
                self._written[name] = output.safe, order

    def _say(self, name: str, on: bool) -> None:
        self._written[name] = on, self._link.say("out", name=name, on=on)

    def snapshot(self) -> StationState:
        """The operator station as its pins have it; its age is that of the inputs."""
        return station_of(
            self.inputs(),
            self._config.pots,
            self._analog,
            handwheel=round(self._analog("handwheel")),
            age=self._link.input_age,
        )

    def _analog(self, name: str) -> float:
        """The number at a pin: 1 at the end of a pot's range; 0 where it is not wired."""
        told, names = self._link.told.get("analog"), list(self._config.pots)
        if not isinstance(told, list) or name not in names:
            return 0.0
        return float(told[names.index(name)])


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
