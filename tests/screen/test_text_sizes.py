"""Heights of texts by distance: the real size of a panel, and what every page draws on it."""

from __future__ import annotations

from math import radians, tan

import pytest

from app.screen import page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.text_sizes import CAPITAL_HEIGHT_RATIO, ScreenResolution, TextRole, make_screen_resolution
from app.screen.window_layout import (
    LOW_WINDOW_HEIGHT_PX,
    find_unit_px,
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
# Requirements that not every page meets in English and Spanish: the height of the lowest text of a role in
# percent of the height that its distance requires. On pages on which axes can move and on the Automatic page,
# the position is higher. Three axes with eight characters limit the position, feed shares its row with the
# spindle and the tool, and the height of the title line limits the state. A Spanish sentence that is too wide
# for its row is drawn at 60 % of its height at the least.
SHORT = {
    "7": {
        TextRole.POSITION: 39,
        TextRole.STATE: 39,
        TextRole.PROMPT: 54,
        TextRole.FEED: 34,
        TextRole.TABLE: 24,
    },
    "10": {
        TextRole.POSITION: 34,
        TextRole.STATE: 34,
        TextRole.PROMPT: 52,
        TextRole.FEED: 34,
        TextRole.TABLE: 24,
    },
    "10.1": {
        TextRole.POSITION: 34,
        TextRole.STATE: 39,
        TextRole.PROMPT: 51,
        TextRole.FEED: 34,
        TextRole.TABLE: 22,
    },
    "12.1": {
        TextRole.POSITION: 41,
        TextRole.STATE: 48,
        TextRole.PROMPT: 62,
        TextRole.FEED: 41,
        TextRole.TABLE: 25,
    },
    "15.6": {
        TextRole.POSITION: 55,
        TextRole.STATE: 65,
        TextRole.PROMPT: 83,
        TextRole.FEED: 54,
        TextRole.TABLE: 39,
    },
    "21.5": {TextRole.POSITION: 75, TextRole.STATE: 90, TextRole.FEED: 75, TextRole.TABLE: 55},
    "27": {TextRole.POSITION: 95, TextRole.TABLE: 68},
    "upright": {
        TextRole.POSITION: 30,
        TextRole.STATE: 35,
        TextRole.PROMPT: 47,
        TextRole.FEED: 30,
        TextRole.TABLE: 20,
    },
}
# The position on the pages on which axes can move, in percent of the required height.
MOVING = {"7": 40, "10": 34, "10.1": 49, "12.1": 59, "15.6": 79, "21.5": 98, "27": 98, "upright": 44}
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


def test_a_text_grows_to_the_height_of_its_role_or_of_its_row() -> None:
    look = ScreenTheme(DARK_PALETTE, 8.0)
    look.screen = ScreenResolution(5.0)  # A position has capitals of 58.2 pixels, and a table of 16.3 pixels.
    needed = 58.18 / CAPITAL_HEIGHT_RATIO / 8.0
    assert look.find_em_height(5.0, TextRole.POSITION, 200.0) == pytest.approx(needed, rel=1e-3)
    assert look.find_em_height(5.0, TextRole.POSITION, 56.0) == pytest.approx(
        7.7
    )  # 1.1 times the row of 7 units
    assert look.find_em_height(5.0, TextRole.POSITION, 8.0) == 5.0  # never smaller than its least size
    needed = 16.29 / CAPITAL_HEIGHT_RATIO / 8.0
    assert look.find_em_height(2.0, TextRole.TABLE, 80.0) == pytest.approx(needed, rel=1e-3)
    assert look.find_em_height(1.5, TextRole.TABLE, 80.0) == pytest.approx(2.4)  # 1.6 times
    assert look.find_em_height(1.5, TextRole.TABLE, 12.8) == pytest.approx(1.5)
    look.screen = ScreenResolution(2.0)
    assert look.find_em_height(2.0, TextRole.TABLE, 80.0) == 2.0  # A large screen needs no more.


@pytest.mark.parametrize("size", [(1024, 600), (1280, 800), (1920, 1080), (3840, 2160), (1080, 1920)])
@pytest.mark.parametrize("dock", [True, False])
def test_large_position_readout_uses_2_8_units_of_page(size: tuple[int, int], dock: bool) -> None:
    low, moves, u = (
        make_compact_layout(*size, dock),
        make_compact_layout(*size, dock, has_axis_motion=True),
        find_unit_px(*size),
    )
    more = 2.8 * u if size[1] >= LOW_WINDOW_HEIGHT_PX else 0.0  # a lower window keeps the room for fingers
    assert moves.readout_line.h - low.readout_line.h == pytest.approx(more, abs=1)
    assert low.work_area.h - moves.work_area.h == moves.readout_line.h - low.readout_line.h
    assert moves.work_area.bottom == low.work_area.bottom <= make_automatic_layout(*size, dock).prompt.y


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("name", PANELS)
def test_texts_on_all_pages_have_required_height(
    operator: Operator, monkeypatch: pytest.MonkeyPatch, name: str, language: str
) -> None:
    size, lowest = make_screen_resolution(*PANELS[name]), dict[TextRole, tuple[float, str]]()
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
    for each in texts:
        share = (
            100
            * each.capitals
            / (each.role.find_min_height_mm(is_small=size.is_small_screen) * size.pixels_per_mm)
        )
        lowest[each.role] = min((share, f"{each.panel}: {each.text}"), lowest.get(each.role, (999.0, "")))
    assert set(lowest) == set(TextRole)
    for role, (share, text) in lowest.items():
        assert share >= SHORT[name].get(role, 98), (role, share, text)


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
    least = (
        MOVING[name]
        / 100
        * TextRole.POSITION.find_min_height_mm(is_small=size.is_small_screen)
        * size.pixels_per_mm
    )
    heights = [each.capitals for each in texts if each.role is TextRole.POSITION]
    assert len(heights) == 3
    assert min(heights) >= least
