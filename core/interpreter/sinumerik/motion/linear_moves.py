"""Straight moves with G0 and G1, with or without C: their end points, feeds and blocks."""

from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, radians, sin, tan
from typing import NamedTuple

from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.contour_stage import AdjustedMoveFactory, make_element
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.sinumerik.motion import third_axis
from core.interpreter.sinumerik.motion.sinumerik_feeds import check_block_feed
from core.interpreter.sinumerik.setup.modes_and_offsets import check_c_word, check_working_area
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from core.interpreter.sinumerik.sinumerik_state import IDENTITY_FRAME, MotionKind, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import ARC_WORDS, PositionMode, Word
from core.language.sinumerik.word_table import SUPPRESSION_GROUP

# --- end points in machine coordinates


MIN_PATH_MM = 1e-6
"""Path length of X and Z in mm below which a block has no path, and F applies to C."""


class AxisTravel(NamedTuple):
    """The start and end of a move in machine coordinates.

    Positions are in mm with X as a radius. C is in continuous degrees, or in mm for a linear third axis.
    ``offset_x``, ``offset_z``, ``modal`` and ``frame`` are those of the block. Under G53, only the offset
    of the cutting edge applies.
    """

    x0: float
    z0: float
    c0: float
    x: float
    z: float
    c: float
    modal_state: ModalState
    offset_x: float
    offset_z: float
    frame: ProgrammedFrame = IDENTITY_FRAME

    @property
    def length_mm(self) -> float:
        """Return the length of the straight path of X and Z, in mm."""
        return hypot(self.x - self.x0, self.z - self.z0)

    @property
    def c_travel(self) -> float:
        """Return the signed travel of C in degrees, or in mm for a linear third axis."""
        return self.c - self.c0

    @property
    def program_start(self) -> tuple[float, float]:
        """Return X (as a radius) and Z of the start in the program frame, in mm."""
        return self.frame.convert_to_program_distance(self.x0 - self.offset_x, self.z0 - self.offset_z)

    def convert_to_machine_point(self, x: float, z: float) -> tuple[float, float]:
        """Return machine X and Z of a program point."""
        x, z = self.frame.convert_to_machine_distance(x, z)
        return x + self.offset_x, z + self.offset_z

    def compute_rapid_rate(self, max_axis_speeds: tuple[float, float, float]) -> float:
        """Return the rapid rate along the path in mm/s, or in degrees/s if only a rotary C moves.

        ``max_axis_speeds`` are the maximum speeds of X, Z and C. The slowest axis moves at its maximum speed.
        """
        travels = (self.x - self.x0, self.z - self.z0, self.c_travel)
        time = max(abs(travel) / speed for travel, speed in zip(travels, max_axis_speeds, strict=True))
        return (self.length_mm or abs(self.c_travel)) / time if time else min(max_axis_speeds)


def compute_axis_travel(state: SinumerikState, statement: Statement) -> AxisTravel:
    """Return the travel of a block.

    Raises ProgramError if a word is invalid or the end point is outside the working area.
    """
    check_c_word(state, statement)
    modal, frame = state.modal, state.programmed_frame
    dx, dz = modal.offset_x, modal.offset_z
    if SUPPRESSION_GROUP in statement.g_words:
        frame, dx, dz = (
            IDENTITY_FRAME,
            modal.drawing_zero_x - modal.zero_offset_x,
            modal.drawing_zero_z - modal.zero_offset_z,
        )
        modal = modal._replace(offset_c=0.0)
    still = AxisTravel(state.x, state.z, state.c, state.x, state.z, state.c, modal, dx, dz, frame)
    x, z = _ends(state, statement, still)
    travel = still._replace(x=x, z=z, c=state.c + _turn(state, statement, modal))
    check_working_area(state, statement, travel.x, travel.z)
    return travel._replace(x=state.x, z=state.z) if travel.length_mm < MIN_PATH_MM else travel


def _ends(state: SinumerikState, statement: Statement, start_travel: AxisTravel) -> tuple[float, float]:
    """Return machine X and Z of the end point."""
    words = statement.words
    if "RP" in words or "AP" in words:
        return start_travel.convert_to_machine_point(*_polar_end(state, statement))
    begun = start_travel.program_start
    x, z = _linear_end(state, statement, "X", begun[0]), _linear_end(state, statement, "Z", begun[1])
    if "ANG" in words:
        x, z = _inclined(state, statement, begun, x, z)
    if x is None and z is None:
        return start_travel.x, start_travel.z
    there = start_travel.convert_to_machine_point(begun[0] if x is None else x, begun[1] if z is None else z)
    if not start_travel.frame.is_shift_only:
        return there
    return (start_travel.x if x is None else there[0]), (start_travel.z if z is None else there[1])


def _linear_end(state: SinumerikState, statement: Statement, name: str, start: float) -> float | None:
    """Return the end position of a linear axis in the program frame, or None if its word is missing."""
    word = statement.words.get(name)
    if word is None:
        return None
    if word.position_mode in third_axis.MODULO_ONLY_ALARMS:
        raise statement.make_error(
            word,
            third_axis.MODULO_ONLY_ALARMS[word.position_mode],
            "{word}: {form} needs a rotary axis.",
            "Write {name}=AC( ) or {name2}=IC( ).",
            word=word.text,
            form=word.position_mode,
            name=name,
            name2=name,
        )
    relative = _form(state, word) is PositionMode.IC
    halved = name == "X" and state.modal.diameter and not (relative and state.distance_is_radius)
    value = state.length(statement, word) / (2.0 if halved else 1.0)
    if not relative:
        state.moved_by_tool.discard(name)
        return value
    if name in state.moved_by_tool:
        text = "{word} is incremental, but T or D has just changed the position of {name}."
        hint = "Program a position of {name} before this block."
        raise statement.make_error(word, "distance-behind-tool", text, hint, word=word.text, name=name)
    return start + value


def _polar_end(state: SinumerikState, statement: Statement) -> tuple[float, float]:
    """Return the point that RP (radius) and AP (angle) define about the pole.

    If RP or AP is missing, its last value applies.
    """
    last = state.last_polar_point or (0.0, 0.0)
    radius, angle = statement.words.get("RP"), statement.words.get("AP")
    for name in ("X", "Z", "ANG"):
        if name in statement.words:
            text = "{text} cannot be combined with RP and AP."
            hint = "Remove this word, or remove RP and AP."
            raise statement.make_error(
                statement.words[name], "polar-both", text, hint, text=statement.words[name].text
            )
    if (radius is None or angle is None) and state.last_polar_point is None:
        text = "the first polar move needs RP and AP."
        raise statement.make_error(radius or angle, "polar-half", text, "Write both RP and AP.")
    far = last[0] if radius is None else state.length(statement, radius)
    turn = last[1] if angle is None else state.number(statement, angle)
    far += last[0] if radius is not None and radius.position_mode is PositionMode.IC else 0.0
    turn += last[1] if angle is not None and angle.position_mode is PositionMode.IC else 0.0
    text = "The resulting RP is less than 0."
    statement.require_condition(far >= 0.0, radius, "not-positive", text, "Correct the value.")
    state.last_polar_point = far, turn
    state.moved_by_tool.clear()
    return state.pole[0] + far * sin(radians(turn)), state.pole[1] + far * cos(radians(turn))


_STEEP = 1e-9


def _inclined(
    state: SinumerikState, statement: Statement, start: tuple[float, float], x: float | None, z: float | None
) -> tuple[float | None, float | None]:
    """Return the end point of a line that is programmed with its angle and one coordinate."""
    word = statement.words["ANG"]
    if state.motion is not MotionKind.LINE and state.motion is not MotionKind.RAPID:
        text = "{word} can be used only in a straight move."
        raise statement.make_error(word, "word-unused", text, "Write G1.", word=word.text)
    if x is None and z is None:
        text = (
            "{word} without X or Z begins a contour of two straight lines, which TurnDesk does not support."
        )
        hint = "Add X or Z of the end point to the block."
        raise statement.make_error(word, "not-in-subset", text, hint, word=word.text)
    if x is not None and z is not None:
        text = "{word} cannot be combined with both X and Z, which define the end point."
        raise statement.make_error(
            word, "angle-both", text, "Program only X or only Z with ANG.", word=word.text
        )
    angle = radians(state.number(statement, word))
    if x is None and z is not None:
        text = "this straight line never reaches the programmed Z."
        statement.require_condition(
            abs(cos(angle)) >= _STEEP, word, "angle-none", text, "Write X together with ANG."
        )
        return start[0] + (z - start[1]) * tan(angle), z
    assert x is not None
    text = "this straight line never reaches the programmed X."
    statement.require_condition(
        abs(sin(angle)) >= _STEEP, word, "angle-none", text, "Write Z together with ANG."
    )
    return x, start[1] + (x - start[0]) / tan(angle)


def _turn(state: SinumerikState, statement: Statement, modal: ModalState) -> float:
    """Return the signed travel of C in degrees, or in mm for a linear third axis."""
    word = statement.words.get("C")
    if word is None:
        return 0.0
    return compute_c_travel(state, statement, word, _form(state, word), state.c - modal.offset_c)


def compute_c_travel(
    state: SinumerikState,
    statement: Statement,
    word: Word,
    position_form: PositionMode,
    start_position: float,
) -> float:
    """Return the signed travel of C from ``start_position`` to the target of a word.

    The travel and ``start_position`` are in degrees, or in mm for a linear third axis. Raises ProgramError if
    the target is not possible.
    """
    value = state.third(statement, word)
    limits = state.setup.limits
    try:
        if limits.is_c_modulo:
            return third_axis.compute_modulo_travel(position_form, value, start_position)
        travel = third_axis.compute_linear_travel(position_form, value, start_position)
        third_axis.check_axis_range(
            state.c + travel, limits.c_travel_range if limits.is_c_linear else third_axis.NON_MODULO_RANGE
        )
    except third_axis.AxisTargetError as problem:
        raise statement.make_error(
            word,
            problem.alarm_number,
            "{word}: {problem}.",
            _hint(problem.alarm_number, linear=limits.is_c_linear),
            word=word.text,
            problem=problem,
        ) from None
    return travel


def _form(state: SinumerikState, word: Word) -> PositionMode:
    """Return whether a word is absolute or incremental; without AC or IC, G90 or G91 applies."""
    if word.position_mode is not PositionMode.PLAIN:
        return word.position_mode
    return PositionMode.IC if state.modal.absolute is False else PositionMode.AC


def _hint(number: int, *, linear: bool) -> str:
    if linear and number != third_axis.WRONG_AXIS_RANGE:
        return "This axis is linear; write AC( ) or IC( )."
    return _HINTS[number]


_WHOLE_TURN = "Write an angle from 0 to 359.999, or IC( ) for an incremental move."
_NOT_MODULO = "This axis ranges from -360 to +360; write AC( ) or IC( )."
_HINTS = {
    third_axis.WRONG_MODULO_POSITION: _WHOLE_TURN,
    third_axis.WRONG_AXIS_RANGE: ("Correct the target or the axis offset."),
    **dict.fromkeys(third_axis.MODULO_ONLY_ALARMS.values(), _NOT_MODULO),
}


def make_straight_block(state: SinumerikState, statement: Statement) -> Block:
    """Return the block of a G0 or G1 move.

    Raises ProgramError if its words are invalid or, for G1, if no valid feed is active.
    """
    for name in sorted(ARC_WORDS & statement.words.keys()):
        raise statement.make_error(
            statement.words[name],
            "word-unused",
            "{text} can be used only in an arc, but G{motion} is active.",
            "Write G2 or G3, or remove the word.",
            text=statement.words[name].text,
            motion=f"{state.motion:d}",
        )
    travel = compute_axis_travel(state, statement)
    if state.motion is MotionKind.RAPID:
        return make_rapid_block(state, statement, travel)
    kind = BlockKind.ROTATE if travel.c_travel and not travel.length_mm else BlockKind.FEED
    offset = travel.offset_x
    degrees = kind is BlockKind.ROTATE and not state.modal.is_c_linear
    feed = check_block_feed(state, statement, travel.x0 - offset, travel.x - offset, is_in_degrees=degrees)
    return make_travel_block(state, statement, travel, kind, feed)


def make_rapid_block(state: SinumerikState, statement: Statement, travel: AxisTravel) -> Block:
    """Return a rapid in which all axes arrive at the same time.

    The slowest axis moves at its maximum speed.
    """
    return make_travel_block(
        state,
        statement,
        travel,
        BlockKind.RAPID,
        travel.compute_rapid_rate(state.setup.limits.max_axis_speeds),
    )


def make_travel_block(
    state: SinumerikState, statement: Statement, travel: AxisTravel, kind: BlockKind, feed: float
) -> Block:
    """Return the block of a move, and set the state to the end of the move."""
    state.x, state.z, state.c = travel.x, travel.z, travel.c
    modal = travel.modal_state
    dx, dz, dc = travel.offset_x, travel.offset_z, modal.offset_c
    if travel.length_mm and kind is not BlockKind.ARC:
        state.direction = (travel.x - travel.x0) / travel.length_mm, (travel.z - travel.z0) / travel.length_mm
    return Block(
        n=0, line=statement.lexed_block.line_number, kind=kind, text=statement.lexed_block.text,
        x0=travel.x0 - dx, z0=travel.z0 - dz, c0=travel.c0 - dc,
        x=travel.x - dx, z=travel.z - dz, c=travel.c - dc,
        offset_x=dx, offset_z=dz, modal=modal, feed=feed,
        per_rev=modal.per_rev and kind is not BlockKind.RAPID and state.master == 1,
        rpm=state.compute_rpm_at_radius(travel.x - dx), css=state.css,
    )  # fmt: skip


def store_end_direction(state: SinumerikState, arc: Block) -> Block:
    """Store the end direction of an arc for a following CT, and return the arc."""
    state.direction = make_element(arc).end_direction
    return arc


class PlainMoveFactory(AdjustedMoveFactory):
    """Factory of blocks whose moves were changed by corners or nose compensation.

    The blocks retain their program text. In a rapid, the slowest axis moves at its maximum speed.
    """

    def __init__(self, state: SinumerikState) -> None:
        self._state = state

    @property
    def max_rpm(self) -> float:
        """Return the speed limit of the spindle in rpm, including the limit of G26."""
        return self._state.highest

    def replace_element(self, block: Block, element: Element) -> Block:
        """Return the block with its move changed to another element."""
        made = self._placed(block, element, block.text)
        if block.kind is not BlockKind.RAPID:
            return made
        zero = block.offset_x, block.offset_z
        travel = AxisTravel(*element.start, block.c0, *element.end, block.c, block.modal, *zero)
        return replace(made, feed=travel.compute_rapid_rate(self._state.setup.limits.max_axis_speeds))

    def insert_move(self, block: Block, element: Element) -> Block:
        """Return a new move of X and Z, to be inserted after a block; C remains at the block's target."""
        return replace(self.replace_element(block, element), c0=block.c, text=f"{block.text} ›")
