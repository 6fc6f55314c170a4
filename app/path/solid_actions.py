"""Keys and buttons for the part in space: section and stock."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from app.desk.translation import tr
from app.path.path_marks_view import ViewButton
from app.path.path_pane_view import PathPane
from app.path.solid_pane_view import SolidPane

if TYPE_CHECKING:
    from app.screen.page_base import KeyActions

SECTION_KEY = "X"
ROTATE_SECTION_KEY = "Shift+X"
STOCK_KEY = "G"


def make_solid_key_actions(panes: Iterable[PathPane], redraw: Callable[[], None]) -> KeyActions:
    """Return the actions of the keys for the first pane that shows the part in space."""
    pane = _find_solid_pane(panes)
    if pane is None:
        return {}
    return {
        SECTION_KEY: partial(_change, pane.toggle_section, redraw),
        ROTATE_SECTION_KEY: partial(_change, pane.rotate_section, redraw),
        STOCK_KEY: partial(_change, pane.toggle_stock, redraw),
    }


def make_solid_buttons(panes: Iterable[PathPane], redraw: Callable[[], None]) -> Iterator[ViewButton]:
    """Yield the buttons for the part in space: section, rotation of its plane, and stock."""
    pane = _find_solid_pane(panes)
    if pane is not None:
        is_cut = pane.section_angle_deg is not None
        yield ViewButton(tr("CUT"), partial(_change, pane.toggle_section, redraw), is_cut)
        yield ViewButton("∠", partial(_change, pane.rotate_section, redraw))
        yield ViewButton(tr("BLANK"), partial(_change, pane.toggle_stock, redraw), pane.is_stock_shown)


def _find_solid_pane(panes: Iterable[PathPane]) -> SolidPane | None:
    return next((pane for pane in panes if isinstance(pane, SolidPane)), None)


def _change(change: Callable[[], None], redraw: Callable[[], None]) -> None:
    change()
    redraw()
