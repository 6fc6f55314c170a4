"""Figures as the commands show them: inches and minutes outside, millimetres and seconds inside."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from core.language.source import Dialect

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import Block

MM_PER_INCH = 25.4

# A surface speed in ft/min is 12 in over 60 s.
MM_S_PER_FT_MIN = 12 * MM_PER_INCH / 60

_PER_MINUTE = 60.0

Json = dict[str, object]


def block_head(block: Block, source_line: str) -> Json:
    """What stands first in the object of every elementary block."""
    return {
        "n": block.n,
        "line": block.line,
        "source": source_line,
        "text": block.text,
        "kind": str(block.kind),
    }


def inches(mm: float) -> float:
    """Inches of a length, to a billionth, so that the binary noise of the conversion does not show."""
    return round(mm / MM_PER_INCH, 9) + 0.0  # + 0.0 makes -0.0 a plain zero


def millimetres(mm: float) -> float:
    """A length as it is, to a billionth."""
    return round(mm, 9) + 0.0


def length_of(dialect: Dialect) -> Callable[[float], float]:
    """How lengths are shown to whoever programs in this language: OmniTurn counts in inches, others in mm."""
    return inches if dialect is Dialect.OMNITURN else millimetres


def volume_of(dialect: Dialect) -> Callable[[float], float]:
    """How volumes are shown, in the unit of ``length_of``; given in mm³."""
    scale = MM_PER_INCH**3 if dialect is Dialect.OMNITURN else 1.0
    return lambda mm3: round(mm3 / scale, 6)


def path_feed(block: Block, unit: str) -> tuple[float, str]:
    """The feed along a path in mm or degrees, and what it counts."""
    if block.per_rev:
        return round(block.feed, 6), f"{unit}/rev"
    return round(block.feed * _PER_MINUTE, 6), f"{unit}/min"


def per_minute(mm_s: float) -> float:
    """in/min of a speed in mm/s."""
    return round(mm_s * 60 / MM_PER_INCH, 6)


def seconds(t: float) -> float:
    """Seconds to the microsecond."""
    return round(t, 6)


def degrees(angle: float) -> float:
    """Degrees to a millionth."""
    return round(angle, 6) + 0.0
