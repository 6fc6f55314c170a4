"""Roughing cycles G74 (box), G75 and G78 (contour), in passes parallel to Z.

In the lines that describe a contour, only the words that define geometry have an effect.
"""

from __future__ import annotations

import copy
from collections import deque
from collections.abc import Sequence

from core.geometry.contour_offset import RoughingArea, TrimError
from core.geometry.lines_and_arcs import Element, Point, shift_element
from core.interpreter.omniturn.codes.code_entry import ActionKind
from core.interpreter.omniturn.codes.code_rules import check_word_groups, number
from core.interpreter.omniturn.codes.code_table import LETTER_ENTRIES
from core.interpreter.omniturn.cycles.canned_cycles import (
    LIFT_MM,
    check_pass_count,
    get_cycle_code,
    read_length_mm,
)
from core.interpreter.omniturn.motion.arc_moves import make_arc_block
from core.interpreter.omniturn.motion.corners import ContourCornerStage, read_corner_size_mm
from core.interpreter.omniturn.motion.move_words import OmniturnMoveFactory
from core.interpreter.omniturn.motion.straight_moves import (
    execute_dimension_modes,
    round_to_resolution,
    set_position,
)
from core.interpreter.omniturn.omniturn_state import Corner, State
from core.interpreter.omniturn.omniturn_statement import UNREADABLE_FLOW, Statement
from core.interpreter.omniturn.setup.tools_and_offsets import set_preset
from core.interpreter.shared.contour_passes import (
    MAX_COMPARISON_COUNT,
    MAX_ELEMENT_COUNT,
    ContourClearanceError,
    ContourFrame,
    CycleMove,
    RoughingPlanner,
    compute_equal_depths,
    count_passes,
    make_contour_frame,
)
from core.interpreter.shared.contour_stage import make_element
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.omniturn import Word
from core.message import Message, fill_template

_MODES = "absolute", "metric", "diameter", "preset_x", "preset_z"
_NOSE = frozenset({40, 41, 42})
_TURNS = frozenset({"CA", "CI"})
_CORNERS = frozenset({"C", "R"})


def read_contour(state: State, statement: Statement, lines: Sequence[Statement]) -> list[Element]:
    """Return the contour from its first point, in mm.

    The coordinates are in the frame of ``statement``, the line of the cycle. The active state does not
    change. Raises ProgramError for a line that is not allowed in a contour, for an invalid arc or corner,
    and for a contour without a line or an arc.
    """
    reader = _Reader(state, statement)
    for each in lines:
        if not (each.has_block_delete and state.setup.block_delete):
            reader.read_line(each)
    elements = reader.finish_contour()
    text = "The contour of G{one_shot} does not contain a line or an arc."
    hint = "Write the points of the contour."
    statement.check_condition(
        elements, "", "cycle-contour-empty", text, hint, one_shot=statement.one_shot_code
    )
    return elements


class _Reader:
    """Reader of contour lines, which works on a copy of the state so that its changes are discarded."""

    def __init__(self, state: State, statement: Statement) -> None:
        self._state, self._made = state, statement
        self._own = copy.copy(state)
        # The state is set to rapid, because a rapid needs neither feed nor spindle.
        self._own.set_modal(state.modal._replace(rapid=True))
        self._own.reported = set()
        self._own.title_rapid = self._own.tool_line = 0
        self._begun = False
        self._reported = False
        self._moves: list[tuple[Block, Corner | None]] = []

    def read_line(self, line: Statement) -> None:
        if line.flow_code == UNREADABLE_FLOW:
            raise _refused(line, 1, "This line of the contour cannot be read", "Correct the line.")
        idle_corner = not line.has_x_or_z_move and not _CORNERS.isdisjoint(line.words)
        if line.flow_code or idle_corner or not _TURNS.isdisjoint(line.words):
            hint = "Write the contour block by block, with only straight moves, arcs, chamfers and roundings."
            raise _refused(line, 1, "{line} is not allowed in a contour", hint, line=line.text)
        if line.one_shot_code is not None and not line.code_entry.is_allowed_in_contour:
            column = line.code_word.column if line.code_word else 1
            text = "G{one_shot} is not allowed in a contour"
            raise _refused(
                line, column, text, "Remove this text from the program.", one_shot=line.one_shot_code
            )
        if not _NOSE.isdisjoint(line.modal_codes):
            text = "Nose compensation cannot be turned on or off in a contour"
            raise _refused(line, 1, text, "Program a separate contour for finishing.", "cycle-nose-comp")
        self._tell_ignored(line)
        execute_dimension_modes(self._own, line)
        if line.one_shot_code == 92:
            deque(set_preset(self._own, line), maxlen=0)
        elif line.has_x_or_z_move:
            self._move(line)

    def finish_contour(self) -> list[Element]:
        """Return the elements of the contour.

        If the modes at the end of the contour differ from the modes at the start, a warning is logged.
        """
        for mode in _MODES:
            if getattr(self._own.modal, mode) != getattr(self._state.modal, mode):
                text = (
                    "The contour changes modes or coordinates; the previous ones are restored after the "
                    "cycle."
                )
                self._state.log.add_warning(self._made.line, self._made.code_column, "cycle-modes", text)
                break
        state = self._state
        moves = OmniturnMoveFactory(state.setup.limits.max_rpm)
        blocks = ContourCornerStage(state.log, moves).insert_corners(self._moves)
        elements = [shift_element(make_element(each), *self._shift(each)) for each in blocks]
        return [element for element in elements if element.length > _SAME]

    def _tell_ignored(self, line: Statement) -> None:
        words = [line.words[letter] for letter in "TDSF" if letter in line.words and line.one_shot_code != 4]
        words += [line.m_word] if line.m_word else []
        words += [line.code_word] if line.code_word and line.one_shot_code in {4, 10} else []
        if words and not self._reported:
            self._reported = True
            text = Message(
                "{words} and other words that do not belong to a contour are ignored in the contour "
                "of G{one_shot}.",
                words=words[0].text,
                one_shot=self._made.one_shot_code,
            )
            found = Diagnostic(line.line, words[0].column, Severity.NOTE, "cycle-ignored", text)
            self._state.log.add_finding(found)

    def _move(self, line: Statement) -> None:
        arc = line.code_entry.action_kind is ActionKind.ARC
        word = None if arc else line.words.get("C") or line.words.get("R")
        if not self._begun:
            self._begin(line, word)
            return
        block, corner = make_arc_block(self._own, line) if arc else self._line(line), None
        if word is not None:
            check_word_groups(line, LETTER_ENTRIES[word.letter])
            corner = Corner(word.letter, read_corner_size_mm(self._own, line, word), word.column)
        if corner is not None or make_element(block).length > _SAME:
            self._moves.append((block, corner))

    def _begin(self, line: Statement, corner: Word | None) -> None:
        """Read the first line, which moves from the start point to the first point of the contour."""
        if line.code_entry.action_kind is ActionKind.ARC or corner is not None:
            column = corner.column if corner else 1
            text = "The first line of a contour defines its start point and cannot contain an arc or a corner"
            raise _refused(line, column, text, "Write only X and Z of the first point.")
        self._line(line)
        self._begun = True

    def _line(self, line: Statement) -> Block:
        own, start = self._own, (self._own.x, self._own.z, self._own.c)
        set_position(own, round_to_resolution(own, line, "X"), round_to_resolution(own, line, "Z"))
        return own.move(BlockKind.FEED, line.line, "", start, 0.0)

    def _shift(self, block: Block) -> Point:
        """Return the shift from the frame of a contour block to the frame of the cycle line.

        The shift is in mm, with X as a radius.
        """
        return block.offset_x - self._state.offset_x, block.offset_z - self._state.offset_z


def _refused(
    line: Statement, column: int, what: str, hint: str, code: str = "cycle-contour-line", /, **values: object
) -> ProgramError:
    return line.make_error(column, code, "{what}.", hint, what=fill_template(what, values))


_SAME = 1e-6  # mm


def plan_contour_cycle(state: State, statement: Statement, lines: Sequence[Statement]) -> list[CycleMove]:
    """Return the motions of G75 or G78 along the contour in ``lines``.

    The motions begin and end at the start point. Raises ProgramError if a word or the contour is invalid,
    if there are too many elements or passes, or if the contour cannot be cut from the start point.
    """
    number(state, statement, "P")
    cut = read_length_mm(state, statement, "I") if statement.one_shot_code == 75 else None
    left = read_length_mm(state, statement, "U")
    contour = read_contour(state, statement, lines)
    if len(contour) > MAX_ELEMENT_COUNT:
        raise statement.make_error(
            "G",
            "cycle-contour-long",
            "The contour has {contour_count} lines and arcs; the maximum is {most_elements}.",
            "Program the contour with fewer, longer moves.",
            contour_count=f"{len(contour):,}",
            most_elements=f"{MAX_ELEMENT_COUNT:,}",
        )
    view = _make_view(state, statement, contour)
    try:
        area = RoughingArea(view.transform_contour(contour), left)
    except TrimError:
        text = "{text} cannot find a continuous path along the contour at distance U."
        hint = "Reduce U, or widen the narrow part of the contour."
        raise statement.make_error("U", "cycle-no-way", text, hint, text=get_cycle_code(statement)) from None
    rougher = RoughingPlanner(area, state.modal.rapid_rate, LIFT_MM)
    if cut is not None:
        _passes(state, statement, rougher, area, cut, len(contour))
    try:
        rougher.add_finishing_pass(is_reversed=view.is_reversed)
    except ContourClearanceError:
        text = (
            "On the path from the start point to the contour and back, the tool comes closer to "
            "the contour than the distance U."
        )
        hint = "Move the start point away from the contour."
        if _plunges_at_start(view.transform_contour(contour)[0]):
            hint = (
                "The contour goes deeper immediately after its first point; start the contour at the "
                "lowest X and move up the face first."
            )
        raise statement.make_error("G", "cycle-start-near", text, hint) from None
    if area.reverses_in_z:
        text = (
            "The contour reverses along Z. The roughing passes do not reach this undercut, so the pass along "
            "the contour cuts all of its material."
        )
        hint = "Check whether the tool fits into the undercut."
        state.log.add_warning(statement.line, statement.code_column, "cycle-undercut", text, hint)
    return [view.transform_move(move) for move in rougher.moves]


def _plunges_at_start(first: Element) -> bool:
    """Return whether the contour leads deeper into the part at its first point.

    ``first`` is the first element, as depth and length from the start point.
    """
    (depth, length), (there, further) = first.start, first.end
    return there > depth + _SAME and abs(further - length) > _SAME


def _passes(
    state: State,
    statement: Statement,
    rougher: RoughingPlanner,
    area: RoughingArea,
    cut: float,
    elements: int,
) -> None:
    text = "No material remains to be cut between the contour and the start point."
    statement.check_condition(
        area.max_depth > 0, "G", "cycle-nothing", text, "Start farther from the contour in X."
    )
    count = count_passes(area.max_depth, cut)
    check_pass_count(statement, "I", count, "passes")
    if count * elements > MAX_COMPARISON_COUNT:
        text = "{count} passes along a contour of {elements} lines and arcs are too many to calculate."
        hint = "Increase I, or program the contour with fewer moves."
        raise statement.make_error(
            "I", "cycle-passes", text, hint, count=f"{count:,}", elements=f"{elements:,}"
        )
    rougher.add_roughing_passes(count)
    if rougher.has_plunged:
        text = "The contour rises and falls again, so the tool plunges into the material after the rise."
        hint = "Check whether the tool can plunge into the material."
        state.log.add_warning(statement.line, statement.code_column, "cycle-plunge", text, hint)


def _make_view(state: State, statement: Statement, contour: list[Element]) -> ContourFrame:
    """Return the contour in the frame for roughing.

    Raises ProgramError if the contour cannot be roughed from this start point.
    """
    start, first, last = (state.x, state.z), contour[0].start, contour[-1].end
    for axis, letter in ((0, "X"), (1, "Z")):
        to_first, to_last = first[axis] - start[axis], last[axis] - start[axis]
        text = (
            "In {letter}, the start point is between the two ends of the contour, but it must be outside "
            "them."
        )
        hint = (
            "Move the start point so that both ends of the contour are on the same side of it, in X and in Z."
        )
        statement.check_condition(to_first * to_last >= 0, "G", "cycle-quadrant", text, hint, letter=letter)
        text = (
            "Both ends of the contour have the same {letter} as the start point, so the contour does not "
            "enclose an area to cut."
        )
        hint = "Move the start point away from the contour."
        statement.check_condition(
            not to_first == to_last == 0, "G", "cycle-nothing", text, hint, letter=letter
        )
    return make_contour_frame(start, first, last)


def plan_box_cycle(state: State, statement: Statement) -> list[CycleMove]:
    """Return the motions of G74, which cuts a box in equal passes.

    The depth of each pass is at most I. The passes go from the start point toward X, where they leave the
    allowance U. The tool enters each pass at the feed, because it may cut material at a shoulder. The cycle
    ends at the start point. Raises ProgramError for invalid words.
    """
    x = _corner(state, statement, "X", state.x, state.secondary_x)
    z = _corner(state, statement, "Z", state.z, state.secondary_z)
    cut, left = read_length_mm(state, statement, "I"), read_length_mm(state, statement, "U")
    towards = 1.0 if x > state.x else -1.0
    depth = abs(x - state.x) - left
    if depth <= 0:
        text = "The allowance {text} leaves no material for the box cycle to cut."
        hint = "U must be less than the distance in X from the start point to the programmed X."
        raise statement.make_error("U", "cycle-nothing", text, hint, text=statement.words["U"].text)
    count = count_passes(depth, cut)
    check_pass_count(statement, "I", count, "passes")
    rapid = state.modal.rapid_rate
    moves: list[CycleMove] = []
    for below in compute_equal_depths(depth, count):
        level = state.x + towards * below
        off = level - towards * LIFT_MM
        moves += [
            CycleMove(level, state.z),
            CycleMove(level, z),
            CycleMove(off, z, rapid),
            CycleMove(off, state.z, rapid),
        ]
    return [*moves, CycleMove(state.x, state.z, rapid)]


def _corner(state: State, statement: Statement, letter: str, start: float, offset: float) -> float:
    """Return X or Z of the corner of the area that is opposite to the start point."""
    end = read_length_mm(state, statement, letter) + (offset if state.absolute else start)
    text = "The box has zero size along {letter} because its corner is at the start point."
    hint = "Correct {letter} or the start point."
    statement.check_condition(end != start, letter, "cycle-nothing", text, hint, letter=letter)
    return end
