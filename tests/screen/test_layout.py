"""The page at every size: nothing overlaps, nothing is cut off, targets fit a finger."""

from __future__ import annotations

from itertools import combinations
from types import SimpleNamespace
from typing import cast

import pytest
from PySide6.QtCore import QRect
from PySide6.QtGui import QScreen

from app.screen.window_layout import (
    MIN_WINDOW_PX,
    Rect,
    find_unit_px,
    make_automatic_layout,
    make_compact_layout,
)
from tests.screen.hands import Hands

SIZES = [
    MIN_WINDOW_PX,
    (1024, 768),
    (1280, 720),
    (1280, 1024),
    (1920, 1080),
    (2560, 1080),
    (3840, 2160),
    (1080, 1920),
]


def apart(one: Rect, other: Rect) -> bool:
    """Whether two rectangles share no pixel."""
    return one.right <= other.x or other.right <= one.x or one.bottom <= other.y or other.bottom <= one.y


@pytest.mark.parametrize("dock", [True, False])
@pytest.mark.parametrize("size", SIZES)
def test_layout_parts_do_not_overlap_and_fit_window(size: tuple[int, int], dock: bool) -> None:
    at = make_automatic_layout(*size, dock)
    parts = [(name, rect) for name, rect in at._asdict().items() if dock or name != "dock"]
    for name, rect in parts:
        assert rect.w > 0, name
        assert rect.h > 0, name
        assert rect.x >= 0, name
        assert rect.y >= 0, name
        assert rect.right <= size[0], name
        assert rect.bottom <= size[1], name
    for (name, one), (other, two) in combinations(parts, 2):
        assert apart(one, two), (name, other)


@pytest.mark.parametrize("size", SIZES)
def test_automatic_page_panels_have_minimum_sizes(size: tuple[int, int]) -> None:
    at, u = make_automatic_layout(*size, has_dock=True), find_unit_px(*size)
    assert at.position.h >= 27 * u - 1
    assert at.feed.w >= 24 * u
    assert at.listing.h >= 18 * u
    assert at.path.w >= 40 * u
    assert at.path.h >= 26 * u


def test_targets_are_touch_sized_on_smallest_screen() -> None:
    at = make_automatic_layout(*MIN_WINDOW_PX, has_dock=True)
    least = 9 / (254 / (1024**2 + 600**2) ** 0.5)  # pixels: 9 mm where the corners are 10 inches apart
    assert at.keys.h >= least
    assert at.strip.h >= least
    assert (at.keys.w / 10) >= 80


def test_path_view_is_larger_without_dock() -> None:
    assert (
        make_automatic_layout(1920, 1080, has_dock=False).path.w
        > make_automatic_layout(1920, 1080, has_dock=True).path.w + 200
    )


@pytest.mark.parametrize("dock", [True, False])
@pytest.mark.parametrize("size", SIZES)
def test_page_layout_with_low_readouts_does_not_overlap(size: tuple[int, int], dock: bool) -> None:
    at, low = make_automatic_layout(*size, dock), make_compact_layout(*size, dock)
    parts = [at.title, *low, at.prompt, at.keys, *([at.dock] if dock else [])]
    for one, two in combinations(parts, 2):
        assert apart(one, two), (one, two)
    assert low.work_area.h >= 47 * find_unit_px(*size) - 1


@pytest.mark.parametrize(
    ("glass", "window"),
    [((2560, 1440), (1280, 720)), ((3440, 1440), (1720, 720)), ((3840, 2160), (1920, 1080))],
)
def test_window_covers_a_quarter_of_large_screen(
    hands: Hands, glass: tuple[int, int], window: tuple[int, int]
) -> None:
    screen = SimpleNamespace(availableGeometry=lambda: QRect(0, 0, *glass))
    hands.window.show_on_screen(cast("QScreen", screen))
    size = hands.window.size()
    assert (size.width(), size.height()) == window
    assert not hands.window.isMaximized()
