"""C and R on a straight move: a chamfer or a radius where it meets the next one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from core.geometry.chamfer_and_rounding import (
    CornerError,
    CornerTooLargeError,
    NoCornerError,
    chamfer,
    rounding,
)
from core.geometry.lines_and_arcs import Element, Line
from core.interpreter import units
from core.interpreter.actions import AskInput, Preset, ProgramEnd, ToolChange
from core.interpreter.adjusted_moves import inserted_after, moved_along, standstill_at
from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.omniturn.code_rules import check_together, check_when, checked
from core.interpreter.omniturn.code_table import LETTERS
from core.interpreter.omniturn.omniturn_state import CompensationSwitch, Corner, Item, State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.straight_moves import on_step
from core.language.diagnostics import ProgramError, program_error
from core.language.omniturn import Word
from core.message import Message

STRAIGHT = frozenset({Kind.RAPID, Kind.FEED})
_PARTS = ProgramEnd | ToolChange | Preset | AskInput
"""Actions across which no corner reaches: the program ends, its numbers mean another
point, or all motion before it must have ended."""


def read_corner(state: State, statement: Statement) -> None:
    """Note the corner of a line whose straight move has been made. Raises ProgramError for a bad size.

    A C word is a corner unless C is an axis at the moment.
    """
    chamfers = None if state.modal.c_locked else statement.words.get("C")
    word = statement.words.get("R") or chamfers
    if word is None:
        return
    if chamfers is not None:
        check_together(statement, LETTERS["C"])
    size = corner_size(state, statement, word)
    state.contour.corner = Corner(word.letter, size, word.column)
    state.contour.active, state.fast = True, False


def corner_size(state: State, statement: Statement, word: Word) -> float:
    """The size that a C or R word gives a corner, mm. Raises ProgramError where it is none."""
    size = on_step(state, statement, word.letter)
    return checked(state, statement, word.letter, size or 0.0, LETTERS[word.letter]) or 0.0


def refuse_radius(state: State, statement: Statement) -> None:
    """Raises ProgramError for R on a line without a straight move of X and Z alone."""
    word = statement.words.get("R")
    if word is not None:
        check_when(state, statement, LETTERS["R"], word=word)


@dataclass(slots=True)
class _Held:
    """A move that waits for the next one, and what happens between them."""

    block: Block
    corner: Corner
    between: list[Item] = field(default_factory=list)

    @property
    def place(self) -> tuple[int, int]:
        """Line and column of the corner's word."""
        return self.block.line, self.corner.column


class Corners:
    """Holds a move with a corner until the next one is known, and cuts both."""

    def __init__(self, log: Log, max_rpm: float) -> None:
        self._log = log
        self._max_rpm = max_rpm
        self._held: _Held | None = None

    @property
    def active(self) -> bool:
        """Whether a move is held back until the next one is known."""
        return self._held is not None

    def drop(self) -> None:
        """Forget the move that is held back, after an error."""
        self._held = None

    def take(self, item: Item, corner: Corner | None) -> Iterator[Item]:
        """Yields what no later item can change. Raises ProgramError where the corner cannot be made."""
        held = self._held
        if held is None:
            yield from self._pass_on(item, corner)
        elif isinstance(item, CompensationSwitch):
            if item.code == 40:
                raise _refused(held, "corner-next", "nose compensation ends before the next move")
            held.between.append(item)
        elif item.action is not None:
            if isinstance(item.action, _PARTS):
                raise _refused(
                    held,
                    "corner-next",
                    Message("no move is programmed between the corner and {item}", item=item.text),
                )
            held.between.append(item)
        else:
            self._held = None
            yield from self._cut(held, item, corner)

    def check(self, statement: Statement) -> None:
        """Refuse a line that begins with no plain move while one waits. Raises ProgramError."""
        held = self._held
        if held is not None and statement.one_shot is not None and not statement.entry.before_corner:
            what = statement.code.text if statement.code is not None else "the motion"
            raise _refused(
                held,
                "corner-next",
                Message("{what} on line {line} is not a straight move", what=what, line=statement.line),
            )

    def end(self) -> None:
        """No block comes any more. Raises ProgramError where a corner is left."""
        held, self._held = self._held, None
        if held is not None:
            raise _refused(held, "corner-next", "no move follows the corner")

    def _pass_on(self, item: Item, corner: Corner | None) -> Iterator[Item]:
        if corner is not None and isinstance(item, Block) and item.moves:
            self._held = _Held(item, corner)
        else:
            yield item

    def _cut(self, held: _Held, after: Block, corner: Corner | None) -> Iterator[Item]:
        if after.kind not in STRAIGHT or after.c != after.c0:
            template = (
                "the next move, on line {line}, is an arc"
                if after.kind is Kind.ARC
                else "the next move, on line {line}, is not a straight line"
            )
            raise _refused(held, "corner-next", Message(template, line=after.line))
        block, point = held.block, (held.block.x, held.block.z)
        first, last = Line((block.x0, block.z0), point), Line(point, (after.x, after.z))
        try:
            make = chamfer if held.corner.letter == "C" else rounding
            cut, between, rest = make(first, last, held.corner.size)
        except NoCornerError:
            text = Message(
                "The moves on lines {line} and {line2} are in the same direction, so they do not "
                "form a corner.",
                line=block.line,
                line2=after.line,
            )
            self._log.warn(*held.place, "corner-straight", text, "Remove C or R.")
            yield from (block, *held.between)
            yield from self._pass_on(after, corner)
            return
        except CornerTooLargeError as problem:
            raise self._too_large(held, after, problem) from None
        except CornerError as problem:
            raise _refused(
                held, "corner-next", Message("{problem} (line {line})", problem=problem, line=after.line)
            ) from None
        yield moved_along(block, cut, self._max_rpm)
        yield inserted_after(block, between, self._max_rpm)
        for item in held.between:
            yield (
                item
                if isinstance(item, CompensationSwitch)
                else standstill_at(item, between.end, self._max_rpm)
            )
        yield from self._pass_on(moved_along(after, rest, self._max_rpm), corner)

    def _too_large(self, held: _Held, after: Block, problem: CornerTooLargeError) -> ProgramError:
        of = held.block if problem.first else after
        left = held.block.modal.length_text(Line((of.x0, of.z0), (of.x, of.z)).length)
        if not problem.needed:
            return _refused(
                held, "corner-too-large", Message("the move on line {line} has zero length", line=of.line)
            )
        needed = held.block.modal.length_text(problem.needed)
        return _refused(
            held,
            "corner-too-large",
            Message(
                "the corner needs {needed} of the move on line {line}, but only {left} remains",
                needed=needed,
                line=of.line,
                left=left,
            ),
        )


def _refused(held: _Held, code: str, why: str) -> ProgramError:
    return _impossible(*held.place, held.corner.letter, code, why)


def _impossible(line: int, column: int, letter: str, code: str, why: str) -> ProgramError:
    hint = (
        "Use a smaller chamfer or radius."
        if code == "corner-too-large"
        else "A chamfer or corner radius needs two consecutive straight moves."
    )
    return program_error(
        line, column, code, Message("Corner {letter} is not possible: {why}.", letter=letter, why=why), hint
    )


# --- corners of a contour that a cycle reads: see ``cycle_contour``

_SHORTEST = 1e-6  # mm


class ContourPiece(NamedTuple):
    """An element of a contour, and the corner of ``size`` mm that its line asks for at its end."""

    element: Element
    line: int
    corner: Word | None = None
    size: float = 0.0
    metric: bool = False


def cut_corners(pieces: Sequence[ContourPiece], log: Log) -> list[Element]:
    """The elements with their corners cut. Raises ProgramError for a corner that cannot be made."""
    done: list[Element] = []
    asked: ContourPiece | None = None
    for piece in pieces:
        element = piece.element
        if asked is not None:
            *cut, element = _corner(asked, done.pop(), element, log)
            done += [each for each in cut if each.length > _SHORTEST]
        done.append(element)
        asked = piece if piece.corner is not None else None
    if asked is not None:
        raise _refused_in_contour(asked, "corner-next", "the contour ends at this corner")
    return [element for element in done if element.length > _SHORTEST]


def _corner(asked: ContourPiece, before: Element, after: Element, log: Log) -> Sequence[Element]:
    if not isinstance(before, Line) or not isinstance(after, Line):
        raise _refused_in_contour(asked, "corner-next", "the next move is an arc")
    make = chamfer if asked.corner is not None and asked.corner.letter == "C" else rounding
    try:
        return make(before, after, asked.size)
    except NoCornerError:
        text = "The two moves are in the same direction, so they do not form a corner."
        log.warn(asked.line, _column(asked), "corner-straight", text, "Remove C or R.")
        return before, after
    except CornerTooLargeError as problem:
        needed = units.length(problem.needed, metric=asked.metric)
        left = units.length((before if problem.first else after).length, metric=asked.metric)
        template = (
            "the corner needs {needed} of this move, but only {left} remains"
            if problem.first
            else "the corner needs {needed} of the next move, but only {left} remains"
        )
        why = Message(template, needed=needed, left=left)
        raise _refused_in_contour(asked, "corner-too-large", why) from None
    except CornerError as problem:
        raise _refused_in_contour(asked, "corner-next", str(problem)) from None


def _column(asked: ContourPiece) -> int:
    return asked.corner.column if asked.corner else 0


def _refused_in_contour(asked: ContourPiece, code: str, why: str) -> ProgramError:
    letter = asked.corner.letter if asked.corner else "C"
    return _impossible(asked.line, _column(asked), letter, code, why)
