"""Plane switching: X and C, or Z and C, as the axes of a virtual mill with its own frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import atan2

from core.geometry.face import Face
from core.geometry.side import Side
from core.interpreter import units
from core.interpreter.blocks import Block
from core.interpreter.mill import Mill
from core.interpreter.plane_moves import plane_length, plane_move, plane_refusal, plane_shown
from core.interpreter.state import State
from core.interpreter.statement import Statement

_LEAST_FEED = 0.00005 * units.MM_PER_INCH / 60
_SAME = 1e-9


def plane_line(state: State, made: Statement) -> Iterator[Block]:
    """One line of plane switching. Raises ProgramError for what cannot be done there."""
    line, mill = made.plane, state.modal.mill
    assert line is not None
    if line.name == "END":
        state.adopt(state.modal._replace(mill=None))
    elif line.name:
        _enter(state, made, line.name)
    elif mill is None:
        return  # the entry was refused
    elif "H" in line.words:
        _height(state, made, mill)
    elif "D" in line.words:
        _diameter(state, made, mill)
    else:
        _feed(state, made)
        if not {"X", "Y", "Z", "G"}.isdisjoint(line.words):
            yield from plane_move(state, made, mill)


def _enter(state: State, made: Statement, name: str) -> None:
    modal = state.modal
    if not modal.c_locked:
        raise plane_refusal(
            made, "c-unlocked", f"(~{name}) turns C, which is not locked.", "Write M19 before."
        )
    if modal.per_rev:
        text = f"(~{name}) under G95: a plane is fed in inches a minute."
        raise plane_refusal(made, "plane-feed-mode", text, "Write G94 with F before.")
    if modal.nose_comp != 40:
        raise plane_refusal(
            made, "plane-nose-comp", f"(~{name}) with nose compensation on.", "Write G40 before."
        )
    if state.tool_line:
        text = f"The T on line {state.tool_line} has not been moved to X and Z."
        raise plane_refusal(made, "tool-first-move", text, "Move there before the plane.")
    if state.px > -_SAME:
        text = f"(~{name}) needs the tool on the negative X side, and X is {plane_shown(state, state.px)}."
        raise plane_refusal(made, "plane-side", text, "Move to X- before it.")
    if name == "PLXC":
        mill = Mill(Face(state.c), -state.px, 0.0, state.pz)
    else:
        mill = Mill(Side(state.c, state.pz, -2.0 * state.px), 0.0, 0.0, -state.px)
    feed = None if modal.rapid else modal.feed  # a mill has no rapid
    state.adopt(modal._replace(mill=mill, rapid=False, feed=feed))


def _height(state: State, made: Statement, mill: Mill) -> None:
    if isinstance(mill.frame, Side):
        raise plane_refusal(made, "plane-word", "H belongs to (~PLXC).", "Take it out.", "H")
    if not mill.fresh:
        raise plane_refusal(made, "plane-h-late", "H comes after a move or F.", "Write it first.", "H")
    h = plane_length(state, made, "H", 0.0)
    frame = replace(mill.frame, h=h)
    state.adopt(state.modal._replace(mill=Mill(frame, mill.x, h, mill.z, atan2(h, mill.x), False)))


def _diameter(state: State, made: Statement, mill: Mill) -> None:
    if isinstance(mill.frame, Face):
        raise plane_refusal(made, "plane-word", "D belongs to (~PLZC).", "Take it out.", "D")
    if abs(mill.y) > _SAME:
        text = f"D comes where Y is {plane_shown(state, mill.y)}: it would move Y."
        raise plane_refusal(made, "plane-d-late", text, "Write it where Y is 0.", "D")
    diameter = plane_length(state, made, "D", 0.0)
    if diameter <= 0.0:
        raise plane_refusal(made, "plane-diameter", "D must be a diameter over 0.", "Correct it.", "D")
    state.adopt(state.modal._replace(mill=mill._replace(frame=replace(mill.frame, diameter=diameter))))


def _feed(state: State, made: Statement) -> None:
    assert made.plane is not None
    word = made.plane.words.get("F")
    if word is None or word.value is None:
        return
    feed, most = state.feed_word(word.value), state.setup.limits.max_feed
    modal, mill = state.modal, state.modal.mill
    kept = min(max(feed, _LEAST_FEED), most)
    state.adopt(
        modal._replace(feed=kept, cut_feed=kept, cut_per_rev=False, mill=mill and mill._replace(fresh=False))
    )
    state.told.discard("feed-missing")
    if not _LEAST_FEED * (1 - 1e-9) <= feed <= most * (1 + 1e-9):
        low = units.feed(_LEAST_FEED, per_rev=False, metric=modal.metric)
        high = units.feed(most, per_rev=False, metric=modal.metric)
        shown = units.feed(feed, per_rev=False, metric=modal.metric)
        text = f"Feed {shown} is out of range: {low} to {high}."
        raise plane_refusal(made, "feed-range", text, "Correct F.", "F")
