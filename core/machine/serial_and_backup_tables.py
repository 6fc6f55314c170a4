"""Tables [backup] for daily backups and [dnc] for transferring programs over a serial line."""

from __future__ import annotations

from typing import Any

from core.key_declaration import KeyRange, declare_key, make_key_table
from core.table_schema import DriverDeclaration, DriverTable

BAUD_RATE_KEY: Any = declare_key(KeyRange(110, 1_000_000), default=9600, meaning="Bit rate of the line.")
DATA_BITS_KEY: Any = declare_key(KeyRange(7, 8), default=8, meaning="Data bits of a character.")
PARITY_KEY: Any = declare_key(
    default="N", choices=("N", "E", "O"), meaning="Parity: none (N), even (E) or odd (O)."
)
STOP_BITS_KEY: Any = declare_key(KeyRange(1, 2), default=1, meaning="Stop bits of a character.")
DEFAULT_BACKUP_COUNT = 14


@make_key_table
class SerialLineModel:
    """The settings of the serial line over which programs are sent and received."""

    port: str = declare_key(meaning="Serial port, such as `/dev/serial/by-id/…`.")
    baud: int = BAUD_RATE_KEY
    bits: int = DATA_BITS_KEY
    parity: str = PARITY_KEY
    stop: int = STOP_BITS_KEY
    flow: str = declare_key(
        default="xonxoff", choices=("xonxoff", "rtscts", "none"), meaning="Flow control of the line."
    )
    wrap: str = declare_key(
        default="%",
        choices=("%", ""),
        meaning='Line before and after a program. "": none; a pause then ends a received program.',
    )
    eol: str = declare_key(
        default="\r\n",
        choices=("\r\n", "\n", "\r"),
        meaning="Line ending of the programs that TurnDesk sends.",
    )
    dc_codes: bool = declare_key(
        default=False,
        meaning="true: TurnDesk sends DC2 before and DC4 after a program, and DC1 before and DC3 after it "
        "receives one.",
    )
    wait: bool = declare_key(
        default=False, meaning="true: TurnDesk sends a program only after the other side has sent DC1."
    )
    leader: int = declare_key(
        KeyRange(0, 2000),
        default=0,
        meaning="Number of NUL characters before and after a program that is sent.",
    )


DNC_DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "dnc",
            SerialLineModel,
            serial_port_key="dnc.port",
            purpose="The serial line over which programs are sent and received.",
        ),
    )
)


@make_key_table
class BackupTable:
    """The folder and the number of the daily backups."""

    folder: str = declare_key(
        default="",
        meaning="Folder for the daily backups, preferably on another disk or computer. Default: `backups` "
        "in the data folder.",
    )
    keep: int = declare_key(
        KeyRange(2, 400),
        default=DEFAULT_BACKUP_COUNT,
        meaning="Number of daily backups that TurnDesk retains; it deletes older backups.",
    )


BACKUP_DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "backup",
            BackupTable,
            purpose="Where TurnDesk saves its daily backups, and how many of them it retains.",
        ),
    )
)
