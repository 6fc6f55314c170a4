"""Stock and collet below the path: which part of them is visible, and the row below the panes."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pytestqt.qtbot import QtBot

from app.path.path_aspects import ApproachLeg
from app.path.path_stock_view import StockAndClamping, find_stock_and_clamping
from app.path.path_view import FOOTER_HEIGHT, PathView
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from core.part.stock import Clamping, Stock, make_bar_stock
from core.part.stock_spec import StockSpec, parse_stock_specification
from core.proving.part_history import ProgramSteps
from core.proving.program_tools import PartSettings
from tests.path.test_part_player import SHAFT, picture
from tests.screen.hands import LIMIT

COLLET = Clamping(60.0, 30.0)
BAR = make_bar_stock(20.0, 0.0, -100.0)


def setting(stock: Stock | StockSpec | None, clamping: Clamping | None) -> PartSettings:
    return PartSettings(stock=stock, clamping=clamping)


def blank(stock: Stock | StockSpec | None, clamping: Clamping | None) -> StockAndClamping | None:
    """What the picture of the shaft shows of a stock and a clamping."""
    drawn = picture(SHAFT)
    assert drawn.part is not None
    return find_stock_and_clamping(
        replace(drawn, part=ProgramSteps(drawn.part.block_groups, setting(stock, clamping)))
    )


def test_no_blank_is_shown_for_unspecified_part() -> None:
    assert blank(None, None) is None
    assert blank(None, Clamping(0.0, 0.0, max_rpm=3000.0)) is None
    assert find_stock_and_clamping(replace(picture(SHAFT), part=None)) is None


def test_unreadable_stock_shows_only_the_collet() -> None:
    wrong = StockSpec("profile:x", points="z,r\n1,2\n")
    assert blank(wrong, None) is None
    found = blank(wrong, COLLET)
    assert found is not None
    assert found.stock is None


def test_bar_length_comes_from_program_unless_specified() -> None:
    as_needed, given = (
        blank(parse_stock_specification("bar:1.0"), None),
        blank(parse_stock_specification("bar:1.0:3"), None),
    )
    assert as_needed is not None
    assert as_needed.stock is not None
    assert as_needed.stock.back_z_mm < picture(SHAFT).bounds[0]
    assert given is not None
    assert given.stock is not None
    assert given.stock.back_z_mm == pytest.approx(-3 * 25.4)


def test_distant_retract_does_not_shrink_part() -> None:
    """The stock is 30 mm long in front of the collet: 12 % of 30 + 20 mm are shown next to it."""
    seen = StockAndClamping(BAR, BAR, COLLET).find_visible_area((-25.0, 200.0, 0.0, 150.0))
    assert seen == pytest.approx((-30.0, 6.0, 0.0, 16.0))


def test_all_cuts_are_visible_without_a_stock() -> None:
    cuts = (-25.0, 200.0, -3.0, 150.0)
    assert StockAndClamping(None, BAR, COLLET).find_visible_area(cuts) == cuts


def test_chuck_is_shown_up_to_a_fraction_of_stock_length() -> None:
    assert StockAndClamping(BAR, BAR, COLLET).chuck_left_z_mm == pytest.approx(-30.0 - 12.0)
    assert StockAndClamping(BAR, BAR, None).chuck_left_z_mm is None


@pytest.fixture
def view(qtbot: QtBot) -> PathView:
    """A path view with a bar in a collet."""
    made = PathView(ScreenTheme(DARK_PALETTE, 8.0))
    made.resize(640, 280)
    qtbot.addWidget(made)
    with qtbot.waitExposed(made, timeout=LIMIT):
        made.show()
    drawn = picture(SHAFT)
    assert drawn.part is not None
    made.show_picture(replace(drawn, part=ProgramSteps(drawn.part.block_groups, setting(BAR, COLLET))))
    return made


def test_legend_and_scale_are_below_all_panes(view: PathView) -> None:
    (pane,) = view.panes
    texts = [
        (box, text)
        for box, text in view.read_painted_texts()
        if text in {"done", "remaining", "rapid", "0.2 in"}
    ]
    assert {"done", "remaining", "rapid"} <= {text for _, text in texts}
    for box, text in texts:
        assert not box.intersects(pane.area), text
        assert box.bottom() <= view.height(), text
    assert pane.area.bottom() + FOOTER_HEIGHT * view.theme.unit_px <= view.height()


def test_the_part_fills_the_height_of_the_pane(view: PathView) -> None:
    (pane,) = view.panes
    top, bottom = pane.map_to_pane(0.0, -10.0).y(), pane.map_to_pane(0.0, 10.0).y()
    assert bottom - top > 0.6 * pane.area.height()


def test_distant_approach_zooms_out_only_if_whole_approach_is_shown(view: PathView) -> None:
    near = view.first_projection
    view.show_approach((ApproachLeg(400.0, 200.0), ApproachLeg(5.0, 12.0, label="START")))
    view.grab()
    assert view.first_projection == near
    view.shows_whole_approach = True
    view.show_approach((ApproachLeg(400.0, 201.0), ApproachLeg(5.0, 12.0, label="START")))
    assert view.first_projection is not None
    assert near is not None
    assert view.first_projection.pixels_per_mm < near.pixels_per_mm / 3
