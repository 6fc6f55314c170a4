"""Fields used by many shapes, such as tool, speed, feed and bar diameter, with their proposals."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from core.extras.shapes import cutting_data
from core.extras.shapes.cutting_data import Work
from core.extras.shapes.shape import Filled
from core.extras.shapes.shape_fields import Field, Kind, Refusal, Setting, Value, Values, number
from core.message import Message
from core.part.tool_shape import ToolKind

_MOST_TOOL = 32
MOST_RPM = 100_000.0


def tool_field(*kinds: ToolKind) -> Field:
    """Return a tool field that proposes the first unused tool of these kinds, or else the next number."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        inside = values.get("SIDE") == "BORE" or kinds == (ToolKind.BORING,)
        sheets = sorted(setting.shop.tools.items())
        fits = [n for n, shape in sheets if shape.kind in kinds and shape.internal is inside]
        fits = [n for n in fits if setting.shop.tools[n].behind is (values.get("SIDE") == "REAR")] or fits
        fresh = [n for n in fits if n not in setting.used]
        return float((fresh or fits)[0] if fits else next_tool(setting))

    return Field("T", "TOOL", Kind.TOOL, proposed, most=_MOST_TOOL, tools=tuple(kinds))


def next_tool(setting: Setting) -> int:
    """Return the next number after the largest used tool that the tool data does not assign."""
    first = max(setting.used, default=0) + 1
    free = (n for n in range(first, _MOST_TOOL + 1) if n not in setting.shop.tools)
    return next(free, min(first, _MOST_TOOL))


def bar(_values: Values, setting: Setting) -> Value | None:
    """Propose the bar diameter that the head specifies."""
    return setting.bar or None


def around(word: str) -> Callable[[Values], float]:
    """Return a function that reads a diameter from the field ``word``."""
    return lambda values: abs(number(values, word))


def rpm_field(work: Work, across: Callable[[Values], float]) -> Field:
    """Return a speed field with a proposal by material, diameter and spindle."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        return cutting_data.rpm(work, across(values) or setting.bar or 0.5, setting)

    return Field("RPM", "SPINDLE SPEED, RPM", Kind.RPM, proposed, most=MOST_RPM)


def feed_field(work: Work, word: str = "FEED", label: str = "FEED", **more: object) -> Field:
    """Return a field for the feed per revolution, with a proposal by material and tool."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        return cutting_data.feed(work, setting, number(values, "T"), number(values, "DIA"))

    only = more.get("only", lambda _values: True)
    assert callable(only)
    return Field(word, label, Kind.FEED, proposed, only=only)


def surface_field() -> Field:
    """Return a field for constant surface speed; 0 means constant rpm."""
    return Field("SURF", "SURFACE SPEED", Kind.SURFACE, 0.0, zero=True)


def too_fast(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    """Yield an error if the rpm exceeds the limit of the spindle."""
    turns = filled.n("RPM")
    if turns > setting.shop.max_rpm:
        most = f"{setting.shop.max_rpm:g}"
        yield Refusal(
            "RPM",
            Message(
                "S{revolutions} is more than the {maximum} rpm limit of this spindle: enter "
                "{maximum2} or less.",
                revolutions=f"{turns:g}",
                maximum=most,
                maximum2=most,
            ),
        )


def per_rev(filled: Filled, setting: Setting, *words: str) -> Iterator[Refusal]:
    """Yield errors for feeds per revolution that are far too high."""
    most = 0.05 * 25.4 / setting.mm
    for word in words:
        if filled.n(word) > most:
            text = Message(
                "A feed of {word} per revolution is more than {maximum}: did you mean F.003?",
                word=f"{filled.n(word):g}",
                maximum=f"{most:g}",
            )
            yield Refusal(word, text)


def too_deep(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    """Yield an error if DEEP exceeds the flute length in the tool data."""
    shape, deep = setting.tool(filled.n("T")), filled.n("DEEP")
    if shape is not None and shape.length and deep > shape.length / setting.mm + 1e-9:
        yield Refusal(
            "DEEP",
            Message(
                "Depth {depth} is more than the flute length of T{number}, which is {length}: "
                "use a longer tool.",
                depth=f"{deep:g}",
                number=f"{filled.n('T'):.0f}",
                length=f"{shape.length / setting.mm:.4g}",
            ),
        )
