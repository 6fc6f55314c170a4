"""What the store hands out. Lengths mm, X a radius; times UTC, ISO 8601."""

from __future__ import annotations

from datetime import UTC, datetime
from enum import StrEnum
from typing import NamedTuple

MM_PER_INCH = 25.4
OFFSETS = range(1, 33)
ZERO_CODES = range(54, 60)
TOOL_REACH = 1270.0  # mm: 50 in, more than any such lathe travels
SECONDARY_REACH = 254.0  # mm: 10 in, what the control's display has digits for
RADIUS_MAX = 50.8  # mm: 2 in
WEAR_REACH = 2.54  # mm: .1 in; a tool that is off by more has to be touched off
REMARK_LONGEST = 40  # characters
SHAPE_REACH = 508.0  # mm: 20 in, longer than any tool of such a lathe sticks out
OUTLINE_LONGEST = 600  # characters
ZERO_REACH = 5000.0  # mm, more than any such lathe travels
ANGLE_REACH = 360.0  # degrees: further is the same place
Value = float | int | str | bool


class Kind(StrEnum):
    """The tables of offsets: T, D, the settable zero offsets G54 to G59, and the shapes of the tools."""

    TOOL = "tool"
    SECONDARY = "secondary"
    ZERO = "zero"
    SHAPE = "shape"


class ToolRow(NamedTuple):
    """Machine position at which the tip stood on part zero when it was touched off, and its wear since.

    ``quadrant`` is where the tip lies as seen from the nose centre, 0…9; one tool at most is the master.
    """

    x: float = 0.0
    z: float = 0.0
    nose_radius: float = 0.0
    wear_x: float = 0.0
    wear_z: float = 0.0
    quadrant: int = 0
    remark: str = ""
    master: bool = False

    @property
    def offset(self) -> tuple[float, float]:
        """Geometry and wear together: what the control moves by."""
        return self.x + self.wear_x, self.z + self.wear_z


class SecondaryRow(NamedTuple):
    """D offset as stored: X a radius, R the nose radius."""

    x: float = 0.0
    z: float = 0.0
    r: float = 0.0


class ZeroRow(NamedTuple):
    """Zero offset: machine position of the program's zero, X a radius, C in degrees."""

    x: float = 0.0
    z: float = 0.0
    c: float = 0.0


class ShapeRow(NamedTuple):
    """Shape of a tool, mm and degrees, 0 or empty: not stated; nose radius and tip are those of its offset.

    ``length`` is what can cut, ``stick_out`` where the tool is held, ``entry`` the entering angle of the main
    edge; ``rear``: it works at X negative; ``profile`` is an outline, ``z,x z,x z,x`` in mm.
    """

    kind: str = ""
    hand: str = "right"
    insert: str = ""
    holder: str = ""
    width: float = 0.0
    diameter: float = 0.0
    point: float = 0.0
    stick_out: float = 0.0
    length: float = 0.0
    pitch: float = 0.0
    flutes: int = 0
    entry: float = 0.0
    rear: bool = False
    profile: str = ""


Row = ToolRow | SecondaryRow | ZeroRow | ShapeRow


class Change(NamedTuple):
    """One offset's change: its row before and after, None where it was not set. Ids give the order."""

    id: int
    step: int
    undoes: int | None
    at: str
    kind: Kind
    number: int
    old: Row | None
    new: Row | None
    why: str
    who: str


class ProgramRow(NamedTuple):
    """A program's name and its newest version."""

    name: str
    created: str
    version: int
    saved: str


class VersionRow(NamedTuple):
    """One saved version of a program."""

    number: int
    sha256: str
    saved: str
    why: str
    size: int


class EventRow(NamedTuple):
    """One line of the log; ``line`` is the program's, 0 none; ``record`` is a file of the folder records."""

    at: str
    kind: str
    text: str
    line: int = 0
    record: str = ""


class RunRow(NamedTuple):
    """What a program has done: parts counted, last run and its outcome, cycles since ever, times in seconds.

    ``proof`` is what proving found last, ``planned`` the cycle time it reckoned with; None: never.
    """

    program: str
    parts: int = 0
    started: str | None = None
    outcome: str = ""
    cycles: int = 0
    best: float | None = None
    latest: float | None = None
    proved: str | None = None
    proof: str = ""
    planned: float | None = None


def inches(mm: float) -> float:
    """Millimetres as inches with ten places: what was entered in inches comes back as it was entered."""
    return round(mm / MM_PER_INCH, 10)


def utc_now() -> str:
    """This moment, to the millisecond."""
    return datetime.now(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
