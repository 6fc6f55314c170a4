"""[dnc] of the machine file: the serial line for programs."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, Kind

_FIELDS = (
    Field("port", Kind.TEXT, meaning="Serial port, such as `/dev/serial/by-id/…`."),
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
    Field(
        "flow",
        Kind.CHOICE,
        choices=("xonxoff", "rtscts", "none"),
        default="xonxoff",
        meaning="Flow control of the line.",
    ),
    Field(
        "wrap",
        Kind.CHOICE,
        choices=("%", ""),
        default="%",
        meaning='Line before and after a program. "": none; a pause then ends a received program.',
    ),
    Field(
        "eol",
        Kind.CHOICE,
        choices=("\r\n", "\n", "\r"),
        default="\r\n",
        meaning="Line ending of the programs that TurnDesk sends.",
    ),
    Field(
        "dc_codes",
        Kind.FLAG,
        default=False,
        meaning=(
            "true: TurnDesk sends DC2 before and DC4 after a program, and DC1 before and DC3 after "
            "it receives one."
        ),
    ),
    Field(
        "wait",
        Kind.FLAG,
        default=False,
        meaning="true: TurnDesk sends a program only after the other side has sent DC1.",
    ),
    Field(
        "leader",
        Kind.WHOLE,
        low=0,
        high=2000,
        default=0,
        meaning="Number of NUL characters before and after a program that is sent.",
    ),
)


@dataclass(frozen=True, slots=True)
class DncModel:
    """The serial line for programs."""

    port: str
    baud: int
    bits: int
    parity: str  # N, E or O
    stop: int
    flow: str  # xonxoff, rtscts or none
    wrap: str  # the line before and behind a program; empty: none
    eol: str
    dc_codes: bool = False  # DC2 and DC4 around what is sent, DC1 and DC3 around what is received
    wait: bool = False  # send only when the other side has said DC1
    leader: int = 0  # NULs before and behind what is sent


_TABLE = DriverTable(
    "dnc",
    _FIELDS,
    lambda file: file.values.model(DncModel, "dnc"),
    port="dnc.port",
    purpose="The serial line over which programs are sent and received.",
)
DRIVER = Driver(tables=(_TABLE,))
