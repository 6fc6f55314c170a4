"""Spindle, inputs, outputs, pots and the operator station on HAL's pins, by the names of the machine file."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.message import Message
from core.ports import DriverError, Fault, StationState
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_index import SpindleIndex
from drivers.hal.hal_link import HalLink
from drivers.station_inputs import station_of


class HalSpindle:
    """``core.ports.Spindle``. What E-stop has switched off does not come back by itself."""

    def __init__(self, config: HalConfig, link: HalLink, axes: HalAxes) -> None:
        self._config = config.spindle
        self._link = link
        self._axes = axes
        self.ordered = 0.0  # rpm
        self.lent = False  # its drive is C, or becomes it: what it turns then is not the spindle's speed
        self.index = SpindleIndex(axes, link, wired=bool(config.spindle.pins.index_enable))
        self._unknown: tuple[float, float] | None = None  # what is told of its angle before its index was

    def tick(self) -> None:
        """An open chain has switched it off."""
        if self._link.told.get("ok") is not True:
            self.ordered = 0.0
        self.index.look()

    def run(self, rpm: float) -> None:
        """Turn at ``rpm``, signed. Raises DriverError with a fault or an open chain, unless asked to stop."""
        if rpm and (why := self.fault() or self._axes.fault):
            raise DriverError(Message("the spindle stays off: {problem}", problem=why), "spindle-off")
        if rpm and self._link.told.get("ok") is not True:
            raise DriverError(
                "the spindle stays off because the E-stop chain is open; press Reset", "spindle-off"
            )
        limit = self._config.rpm_max
        self.ordered = min(max(rpm, -limit), limit)
        if not self._link.lost:
            self._link.say("spindle", rpm=self.ordered, on=bool(self.ordered))

    def coast(self) -> None:
        """Speed 0, and off: what its drive makes of that is the drive's."""
        self.run(0.0)

    def speed(self) -> float:
        """Measured rpm, signed; without turns or velocity, what it was told once it is at speed."""
        return 0.0 if self.lent else self.measured()

    def measured(self) -> float:
        """The same, whatever its drive is."""
        pins = self._config.pins
        if pins.position or pins.velocity:
            return 60.0 * self._axes.rps
        return self.ordered if self._link.bit("spindle.at_speed") else 0.0

    def angle(self) -> tuple[float, float] | None:
        """(time, turns) by the encoder, whole turns at its index where it has one; None without one.

        Before its index has come by it is an old reading: who needs the angle waits for a new one.
        """
        if not self._config.encoder or self._axes.spindle_at is None:
            return None
        if not self.index.known:
            self._unknown = self._unknown or self._axes.spindle_at
            return self._unknown
        self._unknown = None
        t, turns = self._axes.spindle_at
        return t, turns - self._axes.index_at

    def fault(self) -> str:
        """What is wrong with it; empty when well."""
        if why := self._link.trouble:
            return why
        if self.index.trouble:
            return self.index.trouble
        wrong = self._link.bit("spindle.fault")
        return Fault("the spindle drive reports a fault", "spindle") if wrong else ""


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
        output = self._config.outputs.get(name)
        if output is None:
            raise DriverError(
                Message("output {name} is not in the machine file; add it under [io.out]", name=f"{name!r}"),
                "output",
            )
        if on and self._link.trouble:
            raise DriverError(
                Message("output {name} stays off: {problem}", name=name, problem=self._link.trouble), "output"
            )
        chained = output.safe is not None and not output.lamp
        if chained and on is not output.safe and self._link.told.get("ok") is not True:
            raise DriverError(
                Message(
                    "output {name} does not change because the E-stop chain is open; press Reset", name=name
                ),
                "output",
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
        pot = self._config.pots.get("spindle_pot")
        return station_of(
            self.inputs(),
            pot_switch=pot.switch if pot is not None else "",
            spindle_pot=self._pot("spindle_pot"),
            feed_pot=self._pot("feed_pot"),
            handwheel=round(self._analog("handwheel", 0.0)),
            age=self._link.input_age,
            spindle_load=self._load(),
        )

    def _load(self) -> float | None:
        """Per cent; its pin is 1 where the machine file's range ends."""
        load = self._config.pots.get("spindle_load")
        if load is None:
            return None
        return load.low + (load.high - load.low) * max(self._analog("spindle_load", 0.0), 0.0)

    def _pot(self, name: str) -> float:
        pot = self._config.pots.get(name)
        if pot is None:
            return 1.0
        return pot.low + (pot.high - pot.low) * min(max(self._analog(name, 0.0), 0.0), 1.0)

    def _analog(self, name: str, otherwise: float) -> float:
        told, names = self._link.told.get("analog"), list(self._config.pots)
        if not isinstance(told, list) or name not in names:
            return otherwise
        return float(told[names.index(name)])
