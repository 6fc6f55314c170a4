"""Machine on HAL, driven by the one loop that owns its bridge.

Inputs, outputs, pots and the operator station are HAL pins with the names of the machine file.
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
    """``core.ports.DigitalIO`` and ``Station`` on HAL pins."""

    def __init__(self, config: HalConfig, link: HalLink, now: Callable[[], float]) -> None:
        self._config = config
        self._link = link
        self._now = now
        self._written: dict[str, tuple[bool, int]] = {}  # Commands that the bridge has not executed yet.

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs by name; True is active."""
        told = self._link.told.get("in")
        raw = told if isinstance(told, list) else [False] * len(self._config.inputs)
        wired = zip(self._config.inputs.items(), raw, strict=True)
        return {name: on is not each.active_low for (name, each), on in wired}

    def outputs(self) -> Mapping[str, bool]:
        """Return all outputs by name with the states of their HAL pins."""
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
        """Switch one output. Raises DriverError if the bridge is silent or the E-stop chain is open."""
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
        """Set every output to its safe state."""
        if self._link.lost:
            return
        order = self._link.say("safe")
        for name, output in self._config.outputs.items():
            if output.safe is not None:
                self._written[name] = output.safe, order

    def _say(self, name: str, on: bool) -> None:
        self._written[name] = on, self._link.say("out", name=name, on=on)

    def snapshot(self) -> StationState:
        """Return the state of the operator station; its age is that of the inputs."""
        return station_of(
            self.inputs(),
            self._config.pots,
            self._analog,
            handwheel=round(self._analog("handwheel")),
            age=self._link.input_age,
        )

    def _analog(self, name: str) -> float:
        """Return the value of an analog pin: 1 is the end of a pot's range, 0 if it is not wired."""
        told, names = self._link.told.get("analog"), list(self._config.pots)
        if not isinstance(told, list) or name not in names:
            return 0.0
        return float(told[names.index(name)])


class HalSamples:
    """``core.ports.SampleSource`` with each period of the servo thread."""

    def __init__(self, axes: HalAxes, period: float) -> None:
        self.rate = 1.0 / period
        self._log = SampleLog(len(axes.axes))
        axes.keep_samples(self._log.add)

    def take(self, most: int = KEPT) -> FloatArray:
        """Return at most ``most`` samples since the last call, oldest first."""
        return self._log.take(most)


class HalMachine:
    """Machine on HAL, connected by its constructor.

    The constructor raises DriverError that names the first pin which does not match the machine file.
    """

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
        """The ports for the executor; the terminals are also the operator station."""
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
        """Return the unknown states: all of them if bridge, HAL or board do not respond."""
        return ALL_UNKNOWN if self.link.blind else frozenset()

    def tick(self) -> None:
        """Run one cycle: receive, supervise and send a sign of life.

        It must be called every few milliseconds.
        """
        self.link.pump()
        self.axes.tick()
        self.spindle.tick()
        if self.c is not None:
            self.c.tick()
        if self.orientation is not None:
            self.orientation.tick()
        self.link.beat()

    def close(self) -> None:
        """Close the connection; the bridge brakes and switches off, and HAL is shut down."""
        self.link.close()


def _spindle_as_c(config: HalConfig, axes: HalAxes, spindle: HalSpindle, link: HalLink) -> HalSpindleC | None:
    """Create the C axis of the spindle drive, or return None if C has its own drive or does not exist."""
    number = next((n for n, axis in enumerate(config.axes) if axis.is_spindle), None)
    if number is None:
        return None
    told = "spindle.in_position_mode" if config.spindle.pins.in_position_mode else ""
    return HalSpindleC(axes, spindle, link, number, told)
