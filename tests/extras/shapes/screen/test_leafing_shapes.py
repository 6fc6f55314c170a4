"""A finger comes to every shape of a list that is longer than its panel."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.extras.shapes.shapes_view import ShapeRowsPanel, _Line
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from tests.screen.test_leafing import MANY, SMALL, above, chosen_rows, leaf_keys

__all__ = ["above"]


def test_every_shape_can_be_reached_by_touch(above: QWidget) -> None:
    touched: list[int] = []
    panel = ShapeRowsPanel(ScreenTheme(DARK_PALETTE, SMALL), lambda row, _column: touched.append(row), above)
    panel.resize(260, 300)
    panel.displayed_rows = tuple(_Line(f"row {n}") for n in range(MANY))
    assert chosen_rows(panel, lambda: touched[-1], leaf_keys(panel)) == set(range(MANY))
