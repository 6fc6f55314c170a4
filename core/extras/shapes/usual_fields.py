"""Fields that many shapes have: tool, speed, feed, diameter of the bar; with what is proposed for them."""

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
    """T: the first of such a kind by the tool sheets, one that is not used yet; else the next number."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        inside = values.get("SIDE") == "BORE" or kinds == (ToolKind.BORING,)
        sheets = sorted(setting.shop.tools.items())
        fits = [n for n, shape in sheets if shape.kind in kinds and shape.internal is inside]
        fits = [n for n in fits if setting.shop.tools[n].behind is (values.get("SIDE") == "REAR")] or fits
        fresh = [n for n in fits if n not in setting.used]
        return float((fresh or fits)[0] if fits else next_tool(setting))

    return Field("T", "TOOL", Kind.TOOL, proposed, most=_MOST_TOOL, tools=tuple(kinds))


def next_tool(setting: Setting) -> int:
    """The number behind the largest that is used, and that no sheet gives to another tool."""
    first = max(setting.used, default=0) + 1
    free = (n for n in range(first, _MOST_TOOL + 1) if n not in setting.shop.tools)
    return next(free, min(first, _MOST_TOOL))


def bar(_values: Values, setting: Setting) -> Value | None:
    """The diameter of the bar, where the head says it."""
    return setting.bar or None


def around(word: str) -> Callable[[Values], float]:
    """The diameter that a field says."""
    return lambda values: abs(number(values, word))


def rpm_field(work: Work, across: Callable[[Values], float]) -> Field:
    """S: by material, diameter and what the machine can do."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        return cutting_data.rpm(work, across(values) or setting.bar or 0.5, setting)

    return Field("RPM", "SPINDLE SPEED, RPM", Kind.RPM, proposed, most=MOST_RPM)


def feed_field(work: Work, word: str = "FEED", label: str = "FEED", **more: object) -> Field:
    """F a turn: by material and tool."""

    def proposed(values: Values, setting: Setting) -> Value | None:
        return cutting_data.feed(work, setting, number(values, "T"), number(values, "DIA"))

    only = more.get("only", lambda _values: True)
    assert callable(only)
    return Field(word, label, Kind.FEED, proposed, only=only)


def surface_field() -> Field:
    """Constant surface speed; 0: the same rpm all the way."""
    return Field("SURF", "SURFACE SPEED", Kind.SURFACE, 0.0, zero=True)


def too_fast(filled: Filled, setting: Setting) -> Iterator[Refusal]:
    """More rpm than the spindle has."""
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
    """Feeds beyond what the control takes, or what no tool of this size stands."""
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
    """DEEP beyond what the flutes of the tool reach by its sheet."""
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
