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
    Field("family", Kind.CHOICE, choices=FAMILIES),
    Field("port", Kind.TEXT),
    Field("baud", Kind.WHOLE, low=110, high=1_000_000, default=9600),
    Field("parity", Kind.CHOICE, choices=("N", "E", "O"), default="N"),
    Field("stop", Kind.WHOLE, low=1, high=2, default=1),
    Field("id", Kind.WHOLE, low=1, high=247, default=1),
    Field("comm_loss_s", Kind.NUMBER, Unit.SECONDS, 0.2, 10.0, default=1.5),
    Field("hz_per_rpm", Kind.NUMBER, Unit.PLAIN, 0.001, 1.0),
    Field("rated_a", Kind.NUMBER, Unit.PLAIN, 0.1, 1000.0, default=0.0),
    Field("disagree_pct", Kind.NUMBER, Unit.PERCENT, 0.05, 0.5, default=0.15),
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


DRIVER = Driver(tables=(DriverTable(_PATH, _FIELDS, _table, port=f"{_PATH}.port"),), spindle="vfd")
