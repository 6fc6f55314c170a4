"""Lines with G0 and G1, with or without C: end points, feeds and blocks, also for trimmed moves."""

from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, radians, sin, tan
from typing import NamedTuple

from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.contour_stage import AdjustedMoves, element_of
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.shared.modal_state import Modal
from core.interpreter.sinumerik.motion import third_axis
from core.interpreter.sinumerik.motion.sinumerik_feeds import check_feed
from core.interpreter.sinumerik.setup.modes_and_offsets import check_area, check_c
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from core.interpreter.sinumerik.sinumerik_state import NO_FRAME, Motion, State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import ARC, Form, Word
from core.language.sinumerik.word_table import SUPPRESSION

# --- end points in machine coordinates


NO_WAY = 1e-6
"""mm of X and Z together below which a block has no path, and F belongs to C."""


class AxisTravel(NamedTuple):
    """Start and end of a move in machine coordinates: mm, X as a radius, C in continuous degrees.

    ``offset_x offset_z``, ``modal`` and ``frame`` are those of the block; under G53, only the offset of the
    edge applies.
    """

    x0: float
    z0: float
    c0: float
    x: float
    z: float
    c: float
    modal: Modal
    offset_x: float
    offset_z: float
    frame: ProgrammedFrame = NO_FRAME

    @property
    def length(self) -> float:
        """Length of the straight path of X and Z, in mm."""
        return hypot(self.x - self.x0, self.z - self.z0)

    @property
    def turn(self) -> float:
        """Signed travel of C, in degrees."""
        return self.c - self.c0

    @property
    def begun(self) -> tuple[float, float]:
        """X (radius) and Z of the start in the program frame, in mm."""
        return self.frame.unturned(self.x0 - self.offset_x, self.z0 - self.offset_z)

    def placed(self, x: float, z: float) -> tuple[float, float]:
        """Return machine X and Z of a point of the program."""
        x, z = self.frame.turned(x, z)
        return x + self.offset_x, z + self.offset_z

    def rapid_rate(self, speeds: tuple[float, float, float]) -> float:
        """Return the rapid speed along the path in mm/s, or of C alone in degrees/s.

        ``speeds`` are the limits of X, Z and C; the slowest axis moves at its limit.
        """
        ways = (self.x - self.x0, self.z - self.z0, self.turn)
        time = max(abs(way) / speed for way, speed in zip(ways, speeds, strict=True))
        return (self.length or abs(self.turn)) / time if time else min(speeds)


def travel_of(state: State, statement: Statement) -> AxisTravel:
    """Return the travel of a block. Raises ProgramError if a word is invalid."""
    check_c(state, statement)
    modal, frame = state.modal, state.programmed
    dx, dz = modal.offset_x, modal.offset_z
    if SUPPRESSION in statement.g:
        frame, dx, dz = NO_FRAME, modal.base_x - modal.settable_x, modal.base_z - modal.settable_z
        modal = modal._replace(offset_c=0.0)
    still = AxisTravel(state.x, state.z, state.c, state.x, state.z, state.c, modal, dx, dz, frame)
    x, z = _ends(state, statement, still)
    travel = still._replace(x=x, z=z, c=state.c + _turn(state, statement, modal))
    check_area(state, statement, travel.x, travel.z)
    return travel._replace(x=state.x, z=state.z) if travel.length < NO_WAY else travel


def _ends(state: State, statement: Statement, still: AxisTravel) -> tuple[float, float]:
    """Return machine X and Z of the end."""
    words = statement.words
    if "RP" in words or "AP" in words:
        return still.placed(*_polar(state, statement))
    begun = still.begun
    x, z = _slide(state, statement, "X", begun[0]), _slide(state, statement, "Z", begun[1])
    if "ANG" in words:
        x, z = _inclined(state, statement, begun, x, z)
    if x is None and z is None:
        return still.x, still.z
    there = still.placed(begun[0] if x is None else x, begun[1] if z is None else z)
    if not still.frame.plain:
        return there
    return (still.x if x is None else there[0]), (still.z if z is None else there[1])


def _slide(state: State, statement: Statement, name: str, begun: float) -> float | None:
    """Return the end of a linear axis in the program frame; None without its word."""
    word = statement.words.get(name)
    if word is None:
        return None
    if word.form in third_axis.NO_ROTARY:
        raise statement.refuse(
            word,
            third_axis.NO_ROTARY[word.form],
            "{word}: {form} needs a rotary axis.",
            "Write {name}=AC( ) or {name2}=IC( ).",
            word=word.text,
            form=word.form,
            name=name,
            name2=name,
        )
    relative = _form(state, word) is Form.IC
    halved = name == "X" and state.modal.diameter and not (relative and state.distance_is_radius)
    value = state.length(statement, word) / (2.0 if halved else 1.0)
    if not relative:
        state.moved_by_tool.discard(name)
        return value
    if name in state.moved_by_tool:
        text = "{word} is incremental, but T or D has just changed the position of {name}."
        hint = "Program a position of {name} before this block."
        raise statement.refuse(word, "distance-behind-tool", text, hint, word=word.text, name=name)
    return begun + value


def _polar(state: State, statement: Statement) -> tuple[float, float]:
    """Return the point of RP and AP about the pole; a missing value is unchanged."""
    last = state.polar or (0.0, 0.0)
    radius, angle = statement.words.get("RP"), statement.words.get("AP")
    for name in ("X", "Z", "ANG"):
        if name in statement.words:
            text = "{text} cannot be combined with RP and AP."
            hint = "Remove this word, or remove RP and AP."
            raise statement.refuse(
                statement.words[name], "polar-both", text, hint, text=statement.words[name].text
            )
    if (radius is None or angle is None) and state.polar is None:
        text = "the first polar move needs RP and AP."
        raise statement.refuse(radius or angle, "polar-half", text, "Write both RP and AP.")
    far = last[0] if radius is None else state.length(statement, radius)
    turn = last[1] if angle is None else state.number(statement, angle)
    far += last[0] if radius is not None and radius.form is Form.IC else 0.0
    turn += last[1] if angle is not None and angle.form is Form.IC else 0.0
    text = "The resulting RP is less than 0."
    statement.check(far >= 0.0, radius, "not-positive", text, "Correct the value.")
    state.polar = far, turn
    state.moved_by_tool.clear()
    return state.pole[0] + far * sin(radians(turn)), state.pole[1] + far * cos(radians(turn))


_STEEP = 1e-9


def _inclined(
    state: State, statement: Statement, begun: tuple[float, float], x: float | None, z: float | None
) -> tuple[float | None, float | None]:
    """Return the end of a line from its angle and one coordinate."""
    word = statement.words["ANG"]
    if state.motion is not Motion.LINE and state.motion is not Motion.RAPID:
        text = "{word} can be used only in a straight move."
        raise statement.refuse(word, "word-unused", text, "Write G1.", word=word.text)
    if x is None and z is None:
        text = (
            "{word} without X or Z begins a contour of two straight lines, which TurnDesk does not support."
        )
        hint = "Add X or Z of the end point to the block."
        raise statement.refuse(word, "not-in-subset", text, hint, word=word.text)
    if x is not None and z is not None:
        text = "{word} cannot be combined with both X and Z, which define the end point."
        raise statement.refuse(word, "angle-both", text, "Program only X or only Z with ANG.", word=word.text)
    angle = radians(state.number(statement, word))
    if x is None and z is not None:
        text = "this straight line never reaches the programmed Z."
        statement.check(abs(cos(angle)) >= _STEEP, word, "angle-none", text, "Write X together with ANG.")
        return begun[0] + (z - begun[1]) * tan(angle), z
    assert x is not None
    text = "this straight line never reaches the programmed X."
    statement.check(abs(sin(angle)) >= _STEEP, word, "angle-none", text, "Write Z together with ANG.")
    return x, begun[1] + (x - begun[0]) / tan(angle)


def _turn(state: State, statement: Statement, modal: Modal) -> float:
    """Return the signed travel of C, in degrees."""
    word = statement.words.get("C")
    if word is None:
        return 0.0
    return turn_of_c(state, statement, word, _form(state, word), state.c - modal.offset_c)


def turn_of_c(state: State, statement: Statement, word: Word, form: Form, at: float) -> float:
    """Return the signed travel of C from ``at`` to the target of a word. Raises ProgramError."""
    value = state.third(statement, word)
    limits = state.setup.limits
    try:
        if limits.c_modulo:
            return third_axis.modulo_travel(form, value, at)
        travel = third_axis.linear_travel(form, value, at)
        third_axis.check_reach(state.c + travel, limits.c_travel if limits.c_linear else third_axis.TURNS)
    except third_axis.TargetError as problem:
        raise statement.refuse(
            word,
            problem.number,
            "{word}: {problem}.",
            _hint(problem.number, linear=limits.c_linear),
            word=word.text,
            problem=problem,
        ) from None
    return travel


def _form(state: State, word: Word) -> Form:
    """Return the form of a word; G90 and G91 determine a plain word."""
    if word.form is not Form.PLAIN:
        return word.form
    return Form.IC if state.modal.absolute is False else Form.AC


def _hint(number: int, *, linear: bool) -> str:
    if linear and number != third_axis.WRONG_RANGE:
        return "This axis is linear; write AC( ) or IC( )."
    return _HINTS[number]


_WHOLE_TURN = "Write an angle from 0 to 359.999, or IC( ) for an incremental move."
_NOT_MODULO = "This axis ranges from -360 to +360; write AC( ) or IC( )."
_HINTS = {
    third_axis.WRONG_MODULO: _WHOLE_TURN,
    third_axis.WRONG_RANGE: ("Correct the target or the axis offset."),
    **dict.fromkeys(third_axis.NO_ROTARY.values(), _NOT_MODULO),
}


def straight(state: State, statement: Statement) -> Block:
    """Return the block of a G0 or G1 move. Raises ProgramError if its words are invalid."""
    for name in sorted(ARC & statement.words.keys()):
        raise statement.refuse(
            statement.words[name],
            "word-unused",
            "{text} can be used only in an arc, but G{motion} is active.",
            "Write G2 or G3, or remove the word.",
            text=statement.words[name].text,
            motion=f"{state.motion:d}",
        )
    travel = travel_of(state, statement)
    if state.motion is Motion.RAPID:
        return rapid(state, statement, travel)
    kind = Kind.ROTATE if travel.turn and not travel.length else Kind.FEED
    offset = travel.offset_x
    degrees = kind is Kind.ROTATE and not state.modal.linear_c
    feed = check_feed(state, statement, travel.x0 - offset, travel.x - offset, in_degrees=degrees)
    return block_of(state, statement, travel, kind, feed)


def rapid(state: State, statement: Statement, travel: AxisTravel) -> Block:
    """Return a rapid in which all axes end together and the slowest axis moves at its limit."""
    return block_of(state, statement, travel, Kind.RAPID, travel.rapid_rate(state.setup.limits.speeds))


def block_of(state: State, statement: Statement, travel: AxisTravel, kind: Kind, feed: float) -> Block:
    """Return the block of a move, and set the state to its end."""
    state.x, state.z, state.c = travel.x, travel.z, travel.c
    modal = travel.modal
    dx, dz, dc = travel.offset_x, travel.offset_z, modal.offset_c
    if travel.length and kind is not Kind.ARC:
        state.direction = (travel.x - travel.x0) / travel.length, (travel.z - travel.z0) / travel.length
    return Block(
        n=0, line=statement.line.number, kind=kind, text=statement.line.text,
        x0=travel.x0 - dx, z0=travel.z0 - dz, c0=travel.c0 - dc,
        x=travel.x - dx, z=travel.z - dz, c=travel.c - dc,
        offset_x=dx, offset_z=dz, modal=modal, feed=feed,
        per_rev=modal.per_rev and kind is not Kind.RAPID and state.master == 1,
        rpm=state.rpm_at(travel.x - dx), css=state.css,
    )  # fmt: skip


def keep_direction(state: State, arc: Block) -> Block:
    """Store the end direction of an arc for CT, and return the arc."""
    state.direction = element_of(arc).end_direction
    return arc


class MovesAlong(AdjustedMoves):
    """Factory of adjusted moves that keep their text; a rapid takes the time of its slowest axis."""

    def __init__(self, state: State) -> None:
        self._state = state

    @property
    def highest_rpm(self) -> float:
        """The speed limit of the spindle in rpm, including that of G26."""
        return self._state.highest

    def along(self, block: Block, element: Element) -> Block:
        """Return the block with its move along another element."""
        made = self._placed(block, element, block.text)
        if block.kind is not Kind.RAPID:
            return made
        zero = block.offset_x, block.offset_z
        travel = AxisTravel(*element.start, block.c0, *element.end, block.c, block.modal, *zero)
        return replace(made, feed=travel.rapid_rate(self._state.setup.limits.speeds))

    def inserted(self, block: Block, element: Element) -> Block:
        """Return a new move of X and Z after a block; C has ended with that block."""
        return replace(self.along(block, element), c0=block.c, text=f"{block.text} ›")
