"""[sharing] of the machine file: where the programs of this desk are shared with other desks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from core.message import Message
from core.table_schema import Driver, DriverTable, Field, FileReading, Finding, Kind, Unit, written

KINDS = ("folder", "git", "postgresql")
_LONGEST = 40  # letters of a desk's name
_FIELDS = (
    Field("folder", Kind.TEXT, default="", meaning="Shared folder, mounted on every computer."),
    Field(
        "git",
        Kind.TEXT,
        default="",
        meaning="Address of a git repository, in which TurnDesk uses the branch `turndesk`.",
    ),
    Field(
        "postgresql",
        Kind.TEXT,
        default="",
        meaning="Connection string of a PostgreSQL database, as libpq reads it.",
    ),
    Field(
        "desk",
        Kind.TEXT,
        default="",
        meaning="Name of this machine in the list of machines, at most 40 characters. Default: "
        "`machine.name`.",
    ),
    Field(
        "look",
        Kind.NUMBER,
        Unit.SECONDS,
        2.0,
        3600.0,
        default=30.0,
        meaning="Time between two checks for new versions.",
    ),
)


@dataclass(frozen=True, slots=True)
class SharingTable:
    """One of ``folder``, ``git`` (a remote) and ``postgresql`` (what libpq takes); the others are empty.

    ``desk`` is what this desk is called among the others; empty: as the machine. ``look``: seconds between
    two looks at what is new there.
    """

    folder: str
    git: str = field(repr=False)
    postgresql: str = field(repr=False)
    desk: str
    look: float


def _rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if not values.has("sharing.folder", "sharing.git", "sharing.postgresql", "sharing.desk"):
        return
    named = [kind for kind in KINDS if values.text(f"sharing.{kind}")]
    if len(named) != 1:
        said = " and ".join(named) if named else "none"
        yield Finding(
            "sharing",
            said,
            Message(
                "specify exactly one of the keys {kinds} or {kinds2}",
                kinds=", ".join(KINDS[:-1]),
                kinds2=KINDS[-1],
            ),
            "many-places",
        )
    git, desk = values.text("sharing.git"), values.text("sharing.desk")
    if git.startswith("-"):
        yield Finding(
            "sharing.git", written(git), ("this value must be the address of a Git repository"), "git-address"
        )
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
            _FIELDS,
            lambda file: file.values.model(SharingTable, "sharing"),
            rules=_rules,
            purpose="The location through which machines share their programs. Specify exactly one of "
            "`folder`, `git` and `postgresql`.",
        ),
    )
)
