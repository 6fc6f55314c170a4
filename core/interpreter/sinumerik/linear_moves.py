"""G0 and G1, with C or without: where the words of a block lead, at which feed, and the block of the move."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.modal_state import Modal
from core.interpreter.sinumerik import third_axis
from core.interpreter.sinumerik.modes_and_offsets import check_c
from core.interpreter.sinumerik.sinumerik_state import State, positive
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import ARC, Form, Word

# --- where the words lead, in machine coordinates


NO_WAY = 1e-6
"""mm of X and Z together below which a block has no path, and F belongs to C."""


class AxisTravel(NamedTuple):
    """From where to where, machine coordinates: mm, X a radius, C in degrees over its turns.

    ``offset_x offset_z`` and ``modal`` hold the frame of the block: none under G53.
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

    @property
    def length(self) -> float:
        """mm of the straight path of X and Z."""
        return hypot(self.x - self.x0, self.z - self.z0)

    @property
    def turn(self) -> float:
        """Signed travel of C, degrees."""
        return self.c - self.c0

    def rapid_rate(self, speeds: tuple[float, float, float]) -> float:
        """Speed along the path of a rapid, or of C where there is none: mm/s or degrees/s.

        The slowest axis goes at its limit, ``speeds`` of X, Z and C.
        """
        ways = (self.x - self.x0, self.z - self.z0, self.turn)
        time = max(abs(way) / speed for way, speed in zip(ways, speeds, strict=True))
        return (self.length or abs(self.turn)) / time if time else min(speeds)


def travel_of(state: State, statement: Statement) -> AxisTravel:
    """Where a block leads. Raises ProgramError for a word that names no place."""
    check_c(state, statement)
    modal = state.modal
    dx, dz = modal.offset_x, modal.offset_z
    if "suppression of offsets" in statement.g:
        modal, dx, dz = modal._replace(offset_c=0.0), 0.0, 0.0
    x, z = _slide(state, statement, "X", state.x, dx), _slide(state, statement, "Z", state.z, dz)
    travel = AxisTravel(
        state.x, state.z, state.c, x, z, state.c + _turn(state, statement, modal), modal, dx, dz
    )
    return travel._replace(x=state.x, z=state.z) if travel.length < NO_WAY else travel


def _slide(state: State, statement: Statement, name: str, at: float, offset: float) -> float:
    """The end of a linear axis."""
    word = statement.words.get(name)
    if word is None:
        return at
    if word.form in third_axis.NO_ROTARY:
        text = f"{word.text}: {word.form} needs a rotary axis."
        raise statement.refuse(
            word, third_axis.NO_ROTARY[word.form], text, f"Write {name}=AC( ) or {name}=IC( )."
        )
    value = state.length(statement, word) / (2.0 if name == "X" and state.modal.diameter else 1.0)
    return at + value if _form(state, word) is Form.IC else value + offset


def _turn(state: State, statement: Statement, modal: Modal) -> float:
    """Signed travel of C."""
    word = statement.words.get("C")
    if word is None:
        return 0.0
    value, form, at = state.number(statement, word), _form(state, word), state.c - modal.offset_c
    try:
        if state.setup.limits.c_modulo:
            return third_axis.modulo_travel(form, value, at)
        travel = third_axis.linear_travel(form, value, at)
        third_axis.check_reach(state.c + travel)
    except third_axis.TargetError as problem:
        raise statement.refuse(
            word, problem.number, f"{word.text}: {problem}.", _HINTS[problem.number]
        ) from None
    return travel


def _form(state: State, word: Word) -> Form:
    """How the word is meant; what it does not say itself G90 and G91 do."""
    if word.form is not Form.PLAIN:
        return word.form
    return Form.IC if state.modal.absolute is False else Form.AC


_WHOLE_TURN = "Write an angle from 0 to 359.999, or IC( ) for a distance."
_NOT_MODULO = "C of this machine counts -360 to +360; write AC( ) or IC( )."
_HINTS = {
    third_axis.WRONG_MODULO: _WHOLE_TURN,
    third_axis.WRONG_RANGE: "Correct the target or the offset of C.",
    **dict.fromkeys(third_axis.NO_ROTARY.values(), _NOT_MODULO),
}

# --- feed: one word, read by the kind of block


NO_FEED = 10860


def feed_words(state: State, statement: Statement) -> None:
    """G94, G95 and F of a block. Changing between the two forgets F. Raises ProgramError."""
    code = statement.code("kind of feed")
    if code is not None and (code == 95) != state.modal.per_rev:
        state.adopt(state.modal._replace(per_rev=code == 95, feed=None))
    word = statement.words.get("F")
    if word is None or statement.code("dwell") is not None:
        return
    value = positive(statement, word, state.number(statement, word), "the feed")
    # mm/min and degrees/min, or mm and degrees a revolution: the kind of block tells which.
    state.adopt(state.modal._replace(feed=value if state.modal.per_rev else value / 60.0))


def check_feed(state: State, statement: Statement, x0: float, x1: float) -> float:
    """The feed in force for a block from radius ``x0`` to ``x1``, mm (degrees) a second or a revolution.

    Raises ProgramError: alarm 10860 where there is none; ours where G95 has no speed to go by.
    """
    modal = state.modal
    if modal.feed is None:
        hint = "Write F. Between G94 and G95 the old value is forgotten."
        raise statement.refuse(_mover(statement), NO_FEED, "no feedrate is programmed.", hint)
    if modal.css and modal.spindle and not modal.surface_speed:
        text = "G96 is in force and no S has given a surface speed."
        raise statement.refuse(statement.words.get("S"), "surface-speed-missing", text, "Write S beside G96.")
    if modal.per_rev and not (state.rpm_at(x0) and state.rpm_at(x1)):
        text = "no spindle speed for G95: the spindle stands."
        raise statement.refuse(
            _mover(statement), "g95-spindle-stopped", text, "Start it with S and M3 or M4, or use G94."
        )
    return modal.feed


def _mover(statement: Statement) -> Word | None:
    """The word that wants to move."""
    return next((statement.words[name] for name in statement.axes), None)


def straight(state: State, statement: Statement) -> Block:
    """G0 or G1 to where the words lead. Raises ProgramError."""
    for name in sorted(ARC & statement.words.keys()):
        text = f"{statement.words[name].text} belongs to an arc, and G{state.motion} is in force."
        raise statement.refuse(statement.words[name], "word-unused", text, "Write G2 or G3, or take it out.")
    travel = travel_of(state, statement)
    offset = travel.offset_x
    if state.motion == 0:
        speeds = state.setup.limits.speeds
        return block_of(state, statement, travel, Kind.RAPID, travel.rapid_rate(speeds))
    feed = check_feed(state, statement, travel.x0 - offset, travel.x - offset)
    kind = Kind.ROTATE if travel.turn and not travel.length else Kind.FEED
    return block_of(state, statement, travel, kind, feed)


def block_of(state: State, statement: Statement, travel: AxisTravel, kind: Kind, feed: float) -> Block:
    """The block of a move; the state then stands at its end."""
    state.x, state.z, state.c = travel.x, travel.z, travel.c
    modal = travel.modal
    dx, dz, dc = travel.offset_x, travel.offset_z, modal.offset_c
    return Block(
        n=0, line=statement.line.number, kind=kind, text=statement.line.text,
        x0=travel.x0 - dx, z0=travel.z0 - dz, c0=travel.c0 - dc,
        x=travel.x - dx, z=travel.z - dz, c=travel.c - dc,
        offset_x=dx, offset_z=dz, modal=modal, feed=feed, per_rev=modal.per_rev and kind is not Kind.RAPID,
        rpm=state.rpm_at(travel.x - dx), css=state.css,
    )  # fmt: skip
