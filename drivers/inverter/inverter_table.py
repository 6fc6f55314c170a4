"""[spindle.vfd] of the machine file: the inverter that turns the spindle, and the line to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from core.table_schema import Driver, DriverTable, Field, FileReading, Kind, Unit

if TYPE_CHECKING:
    from drivers.serial_line import LineSettings

FAMILIES = ("delta-vfdb", "hitachi-wj200", "huanyang")
_PATH = "spindle.vfd"
_FIELDS = (
    Field(
        "family",
        Kind.CHOICE,
        choices=FAMILIES,
        meaning="Family of the inverter, which determines its protocol.",
    ),
    Field("port", Kind.TEXT, meaning="Serial port of the inverter, such as `/dev/serial/by-id/…`."),
    Field("baud", Kind.WHOLE, low=110, high=1_000_000, default=9600, meaning="Bit rate of the line."),
    Field(
        "parity",
        Kind.CHOICE,
        choices=("N", "E", "O"),
        default="N",
        meaning="Parity: none (N), even (E) or odd (O).",
    ),
    Field("stop", Kind.WHOLE, low=1, high=2, default=1, meaning="Stop bits of a character."),
    Field("id", Kind.WHOLE, low=1, high=247, default=1, meaning="Station number set at the inverter."),
    Field(
        "comm_loss_s",
        Kind.NUMBER,
        Unit.SECONDS,
        0.2,
        10.0,
        default=1.5,
        meaning=(
            "Time without a message after which the inverter stops the spindle. A Huanyang does not "
            "have this function."
        ),
    ),
    Field(
        "hz_per_rpm",
        Kind.NUMBER,
        Unit.PLAIN,
        0.001,
        1.0,
        meaning="Output frequency in Hz per rpm of the spindle: pole pairs ÷ 60 × belt ratio.",
    ),
    Field(
        "rated_a",
        Kind.NUMBER,
        Unit.PLAIN,
        0.1,
        1000.0,
        default=0.0,
        meaning=(
            "Rated current of the motor in A, for the spindle load in percent. Default: not specified, "
            "and no load is shown."
        ),
    ),
    Field(
        "disagree_pct",
        Kind.NUMBER,
        Unit.PERCENT,
        0.05,
        0.5,
        default=0.15,
        meaning="Largest difference between the speeds of the encoder and the inverter before alarm 209.",
    ),
)


@dataclass(frozen=True, slots=True)
class InverterConfig:
    """``hz_per_rpm`` of the spindle, with its belt; ``comm_loss`` the inverter's own time-out in s."""

    family: str
    unit: int
    hz_per_rpm: float
    rpm_max: float
    comm_loss: float
    character: float  # s that one character takes on the line
    rated: float = 0.0  # A of the motor, by its plate; 0: not known, and no load is told
    disagree: float = 0.15  # fraction by which an encoder may differ from what the inverter gives


@dataclass(frozen=True, slots=True)
class InverterTable:
    """An inverter, and the serial line of eight bits to it."""

    config: InverterConfig
    line: LineSettings


def _table(file: FileReading) -> InverterTable:
    from drivers.serial_line import LineSettings  # noqa: PLC0415  few machines have one

    values = file.values
    line = values.model(LineSettings, _PATH, bits=8, flow="none")
    config = values.model(
        InverterConfig,
        _PATH,
        {"unit": "id", "comm_loss": "comm_loss_s", "disagree": "disagree_pct", "rated": "rated_a"},
        rpm_max=values.pair("spindle.rpm")[1],
        character=line.character,
    )
    return InverterTable(config, line)


DRIVER = Driver(
    tables=(
        DriverTable(
            _PATH,
            _FIELDS,
            _table,
            port=f"{_PATH}.port",
            purpose='The inverter of the spindle on a serial line (`driver = "vfd"` of [spindle]).',
        ),
    ),
    spindle="vfd",
)
