"""Program heads and templates, and calculators for SINUMERIK: start, rough, thread and bar feed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.calculators import SPEED, THREADS
from core.extras.shapes.contour import Row
from core.extras.shapes.cutting_data import MATERIALS, Work, finish_depth, rough_depth
from core.extras.shapes.forms.bar_work import SINUMERIK_LOOP, no_chuck
from core.extras.shapes.forms.turning import LABEL
from core.extras.shapes.lines.code_lines import Along, Bars, Code, figure, plain, rounded_up, write_bars
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import (
    CLEAR,
    Field,
    Kind,
    Proposal,
    Refusal,
    Setting,
    Value,
    Values,
    number,
    size,
    text,
)
from core.extras.shapes.threads.threading import write_cycle97
from core.extras.shapes.usual_fields import MOST_RPM, bar, feed_field, next_tool
from core.message import Message
from core.sketch import Dim, Sketch, cut, part, sketch, tool

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


V60_DEEP = 0.6134  # depth of a 60-degree thread in pitches, ISO 68-1
_TOOL = Field("T", "TOOL", Kind.TOOL, lambda _v, s: float(next_tool(s)), most=32)
_SPEED = Field("RPM", "SPINDLE SPEED, RPM", Kind.RPM, 1000.0, most=MOST_RPM)
_ACROSS = Field("FROM", "DIAMETER", Kind.DIAMETER, lambda v, s: bar(v, s) or (25.0 if s.metric else 1.0))


def _depth(values: Values, setting: Setting) -> Value | None:
    return rough_depth(setting, max(setting.used, default=0), number(values, "FROM"))


def _leave(values: Values, setting: Setting) -> Value | None:
    return finish_depth(setting, number(values, "ROUGH"))


def _bar(_filled: Filled) -> Sketch:
    return sketch(part((0, 0), (0, 6), (-22, 6), (-22, 0)))


def _change(filled: Filled, setting: Setting, code: Code) -> None:
    if setting.used:  # before the first tool, Z has another zero
        code.rapid(z=setting.clear)
    code.begin(filled.n("T"), filled.n("RPM"), filled.n("FROM") / 2.0, setting.near)


def _rough(filled: Filled, setting: Setting, code: Code) -> None:
    r, far = filled.n("FROM") / 2.0, 25.0 if setting.metric else 1.0
    code.rapid(r, setting.near)
    code.write(f"G95F{plain(filled.n('FEED'), 6)}")
    code.write(f"G75{code.z(filled.n('ROUGH'), 'I')}{code.z(filled.n('LEAVE'), 'U')}")
    code.write(code.point(0.5 * r, 0.0), code.point(None, -0.5 * far), code.point(r, None), "RF")


def _rough_sketch(_filled: Filled) -> Sketch:
    steps = [cut((0, r), (-8, r)) for r in (5.5, 5.0, 4.5)]
    return sketch(part((0, 0), (0, 4), (-8, 4), (-8, 6), (-22, 6), (-22, 0)), *steps)


def _thread(filled: Filled, setting: Setting, code: Code) -> None:
    r, pitch = filled.n("FROM") / 2.0, filled.n("PITCH")
    deep = V60_DEEP * pitch
    first = rounded_up(deep / 8.0**0.5, metric=setting.metric)
    code.begin(filled.n("T"), filled.n("RPM"), r - first, 3.0 * pitch + setting.near)
    code.write(f"G33{code.x(r - deep)}{code.z(-filled.n('LONG'))}{code.x(first, 'I')}K{plain(pitch, 6)}PC")
    code.forget()
    code.away()


def _thread_sketch(_filled: Filled) -> Sketch:
    teeth = [(-k, 6.0 if k % 2 else 5.0) for k in range(12)]
    return sketch(part((0, 0), *teeth, (-22, 6), (-22, 0)), cut(*teeth))


def _loop(filled: Filled, setting: Setting, code: Code) -> None:
    code.write(f"LS{filled.n('COUNT'):.0f}", f"T{filled.n('T'):.0f}")
    code.rapid(0.0, setting.clear)
    code.rapid(z=-filled.n("LONG"))
    code.write("M13", f"G94F{500 if setting.metric else 20}{code.z(0.0)}", "M12")
    code.forget()
    code.away()
    code.write(f"P{filled.n('SUB'):.0f}", "LF")


def _loop_end(filled: Filled) -> tuple[str, ...]:
    return f"}}{filled.n('SUB'):.0f}", "M99"


def _loop_sketch(_filled: Filled) -> Sketch:
    return sketch(part((0, 0), (0, 6), (-30, 6), (-30, 0)), tool((1, -3), (1, 3), (4, 3), (4, -3)))


START = Shape(
    "START OF PROGRAM",
    "units, diameter programming, rapid rates, coolant",
    HEAD.fields,
    HEAD.cut,
    HEAD.sketch,
    noted=False,
)
TOOL_CHANGE = Shape(
    "TOOL CHANGE",
    "retracts, changes the tool, starts the spindle and moves to the part",
    (_TOOL, _SPEED, _ACROSS),
    _change,
    _bar,
    noted=False,
)
ROUGH = Shape(
    "G75 ROUGHING",
    "makes roughing passes down to a contour whose points you edit by hand",
    (
        _ACROSS,
        Field("ROUGH", "ROUGHING DEPTH OF CUT", Kind.LENGTH, _depth),
        Field("LEAVE", "FINISHING ALLOWANCE", Kind.LENGTH, _leave, zero=True),
        feed_field(Work.TURN),
    ),
    _rough,
    _rough_sketch,
    noted=False,
)
THREADING = Shape(
    "THREAD G33",
    "calls the tool, leads in, cuts passes with a constant chip cross-section, and pulls out",
    (
        _TOOL,
        _SPEED,
        _ACROSS,
        Field("PITCH", "PITCH", Kind.LENGTH, size(0.05, 1.5)),
        Field("LONG", "LENGTH", Kind.LENGTH, size(0.5, 12.0)),
    ),
    _thread,
    _thread_sketch,
    noted=False,
)
BAR_FEED = Shape(
    "BAR FEED LOOP",
    "positions a stop, opens the collet and feeds the bar, with the part program as a subroutine",
    (
        Field("COUNT", "PARTS", Kind.COUNT, 10.0, most=100_000),
        _TOOL,
        Field("LONG", "BAR LENGTH PER PART + CUT-OFF", Kind.LENGTH, size(1.0, 25.0)),
        Field("SUB", "PART SUBROUTINE NUMBER", Kind.COUNT, lambda _v, s: float(s.free_sub), most=9999),
    ),
    _loop,
    _loop_sketch,
    ends=_loop_end,
    noted=False,
)


_BAR_RATE = {False: 20.0, True: 500.0}  # by metric, feed per minute


def _speed(filled: Filled, _setting: Setting, code: Code) -> None:
    code.write(f"G95 S{figure(filled.n('RPM'), 0)} M3 F{figure(filled.n('FEED'), 6)}")


def _speed_says(filled: Filled, setting: Setting) -> tuple[str, ...]:
    """Return the notes with the feed per minute in the syntax of SINUMERIK."""
    _, *others = SPEED.says(filled, setting)
    return Message("equivalent feed per minute: G94 F{number}", number=figure(filled.n("RATE"), 3)), *others


def _run_up(filled: Filled, setting: Setting) -> Filled:
    """Return the shape with a run-up of three pitches, in which the axis reaches the lead."""
    return replace(filled, values={**filled.values, "RUNUP": 3.0 * filled.n("PITCH") + setting.near})


def _passes(filled: Filled, setting: Setting, code: Code) -> None:
    write_cycle97(_run_up(filled, setting), code)


def _passes_say(filled: Filled, setting: Setting) -> tuple[str, ...]:
    """Return the notes without the start position.

    The cycle moves to its first pass automatically.
    """
    depth, _, passes = THREADS.says(filled, setting)
    return depth, passes


def _sinumerik_rough(filled: Filled, setting: Setting, code: Code) -> None:
    across, long = filled.n("FROM"), 12.5 if setting.metric else 0.5
    code.rapid(across / 2.0, setting.near)
    rows = (Row(across / 2.0, 0.0), Row(z=-long), Row(across))
    feed, rough, leave = (filled.n(word) for word in ("FEED", "ROUGH", "LEAVE"))
    code.along(Along(rows, across / 2.0, False, feed, rough, leave, feed, 0.0, filled.n("LABEL")))
    code.away()


def _sinumerik_thread(filled: Filled, setting: Setting, code: Code) -> None:
    crest = filled.n("FROM")
    root = crest - 2.0 * V60_DEEP * filled.n("PITCH")
    values = {**filled.values, "CREST": crest, "ROOT": root, "PASSES": 8.0, "INFEED": 29.0}
    whole = _run_up(replace(filled, values=values), setting)
    code.begin(filled.n("T"), filled.n("RPM"), crest / 2.0, whole.n("RUNUP"))
    write_cycle97(whole, code)
    code.away()


def _bar_feed(filled: Filled, setting: Setting, code: Code) -> None:
    many, long, stop, part = (filled.n(word) for word in ("COUNT", "LONG", "T", "SUB"))
    rate = _BAR_RATE[setting.metric]
    write_bars(code, Bars(int(many), long, True, stop, 0.0, rate, int(part)))


def _bar_feed_checks(_filled: Filled, setting: Setting) -> Iterator[Refusal]:
    return no_chuck(setting, "COUNT")


SINUMERIK_SPEED = replace(SPEED, cut=_speed, says=_speed_says)
SINUMERIK_THREADS = replace(THREADS, cut=_passes, says=_passes_say)
SINUMERIK_START = replace(START, fields=SINUMERIK_HEAD.fields, cut=SINUMERIK_HEAD.cut)
SINUMERIK_ROUGH = replace(ROUGH, name="CYCLE95 ROUGHING", cut=_sinumerik_rough, fields=(*ROUGH.fields, LABEL))
SINUMERIK_THREADING = replace(
    THREADING,
    name="THREAD CYCLE97",
    use="calls the tool, leads in, and cuts passes with a constant chip cross-section",
    cut=_sinumerik_thread,
)
SINUMERIK_BAR_FEED = replace(BAR_FEED, cut=_bar_feed, checks=_bar_feed_checks, ends=SINUMERIK_LOOP.ends)
