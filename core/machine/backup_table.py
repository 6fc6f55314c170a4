"""[backup] of the machine file: where the daily backups of all that is kept go, and how many stay."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, Kind

KEPT = 14
_FIELDS = (
    Field(
        "folder",
        Kind.TEXT,
        default="",
        meaning=(
            "Folder for the daily backups, preferably on another disk or computer. Default: "
            "`backups` in the data folder."
        ),
    ),
    Field(
        "keep",
        Kind.WHOLE,
        low=2,
        high=400,
        default=KEPT,
        meaning="Number of daily backups that TurnDesk retains; it deletes older backups.",
    ),
)


@dataclass(frozen=True, slots=True)
class BackupTable:
    """``folder`` on another disk or computer; empty: the data folder's own. The newest ``keep`` stay."""

    folder: str = ""
    keep: int = KEPT


DRIVER = Driver(
    tables=(
        DriverTable(
            "backup",
            _FIELDS,
            lambda file: file.values.model(BackupTable, "backup"),
            purpose="Where TurnDesk saves its daily backups, and how many of them it retains.",
        ),
    )
)
