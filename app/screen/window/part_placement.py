"""Which parts the window frame shows around a page, and where it places them."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.status.machine_status import MachineStatus
from app.desk.status.readouts import Lamp, make_drives_lamp
from app.screen.page_base import Page
from app.screen.window.key_table import HELP_KEY
from app.screen.window_layout import LOW_WINDOW_HEIGHT_PX, Rect
from core.executor.snapshot import Snapshot

GAP_PX = 4  # Pixels below the notice rows.


def find_needed_readouts(page: Page, window_height_px: int, has_notices: bool) -> tuple[bool, bool]:
    """Return whether a page has a large position above it, and a run line below it.

    Pages on which axes can move have a large position. In a low window, they have no run line, and notices
    and touch keyboards use the height of the large position.
    """
    moves, needs_height = page.CAN_START_CYCLES, page.needs_height()
    if window_height_px >= LOW_WINDOW_HEIGHT_PX:
        return moves, True
    return moves and not needs_height and not has_notices, not (moves or needs_height)


def make_lamp_row(desk: Desk, snapshot: Snapshot, status: MachineStatus) -> tuple[Lamp, ...]:
    """Return the lamps from left to right."""
    unsaved = (
        (Lamp("NOT SAVED", is_lit=True, is_warning=True),)
        if desk.storage_state.read_storage_problem()
        else ()
    )
    return (
        *status.mode_lamps,
        *status.lamps,
        *unsaved,
        make_drives_lamp(snapshot, "D"),
        Lamp("RESET", False, "R"),
        Lamp("HELP", False, HELP_KEY),
    )


def find_area_below(area: Rect, rows: Rect) -> Rect:
    """Return the part of a rectangle below the notice rows."""
    taken = rows.h + GAP_PX if rows.h else 0
    return Rect(area.x, area.y + taken, area.w, area.h - taken)


def place_widget(widget: QWidget, rect: Rect) -> None:
    """Set the geometry of a widget, and redraw it."""
    widget.setGeometry(*rect)
    widget.update()
