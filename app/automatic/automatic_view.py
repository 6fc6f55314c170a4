"""Automatic page with the program window, comment line, path view and file prompt."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum, auto
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.code_help import make_code_blocks
from app.desk.pages.guide_text import GuideBlock
from app.desk.pages.page_entry import find_editor_refusal, find_program_refusal, find_restart_refusal
from app.desk.pages.table_content import WHOLE_LIST
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.status.prompt_line import ACTIVE_STATES, MOVING_STATES, NO_NAME_TYPED
from app.desk.translation import tr
from app.path.measuring import make_measuring_prompt
from app.path.part_player import make_part_player
from app.path.path_aspects import find_tip_position
from app.path.path_view import PathView
from app.programs.file_prompt_view import FilePrompt
from app.screen import page_table
from app.screen.page_base import KeyActions, Page, PageHost
from app.screen.program_listing import ProgramListing
from app.screen.window.key_table import RELOAD_KEY
from app.screen.window.window_bars import CommentLine
from app.screen.window_layout import Rect, divide_work_area
from app.working_plane.plane_instant import describe_plane, make_instant_from_snapshot
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.dialects import get_code_book

_NO_LINES: tuple[str, ...] = ()
FULL_VIEW_KEY, HALF_VIEW_KEY = "W", "Shift+W"


class ViewSize(Enum):
    """Size of the path view on the Automatic page.

    ``HALF`` is about half of the window, next to the program. ``FULL`` is the whole page.
    """

    NORMAL = auto()
    HALF = auto()
    FULL = auto()


class AutomaticPage(Page):
    """Page for automatic operation. Each view on the page is redrawn only when its content changes.

    ``Frame`` shows the large readouts above the page.
    """

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
    CAN_START_CYCLES = True

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent)
        look, desk = host.theme, host.desk
        self._loaded = LoadedProgram()
        self._moving = self._is_notice_shown = False
        self.program_listing = ProgramListing(look, self)
        self.comment_line = CommentLine(look, self)
        self.path_view = PathView(look, self, part_player=make_part_player(desk))
        self.path_view.open_stock = self._open_stock
        self.path_view.enlarge = self._select_next_size
        self._view_size = ViewSize.NORMAL
        self.plane_view = WorkingPlaneView(look, self)  # Replaces the path view on a mill.
        self.file_prompt = FilePrompt(
            look,
            desk.program_choice.program_folders,
            desk.program_choice.load_by_name,
            self._files_closed,
            self,
        )

    def apply_theme(self) -> None:
        """Redraw all views of the page in the colors of the current theme."""
        self.file_prompt.apply_theme()
        self.path_view.redraw()

    def _files_closed(self) -> None:
        self.window().setFocus()

    def try_leave_page(self) -> bool:
        """Close the file prompt and return True, because the operator can always leave this page."""
        self.file_prompt.close_prompt()
        return True

    def prompt_text(self) -> str:
        """Return the text of the open file prompt or of measuring; it is empty if neither is active.

        During motion, the text is always empty.
        """
        if self.file_prompt.isVisible() and not self._moving:
            return self.file_prompt.prompt_text()
        return make_measuring_prompt() if self.path_view.measurement is not None and not self._moving else ""

    def handle_escape(self) -> bool:
        """End measuring in the path view or its enlargement, and return whether one of them was active.

        During motion, return False, so that Esc triggers a feed hold.
        """
        if self._moving:
            return False
        measuring = self.path_view.measurement is not None
        enlarged = self.has_enlarged_view and not measuring
        if measuring:
            self.path_view.switch_measuring(is_on=False)
        if enlarged:
            self.set_view_size(ViewSize.NORMAL)
        return measuring or enlarged

    def set_view_size(self, size: ViewSize) -> None:
        """Change the size of the path view; the same size again restores the normal size."""
        self._view_size = ViewSize.NORMAL if size is self._view_size else size
        self.has_enlarged_view = self._view_size is not ViewSize.NORMAL
        self._place_views()

    def _select_next_size(self) -> None:
        sizes = list(ViewSize)
        self.set_view_size(sizes[(sizes.index(self._view_size) + 1) % len(sizes)])

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Rearrange all views of the page after the page is resized."""
        self._place_views()

    def _place_views(self) -> None:
        page = Rect(0, 0, self.width(), self.height())
        listing, comment, path = divide_work_area(page, self.theme.unit_px)
        is_full = self._view_size is ViewSize.FULL
        path = page if is_full else path
        self.program_listing.setHidden(is_full)
        self.comment_line.setHidden(is_full)
        for part, rect in (
            (self.program_listing, listing),
            (self.comment_line, comment),
            (self.path_view, path),
            (self.plane_view, path),
            (self.file_prompt, path),
        ):
            part.setGeometry(*rect)
            part.update()

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Show the program with its current line, comment and path."""
        self._is_notice_shown = bool(status.message or status.alarms)
        is_running = snapshot.state in {MachineState.RUN, MachineState.WAIT}
        if self.file_prompt.isVisible() and (is_running or self._is_notice_shown):
            # The keys belong to a cycle that was started at the station, or a notice covers the prompt.
            self.file_prompt.close_prompt()
        self._moving = snapshot.state in MOVING_STATES
        if self.path_view.part_player is not None:
            self.path_view.part_player.follows_run = snapshot.state in ACTIVE_STATES
        self._show_program(loaded)
        self.comment_line.text = status.comment
        self.program_listing.show_run_position(
            status.line_number or snapshot.interrupted_line, status.block_text, status.next_block_text
        )
        self._show_path(snapshot, loaded)

    def _show_program(self, loaded: LoadedProgram) -> None:
        if loaded is self._loaded:
            return
        self._loaded = loaded
        self.path_view.is_loading = loaded.is_busy
        lines: Sequence[str] = loaded.source.lines if loaded.source else _NO_LINES
        self.program_listing.error_text = loaded.error_text
        self.program_listing.show_source(lines, {d.line: d.message for d in loaded.blocking_errors if d.line})
        scene = loaded.picture.mill_scene if loaded.picture is not None else None
        self.plane_view.show_scene(scene)
        self.plane_view.setVisible(scene is not None)
        self.path_view.show_picture(loaded.picture if scene is None else None)

    def _show_path(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        scene = self.plane_view.scene
        if scene is not None:
            self.plane_view.show_instant(
                make_instant_from_snapshot(scene, snapshot), describe_plane(snapshot.swivel)
            )
            return
        self.path_view.show_tool_tip(find_tip_position(snapshot, loaded.job))
        first_move = self.desk.start_watch
        self.path_view.show_approach(first_move.make_start_legs(snapshot) if first_move is not None else None)
        self.path_view.continue_drawing()

    @property
    def _visible_view(self) -> PathView | WorkingPlaneView:
        """Return the view that the zoom and pan keys control."""
        return self.path_view if self.plane_view.scene is None else self.plane_view

    def find_marked_help(self) -> Sequence[GuideBlock]:
        """Return the explanation of the codes in the current line of the program."""
        source, line = self._loaded.source, self.program_listing.active_line
        if source is None or not 0 < line <= len(source.lines):
            return ()
        book = get_code_book(source.dialect)
        return make_code_blocks(book, book.list_codes(source.lines[line - 1]))

    def is_animating(self) -> bool:
        """Return whether the animation of the part is playing."""
        return self.path_view.part_player is not None and self.path_view.part_player.is_playing

    def find_disabled_keys(self) -> frozenset[str]:
        """Return those of the keys for program choice, editor and SEARCHTO that are currently disabled."""
        snapshot, loaded = self.desk.read_snapshot(), self.desk.program_loader.loaded_program
        asking = self.file_prompt.isVisible()
        named = bool(self.file_prompt.requested_name) if asking else loaded.path is not None
        found = {
            "F2": "" if asking else find_program_refusal(snapshot),
            "F3": find_editor_refusal(snapshot, has_name=named),
            "F6": find_restart_refusal(snapshot, loaded),
        }
        return frozenset(key for key, why in found.items() if why)

    def make_key_actions(self) -> KeyActions:
        """Return the key actions of this page."""
        looked_at = self._visible_view
        return {
            "F2": self.show_file_prompt,
            RELOAD_KEY: self._reload_program,
            "F3": self._open_editor,
            "F4": self.desk.select_next_readout,
            "F5": looked_at.fit_all_panes,
            "F6": partial(self.host.open_page, page_table.SEARCHTO_PAGE),
            "F8": partial(self.host.open_page, page_table.TOOLS),
            "F9": partial(self.host.open_page, page_table.SECCMP),
            "F10": partial(self.host.open_page, page_table.SPECIAL),
            "B": partial(self.host.open_page, page_table.PART),
            "Zoom in": partial(looked_at.zoom_view, 1),
            "Zoom out": partial(looked_at.zoom_view, -1),
            "Measure": self.path_view.switch_measuring,
            "View": looked_at.select_next_view,
            FULL_VIEW_KEY: partial(self.set_view_size, ViewSize.FULL),
            HALF_VIEW_KEY: partial(self.set_view_size, ViewSize.HALF),
            **self._part_keys(),
            "Pan left": partial(looked_at.pan_view, -1, 0),
            "Pan right": partial(looked_at.pan_view, 1, 0),
            "Pan up": partial(looked_at.pan_view, 0, -1),
            "Pan down": partial(looked_at.pan_view, 0, 1),
            "Page up": lambda: self.program_listing.scroll_by(-self.program_listing.rows),
            "Page down": lambda: self.program_listing.scroll_by(self.program_listing.rows),
            "End": lambda: self.program_listing.scroll_by(WHOLE_LIST),
            "Follow": self.program_listing.follow_run,
        }

    def _part_keys(self) -> KeyActions:
        """Return the key actions of the part animation, or no actions while the part is not shown."""
        if self.path_view.part_player is None or not self.path_view.is_part_shown:
            return {}
        return {**self.path_view.make_part_key_actions(), "To line": self._show_part_at_line}

    def _show_part_at_line(self) -> None:
        """Show the part as machined before the first visible line of the program window."""
        if self.path_view.part_player is not None:
            self.path_view.part_player.seek_line(self.program_listing.first_row + 1)

    def _open_stock(self) -> None:
        """Open the stock settings of the displayed part."""
        from app.part.part_model import PartPageModel

        sheet = self.desk.page_registry.find_model(PartPageModel)
        if sheet is not None and self.host.open_page(page_table.PART):
            sheet.show_stock_table()

    def _open_editor(self) -> None:
        """Open the editor for the loaded program, or for the file name in the prompt."""
        from app.editor.editor_model import EditorModel

        wanted = self.file_prompt.requested_name if self.file_prompt.isVisible() else ""
        if self.file_prompt.isVisible() and not wanted:
            self.desk.say(NO_NAME_TYPED)
        elif (editor := self.desk.page_registry.find_model(EditorModel)) is not None:
            editor.pending_name = wanted
            self.host.open_page(page_table.EDITOR)

    def _reload_program(self) -> None:
        """Load the changed file of the loaded program again, or show why this is impossible."""
        path, state = self.desk.program_loader.loaded_program.path, self.desk.storage_state
        if path is None or not state.can_reload_file():
            self.desk.say(state.describe_file_difference() or tr("THE PROGRAM FILE HAS NOT CHANGED"))
        elif self.desk.program_choice.can_choose_program():
            self.file_prompt.close_prompt()
            self.desk.program_choice.load_path(path)

    def show_file_prompt(self) -> None:
        """Show the prompt ``FILE TO BE PROCESSED``, or open the program list.

        The program list opens if the prompt is already shown, or if a notice would cover the prompt.
        """
        if self.file_prompt.isVisible():
            self.host.open_page(page_table.PROGRAMS)
        elif self.desk.program_choice.can_choose_program():
            self.host.close_alarm_log()
            if self._is_notice_shown:
                self.host.open_page(page_table.PROGRAMS)
            else:
                self.file_prompt.show_prompt()
