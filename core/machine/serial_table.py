"""[dnc] of the machine file: the serial line for programs."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, Kind

_FIELDS = (
    Field("port", Kind.TEXT),
    Field("baud", Kind.WHOLE, low=110, high=1_000_000, default=9600),
    Field("bits", Kind.WHOLE, low=7, high=8, default=8),
    Field("parity", Kind.CHOICE, choices=("N", "E", "O"), default="N"),
    Field("stop", Kind.WHOLE, low=1, high=2, default=1),
    Field("flow", Kind.CHOICE, choices=("xonxoff", "rtscts", "none"), default="xonxoff"),
    Field("wrap", Kind.CHOICE, choices=("%", ""), default="%"),
    Field("eol", Kind.CHOICE, choices=("\r\n", "\n", "\r"), default="\r\n"),
    Field("dc_codes", Kind.FLAG, default=False),
    Field("wait", Kind.FLAG, default=False),
    Field("leader", Kind.WHOLE, low=0, high=2000, default=0),
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


_TABLE = DriverTable("dnc", _FIELDS, lambda file: file.values.model(DncModel, "dnc"), port="dnc.port")
DRIVER = Driver(tables=(_TABLE,))
