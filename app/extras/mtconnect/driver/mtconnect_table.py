"""Table [mtconnect] of the machine file, with the settings of the MTConnect adapter."""

from __future__ import annotations

from core.key_declaration import FileUnit, KeyRange, declare_key, make_key_table
from core.table_schema import DriverDeclaration, DriverTable


@make_key_table
class MtconnectTable:
    """Settings of the MTConnect adapter: address, port, device name and ``heartbeat``.

    ``heartbeat`` is the PING interval in seconds.
    """

    enabled: bool = declare_key(default=False, meaning="true: TurnDesk serves an MTConnect adapter.")
    bind: str = declare_key(
        default="127.0.0.1",
        meaning='Address at which agents connect. "0.0.0.0": from all computers, without a password.',
    )
    port: int = declare_key(KeyRange(1, 65535), default=7878, meaning="TCP port of the adapter.")
    heartbeat: float = declare_key(
        KeyRange(0.001, 1800.0, FileUnit.MILLISECONDS),
        name="heartbeat_ms",
        default=10.0,
        meaning="Interval at which the agent must send its ping; an agent that misses two of them is "
        "disconnected.",
    )
    device: str = declare_key(
        default="TurnDesk", meaning="Name of the device in MTConnect; a different one for each machine."
    )


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "mtconnect",
            MtconnectTable,
            purpose="The MTConnect adapter, which reports the state of the machine to MTConnect agents.",
        ),
    )
)
