"""The page at every size: nothing overlaps, nothing is cut off, targets fit a finger."""

from __future__ import annotations

from itertools import combinations
from types import SimpleNamespace
from typing import cast

import pytest
from PySide6.QtCore import QRect
from PySide6.QtGui import QScreen

from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.text_sizes import ScreenResolution
from app.screen.window.station_dock import StationDock
from app.screen.window_layout import (
    FINGERTIP_PX,
    MIN_WINDOW_PX,
    Rect,
    find_unit_px,
    limit_resolution,
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


WINDOWS = [MIN_WINDOW_PX, (1024, 768), (1280, 720), (1920, 1080), (1080, 1920)]


@pytest.mark.parametrize("resolution", [3.0, 4.71, 6.43, 7.24, 9.0, 11.9, 13.8])
@pytest.mark.parametrize("size", WINDOWS)
def test_rows_fit_in_window_on_screen_with_small_pixels(size: tuple[int, int], resolution: float) -> None:
    """A quarter of a 27-inch screen with 3840 x 2160 pixels has 6.43 pixels per mm."""
    for small in (False, True):
        screen = ScreenResolution(resolution, small)
        at = make_automatic_layout(*size, True, screen)
        assert all(rect.h > 0 and rect.w > 0 for rect in at)
        assert at.path.h >= size[1] // 5
        for moves in (False, True):
            low = make_compact_layout(*size, True, screen, has_axis_motion=moves)
            assert all(rect.h > 0 for rect in low)
            assert low.work_area.h >= size[1] // 5


def test_all_rows_shrink_by_the_same_ratio() -> None:
    """The rows of 84, 282, 59 and 111 pixels have a text height of 6.43 pixels per mm."""
    at = make_automatic_layout(*MIN_WINDOW_PX, True, ScreenResolution(6.43))
    limited = limit_resolution(*MIN_WINDOW_PX, ScreenResolution(6.43)).pixels_per_mm
    assert 4.6 < limited < 4.8  # At 4.71 the work area is 22.5 % of the height.
    assert at.title.h == pytest.approx(84 * limited / 6.43, abs=1)
    assert at.prompt.h == pytest.approx(111 * limited / 6.43, abs=1)


@pytest.mark.parametrize("resolution", [3.0, 3.78, 4.71, 6.43, 9.0, 13.8])
@pytest.mark.parametrize("size", WINDOWS)
def test_estop_and_palm_buttons_are_as_large_as_a_fingertip(
    hands: Hands, size: tuple[int, int], resolution: float
) -> None:
    dock = hands.frame.station_dock
    assert dock is not None
    hands.window.resize(*size)
    hands.window.theme.screen = ScreenResolution(resolution)
    hands.frame.arrange_parts()
    dock.grab()
    estop, *_, left, right = dock.controls
    for button in (estop, left, right):
        assert min(button.box.width(), button.box.height()) >= FINGERTIP_PX
        assert button.box.bottom() <= dock.height()


def test_dock_with_high_labels_keeps_estop_as_large_as_a_fingertip(hands: Hands) -> None:
    """Four labels of 52 pixels and four controls of 43 pixels leave 10 of 390 pixels."""
    theme = ScreenTheme(DARK_PALETTE, find_unit_px(*MIN_WINDOW_PX))
    theme.screen = ScreenResolution(13.0)
    dock = StationDock(theme, hands.desk)
    dock.resize(154, 390)
    dock.grab()
    assert min(dock.controls[0].box.width(), dock.controls[0].box.height()) >= FINGERTIP_PX
    dock.deleteLater()


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
