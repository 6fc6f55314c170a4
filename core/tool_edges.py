"""Cutting edges D1 to D9 of a tool T, their row numbers in the tool table, and tip quadrants.

D1 uses the row of the tool itself, so a tool with one cutting edge needs only this row.
"""

from __future__ import annotations

_STEP = 100_000
EDGE_NUMBERS = range(1, 10)

# Tip quadrant → (z, x) from the nose center to the tip, with x away from the spindle axis. 0 and 9: the
# center.
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

FIRST_NAMED_TOOL = 32_768
"""First number for tools whose name is not in the tool table."""


class NamedToolNumber(int):
    """Number assigned to a tool or cutting edge whose name in the program is not in the tool table."""

    name: str

    def __new__(cls, number: int, name: str) -> NamedToolNumber:
        """Create the number of a tool or cutting edge together with the name that the program calls."""
        made = super().__new__(cls, number)
        made.name = name
        return made

    def __reduce__(self) -> tuple[type[NamedToolNumber], tuple[int, str]]:
        return NamedToolNumber, (int(self), self.name)


def _like(key: int, number: int) -> int:
    """Return ``number`` with the tool name of ``key``, or unchanged if ``key`` has no tool name."""
    return NamedToolNumber(number, key.name) if isinstance(key, NamedToolNumber) else number


def make_edge_row_number(tool: int, edge: int) -> int:
    """Return the row number of a cutting edge; the row number of D1 is the tool number."""
    return tool if edge <= 1 else _like(tool, edge * _STEP + tool)


def get_tool_number(key: int) -> int:
    """Return the tool number T of a row."""
    return _like(key, key % _STEP)


def get_edge_number(key: int) -> int:
    """Return the cutting edge number D of a row, 1 to 9."""
    return max(key // _STEP, 1)


def format_edge_suffix(key: int) -> str:
    """Return the text that follows T for a row, such as ``3``, ``="ROUGHER"`` or ``3 D2``.

    The text contains D only for cutting edges D2 to D9.
    """
    number = f'="{key.name}"' if isinstance(key, NamedToolNumber) else f"{get_tool_number(key)}"
    return number if key < _STEP else f"{number} D{get_edge_number(key)}"


def format_edge_name(key: int) -> str:
    """Return the name of a row, such as T3, T3 D2 or T="ROUGHER"."""
    return f"T{format_edge_suffix(key)}"
