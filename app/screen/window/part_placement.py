"""Which parts the window frame shows around a page, and where it places them."""

from __future__ import annotations

from typing import NamedTuple

from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status import formats
from app.desk.status.machine_status import MachineStatus
from app.desk.status.readouts import TURNING_RPM, Lamp, make_drives_lamp
from app.desk.status.state_prompt import find_remaining_time_s
from app.screen import page_table
from app.screen.page_base import Page
from app.screen.window.key_table import HELP_KEY
from app.screen.window_layout import LOW_WINDOW_HEIGHT_PX, Rect
from core.executor.snapshot import MachineState, Snapshot

_LAYOUT_DELAY_S = 3.0  # Seconds after a manual move before the layout of a page may change.
GAP_PX = 4  # Pixels below the notice rows, and next to the help.


class LayoutNeeds(NamedTuple):
    """What the layout of a page depends on.

    ``has_automatic_layout`` is True if the large readouts of the Automatic page are shown. Otherwise the
    readouts are in one row, with a large position or with a run line.
    """

    has_automatic_layout: bool
    has_large_position: bool
    has_run_line: bool
    has_alarm_notice: bool
    search_height_px: int


class ManualMotion:
    """Time of the last manual move of an axis."""

    def __init__(self) -> None:
        self._moved_at_s: float | None = None

    def is_recent(self, snapshot: Snapshot, now_s: float) -> bool:
        """Return whether the axes were jogged or homed in the last few seconds.

        The touch targets must then stay at their positions.
        """
        if snapshot.state in {MachineState.JOG, MachineState.HOMING}:
            self._moved_at_s = now_s
        return self._moved_at_s is not None and now_s - self._moved_at_s < _LAYOUT_DELAY_S


def find_layout_needs(
    page: Page, window_height_px: int, *, has_notices: bool, has_alarm: bool, search_height_px: int = 0
) -> LayoutNeeds:
    """Return the parts that are shown around a page.

    Pages on which axes can move have a large position. In a low window, they have no run line, and notices
    and touch keyboards use the height of the large position. Alarms use the height of the large readouts of
    the Automatic page. If a view of the page is enlarged, the readouts are in one row without a run line.
    """
    moves, needs_height, low = (
        page.CAN_START_CYCLES,
        page.needs_height() or search_height_px > 0,
        window_height_px < LOW_WINDOW_HEIGHT_PX,
    )
    is_automatic = page.NAME == page_table.AUTOMATIC
    shows_alarm = is_automatic and has_alarm
    if page.has_enlarged_view:
        return LayoutNeeds(False, False, False, shows_alarm, search_height_px)
    has_automatic_layout = is_automatic and not (low and shows_alarm)
    if not low:
        return LayoutNeeds(has_automatic_layout, moves, True, shows_alarm, search_height_px)
    has_large_position = moves and not needs_height and not has_notices
    has_run_line = not (moves or needs_height)
    return LayoutNeeds(has_automatic_layout, has_large_position, has_run_line, shows_alarm, search_height_px)


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


def make_times(
    desk: Desk, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram
) -> tuple[tuple[str, str], ...]:
    """Return the part count and times for the times panel and the run status row."""
    return (
        ("PARTS", desk.program_runs.part_counter.part_count_text),
        ("CYCLE", status.cycle_time_text),
        ("LEFT", formats.format_duration(find_remaining_time_s(snapshot, loaded))),
        ("LAST", status.last_cycle_time_text),
    )


def needs_instruction(snapshot: Snapshot) -> bool:
    """Return whether the prompt must tell the operator how to stop or to continue, also at rest."""
    is_stopped = snapshot.state in {MachineState.FAULT, MachineState.ESTOP} or bool(snapshot.alarms)
    return is_stopped or bool(snapshot.rpm_command) or abs(snapshot.rpm_actual) > TURNING_RPM


def find_area_below(area: Rect, rows: Rect) -> Rect:
    """Return the part of a rectangle below the notice rows."""
    taken = rows.h + GAP_PX if rows.h else 0
    return Rect(area.x, area.y + taken, area.w, area.h - taken)


def find_area_left_of(area: Rect, other: Rect) -> Rect:
    """Return the part of a rectangle to the left of another rectangle."""
    return area._replace(w=max(0, other.x - GAP_PX - area.x))


def place_widget(widget: QWidget, rect: Rect) -> None:
    """Set the geometry of a widget, and redraw it."""
    widget.setGeometry(*rect)
    widget.update()
