"""Plan of a program from a drawing, calculated on a worker: proposals, choices, lines and picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import Watch
from core.extras.drawings.contour_walk import Net
from core.extras.drawings.drawing import Drawing, DrawingError, limited_work
from core.extras.drawings.drawing_view import (
    Front,
    Profile,
    Side,
    View,
    Zero,
    axes,
    axis_named,
    contours,
    on_lathe,
    profile,
)
from core.extras.drawings.profile_job import proposed_fields
from core.extras.drawings.profile_program import ProfileProgram, profile_program
from core.extras.drawings.unit_check import UNITS, wrong_unit
from core.extras.shapes.shape_fields import Setting, Value, Values
from core.geometry.lines_and_arcs import Arc, Element, Line
from core.message import Message
from core.sketch import Dim, Outline, Sketch

if TYPE_CHECKING:
    from core.extras.drawings.part_against_drawing import Comparison

ALL = "ALL"
OWN = "AS DRAWN"
_MOST_DRAWN = 3000  # maximum number of elements in a picture
_CHORD = 0.15  # rad of an arc per chord of the picture
_NUMBERS = ("FROM", "STOCK", "HOLE", "ROUGH", "T", "BLADE", "COMP")


@dataclass(frozen=True, slots=True)
class Asked:
    """Request of a plan. ``values`` are the entries, and ``lines`` is the preceding program."""

    path: Path
    values: Values
    lines: tuple[str, ...]
    setting: Setting


@dataclass(frozen=True, slots=True)
class Placed:
    """Element of the drawing as (z, r) points from the axis, with its line number or contour, from 1."""

    points: tuple[tuple[float, float], ...]
    number: int = 0
    net: int = 0


@dataclass(frozen=True, slots=True)
class Plan:
    """Plan with ``troubles`` by field. ``made`` and ``chosen`` are None if there is an error."""

    asked: Asked
    proposals: Mapping[str, Value] = field(default_factory=dict)
    choices: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    troubles: Mapping[str, str] = field(default_factory=dict)
    placed: tuple[Placed, ...] = ()
    picture: Sketch = field(default_factory=Sketch)
    made: ProfileProgram | None = None
    chosen: Profile | None = None


class Planner:
    """Planner with a cache of the last drawing, used by one worker.

    ``reading`` is set while a file is read.
    """

    def __init__(self, read: Callable[[Path, Watch], Drawing]) -> None:
        self._read = read
        self._known: tuple[Path, float, Drawing] | None = None
        self.reading = False

    def plan(self, asked: Asked, watch: Watch) -> Plan:
        """Return the plan, with errors by field. ``watch`` can raise an exception to cancel."""
        try:
            drawing = self._drawing(asked.path, watch)
        except DrawingError as error:
            return Plan(asked, troubles={"FILE": str(error)})
        with limited_work(watch):
            return _Making(drawing, asked).plan()

    def _drawing(self, path: Path, watch: Watch) -> Drawing:
        try:
            changed = path.stat().st_mtime
        except OSError as error:
            raise DrawingError(
                Message("{path} cannot be read: {cause}.", path=path.name, cause=error.strerror or error),
                "unreadable",
            ) from error
        if self._known is None or self._known[:2] != (path, changed):
            self.reading = True
            try:
                self._known = (path, changed, self._read(path, watch))
            finally:
                self.reading = False
        return self._known[2]


class _Making:
    """Calculation of one plan. Each step adds proposals and can end the plan with an error."""

    def __init__(self, drawing: Drawing, asked: Asked) -> None:
        self.drawing, self.asked = drawing, asked
        self.proposals: dict[str, Value] = {}
        self.choices: dict[str, tuple[str, ...]] = {}
        self.nets: list[Net] = []
        self.view: View | None = None

    def word(self, name: str, proposed: str = "") -> str:
        """Return the choice of a field."""
        if proposed:
            self.proposals[name] = proposed
        value = self.asked.values.get(name, proposed)
        return value if isinstance(value, str) else ""

    def plan(self) -> Plan:
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
            if one.shape.contour:
                fields["ROUGH"] = one.n("ROUGH")
        self.proposals |= {name: fields[name] for name in _NUMBERS if name in fields}
        troubles = {_field_of(each.word): each.text for each in reversed(made.refusals)}
        return self._plan(troubles, made, chosen)

    def _plan(
        self, troubles: Mapping[str, str], made: ProfileProgram | None = None, chosen: Profile | None = None
    ) -> Plan:
        placed = tuple(_placed(self.drawing, self.view, self.nets, self.word("LAYER"))) if self.view else ()
        number = int(self.word("CONTOUR") or self.proposals.get("CONTOUR") or 1)
        good = made if not troubles else None
        plan = Plan(self.asked, self.proposals, self.choices, troubles, placed, made=good, chosen=chosen)
        return replace(plan, picture=pictured(plan, number))

    def _layer(self) -> str:
        self.choices["LAYER"] = (ALL, *(layer for layer in self.drawing.layers if layer and layer != ALL))
        layer = self.word("LAYER", ALL)
        if layer not in self.choices["LAYER"]:
            raise DrawingError(
                Message(
                    "{drawing} has no layer {layer}: choose another layer.",
                    drawing=self.drawing.name,
                    layer=layer,
                ),
                "no-layer",
            )
        return "" if layer == ALL else layer

    def _unit(self) -> float:
        self.choices["DUNIT"] = tuple(UNITS)
        own = next((name for name, mm in UNITS.items() if abs(mm - self.drawing.unit) < 1e-9), "")
        if self.drawing.unit and not own:
            self.choices["DUNIT"] = (*UNITS, OWN)
            own = OWN
        said = self.word("DUNIT", own)
        if not said:
            raise DrawingError(
                Message("{drawing} does not specify its unit: choose MM or INCH.", drawing=self.drawing.name),
                "no-unit",
            )
        return UNITS.get(said, self.drawing.unit)

    def _view(self, layer: str, unit: float) -> None:
        known = axes(self.drawing, layer)
        axis = axis_named(self.drawing, self.word("AXIS", known[0].name), layer)
        self.choices["AXIS"] = tuple(dict.fromkeys([*(each.name for each in known), axis.name]))
        front = Front(self.word("FRONT", Front.RIGHT))
        zero = Zero(self.word("ZERO", Zero.FACE))
        shift = self.asked.values.get("SHIFT", 0.0)
        mm = self.asked.setting.mm
        self.view = View(axis, unit, front, zero, 0.0 if isinstance(shift, str) else shift * mm)
        self.nets = contours(self.drawing, self.view, layer)
        self.choices["CONTOUR"] = tuple(str(n) for n in range(1, len(self.nets) + 1))

    def _net(self, layer: str) -> Net:
        if not self.nets or self.view is None:
            template = (
                "{drawing} has no contour on layer {layer}: choose another layer or axis."
                if layer
                else "{drawing} has no contour for the selected axis: choose another layer or axis."
            )
            raise DrawingError(Message(template, drawing=self.drawing.name, layer=layer), "no-contour")
        number = self.word("CONTOUR", "1")
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

    def _check_unit(self, net: Net) -> None:
        """Reject the unit of the file if the contour fits the machine only in another unit."""
        assert self.view is not None
        if "DUNIT" in self.asked.values:
            return
        if (wrong := wrong_unit(net, self.view.unit, self.asked.setting.shop.travel)) is not None:
            words = Message(
                "{drawing} is {wrong}, which is too large for this machine. The drawing fits if its "
                "unit is {wrong2}: choose {wrong3}.",
                drawing=self.drawing.name,
                wrong=wrong[0],
                wrong2=wrong[1],
                wrong3=wrong[1],
            )
            raise DrawingError(words, "wrong-unit")

    def _chosen(self, net: Net) -> Profile:
        assert self.view is not None
        side = Side(self.word("SIDE", Side.OUTSIDE))
        return profile(self.drawing, self.view, net, side)

    def _made(self, chosen: Profile) -> tuple[ProfileProgram, dict[str, Value]]:
        asked = self.asked
        given = {name: asked.values[name] for name in (*_NUMBERS, "MATERIAL") if name in asked.values}
        if "FROM" in given:
            given["BAR"] = given["FROM"]
        now = asked.setting
        fields = proposed_fields(chosen, given, now.shop.tools, metric=now.metric, dialect=now.dialect)
        if chosen.side is Side.INSIDE and not given.get("HOLE"):
            raise DrawingError("Boring needs a predrilled hole: enter its diameter.", "no-hole")
        return profile_program(chosen, fields, asked.lines, asked.setting), fields


_FIELDS = frozenset(
    {"FILE", "DUNIT", "LAYER", "AXIS", "CONTOUR", "FRONT", "ZERO", "SHIFT", "SIDE", *_NUMBERS}
)


def _field_of(word: str) -> str:
    """Return the field of the form that shows a rejection by a shape."""
    return word if word in _FIELDS else "CONTOUR" if word.startswith("#") else "T"


# --- picture ---


def _placed(drawing: Drawing, view: View | None, nets: Sequence[Net], layer: str) -> Iterator[Placed]:
    if view is None:
        return
    layer = "" if layer == ALL else layer
    for number, each in enumerate(drawing.drawn[:_MOST_DRAWN], 1):
        if not layer or each.layer == layer:
            (there,) = on_lathe([each.element], view)
            yield Placed(_polyline(there), number)
    for number, net in enumerate(nets[:60], 1):
        for element in net.elements[:_MOST_DRAWN]:
            yield Placed(_polyline(element), 0, number)


def _polyline(each: Element) -> tuple[tuple[float, float], ...]:
    """Return the (z, r) points of an element, with arcs as chords."""
    if isinstance(each, Line):
        return _turned([each.start, each.end])
    assert isinstance(each, Arc)
    count = max(2, math.ceil(abs(each.sweep) / _CHORD))
    return _turned([each.start, *(each.point(each.length * k / count) for k in range(1, count)), each.end])


def _turned(points: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    return tuple((z, r) for r, z in points)


def pictured(plan: Plan, number: int, comparison: Comparison | None = None) -> Sketch:
    """Return the drawing with its axis and the selected contour, with uncut and wrongly cut parts in red."""
    drawn = [Outline(each.points, "part") for each in plan.placed if each.number]
    outlines = [*drawn, *(Outline(p.points, "far") for p in plan.placed if p.net and p.net != number)]
    here = [Outline(each.points, "cut") for each in plan.placed if each.net == number]
    ends = [z for each in (*outlines, *here) for z, _ in each.points] or [0.0, 1.0]
    room = 0.05 * (max(ends) - min(ends) or 1.0)
    axis = Outline(((min(ends) - room, 0.0), (max(ends) + room, 0.0)), "axis")
    tops = [
        Dim(
            Message("CONTOUR {item}", item=each),
            max((p for o in plan.placed if o.net == each for p in o.points), key=lambda p: p[1]),
        )
        for each in range(1, len(plan.choices.get("CONTOUR", ())) + 1)
        if any(o.net == each for o in plan.placed)
    ]
    left = list(_left(plan, number, comparison))
    return Sketch((axis, *outlines, *here, *left), tuple(tops[:9]))


def _left(plan: Plan, number: int, comparison: Comparison | None) -> Iterator[Outline]:
    """Yield the sections of the contour where the part differs from the drawing."""
    if plan.chosen is None or plan.made is None:
        return
    spans = [(each.back, each.front) for each in plan.made.left]
    if comparison is not None:
        spans = [(each.back - 0.02, each.front + 0.02) for each in comparison.found]
    ends = [z for each in plan.placed if each.net == number for z, _ in each.points]
    shift = (max(ends) if ends else 0.0) - plan.chosen.front
    for each in plan.chosen.elements:
        points = [(z + shift, r) for z, r in _polyline(each)]
        for a, b in pairwise(points):
            low, high = sorted((a[0] - shift, b[0] - shift))
            if any(low < front and high > back for back, front in spans):
                yield Outline((a, b), "left")
