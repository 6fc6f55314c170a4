"""The SEARCHTO page (F6): a line, the machine state there, the path, and the started functions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from textwrap import wrap
from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.code_help import make_code_blocks
from app.desk.pages.guide_text import GuideBlock
from app.desk.pages.table_content import ROW_STEPS
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.path.part_player import make_part_player
from app.path.path_aspects import TipPosition, find_tip_position
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.entry_panel import NumberPad, draw_entry_text
from app.screen.page_base import KeyActions, ModelPage, PageHost
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.program_listing import ProgramListing
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX
from app.searchto.restart_plan import RestartPlan, RetractPlan
from app.searchto.searchto_model import RestartModel, RestartStage
from app.searchto.searchto_state_view import (
    FOLD_KEY,
    PASS_AFTER,
    PASS_BEFORE,
    NearestValidLine,
    RestartStatePanel,
    StatePanelContent,
)
from app.working_plane.plane_instant import describe_plane, make_instant_after_line
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot
from core.interpreter.dialects import get_code_book
from core.message import Message, join_messages

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture
    from app.working_plane.plane_scene import MillScene

# --- line or text -------------------------------------------------------------------------------------


class SearchEntryPanel(Panel):
    """Panel that prompts for a line number or a search text, and shows the entered text."""

    background_color = "panel"
    entry_text = RedrawingAttribute("")

    def __init__(self, theme: ScreenTheme, press: Callable[[], None], parent: QWidget) -> None:
        """Create the panel.

        ``press`` is the function that is called when the panel is touched.
        """
        super().__init__(theme, parent)
        self._press = press

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the question ``LINE OR TEXT?`` and the entered text."""
        self.add_target(self.find_full_area(), self._press)
        u = self.theme.unit_px
        room = self.find_full_area().adjusted(1.2 * u, 0.4 * u, -0.8 * u, -0.4 * u)
        question = tr("LINE OR TEXT?")
        painter.draw_text_line(QRectF(room.x(), room.y(), 14 * u, room.height()), question, 1.9, "text")
        box = room.adjusted(14.5 * u, 0, 0, 0)
        painter.draw_box(box, "accent", 0.2, "ground")
        draw_entry_text(painter, box.adjusted(0.8 * u, 0, -0.8 * u, 0), self.entry_text)


# --- functions that start -----------------------------------------------------------------------------


ROW_HEIGHT = 2.7  # Units.
WARNING_LINE_CHARS = 40  # Characters of one line of a warning.


class FunctionsToStartPanel(Panel):
    """Panel that lists the functions that a restart will turn on.

    ``option_texts`` are the options with their keys. ``error_text`` is a warning, or the reason why the
    restart cannot start.
    """

    functions_to_start: RedrawingAttribute[tuple[str, ...]] = RedrawingAttribute(())
    option_texts: RedrawingAttribute[tuple[str, ...]] = RedrawingAttribute(())
    error_text = RedrawingAttribute("")
    is_confirmed = RedrawingAttribute(False)

    def show_functions(
        self, functions: Sequence[str], options: Sequence[str], error_text: str, is_confirmed: bool
    ) -> None:
        """Show the functions that the restart turns on, the options, and the warning or error."""
        self.functions_to_start, self.option_texts = tuple(functions), tuple(options)
        self.error_text, self.is_confirmed = error_text, is_confirmed

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the functions that the restart will turn on, the options, and the error text.

        The frame is highlighted if the functions are confirmed.
        """
        title = tr("CONFIRMED: READY FOR CYCLE START") if self.is_confirmed else tr("WILL START")
        self.frame(
            painter, title, "lit" if self.is_confirmed else "frame", 0.3 if self.is_confirmed else 0.16
        )
        u, room = self.theme.unit_px, self.inside()
        lines = [(text, "text", True) for text in self.functions_to_start]
        lines += [
            (text, "soft", False) for choice in self.option_texts for text in wrap(choice, WARNING_LINE_CHARS)
        ]
        lines += [(text, "alarm", True) for text in wrap(self.error_text, WARNING_LINE_CHARS)]
        high = min(ROW_HEIGHT * u, room.height() / max(1, len(lines)))
        for number, (text, colour, bold) in enumerate(lines):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            painter.draw_text_line(row, text, min(1.9, high / u * 0.75), colour, bold=bold)


LIST, STATE, ASKED, STARTS = 0.26, 0.46, 4.6, 19.0  # Fractions of the width; units of height.


class RestartPage(ModelPage):
    """The SEARCHTO page, on which lines are chosen by arrow keys, numbers or texts."""

    NAME = page_table.SEARCHTO_PAGE
    LABELS = (
        "MENU",
        "NEXT",
        "PREVIOUS",
        "RETRACT",
        "COOLANT",
        "SEARCH",
        "ALARMS",
        "BEFORE",
        "AFTER",
        "CONFIRM",
    )
    CAN_START_CYCLES = True
    model: RestartModel

    def __init__(self, host: PageHost, model: RestartModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self.entry_panel = SearchEntryPanel(self.theme, self._turn_pad, self)
        self.program_listing = ProgramListing(self.theme, self)
        self.program_listing.on_line_touched = self._mark_line
        self.state_panel = RestartStatePanel(self.theme, host.press_key, self)
        self.path_view = PathView(self.theme, self, part_player=make_part_player(host.desk))
        self.path_view.shows_whole_approach = True
        self.functions_panel = FunctionsToStartPanel(self.theme, self)
        self.plane_view = WorkingPlaneView(self.theme, self)  # Replaces the path view on a mill.
        self.number_pad = NumberPad(self.theme, self.handle_touched_key, page_key=None, parent=self)
        self.number_pad.hide()
        self._loaded: LoadedProgram | None = None
        self._whole = False  # Equal rows are shown, too.
        self._stood: tuple[object, int] = (None, 0)  # Path and block after which the part was last shown.

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the function keys that are disabled now."""
        return self.model.find_disabled_keys()

    def make_key_actions(self) -> KeyActions:
        """Return the key actions of this page."""
        model = self.model
        return {
            "F2": partial(model.find_text, 1),
            "F3": partial(model.find_text, -1),
            "F4": model.plan_retract,
            "F5": model.toggle_coolant,
            "F6": model.rebuild_selected_line,
            "F8": partial(model.select_nearest_valid_line, -1),
            "F9": partial(model.select_nearest_valid_line, 1),
            "F10": model.confirm_plan,
            FOLD_KEY: self._turn_fold,
            PASS_BEFORE: partial(model.change_pass_number, -1),
            PASS_AFTER: partial(model.change_pass_number, 1),
            "Zoom in": partial(self._visible_view.zoom_view, 1),
            "Zoom out": partial(self._visible_view.zoom_view, -1),
        }

    def handle_key(self, key: str) -> bool:
        """Handle a key of the page.

        Arrow keys select a line, and other keys are text input.
        """
        if not self.model.can_choose_line:
            return False
        page = self.program_listing.rows
        steps = {**ROW_STEPS, "Page up": -page, "Page down": page}
        if key in steps:
            self.model.move_cursor(steps[key])
            return True
        if key == "Tab":
            self._turn_fold()
            return True
        if key in {"Left", "Right"}:
            self.model.change_pass_number(-1 if key == "Left" else 1)
            return True
        if key == "Enter":
            self.model.handle_enter()
            return True
        return self.model.handle_key(key)

    def handle_touched_key(self, key: str) -> None:
        """Handle a touch on the number pad.

        Enter and Esc also hide the pad, so that the machine state at the line is visible.
        """
        if key in {"Enter", "Esc"}:
            self.number_pad.hide()
        if key != "Esc":
            self.handle_key(key)

    def _turn_pad(self) -> None:
        self.number_pad.setVisible(self.number_pad.isHidden())
        self.number_pad.raise_()

    def _mark_line(self, line: int) -> None:
        """Select a touched line, or rebuild the machine state there if the line is already selected."""
        if not self.model.can_choose_line:
            return
        if line == self.model.line_cursor.selected_line:
            self.model.rebuild_selected_line()
        else:
            self.model.move_cursor(line - self.model.line_cursor.selected_line)

    def _turn_fold(self) -> None:
        self._whole = not self._whole

    def has_text_field(self) -> bool:
        """Return whether text can be entered. This is always possible unless the tool retracts."""
        return self.model.can_choose_line

    def find_marked_help(self) -> Sequence[GuideBlock]:
        """Return the explanation of the codes in the selected line."""
        source, line = self.desk.program_loader.loaded_program.source, self.model.line_cursor.selected_line
        if source is None or not 0 < line <= len(source.lines):
            return ()
        book = get_code_book(source.dialect)
        return make_code_blocks(book, book.list_codes(source.lines[line - 1]))

    def prompt_text(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt_text(self.desk.read_snapshot(), self.desk.start_instruction)

    def can_open(self) -> bool:
        """Return whether the page can be opened.

        It needs a proved program that is not running.
        """
        return self.model.can_open()

    def try_leave_page(self) -> bool:
        """Let Cycle Start run programs again, and allow the page to close."""
        self.number_pad.hide()
        self.model.on_close()
        return True

    def handle_escape(self) -> bool:
        """Go back one step, or open the Automatic page if there is no step to go back."""
        if not self.model.handle_escape():
            self.host.open_page(page_table.AUTOMATIC)
        return True

    def apply_theme(self) -> None:
        """Redraw the path in the current colors."""
        self.path_view.redraw()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, loaded: LoadedProgram) -> None:
        """Show the selected line, the machine state there, and the path.

        After a restart has started, open the Automatic page instead.
        """
        model = self.model
        model.update(snapshot, loaded)
        if model.has_restart_started:
            self.host.open_page(page_table.AUTOMATIC)
            return
        if loaded is not self._loaded:
            self._loaded = loaded
            self.program_listing.show_source(model.line_cursor.program_lines, {})
            self._show_program(loaded)
        self.entry_panel.entry_text = model.line_cursor.entry_text
        self.program_listing.show_run_position(model.line_cursor.selected_line, "", "")
        self.state_panel.content = self._shown()
        self._show_plan()
        if self.plane_view.scene is not None and loaded.picture is not None:
            self._show_plane(self.plane_view.scene, loaded.picture)
            return
        self._show_stock(loaded)
        self.path_view.show_tool_tip(self._find_tip(snapshot))
        self.path_view.continue_drawing()

    def _show_program(self, loaded: LoadedProgram) -> None:
        """Show the path of the program or, on a mill, the machine table and workpiece."""
        scene = loaded.picture.mill_scene if loaded.picture is not None else None
        self.plane_view.show_scene(scene)
        self.plane_view.setVisible(scene is not None)
        self.path_view.show_picture(loaded.picture if scene is None else None)

    def _show_plane(self, scene: MillScene, picture: ProgramPicture) -> None:
        """Show the axes and the working plane before the line, and earlier blocks as finished."""
        plan, line = self.model.restart_plan, self.model.line_cursor.selected_line
        here = make_instant_after_line(scene, line - 1)
        axes, done = here.axis_positions, picture.count_blocks_before_line(line)
        if plan is not None:
            axes, done = {**axes, **plan.axis_positions}, plan.restart_point.checkpoint.blocks
        self.plane_view.show_instant(
            replace(here, axis_positions=axes, active_block_number=done), describe_plane(here.plane_position)
        )

    @property
    def _visible_view(self) -> PathView | WorkingPlaneView:
        """Return the view that the zoom keys control."""
        return self.path_view if self.plane_view.scene is None else self.plane_view

    def _find_tip(self, snapshot: Snapshot) -> TipPosition:
        """Return the position at which the tool tip is displayed.

        If there is a plan, this is the start of the planned path, for the tool that is active at the line.
        """
        shown = self.model.retract_plan or self.model.restart_plan
        legs = shown.drawn_legs if shown is not None else ()
        return (
            TipPosition(0, legs[0].z, legs[0].x)
            if legs
            else find_tip_position(snapshot)._replace(active_block_number=0)
        )

    def _shown(self) -> StatePanelContent:
        model, line = self.model, self.model.line_cursor.selected_line
        answer, plan = model.restart_refusal, model.restart_plan
        if answer is not None:
            title = tr(Message("CANNOT START FROM LINE {line}", line=answer.line_number))
            near = (
                ("F8", tr("PREVIOUS VALID"), answer.nearest_line_before),
                ("F9", tr("NEXT VALID"), answer.nearest_line_after),
            )
            return StatePanelContent(title, (), answer.why, tuple(self._near(*each) for each in near))
        if plan is not None:
            return self._state(plan)
        if model.retract_plan is not None:
            return StatePanelContent(tr("RETRACT PATH"), (), model.retract_plan.error_text)
        if model.stage is RestartStage.SEARCHING:
            words = tr(Message("SEARCHING UP TO LINE {line}", line=line))
            return StatePanelContent(
                join_messages("  ·  ", (words, str(model.restart_finder.worker.progress_count)))
            )
        return StatePanelContent(tr(Message("ENTER OR TAP: REBUILD STATE AT LINE {line}", line=line)))

    def _state(self, plan: RestartPlan) -> StatePanelContent:
        title, visit = (
            tr(Message("STATE AT LINE {line}", line=plan.restart_point.line_number)),
            plan.restart_point.visit,
        )
        if visit.visit_count < 2:
            return StatePanelContent(title, plan.state_rows, shows_all_rows=self._whole)
        words = tr(
            Message("REPETITION {number} OF {count}", number=visit.visit_number, count=visit.visit_count)
        )
        return StatePanelContent(
            f"{title}, {words}", plan.state_rows, pass_text=words, shows_all_rows=self._whole
        )

    def _near(self, key: str, label: str, line: int) -> NearestValidLine:
        if not line:
            return NearestValidLine(key, tr(Message("{which}: NONE", which=label)), 0, "")
        words = tr(Message("{which}: LINE {line}", which=label, line=line))
        return NearestValidLine(key, words, line, self.model.line_cursor.program_lines[line - 1].strip())

    def _show_plan(self) -> None:
        model, plan = self.model, self.model.restart_plan
        if model.retract_plan is not None:
            self._show_leaving(model.retract_plan)
            return
        if plan is None:
            self.path_view.show_approach(None)
            self.functions_panel.show_functions((), (), "", is_confirmed=False)
            return
        self.path_view.show_approach(plan.drawn_legs)
        choices: list[str] = []
        if plan.restart_point.checkpoint.modal.coolant:
            choices.append(
                tr("COOLANT WILL START. F5: CHANGE")
                if model.restart_choices.uses_coolant
                else tr("COOLANT WILL NOT START. F5: START COOLANT TOO")
            )
        if plan.approach_texts:
            choices.append(tr(Message("PATH: {legs}", legs=", ".join(plan.approach_texts))))
        problem_text = plan.error_text or plan.warning_text
        starts = plan.functions_to_start or (tr("AXES ONLY"),)
        self.functions_panel.show_functions(
            starts, choices, problem_text, is_confirmed=model.stage is RestartStage.READY
        )

    def _show_stock(self, loaded: LoadedProgram) -> None:
        """Show the part as it is before the selected pass (execution) of the line."""
        plan, picture, player = self.model.restart_plan, loaded.picture, self.path_view.part_player
        if picture is None or player is None:
            return
        line = self.model.line_cursor.selected_line
        done = (
            plan.restart_point.checkpoint.blocks
            if plan is not None
            else picture.count_blocks_before_line(line)
        )
        if (picture, done) != self._stood:
            self._stood = picture, done
            player.seek_block(done)

    def _show_leaving(self, leaving: RetractPlan) -> None:
        self.path_view.show_approach(leaving.drawn_legs)
        retract_text = tr(Message("RETRACT FROM PART AT {feed}", feed=leaving.feed_text))
        choices = () if leaving.error_text else (retract_text, tr("H: FEED HOLD DURING RETRACT"))
        ready = self.model.stage is RestartStage.READY
        only = () if leaving.error_text else (tr("AXES ONLY"),)
        self.functions_panel.show_functions(only, choices, leaving.error_text, is_confirmed=ready)

    def needs_height(self) -> bool:
        """Return whether the number pad is shown."""
        return not self.number_pad.isHidden()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the program, the state, the path, and the list of functions that will start."""
        u = self.theme.unit_px
        gap, asked, starts = max(4, round(0.7 * u)), max(FINGERTIP_PX, round(ASKED * u)), round(STARTS * u)
        wide, high = self.width(), self.height()
        left, state = round(LIST * wide), round(STATE * wide)
        right = left + gap + state + gap
        self.entry_panel.setGeometry(0, 0, left, asked)
        self.program_listing.setGeometry(0, asked + gap, left, high - asked - gap)
        self.state_panel.setGeometry(left + gap, 0, state, high)
        self.number_pad.setGeometry(left + gap, 0, state, high)
        for part in (self.path_view, self.plane_view):
            part.setGeometry(right, 0, wide - right, high - starts - gap)
        self.functions_panel.setGeometry(right, high - starts, wide - right, starts)
