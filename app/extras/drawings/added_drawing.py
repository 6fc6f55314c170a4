"""The form of a drawing in the list of shapes: read and planned beside the screen, then tried by a proof."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from app.desk.background_work import Latest, Watch
from app.desk.pages.sheet import Key
from app.desk.translation import tr
from app.extras.drawings.drawing_form import PROFILE, DrawingForm
from app.extras.drawings.drawing_plan import Plan, Planner
from app.extras.shapes.added_form import AddedForm, Show
from app.extras.shapes.shape_form import ShapeForm
from core.extras.drawings.drawing_file import is_drawing
from core.extras.drawings.drawing_process import read_in_process
from core.extras.drawings.part_against_drawing import Comparison
from core.extras.shapes.shape_setting import Setting
from core.message import Message

Attempt = Callable[[str, Plan, Watch], tuple[Comparison | None, tuple[str, ...]]]
"""A program that was made of a drawing is proved, and its part held against it."""


def nothing_tried(_text: str, _plan: Plan, _watch: Watch) -> tuple[Comparison | None, tuple[str, ...]]:
    """Of a desk that knows no machine."""
    return None, ()


class AddedDrawing(AddedForm):
    """``files`` returns the drawings beside the programs; ``attempt`` tries a program that was made."""

    key, shape = "X", PROFILE

    def __init__(self, files: Callable[[], Mapping[str, Path]], attempt: Attempt = nothing_tried) -> None:
        self.files, self.attempt = files, attempt
        self.planner = Planner(read_in_process)
        self.planning, self.trying = Latest("planning-drawing"), Latest("trying-drawing")

    def open_form(self, setting: Setting, before: tuple[str, ...], wanted: Path | None) -> DrawingForm:
        """With the drawings beside the programs, that which was asked for first."""
        files = dict(self.files())
        if wanted is not None:
            files = {wanted.name: wanted, **{name: path for name, path in files.items() if path != wanted}}
        return DrawingForm(PROFILE, setting, files=files, before=before)

    def makes_of(self, name: str) -> bool:
        """Of a drawing."""
        return is_drawing(name)

    def work(self, form: ShapeForm, show: Show, tell: Callable[[str], None]) -> None:
        """What was typed is worked out beside the screen; then the program is tried."""
        if not isinstance(form, DrawingForm) or form.pending is None:
            return
        asked = form.pending

        def planned(plan: Plan) -> None:
            if form.pending == asked:
                form.take(plan)
                self._try(form, plan, show(form), failed)

        def failed(why: str) -> None:
            tell(tr(Message("THE DRAWING CANNOT BE PROCESSED: {why}", why=why)))

        self.trying.give_up()
        self.planning.ask(lambda watch: self.planner.plan(asked, watch), planned, failed)

    def _try(self, form: DrawingForm, plan: Plan, text: str | None, failed: Callable[[str], None]) -> None:
        """``text`` is the program with what the form writes; None where the form is no longer open."""
        if not form.lines or text is None:
            return

        def tried(found: tuple[Comparison | None, tuple[str, ...]]) -> None:
            if form.plan is plan:
                form.tried(*found)

        self.trying.ask(lambda watch: self.attempt(text, plan, watch), tried, failed)

    def cancel(self, form: ShapeForm) -> None:
        """Cancel the reading of a drawing (F6 or Esc) by ending its process."""
        if isinstance(form, DrawingForm):
            self.planning.give_up()
            form.cancel()

    def keys(self, form: ShapeForm, show: Show) -> Mapping[int, Key]:
        """F6 cancels the reading, and begins it again."""

        def read_again() -> None:
            form.work()
            show(form)

        if form.waits:
            return {6: Key("CANCEL", lambda: self.cancel(form))}
        return {6: Key("READ", read_again)} if isinstance(form, DrawingForm) and form.canceled else {}

    def prompt(self, form: ShapeForm) -> str:
        """How far the reading is, what is wrong, or what the keys do."""
        if not form.waits:
            keys = tr("LEFT/RIGHT: CHANGE   TAP DRAWING: PICK CONTOUR OR AXIS")
            return tr(form.trouble or keys)
        if not self.planner.reading:
            return tr("CALCULATING THE CONTOUR. PRESS F6 TO CANCEL")
        words = tr("READING THE DRAWING: {seconds} s. PRESS F6 TO CANCEL")
        return tr(Message(words, seconds=self.planning.reached))

    def poll(self) -> None:
        """Take up what was planned and tried."""
        self.planning.poll()
        self.trying.poll()

    def close(self) -> None:
        """End both workers."""
        self.planning.close()
        self.trying.close()
