"""[mtconnect] of the machine file: where agents find the adapter."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, FileReading, Kind, Unit

_FIELDS = (
    Field("enabled", Kind.FLAG, default=False, meaning="true: TurnDesk serves an MTConnect adapter."),
    Field(
        "bind",
        Kind.TEXT,
        default="127.0.0.1",
        meaning='Address at which agents connect. "0.0.0.0": from all computers, without a password.',
    ),
    Field("port", Kind.WHOLE, low=1, high=65535, default=7878, meaning="TCP port of the adapter."),
    Field(
        "heartbeat_ms",
        Kind.NUMBER,
        Unit.MILLISECONDS,
        0.001,
        1800.0,
        default=10.0,
        meaning=(
            "Interval at which the agent must send its ping; an agent that misses two of them is "
            "disconnected."
        ),
    ),
    Field(
        "device",
        Kind.TEXT,
        default="TurnDesk",
        meaning="Name of the device in MTConnect; a different one for each machine.",
    ),
)


@dataclass(frozen=True, slots=True)
class MtconnectTable:
    """Where agents find the adapter, how often they shall ping (``heartbeat``, s), and the device's name."""

    bind: str
    port: int
    heartbeat: float
    enabled: bool = False
    device: str = "TurnDesk"


def _table(file: FileReading) -> MtconnectTable:
    return file.values.model(MtconnectTable, "mtconnect", {"heartbeat": "heartbeat_ms"})


DRIVER = Driver(
    tables=(
        DriverTable(
            "mtconnect",
            _FIELDS,
            _table,
            purpose="The MTConnect adapter, which reports the state of the machine to MTConnect agents.",
        ),
    )
)
