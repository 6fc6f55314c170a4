"""Coordinate transformation (plane switching), in which X and C or Z and C move a virtual mill.

The virtual mill has its own coordinate system.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import atan2, degrees, dist

import numpy as np

from core.geometry.virtual_mill import FacePlane, MillPoint, PlaneMove, SidePlane
from core.interpreter.omniturn.codes.code_rules import check_conditions
from core.interpreter.omniturn.codes.code_table import FLOW_CODES
from core.interpreter.omniturn.motion.c_axis import rotate_c_axis
from core.interpreter.omniturn.motion.feeds import describe_feed_error
from core.interpreter.omniturn.motion.straight_moves import round_mill_length
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.setup.spindle_and_dwell import warn_about_short_dwell
from core.interpreter.shared import units
from core.interpreter.shared.centerline_rotation import needs_centerline_rotation
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import VirtualMill
from core.language.diagnostics import ProgramError
from core.message import Message

# --- moves of the virtual mill, including those through the spindle centerline


_TOLERANCE = 0.0005 * units.MM_PER_INCH * (1 + 1e-9)
_SAME_PLANE_MOVES = 1e-9
_ENDS = np.array([0.0, 1.0])


def move_virtual_mill(state: State, statement: Statement, virtual_mill: VirtualMill) -> Iterator[Block]:
    """Yield the blocks of a line that moves the virtual mill. Raises ProgramError for an invalid move."""
    assert statement.plane_switching_line is not None
    warn_about_short_dwell(state)
    target = _target(state, statement, virtual_mill)
    whole = PlaneMove(
        virtual_mill.frame,
        (virtual_mill.x, virtual_mill.y, virtual_mill.z),
        target,
        virtual_mill.polar_angle_rad,
    )
    if statement.plane_switching_line.arc_code:
        whole = _arc(state, statement, whole)
    if state.modal.feed is None:
        if "feed-missing" not in state.reported:
            state.reported.add("feed-missing")
            raise make_plane_error(
                statement,
                "feed-missing",
                "No feed is programmed for this move.",
                "Write F on this line or an earlier line.",
            )
        return
    for leg in _split_at_centerline(state, statement, whole):
        yield from _turn_at_centerline(state, statement, leg)
        yield _block(state, statement, leg)


def _target(state: State, statement: Statement, mill: VirtualMill) -> MillPoint:
    side = isinstance(mill.frame, SidePlane)
    x, y = (
        read_plane_length_mm(state, statement, "X", mill.x),
        read_plane_length_mm(state, statement, "Y", mill.y),
    )
    z = read_plane_length_mm(state, statement, "Z", mill.z * 2 if side else mill.z)
    if side and z < 0.0:
        text = Message(
            "Z{z} is past the spindle centerline; with (~PLZC), Z is the diameter at the tool tip.",
            z=state.modal.format_length(z),
        )
        raise make_plane_error(statement, "plane-side", text, "Correct Z.", "Z")
    return x, y, z / 2 if side else z


def _arc(state: State, statement: Statement, line: PlaneMove) -> PlaneMove:
    assert statement.plane_switching_line is not None
    centre = (
        read_plane_length_mm(state, statement, "I", 0.0),
        read_plane_length_mm(state, statement, "J", 0.0),
    )
    first, last = dist(line.start[:2], centre), dist(line.end[:2], centre)
    if first <= _SAME_PLANE_MOVES or abs(first - last) > _TOLERANCE:
        begin, end = state.modal.format_length(first), state.modal.format_length(last)
        text = Message(
            "The arc's radius is {first} at its start and {last} at its end.", first=begin, last=end
        )
        hint = "I and J are the coordinates of the arc center."
        raise make_plane_error(statement, "arc-radius", text, hint, "G")
    return replace(line, center=centre, clockwise=statement.plane_switching_line.arc_code == 2)


def _split_at_centerline(state: State, statement: Statement, move: PlaneMove) -> list[PlaneMove]:
    """Return the move, or its two parts if the move passes through the centerline.

    Raises ProgramError if the tool cannot reach the path.
    """
    if isinstance(move.frame, SidePlane):
        return [move]
    share = move.get_fastest_rotation_fraction()
    rho, h = move.compute_distance_from_axis(share), abs(move.frame.tool_height_mm)
    if rho < h - _SAME_PLANE_MOVES:
        near, least = state.modal.format_length(rho), state.modal.format_length(h)
        text = Message(
            "The path comes within {nearest} of the spindle centerline, but with the programmed "
            "H the tool cannot come closer to the centerline than {minimum}.",
            nearest=near,
            minimum=least,
        )
        raise make_plane_error(
            statement, "plane-reach", text, "The tool centerline is offset from the spindle centerline by H."
        )
    return move.split_at_axis()


def _turn_at_centerline(state: State, statement: Statement, leg: PlaneMove) -> Iterator[Block]:
    """Yield a rotation of C if the tool is on the centerline.

    C rotates until the path leads outward along X.
    """
    mill = state.modal.mill
    assert mill is not None
    turn = replace(leg, start_angle_rad=mill.polar_angle_rad).find_start_rotation()
    state.set_modal(state.modal._replace(mill=mill._replace(polar_angle_rad=mill.polar_angle_rad + turn)))
    if needs_centerline_rotation(state.log, statement.line, turn):
        yield rotate_c_axis(state, statement.line, statement.text, state.c - degrees(turn))


def _block(state: State, statement: Statement, leg: PlaneMove) -> Block:
    mill = state.modal.mill
    assert mill is not None
    leg = replace(leg, start_angle_rad=mill.polar_angle_rad)
    (x, z, c) = leg.compute_machine_positions(_ENDS)[1].tolist()
    theta = (
        leg.start_angle_rad
        if isinstance(leg.frame, SidePlane)
        else float(leg.compute_polar_angles(leg.compute_mill_points(_ENDS), _ENDS)[1])
    )
    start = state.x, state.z, state.c
    state.px, state.pz, state.c = x, z, c
    state.x, state.z = x + state.secondary_x, z + state.secondary_z
    state.set_modal(state.modal._replace(mill=VirtualMill(leg.frame, *leg.end, theta, False)))
    kind, feed = (
        BlockKind.PLANE_ARC if leg.center is not None else BlockKind.PLANE_LINE,
        state.modal.feed or 0.0,
    )
    return state.move(
        kind, statement.line, statement.text, start, feed, is_clockwise=leg.clockwise, plane=leg
    )


def read_plane_length_mm(state: State, statement: Statement, letter: str, default: float) -> float:
    """Return the length of a word in mm, or ``default`` if the line lacks the word.

    The length is not halved: D, and Z on the side of the part, remain diameters.
    """
    assert statement.plane_switching_line is not None
    word = statement.plane_switching_line.words.get(letter)
    return default if word is None else round_mill_length(state, statement.line, word)


def make_plane_error(statement: Statement, code: str, text: str, hint: str, letter: str = "") -> ProgramError:
    """Return an error for a line within coordinate transformation (plane switching).

    The error is located at the word ``letter`` if the line has this word.
    """
    assert statement.plane_switching_line is not None
    word = statement.plane_switching_line.words.get(letter)
    return statement.make_error(word.column if word else 1, code, text, hint)


_MIN_FEED = 0.00005 * units.MM_PER_INCH / 60
_SAME = 1e-9


def execute_plane_line(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the blocks of one line within coordinate transformation (plane switching).

    Raises ProgramError for an invalid line.
    """
    line, mill = statement.plane_switching_line, state.modal.mill
    assert line is not None
    if line.name == "END":
        state.set_modal(state.modal._replace(mill=None))
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
            yield from move_virtual_mill(state, statement, mill)


def _enter(state: State, statement: Statement, name: str) -> None:
    modal = state.modal
    check_conditions(state, statement, FLOW_CODES[f"~{name}"])
    if state.px > -_SAME:
        text = Message(
            "(~{name}) needs the tool on the negative X side, but X is {x}.",
            name=name,
            x=state.modal.format_length(state.px),
        )
        raise make_plane_error(statement, "plane-side", text, "Move to negative X before this line.")
    if name == "PLXC":
        mill = VirtualMill(FacePlane(state.c), -state.px, 0.0, state.pz)
    else:
        mill = VirtualMill(SidePlane(state.c, state.pz, -2.0 * state.px), 0.0, 0.0, -state.px)
    feed = None if modal.rapid else modal.feed  # a mill has no rapid
    state.set_modal(modal._replace(mill=mill, rapid=False, feed=feed))


def _height(state: State, statement: Statement, mill: VirtualMill) -> None:
    if isinstance(mill.frame, SidePlane):
        raise make_plane_error(
            statement,
            "plane-word",
            "H is allowed only with (~PLXC).",
            "Remove this text from the program.",
            "H",
        )
    if not mill.is_newly_active:
        raise make_plane_error(
            statement,
            "plane-h-late",
            "H is programmed after a move or F, but must come first.",
            "Write H before the first move and before F.",
            "H",
        )
    h = read_plane_length_mm(state, statement, "H", 0.0)
    frame = replace(mill.frame, tool_height_mm=h)
    state.set_modal(state.modal._replace(mill=VirtualMill(frame, mill.x, h, mill.z, atan2(h, mill.x), False)))


def _diameter(state: State, statement: Statement, mill: VirtualMill) -> None:
    if isinstance(mill.frame, FacePlane):
        raise make_plane_error(
            statement,
            "plane-word",
            "D is allowed only with (~PLZC).",
            "Remove this text from the program.",
            "D",
        )
    if abs(mill.y) > _SAME:
        text = Message(
            "D is programmed while Y is {y}, so D would move Y.", y=state.modal.format_length(mill.y)
        )
        raise make_plane_error(statement, "plane-d-late", text, "Move to Y0 before you program D.", "D")
    diameter = read_plane_length_mm(state, statement, "D", 0.0)
    if diameter <= 0.0:
        raise make_plane_error(
            statement, "plane-diameter", "D must be a diameter greater than 0.", "Correct the value.", "D"
        )
    state.set_modal(state.modal._replace(mill=mill._replace(frame=replace(mill.frame, diameter_mm=diameter))))


def _feed(state: State, statement: Statement) -> None:
    assert statement.plane_switching_line is not None
    word = statement.plane_switching_line.words.get("F")
    if word is None or word.value is None:
        return
    feed, most = state.convert_feed(word.value), state.setup.limits.max_feed_mm_s
    modal, mill = state.modal, state.modal.mill
    within = min(max(feed, _MIN_FEED), most)
    state.set_modal(
        modal._replace(
            feed=within,
            last_cutting_feed=within,
            is_cutting_feed_per_rev=False,
            mill=mill and mill._replace(is_newly_active=False),
        )
    )
    state.reported.discard("feed-missing")
    if not _MIN_FEED * (1 - 1e-9) <= feed <= most * (1 + 1e-9):
        code, text, _ = describe_feed_error(modal, feed, _MIN_FEED, most)
        raise make_plane_error(statement, code, text, "Correct F.", "F")
