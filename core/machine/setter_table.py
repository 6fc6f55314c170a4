"""Table [setter] of the machine file, for a fixed tool setter or probe that is used to touch off tools."""

from __future__ import annotations

from collections.abc import Iterator

from core.key_declaration import FileUnit, KeyRange, declare_key, format_value, make_key_table
from core.message import Message
from core.table_schema import DriverDeclaration, DriverTable, FileFinding, MachineFileReading

PROBE_INPUT = "io.in.probe"
MAX_TOUCH_DELAY_S = 0.1  # s, longest time from the touch to the command to brake


@make_key_table
class ToolSetterModel:
    """The position of the stylus of a tool setter, and the motion of a touch-off.

    Values are in mm and mm/s, with X as a radius.

    - ``x`` and ``z`` are the center of the stylus, measured from the spindle axis and part zero.
    - ``width`` is the size of the stylus between opposite faces.
    - ``overtravel`` is the distance by which the stylus may be pushed.
    - The tool searches for the stylus at ``speed`` within the distance ``search``.
    - The tool then retracts by ``back_off`` and touches the stylus again at ``slow``.
    """

    x: float = declare_key(
        KeyRange(-1000.0, 1000.0, FileUnit.LENGTH),
        meaning="X position of the middle of the stylus, a radius measured from the spindle axis.",
    )
    z: float = declare_key(
        KeyRange(-3000.0, 3000.0, FileUnit.LENGTH),
        meaning="Z position of the middle of the stylus, measured from part zero.",
    )
    width: float = declare_key(
        KeyRange(0.2, 100.0, FileUnit.LENGTH), meaning="Width of the stylus, or the diameter of a ball."
    )
    overtravel: float = declare_key(
        KeyRange(0.1, 50.0, FileUnit.LENGTH),
        meaning="Distance by which the stylus may be pushed. The tool must be able to stop within it.",
    )
    speed: float = declare_key(
        KeyRange(0.05, 50.0, FileUnit.FEED), meaning="Speed at which the tool searches for the stylus."
    )
    slow: float = declare_key(
        KeyRange(0.002, 5.0, FileUnit.FEED),
        meaning="Speed of the second touch, which is measured; not above `speed`.",
    )
    search: float = declare_key(
        KeyRange(0.5, 200.0, FileUnit.LENGTH),
        default=12.7,
        meaning="Distance within which the tool searches for the stylus.",
    )
    back_off: float = declare_key(
        KeyRange(0.05, 20.0, FileUnit.LENGTH),
        default=1.27,
        meaning="Distance by which the tool retracts between the two touches.",
    )

    def compute_touch_position(self, axis: str, direction_sign: int) -> float:
        """Return the position at which the tip touches the stylus in this direction, in mm from part zero."""
        middle = self.x if axis == "X" else self.z
        return middle - direction_sign * self.width / 2.0


def _rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values, here = file.file_values, "setter" in file.tables
    there = PROBE_INPUT in file.terminals
    if here and not there and f"{PROBE_INPUT}.at" not in values.invalid_paths:
        yield FileFinding(
            PROBE_INPUT,
            "",
            "this input is missing; [setter] needs an input that is on while the setter is touched",
            "missing",
        )
    if not here:
        return
    if values.text("machine.kind") != "lathe":
        yield FileFinding("[setter]", "", "only a lathe can have this table; remove the table", "lathe-only")
    inch = bool(values.is_inch)
    both = values.has_values("setter.slow", "setter.speed")
    if both and values.read_number("setter.slow") > values.read_number("setter.speed"):
        yield FileFinding(
            "setter.slow",
            "",
            "this speed is higher than setter.speed; the second touch must not be faster than the first",
            "broken-rule",
        )
    keys = ("setter.speed", "setter.overtravel", "axis.X.amax", "axis.Z.amax", "machine.commit_ms")
    if values.has_values(*keys):
        speed, over = values.read_number("setter.speed"), values.read_number("setter.overtravel")
        accel = min(values.read_number("axis.X.amax"), values.read_number("axis.Z.amax"))
        needed = compute_stopping_distance(speed, accel, values.read_number("machine.commit_ms"))
        if needed > over * (1 + 1e-9):
            far = format_value(needed, FileUnit.LENGTH, inch)
            why = Message(
                "the tool travels {distance} after the touch, which exceeds setter.overtravel; "
                "reduce the speed",
                distance=far,
            )
            yield FileFinding("setter.speed", "", why, "broken-rule")


def compute_stopping_distance(speed: float, acceleration: float, commit_time_s: float) -> float:
    """Return the maximum distance from the touch of the stylus to standstill, in mm.

    The distance consists of the travel during the detection delay and the commit time, and the braking
    distance.
    """
    return speed * (MAX_TOUCH_DELAY_S + commit_time_s) + speed * speed / (2.0 * acceleration)


SETTER_DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "setter",
            ToolSetterModel,
            check_rules=_rules,
            purpose="A tool setter, or a probe at a fixed place, for touching off the tools of a lathe. "
            "It needs the input `probe`.",
        ),
    )
)
