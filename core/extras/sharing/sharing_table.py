"""Table [sharing] of the machine file, which specifies where this machine shares programs."""

from __future__ import annotations

from collections.abc import Iterator

from core.key_declaration import FileUnit, KeyRange, declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import DriverDeclaration, DriverTable, FileFinding, MachineFileReading, find_raw_value

_LONGEST = 40  # characters of a machine's name


@make_key_table
class SharingTable:
    """Settings for sharing programs.

    Either ``folder`` or ``postgresql`` (a connection string of libpq) is set. ``desk`` is the name under
    which other machines show this machine; if it is empty, the machine's own name is used. ``look`` is the
    time between two checks for new versions, in seconds.
    """

    folder: str = declare_key(default="", meaning="Shared folder, mounted on every computer.")
    postgresql: str = declare_key(
        is_secret=True, default="", meaning="Connection string of a PostgreSQL database, as libpq reads it."
    )
    desk: str = declare_key(
        default="",
        meaning="Name of this machine in the list of machines, at most 40 characters. Default: "
        "`machine.name`.",
    )
    look: float = declare_key(
        KeyRange(2.0, 3600.0, FileUnit.SECONDS),
        default=30.0,
        meaning="Time between two checks for new versions.",
    )


def _rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    if not values.has_values("sharing.folder", "sharing.postgresql", "sharing.desk"):
        return
    named = [kind for kind in ("folder", "postgresql") if values.text(f"sharing.{kind}")]
    removed = find_raw_value(file.parsed_data, "sharing.git") is not None  # it has its own finding
    if len(named) != 1 and not removed:
        said = " and ".join(named) or "none"
        yield FileFinding(
            "sharing", said, "specify exactly one of the keys folder and postgresql", "many-places"
        )
    desk = values.text("sharing.desk")
    if desk.strip() != desk or len(desk) > _LONGEST or not desk.isprintable():
        yield FileFinding(
            "sharing.desk",
            format_toml_value(desk),
            Message("this value must be a name of at most {longest} characters", longest=_LONGEST),
            "name-too-long",
        )


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "sharing",
            SharingTable,
            check_rules=_rules,
            purpose="The location through which machines share their programs. Specify exactly one of "
            "`folder` and `postgresql`.",
        ),
    )
)
