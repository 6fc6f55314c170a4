"""Table [gauge] of the machine file: the serial line of a gauge."""

from __future__ import annotations

from core.key_declaration import file_key, key_table
from core.machine.desk_tables import BAUD, BITS, PARITY, STOP
from core.table_schema import Driver, DriverTable


@key_table
class GaugeModel:
    """Settings of the gauge's serial line. ``unit`` applies to lines that do not state a unit."""

    port: str = file_key(meaning="Serial port of the gauge, such as `/dev/serial/by-id/…`.")
    name: str = file_key(default="gauge", meaning="Name that is saved with each reading of the gauge.")
    unit: str = file_key(
        default="mm", choices=("mm", "in"), meaning="Unit of a reading whose line does not state one."
    )
    baud: int = BAUD
    bits: int = BITS
    parity: str = PARITY
    stop: int = STOP


DRIVER = Driver(
    tables=(
        DriverTable(
            "gauge",
            GaugeModel,
            port="gauge.port",
            purpose="A gauge that sends its readings as lines of text over a serial line.",
        ),
    ),
)
