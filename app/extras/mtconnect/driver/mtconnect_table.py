"""Table [mtconnect] of the machine file: address of the adapter."""

from __future__ import annotations

from core.key_declaration import Range, Unit, file_key, key_table
from core.table_schema import Driver, DriverTable


@key_table
class MtconnectTable:
    """Address of the adapter, the PING interval ``heartbeat`` in seconds, and the name of the device."""

    enabled: bool = file_key(default=False, meaning="true: TurnDesk serves an MTConnect adapter.")
    bind: str = file_key(
        default="127.0.0.1",
        meaning='Address at which agents connect. "0.0.0.0": from all computers, without a password.',
    )
    port: int = file_key(Range(1, 65535), default=7878, meaning="TCP port of the adapter.")
    heartbeat: float = file_key(
        Range(0.001, 1800.0, Unit.MILLISECONDS),
        name="heartbeat_ms",
        default=10.0,
        meaning="Interval at which the agent must send its ping; an agent that misses two of them is "
        "disconnected.",
    )
    device: str = file_key(
        default="TurnDesk", meaning="Name of the device in MTConnect; a different one for each machine."
    )


DRIVER = Driver(
    tables=(
        DriverTable(
            "mtconnect",
            MtconnectTable,
            purpose="The MTConnect adapter, which reports the state of the machine to MTConnect agents.",
        ),
    )
)
