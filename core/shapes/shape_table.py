"""The shapes that there are, in the order in which they are offered, each with the key that opens it."""

from __future__ import annotations

from core.shapes.bar_work import LOOP
from core.shapes.calculators import SPEED, THREADS, TRIANGLE
from core.shapes.drilling import DRILL
from core.shapes.grooving import GROOVE
from core.shapes.live_tools import CROSS, FLATS, SLOT
from core.shapes.parting import PART_OFF
from core.shapes.program_head import HEAD
from core.shapes.shape import Shape
from core.shapes.tapping import TAP
from core.shapes.templates import BAR_FEED, ROUGH, START, THREADING, TOOL_CHANGE
from core.shapes.threading import THREAD
from core.shapes.turning import BORE, EDGE, FACE, TAPER, TURN

# H, E and Space stop the machine on every page: they open nothing.
SHAPES: dict[str, Shape] = {
    "N": HEAD,
    "F": FACE,
    "T": TURN,
    "A": TAPER,
    "K": EDGE,
    "G": GROOVE,
    "R": THREAD,
    "D": DRILL,
    "B": BORE,
    "O": TAP,
    "P": PART_OFF,
    "L": LOOP,
    "C": CROSS,
    "M": FLATS,
    "S": SLOT,
}

HELPERS: dict[str, Shape] = {
    "T": TRIANGLE,
    "R": THREADS,
    "F": SPEED,
    "N": START,
    "C": TOOL_CHANGE,
    "G": ROUGH,
    "D": THREADING,
    "B": BAR_FEED,
}
"""Calculators and templates: forms that write lines without a comment."""

_BY_NAME = {shape.name: shape for shape in SHAPES.values()}


def named(words: list[str]) -> tuple[Shape, list[str]] | None:
    """The shape whose name begins these words, and the words behind it; None where none does."""
    for count in (2, 1):
        found = _BY_NAME.get(" ".join(words[:count]))
        if found is not None and len(words) >= count:
            return found, words[count:]
    return None
