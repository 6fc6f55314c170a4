"""[gauge] of the machine file: a gauge whose SPC cable sends readings as lines of text."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, Kind

_FIELDS = (
    Field("port", Kind.TEXT, meaning="Serial port of the gauge, such as `/dev/serial/by-id/…`."),
    Field("name", Kind.TEXT, default="gauge", meaning="Name that is saved with each reading of the gauge."),
    Field(
        "unit",
        Kind.CHOICE,
        choices=("mm", "in"),
        default="mm",
        meaning="Unit of a reading whose line does not state one.",
    ),
    Field("baud", Kind.WHOLE, low=110, high=1_000_000, default=9600, meaning="Bit rate of the line."),
    Field("bits", Kind.WHOLE, low=7, high=8, default=8, meaning="Data bits of a character."),
    Field(
        "parity",
        Kind.CHOICE,
        choices=("N", "E", "O"),
        default="N",
        meaning="Parity: none (N), even (E) or odd (O).",
    ),
    Field("stop", Kind.WHOLE, low=1, high=2, default=1, meaning="Stop bits of a character."),
)


@dataclass(frozen=True, slots=True)
class GaugeModel:
    """The serial line of a gauge; ``unit`` of lines that do not say theirs."""

    port: str
    name: str
    unit: str
    baud: int
    bits: int
    parity: str
    stop: int


_TABLE = DriverTable(
    "gauge",
    _FIELDS,
    lambda file: file.values.model(GaugeModel, "gauge"),
    port="gauge.port",
    purpose="A gauge that sends its readings as lines of text over a serial line.",
)
DRIVER = Driver(tables=(_TABLE,))
