"""Where the words X, Z and C of a block lead, in machine coordinates, and how long a rapid to there takes."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

from core.interpreter.modal import Modal
from core.interpreter.sinumerik import targets
from core.interpreter.sinumerik.offsets import check_c
from core.interpreter.sinumerik.state import State
from core.interpreter.sinumerik.statement import Statement
from core.language.sinumerik.words import Form, Word

NO_WAY = 1e-6
"""mm of X and Z together below which a block has no path, and F belongs to C."""


class Way(NamedTuple):
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

    def rapid_time(self, speeds: tuple[float, float, float]) -> float:
        """Seconds that the slowest axis needs at its limit (``speeds`` of X, Z, C)."""
        return max(
            abs(self.x - self.x0) / speeds[0], abs(self.z - self.z0) / speeds[1], abs(self.turn) / speeds[2]
        )

    def rapid_rate(self, speeds: tuple[float, float, float]) -> float:
        """Speed along the path of a rapid, or of C where there is none: mm/s or degrees/s."""
        time = self.rapid_time(speeds)
        return (self.length or abs(self.turn)) / time if time else min(speeds)


def way_of(state: State, made: Statement) -> Way:
    """The way of a block. Raises ProgramError for a word that names no place."""
    check_c(state, made)
    modal = state.modal
    dx, dz = modal.offset_x, modal.offset_z
    if "suppression of offsets" in made.g:
        modal, dx, dz = modal._replace(offset_c=0.0), 0.0, 0.0
    x, z = _slide(state, made, "X", state.x, dx), _slide(state, made, "Z", state.z, dz)
    way = Way(state.x, state.z, state.c, x, z, state.c + _turn(state, made, modal), modal, dx, dz)
    return way._replace(x=state.x, z=state.z) if way.length < NO_WAY else way


def _slide(state: State, made: Statement, name: str, at: float, offset: float) -> float:
    """The end of a linear axis."""
    word = made.words.get(name)
    if word is None:
        return at
    if word.form in targets.NO_ROTARY:
        text = f"{word.text}: {word.form} needs a rotary axis."
        raise made.alarm(word, targets.NO_ROTARY[word.form], text, f"Write {name}=AC( ) or {name}=IC( ).")
    value = state.length(made, word) / (2.0 if name == "X" and state.modal.diameter else 1.0)
    return at + value if _form(state, word) is Form.IC else value + offset


def _turn(state: State, made: Statement, modal: Modal) -> float:
    """Signed travel of C."""
    word = made.words.get("C")
    if word is None:
        return 0.0
    value, form, at = state.number(made, word), _form(state, word), state.c - modal.offset_c
    try:
        if state.setup.limits.c_modulo:
            return targets.modulo_travel(form, value, at)
        way = targets.linear_travel(form, value, at)
        targets.check_reach(state.c + way)
    except targets.TargetError as problem:
        raise made.alarm(word, problem.number, f"{word.text}: {problem}.", _HINTS[problem.number]) from None
    return way


def _form(state: State, word: Word) -> Form:
    """How the word is meant; what it does not say itself G90 and G91 do."""
    if word.form is not Form.PLAIN:
        return word.form
    return Form.IC if state.modal.absolute is False else Form.AC


_WHOLE_TURN = "Write an angle from 0 to 359.999, or IC( ) for a distance."
_NOT_MODULO = "C of this machine counts -360 to +360; write AC( ) or IC( )."
_HINTS = {
    targets.WRONG_MODULO: _WHOLE_TURN,
    targets.WRONG_RANGE: "Correct the target or the offset of C.",
    **dict.fromkeys(targets.NO_ROTARY.values(), _NOT_MODULO),
}
