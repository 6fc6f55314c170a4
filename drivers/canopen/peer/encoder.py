"""A CiA 406 encoder on the simulated spindle, and the second input of a drive with one behind it."""

from __future__ import annotations

from collections.abc import Callable

from drivers.canopen import objects as od
from drivers.simulated.plant import Plant

TURNS = 4096  # it goes round after so many


class EncoderDevice:
    """``stuck`` no longer turns with the spindle: its coupling has come off."""

    def __init__(self, plant: Plant, counts: int) -> None:
        self._plant = plant
        self.counts = counts  # a turn, signed
        self.turns = TURNS
        self.steps = abs(counts)  # as it says of itself
        self.stuck: int | None = None
        self.values: dict[tuple[int, int], int] = {}

    def read(self, index: int, _sub: int) -> int | None:
        """What lives in the device."""
        live: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020196,
            od.ENCODER_RESOLUTION: lambda: self.steps,
            od.ENCODER_TURNS: lambda: self.turns,
            od.ENCODER_POSITION: lambda: self.position % (self.steps * self.turns),
        }
        return live[index]() if index in live else None

    @property
    def position(self) -> int:
        """Counts since it was made."""
        return round(self._plant.spindle.turns * self.counts) if self.stuck is None else self.stuck

    def come_off(self) -> None:
        """The coupling: it stays where it is."""
        self.stuck = self.position

    def write(self, index: int, sub: int, value: int) -> None:
        """What the host says."""
        self.values[index, sub] = value

    def host_lost(self) -> None:
        """It only measures."""

    def reset(self) -> None:
        """It knows its turns without power."""
        self.values.clear()
