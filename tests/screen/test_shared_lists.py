"""The lists of editor, MDI, scope and alarms have the rows, marks and scrolling of every other list."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, cast

import pytest
from PySide6.QtWidgets import QWidget

from app.desk.status.alarm_log import LoggedStop
from app.editor.versions_view import VersionList
from app.mdi.mdi_view import HistoryPanel
from app.scope.scope_curves import Sight
from app.scope.scope_readings_view import Readings
from app.screen.code_choices_view import CodeChoices
from app.screen.look import DARK, Look
from app.screen.panel import Panel
from app.screen.program_listing import Listing
from app.screen.window.alarm_panels import AlarmList
from core.executor.snapshot import Alarm
from tests.screen.test_leafing import MANY, SMALL, above, chosen_rows, leaf_keys, press, turn_wheel

if TYPE_CHECKING:
    from app.desk.pages.code_help import CodeHelp
    from app.editor.versions import VersionHistory
    from app.scope.scope_model import Scope

__all__ = ["above"]  # a fixture of this module too


def selected(panel: Panel) -> list[int]:
    """The places of the selected rows among the rows that are shown."""
    panel.grab()
    assert panel.lists
    rows = [spot for spot in panel.spots() if spot.kind == "row"]
    assert rows
    return [place for place, spot in enumerate(rows) if spot.on]


@pytest.fixture
def stops(above: QWidget) -> AlarmList:
    """Thirty stops; each third has a record."""
    opened: list[str] = []
    panel = AlarmList(Look(DARK, SMALL), opened.append, above)
    panel.resize(500, 300)
    alarm = Alarm(102, "following", "FOLLOWING ERROR", "cause", "free the slide", line=1)
    panel.show_entries([LoggedStop(f"{n}", alarm, "" if n % 3 else f"r{n}") for n in range(MANY)])
    panel.grab()
    return panel


def test_a_finger_marks_a_stop_and_the_mark_leads_to_its_record(stops: AlarmList) -> None:
    rows = [spot.box for spot in stops.spots() if spot.kind == "row"]
    assert 2 <= len(rows) == stops.rows < MANY
    press(stops, rows[1])
    assert (stops.marked, selected(stops), stops.record) == (1, [1], "")
    press(stops, rows[0])
    assert (stops.marked, selected(stops), stops.record) == (0, [0], "r0")


@pytest.mark.parametrize(("wanted", "marked"), [(-1, 0), (MANY, MANY - 1), (999, MANY - 1)])
def test_no_mark_beyond_the_ends_of_the_stops(stops: AlarmList, wanted: int, marked: int) -> None:
    stops.mark(wanted)
    stops.grab()
    assert stops.marked == marked
    assert stops.top <= marked < stops.top + stops.rows


def test_the_mark_of_the_stops_stays_in_sight_when_they_scroll(stops: AlarmList) -> None:
    turn_wheel(stops, 5)
    assert (stops.top, stops.marked) == (5, 5)
    turn_wheel(stops, -100)
    assert (stops.top, stops.marked) == (0, stops.rows - 1)


def test_without_stops_nothing_is_marked(above: QWidget) -> None:
    panel = AlarmList(Look(DARK, SMALL), lambda _name: None, above)
    panel.mark(3)
    panel.scroll_by(3)
    panel.grab()
    assert (panel.marked, panel.top, panel.record, list(panel.spots())) == (0, 0, "", [])


def test_a_finger_comes_to_every_line_of_mdi(above: QWidget) -> None:
    """The lines above the last ones were the arrows' alone."""
    taken: list[int] = []
    panel = HistoryPanel(Look(DARK, SMALL), taken.append, above)
    panel.resize(500, 300)
    panel.lines = tuple(f"G1 X{n}" for n in range(MANY))
    up, down = leaf_keys(panel)
    assert chosen_rows(panel, lambda: taken[-1], [down, up]) == set(range(1, MANY + 1))


def test_the_history_of_mdi_shows_what_is_taken_up_and_the_last_line_run(above: QWidget) -> None:
    panel = HistoryPanel(Look(DARK, SMALL), lambda _back: None, above)
    panel.resize(500, 300)
    panel.lines = tuple(f"G1 X{n}" for n in range(MANY))
    panel.grab()
    assert panel.top == MANY - panel.rows
    panel.back = MANY
    assert (selected(panel), panel.top) == ([0], 0)
    turn_wheel(panel, 2)
    assert (selected(panel), panel.top) == ([], 2 * panel.notch)
    panel.lines, panel.back = (*panel.lines, "G1 X30"), 0
    assert (selected(panel), panel.top) == ([], MANY + 1 - panel.rows)


def scope_of(count: int) -> SimpleNamespace:
    quantity = SimpleNamespace(places=lambda _metric: 3, unit=lambda _metric: "mm")
    shown = [SimpleNamespace(key=f"{n}", quantity=quantity, title=f"{n}", note="") for n in range(count)]
    return SimpleNamespace(marked=0, shown=shown, cursors=SimpleNamespace(shown=False))


def test_a_finger_comes_to_every_curve_of_the_scope(above: QWidget) -> None:
    scope = scope_of(MANY)

    def choose(number: int) -> None:
        scope.marked = max(0, min(number, MANY - 1))

    panel = Readings(Look(DARK, SMALL), cast("Scope", scope), choose, above)
    panel.resize(200, 360)
    panel.show_sight(Sight())
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
    def chosen(self) -> SimpleNamespace | None:
        return self.choices[self.marked] if self.choices else None

    def mark(self, number: int) -> None:
        self.marked = max(0, min(len(self.choices) - 1, number))


def test_the_wheel_goes_through_the_codes_and_no_further(above: QWidget) -> None:
    codes = Codes(MANY)
    panel = CodeChoices(Look(DARK, SMALL), cast("CodeHelp", codes), lambda: None, above)
    panel.resize(240, 360)
    turn_wheel(panel, 15)
    assert (codes.marked, selected(panel)) == (15, [panel.rows // 2])
    turn_wheel(panel, 999)
    assert (codes.marked, panel.top) == (MANY - 1, MANY - panel.rows)


def test_a_line_without_codes_has_no_rows(above: QWidget) -> None:
    panel = CodeChoices(Look(DARK, SMALL), cast("CodeHelp", Codes(0)), lambda: None, above)
    panel.resize(240, 360)
    turn_wheel(panel, 1)
    assert not panel.spots()


def test_the_wheel_scrolls_the_comparison_to_its_end_and_leaves_the_version(above: QWidget) -> None:
    rows = tuple(
        SimpleNamespace(number=n, saved="2026-01-01T10:00:00+00:00", size=n, why="", who="") for n in range(3)
    )
    changes = tuple(SimpleNamespace(old=n, new=n, sign=" ", text="") for n in range(MANY))
    history = SimpleNamespace(
        rows=rows, marked=1, changes=changes, words=lambda: "", heading=lambda: "", mark=lambda _n: None
    )
    panel = VersionList(Look(DARK, SMALL), cast("VersionHistory", history), above)
    panel.resize(500, 300)
    assert selected(panel) == [1]
    turn_wheel(panel, 1)
    assert panel.top == panel.notch
    turn_wheel(panel, 999)
    assert (panel.top, history.marked, selected(panel)) == (MANY - panel.rows, 1, [1])


@pytest.mark.parametrize(("line", "marked"), [(0, []), (1, [0]), (MANY, [-1])])
def test_of_the_lines_of_a_program_the_executed_one_is_selected(
    above: QWidget, line: int, marked: list[int]
) -> None:
    panel = Listing(Look(DARK, SMALL), above)
    panel.touched = lambda _line: None
    panel.resize(500, 300)
    panel.show_source([f"N{n}" for n in range(MANY)], {})
    panel.show_run(line, "", "")
    panel.grab()
    assert selected(panel) == [place % panel.rows for place in marked]
