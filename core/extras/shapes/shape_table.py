"""Table of the shapes in the order of the menu, each with its key."""

from __future__ import annotations

from dataclasses import replace

from core.extras.shapes.calculators import SPEED, THREADS, TRIANGLE
from core.extras.shapes.forms.bar_work import LOOP, PART_OFF, SINUMERIK_LOOP
from core.extras.shapes.forms.drilling import DRILL
from core.extras.shapes.forms.grooving import GROOVE, SINUMERIK_GROOVE
from core.extras.shapes.forms.live_tools import (
    CROSS,
    FLATS,
    SINUMERIK_CROSS,
    SINUMERIK_FLATS,
    SINUMERIK_SLOT,
    SLOT,
)
from core.extras.shapes.forms.tapers_and_bores import BORE, EDGE, TAPER
from core.extras.shapes.forms.turning import FACE, LABEL, TURN
from core.extras.shapes.shape import Shape
from core.extras.shapes.templates import (
    BAR_FEED,
    HEAD,
    ROUGH,
    SINUMERIK_BAR_FEED,
    SINUMERIK_HEAD,
    SINUMERIK_ROUGH,
    SINUMERIK_SPEED,
    SINUMERIK_START,
    SINUMERIK_THREADING,
    SINUMERIK_THREADS,
    START,
    THREADING,
    TOOL_CHANGE,
)
from core.extras.shapes.threads.tapping import SINUMERIK_TAP, TAP
from core.extras.shapes.threads.threading import SINUMERIK_THREAD, THREAD
from core.language.source import Dialect

# H, E and Space stop the machine on every page, so they cannot open a shape.
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

SINUMERIK_HELPERS: dict[str, Shape] = {
    "T": TRIANGLE,
    "R": SINUMERIK_THREADS,
    "F": SINUMERIK_SPEED,
    "N": SINUMERIK_START,
    "C": TOOL_CHANGE,
    "G": SINUMERIK_ROUGH,
    "D": SINUMERIK_THREADING,
    "B": SINUMERIK_BAR_FEED,
}

HELPERS_OF = {Dialect.OMNITURN: HELPERS, Dialect.SINUMERIK: SINUMERIK_HELPERS}
"""By the language of the program."""


def _labelled(shape: Shape) -> Shape:
    """Return the shape with a label field, for a contour that CYCLE95 finds by its labels."""
    return replace(shape, fields=(*shape.fields, LABEL))


SINUMERIK_SHAPES: dict[str, Shape] = {
    "N": SINUMERIK_HEAD,
    "F": FACE,
    "T": _labelled(TURN),
    "A": _labelled(TAPER),
    "K": EDGE,
    "G": SINUMERIK_GROOVE,
    "R": SINUMERIK_THREAD,
    "D": DRILL,
    "B": _labelled(BORE),
    "O": SINUMERIK_TAP,
    "P": PART_OFF,
    "L": SINUMERIK_LOOP,
    "C": SINUMERIK_CROSS,
    "M": SINUMERIK_FLATS,
    "S": SINUMERIK_SLOT,
}

SHAPES_OF = {Dialect.OMNITURN: SHAPES, Dialect.SINUMERIK: SINUMERIK_SHAPES}
"""By the language of the program."""

_BY_NAME = {dialect: {shape.name: shape for shape in table.values()} for dialect, table in SHAPES_OF.items()}


def named(words: list[str], dialect: Dialect = Dialect.OMNITURN) -> tuple[Shape, list[str]] | None:
    """Return the shape whose name begins these words, and the remaining words; or None."""
    for count in (2, 1):
        found = _BY_NAME[dialect].get(" ".join(words[:count]))
        if found is not None and len(words) >= count:
            return found, words[count:]
    return None
