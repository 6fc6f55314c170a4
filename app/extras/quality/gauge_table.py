"""Table [gauge] of the machine file, which configures the serial port of a gauge."""

from __future__ import annotations

from core.key_declaration import declare_key, make_key_table
from core.machine.serial_and_backup_tables import BAUD_RATE_KEY, DATA_BITS_KEY, PARITY_KEY, STOP_BITS_KEY
from core.table_schema import DriverDeclaration, DriverTable


@make_key_table
class GaugeModel:
    """Settings of the serial port of a gauge. ``unit`` is the unit of received lines without a unit."""

    port: str = declare_key(meaning="Serial port of the gauge, such as `/dev/serial/by-id/…`.")
    name: str = declare_key(default="gauge", meaning="Name that is saved with each reading of the gauge.")
    unit: str = declare_key(
        default="mm", choices=("mm", "in"), meaning="Unit of a reading whose line does not state one."
    )
    baud: int = BAUD_RATE_KEY
    bits: int = DATA_BITS_KEY
    parity: str = PARITY_KEY
    stop: int = STOP_BITS_KEY


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "gauge",
            GaugeModel,
            serial_port_key="gauge.port",
            purpose="A gauge that sends its readings as lines of text over a serial line.",
        ),
    ),
)
