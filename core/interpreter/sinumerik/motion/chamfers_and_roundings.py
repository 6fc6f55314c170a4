"""Chamfers and roundings with CHF, CHR and RND between lines and arcs.

If a move includes C, the C axis reaches its target at the end of the first element.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Never

from core.geometry.chamfer_and_rounding import CornerError, chamfer, find_chamfer_leg, make_rounding
from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.contour_stage import CONTOUR_KINDS, BufferedMove, CornerStage, make_element
from core.interpreter.shared.control_flow import MAIN_FILE, CallSite
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.sinumerik.motion.linear_moves import PlainMoveFactory
from core.interpreter.sinumerik.motion.sinumerik_feeds import convert_feed
from core.interpreter.sinumerik.sinumerik_state import SinumerikState, require_positive_number
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Word
from core.message import Message

_CUT = CONTOUR_KINDS - {BlockKind.RAPID}


@dataclass(slots=True)
class Corner:
    """A chamfer or rounding at the end of a block.

    ``size_mm`` is the chamfer length (CHF), the chamfer leg (CHR) or the radius (RND). At an arc, the leg
    is a chord. ``call_site`` is the location of the block, because another file may be active at the next
    move.
    """

    statement: Statement
    word: Word
    size_mm: float
    feed: float | None = None  # FRC, FRCM
    is_modal: bool = False  # RNDM: blocks that form no corner are not an error
    call_site: CallSite = MAIN_FILE

    def make_error(self, code: str, reason: str, hint: str) -> ProgramError:
        """Return an error at the position of the word that programs the corner."""
        return self.statement.make_error(
            self.word,
            code,
            Message("Corner {letter} is not possible: {why}.", letter=self.word.text, why=reason),
            hint,
        )


def make_corner(state: SinumerikState, statement: Statement, block: Block) -> Corner | None:
    """Return the corner of a block, or None if it has none. Raises ProgramError if the corner is invalid."""
    word = statement.corner_word
    if word is None:
        return _modal_corner(state, statement, block)
    size = require_positive_number(statement, word, state.length(statement, word), "the corner size")
    corner = Corner(statement, word, size, _feed(state, statement), call_site=state.call_site)
    if block.kind not in _CUT or not _moves(block):
        hint = "Use CHF, CHR and RND only with G1, G2 and G3."
        raise corner.make_error("corner-next", "the block is not a line or an arc", hint)
    if state.plane != 18:
        raise corner.make_error("corner-plane", "corners in X and Z need G18", "Write G18 before this block.")
    return corner


def _modal_corner(state: SinumerikState, statement: Statement, block: Block) -> Corner | None:
    """Return the rounding that RNDM inserts after a block, or None if RNDM does not apply.

    RNDM applies only to lines and arcs of a contour under G18.
    """
    if not state.rounding or block.kind not in _CUT or not _moves(block) or state.plane != 18:
        return None
    word = Word("RND", state.rounding, 1, f"RNDM={state.rounding:g}")
    return Corner(statement, word, state.rounding, _feed(state, statement), is_modal=True)


def _feed(state: SinumerikState, statement: Statement) -> float | None:
    word = statement.words.get("FRC")
    return state.corner_feed if word is None else convert_feed(state, statement, word)


_BufferedMove = BufferedMove[Corner, Never]


class SinumerikCornerStage(CornerStage[Corner, Never]):
    """Stage that inserts corners between lines and arcs."""

    def __init__(self, state: SinumerikState, log: DiagnosticLog) -> None:
        super().__init__(PlainMoveFactory(state))
        self._log = log

    def flush_at_program_end(self) -> Iterator[Block]:
        """Yield the buffered blocks at the end of the program.

        Raises ProgramError if a corner has no following move.
        """
        held, self._held = self._held, None
        if held is not None and held.corner.is_modal:
            yield from (held.block, *held.blocks_between)
        elif held is not None:
            raise held.corner.make_error(
                "corner-next", "no move follows the corner", "Program two consecutive moves for the corner."
            )

    def _keeps_waiting(self, buffered: _BufferedMove, item: Block) -> bool:
        del buffered
        return item.action is not None and not isinstance(item.action, ProgramEnd)

    def _forms_corner(self, buffered: _BufferedMove, after: Block) -> bool:
        if after.kind in CONTOUR_KINDS and _moves(after):
            return not buffered.corner.is_modal or after.kind is not BlockKind.RAPID
        if buffered.corner.is_modal:
            return False
        why = Message("the next move, on line {line}, is not a line or an arc in X and Z", line=after.line)
        raise buffered.corner.make_error("corner-next", why, "Program two consecutive moves for the corner.")

    def _elements(self, corner: Corner, first: Element, last: Element) -> Sequence[Element]:
        if corner.word.name == "RND":
            return make_rounding(first, last, corner.size_mm)
        leg = find_chamfer_leg(first, last, corner.size_mm) if corner.word.name == "CHF" else corner.size_mm
        return chamfer(first, last, leg)

    def _inserted(self, held: _BufferedMove, between: Element) -> Block:
        made = super()._inserted(held, between)
        return made if held.corner.feed is None else replace(made, feed=held.corner.feed)

    def _report_straight(self, buffered: _BufferedMove, after: Block) -> None:
        if buffered.corner.is_modal:
            return
        text = Message(
            "the moves on lines {line} and {line2} are in the same direction and do not form a corner.",
            line=buffered.block.line,
            line2=after.line,
        )
        corner, hint = buffered.corner, "Remove this text from the program."
        found = corner.statement.make_warning(corner.word, "corner-straight", text, hint)
        self._log.add_finding(corner.call_site.relocate_finding(found), found)

    def _make_size_error(self, buffered: _BufferedMove, block: Block, needed_mm: float) -> ProgramError:
        why = Message(
            "the corner needs {needed} mm of the move on line {line}, which is only {left} mm long",
            needed=f"{needed_mm:.4f}",
            line=block.line,
            left=f"{make_element(block).length:.4f}",
        )
        return buffered.corner.make_error("corner-too-large", why, "Use a smaller chamfer or radius.")

    def _make_corner_error(self, buffered: _BufferedMove, after: Block, problem: CornerError) -> ProgramError:
        del after
        return buffered.corner.make_error("corner-next", str(problem), "Program a different end point.")


def _moves(block: Block) -> bool:
    return (block.x, block.z) != (block.x0, block.z0)
