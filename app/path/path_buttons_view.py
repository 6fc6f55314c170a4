"""Buttons of the path view, and keys for the part in space."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Protocol

from app.desk.translation import tr
from app.path.path_marks_view import ViewButton, count_button_columns
from app.path.path_pane_view import PathPane
from app.path.solid_pane_view import SolidPane

if TYPE_CHECKING:
    from PySide6.QtCore import QRectF

    from app.screen.page_base import KeyActions
    from app.screen.panel import OnPress
    from app.screen.screen_theme import ScreenTheme

SECTION_KEY = "X"
ROTATE_SECTION_KEY = "Shift+X"
STOCK_KEY = "G"
_MAX_COLUMNS = 3  # of buttons, with the buttons for the part in space


class ViewWithButtons(Protocol):
    """A view whose buttons ``make_view_buttons`` makes. ``enlarge`` is None if its size is fixed."""

    theme: ScreenTheme
    enlarge: OnPress | None

    def find_panes_area(self) -> QRectF:
        """Return the area inside the frame of the view."""

    @property
    def measurement(self) -> object | None:
        """Return the measurement, or None while the user does not measure."""

    @property
    def panes(self) -> Sequence[PathPane]:
        """Return the visible panes."""

    @property
    def has_several_views(self) -> bool:
        """Return whether more than one view exists."""

    def zoom_view(self, steps: int) -> None:
        """Zoom in (positive steps) or out (negative steps)."""

    def fit_all_panes(self) -> None:
        """Zoom every pane so that it shows its whole path."""

    def switch_measuring(self) -> None:
        """Start or stop measuring."""

    def select_next_view(self) -> None:
        """Switch to the next view."""

    def update(self) -> None:
        """Redraw the view."""


def make_view_buttons(view: ViewWithButtons) -> list[ViewButton]:
    """Return the buttons of a path view, from top to bottom.

    A low view has no buttons for the part in space, because they would cover it. Their keys still act.
    """
    found = [
        ViewButton("+", lambda: view.zoom_view(1)),
        ViewButton("−", lambda: view.zoom_view(-1)),
        ViewButton(tr("FIT"), view.fit_all_panes),
        ViewButton(tr("MEAS"), view.switch_measuring, view.measurement is not None),
    ]
    if view.has_several_views:
        # A low pane does not have room for all buttons.
        found.insert(2, ViewButton(tr("VIEW"), view.select_next_view))
    if view.enlarge is not None:
        found.append(ViewButton(tr("LARGE"), view.enlarge))
    more = [*found, *_make_solid_buttons(view.panes, view.update)]
    columns = count_button_columns(view.theme, view.find_panes_area(), len(more))
    return more if columns <= _MAX_COLUMNS else found


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


def _make_solid_buttons(panes: Iterable[PathPane], redraw: Callable[[], None]) -> Iterator[ViewButton]:
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
