"""CHF, CHR and RND: a chamfer or a rounding where two straight moves meet. C ends with the first of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import cos

from core.geometry.contour import Element, Line, turn
from core.geometry.corner import CornerError, CornerTooLargeError, NoCornerError, chamfer, fillet
from core.interpreter.actions import ProgramEnd
from core.interpreter.blocks import Block, Kind
from core.interpreter.log import Log
from core.interpreter.remade import stand
from core.interpreter.sinumerik.state import State, positive
from core.interpreter.sinumerik.statement import Statement
from core.interpreter.sinumerik.travel import Way
from core.language.diagnostics import ProgramError
from core.language.sinumerik.words import Word


@dataclass(slots=True)
class Corner:
    """What a block asks for at its end; ``size`` in mm: CHF the chamfer, CHR its leg, RND the radius."""

    made: Statement
    word: Word
    size: float

    def refuse(self, code: str, why: str, hint: str) -> ProgramError:
        """An error at the corner's word."""
        return self.made.refuse(self.word, code, f"{self.word.text} cannot make a corner: {why}.", hint)


def corner_of(state: State, made: Statement, block: Block) -> Corner | None:
    """The corner of a block that has been made. Raises ProgramError."""
    word = made.corner
    if word is None:
        return None
    corner = Corner(made, word, positive(made, word, state.length(made, word), "the size of a corner"))
    if block.kind is not Kind.FEED or not _moves(block):
        raise corner.refuse("corner-next", "the block is no straight move at feed", "Put it behind a G1.")
    if state.plane != 18:
        raise corner.refuse("corner-plane", "corners of X and Z need G18", "Write G18 before it.")
    return corner


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

    def drop(self) -> None:
        """Forget what is held."""
        self._held = None

    def take(self, block: Block, corner: Corner | None) -> Iterator[Block]:
        """Passes on what is sure. Raises ProgramError where the corner cannot be made."""
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

    def end(self) -> None:
        """No block comes any more. Raises ProgramError where a corner is left."""
        held, self._held = self._held, None
        if held is not None:
            raise held.corner.refuse("corner-next", "no move follows", "A corner needs two moves in a row.")

    def _cut(self, held: _Held, after: Block, corner: Corner | None) -> Iterator[Block]:
        if after.kind not in {Kind.FEED, Kind.RAPID} or not _moves(after):
            why = f"the next move, on line {after.line}, is no straight move of X and Z"
            raise held.corner.refuse("corner-next", why, "A corner needs two straight moves in a row.")
        block, (x, z) = held.block, _meeting(held.block, after)
        first = Line((block.x0, block.z0), (block.x, block.z))
        last = Line((x, z), (after.x + x - after.x0, after.z + z - after.z0))
        try:
            cut, between, rest = self._elements(held.corner, first, last)
        except NoCornerError:
            text = f"lines {block.line} and {after.line} run in one direction: there is no corner to cut."
            found = held.corner.made.refuse(
                held.corner.word, "corner-straight", text, "Take it out."
            ).diagnostic
            self._log.warn(found.line, found.column, found.code, found.message, found.hint)
            yield from (block, *held.between)
            yield from self.take(after, corner)
            return
        except CornerTooLargeError as problem:
            raise self._too_large(held, after, problem) from None
        except CornerError as problem:
            raise held.corner.refuse("corner-next", str(problem), "Give another end point.") from None
        yield self._along(block, cut)
        yield self._inserted(block, between)
        for each in held.between:
            yield stand(each, between.end, self._state.setup.limits.max_rpm)
        moved = rest.start[0] - x + after.x0, rest.start[1] - z + after.z0
        yield from self.take(self._along(after, Line(moved, (after.x, after.z))), corner)

    def _elements(self, corner: Corner, first: Line, last: Line) -> tuple[Line, Element, Line]:
        if corner.word.name == "RND":
            return fillet(first, last, corner.size)
        leg = corner.size
        if corner.word.name == "CHF" and first.length and last.length:
            # The chamfer and its two legs are a triangle of two equal sides: chf = 2 leg cos(turn / 2).
            leg /= 2.0 * max(abs(cos(turn(first.end_direction, last.start_direction) / 2)), 1e-9)
        return chamfer(first, last, leg)

    def _along(self, block: Block, line: Line) -> Block:
        """The block's own move on a part of its line; a rapid takes the time of its slowest axis."""
        (x0, z0), (x, z) = line.start, line.end
        way = Way(x0, z0, block.c0, x, z, block.c, block.modal, block.offset_x, block.offset_z)
        rapid = block.kind is Kind.RAPID
        feed = way.rapid_rate(self._state.setup.limits.speeds) if rapid else block.feed
        return replace(block, x0=x0, z0=z0, x=x, z=z, feed=feed, rpm=self._rpm(block, x))

    def _inserted(self, block: Block, element: Element) -> Block:
        """The corner: a move of X and Z alone; C has ended with the block before it."""
        made = replace(
            self._along(block, Line(element.start, element.end)), c0=block.c, text=f"{block.text} ›"
        )
        if isinstance(element, Line):
            return made
        cx, cz = element.centre
        return replace(made, kind=Kind.ARC, cx=cx, cz=cz, clockwise=element.clockwise)

    def _rpm(self, block: Block, x: float) -> float:
        if block.css is None or not block.modal.spindle:
            return block.rpm
        return self._state.rpm_at(x)

    def _too_large(self, held: _Held, after: Block, problem: CornerTooLargeError) -> ProgramError:
        of = held.block if problem.first else after
        left = Line((of.x0, of.z0), (of.x, of.z)).length
        why = f"it takes {problem.needed:.4f} mm of the move on line {of.line}, which has {left:.4f} mm"
        return held.corner.refuse("corner-too-large", why, "Make it smaller.")


def _moves(block: Block) -> bool:
    return (block.x, block.z) != (block.x0, block.z0)


def _meeting(block: Block, after: Block) -> tuple[float, float]:
    """Where both meet, in the frame of the first: an offset may have changed between them."""
    return (
        after.x0 + after.offset_x - block.offset_x,
        after.z0 + after.offset_z - block.offset_z,
    )
