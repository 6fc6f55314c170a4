"""Cutting edges D1 to D9 of a tool T: their numbers in the one table of tool offsets, and tip quadrants.

D1 is the row of the tool itself, so that a tool with one edge is what it is in every language.
"""

from __future__ import annotations

_STEP = 100_000
EDGES = range(1, 10)

# Tip quadrant → (z, x) from the nose centre to the tip, x away from the spindle axis. 0 and 9: the centre.
TIP_DIRECTIONS = {
    0: (0, 0),
    1: (1, 1),
    2: (-1, 1),
    3: (-1, -1),
    4: (1, -1),
    5: (1, 0),
    6: (0, 1),
    7: (-1, 0),
    8: (0, -1),
    9: (0, 0),
}

NAMED_TOOLS = 32_768
"""Numbers from here on stand for tools by a name that the table does not have."""


class NamedTool(int):
    """The number of such a tool, or of an edge of it, which carries its name as a program writes it."""

    name: str

    def __new__(cls, number: int, name: str) -> NamedTool:
        made = super().__new__(cls, number)
        made.name = name
        return made

    def __reduce__(self) -> tuple[type[NamedTool], tuple[int, str]]:
        return NamedTool, (int(self), self.name)


def _like(key: int, number: int) -> int:
    """The number, with the name of ``key`` where that is a tool by name."""
    return NamedTool(number, key.name) if isinstance(key, NamedTool) else number


def edge_key(tool: int, edge: int) -> int:
    """The number of this edge's row: that of the tool for D1."""
    return tool if edge <= 1 else _like(tool, edge * _STEP + tool)


def tool_of(key: int) -> int:
    """T of a row."""
    return _like(key, key % _STEP)


def edge_of(key: int) -> int:
    """D of a row, 1 to 9."""
    return max(key // _STEP, 1)


def edge_number(key: int) -> str:
    """What stands behind the T of a row: 3, ="ROUGHER", and D2 behind where it is not the first edge."""
    number = f'="{key.name}"' if isinstance(key, NamedTool) else f"{tool_of(key)}"
    return number if key < _STEP else f"{number} D{edge_of(key)}"


def edge_name(key: int) -> str:
    """What a row is called: T3, T3 D2, T="ROUGHER"."""
    return f"T{edge_number(key)}"
