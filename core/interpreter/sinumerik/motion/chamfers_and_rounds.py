"""Chamfers and roundings with CHF, CHR and RND between lines and arcs.

C ends its move with the first element.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Never

from core.geometry.chamfer_and_rounding import CornerError, chamfer, leg_of, rounding
from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.contour_stage import FOLLOWED, CornerStage, HeldMove, element_of
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.sinumerik.motion.linear_moves import MovesAlong
from core.interpreter.sinumerik.motion.sinumerik_feeds import feed_of
from core.interpreter.sinumerik.sinumerik_state import State, positive
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Word
from core.message import Message

_CUT = FOLLOWED - {Kind.RAPID}


@dataclass(slots=True)
class Corner:
    """Corner at the end of a block. ``size`` in mm is the chamfer (CHF), its leg (CHR) or the radius (RND).

    At an arc, the leg is a chord.
    """

    statement: Statement
    word: Word
    size: float
    feed: float | None = None  # FRC, FRCM
    modal: bool = False  # RNDM: blocks that form no corner are not an error

    def refuse(self, code: str, why: str, hint: str) -> ProgramError:
        """Return an error at the corner's word."""
        return self.statement.refuse(
            self.word,
            code,
            Message("Corner {letter} is not possible: {why}.", letter=self.word.text, why=why),
            hint,
        )


def corner_of(state: State, statement: Statement, block: Block) -> Corner | None:
    """Return the corner of a block, or None. Raises ProgramError if it is invalid."""
    word = statement.corner
    if word is None:
        return _modal_corner(state, statement, block)
    size = positive(statement, word, state.length(statement, word), "the corner size")
    corner = Corner(statement, word, size, _feed(state, statement))
    if block.kind not in _CUT or not _moves(block):
        hint = "Use CHF, CHR and RND only with G1, G2 and G3."
        raise corner.refuse("corner-next", "the block is not a line or an arc", hint)
    if state.plane != 18:
        raise corner.refuse("corner-plane", "corners in X and Z need G18", "Write G18 before this block.")
    return corner


def _modal_corner(state: State, statement: Statement, block: Block) -> Corner | None:
    """Return the rounding of RNDM; None if the block is not a line or arc of the contour."""
    if not state.rounding or block.kind not in _CUT or not _moves(block) or state.plane != 18:
        return None
    word = Word("RND", state.rounding, 1, f"RNDM={state.rounding:g}")
    return Corner(statement, word, state.rounding, _feed(state, statement), modal=True)


def _feed(state: State, statement: Statement) -> float | None:
    word = statement.words.get("FRC")
    return state.corner_feed if word is None else feed_of(state, statement, word)


_Held = HeldMove[Corner, Never]


class Corners(CornerStage[Corner, Never]):
    """Corner stage for corners between lines and arcs."""

    def __init__(self, state: State, log: Log) -> None:
        super().__init__(MovesAlong(state))
        self._log = log

    def end(self) -> Iterator[Block]:
        """Yield the buffered blocks at the end of the program. Raises ProgramError if a corner remains."""
        held, self._held = self._held, None
        if held is not None and held.corner.modal:
            yield from (held.block, *held.between)
        elif held is not None:
            raise held.corner.refuse(
                "corner-next", "no move follows the corner", "Program two consecutive moves for the corner."
            )

    def _waits(self, held: _Held, item: Block) -> bool:
        del held
        return item.action is not None and not isinstance(item.action, ProgramEnd)

    def _meets(self, held: _Held, after: Block) -> bool:
        if after.kind in FOLLOWED and _moves(after):
            return not held.corner.modal or after.kind is not Kind.RAPID
        if held.corner.modal:
            return False
        why = Message("the next move, on line {line}, is not a line or an arc in X and Z", line=after.line)
        raise held.corner.refuse("corner-next", why, "Program two consecutive moves for the corner.")

    def _elements(self, corner: Corner, first: Element, last: Element) -> Sequence[Element]:
        if corner.word.name == "RND":
            return rounding(first, last, corner.size)
        leg = leg_of(first, last, corner.size) if corner.word.name == "CHF" else corner.size
        return chamfer(first, last, leg)

    def _inserted(self, held: _Held, between: Element) -> Block:
        made = super()._inserted(held, between)
        return made if held.corner.feed is None else replace(made, feed=held.corner.feed)

    def _tell_straight(self, held: _Held, after: Block) -> None:
        if held.corner.modal:
            return
        text = Message(
            "the moves on lines {line} and {line2} are in the same direction and do not form a corner.",
            line=held.block.line,
            line2=after.line,
        )
        statement, hint = held.corner.statement, "Remove this text from the program."
        self._log.add(statement.warning(held.corner.word, "corner-straight", text, hint))

    def _too_large(self, held: _Held, of: Block, needed: float) -> ProgramError:
        why = Message(
            "the corner needs {needed} mm of the move on line {line}, which is only {left} mm long",
            needed=f"{needed:.4f}",
            line=of.line,
            left=f"{element_of(of).length:.4f}",
        )
        return held.corner.refuse("corner-too-large", why, "Use a smaller chamfer or radius.")

    def _impossible(self, held: _Held, after: Block, problem: CornerError) -> ProgramError:
        del after
        return held.corner.refuse("corner-next", str(problem), "Program a different end point.")


def _moves(block: Block) -> bool:
    return (block.x, block.z) != (block.x0, block.z0)
