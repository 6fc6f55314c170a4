"""[mtconnect] of the machine file: where agents find the adapter."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, FileReading, Kind, Unit

_FIELDS = (
    Field("enabled", Kind.FLAG, default=False),
    Field("bind", Kind.TEXT, default="127.0.0.1"),
    Field("port", Kind.WHOLE, low=1, high=65535, default=7878),
    Field("heartbeat_ms", Kind.NUMBER, Unit.MILLISECONDS, 0.001, 1800.0, default=10.0),
    Field("device", Kind.TEXT, default="TurnDesk"),
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


DRIVER = Driver(tables=(DriverTable("mtconnect", _FIELDS, _table),))
