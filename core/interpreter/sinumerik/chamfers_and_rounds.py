"""CHF, CHR and RND: chamfers and roundings between lines and arcs. C ends with the first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from core.geometry.chamfer_and_rounding import (
    CornerError,
    CornerTooLargeError,
    NoCornerError,
    chamfer,
    leg_of,
    rounding,
)
from core.geometry.lines_and_arcs import Element
from core.interpreter.actions import ProgramEnd
from core.interpreter.adjusted_moves import element_of, standstill_at
from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.sinumerik.moves_along import along, inserted
from core.interpreter.sinumerik.sinumerik_feeds import feed_of
from core.interpreter.sinumerik.sinumerik_state import State, positive
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Word
from core.message import Message

_CUT = frozenset({Kind.FEED, Kind.RAPID, Kind.ARC})  # what may meet in a corner


@dataclass(slots=True)
class Corner:
    """What a block asks for at its end; ``size`` in mm: CHF the chamfer, CHR its leg (beside an arc a chord),
    RND the radius.
    """

    statement: Statement
    word: Word
    size: float
    feed: float | None = None  # FRC, FRCM
    modal: bool = False  # RNDM: where there is no corner, none is asked for

    def refuse(self, code: str, why: str, hint: str) -> ProgramError:
        """An error at the corner's word."""
        return self.statement.refuse(
            self.word,
            code,
            Message("Corner {letter} is not possible: {why}.", letter=self.word.text, why=why),
            hint,
        )


def corner_of(state: State, statement: Statement, block: Block) -> Corner | None:
    """The corner of a block that has been made. Raises ProgramError."""
    word = statement.corner
    if word is None:
        return _modal_corner(state, statement, block)
    size = positive(statement, word, state.length(statement, word), "the corner size")
    corner = Corner(statement, word, size, _feed(state, statement))
    if block.kind not in _CUT - {Kind.RAPID} or not _moves(block):
        hint = "Use CHF, CHR and RND only with G1, G2 and G3."
        raise corner.refuse("corner-next", "the block is not a line or an arc", hint)
    if state.plane != 18:
        raise corner.refuse("corner-plane", "corners in X and Z need G18", "Write G18 before this block.")
    return corner


def _modal_corner(state: State, statement: Statement, block: Block) -> Corner | None:
    """The rounding of RNDM; None where the block is no line or arc of the contour."""
    if not state.rounding or block.kind not in _CUT - {Kind.RAPID} or not _moves(block) or state.plane != 18:
        return None
    word = Word("RND", state.rounding, 1, f"RNDM={state.rounding:g}")
    return Corner(statement, word, state.rounding, _feed(state, statement), modal=True)


def _feed(state: State, statement: Statement) -> float | None:
    word = statement.words.get("FRC")
    return state.corner_feed if word is None else feed_of(state, statement, word)


@dataclass(slots=True)
class _Held:
    block: Block
    corner: Corner
    between: list[Block] = field(default_factory=list)


class Corners:
    """Holds a block with a corner until the next move is known, and cuts both."""

    def __init__(self, state: State, log: Log) -> None:
        self._state, self._log = state, log
        self._held: _Held | None = None

    @property
    def holds(self) -> bool:
        """Whether a move is held back."""
        return self._held is not None

    def drop(self) -> None:
        """Forget the move that is held back, after an error."""
        self._held = None

    def take(self, block: Block, corner: Corner | None) -> Iterator[Block]:
        """Yields what no later block can change. Raises ProgramError where the corner cannot be made."""
        held = self._held
        if held is None:
            if corner is None:
                yield block
            else:
                self._held = _Held(block, corner)
        elif block.action is not None and not isinstance(block.action, ProgramEnd):
            held.between.append(block)
        else:
            self._held = None
            yield from self._cut(held, block, corner)

    def end(self) -> Iterator[Block]:
        """No block comes any more: what is held back. Raises ProgramError where a corner is left."""
        held, self._held = self._held, None
        if held is not None and held.corner.modal:
            yield from (held.block, *held.between)
        elif held is not None:
            raise held.corner.refuse(
                "corner-next", "no move follows the corner", "Program two consecutive moves for the corner."
            )

    def _cut(self, held: _Held, after: Block, corner: Corner | None) -> Iterator[Block]:
        if held.corner.modal and (after.kind not in _CUT - {Kind.RAPID} or not _moves(after)):
            yield from (held.block, *held.between)
            yield from self.take(after, corner)
            return
        if after.kind not in _CUT or not _moves(after):
            why = Message(
                "the next move, on line {line}, is not a line or an arc in X and Z", line=after.line
            )
            raise held.corner.refuse("corner-next", why, "Program two consecutive moves for the corner.")
        block, (dx, dz) = held.block, _shift(held.block, after)
        first, last = element_of(block), element_of(_moved(after, dx, dz))
        try:
            cut, between, rest = self._elements(held.corner, first, last)
        except NoCornerError:
            if held.corner.modal:
                yield from (block, *held.between)
                yield from self.take(after, corner)
                return
            text = Message(
                "the moves on lines {line} and {line2} are in the same direction and do not form a corner.",
                line=block.line,
                line2=after.line,
            )
            self._log.add(
                held.corner.statement.warning(
                    held.corner.word, "corner-straight", text, "Remove this text from the program."
                )
            )
            yield from (block, *held.between)
            yield from self.take(after, corner)
            return
        except CornerTooLargeError as problem:
            raise self._too_large(held, after, problem) from None
        except CornerError as problem:
            raise held.corner.refuse("corner-next", str(problem), "Program a different end point.") from None
        yield along(self._state, block, cut)
        made = inserted(self._state, block, between)
        yield made if held.corner.feed is None else replace(made, feed=held.corner.feed)
        for each in held.between:
            yield standstill_at(each, between.end, self._state.setup.limits.max_rpm)
        there = _moved(along(self._state, _moved(after, dx, dz), rest), -dx, -dz)
        yield from self.take(there, corner)

    def _elements(self, corner: Corner, first: Element, last: Element) -> tuple[Element, Element, Element]:
        if corner.word.name == "RND":
            return rounding(first, last, corner.size)
        leg = leg_of(first, last, corner.size) if corner.word.name == "CHF" else corner.size
        return chamfer(first, last, leg)

    def _too_large(self, held: _Held, after: Block, problem: CornerTooLargeError) -> ProgramError:
        of = held.block if problem.first else after
        left = element_of(of).length
        why = Message(
            "the corner needs {needed} mm of the move on line {line}, which is only {left} mm long",
            needed=f"{problem.needed:.4f}",
            line=of.line,
            left=f"{left:.4f}",
        )
        return held.corner.refuse("corner-too-large", why, "Use a smaller chamfer or radius.")


def _moves(block: Block) -> bool:
    return (block.x, block.z) != (block.x0, block.z0)


def _shift(block: Block, after: Block) -> tuple[float, float]:
    """From the frame of the second to that of the first: an offset may have changed between them."""
    return after.offset_x - block.offset_x, after.offset_z - block.offset_z


def _moved(block: Block, dx: float, dz: float) -> Block:
    """The same move in another frame."""
    if not dx and not dz:
        return block
    return replace(
        block, x0=block.x0 + dx, z0=block.z0 + dz, x=block.x + dx, z=block.z + dz,
        cx=block.cx + dx, cz=block.cz + dz, offset_x=block.offset_x - dx, offset_z=block.offset_z - dz,
    )  # fmt: skip
