"""The Automatic page: its parts, where they stand, and what each is shown of one snapshot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk import formats
from app.desk.desk import Desk
from app.desk.lamps import Lamp
from app.desk.session import Loaded
from app.desk.view import View
from app.screen.bars import CommentLine, FunctionKeys, PromptLine, TitleLine
from app.screen.dock import StationDock
from app.screen.fileprompt import FilePrompt
from app.screen.gauges import FeedGauge, SpindleGauge, TimesGauge, ToolGauge
from app.screen.layout import Rect, places, unit
from app.screen.listing import Listing
from app.screen.look import Look
from app.screen.overlay import AlarmList, Notice
from app.screen.pathview import PathView, Tip
from app.screen.position import PositionPanel
from app.screen.strip import Strip
from core.executor.snapshot import Snapshot, State

_NO_LINES: tuple[str, ...] = ()


class AutomaticPage(QWidget):
    """Polls nothing itself: ``refresh`` is called once a frame, and each part redraws only what changed."""

    def __init__(self, look: Look, desk: Desk, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(parent)
        self.look, self.desk = look, desk
        self._loaded = Loaded()
        self.title = TitleLine(look, self)
        self.position = PositionPanel(look, self)
        self.feed = FeedGauge(look, "FEED", self)
        self.spindle = SpindleGauge(look, "SPINDLE", self)
        self.tool = ToolGauge(look, "TOOL  ·  OFFSET", self)
        self.times = TimesGauge(look, "PARTS  ·  TIME", self)
        self.strip = Strip(look, press, self)
        self.listing = Listing(look, self)
        self.comment = CommentLine(look, self)
        self.path = PathView(look, self)
        self.dock = StationDock(look, desk, self) if desk.station else None
        self.prompt = PromptLine(look, self)
        self.keys = FunctionKeys(look, lambda number: press(f"F{number}"), self)
        self.notice = Notice(look, self)
        self.log = AlarmList(look, self)
        self.files = FilePrompt(look, desk.shelf, desk.choose, self._files_closed, self)

    def dress(self) -> None:
        """Everything in the colours that are in force now."""
        self.files.dress()
        self.path.restart()
        for part in self.findChildren(QWidget):
            part.update()

    def _files_closed(self) -> None:
        self.window().setFocus()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Everything again, in the new unit."""
        width, height = self.width(), self.height()
        self.look.resize(unit(width, height))
        at = places(width, height, self.dock is not None)
        for part, rect in (
            (self.title, at.title),
            (self.position, at.position),
            (self.feed, at.feed),
            (self.spindle, at.spindle),
            (self.tool, at.tool),
            (self.times, at.times),
            (self.strip, at.strip),
            (self.listing, at.listing),
            (self.comment, at.comment),
            (self.path, at.path),
            (self.dock, at.dock),
            (self.prompt, at.prompt),
            (self.keys, at.keys),
            (self.notice, at.path),
            (self.log, at.path),
            (self.files, at.path),
        ):
            if part is not None:
                _stand(part, rect)

    def refresh(self) -> None:
        """Take one snapshot and show it everywhere."""
        snapshot, view, loaded = self.desk.look()
        if self.files.isVisible() and snapshot.state in {State.RUN, State.WAIT}:
            self.files.dismiss()  # a cycle was started at the station: the keys belong to it
        self._show_program(loaded)
        self._show_bars(snapshot, view, loaded)
        self.position.show_position(view.position)
        self.feed.show_value(view.feed)
        self.spindle.show_value(view.spindle)
        self.tool.show_value((view.tool, view.secondary))
        self.times.show_value(self._times(snapshot, view, loaded))
        self.strip.show_lamps(self._lamps(snapshot, view))
        self.listing.show_run(view.line, view.block_text, view.next_text)
        self._show_path(snapshot)
        self.notice.show_notice(view.message, self.desk.start_words + " TO GO ON", view.alarm)
        self.log.show_entries(self.desk.log.entries)
        if self.dock is not None:
            self.dock.show_station(snapshot)

    def _show_program(self, loaded: Loaded) -> None:
        if loaded is self._loaded:
            return
        self._loaded = loaded
        lines: Sequence[str] = loaded.source.lines if loaded.source else _NO_LINES
        self.listing.show_source(lines, {d.line: d.message for d in loaded.errors if d.line})
        self.path.show_picture(loaded.picture)

    def _show_bars(self, snapshot: Snapshot, view: View, loaded: Loaded) -> None:
        desk = self.desk
        name = view.program or loaded.name
        self.title.show_state(name, view.state, view.tone, desk.machine, desk.time_of_day())
        text = desk.prompt(snapshot, loaded)
        self.prompt.show_text(text, answer=bool(desk.notice))
        self.comment.show_text(view.comment)

    def _times(self, snapshot: Snapshot, view: View, loaded: Loaded) -> tuple[tuple[str, str], ...]:
        left = formats.duration(self.desk.time_left(snapshot, loaded))
        return (("PARTS", view.parts), ("CYCLE", view.cycle), ("LEFT", left), ("LAST", view.last_cycle))

    def _lamps(self, snapshot: Snapshot, view: View) -> tuple[Lamp, ...]:
        on = snapshot.state not in {State.ESTOP, State.DISABLED}
        return (*view.modes, *view.lamps, Lamp("DRIVES ON", on, "D"), Lamp("RESET", False, "R"))

    def _show_path(self, snapshot: Snapshot) -> None:
        modal = snapshot.modal
        x, z, _c = snapshot.actual
        self.path.show_tip(Tip(snapshot.block, z - modal.tool_z, x - modal.tool_x, modal.metric))
        self.path.advance()

    def doings(self) -> dict[str, Callable[[], None]]:
        """What the page itself does, by key."""
        return {
            "F2": self.ask_file,
            "F4": self.desk.next_readout,
            "F5": self.path.fit,
            "F7": self.toggle_log,
            "Zoom in": partial(self.path.zoom, 1),
            "Zoom out": partial(self.path.zoom, -1),
            "Pan left": partial(self.path.pan, -1, 0),
            "Pan right": partial(self.path.pan, 1, 0),
            "Pan up": partial(self.path.pan, 0, -1),
            "Pan down": partial(self.path.pan, 0, 1),
            "Page up": lambda: self.listing.look_at(-self.listing.rows),
            "Page down": lambda: self.listing.look_at(self.listing.rows),
            "Follow": self.listing.follow,
        }

    def ask_file(self) -> None:
        """``FILE TO BE PROCESSED``, unless a program is under way."""
        if self.desk.may_choose():
            self.log.hide()
            self.files.ask()

    def toggle_log(self) -> None:
        """The log of alarms over the path view, or away again."""
        self.log.setVisible(not self.log.isVisible())
        self.log.raise_()

    def escape(self) -> bool:
        """Close what lies over the page; False when nothing did."""
        if self.log.isVisible():
            self.log.hide()
            return True
        return False


def _stand(part: QWidget, rect: Rect) -> None:
    part.setGeometry(*rect)
    part.update()
