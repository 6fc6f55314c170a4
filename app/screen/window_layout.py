"""Layout of the window and of the Automatic page for any size, calculated without Qt.

Fixed parts are measured in a unit that follows the size of the window. A 16:9 window is 160 by 90 units.
The program window and the path view use the remaining area.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

from app.screen.text_sizes import ScreenResolution, TextRole

ACROSS, DOWN = 160.0, 90.0
MIN_WINDOW_PX = (1024, 600)
FINGERTIP_PX = 43  # Pixels: 9 mm on the smallest screen, which has a diagonal of 10 inches.


class Rect(NamedTuple):
    """A rectangle in the window, in pixels."""

    x: int
    y: int
    w: int
    h: int

    @property
    def right(self) -> int:
        """Return the x coordinate of the first pixel column to the right of the rectangle."""
        return self.x + self.w

    @property
    def bottom(self) -> int:
        """Return the y coordinate of the first pixel row below the rectangle."""
        return self.y + self.h


class CompactLayout(NamedTuple):
    """Layout of a page with low readouts: rectangles of readouts, lamps, page and run line."""

    readout_line: Rect
    strip: Rect
    work_area: Rect
    run_line: Rect


class AutomaticLayout(NamedTuple):
    """Layout of the Automatic page.

    The rectangle ``dock`` is empty for a machine with a hardware operator station.
    """

    title: Rect
    position: Rect
    feed: Rect
    spindle: Rect
    tool: Rect
    times: Rect
    strip: Rect
    listing: Rect
    comment: Rect
    path: Rect
    dock: Rect
    prompt: Rect
    keys: Rect


HEAD, HEAD_MOVES = 7.4, 10.2  # Units: smallest height of the readouts above a page.

LOW_WINDOW_HEIGHT_PX = 700
"""Window height in pixels below which the rows above and below the page are smaller.

This leaves room for touch targets.
"""


def find_unit_px(width_px: int, height_px: int) -> float:
    """Return the size unit of the layout in pixels for a window of this size."""
    return min(width_px / ACROSS, height_px / DOWN)


_UNKNOWN_SCREEN = ScreenResolution()
_TITLE_HEIGHT = 2.0  # Units: height of the title of a frame.
# Height of a row of capitals and of a row of a table, as ratios to the em height of the text.
_CAPITALS_ROW, TABLE_ROW = 0.82, 0.92
_LATHE_AXIS_COUNT = 3
MIN_WORK_AREA_RATIO = 0.22  # Height of the work area of the Automatic page, as a ratio to the window height.
_RESOLUTION_STEP = 0.01  # Pixels per mm: precision of a limited resolution.


def find_title_height_px(unit_px: float, screen: ScreenResolution) -> float:
    """Return the height of the title of a frame in pixels."""
    return max(_TITLE_HEIGHT * unit_px, TABLE_ROW * screen.find_min_em_px(TextRole.TABLE))


@lru_cache(maxsize=64)
def limit_resolution(width_px: int, height_px: int, screen: ScreenResolution) -> ScreenResolution:
    """Return the resolution of the screen, or a lower one with which all rows fit in the window.

    A window that covers a part of a screen with small pixels has no room for the required text heights. With
    the lower resolution, the heights of all rows shrink by the same ratio.
    """
    if _has_work_area(width_px, height_px, screen):
        return screen
    fits, exceeds = 0.0, screen.pixels_per_mm
    while exceeds - fits > _RESOLUTION_STEP:
        middle = (fits + exceeds) / 2.0
        if _has_work_area(width_px, height_px, replace(screen, pixels_per_mm=middle)):
            fits = middle
        else:
            exceeds = middle
    return replace(screen, pixels_per_mm=fits)


def _has_work_area(width: int, height: int, screen: ScreenResolution) -> bool:
    """Return whether the rows of the Automatic page leave a large enough work area."""
    return _divide_window(width, height, False, screen).path.h >= MIN_WORK_AREA_RATIO * height


def make_automatic_layout(
    width: int, height: int, has_dock: bool, screen: ScreenResolution = _UNKNOWN_SCREEN
) -> AutomaticLayout:
    """Return the layout of the Automatic page for a window of this size in pixels.

    The rows are high enough for the texts that the operator must be able to read on this screen. In a window
    that is too low for this, all rows are less high.
    """
    return _divide_window(width, height, has_dock, limit_resolution(width, height, screen))


def _divide_window(width: int, height: int, has_dock: bool, screen: ScreenResolution) -> AutomaticLayout:
    """Return the layout of the Automatic page, without a check that the rows fit in the window."""
    u = find_unit_px(width, height)
    gap = _gap(u)
    low = height < LOW_WINDOW_HEIGHT_PX
    two_lines = 2 * TABLE_ROW * screen.find_min_em_px(TextRole.TABLE) + u
    state_h, prompt_line_h, position_h = (
        _CAPITALS_ROW * screen.find_min_em_px(role)
        for role in (TextRole.STATE, TextRole.PROMPT, TextRole.POSITION)
    )
    title_h = round(max((4.0 if low else 4.8) * u, state_h))
    strip_h = round(max(6.0 * u, FINGERTIP_PX, two_lines))
    prompt_h = round(max((5.2 if low else 7.6) * u, 2.2 * prompt_line_h))
    keys_h = round(max(6.6 * u, FINGERTIP_PX, two_lines))
    top_h = round(max(27.2 * u, find_title_height_px(u, screen) + _LATHE_AXIS_COUNT * position_h + 0.6 * u))
    keys = Rect(gap, height - gap - keys_h, width - 2 * gap, keys_h)
    prompt = Rect(gap, keys.y - gap - prompt_h, width - 2 * gap, prompt_h)
    title = Rect(0, 0, width, title_h)
    top = title.bottom + gap
    dock_w = round(24 * u) if has_dock else 0
    right = width - gap - (dock_w + gap if has_dock else 0)
    station = Rect(right + gap, top, dock_w, prompt.y - gap - top) if has_dock else Rect(0, 0, 0, 0)
    position = Rect(gap, top, round(70 * u), top_h)
    feed, spindle, tool, times = _quarters(
        Rect(position.right + gap, top, right - position.right - gap, top_h), gap
    )
    strip = Rect(gap, position.bottom + gap, right - gap, strip_h)
    below = strip.bottom + gap
    work = Rect(gap, below, right - gap, prompt.y - gap - below)
    listing, comment, path = divide_work_area(work, u)
    return AutomaticLayout(
        title, position, feed, spindle, tool, times, strip, listing, comment, path, station, prompt, keys
    )


def divide_work_area(work_area: Rect, unit_px: float) -> tuple[Rect, Rect, Rect]:
    """Return the rectangles of listing, comment and path in the work area of the Automatic page."""
    gap = _gap(unit_px)
    wide, comment_h = round(52 * unit_px), round(4.8 * unit_px)
    listing = Rect(work_area.x, work_area.y, wide, work_area.h - comment_h - gap)
    comment = Rect(work_area.x, work_area.bottom - comment_h, wide, comment_h)
    return (
        listing,
        comment,
        Rect(work_area.x + wide + gap, work_area.y, work_area.w - wide - gap, work_area.h),
    )


def find_work_area(layout: AutomaticLayout) -> Rect:
    """Return the work area of the Automatic page."""
    return Rect(layout.listing.x, layout.listing.y, layout.path.right - layout.listing.x, layout.path.h)


def make_compact_layout(
    width: int,
    height: int,
    has_dock: bool,
    screen: ScreenResolution = _UNKNOWN_SCREEN,
    *,
    has_axis_motion: bool = False,
    has_run_line: bool = True,
) -> CompactLayout:
    """Return the layout with low readouts, for a window of this size in pixels.

    The readouts are in one row. On a page on which axes can move, large positions are above the other
    readouts. Without a run line, its rectangle is empty. Title, dock, prompt and function keys have the same
    positions as on the Automatic page.
    """
    screen = limit_resolution(width, height, screen)
    at, u = make_automatic_layout(width, height, has_dock, screen), find_unit_px(width, height)
    gap, wide = _gap(u), at.strip.w
    head = Rect(at.strip.x, at.position.y, wide, _find_head_height(width, height, screen, has_axis_motion))
    strip = Rect(head.x, head.bottom + gap, wide, at.strip.h)
    top = strip.bottom + gap
    high = round(max(2.8 * u, TABLE_ROW * screen.find_min_em_px(TextRole.TABLE)))
    if not has_run_line:
        high = -gap
    run = Rect(head.x, at.prompt.y - gap - high, wide, max(0, high))
    return CompactLayout(head, strip, Rect(head.x, top, wide, run.y - gap - top), run)


def find_position_row_count(width: int, height: int) -> int:
    """Return the number of rows for the large positions, which is 2 in an upright window."""
    return 2 if height > width else 1


def _find_head_height(width: int, height: int, screen: ScreenResolution, has_axis_motion: bool) -> int:
    """Return the height of the readouts above a page in pixels."""
    u = find_unit_px(width, height)
    title, table = find_title_height_px(u, screen), screen.find_min_em_px(TextRole.TABLE)
    if not has_axis_motion:
        return round(max(HEAD * u, title + 2 * TABLE_ROW * table + 0.6 * u))
    rows = find_position_row_count(width, height)
    needed = rows * screen.find_min_em_px(TextRole.POSITION) + screen.find_min_em_px(TextRole.FEED)
    return round(max(HEAD_MOVES * u, title + _CAPITALS_ROW * needed + 0.8 * u))


def _gap(u: float) -> int:
    return max(4, round(0.7 * u))


def _quarters(whole: Rect, gap: int) -> tuple[Rect, Rect, Rect, Rect]:
    left = (whole.w - gap) // 2
    upper = round((whole.h - gap) * 0.56)
    x, y = whole.x + left + gap, whole.y + upper + gap
    return (
        Rect(whole.x, whole.y, left, upper),
        Rect(x, whole.y, whole.right - x, upper),
        Rect(whole.x, y, left, whole.bottom - y),
        Rect(x, y, whole.right - x, whole.bottom - y),
    )
