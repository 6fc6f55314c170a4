"""Form of a drawing (DXF, SVG): read, planned and tried on workers.

The form writes shapes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

from app.desk.background_work import Latest, Watch
from app.desk.pages.sheet import Key
from app.desk.translation import tr
from app.extras.drawings.drawing_plan import ALL, OWN, Asked, Plan, Planner, pictured
from app.extras.shapes.shape_form import AddedForm, ShapeForm, Show
from core.extras.drawings.drawing_file import is_drawing
from core.extras.drawings.drawing_process import read_in_process
from core.extras.drawings.drawing_view import Front, Side, Zero
from core.extras.drawings.part_against_drawing import Comparison
from core.extras.drawings.profile_job import in_words
from core.extras.drawings.unit_check import UNITS
from core.extras.shapes.cutting_data import MATERIALS
from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Setting, Value, Values, text
from core.message import Message
from core.sketch import Dim, Sketch, cut, part, sketch

NO_DRAWINGS = "No drawings in the program folder: copy a DXF or SVG file into it with F6, then F8."
CANCELED = "Reading was canceled. Press F6 to read the drawing again."
_WORDS = {"DUNIT": (*UNITS, OWN), "LAYER": (ALL,)}  # translatable choices of a drawing


def _inside(values: Values) -> bool:
    return text(values, "SIDE") == Side.INSIDE


def _outside(values: Values) -> bool:
    return not _inside(values)


def _picture(_filled: Filled) -> Sketch:
    shaft = (
        (0, 0),
        (0, 5),
        (-1, 6),
        (-9, 6),
        (-9, 5),
        (-11, 5),
        (-11, 6),
        (-16, 6),
        (-18, 10),
        (-26, 10),
        (-26, 0),
    )
    return sketch(part(*shaft), cut(*shaft[1:-1]), dims=(Dim("CONTOUR", (-13, 6)),))


def _written(filled: Filled, _setting: Setting, code: Code) -> None:
    assert isinstance(filled, FromDrawing)
    code.write(*filled.text)


PROFILE = Shape(
    "DRAWING",
    "facing, roughing, finishing and grooving of a profile from a DXF or SVG drawing",
    (
        Field("FILE", "DRAWING", Kind.CHOICE),
        Field("DUNIT", "DRAWING UNIT", Kind.CHOICE),
        Field("LAYER", "LAYER", Kind.CHOICE),
        Field("CONTOUR", "CONTOUR", Kind.CHOICE),
        Field("AXIS", "AXIS", Kind.CHOICE),
        Field("SIDE", "SIDE", Kind.CHOICE, str(Side.OUTSIDE), (Side.OUTSIDE, Side.INSIDE)),
        Field("FRONT", "FACE SIDE IN DRAWING", Kind.CHOICE, str(Front.RIGHT), tuple(Front)),
        Field("ZERO", "Z REFERENCE POINT", Kind.CHOICE, str(Zero.FACE), tuple(Zero)),
        Field("SHIFT", "Z OF REFERENCE POINT", Kind.COORDINATE, 0.0, zero=True),
        Field("MATERIAL", "MATERIAL", Kind.CHOICE, "STEEL", tuple(MATERIALS)),
        Field("FROM", "STOCK DIAMETER", Kind.DIAMETER, zero=True),
        Field("HOLE", "HOLE DIAMETER", Kind.DIAMETER, only=_inside),
        Field("STOCK", "STOCK ON THE FACE", Kind.LENGTH, zero=True, only=_outside),
        Field("T", "TOOL", Kind.TOOL, most=32),
        Field("ROUGH", "ROUGHING DEPTH OF CUT", Kind.LENGTH, zero=True),
        Field("COMP", "NOSE COMPENSATION: D NUMBER", Kind.OFFSET, zero=True, most=32),
        Field("BLADE", "GROOVING TOOL", Kind.TOOL, 0.0, zero=True, most=32),
    ),
    _written,
    _picture,
)


@dataclass(frozen=True, slots=True)
class FromDrawing(Filled):
    """Filled form of a drawing. ``text`` contains the lines of several shapes."""

    text: tuple[str, ...] = ()

    def lines(self, setting: Setting) -> list[str]:
        """Return the lines as the shapes have written them."""
        code = Code(setting)
        self.shape.cut(self, setting, code)
        return code.lines


@dataclass(slots=True)
class DrawingForm(ShapeForm):
    """Form of a drawing. ``files`` are the available drawings and ``before`` is the preceding program text.

    ``pending`` is the request that is being planned. ``words`` are the needs of the program and its uncut
    parts, after the trial.
    """

    files: Mapping[str, Path] = field(default_factory=dict)
    before: tuple[str, ...] = ()
    plan: Plan | None = None
    pending: Asked | None = None
    comparison: Comparison | None = None
    canceled: bool = False

    def work(self) -> None:
        """Request a plan for the entries. The previous plan remains until the new plan arrives."""
        self.worked += 1
        self.troubles, self.canceled = {}, False
        values: dict[str, Value] = {}
        for word in self.typed:
            value = self._value(word)
            if value is not None:
                values[word] = value
        self._fill(values)
        path = self.files.get(text(self.one.values, "FILE"))
        if path is None:
            self.troubles["FILE"] = NO_DRAWINGS
        elif not self.troubles:
            asked = Asked(path, {w: v for w, v in values.items() if w != "FILE"}, self.before, self.setting)
            self._ask(asked)
        self._show()

    def use_setting(self, setting: Setting) -> None:
        """Calculate again with other tool data, unless the reading was canceled.

        After a cancellation, F6 starts the reading again.
        """
        if self.canceled:
            self.setting = setting
        else:
            ShapeForm.use_setting(self, setting)  # super() fails in a dataclass with slots

    def _ask(self, asked: Asked) -> None:
        if self.plan is None or self.plan.asked != asked:
            self.pending = asked
            self.words, self.comparison = (), None

    def _fill(self, values: Mapping[str, Value]) -> None:
        proposed: dict[str, Value] = {"FILE": next(iter(self.files))} if self.files else {}
        if self.plan is not None:
            proposed |= self.plan.proposals
        known = {each.word: each.start for each in self.shape.fields if isinstance(each.start, str | float)}
        self.one = FromDrawing(self.shape, {**known, **proposed, **values})

    def cancel(self) -> None:
        """Cancel the reading. F6 requests a new plan."""
        self.pending, self.canceled = None, True
        self.worked += 1
        self.lines = []
        self.troubles["FILE"] = CANCELED

    def take(self, plan: Plan) -> None:
        """Show a finished plan."""
        self.plan, self.pending = plan, None
        self.worked += 1
        values = {word: v for word in self.typed if (v := self._value(word)) is not None}
        self.troubles = {}
        self._fill(values)
        self._show()

    def _show(self) -> None:
        plan = self.plan
        if plan is None or self.pending is not None:
            self.lines = []
            return
        self.troubles = {**plan.troubles, **self.troubles}
        made = plan.made
        self.lines = list(made.lines) if made is not None and not self.troubles else []
        self.one = FromDrawing(self.shape, self.one.values, text=tuple(self.lines))

    def tried(self, comparison: Comparison | None, errors: tuple[str, ...]) -> None:
        """Show the result of the trial: the proof of the program and the comparison with the drawing."""
        plan = self.plan
        if plan is None or plan.made is None or plan.chosen is None:
            return
        self.worked += 1
        self.comparison = comparison
        metric = self.setting.metric
        self.words = (*errors, *in_words(plan.made, comparison, plan.chosen, metric=metric))
        self.plan = replace(plan, picture=pictured(plan, self._chosen_number, comparison))

    @property
    def _chosen_number(self) -> int:
        said = text(self.one.values, "CONTOUR")
        return int(said) if said.isdigit() else 1

    @property
    def sketch(self) -> Sketch:
        """Drawing with the selected contour."""
        return self.plan.picture if self.plan is not None and self.plan.placed else PROFILE.sketch(self.one)

    @property
    def waits(self) -> bool:
        """Whether a plan is pending."""
        return self.pending is not None

    def choices(self, each: Field) -> tuple[str, ...]:
        """Return the choices of a field, including those of the drawing."""
        if each.word == "FILE":
            return tuple(self.files)
        if each.choices or self.plan is None:
            return each.choices
        return self.plan.choices.get(each.word, ())

    def is_word(self, each: Field, choice: str) -> bool:
        """Return whether a choice is a translatable word. Names of layers are not translated."""
        return choice in each.choices or choice in _WORDS.get(each.word, ())

    def dimension(self, word: str) -> str:
        """Return the number of a contour, or the value of another dimension."""
        return (
            word.removeprefix("CONTOUR ") if word.startswith("CONTOUR ") else ShapeForm.dimension(self, word)
        )

    def go_to(self, word: str) -> None:
        """Select a field, or a contour by its number in the drawing."""
        if word.startswith("CONTOUR "):
            self._set("CONTOUR", word.removeprefix("CONTOUR "))
            word = "CONTOUR"
        ShapeForm.go_to(self, word)

    def touch_at(self, point: tuple[float, float]) -> None:
        """Select the touched contour, or the touched line while AXIS is selected."""
        plan = self.plan
        if plan is None or not plan.placed:
            return
        by_line = self.word == "AXIS"
        there = [p for p in plan.placed if (p.number and len(p.points) == 2 if by_line else p.net)]
        nearest = min(there, key=lambda p: _distance(point, p.points), default=None)
        if nearest is not None:
            word, said = (
                ("AXIS", Message("LINE {line}", line=nearest.number))
                if by_line
                else ("CONTOUR", str(nearest.net))
            )
            self._set(word, said)


def _distance(p: tuple[float, float], points: tuple[tuple[float, float], ...]) -> float:
    return min(_from_segment(p, a, b) for a, b in pairwise(points))


def _from_segment(p: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    whole = dx * dx + dy * dy
    share = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / whole)) if whole else 0.0
    return math.dist(p, (a[0] + share * dx, a[1] + share * dy))


Attempt = Callable[[str, Plan, Watch], tuple[Comparison | None, tuple[str, ...]]]
"""A program that was made of a drawing is proved, and its part held against it."""


def nothing_tried(_text: str, _plan: Plan, _watch: Watch) -> tuple[Comparison | None, tuple[str, ...]]:
    """Return no result; used without machine data."""
    return None, ()


class AddedDrawing(AddedForm):
    """Added form for drawings.

    ``files`` returns the available drawings, ``attempt`` tries a program.
    """

    key, shape = "X", PROFILE

    def __init__(self, files: Callable[[], Mapping[str, Path]], attempt: Attempt = nothing_tried) -> None:
        self.files, self.attempt = files, attempt
        self.planner = Planner(read_in_process)
        self.planning, self.trying = Latest("planning-drawing"), Latest("trying-drawing")

    def open_form(self, setting: Setting, before: tuple[str, ...], wanted: Path | None) -> DrawingForm:
        """Return a form with the available drawings, the requested drawing first."""
        files = dict(self.files())
        if wanted is not None:
            files = {wanted.name: wanted, **{name: path for name, path in files.items() if path != wanted}}
        return DrawingForm(PROFILE, setting, files=files, before=before)

    def makes_of(self, name: str) -> bool:
        """Return whether the file is a drawing."""
        return is_drawing(name)

    def work(self, form: ShapeForm, show: Show, tell: Callable[[str], None]) -> None:
        """Plan the entries on a worker, then try the program."""
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
        """Try the program ``text``, or do nothing if the form has been closed (None)."""
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
        """Return F6, which cancels the reading or starts it again."""

        def read_again() -> None:
            form.work()
            show(form)

        if form.waits:
            return {6: Key("CANCEL", lambda: self.cancel(form))}
        return {6: Key("READ", read_again)} if isinstance(form, DrawingForm) and form.canceled else {}

    def prompt(self, form: ShapeForm) -> str:
        """Return the progress of the reading, the error, or the prompt for the keys."""
        if not form.waits:
            keys = tr("LEFT/RIGHT: CHANGE   TAP DRAWING: PICK CONTOUR OR AXIS")
            return tr(form.trouble or keys)
        if not self.planner.reading:
            return tr("CALCULATING THE CONTOUR. PRESS F6 TO CANCEL")
        words = tr("READING THE DRAWING: {seconds} s. PRESS F6 TO CANCEL")
        return tr(Message(words, seconds=self.planning.reached))

    def poll(self) -> None:
        """Process the results of planning and trials."""
        self.planning.poll()
        self.trying.poll()

    def close(self) -> None:
        """Stop both workers."""
        self.planning.close()
        self.trying.close()
