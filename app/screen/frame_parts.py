"""What is always visible of the main window, in its place: title, readouts, lamps, station, prompt, keys."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QWidget

from app.desk import formats
from app.desk.desk import Desk
from app.desk.interrupted import may_go_on, standing
from app.desk.lamps import Lamp
from app.desk.session import Loaded
from app.desk.view import View
from app.desk.words import tr
from app.screen.bars import FunctionKeys, PromptLine, TitleLine
from app.screen.dock import StationDock
from app.screen.gauges import FeedGauge, SpindleGauge, TimesGauge, ToolGauge
from app.screen.head import HeadLine
from app.screen.layout import Places, Rect, low_places, places, unit, work_of
from app.screen.look import Look
from app.screen.overlay import AlarmList, Notice
from app.screen.position import PositionPanel
from app.screen.runline import RunLine
from app.screen.standing import Row, StandingRows
from app.screen.strip import Strip
from core.executor.snapshot import Snapshot, State

_KEYS = (("F6", "SEARCHTO"), ("Y", "FROM LINE 1"))
GAP = 4  # pixels under the rows that stand


class FrameParts(QWidget):
    """Readouts are large, or the same figures in one low row; alarms lie over the room of the page."""

    def __init__(self, look: Look, desk: Desk, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(parent)
        self.look, self.desk = look, desk
        self.title = TitleLine(look, self)
        self.head = HeadLine(look, self)
        self.run = RunLine(look, self)
        self.position = PositionPanel(look, self)
        self.feed = FeedGauge(look, "FEED", self)
        self.spindle = SpindleGauge(look, "SPINDLE", self)
        self.tool = ToolGauge(look, "TOOL  ·  OFFSET", self)
        self.times = TimesGauge(look, "PARTS  ·  TIME", self)
        self.strip = Strip(look, press, self)
        self.standing = StandingRows(look, press, self)
        self.dock = StationDock(look, desk, self) if desk.station else None
        self.prompt = PromptLine(look, press, self)
        self.keys = FunctionKeys(look, lambda number: press(f"F{number}"), self)
        self.notice = Notice(look, self)
        self.log = AlarmList(look, self)
        self._docked = True

    def lay_parts(self, *, large: bool) -> Rect:
        """Everything in its place for the size of now; the answer is the room of the page."""
        width, height = self.width(), self.height()
        self.look.resize(unit(width, height))
        with_dock = self.dock is not None and self.desk.settings.now.dock
        at, low = places(width, height, with_dock), low_places(width, height, with_dock)
        self._docked = with_dock
        work = work_of(at) if large else low.work
        rows = Rect(work.x, work.y, work.w, min(self.standing.take_room(), work.h // 3))
        work, over = _below(work, rows), _below(at.path if large else low.work, rows)
        stand(self.standing, rows)
        self.standing.setVisible(bool(rows.h))
        self._stand_readouts(at, large)
        for part, rect in ((self.head, low.head), (self.run, low.run)):
            stand(part, rect)
            part.setVisible(not large)
        if self.dock is not None:
            self.dock.let_go()
            self.dock.setVisible(with_dock)
            stand(self.dock, at.dock)
        stand(self.title, at.title)
        stand(self.strip, at.strip if large else low.strip)
        stand(self.prompt, at.prompt)
        stand(self.keys, at.keys)
        stand(self.notice, over)
        stand(self.log, over)
        return work

    @property
    def moved_dock(self) -> bool:
        """Whether the operator wants the station elsewhere than it stands."""
        return self.dock is not None and self._docked is not self.desk.settings.now.dock

    def _stand_readouts(self, at: Places, large: bool) -> None:
        parts: tuple[tuple[QWidget, Rect], ...] = (
            (self.position, at.position),
            (self.feed, at.feed),
            (self.spindle, at.spindle),
            (self.tool, at.tool),
            (self.times, at.times),
        )
        for part, rect in parts:
            stand(part, rect)
            part.setVisible(large)

    def show_readouts(self, snapshot: Snapshot, view: View, loaded: Loaded) -> None:
        """The figures of this instant, large."""
        self.position.show_position(view.position)
        self.feed.show_value(view.feed)
        self.spindle.show_value(view.spindle)
        self.tool.show_value((view.tool, view.secondary))
        self.times.show_value(self.times_of(snapshot, view, loaded))

    def times_of(self, snapshot: Snapshot, view: View, loaded: Loaded) -> tuple[tuple[str, str], ...]:
        """Parts and times, as the run's row has them too."""
        left = formats.duration(self.desk.time_left(snapshot, loaded))
        return (
            ("PARTS", self.desk.counter.words),
            ("CYCLE", view.cycle),
            ("LEFT", left),
            ("LAST", view.last_cycle),
        )

    def lamps_of(self, snapshot: Snapshot, view: View) -> tuple[Lamp, ...]:
        """The lit words, from left to right."""
        on = snapshot.state not in {State.ESTOP, State.DISABLED}
        kept = (Lamp("NOT KEPT", lit=True, warn=True),) if self.desk.unkept() else ()
        return (*view.modes, *view.lamps, *kept, Lamp("DRIVES ON", on, "D"), Lamp("RESET", False, "R"))

    def rows_of(self, snapshot: Snapshot, loaded: Loaded, *, here: bool) -> tuple[Row, ...]:
        """What stands until somebody does something; its keys where they mean that (``here``)."""
        desk, rows = self.desk, []
        found = standing(snapshot, loaded, desk.settings.units)
        if found is not None:
            offered = here and snapshot.state is State.IDLE and bool(snapshot.interrupted_line)
            rows.append(Row(found.text, found.figures, _KEYS[not may_go_on(loaded) :] if offered else ()))
        if desk.unkept():
            held = desk.waiting()
            waits = tr("HELD IN MEMORY, WRITTEN WHEN THERE IS ROOM: {what}").format(what=held) if held else ""
            rows.append(Row(tr("NOT KEPT: {why}").format(why=desk.unkept()), waits))
        return tuple(rows)


def _below(room: Rect, rows: Rect) -> Rect:
    """What of a room is left under the rows."""
    taken = rows.h + GAP if rows.h else 0
    return Rect(room.x, room.y + taken, room.w, room.h - taken)


def stand(part: QWidget, rect: Rect) -> None:
    """Put it there and draw it anew."""
    part.setGeometry(*rect)
    part.update()
