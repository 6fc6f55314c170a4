"""Plan of a program from a drawing, which a worker calculates.

The plan contains proposed values, choices, program lines and a sketch.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import ProgressCallback
from core.extras.drawings.contour_tracing import ElementGroup
from core.extras.drawings.drawing import Drawing, DrawingError, limit_processor_time
from core.extras.drawings.drawing_placement import (
    ContourProfile,
    ContourSide,
    DrawingPlacement,
    FaceEnd,
    ZeroPosition,
    extract_profile,
    find_axes,
    find_contours,
    place_elements,
    require_clear_axis,
    select_axis,
)
from core.extras.drawings.profile_description import propose_program_fields
from core.extras.drawings.profile_program import ProfileProgram, make_profile_program
from core.extras.drawings.unit_check import UNIT_SIZES_MM, detect_wrong_unit
from core.extras.shapes.shape_fields import FieldValue, FieldValues, ProgramSettings
from core.geometry.lines_and_arcs import Arc, Element, Line
from core.message import Message
from core.sketch import Dimension, Outline, Sketch

if TYPE_CHECKING:
    from core.extras.drawings.part_comparison import DrawingComparison

ALL_LAYERS = "ALL"
AXIS_AS_DRAWN = "AS DRAWN"
_MOST_DRAWN = 3000  # maximum number of elements in a picture
_CHORD = 0.15  # rad of an arc per chord of the picture
_NUMBERS = ("FROM", "STOCK", "HOLE", "ROUGH", "T", "BLADE", "COMP")


@dataclass(frozen=True, slots=True)
class PlanRequest:
    """Request for a program plan.

    ``entered_values`` are the entries of the form. ``preceding_lines`` are the program lines before the
    form.
    """

    drawing_path: Path
    entered_values: FieldValues
    preceding_lines: tuple[str, ...]
    settings: ProgramSettings


@dataclass(frozen=True, slots=True)
class PlacedElement:
    """Element of a drawing as (z, r) points relative to the axis of rotation.

    ``line_number`` and ``contour_number`` count from 1. The value 0 means that the element has no such
    number.
    """

    points: tuple[tuple[float, float], ...]
    line_number: int = 0
    contour_number: int = 0


@dataclass(frozen=True, slots=True)
class DrawingPlan:
    """Plan of a program from a drawing.

    ``errors`` contains the errors by field name. ``program`` and ``profile`` are None if there is an error.
    """

    request: PlanRequest
    proposed_values: Mapping[str, FieldValue] = field(default_factory=dict)
    field_choices: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    field_errors: Mapping[str, str] = field(default_factory=dict)
    placed_elements: tuple[PlacedElement, ...] = ()
    sketch: Sketch = field(default_factory=Sketch)
    program: ProfileProgram | None = None
    profile: ContourProfile | None = None


class DrawingPlanner:
    """Planner of programs from drawings. It caches the last drawing, and only one worker uses it.

    ``is_reading`` is True while a drawing file is being read.
    """

    def __init__(self, read_drawing: Callable[[Path, ProgressCallback], Drawing]) -> None:
        self._read = read_drawing
        self._known: tuple[Path, float, Drawing] | None = None
        self.is_reading = False

    def make_plan(self, request: PlanRequest, report_progress: ProgressCallback) -> DrawingPlan:
        """Return the plan of a program. Errors are returned in the plan, by form field.

        ``report_progress`` can raise an exception to cancel the work.
        """
        try:
            drawing = self._drawing(request.drawing_path, report_progress)
        except DrawingError as error:
            return DrawingPlan(request, field_errors={"FILE": str(error)})
        with limit_processor_time(report_progress):
            return _PlanBuilder(drawing, request).make_plan()

    def _drawing(self, path: Path, watch: ProgressCallback) -> Drawing:
        try:
            changed = path.stat().st_mtime
        except OSError as error:
            raise DrawingError(
                Message("{path} cannot be read: {cause}.", path=path.name, cause=error.strerror or error),
                "unreadable",
            ) from error
        if self._known is None or self._known[:2] != (path, changed):
            self.is_reading = True
            try:
                self._known = (path, changed, self._read(path, watch))
            finally:
                self.is_reading = False
        return self._known[2]


def get_contour_number(value: FieldValue | None) -> int:
    """Return the number of the selected contour, or 1 if the value is not a whole number."""
    said = str(value)
    return int(said) if said.isdecimal() else 1


class _PlanBuilder:
    """Builder that calculates one plan in steps.

    Each step adds proposed values and can end the plan with an error.
    """

    def __init__(self, drawing: Drawing, request: PlanRequest) -> None:
        self.drawing, self.request = drawing, request
        self.proposals: dict[str, FieldValue] = {}
        self.choices: dict[str, tuple[str, ...]] = {}
        self.nets: list[ElementGroup] = []
        self.view: DrawingPlacement | None = None

    def get_entry_text(self, name: str, proposed: str = "") -> str:
        """Return the entry of a field, or ``proposed`` if the field is empty.

        ``proposed`` is also added to the proposed values of the form.
        """
        if proposed:
            self.proposals[name] = proposed
        value = self.request.entered_values.get(name, proposed)
        return value if isinstance(value, str) else ""

    def make_plan(self) -> DrawingPlan:
        try:
            word = "LAYER"
            layer = self._layer()
            word = "DUNIT"
            unit = self._unit()
            word = "AXIS"
            self._view(layer, unit)
            word = "CONTOUR"
            net = self._net(layer)
            word = "DUNIT"
            self._check_unit(net)
            word = "CONTOUR"
            chosen = self._chosen(net)
            word = "T"
            made, fields = self._made(chosen)
        except DrawingError as error:
            return self._plan({word: str(error)})
        for one, _ in made.shapes:
            if one.shape.has_point_table:
                fields["ROUGH"] = one.get_number("ROUGH")
        self.proposals |= {name: fields[name] for name in _NUMBERS if name in fields}
        troubles = {_find_form_field(each.field_name): each.message for each in reversed(made.errors)}
        return self._plan(troubles, made, chosen)

    def _plan(
        self,
        troubles: Mapping[str, str],
        made: ProfileProgram | None = None,
        chosen: ContourProfile | None = None,
    ) -> DrawingPlan:
        placed = (
            tuple(_placed(self.drawing, self.view, self.nets, self.get_entry_text("LAYER")))
            if self.view
            else ()
        )
        number = get_contour_number(self.get_entry_text("CONTOUR") or self.proposals.get("CONTOUR"))
        good = made if not troubles else None
        plan = DrawingPlan(
            self.request, self.proposals, self.choices, troubles, placed, program=good, profile=chosen
        )
        return replace(plan, sketch=make_plan_sketch(plan, number))

    def _layer(self) -> str:
        self.choices["LAYER"] = (
            ALL_LAYERS,
            *(layer for layer in self.drawing.layers if layer and layer != ALL_LAYERS),
        )
        layer = self.get_entry_text("LAYER", ALL_LAYERS)
        if layer not in self.choices["LAYER"]:
            raise DrawingError(
                Message(
                    "{drawing} has no layer {layer}: choose another layer.",
                    drawing=self.drawing.name,
                    layer=layer,
                ),
                "no-layer",
            )
        return "" if layer == ALL_LAYERS else layer

    def _unit(self) -> float:
        self.choices["DUNIT"] = tuple(UNIT_SIZES_MM)
        own = next((name for name, mm in UNIT_SIZES_MM.items() if abs(mm - self.drawing.unit_mm) < 1e-9), "")
        if self.drawing.unit_mm and not own:
            self.choices["DUNIT"] = (*UNIT_SIZES_MM, AXIS_AS_DRAWN)
            own = AXIS_AS_DRAWN
        said = self.get_entry_text("DUNIT", own)
        if not said:
            raise DrawingError(
                Message("{drawing} does not specify its unit: choose MM or INCH.", drawing=self.drawing.name),
                "no-unit",
            )
        return UNIT_SIZES_MM.get(said, self.drawing.unit_mm)

    def _view(self, layer: str, unit: float) -> None:
        known = find_axes(self.drawing, layer)
        self.choices["AXIS"] = tuple(each.name for each in known)
        if "AXIS" not in self.request.entered_values:
            require_clear_axis(self.drawing, layer)
        axis = select_axis(self.drawing, self.get_entry_text("AXIS", known[0].name), layer)
        self.choices["AXIS"] = tuple(dict.fromkeys([*(each.name for each in known), axis.name]))
        front = FaceEnd(self.get_entry_text("FRONT", FaceEnd.RIGHT))
        zero = ZeroPosition(self.get_entry_text("ZERO", ZeroPosition.FACE))
        shift = self.request.entered_values.get("SHIFT", 0.0)
        mm = self.request.settings.mm
        self.view = DrawingPlacement(axis, unit, front, zero, 0.0 if isinstance(shift, str) else shift * mm)
        self.nets = find_contours(self.drawing, self.view, layer)
        self.choices["CONTOUR"] = tuple(str(n) for n in range(1, len(self.nets) + 1))

    def _net(self, layer: str) -> ElementGroup:
        if not self.nets or self.view is None:
            template = (
                "{drawing} has no contour on layer {layer}: choose another layer or axis."
                if layer
                else "{drawing} has no contour for the selected axis: choose another layer or axis."
            )
            raise DrawingError(Message(template, drawing=self.drawing.name, layer=layer), "no-contour")
        number = self.get_entry_text("CONTOUR", "1")
        if number not in self.choices["CONTOUR"]:
            raise DrawingError(
                Message(
                    "{drawing} has {nets_count} contours: choose 1 to {nets_count2}.",
                    drawing=self.drawing.name,
                    nets_count=len(self.nets),
                    nets_count2=len(self.nets),
                ),
                "no-contour-number",
            )
        return self.nets[int(number) - 1]

    def _check_unit(self, net: ElementGroup) -> None:
        """Raise DrawingError if the size of the contour suggests a unit other than the file's unit."""
        assert self.view is not None
        if "DUNIT" in self.request.entered_values:
            return
        if (
            wrong := detect_wrong_unit(net, self.view.unit, self.request.settings.shop.travel_mm)
        ) is not None:
            template = (
                "{drawing} is {wrong}, which is too large for this machine. The drawing fits if its "
                "unit is {wrong2}: choose {wrong3}."
                if wrong.is_too_large
                else "{drawing} is only {wrong}. Its unit may be {wrong2}: choose MM or INCH."
            )
            words = Message(
                template,
                drawing=self.drawing.name,
                wrong=wrong.size,
                wrong2=wrong.unit_name,
                wrong3=wrong.unit_name,
            )
            raise DrawingError(words, "wrong-unit")

    def _chosen(self, net: ElementGroup) -> ContourProfile:
        assert self.view is not None
        side = ContourSide(self.get_entry_text("SIDE", ContourSide.OUTSIDE))
        return extract_profile(self.drawing, self.view, net, side)

    def _made(self, chosen: ContourProfile) -> tuple[ProfileProgram, dict[str, FieldValue]]:
        asked = self.request
        given = {
            name: asked.entered_values[name]
            for name in (*_NUMBERS, "MATERIAL")
            if name in asked.entered_values
        }
        if "FROM" in given:
            given["BAR"] = given["FROM"]
        now = asked.settings
        fields = propose_program_fields(
            chosen, given, now.shop.tools, is_metric=now.metric, dialect=now.dialect
        )
        if chosen.side is ContourSide.INSIDE and not given.get("HOLE"):
            raise DrawingError("Boring needs a predrilled hole: enter its diameter.", "no-hole")
        return make_profile_program(chosen, fields, asked.preceding_lines, asked.settings), fields


_FIELDS = frozenset(
    {"FILE", "DUNIT", "LAYER", "AXIS", "CONTOUR", "FRONT", "ZERO", "SHIFT", "SIDE", *_NUMBERS}
)


def _find_form_field(word: str) -> str:
    """Return the field of the drawing form at which an error of a shape is shown.

    ``word`` is the name of the field of the shape that has the error.
    """
    return word if word in _FIELDS else "CONTOUR" if word.startswith("#") else "T"


# --- picture ---


def _placed(
    drawing: Drawing, view: DrawingPlacement | None, nets: Sequence[ElementGroup], layer: str
) -> Iterator[PlacedElement]:
    if view is None:
        return
    layer = "" if layer == ALL_LAYERS else layer
    for number, each in enumerate(drawing.elements[:_MOST_DRAWN], 1):
        if not layer or each.layer == layer:
            (there,) = place_elements([each.element], view)
            yield PlacedElement(_polyline(there), number)
    for number, net in enumerate(nets[:60], 1):
        for element in net.elements[:_MOST_DRAWN]:
            yield PlacedElement(_polyline(element), 0, number)


def _polyline(element: Element) -> tuple[tuple[float, float], ...]:
    """Return the (z, r) points of an element. Arcs are divided into chords."""
    if isinstance(element, Line):
        return _turned([element.start, element.end])
    assert isinstance(element, Arc)
    count = max(2, math.ceil(abs(element.sweep_rad) / _CHORD))
    return _turned(
        [
            element.start,
            *(element.get_point(element.length * k / count) for k in range(1, count)),
            element.end,
        ]
    )


def _turned(points: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    return tuple((z, r) for r, z in points)


def make_plan_sketch(
    plan: DrawingPlan, contour_number: int, comparison: DrawingComparison | None = None
) -> Sketch:
    """Return the sketch of the drawing with its axis of rotation and the selected contour.

    Sections of the contour that the program leaves uncut or cuts incorrectly are red.
    """
    drawn = [Outline(each.points, "part") for each in plan.placed_elements if each.line_number]
    outlines = [
        *drawn,
        *(
            Outline(p.points, "far")
            for p in plan.placed_elements
            if p.contour_number and p.contour_number != contour_number
        ),
    ]
    here = [
        Outline(each.points, "cut") for each in plan.placed_elements if each.contour_number == contour_number
    ]
    ends = [z for each in (*outlines, *here) for z, _ in each.points] or [0.0, 1.0]
    room = 0.05 * (max(ends) - min(ends) or 1.0)
    axis = Outline(((min(ends) - room, 0.0), (max(ends) + room, 0.0)), "axis")
    tops = [
        Dimension(
            Message("CONTOUR {item}", item=each),
            max(
                (p for o in plan.placed_elements if o.contour_number == each for p in o.points),
                key=lambda p: p[1],
            ),
        )
        for each in range(1, len(plan.field_choices.get("CONTOUR", ())) + 1)
        if any(o.contour_number == each for o in plan.placed_elements)
    ]
    left = list(_find_deviating_sections(plan, contour_number, comparison))
    return Sketch((axis, *outlines, *here, *left), tuple(tops[:9]))


def _find_deviating_sections(
    plan: DrawingPlan, number: int, comparison: DrawingComparison | None
) -> Iterator[Outline]:
    """Yield the sections of the contour where the part differs from the drawing."""
    if plan.profile is None or plan.program is None:
        return
    spans = [(each.back_z_mm, each.front_z_mm) for each in plan.program.uncut_ranges]
    if comparison is not None:
        spans = [(each.back_z_mm - 0.02, each.front_z_mm + 0.02) for each in comparison.deviations]
    ends = [z for each in plan.placed_elements if each.contour_number == number for z, _ in each.points]
    shift = (max(ends) if ends else 0.0) - plan.profile.front_z_mm
    for each in plan.profile.elements:
        points = [(z + shift, r) for z, r in _polyline(each)]
        for a, b in pairwise(points):
            low, high = sorted((a[0] - shift, b[0] - shift))
            if any(low < front and high > back for back, front in spans):
                yield Outline((a, b), "left")
