"""Table [setter] of the machine file: a fixed tool setter or probe for touching off tools."""

from __future__ import annotations

from collections.abc import Iterator

from core.key_declaration import Range, Unit, file_key, key_table, shown
from core.message import Message
from core.table_schema import Driver, DriverTable, FileReading, Finding

PROBE_INPUT = "io.in.probe"
SEES = 0.1  # s, longest time from the touch to the command to brake


@key_table
class SetterModel:
    """Position of the stylus of a tool setter, and the motion of a touch-off.

    Units are mm and mm/s, with X as a radius. ``x z`` is the middle of the stylus, measured from part zero
    and the spindle axis. ``width`` is its size, with the faces at half this distance from the middle.
    ``overtravel`` is the distance by which it may be pushed. The tool searches at ``speed`` within
    ``search``, retracts by ``back_off``, and touches again at ``slow``.
    """

    x: float = file_key(
        Range(-1000.0, 1000.0, Unit.LENGTH),
        meaning="X position of the middle of the stylus, a radius measured from the spindle axis.",
    )
    z: float = file_key(
        Range(-3000.0, 3000.0, Unit.LENGTH),
        meaning="Z position of the middle of the stylus, measured from part zero.",
    )
    width: float = file_key(
        Range(0.2, 100.0, Unit.LENGTH), meaning="Width of the stylus, or the diameter of a ball."
    )
    overtravel: float = file_key(
        Range(0.1, 50.0, Unit.LENGTH),
        meaning="Distance by which the stylus may be pushed. The tool must be able to stop within it.",
    )
    speed: float = file_key(
        Range(0.05, 50.0, Unit.FEED), meaning="Speed at which the tool searches for the stylus."
    )
    slow: float = file_key(
        Range(0.002, 5.0, Unit.FEED),
        meaning="Speed of the second touch, which is measured; not above `speed`.",
    )
    search: float = file_key(
        Range(0.5, 200.0, Unit.LENGTH),
        default=12.7,
        meaning="Distance within which the tool searches for the stylus.",
    )
    back_off: float = file_key(
        Range(0.05, 20.0, Unit.LENGTH),
        default=1.27,
        meaning="Distance by which the tool retracts between the two touches.",
    )

    def face(self, axis: str, sign: int) -> float:
        """Return the tip position at which it touches the stylus in this direction, in mm from part zero."""
        middle = self.x if axis == "X" else self.z
        return middle - sign * self.width / 2.0


def _rules(file: FileReading) -> Iterator[Finding]:
    values, here = file.values, "setter" in file.tables
    there = PROBE_INPUT in file.terminals
    if here and not there and f"{PROBE_INPUT}.at" not in values.wrong:
        yield Finding(
            PROBE_INPUT,
            "",
            "this input is missing; [setter] needs an input that is on while the setter is touched",
            "missing",
        )
    if not here:
        return
    if values.text("machine.kind") != "lathe":
        yield Finding("[setter]", "", "only a lathe can have this table; remove the table", "lathe-only")
    inch = bool(values.inch)
    both = values.has("setter.slow", "setter.speed")
    if both and values.number("setter.slow") > values.number("setter.speed"):
        yield Finding(
            "setter.slow",
            "",
            "this speed is higher than setter.speed; the second touch must not be faster than the first",
            "broken-rule",
        )
    keys = ("setter.speed", "setter.overtravel", "axis.X.amax", "axis.Z.amax", "machine.commit_ms")
    if values.has(*keys):
        speed, over = values.number("setter.speed"), values.number("setter.overtravel")
        accel = min(values.number("axis.X.amax"), values.number("axis.Z.amax"))
        needed = runs_on(speed, accel, values.number("machine.commit_ms"))
        if needed > over * (1 + 1e-9):
            far = shown(needed, Unit.LENGTH, inch)
            why = Message(
                "the tool travels {distance} after the touch, which exceeds setter.overtravel; "
                "reduce the speed",
                distance=far,
            )
            yield Finding("setter.speed", "", why, "broken-rule")


def runs_on(speed: float, accel: float, commit: float) -> float:
    """Return the largest distance from the touch to rest.

    It consists of the detection delay, the commit time and the braking distance.
    """
    return speed * (SEES + commit) + speed * speed / (2.0 * accel)


DRIVER = Driver(
    tables=(
        DriverTable(
            "setter",
            SetterModel,
            rules=_rules,
            purpose="A tool setter, or a probe at a fixed place, for touching off the tools of a lathe. "
            "It needs the input `probe`.",
        ),
    )
)
