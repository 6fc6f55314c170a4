"""The program window: which rows it shows, when it follows, and that it paints only those."""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

import pytest
from PySide6.QtGui import QPixmap
from PySide6.QtWidgets import QWidget

from app.screen.color_palettes import DARK_PALETTE
from app.screen.program_listing import ProgramListing
from app.screen.screen_theme import ScreenTheme
from tests.screen.test_leafing import above

__all__ = ["above"]  # a fixture of this module too


class Counted(Sequence[str]):
    """A million lines that count how often one is asked for."""

    def __init__(self) -> None:
        self.asked = 0

    def __len__(self) -> int:
        return 1_000_000

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[str]: ...
    def __getitem__(self, index: int | slice) -> str | Sequence[str]:
        self.asked += 1
        return [f"X{index}"] if isinstance(index, slice) else f"X{index}"


@pytest.fixture
def listing(above: QWidget) -> ProgramListing:
    listing = ProgramListing(ScreenTheme(DARK_PALETTE, 8.0), above)
    listing.resize(400, 250)  # nine rows of 23 pixels
    return listing


def painted(listing: ProgramListing) -> QPixmap:
    return listing.grab()


def test_listing_reads_only_visible_lines(listing: ProgramListing) -> None:
    lines = Counted()
    listing.show_source(lines, {})
    listing.show_run_position(500_000, "X1", "")
    lines.asked = 0
    painted(listing)
    assert 0 < lines.asked <= listing.rows


def test_current_line_is_visible(listing: ProgramListing) -> None:
    listing.show_source([f"X{n}" for n in range(100)], {})
    for line in (1, 2, 50, 99, 100):
        listing.show_run_position(line, "X1", "X2")
        painted(listing)
        assert listing.first_row < line <= listing.first_row + listing.rows


def test_scrolling_stops_following_current_line_until_requested(listing: ProgramListing) -> None:
    listing.show_source([f"X{n}" for n in range(100)], {})
    listing.show_run_position(50, "", "")
    painted(listing)
    listing.scroll_by(-1000)
    assert (listing.first_row, listing.follows_run) == (0, False)
    listing.show_run_position(51, "", "")
    painted(listing)
    assert listing.first_row == 0
    listing.scroll_by(1000)
    assert listing.first_row == 100 - listing.rows
    listing.follow_run()
    painted(listing)
    assert listing.first_row < 51 <= listing.first_row + listing.rows


def test_rejected_program_opens_at_first_error(listing: ProgramListing) -> None:
    listing.show_source([f"X{n}" for n in range(100)], {80: "no", 90: "no"})
    painted(listing)
    assert listing.first_row < 80 <= listing.first_row + listing.rows


def test_empty_listing_is_painted(listing: ProgramListing) -> None:
    assert not painted(listing).isNull()
