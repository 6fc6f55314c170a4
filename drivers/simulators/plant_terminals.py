"""Inputs and outputs of the simulated machine, with the collet and the tool setter that are wired to them."""

from __future__ import annotations

import random
from collections.abc import Mapping

from core.ports import PROBE_INPUT, DriverError
from drivers.port_checks import find_output
from drivers.simulators.plant_config import SimCollet, SimOutput, SimToolSetter


class SimulatedToolSetter:
    """Simulated tool setter that latches the axis positions when its input turns on."""

    def __init__(self, config: SimToolSetter) -> None:
        self._config = config
        self.is_touched = False
        self.max_penetration_mm = 0.0  # Largest penetration of a tip into the stylus in mm.
        self.kept: tuple[float, tuple[float, ...]] | None = None

    def update_touch(self, time_s: float, x: float, z: float, readings: tuple[float, ...]) -> None:
        """Update the input at time ``time_s`` from the axis positions ``x`` and ``z``.

        At a touch, the encoder readings are latched.
        """
        config = self._config
        half = config.stylus_width_mm / 2.0
        depths = [
            half - max(abs(x - tip_x - config.x_mm), abs(z - tip_z - config.z_mm))
            for tip_x, tip_z in config.tip_positions
        ]
        depth = max(depths, default=-1.0)
        if depth > 0.0 and not self.is_touched and self.kept is None:
            self.kept = (time_s, readings)
        self.is_touched = depth > 0.0
        self.max_penetration_mm = max(self.max_penetration_mm, depth)


_GUARD_INPUT = "guard"


class SimulatedTerminals:
    """Simulated terminals of the machine.

    Outputs have the state that was written last. Inputs have the state of the wired device, or the state
    that a test sets.
    """

    def __init__(
        self, outputs: Mapping[str, SimOutput], inputs: tuple[str, ...], collet: SimCollet, seed: int
    ) -> None:
        self._models = dict(outputs)
        self.output_states = {name: model.power_up_state for name, model in outputs.items()}
        self.input_states = {
            name: name == _GUARD_INPUT for name in inputs
        }  # The guard is closed at the start.
        self.is_collet_sensor_stuck = False
        self.write_count = 0  # Number of calls of `write`.
        self.setter: SimulatedToolSetter | None = None
        self._collet = collet
        self._random = random.Random(seed)
        self._closed_at = 0.0 if self.output_states.get(collet.output_name, False) else float("inf")

    def write(self, name: str, state: bool, now: float) -> None:
        """Switch an output.

        Raises DriverError if the machine does not have the output.
        """
        find_output(name, self.output_states)
        if name == self._collet.output_name and state != self.output_states[name]:
            self._closed_at = now + self._late(self._collet.close_time_s) if state else float("inf")
            self._opened_at = now + self._late(self._collet.open_time_s)
        self.output_states[name] = state
        self.write_count += 1

    def switch_to_safe_state(self, now: float) -> None:
        """Set every output to its safe state; outputs without a safe state do not change."""
        for name, model in self._models.items():
            if model.safe_state is not None:
                self.write(name, model.safe_state, now)

    def set_input(self, name: str, state: bool) -> None:
        """Set an input.

        Raises DriverError if the input does not exist.
        """
        if name not in self.input_states:
            raise DriverError(
                "input {name} is not in the machine file; add it under [io.in]", name=f"{name!r}"
            )
        self.input_states[name] = state

    def read_inputs(self, now: float) -> dict[str, bool]:
        """Return the states of all inputs by name.

        The collet switch follows the collet, unless the switch is stuck.
        """
        name = self._collet.closed_input_name
        if name in self.input_states and not self.is_collet_sensor_stuck:
            self.input_states[name] = self.is_collet_closed(now)
        if self.setter is not None and self.setter.is_touched and PROBE_INPUT in self.input_states:
            return {**self.input_states, PROBE_INPUT: True}
        return dict(self.input_states)

    def is_collet_motion_complete(self, now: float) -> bool:
        """Return whether the collet has finished opening or closing."""
        return self._opened_at <= now and (self._closed_at <= now or self._closed_at == float("inf"))

    def is_collet_closed(self, now: float) -> bool:
        """Return whether the collet is clamped; opening and closing take time."""
        if self.output_states.get(self._collet.output_name, True):
            return now >= self._closed_at
        return now < self._opened_at

    def _late(self, nominal: float) -> float:
        return nominal * (
            1.0
            + self._random.uniform(
                -self._collet.time_variation_fraction, self._collet.time_variation_fraction
            )
        )

    _opened_at = -float("inf")
