"""Bar feed and loop: a number of parts off one bar, fed to a stop for each, or once and shifted by G10."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from core.extras.shapes.lines.code_lines import Bars, Code, write_bars
from core.extras.shapes.shape import Filled, Shape
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, Values, size
from core.extras.shapes.usual_fields import next_tool
from core.sketch import Dim, Outline, Sketch, part, sketch, tool

EACH, ONCE = "EACH PART", "ONCE"


def _sub(_values: Values, setting: Setting) -> Value | None:
    return float(setting.free_sub)


def _loop(filled: Filled, _setting: Setting, code: Code) -> None:
    write_bars(
        code,
        Bars(
            int(filled.n("COUNT")), filled.n("LONG"), filled.t("FEEDS") == EACH, filled.n("STOP"),
            filled.n("STOCK"), filled.n("RATE"), int(filled.n("SUB")),
        )
    )  # fmt: skip


def _checks(_filled: Filled, setting: Setting) -> Iterator[Refusal]:
    if setting.called:
        yield Refusal(
            "COUNT",
            "A bar feed loop cannot be inside another bar feed loop: write this shape "
            "before or after the other loop.",
        )


def _sketch(_filled: Filled) -> Sketch:
    bar = part((0, 0), (0, 7), (-30, 7), (-30, 0))
    cuts = [Outline(((z, 0.0), (z, 7.0)), "cut") for z in (-8, -16, -24)]
    return sketch(
        bar,
        *cuts,
        tool((1, -3), (1, 3), (4, 3), (4, -3)),
        dims=(
            Dim("LONG", (-16, 7), (-8, 7), 3),
            Dim("COUNT", (-20, -4)),
            Dim("STOCK", (0, 10)),
            Dim("STOP", (5, -5)),
        ),
    )


def _tail(filled: Filled) -> tuple[str, ...]:
    return f"}}{filled.n('SUB'):.0f}", "M99"


LOOP = Shape(
    "BAR LOOP",
    "feeds the bar to a stop and repeats the following lines for a number of "
    "parts; these lines make the part",
    (
        Field("COUNT", "PARTS", Kind.COUNT, None, most=100_000),
        Field("LONG", "BAR LENGTH PER PART + CUT-OFF", Kind.LENGTH),
        Field("FEEDS", "FEED THE BAR", Kind.CHOICE, EACH, (EACH, ONCE)),
        Field("STOP", "TOOL USED AS STOP", Kind.TOOL, lambda _v, s: float(next_tool(s)), most=32),
        Field("STOCK", "FACING ALLOWANCE", Kind.LENGTH, size(0.025, 0.6), zero=True),
        Field("RATE", "BAR FEED PER MINUTE", Kind.RATE, size(50.0, 1200.0)),
        Field("SUB", "PART SUBROUTINE NUMBER", Kind.COUNT, _sub, most=9999),
    ),
    _loop,
    _sketch,
    _checks,
    ends=_tail,
)


def no_chuck(setting: Setting, word: str) -> Iterator[Refusal]:
    """A machine on which a SINUMERIK program cannot open the chuck; told at this field."""
    if setting.shop.chuck is None:
        yield Refusal(
            word,
            "This machine has no M codes that open and close the chuck: assign two M codes "
            "to the output named collet under [m_codes] in the machine file.",
        )


def _sinumerik_checks(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    yield from no_chuck(setting, "FEEDS")
    yield from _checks(filled, setting)


def _sinumerik_tail(filled: Filled) -> tuple[str, ...]:
    return f"%_N_PART_{filled.n('SUB'):.0f}_SPF", "M17"


SINUMERIK_LOOP = replace(LOOP, checks=_sinumerik_checks, ends=_sinumerik_tail)
"""The same with a subprogram, and M codes of the machine's own for the chuck."""
