"""[backup] of the machine file: where the daily backups of all that is kept go, and how many stay."""

from __future__ import annotations

from core.key_declaration import Range, file_key, key_table
from core.table_schema import Driver, DriverTable

KEPT = 14


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


DRIVER = Driver(
    tables=(
        DriverTable(
            "backup",
            BackupTable,
            purpose="Where TurnDesk saves its daily backups, and how many of them it retains.",
        ),
    )
)
