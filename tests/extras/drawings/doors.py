"""The readers of drawings, for the tests of files that are none: ``tests/fuzz/test_file_doors.py``."""

from __future__ import annotations

from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_file import read_drawing

DOORS = (
    ("part.dxf", read_drawing, DrawingError, "unreadable", "too-large"),
    ("part.svg", read_drawing, DrawingError, "unreadable", "too-large"),
)
