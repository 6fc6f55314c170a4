"""[kinematics] of a mill: where its rotary axes lie, in which order, and where the workpiece stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from core.message import Message
from core.table_schema import Field, Finding, Kind, Triple, Unit, Values, read_table, written

TABLE = "kinematics"
MOST_ROTARIES = 2
_DIRECTIONS: dict[str, Triple] = {
    "X": (1.0, 0.0, 0.0),
    "Y": (0.0, 1.0, 0.0),
    "Z": (0.0, 0.0, 1.0),
    "-X": (-1.0, 0.0, 0.0),
    "-Y": (0.0, -1.0, 0.0),
    "-Z": (0.0, 0.0, -1.0),
}
_ALONG = {"A": "X", "B": "Y", "C": "Z"}
WORKPIECE = (
    Field(
        "origin",
        Kind.TRIPLE,
        Unit.LENGTH,
        -5000.0,
        5000.0,
        meaning="Machine position of the workpiece zero with all rotary axes at 0.",
    ),
    Field(
        "basic_rotation",
        Kind.NUMBER,
        Unit.DEGREES,
        -180.0,
        180.0,
        default=0.0,
        meaning="Rotation of the workpiece about Z relative to the machine.",
    ),
)
ROTARY = (
    Field(
        "side",
        Kind.CHOICE,
        choices=("table", "head"),
        meaning="Whether the axis turns the table or the head.",
    ),
    Field(
        "order",
        Kind.WHOLE,
        low=1,
        high=9,
        meaning=(
            "Position in the chain from the workpiece to the tool, the lowest number first; tables "
            "come before heads."
        ),
    ),
    Field(
        "direction",
        Kind.CHOICE,
        choices=tuple(_DIRECTIONS),
        meaning="Direction of the axis of rotation with all rotary axes at 0.",
    ),
    Field(
        "point",
        Kind.TRIPLE,
        Unit.LENGTH,
        -5000.0,
        5000.0,
        meaning=(
            "Any point on the axis of rotation: in machine positions for a table, measured from "
            "the spindle nose for a head."
        ),
    ),
    Field(
        "modulo",
        Kind.FLAG,
        default=False,
        meaning="true: the axis shows 0° to 360° and takes the shorter direction; it must not have `travel`.",
    ),
)


@dataclass(frozen=True, slots=True)
class RotaryModel:
    """One rotary axis with all of them at 0: unit vector and a point of its line, mm.

    A table's point counts in the machine, a head's from the nose of the spindle. ``modulo``: shows 0 to 360.
    """

    name: str
    table: bool
    direction: Triple
    point: Triple
    modulo: bool


@dataclass(frozen=True, slots=True)
class KinematicsModel:
    """``chain`` goes from the workpiece to the tool. ``origin`` is the machine position of the workpiece's
    zero with all rotary axes at 0, mm; ``basic_rotation`` its turn about Z against the machine, degrees.
    """

    origin: Triple
    basic_rotation: float
    chain: tuple[RotaryModel, ...]


class KinematicsReading:
    """Reads the table where a file has one; ``findings`` is what is wrong with it."""

    def __init__(self, data: Mapping[str, object], values: Values, kind: str, rotary: Sequence[str]) -> None:
        self._values = values
        self._names: list[str] = []
        self._there = TABLE in data
        self.findings: list[Finding] = []
        if self._there:
            self._read(data[TABLE], kind, rotary)

    def model(self) -> KinematicsModel | None:
        """What the table says, once nothing is wrong with it."""
        if not self._there:
            return None
        ordered = sorted(self._names, key=lambda name: self._values.number(f"{TABLE}.{name}.order"))
        return KinematicsModel(
            origin=self._values.triple(f"{TABLE}.origin"),
            basic_rotation=self._values.number(f"{TABLE}.basic_rotation"),
            chain=tuple(self._rotary(name) for name in ordered),
        )

    def _read(self, table: object, kind: str, rotary: Sequence[str]) -> None:
        self.findings += read_table(table, WORKPIECE, TABLE, self._values, tuple(rotary))
        if kind != "mill":
            self.findings.append(
                Finding(
                    f"[{TABLE}]",
                    "",
                    'only a mill can have this table; set machine.kind = "mill"',
                    "mill-only",
                )
            )
        if not isinstance(table, dict):
            return
        for name in rotary:
            path = Message("{table}.{name}", table=TABLE, name=name)
            if name not in table:
                self.findings.append(
                    Finding(
                        Message("[{path}]", path=path),
                        "",
                        Message("this table is missing; define where axis.{name} is located", name=name),
                        "missing",
                    )
                )
                continue
            found = read_table(table[name], ROTARY, path, self._values)
            self.findings += found
            if not found:
                self._names.append(name)
        self.findings += [*self._broken()]

    def _rotary(self, name: str) -> RotaryModel:
        values, path = self._values, Message("{table}.{name}", table=TABLE, name=name)
        return values.model(
            RotaryModel,
            path,
            name=name,
            table=values.text(f"{path}.side") == "table",
            direction=_DIRECTIONS[values.text(f"{path}.direction")],
        )

    def _broken(self) -> Iterator[Finding]:
        """Rules between the axes; each is looked at where its values are good."""
        values = self._values
        if len(self._names) > MOST_ROTARIES:
            yield Finding(
                Message("[{table}]", table=TABLE),
                "",
                Message("at most {most_rotaries} rotary axes are supported", most_rotaries=MOST_ROTARIES),
                "broken-rule",
            )
        orders: dict[float, str] = {}
        for name in self._names:
            path = Message("{table}.{name}", table=TABLE, name=name)
            direction, order = values.text(f"{path}.direction"), values.number(f"{path}.order")
            if direction.removeprefix("-") != _ALONG[name]:
                expected = Message(
                    "the direction must be {along} or -{along2}, because {name} rotates about that axis",
                    along=_ALONG[name],
                    along2=_ALONG[name],
                    name=name,
                )
                yield Finding(f"{path}.direction", written(direction), expected, "broken-rule")
            if order in orders:
                expected = Message(
                    "{orders} already uses this order number; choose another number",
                    orders=orders[order],
                )
                yield Finding(f"{path}.order", written(int(order)), expected, "broken-rule")
            orders[order] = name
            if values.flag(f"{path}.modulo") and values.has(f"axis.{name}.travel"):
                low, _ = values.pair(f"axis.{name}.travel")
                if abs(low) != float("inf"):
                    expected = Message(
                        "a modulo axis has no travel limits; remove axis.{name}.travel", name=name
                    )
                    yield Finding(f"{path}.modulo", "true", expected, "broken-rule")
        yield from self._heads_last(orders)

    def _heads_last(self, orders: Mapping[float, str]) -> Iterator[Finding]:
        head = False
        for _, name in sorted(orders.items()):
            table = self._values.text(f"{TABLE}.{name}.side") == "table"
            if table and head:
                expected = (
                    "tables must come before heads, because the order goes from the workpiece to the tool"
                )
                yield Finding(f"{TABLE}.{name}.order", "", expected, "broken-rule")
            head = head or not table
