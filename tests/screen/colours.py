"""How far a colour of a picture is from one of the palette."""

from __future__ import annotations

from PySide6.QtGui import QColor


def apart(one: QColor, other: QColor) -> int:
    """The sum of what red, green and blue differ by, 0…765."""
    return abs(one.red() - other.red()) + abs(one.green() - other.green()) + abs(one.blue() - other.blue())
