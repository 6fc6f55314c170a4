"""Which ways there are to jog on a machine: keys, and where the targets stand under fingers."""

from __future__ import annotations

from dataclasses import dataclass

from core.machine.model import Machine

Arrow = tuple[int, int]  # right and down, as the operator sees the machine; (0, 0): none
_NO_ARROW: Arrow = (0, 0)


@dataclass(frozen=True, slots=True)
class Direction:
    """One target: axis and sign, its cell in the cross, and its key by Qt's name with how it is written."""

    axis: str
    sign: int
    column: int
    row: int
    key: str
    label: str
    arrow: Arrow = _NO_ARROW


# A lathe from above: X+ is towards the operator, Z+ to the right.
_LATHE = (
    Direction("X", -1, 1, 0, "Up", "↑", (0, -1)),
    Direction("Z", -1, 0, 1, "Left", "←", (-1, 0)),
    Direction("Z", 1, 2, 1, "Right", "→", (1, 0)),
    Direction("X", 1, 1, 2, "Down", "↓", (0, 1)),
)
_LATHE_C = (Direction("C", -1, 0, 2, "PageDown", "PgDn"), Direction("C", 1, 2, 2, "PageUp", "PgUp"))
# A mill from above: X+ to the right, Y+ away from the operator, Z+ up.
_MILL = (
    Direction("Y", 1, 1, 0, "Up", "↑", (0, -1)),
    Direction("X", -1, 0, 1, "Left", "←", (-1, 0)),
    Direction("X", 1, 2, 1, "Right", "→", (1, 0)),
    Direction("Y", -1, 1, 2, "Down", "↓", (0, 1)),
    Direction("Z", 1, 2, 0, "PageUp", "PgUp"),
    Direction("Z", -1, 2, 2, "PageDown", "PgDn"),
)
# Of its rotary axes in the machine's order: cells and keys of + and −.
_ROTARY = (
    ((0, 0, "Insert", "Ins"), (0, 2, "Delete", "Del")),
    ((3, 0, "BracketRight", "]"), (3, 2, "BracketLeft", "[")),
)


def directions_of(machine: Machine) -> tuple[Direction, ...]:
    """All targets of a machine; a lathe has those of C where its spindle can be positioned."""
    if machine.kind != "mill":
        return _LATHE + (_LATHE_C if machine.c_enabled else ())
    found = list(_MILL)
    rotary = [axis.name for axis in machine.axes if axis.rotary]
    for name, ends in zip(rotary, _ROTARY, strict=False):
        for sign, end in zip((1, -1), ends, strict=True):
            column, row, key, label = end
            found.append(Direction(name, sign, column, row, key, label))
    return tuple(found)
