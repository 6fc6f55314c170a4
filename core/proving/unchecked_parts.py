"""What the proof of the part could not look at, because nobody has said what it would have needed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from core.message import Message
from core.part.clamping import Clamping
from core.part.stock import Point
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.assumed_tools import ToolUse
from core.tool_edges import edge_name

_DEEP = frozenset({ToolKind.DRILL, ToolKind.REAMER, ToolKind.TAP, ToolKind.END_MILL})


def unchecked(
    uses: Mapping[int, ToolUse],
    shapes: Mapping[int, ToolShape],
    clamping: Clamping | None,
    gang: Mapping[int, Point],
) -> tuple[str, ...]:
    """Short phrases, one for each kind of thing; ``uses`` are the tools of the program."""
    return tuple(_phrases([n for n in sorted(uses) if uses[n].moves or uses[n].live], shapes, clamping, gang))


def _phrases(
    used: Iterable[int],
    shapes: Mapping[int, ToolShape],
    clamping: Clamping | None,
    gang: Mapping[int, Point],
) -> Iterator[str]:
    used = list(used)
    if without := [n for n in used if n and n not in shapes]:
        yield Message(
            "{without}: tool holder, edge length and hand of the tool not defined", without=_names(without)
        )
    if short := [n for n in used if n in shapes and shapes[n].kind in _DEEP and not shapes[n].length]:
        yield Message("{short}: maximum tool depth (unknown: no flute length defined)", short=_names(short))
    if clamping is None or not clamping.diameter:
        yield (
            "collisions with the chuck and jaws, and stock whip (these checks require a "
            "diameter in [clamping] and a stick-out)"
        )
    if clamping is None or not clamping.max_rpm:
        yield "maximum chuck speed (unknown: no max_rpm in [clamping])"
    if gang and (beside := sorted(gang.keys() - shapes.keys())):
        yield (
            Message(
                "{tools}: collisions on the gang plate while a neighboring tool cuts (no tool shape defined)",
                tools=_names(beside),
            )
        )


def _names(numbers: Iterable[int]) -> str:
    return ", ".join(edge_name(n) for n in numbers)
