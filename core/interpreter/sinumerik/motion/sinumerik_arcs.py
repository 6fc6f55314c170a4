"""Arcs with G2, G3, CIP and CT in the XZ plane.

An arc is defined by its center, radius, angle, intermediate point or start tangent.
"""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, dist, hypot, radians, sin, tan

from core.geometry.lines_and_arcs import Point, find_arc_center
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.sinumerik.motion.linear_moves import (
    MIN_PATH_MM,
    AxisTravel,
    compute_axis_travel,
    make_travel_block,
    store_end_direction,
)
from core.interpreter.sinumerik.motion.sinumerik_feeds import check_block_feed
from core.interpreter.sinumerik.sinumerik_state import MotionKind, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import ARC_WORDS, PositionMode, Word
from core.message import Message

WRONG_ARC_END = 14040
_TOLERANCE = 0.01  # mm; permitted difference of the radii at both ends


def make_arc_block(state: SinumerikState, statement: Statement) -> Block:
    """Return the block of an arc.

    Raises ProgramError if its words do not define an arc, if G18 is not active, if SCALE has different
    factors for X and Z, or if no valid feed is active.
    """
    if state.plane != 18:
        text = "arcs in X and Z need G18."
        raise statement.make_error(
            statement.g_words.get("motion"), "arc-plane", text, "Write G18 before this block."
        )
    _check_words(state, statement)
    travel = compute_axis_travel(state, statement)
    if not travel.frame.has_uniform_scale:
        text = "SCALE uses different factors for X and Z, so an arc is not possible."
        hint = "Use the same factor for both axes."
        raise statement.make_error(statement.g_words.get("motion"), "arc-scaled", text, hint)
    clockwise, (centre, travel) = _compute_arc(state, statement, travel)
    offset = travel.offset_x
    feed = check_block_feed(state, statement, travel.x0 - offset, travel.x - offset)
    made_block = make_travel_block(state, statement, travel, BlockKind.ARC, feed)
    made_block = replace(
        made_block, cx=centre[0] - travel.offset_x, cz=centre[1] - travel.offset_z, clockwise=clockwise
    )
    return store_end_direction(state, made_block)


_CIP_WORDS = frozenset({"I1", "K1"})


def _check_words(state: SinumerikState, statement: Statement) -> None:
    """Raise ProgramError for a word that belongs to another kind of arc."""
    own = {MotionKind.ARC_BY_POINT: _CIP_WORDS, MotionKind.TANGENTIAL_ARC: frozenset[str]()}.get(
        state.motion, ARC_WORDS - _CIP_WORDS
    )
    for name in sorted((ARC_WORDS - own) & statement.words.keys()):
        word = statement.words[name]
        kind = {MotionKind.ARC_BY_POINT: "CIP", MotionKind.TANGENTIAL_ARC: "CT"}.get(
            state.motion, f"G{state.motion:d}"
        )
        text = "{word} cannot be used with {kind}."
        hint = "Remove this word, or program the type of arc that uses it."
        raise statement.make_error(word, "word-unused", text, hint, word=word.text, kind=kind)


def _compute_arc(
    state: SinumerikState, statement: Statement, travel: AxisTravel
) -> tuple[bool, tuple[Point, AxisTravel]]:
    """Return whether the arc is clockwise, its center in machine coordinates, and its travel."""
    if state.motion is MotionKind.ARC_BY_POINT:
        return _arc_by_point(state, statement, travel)
    if state.motion is MotionKind.TANGENTIAL_ARC:
        return _tangential_arc(state, statement, travel)
    # G2 is clockwise in the view with X up and Z to the right. Blocks use the view with X down.
    clockwise = (state.motion is MotionKind.COUNTERCLOCKWISE) is not travel.frame.is_mirrored
    return clockwise, _compute_center(state, statement, travel, clockwise)


def _arc_by_point(
    state: SinumerikState, statement: Statement, travel: AxisTravel
) -> tuple[bool, tuple[Point, AxisTravel]]:
    """Return the arc of CIP through the start point, the point (I1, K1) and the end point."""
    begun, words = travel.program_start, statement.words
    if not _CIP_WORDS & words.keys():
        text = "CIP needs I1 and K1 to define a point on the arc."
        raise statement.make_error(
            statement.g_words.get("motion"), "arc-centre-missing", text, "Add I1 and K1."
        )
    relative = state.modal.absolute is False
    x, z = begun
    if "I1" in words:
        value = state.length(statement, words["I1"])
        halved = state.modal.diameter and not (relative and state.distance_is_radius)
        x = value / (2.0 if halved else 1.0) + (begun[0] if relative else 0.0)
    if "K1" in words:
        z = state.length(statement, words["K1"]) + (begun[1] if relative else 0.0)
    a, b, c = (travel.x0, travel.z0), travel.convert_to_machine_point(x, z), (travel.x, travel.z)
    across = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if abs(across) < MIN_PATH_MM * max(dist(a, b), dist(a, c), MIN_PATH_MM):
        text = (
            "the start point, the end point and the intermediate point (I1, K1) are on one "
            "line, or two of them are identical."
        )
        word = words.get("I1") or words.get("K1")
        raise statement.make_error(word, "arc-radius", text, "Correct the point, or write G1.")
    return _clockwise(across), (_circumcenter(a, b, c), travel)


def _clockwise(across: float) -> bool:
    """Return whether a cross product of two directions means clockwise rotation (X down)."""
    return across < 0.0


def _circumcenter(a: Point, b: Point, c: Point) -> Point:
    """Return the center of the circle through three points.

    The calculation is relative to the first point for better precision.
    """
    bx, bz, cx, cz = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    twice = 2.0 * (bx * cz - bz * cx)
    b2, c2 = bx * bx + bz * bz, cx * cx + cz * cz
    return a[0] + (cz * b2 - bz * c2) / twice, a[1] + (bx * c2 - cx * b2) / twice


def _tangential_arc(
    state: SinumerikState, statement: Statement, travel: AxisTravel
) -> tuple[bool, tuple[Point, AxisTravel]]:
    """Return the arc of CT, which starts in the end direction of the previous path."""
    word = statement.g_words.get("motion")
    if state.direction is None:
        text = "CT continues a path, but no move precedes it."
        raise statement.make_error(word, "arc-centre-missing", text, "Program a move before this block.")
    _demand_ends(statement, word, travel.length_mm)
    ux, uz = state.direction
    dx, dz = travel.x - travel.x0, travel.z - travel.z0
    aside = ux * dz - uz * dx  # signed distance of the end from the tangent line
    if abs(aside) < MIN_PATH_MM:
        text = "the end point of CT is in line with the previous path, so no arc is possible."
        raise statement.make_error(word, "arc-radius", text, "Write G1, or change the end point.")
    far = (dx * dx + dz * dz) / (2.0 * aside)
    centre = travel.x0 - uz * far, travel.z0 + ux * far
    return _clockwise(aside), (centre, travel)


def _compute_center(
    state: SinumerikState, statement: Statement, travel: AxisTravel, clockwise: bool
) -> tuple[Point, AxisTravel]:
    """Return the center of the arc in machine coordinates, and the travel to its end point.

    If the end point is not programmed, it is calculated.
    """
    words, by_centre = statement.words, {"I", "K"} & statement.words.keys()
    if "CR" in words and ("AR" in words or by_centre):
        text = "the arc has CR and another definition of its center."
        raise statement.make_error(words["CR"], "arc-both", text, "Keep only one of the conflicting words.")
    if "CR" in words:
        return _center_by_radius(state, statement, travel, clockwise), travel
    if "AR" in words:
        if {"X", "Z", "RP", "AP"} & words.keys():
            return _center_by_angle(state, statement, travel, clockwise), travel
        return _end_by_angle(state, statement, travel, clockwise)
    if not by_centre:
        text = "the arc needs CR, AR, or I and K."
        hint = "Add one of the missing values."
        raise statement.make_error(statement.g_words.get("motion"), "arc-centre-missing", text, hint)
    centre = _center_by_words(state, statement, travel)
    _check_radii(statement, travel, centre)
    return centre, travel


def _center_by_words(state: SinumerikState, statement: Statement, travel: AxisTravel) -> Point:
    """Return the center from I and K, which are distances from the start point, or coordinates with AC( )."""
    begun = travel.program_start
    i, k = _component(state, statement, "I", begun[0]), _component(state, statement, "K", begun[1])
    x, z = travel.frame.convert_to_machine_distance(i, k)
    return travel.x0 + x, travel.z0 + z


def _component(state: SinumerikState, statement: Statement, name: str, start: float) -> float:
    word = statement.words.get(name)
    if word is None:
        return 0.0
    value = state.length(statement, word)
    if word.position_mode is not PositionMode.AC:
        return value  # a radius, independent of DIAMON
    return value / (2.0 if name == "I" and state.modal.diameter else 1.0) - start


def _center_by_radius(
    state: SinumerikState, statement: Statement, travel: AxisTravel, clockwise: bool
) -> Point:
    """Return the center from CR.

    CR is positive for arcs of up to half a circle, and negative for larger arcs.
    """
    word = statement.words["CR"]
    radius, chord = state.length(statement, word) * travel.frame.scale_factor, travel.length_mm
    _demand_ends(statement, word, chord)
    if chord > 2 * abs(radius) + _TOLERANCE:
        text = (
            "{word} is too small: it must be at least half the distance between the arc ends, which is "
            "{chord} mm."
        )
        hint = "Correct CR or the end point."
        raise statement.make_error(word, "arc-radius", text, hint, word=word.text, chord=f"{chord:.4f}")
    side = clockwise if radius > 0 else not clockwise
    return find_arc_center((travel.x0, travel.z0), (travel.x, travel.z), abs(radius), is_clockwise=side)


def _center_by_angle(
    state: SinumerikState, statement: Statement, travel: AxisTravel, clockwise: bool
) -> Point:
    """Return the center from AR and the end point, with the radius r = chord / (2 sin(angle / 2))."""
    word, chord = statement.words["AR"], travel.length_mm
    _demand_ends(statement, word, chord)
    half = radians(_angle(state, statement, word)) / 2
    if {"I", "K"} & statement.words.keys():
        text = "the arc has AR, an end point and a center, but only two of them are allowed."
        hint = "Keep only two of the three: AR, the end point and the center."
        raise statement.make_error(word, "arc-both", text, hint)
    # The center of a clockwise arc is to the right of the chord. Above half a circle, the cotangent changes
    # the side.
    aside = (0.5 if clockwise else -0.5) / tan(half)
    dx, dz = travel.x - travel.x0, travel.z - travel.z0
    return (travel.x0 + travel.x) / 2 + aside * dz, (travel.z0 + travel.z) / 2 - aside * dx


def _end_by_angle(
    state: SinumerikState, statement: Statement, travel: AxisTravel, clockwise: bool
) -> tuple[Point, AxisTravel]:
    """Return the center, and the travel to the calculated end point.

    The end point is the start point rotated about the center by AR.
    """
    word = statement.words["AR"]
    if not {"I", "K"} & statement.words.keys():
        text = "AR is programmed without an end point and without I and K."
        raise statement.make_error(word, "arc-centre-missing", text, "Add one of the missing values.")
    centre = _center_by_words(state, statement, travel)
    x, z = travel.x0 - centre[0], travel.z0 - centre[1]
    if hypot(x, z) < MIN_PATH_MM:
        text = "the center of the arc is its start point."
        raise statement.make_error(word, "arc-radius", text, "Correct I and K.")
    angle = radians(_angle(state, statement, word))
    turned = atan2(x, z) + (angle if clockwise else -angle)  # from Z+ toward X+ is clockwise with X down
    radius = hypot(x, z)
    end = centre[0] + radius * sin(turned), centre[1] + radius * cos(turned)
    return centre, travel._replace(x=end[0], z=end[1])


def _angle(state: SinumerikState, statement: Statement, word: Word) -> float:
    angle = state.number(statement, word)
    if not 0.0 < angle < 360.0:
        text = "{word}: an opening angle must be greater than 0 and less than 360 degrees."
        raise statement.make_error(
            word, "arc-angle", text, "Program a full circle with I and K.", word=word.text
        )
    return angle


def _demand_ends(statement: Statement, word: Word | None, chord: float) -> None:
    if chord < MIN_PATH_MM:
        by = f" by {word.name}" if word else ""
        text = "the arc{name} ends where it starts."
        raise statement.make_error(word, "arc-no-chord", text, "Program a full circle with I and K.", name=by)


def _check_radii(statement: Statement, travel: AxisTravel, centre: Point) -> None:
    word = statement.words.get("I") or statement.words.get("K")
    first, last = dist((travel.x0, travel.z0), centre), dist((travel.x, travel.z), centre)
    if first < MIN_PATH_MM:
        text = "the center of the arc is its start point."
        raise statement.make_error(word, "arc-radius", text, "Correct I and K.")
    if abs(first - last) > _TOLERANCE:
        text = Message(
            "the arc's radius is {first} mm at its start and {last} mm at its end.",
            first=f"{first:.4f}",
            last=f"{last:.4f}",
        )
        hint = (
            "Enter I and K as distances from the start point (I as a radius), or as coordinates with AC( )."
        )
        error: ProgramError = statement.make_error(word, WRONG_ARC_END, text, hint)
        raise error
