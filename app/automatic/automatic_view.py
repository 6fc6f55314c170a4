"""The Automatic page: program window, comment, path view, and the prompt for a file."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.page_entry import editor_barred, program_barred, searchto_barred
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.status.prompt_line import MOVING, NONE_NAMED, UNDER_WAY
from app.path.measuring import measuring_words
from app.path.part_player import player_of
from app.path.path_aspects import tip_of
from app.path.path_view import PathView
from app.programs.file_prompt_view import FilePrompt
from app.screen import page_table
from app.screen.page_base import Host, KeyActions, Page
from app.screen.program_listing import Listing
from app.screen.window.window_bars import CommentLine
from app.screen.window_layout import Rect, work_parts
from app.working_plane.plane_instant import plane_words, running
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot, State

_NO_LINES: tuple[str, ...] = ()


class AutomaticPage(Page):
    """The Automatic page. Each part redraws only after a change. ``Frame`` shows the large readouts above."""

    NAME = page_table.AUTOMATIC
    LABELS = (
        "MENU",
        "FILE",
        "EDIT",
        "READOUT",
        "FIT",
        "SEARCHTO",
        "ALARMS",
        "TOOLS",
        "SECCMP",
        "SPECIAL",
    )
    STARTS = True

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent)
        look, desk = host.look, host.desk
        self._loaded = Loaded()
        self._moving = False
        self.listing = Listing(look, self)
        self.comment = CommentLine(look, self)
        self.path = PathView(look, self, player=player_of(desk))
        self.path.stock = self._stock
        self.space = WorkingPlaneView(look, self)  # Replaces the path view on a mill.
        self.files = FilePrompt(look, desk.programs.folders, desk.programs.choose, self._files_closed, self)

    def dress(self) -> None:
        """Redraw all parts in the present colors."""
        self.files.dress()
        self.path.restart()

    def _files_closed(self) -> None:
        self.window().setFocus()

    def leave(self) -> bool:
        """Close the prompt for a file, and let the page close."""
        self.files.dismiss()
        return True

    def prompt(self) -> str:
        """Return the prompt for choosing a file or measuring. Empty while the machine moves."""
        if self.files.isVisible() and not self._moving:
            return self.files.prompt()
        return measuring_words() if self.path.ruler is not None and not self._moving else ""

    def escape(self) -> bool:
        """End measuring. While the machine moves, leave Esc to feed hold and return False."""
        measuring = self.path.ruler is not None and not self._moving
        if measuring:
            self.path.measure(on=False)
        return measuring

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out all parts in the new unit."""
        listing, comment, path = work_parts(Rect(0, 0, self.width(), self.height()), self.look.u)
        for part, rect in (
            (self.listing, listing),
            (self.comment, comment),
            (self.path, path),
            (self.space, path),
            (self.files, path),
        ):
            part.setGeometry(*rect)
            part.update()

    def refresh(self, snapshot: Snapshot, view: MachineStatus, loaded: Loaded) -> None:
        """Show the program, its current line, its comment and its path."""
        if self.files.isVisible() and snapshot.state in {State.RUN, State.WAIT}:
            self.files.dismiss()  # A cycle was started at the station, so the keys belong to the cycle.
        self._moving = snapshot.state in MOVING
        if self.path.player is not None:
            self.path.player.bound = snapshot.state in UNDER_WAY
        self._show_program(loaded)
        self.comment.text = view.comment
        self.listing.show_run(view.line or snapshot.interrupted_line, view.block_text, view.next_text)
        self._show_path(snapshot, loaded)

    def _show_program(self, loaded: Loaded) -> None:
        if loaded is self._loaded:
            return
        self._loaded = loaded
        lines: Sequence[str] = loaded.source.lines if loaded.source else _NO_LINES
        self.listing.trouble = loaded.trouble
        self.listing.show_source(lines, {d.line: d.message for d in loaded.errors if d.line})
        scene = loaded.picture.scene if loaded.picture is not None else None
        self.space.show_scene(scene)
        self.space.setVisible(scene is not None)
        self.path.show_picture(loaded.picture if scene is None else None)

    def _show_path(self, snapshot: Snapshot, loaded: Loaded) -> None:
        scene = self.space.scene
        if scene is not None:
            self.space.show_instant(running(scene, snapshot), plane_words(snapshot.swivel))
            return
        self.path.show_tip(tip_of(snapshot, loaded.job))
        first_move = self.desk.first_move
        self.path.show_approach(first_move.legs(snapshot) if first_move is not None else None)
        self.path.advance()

    @property
    def _looked_at(self) -> PathView | WorkingPlaneView:
        """The view that the zoom and pan keys control."""
        return self.path if self.space.scene is None else self.space

    def lively(self) -> bool:
        """Return whether the animation of the part is playing."""
        return self.path.player is not None and self.path.player.playing

    def barred(self) -> frozenset[str]:
        """Return the disabled keys for choosing a program, the editor and SEARCHTO."""
        snapshot, loaded = self.desk.snapshot(), self.desk.session.now
        asking = self.files.isVisible()
        named = bool(self.files.wanted) if asking else loaded.path is not None
        found = {
            "F2": "" if asking else program_barred(snapshot),
            "F3": editor_barred(snapshot, named=named),
            "F6": searchto_barred(snapshot, loaded),
        }
        return frozenset(key for key, why in found.items() if why)

    def key_actions(self) -> KeyActions:
        """Return the key actions of this page."""
        looked_at = self._looked_at
        return {
            "F2": self.ask_file,
            "F3": self._edit,
            "F4": self.desk.next_readout,
            "F5": looked_at.fit,
            "F6": partial(self.host.go, page_table.SEARCHTO),
            "F8": partial(self.host.go, page_table.TOOLS),
            "F9": partial(self.host.go, page_table.SECCMP),
            "F10": partial(self.host.go, page_table.SPECIAL),
            "B": partial(self.host.go, page_table.PART),
            "Zoom in": partial(looked_at.zoom, 1),
            "Zoom out": partial(looked_at.zoom, -1),
            "Measure": self.path.measure,
            "View": looked_at.next_view,
            **self._part_keys(),
            "Pan left": partial(looked_at.pan, -1, 0),
            "Pan right": partial(looked_at.pan, 1, 0),
            "Pan up": partial(looked_at.pan, 0, -1),
            "Pan down": partial(looked_at.pan, 0, 1),
            "Page up": lambda: self.listing.scroll_by(-self.listing.rows),
            "Page down": lambda: self.listing.scroll_by(self.listing.rows),
            "Follow": self.listing.follow,
        }

    def _part_keys(self) -> KeyActions:
        """Return the keys of the playback, which work while the part is shown."""
        if self.path.player is None or not self.path.shows_part:
            return {}
        return {**self.path.play_keys(), "To line": self._part_to_line}

    def _part_to_line(self) -> None:
        """Show the part as it is before the first visible line of the program window."""
        if self.path.player is not None:
            self.path.player.to_line(self.listing.top + 1)

    def _stock(self) -> None:
        """Open the stock settings of the displayed part."""
        from app.part.part_sheet import PartSheet

        sheet = self.desk.pages.find(PartSheet)
        if sheet is not None and self.host.go(page_table.PART):
            sheet.show_stock()

    def _edit(self) -> None:
        """Open the editor for the loaded program, or for the name in the file prompt."""
        from app.editor.editor import Editor

        wanted = self.files.wanted if self.files.isVisible() else ""
        if self.files.isVisible() and not wanted:
            self.desk.say(NONE_NAMED)
        elif (editor := self.desk.pages.find(Editor)) is not None:
            editor.wanted = wanted
            self.host.go(page_table.EDITOR)

    def ask_file(self) -> None:
        """Show the prompt ``FILE TO BE PROCESSED``, or open the program list if it is already shown."""
        if self.files.isVisible():
            self.host.go(page_table.PROGRAMS)
        elif self.desk.programs.can_choose():
            self.host.clear_away()
            self.files.ask()
