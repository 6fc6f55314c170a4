"""What the machine is wired to: pots, homing, tables of its drivers, signal tower and sounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple, TypeVar

from core.key_declaration import Pair, Range, file_key, key_table

_Table = TypeVar("_Table")
RED, AMBER, GREEN, BUZZER = "lamp_red", "lamp_amber", "lamp_green", "lamp_buzzer"
LAMPS = (RED, AMBER, GREEN, BUZZER)
"""Outputs of [io.out] that the control lights by itself, where the machine file has them."""
PREFIX = "lamp_"
HALF = 0.5  # s that a blinking lamp is on, and off


@key_table
class AnalogModel:
    """A pot or a counting wheel; ``range`` is what both ends mean, ``switch`` names its input."""

    name: str
    terminal: str = file_key(
        name="at",
        meaning="Terminal of the signal, written as the backend requires. The handwheel can also be on the "
        "pendant, such as `pendant.REL_DIAL`.",
    )
    range: Pair = file_key(
        Range(-1000.0, 1000.0),
        default=(0.0, 1.0),
        meaning="Values at the two ends of the signal: fractions of the programmed value for the pots, "
        "percent for `spindle_load`.",
    )
    switch: str = file_key(
        default="",
        meaning="Name of the input of the AUTO/OFF switch next to the pot, such as `spindle_auto`. "
        "Default: no switch.",
    )
    counts_per_click: int = file_key(
        Range(-1000, 1000),
        default=1,
        meaning="Handwheel: counts per detent; a negative value reverses the direction. A pot has no "
        "detents.",
    )

    @property
    def low(self) -> float:
        """What the lower end means."""
        return self.range[0]

    @property
    def high(self) -> float:
        """What the upper end means."""
        return self.range[1]


@dataclass(frozen=True, slots=True)
class HomeModel:
    """How a real drive looks for home: CiA 402 method, the slow speed, and where home lies from the mark."""

    method: int = 0  # 0: not said
    latch: float = 0.0  # mm/s
    offset: float = 0.0  # mm


@dataclass(frozen=True, slots=True)
class Hardware:
    """Everything about wires."""

    feeder: bool = False  # the drivers run in a process of their own
    continues_alone: bool = False  # a cut goes on while the screen does not answer
    spindle_driver: str = "sim"  # sim, cia402, vfd or grblhal
    tables: Mapping[str, object] = field(default_factory=dict)  # of the drivers, by path
    analog: Mapping[str, AnalogModel] = field(default_factory=dict)
    homes: Mapping[str, HomeModel] = field(default_factory=dict)  # by axis
    refresh: Mapping[str, float] = field(
        default_factory=dict
    )  # output → s after which it falls if not renewed

    def table(self, kind: type[_Table]) -> _Table | None:
        """What a driver has made of its table; None where the file has no such table."""
        return next((each for each in self.tables.values() if isinstance(each, kind)), None)


class Signal(NamedTuple):
    """``buzz``: s for which the buzzer sounds at its beginning, by turns where the lamp blinks.

    ``tones``: what the desk plays, Hz, each a fifth of a second.
    """

    lamp: str
    blinks: bool
    buzz: float
    tones: tuple[int, ...]
    use: str


SIGNALS = {
    "estop": Signal(RED, False, 0.0, (440, 440), "E-STOP"),
    "alarm": Signal(RED, True, 3.0, (880, 440, 880, 440), "ALARM"),
    "tool-life": Signal(AMBER, True, 1.0, (660, 660), "TOOL LIFE USED UP, OR PART MEASUREMENT DUE"),
    "stop": Signal(AMBER, True, 1.0, (660, 440), "STOP: FEED HOLD, M00, SINGLE BLOCK"),
    "part": Signal(AMBER, False, 0.5, (523, 659, 784), "PART FINISHED, NO CYCLE RUNNING"),
    "runs": Signal(GREEN, False, 0.0, (), "CYCLE RUNNING"),
}
"""By the kind of what happens, as it is announced (MQTT, web hook) too."""
