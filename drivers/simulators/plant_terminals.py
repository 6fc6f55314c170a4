"""Inputs and outputs of the simulated machine, with the collet and the tool setter that are wired to them."""

from __future__ import annotations

import random
from collections.abc import Mapping

from core.ports import PROBE, DriverError
from drivers.port_parts import output_of
from drivers.simulators.plant_config import SimCollet, SimOutput, SimSetter


class ToolSetter:
    """Simulated tool setter that latches the axis positions when its input turns on."""

    def __init__(self, config: SimSetter) -> None:
        self._config = config
        self.made = False
        self.deepest = 0.0  # Largest penetration of a tip into the stylus in mm.
        self.kept: tuple[float, tuple[float, ...]] | None = None

    def look(self, t: float, x: float, z: float, readings: tuple[float, ...]) -> None:
        """Update the input from the axis positions ``x``, ``z`` and the encoder readings at time ``t``."""
        config = self._config
        half = config.width / 2.0
        depths = [
            half - max(abs(x - tip_x - config.x), abs(z - tip_z - config.z)) for tip_x, tip_z in config.tips
        ]
        depth = max(depths, default=-1.0)
        if depth > 0.0 and not self.made and self.kept is None:
            self.kept = (t, readings)
        self.made = depth > 0.0
        self.deepest = max(self.deepest, depth)


_GUARD = "guard"


class Terminals:
    """Simulated terminals: outputs as last written, inputs as wired or as a test sets them."""

    def __init__(
        self, outputs: Mapping[str, SimOutput], inputs: tuple[str, ...], collet: SimCollet, seed: int
    ) -> None:
        self._models = dict(outputs)
        self.outputs = {name: model.initial for name, model in outputs.items()}
        self.inputs = {name: name == _GUARD for name in inputs}  # The guard is closed at the start.
        self.sensor_stuck = False
        self.writes = 0  # Number of calls of `write`.
        self.setter: ToolSetter | None = None
        self._collet = collet
        self._random = random.Random(seed)
        self._closed_at = 0.0 if self.outputs.get(collet.output, False) else float("inf")

    def write(self, name: str, on: bool, now: float) -> None:
        """Switch an output. Raises DriverError for a name that the machine does not have."""
        output_of(name, self.outputs)
        if name == self._collet.output and on != self.outputs[name]:
            self._closed_at = now + self._late(self._collet.close_time) if on else float("inf")
            self._opened_at = now + self._late(self._collet.open_time)
        self.outputs[name] = on
        self.writes += 1

    def safe(self, now: float) -> None:
        """Set every output to its safe state; outputs without a safe state do not change."""
        for name, model in self._models.items():
            if model.safe is not None:
                self.write(name, model.safe, now)

    def set_input(self, name: str, on: bool) -> None:
        """Set an input. Raises DriverError for an unknown name."""
        if name not in self.inputs:
            raise DriverError(
                "input {name} is not in the machine file; add it under [io.in]", name=f"{name!r}"
            )
        self.inputs[name] = on

    def read(self, now: float) -> dict[str, bool]:
        """Return all inputs by name; the collet switch follows the collet unless it is stuck."""
        name = self._collet.closed_input
        if name in self.inputs and not self.sensor_stuck:
            self.inputs[name] = self.closed(now)
        if self.setter is not None and self.setter.made and PROBE in self.inputs:
            return {**self.inputs, PROBE: True}
        return dict(self.inputs)

    def settled(self, now: float) -> bool:
        """Return whether the collet has finished opening or closing."""
        return self._opened_at <= now and (self._closed_at <= now or self._closed_at == float("inf"))

    def closed(self, now: float) -> bool:
        """Return whether the collet clamps. Opening and closing take time."""
        if self.outputs.get(self._collet.output, True):
            return now >= self._closed_at
        return now < self._opened_at

    def _late(self, nominal: float) -> float:
        return nominal * (1.0 + self._random.uniform(-self._collet.spread, self._collet.spread))

    _opened_at = -float("inf")
