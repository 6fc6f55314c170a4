"""[backup], [dnc] and [gauge] of the machine file: daily backups, serial lines for programs and gauges."""

from __future__ import annotations

from typing import Any

from core.key_declaration import Range, file_key, key_table
from core.table_schema import Driver, DriverTable

_BAUD: Any = file_key(Range(110, 1_000_000), default=9600, meaning="Bit rate of the line.")
_BITS: Any = file_key(Range(7, 8), default=8, meaning="Data bits of a character.")
_PARITY: Any = file_key(
    default="N", choices=("N", "E", "O"), meaning="Parity: none (N), even (E) or odd (O)."
)
_STOP: Any = file_key(Range(1, 2), default=1, meaning="Stop bits of a character.")
KEPT = 14


@key_table
class DncModel:
    """The serial line for programs."""

    port: str = file_key(meaning="Serial port, such as `/dev/serial/by-id/…`.")
    baud: int = _BAUD
    bits: int = _BITS
    parity: str = _PARITY
    stop: int = _STOP
    flow: str = file_key(
        default="xonxoff", choices=("xonxoff", "rtscts", "none"), meaning="Flow control of the line."
    )
    wrap: str = file_key(
        default="%",
        choices=("%", ""),
        meaning='Line before and after a program. "": none; a pause then ends a received program.',
    )
    eol: str = file_key(
        default="\r\n",
        choices=("\r\n", "\n", "\r"),
        meaning="Line ending of the programs that TurnDesk sends.",
    )
    dc_codes: bool = file_key(
        default=False,
        meaning="true: TurnDesk sends DC2 before and DC4 after a program, and DC1 before and DC3 after it "
        "receives one.",
    )
    wait: bool = file_key(
        default=False, meaning="true: TurnDesk sends a program only after the other side has sent DC1."
    )
    leader: int = file_key(
        Range(0, 2000), default=0, meaning="Number of NUL characters before and after a program that is sent."
    )


@key_table
class GaugeModel:
    """The serial line of a gauge; ``unit`` of lines that do not say theirs."""

    port: str = file_key(meaning="Serial port of the gauge, such as `/dev/serial/by-id/…`.")
    name: str = file_key(default="gauge", meaning="Name that is saved with each reading of the gauge.")
    unit: str = file_key(
        default="mm", choices=("mm", "in"), meaning="Unit of a reading whose line does not state one."
    )
    baud: int = _BAUD
    bits: int = _BITS
    parity: str = _PARITY
    stop: int = _STOP


DRIVER = Driver(
    tables=(
        DriverTable(
            "dnc",
            DncModel,
            port="dnc.port",
            purpose="The serial line over which programs are sent and received.",
        ),
        DriverTable(
            "gauge",
            GaugeModel,
            port="gauge.port",
            purpose="A gauge that sends its readings as lines of text over a serial line.",
        ),
    )
)


@key_table
class BackupTable:
    """``folder`` on another disk or computer; empty: the data folder's own. The newest ``keep`` stay."""

    folder: str = file_key(
        default="",
        meaning="Folder for the daily backups, preferably on another disk or computer. Default: `backups` "
        "in the data folder.",
    )
    keep: int = file_key(
        Range(2, 400),
        default=KEPT,
        meaning="Number of daily backups that TurnDesk retains; it deletes older backups.",
    )


BACKUP_DRIVER = Driver(
    tables=(
        DriverTable(
            "backup",
            BackupTable,
            purpose="Where TurnDesk saves its daily backups, and how many of them it retains.",
        ),
    )
)
