"""Tables of the shapes and calculators in menu order, each with its function key."""

from __future__ import annotations

from dataclasses import replace

from core.extras.shapes.calculators import SPEED_CALCULATOR, TAPER_CALCULATOR, THREAD_CALCULATOR
from core.extras.shapes.editor_shape import Shape
from core.extras.shapes.forms.bar_work import BAR_LOOP_SHAPE, PARTING_SHAPE, SINUMERIK_BAR_LOOP_SHAPE
from core.extras.shapes.forms.drilling import DRILLING_SHAPE
from core.extras.shapes.forms.face_grooving import FACE_GROOVE_SHAPE
from core.extras.shapes.forms.grooving import GROOVE_SHAPE, SINUMERIK_GROOVE_SHAPE
from core.extras.shapes.forms.live_tools import (
    CROSS_HOLES_SHAPE,
    FLATS_SHAPE,
    SINUMERIK_CROSS,
    SINUMERIK_FLATS,
    SINUMERIK_SLOT,
    SLOT_SHAPE,
)
from core.extras.shapes.forms.tapers_and_bores import BORE_SHAPE, EDGE_SHAPE, TAPER_SHAPE
from core.extras.shapes.forms.turning import FACE, LABEL_FIELD, TURNING_SHAPE
from core.extras.shapes.templates import (
    BAR_FEED_TEMPLATE,
    HEAD_SHAPE,
    ROUGHING_TEMPLATE,
    SINUMERIK_BAR_FEED_TEMPLATE,
    SINUMERIK_HEAD_SHAPE,
    SINUMERIK_ROUGHING_TEMPLATE,
    SINUMERIK_SPEED_CALCULATOR,
    SINUMERIK_START_TEMPLATE,
    SINUMERIK_THREAD_CALCULATOR,
    SINUMERIK_THREADING_TEMPLATE,
    START_TEMPLATE,
    THREADING_TEMPLATE,
    TOOL_CHANGE_TEMPLATE,
)
from core.extras.shapes.threads.tapping import SINUMERIK_TAPPING_SHAPE, TAPPING_SHAPE
from core.extras.shapes.threads.threading import SINUMERIK_THREAD_SHAPE, THREAD_SHAPE
from core.language.source import Dialect

# H, E and Space stop the machine on every page, so they cannot open a shape.
SHAPES_BY_KEY: dict[str, Shape] = {
    "N": HEAD_SHAPE,
    "F": FACE,
    "T": TURNING_SHAPE,
    "A": TAPER_SHAPE,
    "K": EDGE_SHAPE,
    "G": GROOVE_SHAPE,
    "V": FACE_GROOVE_SHAPE,
    "R": THREAD_SHAPE,
    "D": DRILLING_SHAPE,
    "B": BORE_SHAPE,
    "O": TAPPING_SHAPE,
    "P": PARTING_SHAPE,
    "L": BAR_LOOP_SHAPE,
    "C": CROSS_HOLES_SHAPE,
    "M": FLATS_SHAPE,
    "S": SLOT_SHAPE,
}

CALCULATORS_BY_KEY: dict[str, Shape] = {
    "T": TAPER_CALCULATOR,
    "R": THREAD_CALCULATOR,
    "F": SPEED_CALCULATOR,
    "N": START_TEMPLATE,
    "C": TOOL_CHANGE_TEMPLATE,
    "G": ROUGHING_TEMPLATE,
    "D": THREADING_TEMPLATE,
    "B": BAR_FEED_TEMPLATE,
}
"""Calculators and templates by key. These forms write lines without a comment."""

SINUMERIK_CALCULATORS: dict[str, Shape] = {
    "T": TAPER_CALCULATOR,
    "R": SINUMERIK_THREAD_CALCULATOR,
    "F": SINUMERIK_SPEED_CALCULATOR,
    "N": SINUMERIK_START_TEMPLATE,
    "C": TOOL_CHANGE_TEMPLATE,
    "G": SINUMERIK_ROUGHING_TEMPLATE,
    "D": SINUMERIK_THREADING_TEMPLATE,
    "B": SINUMERIK_BAR_FEED_TEMPLATE,
}

CALCULATORS_BY_DIALECT = {Dialect.OMNITURN: CALCULATORS_BY_KEY, Dialect.SINUMERIK: SINUMERIK_CALCULATORS}
"""Calculators and templates by key, for each program language."""


def _labelled(shape: Shape) -> Shape:
    """Return the shape with an additional field for the label by which CYCLE95 finds the contour."""
    return replace(shape, fields=(*shape.fields, LABEL_FIELD))


SINUMERIK_SHAPES: dict[str, Shape] = {
    "N": SINUMERIK_HEAD_SHAPE,
    "F": FACE,
    "T": _labelled(TURNING_SHAPE),
    "A": _labelled(TAPER_SHAPE),
    "K": EDGE_SHAPE,
    "G": SINUMERIK_GROOVE_SHAPE,
    "V": FACE_GROOVE_SHAPE,
    "R": SINUMERIK_THREAD_SHAPE,
    "D": DRILLING_SHAPE,
    "B": _labelled(BORE_SHAPE),
    "O": SINUMERIK_TAPPING_SHAPE,
    "P": PARTING_SHAPE,
    "L": SINUMERIK_BAR_LOOP_SHAPE,
    "C": SINUMERIK_CROSS,
    "M": SINUMERIK_FLATS,
    "S": SINUMERIK_SLOT,
}

SHAPES_BY_DIALECT = {Dialect.OMNITURN: SHAPES_BY_KEY, Dialect.SINUMERIK: SINUMERIK_SHAPES}
"""Shape forms by key, for each program language."""

_BY_NAME = {
    dialect: {shape.name: shape for shape in table.values()} for dialect, table in SHAPES_BY_DIALECT.items()
}


def find_shape(words: list[str], dialect: Dialect = Dialect.OMNITURN) -> tuple[Shape, list[str]] | None:
    """Return the shape whose name these words start with, and the remaining words.

    Return None if the words do not start with the name of a shape.
    """
    for count in (2, 1):
        found = _BY_NAME[dialect].get(" ".join(words[:count]))
        if found is not None and len(words) >= count:
            return found, words[count:]
    return None
