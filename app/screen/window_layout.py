"""Layout of the window and of the Automatic page for any size, as pure arithmetic.

Fixed parts are measured in one unit that follows the window's size: a 16:9 window is 160 by 90 units. The
program window and the path view get the rest.
"""

from __future__ import annotations

from typing import NamedTuple

ACROSS, DOWN = 160.0, 90.0
LEAST = (1024, 600)
FINGER = 43  # Pixels: 9 mm on the smallest screen, which has a diagonal of 10 inches.


class Rect(NamedTuple):
    """A rectangle in the window, in pixels."""

    x: int
    y: int
    w: int
    h: int

    @property
    def right(self) -> int:
        """The x coordinate of the first pixel column to the right of the rectangle."""
        return self.x + self.w

    @property
    def bottom(self) -> int:
        """The y coordinate of the first pixel row below the rectangle."""
        return self.y + self.h


class LowPlaces(NamedTuple):
    """Layout of a page with the readouts in one row: readouts, lamps, page and run line."""

    head: Rect
    strip: Rect
    work: Rect
    run: Rect


class Places(NamedTuple):
    """Layout of the Automatic page. ``dock`` is empty for a machine with its own operator station."""

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


HEAD, HEAD_MOVES = 7.4, 10.2  # Units: height of the low readouts.

LOW = 700
"""px: a lower window has smaller rows above and below its page, so that its targets fit a finger."""


def unit(width: int, height: int) -> float:
    """Return the unit of size in pixels for a window of this size."""
    return min(width / ACROSS, height / DOWN)


def places(width: int, height: int, dock: bool) -> Places:
    """Return the layout of the Automatic page for a window of this size in pixels."""
    u = unit(width, height)
    gap = _gap(u)
    low = height < LOW
    title_h, strip_h, prompt_h, keys_h = (
        round(k * u) for k in (4.0 if low else 4.8, 6.0, 5.2 if low else 7.6, 6.6)
    )
    strip_h, keys_h = max(strip_h, FINGER), max(keys_h, FINGER)
    top_h = round(27.2 * u)
    keys = Rect(gap, height - gap - keys_h, width - 2 * gap, keys_h)
    prompt = Rect(gap, keys.y - gap - prompt_h, width - 2 * gap, prompt_h)
    title = Rect(0, 0, width, title_h)
    top = title.bottom + gap
    dock_w = round(24 * u) if dock else 0
    right = width - gap - (dock_w + gap if dock else 0)
    station = Rect(right + gap, top, dock_w, prompt.y - gap - top) if dock else Rect(0, 0, 0, 0)
    position = Rect(gap, top, round(70 * u), top_h)
    feed, spindle, tool, times = _quarters(
        Rect(position.right + gap, top, right - position.right - gap, top_h), gap
    )
    strip = Rect(gap, position.bottom + gap, right - gap, strip_h)
    below = strip.bottom + gap
    work = Rect(gap, below, right - gap, prompt.y - gap - below)
    listing, comment, path = work_parts(work, u)
    return Places(
        title, position, feed, spindle, tool, times, strip, listing, comment, path, station, prompt, keys
    )


def work_parts(work: Rect, u: float) -> tuple[Rect, Rect, Rect]:
    """Divide the work area of the Automatic page into listing, comment and path."""
    gap = _gap(u)
    wide, comment_h = round(52 * u), round(4.8 * u)
    listing = Rect(work.x, work.y, wide, work.h - comment_h - gap)
    comment = Rect(work.x, work.bottom - comment_h, wide, comment_h)
    return listing, comment, Rect(work.x + wide + gap, work.y, work.w - wide - gap, work.h)


def work_of(at: Places) -> Rect:
    """Return the work area of the Automatic page."""
    return Rect(at.listing.x, at.listing.y, at.path.right - at.listing.x, at.path.h)


def low_places(width: int, height: int, dock: bool, *, moves: bool = False) -> LowPlaces:
    """Return the layout with low readouts, for a window of this size in pixels.

    The readouts are in one row. On a page on which axes can move, large positions are above the others,
    unless the window is so low that the targets of the page would no longer fit a finger.
    Title, dock, prompt and function keys have the same places as on the Automatic page.
    """
    at, u = places(width, height, dock), unit(width, height)
    gap, wide = _gap(u), at.strip.w
    head = Rect(at.strip.x, at.position.y, wide, round((HEAD_MOVES if moves and height >= LOW else HEAD) * u))
    strip = Rect(head.x, head.bottom + gap, wide, at.strip.h)
    top, high = strip.bottom + gap, round(2.8 * u)
    run = Rect(head.x, at.prompt.y - gap - high, wide, high)
    return LowPlaces(head, strip, Rect(head.x, top, wide, run.y - gap - top), run)


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
