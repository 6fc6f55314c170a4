"""Heights of texts by distance: the real size of a panel, and what every page draws on it."""

from __future__ import annotations

import statistics
from math import radians, tan

import pytest

from app.screen import page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.entry_panel import LetterPad
from app.screen.screen_theme import ScreenTheme
from app.screen.text_sizes import (
    CAPITAL_HEIGHT_RATIO,
    ScreenResolution,
    TextRole,
    find_narrow_size,
    make_screen_resolution,
)
from app.screen.window_layout import (
    find_position_row_count,
    make_automatic_layout,
    make_compact_layout,
)
from tests.screen.lathe import Operator
from tests.screen.text_heights import recorded

# Pixels and mm of panels: 7, 10 and 10.1 in, 12.1 in, 15.6 in, 21.5 in, 27 in, and 15.6 in upright.
PANELS = {
    "7": (1024, 600, 154, 90),
    "10": (1024, 600, 222, 130),
    "10.1": (1280, 800, 217, 136),
    "12.1": (1280, 800, 261, 163),
    "15.6": (1920, 1080, 345, 194),
    "21.5": (1920, 1080, 476, 268),
    "27": (3840, 2160, 598, 336),
    "upright": (1080, 1920, 194, 345),
}
# Values, labels and tables: the median of all texts of the pages, and the share of the texts that are at
# least 95 % as high as required, both in percent. A text that is too wide for its place with letters of 65 %
# width is lower. The lowest texts are the long labels of narrow places, such as the modal state.
TABLES = {
    "7": (98, 78),
    "10": (98, 80),
    "10.1": (98, 82),
    "12.1": (98, 90),
    "15.6": (100, 97),
    "21.5": (100, 99),
    "27": (100, 100),
    "upright": (98, 78),
}
PAGES = (
    page_table.MENU,
    page_table.AUTOMATIC,
    page_table.SEARCHTO_PAGE,
    page_table.JOG,
    page_table.MDI,
    page_table.PROGRAMS,
    page_table.TOOLS,
    page_table.SECCMP,
    page_table.ZERO,
    page_table.PART,
    page_table.SPECIAL,
    page_table.EDITOR,
)


def test_minimum_text_height_follows_from_viewing_distance() -> None:
    assert TextRole.POSITION.find_min_height_mm(is_small=False) == pytest.approx(2000 * tan(radians(20 / 60)))
    assert TextRole.POSITION.find_min_height_mm(is_small=False) == pytest.approx(11.64, abs=0.01)
    assert TextRole.PROMPT.find_min_height_mm(is_small=False) == pytest.approx(6.98, abs=0.01)
    assert TextRole.TABLE.find_min_height_mm(is_small=False) == pytest.approx(3.26, abs=0.01)
    assert TextRole.TABLE.find_min_height_mm(is_small=True) == pytest.approx(2.33, abs=0.01)


@pytest.mark.parametrize(("name", "small"), [("7", True), ("10", False), ("21.5", False)])
def test_a_panel_under_10_inches_is_small(name: str, small: bool) -> None:
    size = make_screen_resolution(*PANELS[name])
    width, _, wide, _ = PANELS[name]
    assert size.is_small_screen is small
    assert size.pixels_per_mm == pytest.approx(width / wide, rel=0.02)


@pytest.mark.parametrize(
    "reported",
    [
        (0, 0),  # nothing is known
        (-1, 90),
        (16, 9),  # an aspect ratio
        (1600, 900),  # centimeters taken for millimeters
        (154, 154),  # not the shape of its pixels
    ],
)
def test_implausible_panel_size_is_treated_as_96_dpi_monitor(reported: tuple[int, int]) -> None:
    size = make_screen_resolution(1024, 600, *reported)
    assert size.pixels_per_mm == pytest.approx(96 / 25.4)
    assert not size.is_small_screen


@pytest.mark.parametrize("reported", [(160, 90), (90, 160), (160, 100), (16, 9), (16, 10)])
def test_aspect_ratio_reported_as_size_is_treated_as_96_dpi_monitor(reported: tuple[int, int]) -> None:
    wide, high = reported
    size = make_screen_resolution(12 * wide, 12 * high, *reported)  # 1920 x 1080 pixels for 160 x 90
    assert size.pixels_per_mm == pytest.approx(96 / 25.4)


def test_panel_of_nearly_the_size_of_an_aspect_ratio_is_accepted() -> None:
    assert make_screen_resolution(1920, 1080, 161, 91).pixels_per_mm == pytest.approx(11.9, abs=0.1)


def test_a_text_grows_to_the_height_of_its_role_or_of_its_row() -> None:
    look = ScreenTheme(DARK_PALETTE, 8.0)
    look.screen = ScreenResolution(5.0)  # A position has capitals of 58.2 pixels, and a table of 16.3 pixels.
    needed = 58.18 / CAPITAL_HEIGHT_RATIO / 8.0
    assert look.find_em_height(5.0, TextRole.POSITION, 200.0) == pytest.approx(needed, rel=1e-3)
    # 1.15 times the row of 7 units
    assert look.find_em_height(5.0, TextRole.POSITION, 56.0) == pytest.approx(8.05)
    assert look.find_em_height(5.0, TextRole.POSITION, 8.0) == 5.0  # never smaller than its least size
    needed = 16.29 / CAPITAL_HEIGHT_RATIO / 8.0
    assert look.find_em_height(2.0, TextRole.TABLE, 80.0) == pytest.approx(needed, rel=1e-3)
    assert look.find_em_height(1.0, TextRole.TABLE, 12.8) == pytest.approx(1.84)  # 1.15 times 1.6 units
    assert look.find_em_height(1.0, TextRole.TABLE, 12.8, has_descenders=True) == pytest.approx(1.6)
    look.screen = ScreenResolution(2.0)
    assert look.find_em_height(2.0, TextRole.TABLE, 80.0) == 2.0  # A large screen needs no more.


@pytest.mark.parametrize("name", PANELS)
@pytest.mark.parametrize("dock", [True, False])
def test_rows_of_layout_are_as_high_as_their_texts(name: str, dock: bool) -> None:
    """Capitals need 73 % of the em height. Values are 16 minutes high at 0.7 m, or at 0.5 m below 10 in."""
    width, height, *_ = PANELS[name]
    screen = make_screen_resolution(*PANELS[name])
    capitals = {
        role: role.find_min_height_mm(is_small=screen.is_small_screen) * screen.pixels_per_mm
        for role in TextRole
    }
    at = make_automatic_layout(width, height, dock, screen)
    moves = make_compact_layout(width, height, dock, screen, has_axis_motion=True, has_run_line=False)
    assert at.title.h >= capitals[TextRole.STATE]
    assert at.prompt.h >= 2 * capitals[TextRole.PROMPT]
    assert at.position.h >= 3 * capitals[TextRole.POSITION] + capitals[TextRole.TABLE]
    assert min(at.strip.h, at.keys.h) >= 2 * capitals[TextRole.TABLE]
    rows = find_position_row_count(width, height)
    needed = rows * capitals[TextRole.POSITION] + capitals[TextRole.FEED] + capitals[TextRole.TABLE]
    assert moves.readout_line.h >= needed
    assert moves.work_area.bottom <= at.prompt.y
    assert moves.work_area.h >= 0.34 * height


def test_compact_layout_without_run_line_has_an_empty_rectangle_for_it() -> None:
    low, run = (make_compact_layout(1024, 600, True, has_run_line=shown) for shown in (False, True))
    assert low.run_line.h == 0
    assert low.work_area.bottom == run.run_line.bottom
    assert run.work_area.bottom < run.run_line.y


@pytest.mark.parametrize(
    ("ratio", "expected"),
    [
        (1.2, (40, 100)),  # The text fits.
        (0.8, (40, 80)),
        (0.65, (40, 65)),
        (0.325, (20, 65)),  # The letters are as narrow as permitted, so half the height is left.
    ],
)
def test_letters_become_narrower_before_they_become_lower(ratio: float, expected: tuple[int, int]) -> None:
    assert find_narrow_size(40, ratio) == expected


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("name", PANELS)
def test_texts_on_all_pages_have_required_height(
    operator: Operator, monkeypatch: pytest.MonkeyPatch, name: str, language: str
) -> None:
    size = make_screen_resolution(*PANELS[name])
    window, desk = operator.window, operator.stage.desk
    operator.stage.make_ready()
    window.resize(*PANELS[name][:2])
    window.theme.screen = size
    desk.settings_store.choose("language", language)
    with recorded(monkeypatch) as texts:
        for page in PAGES:
            assert operator.frame.open_page(page)
            window.refresh()
            window.grab()
    shares = dict[TextRole, list[float]]()
    for each in texts:
        least = each.role.find_min_height_mm(is_small=size.is_small_screen) * size.pixels_per_mm
        shares.setdefault(each.role, []).append(100 * each.capitals / least)
    assert set(shares) == set(TextRole)
    for role, least in ((TextRole.POSITION, 97), (TextRole.STATE, 98), (TextRole.PROMPT, 98)):
        assert min(shares[role]) >= least, role
    assert min(shares[TextRole.FEED]) >= 84  # Feed, spindle and tool share one row.
    values, (median, high) = shares[TextRole.TABLE], TABLES[name]
    assert statistics.median(values) >= median
    assert 100 * sum(share >= 95 for share in values) / len(values) >= high


@pytest.mark.parametrize("page", [page_table.JOG, page_table.MDI, page_table.SEARCHTO_PAGE])
@pytest.mark.parametrize("name", PANELS)
def test_position_readout_is_large_where_axes_can_move(
    operator: Operator, monkeypatch: pytest.MonkeyPatch, name: str, page: str
) -> None:
    size = make_screen_resolution(*PANELS[name])
    operator.stage.make_ready()
    operator.window.resize(*PANELS[name][:2])
    operator.window.theme.screen = size
    assert operator.frame.open_page(page)
    operator.window.refresh()
    with recorded(monkeypatch) as texts:
        operator.frame.readout_line.grab()
    least = 0.97 * TextRole.POSITION.find_min_height_mm(is_small=size.is_small_screen) * size.pixels_per_mm
    heights = [each.capitals for each in texts if each.role is TextRole.POSITION]
    assert len(heights) == 3
    assert min(heights) >= least


@pytest.mark.parametrize("page", [page_table.PROGRAMS, page_table.TOOLS, page_table.SPECIAL])
def test_page_on_which_no_axis_moves_has_no_large_position(operator: Operator, page: str) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page)
    operator.window.refresh()
    assert not operator.frame.readout_line.has_axis_motion
    assert operator.frame.run_line.isVisible()


def test_keyboard_in_low_window_uses_height_of_large_position(operator: Operator) -> None:
    operator.stage.make_ready()
    assert operator.frame.open_page(page_table.MDI)
    operator.window.refresh()
    high = operator.frame.current_page.height()
    assert operator.frame.readout_line.has_axis_motion
    assert not operator.frame.run_line.isVisible()
    operator.frame.current_page.findChildren(LetterPad)[0].show()
    operator.window.refresh()
    assert not operator.frame.readout_line.has_axis_motion
    assert operator.frame.current_page.height() > high + 30
