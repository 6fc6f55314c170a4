"""Plane switching: X and C, or Z and C, as the axes of a virtual mill with its own frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import atan2, degrees, dist

import numpy as np

from core.geometry.virtual_mill import Face, PlaneMove, Side, Spot
from core.interpreter.omniturn.codes.code_rules import check_when
from core.interpreter.omniturn.codes.code_table import FLOW_CODES
from core.interpreter.omniturn.motion.c_axis import rotation
from core.interpreter.omniturn.motion.feeds import out_of_range
from core.interpreter.omniturn.motion.straight_moves import mill_step
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.setup.spindle_and_dwell import warn_of_short_dwell
from core.interpreter.shared import units
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.shared.modal_state import Mill
from core.interpreter.shared.turn_at_axis import turns_at_axis
from core.language.diagnostics import ProgramError
from core.message import Message

# --- moves of the virtual mill, including those through the spindle centerline


_TOLERANCE = 0.0005 * units.MM_PER_INCH * (1 + 1e-9)
_SAME_PLANE_MOVES = 1e-9
_ENDS = np.array([0.0, 1.0])


def plane_move(state: State, statement: Statement, mill: Mill) -> Iterator[Block]:
    """Yield the blocks of a line that moves the mill. Raises ProgramError."""
    assert statement.plane is not None
    warn_of_short_dwell(state)
    target = _target(state, statement, mill)
    whole = PlaneMove(mill.frame, (mill.x, mill.y, mill.z), target, mill.theta)
    if statement.plane.arc:
        whole = _arc(state, statement, whole)
    if state.modal.feed is None:
        if "feed-missing" not in state.reported:
            state.reported.add("feed-missing")
            raise plane_refusal(
                statement,
                "feed-missing",
                "No feed is programmed for this move.",
                "Write F on this line or an earlier line.",
            )
        return
    for leg in _legs(state, statement, whole):
        yield from _towards(state, statement, leg)
        yield _block(state, statement, leg)


def _target(state: State, statement: Statement, mill: Mill) -> Spot:
    side = isinstance(mill.frame, Side)
    x, y = plane_length(state, statement, "X", mill.x), plane_length(state, statement, "Y", mill.y)
    z = plane_length(state, statement, "Z", mill.z * 2 if side else mill.z)
    if side and z < 0.0:
        text = Message(
            "Z{z} is past the spindle centerline; with (~PLZC), Z is the diameter at the tool tip.",
            z=state.modal.length_text(z),
        )
        raise plane_refusal(statement, "plane-side", text, "Correct Z.", "Z")
    return x, y, z / 2 if side else z


def _arc(state: State, statement: Statement, line: PlaneMove) -> PlaneMove:
    assert statement.plane is not None
    centre = plane_length(state, statement, "I", 0.0), plane_length(state, statement, "J", 0.0)
    first, last = dist(line.start[:2], centre), dist(line.end[:2], centre)
    if first <= _SAME_PLANE_MOVES or abs(first - last) > _TOLERANCE:
        begin, end = state.modal.length_text(first), state.modal.length_text(last)
        text = Message(
            "The arc's radius is {first} at its start and {last} at its end.", first=begin, last=end
        )
        hint = "I and J are the coordinates of the arc center."
        raise plane_refusal(statement, "arc-radius", text, hint, "G")
    return replace(line, centre=centre, clockwise=statement.plane.arc == 2)


def _legs(state: State, statement: Statement, whole: PlaneMove) -> list[PlaneMove]:
    """Return the move, or its two parts if it passes through the centerline.

    Raises ProgramError if the tool cannot reach the path.
    """
    if isinstance(whole.frame, Side):
        return [whole]
    share = whole.nearest()
    rho, h = whole.rho(share), abs(whole.frame.h)
    if rho < h - _SAME_PLANE_MOVES:
        near, least = state.modal.length_text(rho), state.modal.length_text(h)
        text = Message(
            "The path comes within {nearest} of the spindle centerline, but with the programmed "
            "H the tool cannot come closer to the centerline than {minimum}.",
            nearest=near,
            minimum=least,
        )
        raise plane_refusal(
            statement, "plane-reach", text, "The tool centerline is offset from the spindle centerline by H."
        )
    return whole.parts()


def _towards(state: State, statement: Statement, leg: PlaneMove) -> Iterator[Block]:
    """Yield a turn of C if the tool is on the centerline, until the path leads out along X."""
    mill = state.modal.mill
    assert mill is not None
    turn = replace(leg, theta=mill.theta).turn_at_start()
    state.adopt(state.modal._replace(mill=mill._replace(theta=mill.theta + turn)))
    if turns_at_axis(state.log, statement.line, turn):
        yield rotation(state, statement.line, statement.text, state.c - degrees(turn))


def _block(state: State, statement: Statement, leg: PlaneMove) -> Block:
    mill = state.modal.mill
    assert mill is not None
    leg = replace(leg, theta=mill.theta)
    (x, z, c) = leg.machine(_ENDS)[1].tolist()
    theta = leg.theta if isinstance(leg.frame, Side) else float(leg.thetas(leg.points(_ENDS), _ENDS)[1])
    start = state.x, state.z, state.c
    state.px, state.pz, state.c = x, z, c
    state.x, state.z = x + state.dx, z + state.dz
    state.adopt(state.modal._replace(mill=Mill(leg.frame, *leg.end, theta, False)))
    kind, feed = Kind.PLANE_ARC if leg.centre is not None else Kind.PLANE_LINE, state.modal.feed or 0.0
    return state.move(kind, statement.line, statement.text, start, feed, clockwise=leg.clockwise, plane=leg)


def plane_length(state: State, statement: Statement, letter: str, default: float) -> float:
    """Return a word in mm as written: a length, or the diameter of D or of Z on the side."""
    assert statement.plane is not None
    word = statement.plane.words.get(letter)
    return default if word is None else mill_step(state, statement.line, word)


def plane_refusal(statement: Statement, code: str, text: str, hint: str, letter: str = "") -> ProgramError:
    """Return an error for a line of plane switching, at the word ``letter`` if the line has it."""
    assert statement.plane is not None
    word = statement.plane.words.get(letter)
    return statement.refuse(word.column if word else 1, code, text, hint)


_LEAST_FEED = 0.00005 * units.MM_PER_INCH / 60
_SAME = 1e-9


def plane_line(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the blocks of one line of plane switching. Raises ProgramError for an invalid line."""
    line, mill = statement.plane, state.modal.mill
    assert line is not None
    if line.name == "END":
        state.adopt(state.modal._replace(mill=None))
    elif line.name:
        _enter(state, statement, line.name)
    elif mill is None:
        return  # The entry was rejected.
    elif "H" in line.words:
        _height(state, statement, mill)
    elif "D" in line.words:
        _diameter(state, statement, mill)
    else:
        _feed(state, statement)
        if not {"X", "Y", "Z", "G"}.isdisjoint(line.words):
            yield from plane_move(state, statement, mill)


def _enter(state: State, statement: Statement, name: str) -> None:
    modal = state.modal
    check_when(state, statement, FLOW_CODES[f"~{name}"])
    if state.px > -_SAME:
        text = Message(
            "(~{name}) needs the tool on the negative X side, but X is {pixels}.",
            name=name,
            pixels=state.modal.length_text(state.px),
        )
        raise plane_refusal(statement, "plane-side", text, "Move to negative X before this line.")
    if name == "PLXC":
        mill = Mill(Face(state.c), -state.px, 0.0, state.pz)
    else:
        mill = Mill(Side(state.c, state.pz, -2.0 * state.px), 0.0, 0.0, -state.px)
    feed = None if modal.rapid else modal.feed  # a mill has no rapid
    state.adopt(modal._replace(mill=mill, rapid=False, feed=feed))


def _height(state: State, statement: Statement, mill: Mill) -> None:
    if isinstance(mill.frame, Side):
        raise plane_refusal(
            statement,
            "plane-word",
            "H is allowed only with (~PLXC).",
            "Remove this text from the program.",
            "H",
        )
    if not mill.fresh:
        raise plane_refusal(
            statement,
            "plane-h-late",
            "H is programmed after a move or F, but must come first.",
            "Write H before the first move and before F.",
            "H",
        )
    h = plane_length(state, statement, "H", 0.0)
    frame = replace(mill.frame, h=h)
    state.adopt(state.modal._replace(mill=Mill(frame, mill.x, h, mill.z, atan2(h, mill.x), False)))


def _diameter(state: State, statement: Statement, mill: Mill) -> None:
    if isinstance(mill.frame, Face):
        raise plane_refusal(
            statement,
            "plane-word",
            "D is allowed only with (~PLZC).",
            "Remove this text from the program.",
            "D",
        )
    if abs(mill.y) > _SAME:
        text = Message(
            "D is programmed while Y is {y}, so D would move Y.", y=state.modal.length_text(mill.y)
        )
        raise plane_refusal(statement, "plane-d-late", text, "Move to Y0 before you program D.", "D")
    diameter = plane_length(state, statement, "D", 0.0)
    if diameter <= 0.0:
        raise plane_refusal(
            statement, "plane-diameter", "D must be a diameter greater than 0.", "Correct the value.", "D"
        )
    state.adopt(state.modal._replace(mill=mill._replace(frame=replace(mill.frame, diameter=diameter))))


def _feed(state: State, statement: Statement) -> None:
    assert statement.plane is not None
    word = statement.plane.words.get("F")
    if word is None or word.value is None:
        return
    feed, most = state.feed_word(word.value), state.setup.limits.max_feed
    modal, mill = state.modal, state.modal.mill
    within = min(max(feed, _LEAST_FEED), most)
    state.adopt(
        modal._replace(
            feed=within, cut_feed=within, cut_per_rev=False, mill=mill and mill._replace(fresh=False)
        )
    )
    state.reported.discard("feed-missing")
    if not _LEAST_FEED * (1 - 1e-9) <= feed <= most * (1 + 1e-9):
        code, text, _ = out_of_range(modal, feed, _LEAST_FEED, most)
        raise plane_refusal(statement, code, text, "Correct F.", "F")
