"""Program heads and templates (start, roughing, threading, bar feed), and SINUMERIK calculators."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.calculators import SPEED_CALCULATOR, THREAD_CALCULATOR
from core.extras.shapes.common_fields import (
    MAX_RPM,
    find_next_tool_number,
    make_feed_field,
    propose_bar_diameter,
)
from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.cutting_data import (
    CUTTING_DATA,
    Operation,
    propose_finish_allowance,
    propose_roughing_depth,
)
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.forms.bar_work import SINUMERIK_BAR_LOOP_SHAPE, check_chuck_codes
from core.extras.shapes.forms.turning import LABEL_FIELD
from core.extras.shapes.lines.code_lines import (
    BarFeedLoop,
    CodeWriter,
    ContourTurning,
    format_short_number,
    format_sinumerik_number,
    round_depth_up,
    write_bar_feed_loop,
)
from core.extras.shapes.shape_fields import (
    DEFAULT_TOOL_CHANGE_Z,
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    ValueProposal,
    make_length_proposal,
    number,
    text,
)
from core.extras.shapes.threads.threading import write_cycle97
from core.message import Message
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch, make_tool_outline

INCH, MM = "INCH", "METRIC"
DIAMETER, RADIUS = "DIAMETER", "RADIUS"
_YES, _NO = "ON", "OFF"


def _metric(values: FieldValues) -> bool:
    return text(values, "UNIT") == MM


def _length(inch: float, metric: float) -> ValueProposal:
    def propose_length(values: FieldValues, _setting: ProgramSettings) -> FieldValue | None:
        return metric if _metric(values) else inch

    return propose_length


def _unit(_values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    return MM if setting.metric else INCH


def _cut(filled: ShapeInstance, _setting: ProgramSettings, code: CodeWriter) -> None:
    modes = "G71" if _metric(filled.field_values) else ""
    modes += "G72" if filled.get_text("WORDS") == DIAMETER else "G73"
    code.append_lines(f"G90G94F{format_short_number(filled.get_number('RAPID'))}{modes}")
    if filled.get_text("COOLANT") == _YES:
        code.append_lines("M08")


def _sketch(_filled: ShapeInstance) -> Sketch:
    body = make_part_outline((0, 0), (0, 10), (-24, 10), (-24, 0))
    return make_sketch(
        body,
        dimensions=(Dimension("BAR", (-20, -10), (-20, 10)), Dimension("CLEAR", (0, 13), (10, 13), 0)),
    )


HEAD_SHAPE = Shape(
    "HEAD",
    "the start of the program: units, diameter programming, rapid rates, material",
    (
        ShapeField("UNIT", "UNIT", FieldKind.CHOICE, _unit, (INCH, MM)),
        ShapeField("WORDS", "X VALUES", FieldKind.CHOICE, DIAMETER, (DIAMETER, RADIUS)),
        ShapeField("MATERIAL", "MATERIAL", FieldKind.CHOICE, "STEEL", tuple(CUTTING_DATA)),
        ShapeField("BAR", "BAR DIAMETER", FieldKind.DIAMETER, 0.0, allows_zero=True),
        ShapeField("COOLANT", "COOLANT", FieldKind.CHOICE, _YES, (_YES, _NO)),
        ShapeField(
            "CLEAR",
            "TOOL CHANGE AT Z",
            FieldKind.LENGTH,
            _length(DEFAULT_TOOL_CHANGE_Z[False], DEFAULT_TOOL_CHANGE_Z[True]),
        ),
        ShapeField("RAPID", "RAPID", FieldKind.RATE, _length(300.0, 7620.0)),
    ),
    _cut,
    _sketch,
)


def _sinumerik(filled: ShapeInstance, _setting: ProgramSettings, code: CodeWriter) -> None:
    unit = "G710" if _metric(filled.field_values) else "G700"
    code.append_lines(
        f"G54 G18 G90 G95 {unit} {'DIAMON' if filled.get_text('WORDS') == DIAMETER else 'DIAMOF'}"
    )
    if filled.get_text("COOLANT") == _YES:
        code.append_lines("M8")


SINUMERIK_HEAD_SHAPE = replace(
    HEAD_SHAPE,
    write_lines=_sinumerik,
    fields=tuple(each for each in HEAD_SHAPE.fields if each.name != "RAPID"),
)
"""Program head for SINUMERIK, without a rapid speed.

It sets the zero offset, the plane and the unit, including the unit of F.
"""


V60_DEPTH_FACTOR = 0.6134  # depth of a 60-degree thread in pitches, ISO 68-1
_TOOL = ShapeField("T", "TOOL", FieldKind.TOOL, lambda _v, s: float(find_next_tool_number(s)), maximum=32)
_SPEED = ShapeField("RPM", "SPINDLE SPEED, RPM", FieldKind.RPM, 1000.0, maximum=MAX_RPM)
_ACROSS = ShapeField(
    "FROM",
    "DIAMETER",
    FieldKind.DIAMETER,
    lambda v, s: propose_bar_diameter(v, s) or (25.0 if s.metric else 1.0),
)


def _depth(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    return propose_roughing_depth(setting, max(setting.used, default=0), number(values, "FROM"))


def _leave(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
    return propose_finish_allowance(setting, number(values, "ROUGH"))


def _bar(_filled: ShapeInstance) -> Sketch:
    return make_sketch(make_part_outline((0, 0), (0, 6), (-22, 6), (-22, 0)))


def _change(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    if setting.used:  # before the first tool, Z has another zero
        code.write_rapid(z=setting.clear)
    code.write_tool_start(
        filled.get_number("T"), filled.get_number("RPM"), filled.get_number("FROM") / 2.0, setting.near
    )


def _rough(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    r, far = filled.get_number("FROM") / 2.0, 25.0 if setting.metric else 1.0
    code.write_rapid(r, setting.near)
    code.append_lines(f"G95F{format_short_number(filled.get_number('FEED'), 6)}")
    code.append_lines(
        f"G75{code.format_z(filled.get_number('ROUGH'), 'I')}{code.format_z(filled.get_number('LEAVE'), 'U')}"
    )
    code.append_lines(
        code.format_point(0.5 * r, 0.0), code.format_point(None, -0.5 * far), code.format_point(r, None), "RF"
    )


def _rough_sketch(_filled: ShapeInstance) -> Sketch:
    steps = [make_cut_outline((0, r), (-8, r)) for r in (5.5, 5.0, 4.5)]
    return make_sketch(make_part_outline((0, 0), (0, 4), (-8, 4), (-8, 6), (-22, 6), (-22, 0)), *steps)


def _thread(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    r, pitch = filled.get_number("FROM") / 2.0, filled.get_number("PITCH")
    deep = V60_DEPTH_FACTOR * pitch
    first = round_depth_up(deep / 8.0**0.5, is_metric=setting.metric)
    code.write_tool_start(
        filled.get_number("T"), filled.get_number("RPM"), r - first, 3.0 * pitch + setting.near
    )
    code.append_lines(
        f"G33{code.format_x(r - deep)}{code.format_z(-filled.get_number('LONG'))}"
        f"{code.format_x(first, 'I')}K{format_short_number(pitch, 6)}PC"
    )
    code.clear_modal_state()
    code.write_retract()


def _thread_sketch(_filled: ShapeInstance) -> Sketch:
    teeth = [(-k, 6.0 if k % 2 else 5.0) for k in range(12)]
    return make_sketch(make_part_outline((0, 0), *teeth, (-22, 6), (-22, 0)), make_cut_outline(*teeth))


def _loop(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    code.append_lines(f"LS{filled.get_number('COUNT'):.0f}", f"T{filled.get_number('T'):.0f}")
    code.write_rapid(0.0, setting.clear)
    code.write_rapid(z=-filled.get_number("LONG"))
    code.append_lines("M13", f"G94F{500 if setting.metric else 20}{code.format_z(0.0)}", "M12")
    code.clear_modal_state()
    code.write_retract()
    code.append_lines(f"P{filled.get_number('SUB'):.0f}", "LF")


def _loop_end(filled: ShapeInstance) -> tuple[str, ...]:
    return f"}}{filled.get_number('SUB'):.0f}", "M99"


def _loop_sketch(_filled: ShapeInstance) -> Sketch:
    return make_sketch(
        make_part_outline((0, 0), (0, 6), (-30, 6), (-30, 0)),
        make_tool_outline((1, -3), (1, 3), (4, 3), (4, -3)),
    )


START_TEMPLATE = Shape(
    "START OF PROGRAM",
    "units, diameter programming, rapid rates, coolant",
    HEAD_SHAPE.fields,
    HEAD_SHAPE.write_lines,
    HEAD_SHAPE.make_sketch,
    has_comment=False,
)
TOOL_CHANGE_TEMPLATE = Shape(
    "TOOL CHANGE",
    "retracts, changes the tool, starts the spindle and moves to the part",
    (_TOOL, _SPEED, _ACROSS),
    _change,
    _bar,
    has_comment=False,
)
ROUGHING_TEMPLATE = Shape(
    "G75 ROUGHING",
    "makes roughing passes down to a contour whose points you edit by hand",
    (
        _ACROSS,
        ShapeField("ROUGH", "ROUGHING DEPTH OF CUT", FieldKind.LENGTH, _depth),
        ShapeField("LEAVE", "FINISHING ALLOWANCE", FieldKind.LENGTH, _leave, allows_zero=True),
        make_feed_field(Operation.TURN),
    ),
    _rough,
    _rough_sketch,
    has_comment=False,
)
THREADING_TEMPLATE = Shape(
    "THREAD G33",
    "calls the tool, leads in, cuts passes with a constant chip cross-section, and pulls out",
    (
        _TOOL,
        _SPEED,
        _ACROSS,
        ShapeField("PITCH", "PITCH", FieldKind.LENGTH, make_length_proposal(0.05, 1.5)),
        ShapeField("LONG", "LENGTH", FieldKind.LENGTH, make_length_proposal(0.5, 12.0)),
    ),
    _thread,
    _thread_sketch,
    has_comment=False,
)
BAR_FEED_TEMPLATE = Shape(
    "BAR FEED LOOP",
    "positions a stop, opens the collet and feeds the bar, with the part program as a subroutine",
    (
        ShapeField("COUNT", "PARTS", FieldKind.COUNT, 10.0, maximum=100_000),
        _TOOL,
        ShapeField(
            "LONG", "BAR LENGTH PER PART + CUT-OFF", FieldKind.LENGTH, make_length_proposal(1.0, 25.0)
        ),
        ShapeField(
            "SUB",
            "PART SUBROUTINE NUMBER",
            FieldKind.COUNT,
            lambda _v, s: float(s.free_subroutine_number),
            maximum=9999,
        ),
    ),
    _loop,
    _loop_sketch,
    make_program_end_lines=_loop_end,
    has_comment=False,
)


_BAR_RATE = {False: 20.0, True: 500.0}  # by metric, feed per minute


def _speed(filled: ShapeInstance, _setting: ProgramSettings, code: CodeWriter) -> None:
    code.append_lines(
        f"G95 S{format_sinumerik_number(filled.get_number('RPM'), 0)} M3 "
        f"F{format_sinumerik_number(filled.get_number('FEED'), 6)}"
    )


def _make_speed_remarks(filled_shape: ShapeInstance, settings: ProgramSettings) -> tuple[str, ...]:
    """Return the notes of the speed calculator, with the feed per minute in the syntax of SINUMERIK."""
    _, *others = SPEED_CALCULATOR.make_notes(filled_shape, settings)
    return Message(
        "equivalent feed per minute: G94 F{number}",
        number=format_sinumerik_number(filled_shape.get_number("RATE"), 3),
    ), *others


def _run_up(filled_shape: ShapeInstance, settings: ProgramSettings) -> ShapeInstance:
    """Return the shape with a run-up of three pitches, in which the axis reaches its feed rate."""
    return replace(
        filled_shape,
        field_values={
            **filled_shape.field_values,
            "RUNUP": 3.0 * filled_shape.get_number("PITCH") + settings.near,
        },
    )


def _passes(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    write_cycle97(_run_up(filled, setting), code)


def _make_pass_remarks(filled_shape: ShapeInstance, settings: ProgramSettings) -> tuple[str, ...]:
    """Return the notes of the thread calculator, without a note about the start position.

    CYCLE97 moves to its first pass automatically.
    """
    depth, _, passes = THREAD_CALCULATOR.make_notes(filled_shape, settings)
    return depth, passes


def _sinumerik_rough(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    across, long = filled.get_number("FROM"), 12.5 if setting.metric else 0.5
    code.write_rapid(across / 2.0, setting.near)
    rows = (ContourPoint(across / 2.0, 0.0), ContourPoint(z=-long), ContourPoint(across))
    feed, rough, leave = (filled.get_number(word) for word in ("FEED", "ROUGH", "LEAVE"))
    code.write_contour_turning(
        ContourTurning(rows, across / 2.0, False, feed, rough, leave, feed, 0.0, filled.get_number("LABEL"))
    )
    code.write_retract()


def _sinumerik_thread(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    crest = filled.get_number("FROM")
    root = crest - 2.0 * V60_DEPTH_FACTOR * filled.get_number("PITCH")
    values = {**filled.field_values, "CREST": crest, "ROOT": root, "PASSES": 8.0, "INFEED": 29.0}
    whole = _run_up(replace(filled, field_values=values), setting)
    code.write_tool_start(
        filled.get_number("T"), filled.get_number("RPM"), crest / 2.0, whole.get_number("RUNUP")
    )
    write_cycle97(whole, code)
    code.write_retract()


def _bar_feed(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    many, long, stop, part = (filled.get_number(word) for word in ("COUNT", "LONG", "T", "SUB"))
    rate = _BAR_RATE[setting.metric]
    write_bar_feed_loop(code, BarFeedLoop(int(many), long, True, stop, 0.0, rate, int(part)))


def _bar_feed_checks(_filled: ShapeInstance, setting: ProgramSettings) -> Iterator[FieldError]:
    return check_chuck_codes(setting, "COUNT")


SINUMERIK_SPEED_CALCULATOR = replace(SPEED_CALCULATOR, write_lines=_speed, make_notes=_make_speed_remarks)
SINUMERIK_THREAD_CALCULATOR = replace(THREAD_CALCULATOR, write_lines=_passes, make_notes=_make_pass_remarks)
SINUMERIK_START_TEMPLATE = replace(
    START_TEMPLATE, fields=SINUMERIK_HEAD_SHAPE.fields, write_lines=SINUMERIK_HEAD_SHAPE.write_lines
)
SINUMERIK_ROUGHING_TEMPLATE = replace(
    ROUGHING_TEMPLATE,
    name="CYCLE95 ROUGHING",
    write_lines=_sinumerik_rough,
    fields=(*ROUGHING_TEMPLATE.fields, LABEL_FIELD),
)
SINUMERIK_THREADING_TEMPLATE = replace(
    THREADING_TEMPLATE,
    name="THREAD CYCLE97",
    summary="calls the tool, leads in, and cuts passes with a constant chip cross-section",
    write_lines=_sinumerik_thread,
)
SINUMERIK_BAR_FEED_TEMPLATE = replace(
    BAR_FEED_TEMPLATE,
    write_lines=_bar_feed,
    find_field_conflicts=_bar_feed_checks,
    make_program_end_lines=SINUMERIK_BAR_LOOP_SHAPE.make_program_end_lines,
)
