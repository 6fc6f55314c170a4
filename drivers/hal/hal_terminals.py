"""Inputs, outputs, pots, operator station and probe on HAL's pins, by the names of the machine file."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.ports import DriverError, Latch, StationState
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_link import HalLink
from drivers.operator_station import station_of
from drivers.port_parts import FirstTouch, demand_output, output_of


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


# --- The probe: HAL samples its input and the places of the axes in one period.


class HalTouch(FirstTouch):
    """Touches by HAL's samples."""

    def __init__(self, period: float, *, active_low: bool) -> None:
        super().__init__()
        self._period, self._low = period, active_low

    def see(self, t: float, place: tuple[float, ...], raw: bool) -> None:
        """One period of the servo thread: its input, and where the slides were."""
        if self._touches(raw is not self._low):
            self._kept = Latch(t, place, self._period)
