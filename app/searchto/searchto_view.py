"""F6 SEARCHTO: a line, the state it inherits beside the one of now, the way there, and what will start."""

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
    """The question and the answer as far as it is typed."""

    ground = "panel"
    text = Shown("")

    def __init__(self, look: Look, press: Callable[[], None], parent: QWidget) -> None:
        """``press``: a finger on it."""
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


# --- what will start ----------------------------------------------------------------------------------


ROW = 2.7  # units
ACROSS = 40  # characters of a line of trouble


class StartsPanel(Panel):
    """``choices`` are told with their keys; ``trouble`` keeps it from starting, or has to be looked at."""

    starts: Shown[tuple[str, ...]] = Shown(())
    choices: Shown[tuple[str, ...]] = Shown(())
    trouble = Shown("")
    confirmed = Shown(False)

    def show_starts(
        self, starts: Sequence[str], choices: Sequence[str], trouble: str, confirmed: bool
    ) -> None:
        """The list of this instant."""
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


LIST, STATE, ASKED, STARTS = 0.26, 0.46, 4.6, 19.0  # shares of the width; units of height


class SearchtoPage(ModelPage):
    """Lines are chosen by arrows, numbers and texts."""

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
        self.starts = StartsPanel(self.look, self)
        self.space = WorkingPlaneView(self.look, self)  # takes the path's place where the machine is a mill
        self.pad = KeyPad(self.look, self.touched, own=None, parent=self)
        self.pad.hide()
        self._loaded: Loaded | None = None
        self._whole = False  # rows that are equal are shown too
        self._stood: tuple[object, int] = (None, 0)  # picture and blocks that the part was shown after

    def barred(self) -> frozenset[str]:
        """Return the keys of the model that would be refused now."""
        return self.model.barred_keys()

    def key_actions(self) -> KeyActions:
        """Keys of this page alone."""
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
        """Arrows choose a line, everything else is typed."""
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
        """A finger on the pad: Return and Esc take it away, so that the state is seen."""
        if key in {"Enter", "Esc"}:
            self.pad.hide()
        if key != "Esc":
            self.typed(key)

    def _turn_pad(self) -> None:
        self.pad.setVisible(self.pad.isHidden())
        self.pad.raise_()

    def _mark(self, line: int) -> None:
        """A finger on a line marks it, on the marked one rebuilds its state."""
        if not self.model.has_keyboard:
            return
        if line == self.model.cursor.line:
            self.model.search()
        else:
            self.model.move(line - self.model.cursor.line)

    def _turn_fold(self) -> None:
        self._whole = not self._whole

    def has_field(self) -> bool:
        """The question has it, but while the tool is on its way out."""
        return self.model.has_keyboard

    def prompt(self) -> str:
        """What can be done now."""
        return self.model.prompt(self.desk.snapshot(), self.desk.start_words)

    def opens(self) -> bool:
        """With a proved program, and none under way."""
        return self.model.opens()

    def leave(self) -> bool:
        """Cycle Start means programs again."""
        self.pad.hide()
        self.model.leave()
        return True

    def escape(self) -> bool:
        """One step back, and from the first one to the Automatic page."""
        if not self.model.escape():
            self.host.go(page_table.AUTOMATIC)
        return True

    def dress(self) -> None:
        """Other colours are in force."""
        self.path.restart()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, loaded: Loaded) -> None:
        """The line, its state, the way; a restart that has begun is followed on the Automatic page."""
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
        """Its path, or on a mill table and workpiece."""
        scene = loaded.picture.scene if loaded.picture is not None else None
        self.space.show_scene(scene)
        self.space.setVisible(scene is not None)
        self.path.show_picture(loaded.picture if scene is None else None)

    def _show_plane(self, scene: Scene, picture: Picture) -> None:
        """Axes and plane as the line finds them; drawn as done is what lies before it."""
        plan, line = self.model.plan, self.model.cursor.line
        here = at_line(scene, line - 1)
        axes, done = here.axes, picture.blocks_before(line)
        if plan is not None:
            axes, done = {**axes, **plan.axes}, plan.found.checkpoint.blocks
        self.space.show_instant(replace(here, axes=axes, block=done), plane_words(here.swivel))

    @property
    def _looked_at(self) -> PathView | WorkingPlaneView:
        """Which of the two the keys of looking around are for."""
        return self.path if self.space.scene is None else self.space

    def _tip(self, snapshot: Snapshot) -> Tip:
        """With a plan, the tip of the tool that the line works with: the way begins there."""
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
        """The part as the lines before leave it: of a line that was searched, in the pass that was found."""
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
        """Program, state, and the way over what will start."""
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
