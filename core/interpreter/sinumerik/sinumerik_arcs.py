"""G2 and G3 in the plane of X and Z: end and centre, end and radius, or an opening angle."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, dist, hypot, radians, sin, tan

from core.geometry.lines_and_arcs import Point, centre_from_radius
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.sinumerik.linear_moves import NO_WAY, AxisTravel, block_of, check_feed, travel_of
from core.interpreter.sinumerik.sinumerik_state import State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Form, Word

_TOLERANCE = 0.01  # mm by which the radii at both ends may differ


def arc(state: State, statement: Statement) -> Block:
    """The arc of a block. Raises ProgramError where its words give none."""
    if state.plane != 18:
        raise statement.refuse(
            statement.g.get("motion"), "arc-plane", "arcs of X and Z need G18.", "Write G18 before it."
        )
    travel = travel_of(state, statement)
    # G2 is clockwise as seen with X up and Z to the right: with X down, as blocks count, it is the other way.
    clockwise = state.motion == 3
    centre, travel = _centre(state, statement, travel, clockwise)
    offset = travel.offset_x
    feed = check_feed(state, statement, travel.x0 - offset, travel.x - offset)
    made_block = block_of(state, statement, travel, Kind.ARC, feed)
    return replace(
        made_block, cx=centre[0] - travel.offset_x, cz=centre[1] - travel.offset_z, clockwise=clockwise
    )


def _centre(
    state: State, statement: Statement, travel: AxisTravel, clockwise: bool
) -> tuple[Point, AxisTravel]:
    """Machine coordinates of the centre, and the travel with its end where the words did not give one."""
    words, by_centre = statement.words, {"I", "K"} & statement.words.keys()
    if "CR" in words and ("AR" in words or by_centre):
        text = "the arc has CR and another way to say where its centre is."
        raise statement.refuse(words["CR"], "arc-both", text, "Keep one of them.")
    if "CR" in words:
        return _by_radius(state, statement, travel, clockwise), travel
    if "AR" in words:
        if {"X", "Z"} & words.keys():
            return _by_angle(state, statement, travel, clockwise), travel
        return _turned(state, statement, travel, clockwise)
    if not by_centre:
        text = "the arc has neither CR, AR nor I and K."
        raise statement.refuse(statement.g.get("motion"), "arc-centre-missing", text, "Add one of them.")
    centre = _by_words(state, statement, travel)
    _check_radii(statement, travel, centre)
    return centre, travel


def _by_words(state: State, statement: Statement, travel: AxisTravel) -> Point:
    """I and K: distances from the start, or coordinates with AC( )."""
    x = travel.x0 + _component(state, statement, "I", travel.x0, travel.offset_x)
    return x, travel.z0 + _component(state, statement, "K", travel.z0, travel.offset_z)


def _component(state: State, statement: Statement, name: str, start: float, offset: float) -> float:
    word = statement.words.get(name)
    if word is None:
        return 0.0
    value = state.length(statement, word)
    if word.form is not Form.AC:
        return value  # a radius, whatever DIAMON says
    return value / (2.0 if name == "I" and state.modal.diameter else 1.0) + offset - start


def _by_radius(state: State, statement: Statement, travel: AxisTravel, clockwise: bool) -> Point:
    """CR: over 0 for arcs of up to half a turn, under 0 for larger ones."""
    word = statement.words["CR"]
    radius, chord = state.length(statement, word), travel.length
    _demand_ends(statement, word, chord)
    if chord > 2 * abs(radius) + _TOLERANCE:
        text = (
            f"{word.text} is too small: the ends are {chord:.4f} mm apart, half of which it takes at least."
        )
        raise statement.refuse(word, "arc-radius", text, "Correct CR or the end point.")
    side = clockwise if radius > 0 else not clockwise
    return centre_from_radius((travel.x0, travel.z0), (travel.x, travel.z), abs(radius), clockwise=side)


def _by_angle(state: State, statement: Statement, travel: AxisTravel, clockwise: bool) -> Point:
    """AR and the end point: the centre lies on the bisector of the chord, r = chord / (2 sin(angle / 2))."""
    word, chord = statement.words["AR"], travel.length
    _demand_ends(statement, word, chord)
    half = radians(_angle(state, statement, word)) / 2
    if {"I", "K"} & statement.words.keys():
        raise statement.refuse(
            word, "arc-both", "the arc has AR, an end point and a centre.", "Keep two of them."
        )
    # To the right of the chord for a clockwise arc; for more than half a turn the cotangent changes side.
    aside = (0.5 if clockwise else -0.5) / tan(half)
    dx, dz = travel.x - travel.x0, travel.z - travel.z0
    return (travel.x0 + travel.x) / 2 + aside * dz, (travel.z0 + travel.z) / 2 - aside * dx


def _turned(
    state: State, statement: Statement, travel: AxisTravel, clockwise: bool
) -> tuple[Point, AxisTravel]:
    """AR and the centre: the end is the start turned about it."""
    word = statement.words["AR"]
    if not {"I", "K"} & statement.words.keys():
        text = "AR stands without an end point and without I and K."
        raise statement.refuse(word, "arc-centre-missing", text, "Add one of them.")
    centre = _by_words(state, statement, travel)
    x, z = travel.x0 - centre[0], travel.z0 - centre[1]
    if hypot(x, z) < NO_WAY:
        raise statement.refuse(
            word, "arc-radius", "the centre of the arc is its start point.", "Correct I and K."
        )
    angle = radians(_angle(state, statement, word))
    turned = atan2(x, z) + (angle if clockwise else -angle)  # from Z+ towards X+ is clockwise with X down
    radius = hypot(x, z)
    end = centre[0] + radius * sin(turned), centre[1] + radius * cos(turned)
    return centre, travel._replace(x=end[0], z=end[1])


def _angle(state: State, statement: Statement, word: Word) -> float:
    angle = state.number(statement, word)
    if not 0.0 < angle < 360.0:
        text = f"{word.text}: an opening angle lies over 0 and under 360."
        raise statement.refuse(word, "arc-angle", text, "A full circle takes I and K.")
    return angle


def _demand_ends(statement: Statement, word: Word, chord: float) -> None:
    if chord < NO_WAY:
        text = f"the arc by {word.name} ends where it starts."
        raise statement.refuse(word, "arc-no-chord", text, "A full circle takes I and K.")


def _check_radii(statement: Statement, travel: AxisTravel, centre: Point) -> None:
    word = statement.words.get("I") or statement.words.get("K")
    first, last = dist((travel.x0, travel.z0), centre), dist((travel.x, travel.z), centre)
    if first < NO_WAY:
        raise statement.refuse(
            word, "arc-radius", "the centre of the arc is its start point.", "Correct I and K."
        )
    if abs(first - last) > _TOLERANCE:
        text = f"the arc's radius is {first:.4f} mm at its start and {last:.4f} mm at its end."
        hint = "I and K are distances from the start, I a radius; AC( ) makes them coordinates."
        error: ProgramError = statement.refuse(word, "arc-radius", text, hint)
        raise error
