"""Templates of the editor: lines that begin a program, change a tool, rough, thread, feed a bar."""

from __future__ import annotations

from core.extras.shapes.cutting_data import Work
from core.extras.shapes.cutting_depth import finish_depth, rough_depth
from core.extras.shapes.forms.program_head import HEAD
from core.extras.shapes.lines.code_lines import Code
from core.extras.shapes.number_words import plain, rounded_up
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Value, Values, number, size
from core.extras.shapes.shape_setting import Setting
from core.extras.shapes.usual_fields import MOST_RPM, bar, feed_field, next_tool
from core.sketch import Sketch, cut, part, sketch, tool

V60_DEEP = 0.6134  # of a thread of 60 degrees, in pitches; ISO 68-1
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
    if setting.used:  # before the first tool Z counts from another place
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
