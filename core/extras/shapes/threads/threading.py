"""Thread shape, defined by series, size and class or by dimensions.

The thread is outside or in a bore, and may be tapered or multi-start.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

from core.extras.shapes.common_fields import MAX_RPM, make_tool_field
from core.extras.shapes.editor_shape import Shape, ShapeInstance
from core.extras.shapes.lines.code_lines import (
    CodeWriter,
    format_short_number,
    format_sinumerik_number,
    round_depth_up,
)
from core.extras.shapes.shape_fields import FieldKind, ProgramSettings, ShapeField, text
from core.extras.shapes.threads.thread_series import (
    TAPERED_SERIES,
    ThreadSeries,
    convert_length,
    list_tolerance_classes,
)
from core.extras.shapes.threads.thread_values import (
    G35_LEAD_LIMITS_IN,
    INSIDE,
    LEFT,
    NO,
    OUTSIDE,
    RIGHT,
    YES,
    calculate_thread_depth,
    check_thread,
    check_thread_name,
    find_coarse_feed_step,
    find_thread_limits,
    get_thread_series,
    has_standard_series,
    list_side_tolerance_classes,
    make_diameter_proposal,
    propose_infeed_angle,
    propose_pass_count,
    propose_pitch,
    propose_run_up,
    propose_thread_length,
    propose_thread_taper,
    propose_threading_rpm,
    propose_tolerance_class,
)
from core.message import Message
from core.part.tool_shape import ToolKind
from core.sketch import Dimension, Sketch, make_cut_outline, make_part_outline, make_sketch


def calculate_first_depth(filled_shape: ShapeInstance) -> float:
    """Return the depth per side of the first pass, for passes of equal chip area.

    The depth is the depth of the thread divided by √N for N passes.
    """
    return calculate_thread_depth(filled_shape) / math.sqrt(max(1.0, filled_shape.get_number("PASSES")))


def round_first_depth(filled_shape: ShapeInstance, settings: ProgramSettings) -> float:
    """Return the depth of the first pass, rounded up to the resolution of its program word."""
    deep, coarse = calculate_first_depth(filled_shape), find_coarse_feed_step(filled_shape, settings)
    return (
        math.ceil(deep / coarse - 1e-6) * coarse
        if coarse
        else round_depth_up(deep, is_metric=settings.metric)
    )


def _cycle97(filled_shape: ShapeInstance, _settings: ProgramSettings, code: CodeWriter) -> None:
    """Write a thread with CYCLE97.

    The cycle stops at the end of the thread and therefore needs a relief groove.
    """
    crest, far = filled_shape.get_number("CREST"), _far(filled_shape)
    turns = "M04" if filled_shape.get_text("HAND") == LEFT else "M03"
    inside = filled_shape.get_text("SIDE") == INSIDE
    code.write_tool_start(
        filled_shape.get_number("T"),
        filled_shape.get_number("RPM"),
        0.0 if inside else max(crest, far) / 2.0,
        None,
        turns,
    )
    code.write_rapid(z=filled_shape.get_number("RUNUP") - filled_shape.get_number("AT"))
    write_cycle97(filled_shape, code)
    code.write_retract()


def _far(filled_shape: ShapeInstance) -> float:
    """Return the diameter before threading at the far end of the thread.

    For a tapered thread it differs from the diameter at the start.
    """
    outwards = -1.0 if filled_shape.get_text("SIDE") == INSIDE else 1.0
    return filled_shape.get_number("CREST") + outwards * filled_shape.get_number(
        "TAPER"
    ) * filled_shape.get_number("LONG")


def write_cycle97(filled_shape: ShapeInstance, code: CodeWriter) -> None:
    """Write CYCLE97 with passes of equal chip area."""
    starts = max(1.0, filled_shape.get_number("STARTS"))
    begin, end = (
        -filled_shape.get_number("AT"),
        -(filled_shape.get_number("AT") + filled_shape.get_number("LONG")),
    )
    ends = (
        begin,
        end,
        filled_shape.get_number("CREST"),
        _far(filled_shape),
        filled_shape.get_number("RUNUP"),
        0.0,
    )
    depth, angle, passes = (
        calculate_thread_depth(filled_shape),
        filled_shape.get_number("INFEED"),
        math.ceil(filled_shape.get_number("PASSES") - 1e-6),
    )
    kind = 4.0 if filled_shape.get_text("SIDE") == INSIDE else 3.0
    parameters = (*ends, depth, 0.0, angle, 0.0, passes, 0.0, kind, starts)
    words = (
        format_sinumerik_number(filled_shape.get_number("PITCH") * starts, 6),
        "",
        *map(format_sinumerik_number, parameters),
    )
    code.append_lines(f"CYCLE97({', '.join(words)})")
    code.clear_modal_state()


def _thread(filled: ShapeInstance, setting: ProgramSettings, code: CodeWriter) -> None:
    inside = filled.get_text("SIDE") == INSIDE
    outwards = -1.0 if inside else 1.0
    near = partial(_on_step, step=find_coarse_feed_step(filled, setting))
    starts = max(1, int(filled.get_number("STARTS")))
    lead, first = filled.get_number("PITCH") * starts, round_first_depth(filled, setting)
    begin, end = (
        filled.get_number("RUNUP") - filled.get_number("AT"),
        -(filled.get_number("AT") + filled.get_number("LONG")),
    )
    taper = filled.get_number("TAPER") / 2.0  # taper of the radius
    down = -outwards * taper * filled.get_number("RUNUP")  # radius change at the start of a pass
    crest, root = filled.get_number("CREST") / 2.0 + down, filled.get_number("ROOT") / 2.0 + down
    at, root, begin, end = near(crest - outwards * first), near(root), near(begin), near(end)
    turns = "M04" if filled.get_text("HAND") == LEFT else "M03"
    clear = near(at + outwards * 3.0 * first)
    code.write_tool_start(filled.get_number("T"), filled.get_number("RPM"), clear, begin, turns)
    coarse = lead * setting.mm / 25.4 > G35_LEAD_LIMITS_IN[0]
    for k in range(starts):
        start_z = near(begin + k * filled.get_number("PITCH"))
        on_cone = -outwards * taper * k * filled.get_number("PITCH")  # the same cone, started farther away
        code.write_rapid(near(at + on_cone), start_z if k else None)
        if coarse and k == 0:
            f2 = "F2" if lead * setting.mm / 25.4 > G35_LEAD_LIMITS_IN[1] else ""
            code.append_lines(f"G35{f2}", f"G92{code.format_point(at, start_z)}")
        words = (
            f"G33{code.format_x(near(root + on_cone))}{code.format_z(end)}"
            f"{code.format_x(first, 'I')}K{format_short_number(lead, 6)}"
        )
        if taper:
            far = (begin + k * filled.get_number("PITCH") - end) * taper * outwards
            words += code.format_x(far, "A")
        words += "P" if filled.get_text("PULL") == YES else ""
        words += (
            ""
            if not filled.get_number("INFEED")
            else "C"
            if filled.get_number("INFEED") == 29.0
            else f"C{format_short_number(filled.get_number('INFEED'))}"
        )
        code.append_lines(words)
    if coarse:
        if starts > 1:
            code.write_rapid(z=begin)
        code.append_lines("G36", f"G92{code.format_point(at, begin)}")
    code.clear_modal_state()
    code.write_rapid(clear)
    code.write_retract()


def _make_remarks(filled_shape: ShapeInstance, settings: ProgramSettings) -> tuple[str, ...]:
    """Return notes about the measured diameters and about the taper to turn before threading."""
    known = find_thread_limits(filled_shape.field_values, settings)
    if known is None:
        return ()
    places = 3 if settings.metric else 4
    unit = convert_length(1.0, get_thread_series(filled_shape.field_values), is_metric=settings.metric)
    inside = filled_shape.get_text("SIDE") == INSIDE
    pairs = (known.minor_diameter if inside else known.major_diameter, known.pitch_diameter)
    least, most, low, high = (format_short_number(value * unit, places) for pair in pairs for value in pair)
    if get_thread_series(filled_shape.field_values) in TAPERED_SERIES:
        far = format_short_number(_far(filled_shape), places)
        return (
            Message("pitch diameter {low} at the start of the thread", low=low),
            (
                Message(
                    "taper before threading: diameter {number} at the start, {distance} at the end",
                    number=format_short_number(filled_shape.get_number("CREST"), places),
                    distance=far,
                )
            ),
        )
    if inside:
        return (
            Message(
                "minor diameter {minimum} to {maximum}, pitch diameter {low} to {high}",
                minimum=least,
                maximum=most,
                low=low,
                high=high,
            ),
        )
    return (
        Message(
            "major diameter {minimum} to {maximum}, pitch diameter {low} to {high}",
            minimum=least,
            maximum=most,
            low=low,
            high=high,
        ),
    )


def _on_step(value: float, step: float) -> float:
    return round(value / step) * step if step else value


def _sketch(filled: ShapeInstance) -> Sketch:
    teeth: list[tuple[float, float]] = [(0.0, 6.6)]
    for k in range(7):
        teeth += [(-1.0 - 2 * k, 8.0), (-2.0 - 2 * k, 6.6)]
    relief = (
        [(-14.0, 6.0), (-17.0, 6.0), (-17.0, 10.0)]
        if filled.get_number("RELIEF")
        else [(-14.6, 8.0), (-17, 8.0), (-17, 10)]
    )
    inside = filled.get_text("SIDE") == INSIDE
    solid = (
        make_part_outline((0, 0), *teeth, *relief, (-24, 10), (-24, 0))
        if not inside
        else make_part_outline(
            (0, 13), (0, 8), *((z, 14.6 - r) for z, r in teeth[1:]), (-15, 6.6), (-24, 6.6), (-24, 13)
        )
    )
    crest, root = (6.6, 8.0) if inside else (8.0, 6.6)
    return make_sketch(
        solid,
        make_cut_outline(*(teeth if not inside else [(z, 14.6 - r) for z, r in teeth])),
        dimensions=(
            Dimension("CREST", (-5, -crest), (-5, crest)),
            Dimension("ROOT", (-10, -root), (-10, root)),
            Dimension("LONG", (-14, 13), (0, 13), 2),
            Dimension("RUNUP", (0, 13), (5, 13), 2),
            Dimension("PITCH", (-3, 9.6)),
            Dimension("SIZE", (-19, 4)),
            *((Dimension("RELIEF", (-15.5, 4.5)),) if filled.get_number("RELIEF") else ()),
        ),
    )


_ALL_CLASSES = tuple(
    dict.fromkeys(
        c
        for s in ThreadSeries
        for inside in (False, True)
        for c in list_tolerance_classes(s, is_inside=inside)
    )
)

THREAD_SHAPE = Shape(
    "THREAD",
    "a thread defined by series, size and class (UNC, UNF, M, NPT, BSP, ACME) or by custom dimensions",
    (
        make_tool_field(ToolKind.THREADING),
        ShapeField(
            "SERIES",
            "SERIES",
            FieldKind.CHOICE,
            ThreadSeries.UNC.value,
            tuple(each.value for each in ThreadSeries),
        ),
        ShapeField("SIZE", "SIZE", FieldKind.NAME, None, applies_to=has_standard_series),
        ShapeField("SIDE", "SIDE", FieldKind.CHOICE, OUTSIDE, (OUTSIDE, INSIDE)),
        ShapeField(
            "CLASS",
            "CLASS",
            FieldKind.CHOICE,
            propose_tolerance_class,
            _ALL_CLASSES,
            applies_to=lambda v: bool(list_side_tolerance_classes(v)),
        ),
        ShapeField("LONG", "LENGTH", FieldKind.LENGTH, propose_thread_length),
        ShapeField("AT", "DISTANCE FROM Z0 TO START", FieldKind.LENGTH, 0.0, allows_zero=True),
        ShapeField("PULL", "PULL OUT WHILE FEEDING", FieldKind.CHOICE, YES, (YES, NO)),
        ShapeField(
            "RELIEF",
            "RELIEF WIDTH",
            FieldKind.LENGTH,
            0.0,
            allows_zero=True,
            applies_to=lambda v: text(v, "PULL") == NO,
        ),
        ShapeField("PITCH", "PITCH", FieldKind.LENGTH, propose_pitch),
        ShapeField("STARTS", "STARTS", FieldKind.COUNT, 1.0, maximum=24),
        ShapeField("HAND", "HAND", FieldKind.CHOICE, RIGHT, (RIGHT, LEFT)),
        ShapeField("CREST", "DIAMETER BEFORE THREADING", FieldKind.DIAMETER, make_diameter_proposal("crest")),
        ShapeField("ROOT", "DIAMETER AT LAST PASS", FieldKind.DIAMETER, make_diameter_proposal("root")),
        ShapeField(
            "TAPER",
            "TAPER ON THE DIAMETER",
            FieldKind.RATIO,
            propose_thread_taper,
            allows_zero=True,
            maximum=1.0,
        ),
        ShapeField("PASSES", "PASSES", FieldKind.COUNT, propose_pass_count, maximum=60),
        ShapeField(
            "INFEED", "INFEED ANGLE", FieldKind.ANGLE, propose_infeed_angle, maximum=30.0, allows_zero=True
        ),
        ShapeField("RPM", "SPINDLE SPEED, RPM", FieldKind.RPM, propose_threading_rpm, maximum=MAX_RPM),
        ShapeField("RUNUP", "RUN-UP", FieldKind.LENGTH, propose_run_up),
    ),
    _thread,
    _sketch,
    check_thread,
    find_blocking_errors=check_thread_name,
    make_notes=_make_remarks,
)


def _of_cycle97(each: ShapeField) -> ShapeField:
    return replace(each, applies_to=lambda _values: True) if each.name == "RELIEF" else each


SINUMERIK_THREAD_SHAPE = replace(
    THREAD_SHAPE,
    write_lines=_cycle97,
    fields=tuple(_of_cycle97(each) for each in THREAD_SHAPE.fields if each.name != "PULL"),
)
"""Threading form for SINUMERIK, with CYCLE97.

The cycle stops at the end of the thread, so the thread needs a relief groove.
"""
