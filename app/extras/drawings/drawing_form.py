"""Form that makes a program from a drawing (DXF, SVG).

Workers read the drawing, plan the program and test the program. The program consists of shape lines.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

from app.desk.background_work import LatestRequestWorker, ProgressCallback
from app.desk.pages.table_content import FunctionKey
from app.desk.translation import tr
from app.extras.drawings.drawing_plan import (
    ALL_LAYERS,
    AXIS_AS_DRAWN,
    DrawingPlan,
    DrawingPlanner,
    PlanRequest,
    get_contour_number,
    make_plan_sketch,
)
from app.extras.shapes.shape_form import AdditionalForm, ShapeForm, ShowForm
from core.extras.drawings.drawing_file import has_drawing_suffix
from core.extras.drawings.drawing_placement import ContourSide, FaceEnd, ZeroPosition
from core.extras.drawings.drawing_process import read_drawing_in_process
from core.extras.drawings.part_comparison import DrawingComparison
from core.extras.drawings.profile_description import describe_program
from core.extras.drawings.unit_check import UNIT_SIZES_MM
from core.extras.shapes.cutting_data import CUTTING_DATA
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.lines.code_lines import CodeWriter
from core.extras.shapes.shape_fields import (
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    text,
)
from core.message import Message
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch

NO_DRAWINGS_MESSAGE = "No drawings in the program folder: copy a DXF or SVG file into it with F6, then F8."
CANCELED_MESSAGE = "Reading was canceled. Press F6 to read the drawing again."
_WORDS = {
    "DUNIT": (*UNIT_SIZES_MM, AXIS_AS_DRAWN),
    "LAYER": (ALL_LAYERS,),
}  # translatable choices of a drawing


def _inside(values: FieldValues) -> bool:
    return text(values, "SIDE") == ContourSide.INSIDE


def _outside(values: FieldValues) -> bool:
    return not _inside(values)


def _picture(_filled: ShapeInstance) -> Sketch:
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
    return make_sketch(
        make_part_outline(*shaft),
        make_cut_outline(*shaft[1:-1]),
        dimensions=(Dimension("CONTOUR", (-13, 6)),),
    )


def _written(filled: ShapeInstance, _setting: ProgramSettings, code: CodeWriter) -> None:
    assert isinstance(filled, FilledDrawingForm)
    code.append_lines(*filled.program_lines)


DRAWING_SHAPE = Shape(
    "DRAWING",
    "facing, roughing, finishing and grooving of a profile from a DXF or SVG drawing",
    (
        ShapeField("FILE", "DRAWING", FieldKind.CHOICE),
        ShapeField("DUNIT", "DRAWING UNIT", FieldKind.CHOICE),
        ShapeField("LAYER", "LAYER", FieldKind.CHOICE),
        ShapeField("CONTOUR", "CONTOUR", FieldKind.CHOICE),
        ShapeField("AXIS", "AXIS", FieldKind.CHOICE),
        ShapeField(
            "SIDE",
            "SIDE",
            FieldKind.CHOICE,
            str(ContourSide.OUTSIDE),
            (ContourSide.OUTSIDE, ContourSide.INSIDE),
        ),
        ShapeField("FRONT", "FACE SIDE IN DRAWING", FieldKind.CHOICE, str(FaceEnd.RIGHT), tuple(FaceEnd)),
        ShapeField(
            "ZERO", "Z REFERENCE POINT", FieldKind.CHOICE, str(ZeroPosition.FACE), tuple(ZeroPosition)
        ),
        ShapeField("SHIFT", "Z OF REFERENCE POINT", FieldKind.COORDINATE, 0.0, allows_zero=True),
        ShapeField("MATERIAL", "MATERIAL", FieldKind.CHOICE, "STEEL", tuple(CUTTING_DATA)),
        ShapeField("FROM", "STOCK DIAMETER", FieldKind.DIAMETER, allows_zero=True),
        ShapeField("HOLE", "HOLE DIAMETER", FieldKind.DIAMETER, applies_to=_inside),
        ShapeField("STOCK", "STOCK ON THE FACE", FieldKind.LENGTH, allows_zero=True, applies_to=_outside),
        ShapeField("T", "TOOL", FieldKind.TOOL, maximum=32),
        ShapeField("ROUGH", "ROUGHING DEPTH OF CUT", FieldKind.LENGTH, allows_zero=True),
        ShapeField("COMP", "NOSE COMPENSATION: D NUMBER", FieldKind.OFFSET, allows_zero=True, maximum=32),
        ShapeField("BLADE", "GROOVING TOOL", FieldKind.TOOL, 0.0, allows_zero=True, maximum=32),
    ),
    _written,
    _picture,
)


@dataclass(frozen=True, slots=True)
class FilledDrawingForm(ShapeInstance):
    """Values that are entered in the form of a drawing.

    ``program_lines`` contains the program lines of several shapes.
    """

    program_lines: tuple[str, ...] = ()

    def make_lines(self, settings: ProgramSettings) -> list[str]:
        """Return the program lines that the form writes for its entries."""
        code = CodeWriter(settings)
        self.shape.write_lines(self, settings, code)
        return code.lines


@dataclass(slots=True)
class DrawingForm(ShapeForm):
    """Form that makes a program from a drawing.

    - ``drawing_files`` are the available drawings.
    - ``preceding_lines`` are the program lines before the form.
    - ``pending_request`` is the request for a plan that is not complete yet.
    - ``comparison`` is the comparison between the drawing and the part from the trial run.
    - ``remarks`` lists what the program requires and which sections remain uncut.
    """

    drawing_files: Mapping[str, Path] = field(default_factory=dict)
    preceding_lines: tuple[str, ...] = ()
    drawing_plan: DrawingPlan | None = None
    pending_request: PlanRequest | None = None
    comparison: DrawingComparison | None = None
    is_canceled: bool = False

    def calculate(self) -> None:
        """Request a new program plan for the current entries.

        The previous plan remains until the new plan arrives.
        """
        self.calculation_count += 1
        self.error_texts, self.is_canceled = {}, False
        values: dict[str, FieldValue] = {}
        for word in self.entered_texts:
            value = self._value(word)
            if value is not None:
                values[word] = value
        self._fill(values)
        path = self.drawing_files.get(text(self.filled_shape.field_values, "FILE"))
        if path is None:
            self.error_texts["FILE"] = NO_DRAWINGS_MESSAGE
        elif not self.error_texts:
            asked = PlanRequest(
                path, {w: v for w, v in values.items() if w != "FILE"}, self.preceding_lines, self.settings
            )
            self._ask(asked)
        self._show()

    def apply_settings(self, settings: ProgramSettings) -> None:
        """Recalculate the form with changed tool data, unless the operator canceled reading the drawing.

        After a cancellation, F6 starts reading the drawing again.
        """
        if self.is_canceled:
            self.settings = settings
        else:
            ShapeForm.apply_settings(self, settings)  # super() fails in a dataclass with slots

    def _ask(self, asked: PlanRequest) -> None:
        if self.drawing_plan is None or self.drawing_plan.request != asked:
            self.pending_request = asked
            self.remarks, self.comparison = (), None

    def _fill(self, values: Mapping[str, FieldValue]) -> None:
        proposed: dict[str, FieldValue] = (
            {"FILE": next(iter(self.drawing_files))} if self.drawing_files else {}
        )
        if self.drawing_plan is not None:
            proposed |= self.drawing_plan.proposed_values
        known = {
            each.name: each.default for each in self.shape.fields if isinstance(each.default, str | float)
        }
        self.filled_shape = FilledDrawingForm(self.shape, {**known, **proposed, **values})

    def cancel(self) -> None:
        """Cancel reading the drawing.

        F6 then starts reading again.
        """
        self.pending_request, self.is_canceled = None, True
        self.calculation_count += 1
        self.program_lines = []
        self.error_texts["FILE"] = CANCELED_MESSAGE

    def show_plan(self, plan: DrawingPlan) -> None:
        """Show the program plan that the worker has calculated."""
        self.drawing_plan, self.pending_request = plan, None
        self.calculation_count += 1
        values = {word: v for word in self.entered_texts if (v := self._value(word)) is not None}
        self.error_texts = {}
        self._fill(values)
        self._show()

    def _show(self) -> None:
        plan = self.drawing_plan
        if plan is None or self.pending_request is not None:
            self.program_lines = []
            return
        self.error_texts = {**plan.field_errors, **self.error_texts}
        made = plan.program
        self.program_lines = list(made.lines) if made is not None and not self.error_texts else []
        self.filled_shape = FilledDrawingForm(
            self.shape, self.filled_shape.field_values, program_lines=tuple(self.program_lines)
        )

    def show_trial_result(self, comparison: DrawingComparison | None, errors: tuple[str, ...]) -> None:
        """Show the result of the trial run: the errors of the proof, and the comparison with the drawing."""
        plan = self.drawing_plan
        if plan is None or plan.program is None or plan.profile is None:
            return
        self.calculation_count += 1
        self.comparison = comparison
        metric = self.settings.metric
        self.remarks = (*errors, *describe_program(plan.program, comparison, plan.profile, is_metric=metric))
        number = get_contour_number(self.filled_shape.field_values.get("CONTOUR"))
        self.drawing_plan = replace(plan, sketch=make_plan_sketch(plan, number, comparison))

    @property
    def current_sketch(self) -> Sketch:
        """Return the sketch of the drawing with the selected contour."""
        return (
            self.drawing_plan.sketch
            if self.drawing_plan is not None and self.drawing_plan.placed_elements
            else DRAWING_SHAPE.make_sketch(self.filled_shape)
        )

    @property
    def is_calculating(self) -> bool:
        """Return whether the worker is still calculating a program plan."""
        return self.pending_request is not None

    def list_choices(self, field: ShapeField) -> tuple[str, ...]:
        """Return the choices of a field, including choices from the drawing."""
        if field.name == "FILE":
            return tuple(self.drawing_files)
        if field.choices or self.drawing_plan is None:
            return field.choices
        return self.drawing_plan.field_choices.get(field.name, ())

    def is_translatable(self, field: ShapeField, choice: str) -> bool:
        """Return whether a choice is a screen text and must be translated. Layer names are not translated."""
        return choice in field.choices or choice in _WORDS.get(field.name, ())

    def get_dimension_text(self, word: str) -> str:
        """Return the text of a dimension in the sketch. The text of a contour is its number."""
        return (
            word.removeprefix("CONTOUR ")
            if word.startswith("CONTOUR ")
            else ShapeForm.get_dimension_text(self, word)
        )

    def select_field_by_name(self, word: str) -> None:
        """Select a field by its name, or a contour by its number in the drawing."""
        if word.startswith("CONTOUR "):
            self._set("CONTOUR", word.removeprefix("CONTOUR "))
            word = "CONTOUR"
        ShapeForm.select_field_by_name(self, word)

    def handle_touch(self, point: tuple[float, float]) -> None:
        """Select the touched contour, or the touched line while the AXIS field is selected."""
        plan = self.drawing_plan
        if plan is None or not plan.placed_elements:
            return
        by_line = self.selected_field_name == "AXIS"
        there = [
            p
            for p in plan.placed_elements
            if (p.line_number and len(p.points) == 2 if by_line else p.contour_number)
        ]
        nearest = min(there, key=lambda p: _distance(point, p.points), default=None)
        if nearest is not None:
            word, said = (
                ("AXIS", Message("LINE {line}", line=nearest.line_number))
                if by_line
                else ("CONTOUR", str(nearest.contour_number))
            )
            self._set(word, said)


def _distance(p: tuple[float, float], points: tuple[tuple[float, float], ...]) -> float:
    return min(_from_segment(p, a, b) for a, b in pairwise(points))


def _from_segment(p: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    whole = dx * dx + dy * dy
    share = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / whole)) if whole else 0.0
    return math.dist(p, (a[0] + share * dx, a[1] + share * dy))


TrialFunction = Callable[
    [str, DrawingPlan, ProgressCallback], tuple[DrawingComparison | None, tuple[str, ...]]
]
"""Function that proves a program made from a drawing and compares its part with the drawing."""


def skip_trial(
    _text: str, _plan: DrawingPlan, _watch: ProgressCallback
) -> tuple[DrawingComparison | None, tuple[str, ...]]:
    """Return a trial result without a comparison and without errors.

    This function replaces the trial run if no machine data are available.
    """
    return None, ()


class AdditionalDrawingForm(AdditionalForm):
    """Entry for the drawing form in the list of shapes.

    ``find_drawing_files`` returns the available drawings. ``run_trial`` proves the program and compares its
    part with the drawing.
    """

    key, shape = "X", DRAWING_SHAPE

    def __init__(
        self, find_drawing_files: Callable[[], Mapping[str, Path]], run_trial: TrialFunction = skip_trial
    ) -> None:
        self.find_drawing_files, self.run_trial = find_drawing_files, run_trial
        self.planner = DrawingPlanner(read_drawing_in_process)
        self.plan_worker, self.trial_worker = (
            LatestRequestWorker("planning-drawing"),
            LatestRequestWorker("trying-drawing"),
        )

    def open_form(
        self, settings: ProgramSettings, preceding_lines: tuple[str, ...], requested_file: Path | None
    ) -> DrawingForm:
        """Return a form that lists the available drawings, with the requested drawing first."""
        files = dict(self.find_drawing_files())
        if requested_file is not None:
            files = {
                requested_file.name: requested_file,
                **{name: path for name, path in files.items() if path != requested_file},
            }
        return DrawingForm(DRAWING_SHAPE, settings, drawing_files=files, preceding_lines=preceding_lines)

    def accepts_file(self, name: str) -> bool:
        """Return whether the file is a drawing."""
        return has_drawing_suffix(name)

    def calculate(self, form: ShapeForm, show_form: ShowForm, show_message: Callable[[str], None]) -> None:
        """Plan the program for the form's entries on a worker, and then run the trial of the program."""
        if not isinstance(form, DrawingForm) or form.pending_request is None:
            return
        asked = form.pending_request

        def handle_plan(plan: DrawingPlan) -> None:
            if form.pending_request == asked:
                form.show_plan(plan)
                self._try(form, plan, show_form(form), handle_failure)

        def handle_failure(why: str) -> None:
            show_message(tr(Message("THE DRAWING CANNOT BE PROCESSED: {why}", why=why)))

        self.trial_worker.cancel_request()
        self.plan_worker.request_work(
            lambda watch: self.planner.make_plan(asked, watch), handle_plan, handle_failure
        )

    def _try(
        self, form: DrawingForm, plan: DrawingPlan, text: str | None, failed: Callable[[str], None]
    ) -> None:
        """Run the trial of the program ``text`` on a worker.

        If the form has been closed, ``text`` is None and no trial is run.
        """
        if not form.program_lines or text is None:
            return

        def handle_trial_result(found: tuple[DrawingComparison | None, tuple[str, ...]]) -> None:
            if form.drawing_plan is plan:
                form.show_trial_result(*found)

        self.trial_worker.request_work(
            lambda watch: self.run_trial(text, plan, watch), handle_trial_result, failed
        )

    def cancel(self, form: ShapeForm) -> None:
        """Cancel reading a drawing (F6 or Esc) and end the process that reads it."""
        if isinstance(form, DrawingForm):
            self.plan_worker.cancel_request()
            form.cancel()

    def make_function_keys(self, form: ShapeForm, show_form: ShowForm) -> Mapping[int, FunctionKey]:
        """Return the key F6, which cancels reading the drawing or starts reading it again."""

        def reread_drawing() -> None:
            form.calculate()
            show_form(form)

        if form.is_calculating:
            return {6: FunctionKey("CANCEL", lambda: self.cancel(form))}
        return (
            {6: FunctionKey("READ", reread_drawing)}
            if isinstance(form, DrawingForm) and form.is_canceled
            else {}
        )

    def prompt_text(self, form: ShapeForm) -> str:
        """Return the reading progress or the error, or else the prompt that explains the keys."""
        if not form.is_calculating:
            keys = tr("LEFT/RIGHT: CHANGE   TAP DRAWING: PICK CONTOUR OR AXIS")
            return tr(form.current_error or keys)
        if not self.planner.is_reading:
            return tr("CALCULATING THE CONTOUR. PRESS F6 TO CANCEL")
        words = tr("READING THE DRAWING: {seconds} s. PRESS F6 TO CANCEL")
        return tr(Message(words, seconds=self.plan_worker.progress_count))

    def poll(self) -> None:
        """Process the results of the planning worker and of the trial worker."""
        self.plan_worker.deliver_results()
        self.trial_worker.deliver_results()

    def close(self) -> None:
        """Stop both workers."""
        self.plan_worker.close()
        self.trial_worker.close()
