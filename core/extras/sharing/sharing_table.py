"""[sharing] of the machine file: where the programs of this desk are shared with other desks."""

from __future__ import annotations

from collections.abc import Iterator

from core.key_declaration import Range, Unit, file_key, key_table
from core.message import Message
from core.table_schema import Driver, DriverTable, FileReading, Finding, raw_at, written

_LONGEST = 40  # letters of a desk's name


@key_table
class SharingTable:
    """Either ``folder`` or ``postgresql`` (what libpq takes); the other is empty.

    ``desk`` is what this desk is called among the others; empty: as the machine. ``look``: seconds between
    two looks at what is new there.
    """

    folder: str = file_key(default="", meaning="Shared folder, mounted on every computer.")
    postgresql: str = file_key(
        secret=True, default="", meaning="Connection string of a PostgreSQL database, as libpq reads it."
    )
    desk: str = file_key(
        default="",
        meaning="Name of this machine in the list of machines, at most 40 characters. Default: "
        "`machine.name`.",
    )
    look: float = file_key(
        Range(2.0, 3600.0, Unit.SECONDS), default=30.0, meaning="Time between two checks for new versions."
    )


def _rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if not values.has("sharing.folder", "sharing.postgresql", "sharing.desk"):
        return
    named = [kind for kind in ("folder", "postgresql") if values.text(f"sharing.{kind}")]
    removed = raw_at(file.data, "sharing.git") is not None  # it has a finding of its own
    if len(named) != 1 and not removed:
        said = " and ".join(named) or "none"
        yield Finding("sharing", said, "specify exactly one of the keys folder and postgresql", "many-places")
    desk = values.text("sharing.desk")
    if desk.strip() != desk or len(desk) > _LONGEST or not desk.isprintable():
        yield Finding(
            "sharing.desk",
            written(desk),
            Message("this value must be a name of at most {longest} characters", longest=_LONGEST),
            "name-too-long",
        )


DRIVER = Driver(
    tables=(
        DriverTable(
            "sharing",
            SharingTable,
            rules=_rules,
            purpose="The location through which machines share their programs. Specify exactly one of "
            "`folder` and `postgresql`.",
        ),
    )
)
