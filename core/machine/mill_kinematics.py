"""Table [kinematics] of a mill.

The table contains the positions and order of the rotary axes and the position of the workpiece.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from core.key_declaration import FileUnit, KeyRange, NumberTriple, declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import FileFinding, FileValues, read_table_values

KINEMATICS_TABLE = "kinematics"
MAX_ROTARY_AXIS_COUNT = 2
_DIRECTIONS: dict[str, NumberTriple] = {
    "X": (1.0, 0.0, 0.0),
    "Y": (0.0, 1.0, 0.0),
    "Z": (0.0, 0.0, 1.0),
    "-X": (-1.0, 0.0, 0.0),
    "-Y": (0.0, -1.0, 0.0),
    "-Z": (0.0, 0.0, -1.0),
}
_AXIS_DIRECTIONS = {"A": "X", "B": "Y", "C": "Z"}


@make_key_table
class RotaryModel:
    """One rotary axis of a mill, as it is when all rotary axes are at 0."""

    name: str
    side: str = declare_key(
        choices=("table", "head"), meaning="Whether the axis turns the table or the head."
    )
    order: int = declare_key(
        KeyRange(1, 9),
        meaning="Position in the chain from the workpiece to the tool, the lowest number first; tables "
        "come before heads.",
    )
    direction: str = declare_key(
        choices=tuple(_DIRECTIONS), meaning="Direction of the axis of rotation with all rotary axes at 0."
    )
    point: NumberTriple = declare_key(
        KeyRange(-5000.0, 5000.0, FileUnit.LENGTH),
        meaning="Any point on the axis of rotation: in machine positions for a table, measured from the "
        "spindle nose for a head.",
    )
    modulo: bool = declare_key(
        default=False,
        meaning="true: the axis shows 0° to 360° and takes the shorter direction; it must not have `travel`.",
    )

    @property
    def is_table(self) -> bool:
        """Return whether the axis turns the table instead of the head."""
        return self.side == "table"

    @property
    def unit_vector(self) -> NumberTriple:
        """Return the direction of the axis of rotation as a unit vector."""
        return _DIRECTIONS[self.direction]


@make_key_table
class KinematicsModel:
    """The position of the workpiece in mm and degrees, and the rotary axes of a mill.

    ``chain`` contains the axes in their order from the workpiece to the tool.
    """

    origin: NumberTriple = declare_key(
        KeyRange(-5000.0, 5000.0, FileUnit.LENGTH),
        meaning="Machine position of the workpiece zero with all rotary axes at 0.",
    )
    basic_rotation: float = declare_key(
        KeyRange(-180.0, 180.0, FileUnit.DEGREES),
        default=0.0,
        meaning="Rotation of the workpiece about Z relative to the machine.",
    )
    chain: tuple[RotaryModel, ...] = ()


class KinematicsTableReader:
    """Parser of the optional table [kinematics]; ``findings`` contains the errors in the table."""

    def __init__(
        self, data: Mapping[str, object], values: FileValues, kind: str, rotary: Sequence[str]
    ) -> None:
        self._values = values
        self._names: list[str] = []
        self._there = KINEMATICS_TABLE in data
        self.findings: list[FileFinding] = []
        if self._there:
            self._read(data[KINEMATICS_TABLE], kind, rotary)

    def build_model(self) -> KinematicsModel | None:
        """Return the model of the table, or None if the file lacks the table.

        Call this method only if ``findings`` is empty.
        """
        if not self._there:
            return None
        chain = (
            self._values.make_model(RotaryModel, f"{KINEMATICS_TABLE}.{name}", name=name)
            for name in self._names
        )
        ordered = sorted(chain, key=lambda axis: axis.order)
        return self._values.make_model(KinematicsModel, KINEMATICS_TABLE, chain=tuple(ordered))

    def _read(self, table: object, kind: str, rotary: Sequence[str]) -> None:
        self.findings += read_table_values(
            table, KinematicsModel, KINEMATICS_TABLE, self._values, tuple(rotary)
        )
        if kind != "mill":
            self.findings.append(
                FileFinding(
                    f"[{KINEMATICS_TABLE}]",
                    "",
                    'only a mill can have this table; set machine.kind = "mill"',
                    "mill-only",
                )
            )
        if not isinstance(table, dict):
            return
        for name in rotary:
            path = Message("{table}.{name}", table=KINEMATICS_TABLE, name=name)
            if name not in table:
                self.findings.append(
                    FileFinding(
                        Message("[{path}]", path=path),
                        "",
                        Message("this table is missing; define where axis.{name} is located", name=name),
                        "missing",
                    )
                )
                continue
            found = read_table_values(table[name], RotaryModel, path, self._values)
            self.findings += found
            if not found:
                self._names.append(name)
        self.findings += [*self._check_rules()]

    def _check_rules(self) -> Iterator[FileFinding]:
        """Yield findings about axis values that do not match. Only valid values are compared."""
        values = self._values
        if len(self._names) > MAX_ROTARY_AXIS_COUNT:
            yield FileFinding(
                Message("[{table}]", table=KINEMATICS_TABLE),
                "",
                Message(
                    "at most {most_rotaries} rotary axes are supported", most_rotaries=MAX_ROTARY_AXIS_COUNT
                ),
                "broken-rule",
            )
        orders: dict[float, str] = {}
        for name in self._names:
            path = Message("{table}.{name}", table=KINEMATICS_TABLE, name=name)
            direction, order = values.text(f"{path}.direction"), values.read_number(f"{path}.order")
            if direction.removeprefix("-") != _AXIS_DIRECTIONS[name]:
                expected = Message(
                    "the direction must be {along} or -{along2}, because {name} rotates about that axis",
                    along=_AXIS_DIRECTIONS[name],
                    along2=_AXIS_DIRECTIONS[name],
                    name=name,
                )
                yield FileFinding(f"{path}.direction", format_toml_value(direction), expected, "broken-rule")
            if order in orders:
                expected = Message(
                    "{orders} already uses this order number; choose another number",
                    orders=orders[order],
                )
                yield FileFinding(f"{path}.order", format_toml_value(int(order)), expected, "broken-rule")
            orders[order] = name
            if values.read_flag(f"{path}.modulo") and values.has_values(f"axis.{name}.travel"):
                low, _ = values.read_pair(f"axis.{name}.travel")
                if abs(low) != float("inf"):
                    expected = Message(
                        "a modulo axis has no travel limits; remove axis.{name}.travel", name=name
                    )
                    yield FileFinding(f"{path}.modulo", "true", expected, "broken-rule")
        yield from self._heads_last(orders)

    def _heads_last(self, orders: Mapping[float, str]) -> Iterator[FileFinding]:
        head = False
        for _, name in sorted(orders.items()):
            table = self._values.text(f"{KINEMATICS_TABLE}.{name}.side") == "table"
            if table and head:
                expected = (
                    "tables must come before heads, because the order goes from the workpiece to the tool"
                )
                yield FileFinding(f"{KINEMATICS_TABLE}.{name}.order", "", expected, "broken-rule")
            head = head or not table
