"""The SEARCHTO page (F6): a line, its state, the path to it, and the functions that will start."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from textwrap import wrap
from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.path.part_player import player_of
from app.path.path_aspects import Tip, tip_of
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.entry_panel import KeyPad, draw_entry
from app.screen.look import Look, Painter
from app.screen.page_base import Host, KeyActions, ModelPage
from app.screen.panel import Panel, Shown
from app.screen.program_listing import Listing
from app.screen.window_layout import FINGER
from app.searchto.searchto_model import SearchtoModel, SearchtoStage
from app.searchto.searchto_plan import Plan, WayOut
from app.searchto.searchto_state_view import (
    FOLD,
    PASS_AFTER,
    PASS_BEFORE,
    NearestGood,
    StatePanel,
    StateShown,
)
from app.working_plane.plane_instant import at_line, plane_words
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages

if TYPE_CHECKING:
    from app.path.path_picture import Picture
    from app.working_plane.plane_scene import Scene

# --- line or text -------------------------------------------------------------------------------------


class SearchEntryPanel(Panel):
    """The question for a line or text, with the entered text."""

    ground = "panel"
    text = Shown("")

    def __init__(self, look: Look, press: Callable[[], None], parent: QWidget) -> None:
        """Create the panel. ``press`` is called for a touch."""
        super().__init__(look, parent)
        self._press = press

    def draw(self, painter: Painter) -> None:
        self.place(self.area(), self._press)
        u = self.look.u
        room = self.area().adjusted(1.2 * u, 0.4 * u, -0.8 * u, -0.4 * u)
        question = tr("LINE OR TEXT?")
        painter.write(QRectF(room.x(), room.y(), 14 * u, room.height()), question, 1.9, "text")
        box = room.adjusted(14.5 * u, 0, 0, 0)
        painter.box(box, "accent", 0.2, "ground")
        draw_entry(painter, box.adjusted(0.8 * u, 0, -0.8 * u, 0), self.text)


# --- functions that start -----------------------------------------------------------------------------


ROW = 2.7  # Units.
ACROSS = 40  # Characters of one line of a warning.


class StartsPanel(Panel):
    """The functions that will start.

    ``choices`` are options with their keys. ``trouble`` is a warning, or the reason why the restart cannot
    start.
    """

    starts: Shown[tuple[str, ...]] = Shown(())
    choices: Shown[tuple[str, ...]] = Shown(())
    trouble = Shown("")
    confirmed = Shown(False)

    def show_starts(
        self, starts: Sequence[str], choices: Sequence[str], trouble: str, confirmed: bool
    ) -> None:
        """Show these functions, options and warnings."""
        self.starts, self.choices = tuple(starts), tuple(choices)
        self.trouble, self.confirmed = trouble, confirmed

    def draw(self, painter: Painter) -> None:
        title = tr("CONFIRMED: READY FOR CYCLE START") if self.confirmed else tr("WILL START")
        self.frame(painter, title, "lit" if self.confirmed else "frame", 0.3 if self.confirmed else 0.16)
        u, room = self.look.u, self.inside()
        lines = [(text, "text", True) for text in self.starts]
        lines += [(text, "soft", False) for choice in self.choices for text in wrap(choice, ACROSS)]
        lines += [(text, "alarm", True) for text in wrap(self.trouble, ACROSS)]
        high = min(ROW * u, room.height() / max(1, len(lines)))
        for number, (text, colour, bold) in enumerate(lines):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            painter.write(row, text, min(1.9, high / u * 0.75), colour, bold=bold)


LIST, STATE, ASKED, STARTS = 0.26, 0.46, 4.6, 19.0  # Fractions of the width; units of height.


class SearchtoPage(ModelPage):
    """The SEARCHTO page. Lines are chosen by arrow keys, numbers or texts."""

    NAME = page_table.SEARCHTO
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
    STARTS = True
    model: SearchtoModel

    def __init__(self, host: Host, model: SearchtoModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self.asked = SearchEntryPanel(self.look, self._turn_pad, self)
        self.listing = Listing(self.look, self)
        self.listing.touched = self._mark
        self.state = StatePanel(self.look, host.press, self)
        self.path = PathView(self.look, self, player=player_of(host.desk))
        self.path.shows_whole_approach = True
        self.starts = StartsPanel(self.look, self)
        self.space = WorkingPlaneView(self.look, self)  # Replaces the path view on a mill.
        self.pad = KeyPad(self.look, self.touched, own=None, parent=self)
        self.pad.hide()
        self._loaded: Loaded | None = None
        self._whole = False  # Equal rows are shown, too.
        self._stood: tuple[object, int] = (None, 0)  # Path and block after which the part was last shown.

    def barred(self) -> frozenset[str]:
        """Return the function keys that are disabled now."""
        return self.model.barred_keys()

    def key_actions(self) -> KeyActions:
        """Return the key actions of this page."""
        model = self.model
        return {
            "F2": partial(model.find, 1),
            "F3": partial(model.find, -1),
            "F4": model.way_out,
            "F5": model.turn_coolant,
            "F6": model.search,
            "F8": partial(model.nearest, -1),
            "F9": partial(model.nearest, 1),
            "F10": model.confirm,
            FOLD: self._turn_fold,
            PASS_BEFORE: partial(model.turn_pass, -1),
            PASS_AFTER: partial(model.turn_pass, 1),
            "Zoom in": partial(self._looked_at.zoom, 1),
            "Zoom out": partial(self._looked_at.zoom, -1),
        }

    def typed(self, key: str) -> bool:
        """Handle a key. Arrow keys select a line, and other keys are text input."""
        if not self.model.has_keyboard:
            return False
        steps = {"Up": -1, "Down": 1, "Page up": -self.listing.rows, "Page down": self.listing.rows}
        if key in steps:
            self.model.move(steps[key])
            return True
        if key == "Tab":
            self._turn_fold()
            return True
        if key in {"Left", "Right"}:
            self.model.turn_pass(-1 if key == "Left" else 1)
            return True
        if key == "Enter":
            self.model.enter()
            return True
        return self.model.typed(key)

    def touched(self, key: str) -> None:
        """Handle a touch on the number pad. Enter and Esc also hide the pad, so that the state is visible."""
        if key in {"Enter", "Esc"}:
            self.pad.hide()
        if key != "Esc":
            self.typed(key)

    def _turn_pad(self) -> None:
        self.pad.setVisible(self.pad.isHidden())
        self.pad.raise_()

    def _mark(self, line: int) -> None:
        """Select a touched line, or rebuild its state if the line is already selected."""
        if not self.model.has_keyboard:
            return
        if line == self.model.cursor.line:
            self.model.search()
        else:
            self.model.move(line - self.model.cursor.line)

    def _turn_fold(self) -> None:
        self._whole = not self._whole

    def has_field(self) -> bool:
        """Return whether the entry accepts text, which is so except while the tool retracts."""
        return self.model.has_keyboard

    def prompt(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt(self.desk.snapshot(), self.desk.start_words)

    def opens(self) -> bool:
        """Return whether the page can be opened, which needs a proved program that is not running."""
        return self.model.opens()

    def leave(self) -> bool:
        """Let Cycle Start run programs again, and let the page close."""
        self.pad.hide()
        self.model.leave()
        return True

    def escape(self) -> bool:
        """Go one step back, or from the first step to the Automatic page."""
        if not self.model.escape():
            self.host.go(page_table.AUTOMATIC)
        return True

    def dress(self) -> None:
        """Redraw the path in the present colors."""
        self.path.restart()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, loaded: Loaded) -> None:
        """Show the line, its state and the path. After a restart has started, open the Automatic page."""
        model = self.model
        model.look(snapshot, loaded)
        if model.started:
            self.host.go(page_table.AUTOMATIC)
            return
        if loaded is not self._loaded:
            self._loaded = loaded
            self.listing.show_source(model.cursor.lines, {})
            self._show_program(loaded)
        self.asked.text = model.cursor.text
        self.listing.show_run(model.cursor.line, "", "")
        self.state.shown = self._shown()
        self._show_plan()
        if self.space.scene is not None and loaded.picture is not None:
            self._show_plane(self.space.scene, loaded.picture)
            return
        self._show_stock(loaded)
        self.path.show_tip(self._tip(snapshot))
        self.path.advance()

    def _show_program(self, loaded: Loaded) -> None:
        """Show the path of the program, or on a mill the table and workpiece."""
        scene = loaded.picture.scene if loaded.picture is not None else None
        self.space.show_scene(scene)
        self.space.setVisible(scene is not None)
        self.path.show_picture(loaded.picture if scene is None else None)

    def _show_plane(self, scene: Scene, picture: Picture) -> None:
        """Show axes and plane at the beginning of the line, with the earlier blocks drawn as done."""
        plan, line = self.model.plan, self.model.cursor.line
        here = at_line(scene, line - 1)
        axes, done = here.axes, picture.blocks_before(line)
        if plan is not None:
            axes, done = {**axes, **plan.axes}, plan.found.checkpoint.blocks
        self.space.show_instant(replace(here, axes=axes, block=done), plane_words(here.swivel))

    @property
    def _looked_at(self) -> PathView | WorkingPlaneView:
        """The view that the zoom keys control."""
        return self.path if self.space.scene is None else self.space

    def _tip(self, snapshot: Snapshot) -> Tip:
        """Return the tool tip. With a plan, this is the tip of the line's tool, where the path begins."""
        shown = self.model.leaving or self.model.plan
        legs = shown.legs if shown is not None else ()
        return Tip(0, legs[0].z, legs[0].x) if legs else tip_of(snapshot)._replace(block=0)

    def _shown(self) -> StateShown:
        model, line = self.model, self.model.cursor.line
        answer, plan = model.answer, model.plan
        if answer is not None:
            title = tr(Message("CANNOT START FROM LINE {line}", line=answer.line))
            near = (("F8", tr("PREVIOUS VALID"), answer.before), ("F9", tr("NEXT VALID"), answer.after))
            return StateShown(title, (), answer.why, tuple(self._near(*each) for each in near))
        if plan is not None:
            return self._state(plan)
        if model.leaving is not None:
            return StateShown(tr("RETRACT PATH"), (), model.leaving.trouble)
        if model.stage is SearchtoStage.SEARCHING:
            words = tr(Message("SEARCHING UP TO LINE {line}", line=line))
            return StateShown(join_messages("  ·  ", (words, str(model.finder.worker.reached))))
        return StateShown(tr(Message("ENTER OR TAP: REBUILD STATE AT LINE {line}", line=line)))

    def _state(self, plan: Plan) -> StateShown:
        title, visit = tr(Message("STATE AT LINE {line}", line=plan.found.line)), plan.found.visit
        if visit.of < 2:
            return StateShown(title, plan.rows, whole=self._whole)
        words = tr(Message("REPETITION {number} OF {count}", number=visit.number, count=visit.of))
        return StateShown(f"{title}, {words}", plan.rows, passes=words, whole=self._whole)

    def _near(self, key: str, label: str, line: int) -> NearestGood:
        if not line:
            return NearestGood(key, tr(Message("{which}: NONE", which=label)), 0, "")
        words = tr(Message("{which}: LINE {line}", which=label, line=line))
        return NearestGood(key, words, line, self.model.cursor.lines[line - 1].strip())

    def _show_plan(self) -> None:
        model, plan = self.model, self.model.plan
        if model.leaving is not None:
            self._show_leaving(model.leaving)
            return
        if plan is None:
            self.path.show_approach(None)
            self.starts.show_starts((), (), "", confirmed=False)
            return
        self.path.show_approach(plan.legs)
        choices: list[str] = []
        if plan.found.checkpoint.modal.coolant:
            choices.append(
                tr("COOLANT WILL START. F5: CHANGE")
                if model.choices.coolant
                else tr("COOLANT WILL NOT START. F5: START COOLANT TOO")
            )
        if plan.way:
            choices.append(tr(Message("PATH: {legs}", legs=", ".join(plan.way))))
        trouble = plan.trouble or plan.warning
        starts = plan.starts or (tr("AXES ONLY"),)
        self.starts.show_starts(starts, choices, trouble, confirmed=model.stage is SearchtoStage.READY)

    def _show_stock(self, loaded: Loaded) -> None:
        """Show the part as the earlier lines leave it, in the pass that was found."""
        plan, picture, player = self.model.plan, loaded.picture, self.path.player
        if picture is None or player is None:
            return
        line = self.model.cursor.line
        done = plan.found.checkpoint.blocks if plan is not None else picture.blocks_before(line)
        if (picture, done) != self._stood:
            self._stood = picture, done
            player.to_block(done)

    def _show_leaving(self, leaving: WayOut) -> None:
        self.path.show_approach(leaving.legs)
        told = tr(Message("RETRACT FROM PART AT {feed}", feed=leaving.feed))
        choices = () if leaving.trouble else (told, tr("H: FEED HOLD DURING RETRACT"))
        ready = self.model.stage is SearchtoStage.READY
        only = () if leaving.trouble else (tr("AXES ONLY"),)
        self.starts.show_starts(only, choices, leaving.trouble, confirmed=ready)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out the program, the state, and the path above the functions that start."""
        u = self.look.u
        gap, asked, starts = max(4, round(0.7 * u)), max(FINGER, round(ASKED * u)), round(STARTS * u)
        wide, high = self.width(), self.height()
        left, state = round(LIST * wide), round(STATE * wide)
        right = left + gap + state + gap
        self.asked.setGeometry(0, 0, left, asked)
        self.listing.setGeometry(0, asked + gap, left, high - asked - gap)
        self.state.setGeometry(left + gap, 0, state, high)
        self.pad.setGeometry(left + gap, 0, state, high)
        for part in (self.path, self.space):
            part.setGeometry(right, 0, wide - right, high - starts - gap)
        self.starts.setGeometry(right, high - starts, wide - right, starts)
