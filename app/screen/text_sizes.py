"""Smallest text heights by text role, from the viewing distance and the real size of the screen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

DEFAULT_DPI = 96.0  # Dots per inch of a monitor that does not report its size.
_LEAST_DPI, _MOST_DPI = 75.0, 350.0
_ALIKE = 0.1  # Largest difference of the horizontal and vertical resolution, as a ratio.
_INCH = 25.4
# mm: sizes that screens report instead of their real size. They contain only the aspect ratio.
_ASPECT_RATIO_SIZES = frozenset({(160, 90), (160, 100), (16, 9), (16, 10)})
_SMALL = 10.0  # Inches: smaller panels are read from nearer.
CAPITAL_HEIGHT_RATIO = 0.73  # Height of a capital or a digit of B612, as a ratio to its em height.
MIN_STRETCH = 65  # Percent: a text that is too wide is drawn with letters of this width at the least.


class TextRole(Enum):
    """Roles of a text, which determine its smallest height.

    ``TABLE`` is the role of values, labels and table rows.
    """

    POSITION = "position"
    STATE = "state"
    PROMPT = "prompt"
    FEED = "feed"
    TABLE = "table"

    def find_min_height_mm(self, *, is_small: bool) -> float:
        """Return the smallest permitted height of capital letters in mm."""
        minutes, far, near = _SEEN[self]
        return (near if is_small else far) * math.tan(math.radians(minutes / 60.0))


# Height of the capitals in arc minutes, and the viewing distance in mm; the second distance is that of panels
# with a diagonal of less than 10 inches.
_SEEN = {
    TextRole.POSITION: (20.0, 2000.0, 1200.0),
    TextRole.STATE: (20.0, 2000.0, 1200.0),
    TextRole.PROMPT: (16.0, 1500.0, 1000.0),
    TextRole.FEED: (16.0, 1500.0, 1000.0),
    TextRole.TABLE: (16.0, 700.0, 500.0),
}


@dataclass(frozen=True, slots=True)
class ScreenResolution:
    """Resolution of a screen in pixels per mm.

    ``is_small`` is True if the diagonal of the screen is less than 10 inches.
    """

    pixels_per_mm: float = DEFAULT_DPI / _INCH
    is_small_screen: bool = False

    def find_min_em_px(self, role: TextRole) -> float:
        """Return the smallest permitted em height of a text in pixels."""
        return (
            role.find_min_height_mm(is_small=self.is_small_screen) * self.pixels_per_mm / CAPITAL_HEIGHT_RATIO
        )


def make_screen_resolution(
    width_px: int, height_px: int, width_mm: float, height_mm: float
) -> ScreenResolution:
    """Return the resolution of a screen from its size in pixels and its reported size in mm.

    Some screens report no size, the size of another screen, or only an aspect ratio. For an implausible
    size, 96 dots per inch are assumed.
    """
    across = width_px / width_mm if width_mm > 0.0 else 0.0
    down = height_px / height_mm if height_mm > 0.0 else 0.0
    is_ratio = (max(width_mm, height_mm), min(width_mm, height_mm)) in _ASPECT_RATIO_SIZES
    plausible = (
        not is_ratio and min(across, down) >= _LEAST_DPI / _INCH and max(across, down) <= _MOST_DPI / _INCH
    )
    if not plausible or abs(across / down - 1.0) > _ALIKE:
        across = down = DEFAULT_DPI / _INCH
    diagonal = math.hypot(width_px / across, height_px / down)
    return ScreenResolution((across + down) / 2.0, diagonal < _SMALL * _INCH)


def find_narrow_size(pixels: int, width_ratio: float) -> tuple[int, int]:
    """Return the pixel size and stretch in percent of a font that is narrower by ``width_ratio``.

    The letters become narrower first, and lower only beyond ``MIN_STRETCH``.
    """
    stretch = max(MIN_STRETCH, min(100, int(100 * width_ratio)))
    return max(1, int(pixels * min(1.0, 100 * width_ratio / stretch))), stretch
