"""Reader of a drawing file, which is DXF or SVG according to its suffix.

Empty and oversized files are rejected before they are read.
"""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

from core.extras.drawings.drawing import MAX_DRAWING_BYTES, Drawing, DrawingError
from core.input_file import BYTES_PER_MB, TooLargeError, convert_exceptions, read_input_bytes
from core.message import Message

DRAWING_SUFFIXES = (".dxf", ".svg")

_MISSING_BLOCK = re.compile(r'Required block definition for "(.+?)"')  # texts of ezdxf
_TRUNCATED = re.compile(r"missing (ENDSEC|EOF)")
_DAMAGED_LINE = re.compile(r"(?:at|near) line:? (\d+)")


def has_drawing_suffix(name: str) -> bool:
    """Return whether a file name has the suffix of a drawing."""
    return name.lower().endswith(DRAWING_SUFFIXES)


def read_drawing(path: Path) -> Drawing:
    """Return the lines and arcs of a drawing.

    The only exception raised is DrawingError. Its text is written by TurnDesk, not by a library.
    """
    if not has_drawing_suffix(path.name):
        raise DrawingError(
            Message("{path} is not a supported drawing: use a DXF or SVG file.", path=path.name),
            "not-a-drawing",
        )
    with convert_exceptions(partial(_unreadable, path)):
        data = read_input_bytes(path, MAX_DRAWING_BYTES)
        if not data:
            raise DrawingError(Message("{path} is empty: save the drawing again.", path=path.name), "empty")
        if path.suffix.lower() == ".svg":
            from core.extras.drawings.svg_reader import read_svg

            return read_svg(path.name, data)
        from core.extras.drawings.dxf_reader import read_dxf

        return read_dxf(path, data)


def _unreadable(path: Path, error: Exception) -> DrawingError:
    if isinstance(error, TooLargeError):
        words = Message(
            "{path} is larger than {limit_mb} MB. Save only the contour of the part.",
            path=path.name,
            limit_mb=MAX_DRAWING_BYTES // BYTES_PER_MB,
        )
        return DrawingError(words, "too-large")
    if isinstance(error, OSError) and error.errno is not None:
        return DrawingError(
            Message("{path} cannot be read: {cause}.", path=path.name, cause=error.strerror),
            "unreadable",
        )
    if isinstance(error, MemoryError):
        words = Message(
            "{path} needs more memory than is allowed for a drawing. Save only the contour of the part.",
            path=path.name,
        )
        return DrawingError(words, "out-of-memory")
    damage = _find_damage(path, error)
    if damage is not None:
        return DrawingError(damage, "damaged")
    kind = path.suffix[1:].upper()
    return DrawingError(
        Message(
            "{path} is damaged or is not a {kind} file: save the drawing again.", path=path.name, kind=kind
        ),
        "damaged",
    )


def _find_damage(path: Path, error: Exception) -> Message | None:
    """Return the message for damage whose place the library names, or None if it names no place."""
    if (block := _MISSING_BLOCK.search(str(error))) is not None:
        return Message(
            "{path} uses the block {block}, but does not contain it: explode the blocks in the CAD program, "
            "and save the drawing again.",
            path=path.name,
            block=block[1],
        )
    if (line := _DAMAGED_LINE.search(str(error))) is not None:
        return Message(
            "{path} is damaged at line {line} of the file: save the drawing again.",
            path=path.name,
            line=line[1],
        )
    if _TRUNCATED.search(str(error)):
        return Message("{path} ends too early: copy the file or save the drawing again.", path=path.name)
    return None
