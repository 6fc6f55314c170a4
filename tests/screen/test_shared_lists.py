"""The lists of editor, MDI, scope and alarms have the rows, marks and scrolling of every other list."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, cast

import pytest
from PySide6.QtWidgets import QWidget

from app.desk.status.alarm_log import LoggedStop
from app.editor.versions_view import VersionList
from app.mdi.mdi_view import MdiHistoryPanel
from app.scope.scope_curves import ScopePicture
from app.scope.scope_readings_view import ScopeReadings
from app.screen.code_choices_view import CodeChoiceList
from app.screen.color_palettes import DARK_PALETTE
from app.screen.panel import Panel
from app.screen.program_listing import ProgramListing
from app.screen.screen_theme import ScreenTheme
from app.screen.window.alarm_panels import AlarmList
from core.executor.snapshot import Alarm
from tests.screen.test_leafing import MANY, SMALL, above, chosen_rows, leaf_keys, press, turn_wheel

if TYPE_CHECKING:
    from app.desk.pages.code_help import CodeHelp
    from app.editor.version_history import VersionHistory
    from app.scope.scope_model import ScopeModel

__all__ = ["above"]  # a fixture of this module too


def selected(panel: Panel) -> list[int]:
    """The places of the selected rows among the rows that are shown."""
    panel.grab()
    assert panel.is_list
    rows = [spot for spot in panel.list_targets() if spot.kind == "row"]
    assert rows
    return [place for place, spot in enumerate(rows) if spot.is_on]


@pytest.fixture
def stops(above: QWidget) -> AlarmList:
    """Thirty stops; each third has a record."""
    opened: list[str] = []
    panel = AlarmList(ScreenTheme(DARK_PALETTE, SMALL), opened.append, above)
    panel.resize(500, 300)
    alarm = Alarm(102, "following", "FOLLOWING ERROR", "cause", "free the slide", line=1)
    panel.show_entries([LoggedStop(f"{n}", alarm, "" if n % 3 else f"r{n}") for n in range(MANY)])
    panel.grab()
    return panel


def test_touch_marks_stop_and_selects_its_recording(stops: AlarmList) -> None:
    rows = [spot.box for spot in stops.list_targets() if spot.kind == "row"]
    assert 2 <= len(rows) == stops.rows < MANY
    press(stops, rows[1])
    assert (stops.marked, selected(stops), stops.recording_name) == (1, [1], "")
    press(stops, rows[0])
    assert (stops.marked, selected(stops), stops.recording_name) == (0, [0], "r0")


@pytest.mark.parametrize(("wanted", "marked"), [(-1, 0), (MANY, MANY - 1), (999, MANY - 1)])
def test_mark_stays_within_list_of_stops(stops: AlarmList, wanted: int, marked: int) -> None:
    stops.mark(wanted)
    stops.grab()
    assert stops.marked == marked
    assert stops.first_row <= marked < stops.first_row + stops.rows


def test_marked_stop_stays_visible_while_scrolling(stops: AlarmList) -> None:
    turn_wheel(stops, 5)
    assert (stops.first_row, stops.marked) == (5, 5)
    turn_wheel(stops, -100)
    assert (stops.first_row, stops.marked) == (0, stops.rows - 1)


def test_nothing_is_marked_without_stops(above: QWidget) -> None:
    panel = AlarmList(ScreenTheme(DARK_PALETTE, SMALL), lambda _name: None, above)
    panel.mark(3)
    panel.scroll_by(3)
    panel.grab()
    assert (panel.marked, panel.first_row, panel.recording_name, list(panel.list_targets())) == (0, 0, "", [])


def test_every_mdi_line_is_reached_by_touch(above: QWidget) -> None:
    """The lines above the last ones were the arrows' alone."""
    taken: list[int] = []
    panel = MdiHistoryPanel(ScreenTheme(DARK_PALETTE, SMALL), taken.append, above)
    panel.resize(500, 300)
    panel.history_lines = tuple(f"G1 X{n}" for n in range(MANY))
    up, down = leaf_keys(panel)
    assert chosen_rows(panel, lambda: taken[-1], [down, up]) == set(range(1, MANY + 1))


def test_mdi_history_marks_recalled_line_and_shows_last_run_line(above: QWidget) -> None:
    panel = MdiHistoryPanel(ScreenTheme(DARK_PALETTE, SMALL), lambda _back: None, above)
    panel.resize(500, 300)
    panel.history_lines = tuple(f"G1 X{n}" for n in range(MANY))
    panel.grab()
    assert panel.first_row == MANY - panel.rows
    panel.recall_index = MANY
    assert (selected(panel), panel.first_row) == ([0], 0)
    turn_wheel(panel, 2)
    assert (selected(panel), panel.first_row) == ([], 2 * panel.scroll_step)
    panel.history_lines, panel.recall_index = (*panel.history_lines, "G1 X30"), 0
    assert (selected(panel), panel.first_row) == ([], MANY + 1 - panel.rows)


def scope_of(count: int) -> SimpleNamespace:
    quantity = SimpleNamespace(places=lambda _metric: 3, unit=lambda _metric: "mm")
    shown = [SimpleNamespace(key=f"{n}", quantity=quantity, title=f"{n}", note="") for n in range(count)]
    return SimpleNamespace(marked=0, shown=shown, cursors=SimpleNamespace(shown=False))


def test_every_scope_curve_is_reached_by_touch(above: QWidget) -> None:
    scope = scope_of(MANY)

    def choose(number: int) -> None:
        scope.marked = max(0, min(number, MANY - 1))

    panel = ScopeReadings(ScreenTheme(DARK_PALETTE, SMALL), cast("ScopeModel", scope), choose, above)
    panel.resize(200, 360)
    panel.show_picture(ScopePicture())
    assert chosen_rows(panel, lambda: scope.marked, leaf_keys(panel)) == set(range(MANY))
    turn_wheel(panel, -1)
    assert scope.marked == MANY - 2


class Codes:
    """Choices of a code book, as the editor and MDI show them."""

    title, words = "CODES", ()

    def __init__(self, count: int) -> None:
        self.choices = tuple(SimpleNamespace(form=f"G{n}", what="", example="") for n in range(count))
        self.marked = 0

    @property
    def selected_entry(self) -> SimpleNamespace | None:
        return self.choices[self.marked] if self.choices else None

    def mark(self, index: int) -> None:
        self.marked = max(0, min(len(self.choices) - 1, index))


def test_wheel_scrolls_codes_up_to_last_one(above: QWidget) -> None:
    codes = Codes(MANY)
    panel = CodeChoiceList(ScreenTheme(DARK_PALETTE, SMALL), cast("CodeHelp", codes), lambda: None, above)
    panel.resize(240, 360)
    turn_wheel(panel, 15)
    assert (codes.marked, selected(panel)) == (15, [panel.rows // 2])
    turn_wheel(panel, 999)
    assert (codes.marked, panel.first_row) == (MANY - 1, MANY - panel.rows)


def test_line_without_codes_shows_no_rows(above: QWidget) -> None:
    panel = CodeChoiceList(ScreenTheme(DARK_PALETTE, SMALL), cast("CodeHelp", Codes(0)), lambda: None, above)
    panel.resize(240, 360)
    turn_wheel(panel, 1)
    assert not panel.list_targets()


def test_wheel_scrolls_comparison_without_changing_version(above: QWidget) -> None:
    rows = tuple(
        SimpleNamespace(number=n, saved="2026-01-01T10:00:00+00:00", size=n, why="", who="") for n in range(3)
    )
    changes = tuple(SimpleNamespace(old=n, new=n, sign=" ", text="") for n in range(MANY))
    history = SimpleNamespace(
        rows=rows, marked=1, changes=changes, words=lambda: "", heading=lambda: "", mark=lambda _n: None
    )
    panel = VersionList(ScreenTheme(DARK_PALETTE, SMALL), cast("VersionHistory", history), above)
    panel.resize(500, 300)
    assert selected(panel) == [1]
    turn_wheel(panel, 1)
    assert panel.first_row == panel.scroll_step
    turn_wheel(panel, 999)
    assert (panel.first_row, history.marked, selected(panel)) == (MANY - panel.rows, 1, [1])


@pytest.mark.parametrize(("line", "marked"), [(0, []), (1, [0]), (MANY, [-1])])
def test_executed_line_of_program_is_selected(above: QWidget, line: int, marked: list[int]) -> None:
    panel = ProgramListing(ScreenTheme(DARK_PALETTE, SMALL), above)
    panel.on_line_touched = lambda _line: None
    panel.resize(500, 300)
    panel.show_source([f"N{n}" for n in range(MANY)], {})
    panel.show_run_position(line, "", "")
    panel.grab()
    assert selected(panel) == [place % panel.rows for place in marked]
