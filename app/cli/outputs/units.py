"""Conversion of internal values in millimeters and seconds to output units."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from core.language.source import Dialect

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import Block

MM_PER_INCH = 25.4

# 1 ft/min is 12 in per 60 s.
MM_S_PER_FT_MIN = 12 * MM_PER_INCH / 60

_PER_MINUTE = 60.0

Json = dict[str, object]


def make_common_block_json(block: Block, source_line: str) -> Json:
    """Return the first keys of an elementary block's JSON object, which are the same for all languages."""
    return {
        "n": block.n,
        "line": block.line,
        "source": source_line,
        "text": block.text,
        "kind": str(block.kind),
    }


def to_inches(mm: float) -> float:
    """Return a length in mm as inches, rounded to nine decimals to hide the conversion error."""
    return round(mm / MM_PER_INCH, 9) + 0.0  # =


def round_millimeters(mm: float) -> float:
    """Return a length in mm, rounded to nine decimals."""
    return round(mm, 9) + 0.0


def get_length_converter(dialect: Dialect) -> Callable[[float], float]:
    """Return the function that converts lengths from mm to the output unit.

    The output unit is inches for OmniTurn and otherwise mm.
    """
    return to_inches if dialect is Dialect.OMNITURN else round_millimeters


def get_volume_converter(dialect: Dialect) -> Callable[[float], float]:
    """Return the function that converts volumes from mm³ to the output unit.

    The output unit is cubic inches for OmniTurn and otherwise mm³.
    """
    scale = MM_PER_INCH**3 if dialect is Dialect.OMNITURN else 1.0
    return lambda mm3: round(mm3 / scale, 6)


def get_path_feed(block: Block, unit: str) -> tuple[float, str]:
    """Return the feed along a path and its unit as text, such as ``mm/rev`` or ``mm/min``.

    ``unit`` is ``mm`` or ``deg``.
    """
    if block.per_rev:
        return round(block.feed, 6), f"{unit}/rev"
    return round(block.feed * _PER_MINUTE, 6), f"{unit}/min"


def to_inches_per_minute(mm_s: float) -> float:
    """Return a speed in mm/s as in/min, rounded to six decimals."""
    return round(mm_s * 60 / MM_PER_INCH, 6)


def round_seconds(seconds: float) -> float:
    """Return a time in seconds, rounded to the microsecond."""
    return round(seconds, 6)


def round_degrees(angle: float) -> float:
    """Return an angle in degrees, rounded to six decimals."""
    return round(angle, 6) + 0.0
