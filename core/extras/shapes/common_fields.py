"""Fields used by many shapes, such as tool, speed, feed and bar diameter, with their proposals."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from core.extras.shapes import cutting_data
from core.extras.shapes.cutting_data import Operation
from core.extras.shapes.editor_shape import ShapeInstance
from core.extras.shapes.shape_fields import (
    FieldError,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShapeField,
    number,
)
from core.message import Message
from core.part.tool_shape import ToolKind

_MOST_TOOL = 32
MAX_RPM = 100_000.0


def make_tool_field(*kinds: ToolKind) -> ShapeField:
    """Return a tool field that proposes a tool.

    The proposal is the first unused tool of these kinds, or the next free number if there is none.
    """

    def propose_tool_number(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
        inside = values.get("SIDE") == "BORE" or kinds == (ToolKind.BORING,)
        sheets = sorted(setting.shop.tools.items())
        fits = [n for n, shape in sheets if shape.kind in kinds and shape.internal is inside]
        fits = [
            n for n in fits if setting.shop.tools[n].is_rear_tool is (values.get("SIDE") == "REAR")
        ] or fits
        fresh = [n for n in fits if n not in setting.used]
        return float((fresh or fits)[0] if fits else find_next_tool_number(setting))

    return ShapeField(
        "T", "TOOL", FieldKind.TOOL, propose_tool_number, maximum=_MOST_TOOL, tool_kinds=tuple(kinds)
    )


def find_next_tool_number(settings: ProgramSettings) -> int:
    """Return the first tool number above all used numbers that is not in the tool data."""
    first = max(settings.used, default=0) + 1
    free = (n for n in range(first, _MOST_TOOL + 1) if n not in settings.shop.tools)
    return next(free, min(first, _MOST_TOOL))


def propose_bar_diameter(_values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
    """Return the bar diameter specified in the program head, or None if it is not specified."""
    return settings.bar or None


def make_diameter_reader(word: str) -> Callable[[FieldValues], float]:
    """Return a function that reads a diameter from the field ``word``."""
    return lambda values: abs(number(values, word))


def make_rpm_field(operation: Operation, read_diameter: Callable[[FieldValues], float]) -> ShapeField:
    """Return a spindle speed field, with a proposal that depends on material, diameter and spindle."""

    def propose_spindle_rpm(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
        return cutting_data.rpm(operation, read_diameter(values) or setting.bar or 0.5, setting)

    return ShapeField("RPM", "SPINDLE SPEED, RPM", FieldKind.RPM, propose_spindle_rpm, maximum=MAX_RPM)


def make_feed_field(
    operation: Operation, word: str = "FEED", label: str = "FEED", **more: object
) -> ShapeField:
    """Return a field for the feed per revolution, with a proposal that depends on material and tool."""

    def propose_feed_per_rev(values: FieldValues, setting: ProgramSettings) -> FieldValue | None:
        return cutting_data.propose_feed(operation, setting, number(values, "T"), number(values, "DIA"))

    only = more.get("only", lambda _values: True)
    assert callable(only)
    return ShapeField(word, label, FieldKind.FEED, propose_feed_per_rev, applies_to=only)


def make_surface_speed_field() -> ShapeField:
    """Return a field for constant surface speed, in which 0 means constant rpm."""
    return ShapeField("SURF", "SURFACE SPEED", FieldKind.SURFACE_SPEED, 0.0, allows_zero=True)


def check_rpm(filled_shape: ShapeInstance, settings: ProgramSettings) -> Iterator[FieldError]:
    """Yield an error if the rpm exceeds the limit of the spindle."""
    turns = filled_shape.get_number("RPM")
    if turns > settings.shop.max_rpm:
        most = f"{settings.shop.max_rpm:g}"
        yield FieldError(
            "RPM",
            Message(
                "S{revolutions} is more than the {maximum} rpm limit of this spindle: enter "
                "{maximum2} or less.",
                revolutions=f"{turns:g}",
                maximum=most,
                maximum2=most,
            ),
        )


def check_feeds(filled_shape: ShapeInstance, settings: ProgramSettings, *words: str) -> Iterator[FieldError]:
    """Yield errors for feeds per revolution that exceed a plausible maximum."""
    most = 0.05 * 25.4 / settings.mm
    for word in words:
        if filled_shape.get_number(word) > most:
            text = Message(
                "A feed of {word} per revolution is more than {maximum}: did you mean F.003?",
                word=f"{filled_shape.get_number(word):g}",
                maximum=f"{most:g}",
            )
            yield FieldError(word, text)


def check_flute_length(filled_shape: ShapeInstance, settings: ProgramSettings) -> Iterator[FieldError]:
    """Yield an error if the depth (DEEP) exceeds the flute length in the tool data."""
    shape, deep = settings.tool(filled_shape.get_number("T")), filled_shape.get_number("DEEP")
    if shape is not None and shape.length and deep > shape.length / settings.mm + 1e-9:
        yield FieldError(
            "DEEP",
            Message(
                "Depth {depth} is more than the flute length of T{number}, which is {length}: "
                "use a longer tool.",
                depth=f"{deep:g}",
                number=f"{filled_shape.get_number('T'):.0f}",
                length=f"{shape.length / settings.mm:.4g}",
            ),
        )
