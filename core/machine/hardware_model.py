"""Hardware model of the machine: analog inputs, homing, driver tables, signal tower and sounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple, TypeVar

from core.key_declaration import KeyRange, Pair, declare_key, make_key_table

_Table = TypeVar("_Table")
RED, AMBER, GREEN, BUZZER = "lamp_red", "lamp_amber", "lamp_green", "lamp_buzzer"
LAMP_NAMES = (RED, AMBER, GREEN, BUZZER)
"""Outputs of [io.out] that the control switches automatically if the machine file defines them."""
LAMP_PREFIX = "lamp_"
BLINK_HALF_PERIOD_S = 0.5  # s that a blinking lamp is on, and off


@make_key_table
class AnalogInputModel:
    """A potentiometer or a handwheel.

    ``range`` contains the values at both ends of the signal. ``switch`` is the name of the input to which
    the AUTO/OFF switch is wired.
    """

    name: str
    terminal: str = declare_key(
        name="at",
        meaning="Terminal of the signal, written as the backend requires. The handwheel can also be on the "
        "pendant, such as `pendant.REL_DIAL`.",
    )
    range: Pair = declare_key(
        KeyRange(-1000.0, 1000.0),
        default=(0.0, 1.0),
        meaning="Values at the two ends of the signal: fractions of the programmed value for the pots, "
        "percent for `spindle_load`.",
    )
    switch: str = declare_key(
        default="",
        meaning="Name of the input of the AUTO/OFF switch next to the pot, such as `spindle_auto`. "
        "Default: no switch.",
    )
    counts_per_click: int = declare_key(
        KeyRange(-1000, 1000),
        default=1,
        meaning="Handwheel: counts per detent; a negative value reverses the direction. A pot has no "
        "detents.",
    )

    @property
    def low_value(self) -> float:
        """Return the value at the lower end of the signal."""
        return self.range[0]

    @property
    def high_value(self) -> float:
        """Return the value at the upper end of the signal."""
        return self.range[1]


@dataclass(frozen=True, slots=True)
class HomingModel:
    """The homing parameters of a drive that is not simulated.

    ``method`` is the CiA 402 homing method, ``latch`` is the slow speed, and ``offset`` is the position of
    home relative to the reference mark.
    """

    method: int = 0  # 0: not specified
    latch: float = 0.0  # mm/s
    offset: float = 0.0  # mm


@dataclass(frozen=True, slots=True)
class Hardware:
    """The wiring of the machine, and the tables of its drivers."""

    uses_driver_host: bool = False  # the drivers run in a separate process
    continues_without_screen: bool = False  # the cycle continues while the screen does not respond
    spindle_driver: str = "sim"  # sim, cia402, vfd or grblhal
    tables: Mapping[str, object] = field(default_factory=dict)  # models of the driver tables, by path
    analog_inputs: Mapping[str, AnalogInputModel] = field(default_factory=dict)
    homing_models: Mapping[str, HomingModel] = field(default_factory=dict)  # homing models by axis
    refresh_timeouts_s: Mapping[str, float] = field(
        default_factory=dict
    )  # output name → s after which the output switches off if it is not refreshed

    def find_driver_table(self, kind: type[_Table]) -> _Table | None:
        """Return the model of the driver table of this type.

        Returns None if the file does not contain the table.
        """
        return next((each for each in self.tables.values() if isinstance(each, kind)), None)


class MachineSignal(NamedTuple):
    """A machine signal with its lamp, buzzer and sounds.

    ``buzzer_time_s`` is how long the buzzer sounds when the signal starts, in seconds. With a blinking
    lamp, the buzzer is synchronized with the lamp. ``tones_hz`` are the frequencies in Hz of the tones that
    the computer plays for 0.2 s each.
    """

    lamp: str
    is_blinking: bool
    buzzer_time_s: float
    tones_hz: tuple[int, ...]
    description: str


MACHINE_SIGNALS = {
    "estop": MachineSignal(RED, False, 0.0, (440, 440), "E-STOP"),
    "alarm": MachineSignal(RED, True, 3.0, (880, 440, 880, 440), "ALARM"),
    "tool-life": MachineSignal(AMBER, True, 1.0, (660, 660), "TOOL LIFE USED UP, OR PART MEASUREMENT DUE"),
    "stop": MachineSignal(AMBER, True, 1.0, (660, 440), "STOP: FEED HOLD, M00, SINGLE BLOCK"),
    "part": MachineSignal(AMBER, False, 0.5, (523, 659, 784), "PART FINISHED, NO CYCLE RUNNING"),
    "runs": MachineSignal(GREEN, False, 0.0, (), "CYCLE RUNNING"),
}
"""Machine signal for each kind of event. The kind is also used in MQTT and web hook announcements."""
