"""Corners C and R between the lines of a contour that a cycle reads."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from core.geometry.contour import Element, Line
from core.geometry.corner import CornerError, CornerTooLargeError, NoCornerError, chamfer, fillet
from core.interpreter import units
from core.interpreter.log import Log, refusal
from core.language.diagnostics import ProgramError
from core.language.omniturn import Word

_SHORTEST = 1e-6  # mm


class Piece(NamedTuple):
    """An element of a contour, and the corner of ``size`` mm that its line asks for at its end."""

    element: Element
    line: int
    corner: Word | None = None
    size: float = 0.0
    metric: bool = False


def cut_corners(pieces: Sequence[Piece], log: Log) -> list[Element]:
    """The elements with their corners cut. Raises ProgramError for a corner that cannot be made."""
    done: list[Element] = []
    asked: Piece | None = None
    for piece in pieces:
        element = piece.element
        if asked is not None:
            *cut, element = _corner(asked, done.pop(), element, log)
            done += [each for each in cut if each.length > _SHORTEST]
        done.append(element)
        asked = piece if piece.corner is not None else None
    if asked is not None:
        raise _refused(asked, "corner-next", "the contour ends here")
    return [element for element in done if element.length > _SHORTEST]


def _corner(asked: Piece, before: Element, after: Element, log: Log) -> Sequence[Element]:
    if not isinstance(before, Line) or not isinstance(after, Line):
        raise _refused(asked, "corner-next", "the next move is an arc")
    make = chamfer if asked.corner is not None and asked.corner.letter == "C" else fillet
    try:
        return make(before, after, asked.size)
    except NoCornerError:
        text = "The two moves run in one direction: there is no corner to cut."
        log.warn(asked.line, _column(asked), "corner-straight", text, "Take C or R out.")
        return before, after
    except CornerTooLargeError as problem:
        needed = units.length(problem.needed, metric=asked.metric)
        left = units.length((before if problem.first else after).length, metric=asked.metric)
        which = "this move" if problem.first else "the next move"
        why = f"it takes {needed} of {which}, which has {left} left"
        raise _refused(asked, "corner-too-large", why) from None
    except CornerError as problem:
        raise _refused(asked, "corner-next", str(problem)) from None


def _column(asked: Piece) -> int:
    return asked.corner.column if asked.corner else 0


def _refused(asked: Piece, code: str, why: str) -> ProgramError:
    name = asked.corner.letter if asked.corner else "C"
    hint = "Make it smaller." if code == "corner-too-large" else "A corner needs two straight moves in a row."
    text = f"{name} cannot make a corner: {why}."
    return ProgramError(refusal(asked.line, _column(asked), code, text, hint))
