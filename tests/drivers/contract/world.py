"""The machine as it really is, whatever its driver believes; and the operator's hands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

from drivers.simulators.plant_controls import PlantControls

Readings = Mapping[str, bool]


class World(Protocol):
    """Behind every bench of the contract. ``press_start`` is both palms down and up again."""

    def place(self) -> tuple[float, float]:
        """X and Z, mm."""
        ...

    def rpm(self) -> float: ...

    def outputs(self) -> Readings:
        """What hangs on the outputs, by their names: on or off."""
        ...

    def set_input(self, name: str, on: bool, /) -> None: ...

    def press_start(self) -> None: ...

    def press_hold(self) -> None: ...

    def release_hold(self) -> None: ...

    def press_estop(self) -> None:
        """The chain of relays, not a word to any program."""
        ...

    def release_estop(self) -> None: ...

    def set_feed_pot(self, fraction: float, /) -> None: ...

    def set_spindle_auto(self, auto: bool, /) -> None: ...

    def open_collet(self) -> None:
        """By hand: its switch says so, whatever the valve is told."""
        ...

    def silence_station(self) -> None:
        """Its cable is off, that of the E-stop is not."""
        ...

    def spindle_ignores_stop(self) -> None: ...

    def spindle_dies(self) -> None:
        """Whatever is commanded, it runs down."""
        ...


class SimWorld:
    """The simulated lathe, as the machine itself or behind drives on a bus."""

    def __init__(self, hands: PlantControls, outputs: Callable[[], Readings]) -> None:
        self.hands = hands
        self.outputs = outputs
        self.set_input = hands.set_input
        self.press_start, self.press_hold = hands.press_start, hands.press_hold
        self.release_hold = hands.release_hold
        self.set_feed_pot, self.set_spindle_auto = hands.set_feed_pot, hands.set_spindle_auto

    def place(self) -> tuple[float, float]:
        """X and Z."""
        x, z, *_ = self.hands.get_true_positions()
        return x, z

    def rpm(self) -> float:
        """By the motor."""
        return self.hands.get_spindle_rpm()

    def press_estop(self) -> None:
        """Slides brake and lose power, the spindle too."""
        self.hands.press_estop()

    def release_estop(self) -> None:
        """Free."""
        self.hands.release_estop()

    def open_collet(self) -> None:
        """The switch is open and stays so."""
        self.hands.collet_sensor_stuck()
        self.hands.set_input("collet_closed", False)

    def silence_station(self) -> None:
        """Nothing comes any more."""
        self.hands.station_silent()

    def spindle_ignores_stop(self) -> None:
        """The inverter no longer obeys."""
        self.hands.spindle_ignores_stop()

    def spindle_dies(self) -> None:
        """The belt slips."""
        self.hands.spindle_bog(0.3)
