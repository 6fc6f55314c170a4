"""The head of a program: unit, diameter or radius, rapid, where tools change, material, bar, coolant."""

from __future__ import annotations

from dataclasses import replace

from core.extras.shapes.cutting_data import MATERIALS
from core.extras.shapes.lines.code_lines import Code, plain
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import CLEAR, Field, Kind, Proposal, Setting, Value, Values, text
from core.sketch import Dim, Sketch, part, sketch

INCH, MM = "INCH", "METRIC"
DIAMETER, RADIUS = "DIAMETER", "RADIUS"
_YES, _NO = "ON", "OFF"


def _metric(values: Values) -> bool:
    return text(values, "UNIT") == MM


def _length(inch: float, metric: float) -> Proposal:
    def proposed(values: Values, _setting: Setting) -> Value | None:
        return metric if _metric(values) else inch

    return proposed


def _unit(_values: Values, setting: Setting) -> Value | None:
    return MM if setting.metric else INCH


def _cut(filled: Filled, _setting: Setting, code: Code) -> None:
    modes = "G71" if _metric(filled.values) else ""
    modes += "G72" if filled.t("WORDS") == DIAMETER else "G73"
    code.write(f"G90G94F{plain(filled.n('RAPID'))}{modes}")
    if filled.t("COOLANT") == _YES:
        code.write("M08")


def _sketch(_filled: Filled) -> Sketch:
    body = part((0, 0), (0, 10), (-24, 10), (-24, 0))
    return sketch(
        body,
        dims=(Dim("BAR", (-20, -10), (-20, 10)), Dim("CLEAR", (0, 13), (10, 13), 0)),
    )


HEAD = Shape(
    "HEAD",
    "the start of the program: units, diameter programming, rapid rates, material",
    (
        Field("UNIT", "UNIT", Kind.CHOICE, _unit, (INCH, MM)),
        Field("WORDS", "X VALUES", Kind.CHOICE, DIAMETER, (DIAMETER, RADIUS)),
        Field("MATERIAL", "MATERIAL", Kind.CHOICE, "STEEL", tuple(MATERIALS)),
        Field("BAR", "BAR DIAMETER", Kind.DIAMETER, 0.0, zero=True),
        Field("COOLANT", "COOLANT", Kind.CHOICE, _YES, (_YES, _NO)),
        Field("CLEAR", "TOOL CHANGE AT Z", Kind.LENGTH, _length(CLEAR[False], CLEAR[True])),
        Field("RAPID", "RAPID", Kind.RATE, _length(300.0, 7620.0)),
    ),
    _cut,
    _sketch,
)


def _sinumerik(filled: Filled, _setting: Setting, code: Code) -> None:
    unit = "G710" if _metric(filled.values) else "G700"
    code.write(f"G54 G18 G90 G95 {unit} {'DIAMON' if filled.t('WORDS') == DIAMETER else 'DIAMOF'}")
    if filled.t("COOLANT") == _YES:
        code.write("M8")


SINUMERIK_HEAD = replace(
    HEAD, cut=_sinumerik, fields=tuple(each for each in HEAD.fields if each.word != "RAPID")
)
"""The same for a control that knows its rapid: zero offset, plane, unit of F too."""
