"""Execution of path functions, with a buffer of path elements.

RND and CHF need the next element, and APPR needs the first element of the contour. Compensation (RL, RR)
needs all elements up to R0 or DEP. Until the needed elements are known, the elements are buffered with the
blocks between them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from core.geometry.chamfer_and_rounding import CornerError, chamfer, make_rounding
from core.geometry.lines_and_arcs import Arc, Element, Point
from core.geometry.rotation_frames import Vector
from core.geometry.working_plane import convert_to_plane_order
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import LINEAR_AXES, POINT_TOLERANCE, State
from core.interpreter.klartext.motion.feed_rates import convert_to_feed_per_minute, reduce_plunging_feed
from core.interpreter.klartext.motion.path_checks import (
    check_axes,
    check_surface_normal,
    warn_about_cut_start,
)
from core.interpreter.klartext.motion.path_element_blocks import make_element_block
from core.interpreter.klartext.motion.path_elements import (
    PathElement,
    compute_end_point,
    find_pole_plane,
    make_elements,
)
from core.interpreter.klartext.motion.radius_compensation import (
    CompensatedContour,
    ContourEntry,
    plan_approach_path,
    plan_departure_path,
)
from core.interpreter.klartext.motion.rotary_targets import find_rotary_targets
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import (
    COMPENSATION_NOT_PERMITTED,
    PATH_FUNCTION_NOT_POSSIBLE,
    ROUNDING_NOT_POSSIBLE,
    make_unsupported_error,
)
from core.language.klartext.klartext_nodes import CornerBlock, PathFunction, Pole
from core.message import Message

BlockGenerator = Callable[[], Iterator[Block]]


@dataclass(slots=True)
class _InsertedEvent:
    """The blocks of an event, such as an M function, between two buffered path elements."""

    block_generator: BlockGenerator
    line_number: int
    block_text: str


@dataclass(slots=True)
class _Approach:
    """An APPR block, or a block that turns compensation on; its end is the start of the contour."""

    node: PathFunction
    element: PathElement


_BufferedItem = PathElement | _InsertedEvent | _Approach
_CORNER_HINT = "Put RND or CHF between two contour elements."


class PathRunner:
    """Executor of path functions, with a buffer for path elements that later blocks may still change.

    The argument ``machine_datum`` of ``execute_move`` contains the machine positions to which M91 or M92
    refers. It is None if the block has neither M91 nor M92.
    """

    def __init__(self, state: State) -> None:
        self._state = state
        self._waiting: list[_BufferedItem] = []
        self._corner: CornerBlock | None = None
        self._corner_line = 0
        self._side = ""  # L or R while radius compensation is active
        self._end: Vector | None = None  # end of the buffered path, in program coordinates
        self._direction: Point | None = None  # direction at the end of the path

    @property
    def blocking_reason(self) -> str:
        """Return the reason why no other pass can start at the current line, or an empty string.

        No pass can start while path elements are buffered.
        """
        if self._side:
            return "radius compensation is active"
        return "the previous block is part of an unfinished corner" if self._waiting or self._corner else ""

    @property
    def path_end(self) -> Vector:
        """Return the end of the programmed path in program coordinates, in mm.

        While compensation is active, it is the end of the contour, not of the compensated path.
        """
        return self._state.programmed_position if self._end is None else self._end

    def set_pole(self, node: Pole) -> None:
        """Set the pole of a CC block; an axis without a word keeps the coordinate of the path's end."""
        here = dict(zip(LINEAR_AXES, self.path_end, strict=True))
        for word in node.axis_words:
            value = word_values.evaluate_coordinate(self._state, word)
            here[word.axis] = here[word.axis] + value if word.is_incremental else value
        self._state.pole_plane = order = find_pole_plane(node, self._state.pole_plane)
        first, second, _ = convert_to_plane_order(order, (here["X"], here["Y"], here["Z"]))
        self._state.pole = first, second

    def add_corner(self, node: CornerBlock) -> None:
        """Add the corner of RND or CHF to the last element in the buffer.

        Raises ProgramError if no element is buffered, if the element does not move in the working plane, or
        if the previous block is also RND or CHF.
        """
        last = next((each for each in reversed(self._waiting) if isinstance(each, PathElement)), None)
        if last is None or last.planar_element is None or self._corner is not None:
            text = "{form} must follow a path in the working plane."
            raise self._state.make_error(
                node.column, ROUNDING_NOT_POSSIBLE, text, _CORNER_HINT, form=node.function_name
            )
        self._corner, self._corner_line = node, self._state.line_number

    def execute_between_elements(self, event: BlockGenerator) -> Iterator[Block]:
        """Yield the blocks of an event, such as an M function, between two path elements.

        If an element is buffered, the event is also buffered and no blocks are yielded.
        """
        if not self._waiting:
            yield from event()
            return
        self._waiting.append(_InsertedEvent(event, self._state.line_number, self._state.text))

    def flush_blocks_before(self, column: int, next_function: str) -> Iterator[Block]:
        """Yield all buffered blocks before ``next_function`` is executed.

        Raises ProgramError if compensation is active, or if the element after a buffered corner is still
        missing.
        """
        text = "{what} is not allowed while radius compensation is active."
        hint = "End the contour with R0 or DEP before this block."
        self._state.check_condition(
            not self._side, column, COMPENSATION_NOT_PERMITTED, text, hint, what=next_function
        )
        yield from self._release()

    def finish_program(self) -> Iterator[Block]:
        """Yield the buffered blocks at the end of the program.

        If radius compensation is still active, a warning is logged.
        """
        if self._side:
            text = "The program ends while radius compensation is active."
            hint = "End the contour with R0 or DEP."
            self._state.log.add_warning(self._state.line_number, 0, "compensation-left-on", text, hint)
            yield from self._close(None)
        yield from self._release()

    # --- moves --------------------------------------------------------------------------------------------

    def execute_move(
        self, node: PathFunction, *, machine_datum: Mapping[str, float] | None, has_corner_after: bool
    ) -> Iterator[Block]:
        """Yield the blocks of a path function and of the elements buffered earlier.

        Raises ProgramError for an invalid path function.
        """
        if not node.axis_words and not node.words and node.function_name == "L":
            if node.feed is not None:
                self._set_block_feed(node)
            yield from self._switch_compensation(node)
            return
        check_axes(self._state, node)
        if node.function_name == "LN":
            check_surface_normal(self._state, node, is_compensated=bool(self._side))
        if machine_datum is not None:
            yield from self.flush_blocks_before(node.column, "M91")
            yield from self._move_in_machine_frame(node, machine_datum)
            return
        made = list(self._elements(node))
        if node.function_name.startswith("APPR"):
            yield from self._approach(node, made[0])
        elif node.function_name.startswith("DEP"):
            yield from self._depart(node)
        elif node.compensation in {"L", "R"} and not self._side:
            yield from self._release()
            self._begin(node, _Approach(node, made[-1]), made[-1])
        elif node.compensation == "0" and self._side:
            yield from self._close(None)
            yield from self._add(list(self._elements(node)), hold=has_corner_after)
        else:
            self._demand_same_side(node)
            yield from self._add(made, hold=has_corner_after)

    def _elements(self, node: PathFunction) -> Iterator[PathElement]:
        state, feed = self._state, self._set_block_feed(node)
        if feed is not None:
            warn_about_cut_start(state, node)
        rotary = find_rotary_targets(state, node, state.kinematics.zero_angles)
        if rotary and self._side:
            text = "A rotary axis cannot move while radius compensation is active."
            raise state.make_error(
                node.column, COMPENSATION_NOT_PERMITTED, text, "End the contour with R0 before this block."
            )
        if node.function_name.startswith(("APPR", "DEP")):
            yield PathElement(
                self.path_end,
                compute_end_point(state, node, self.path_end),
                feed,
                state.line_number,
                state.text,
                node.column,
            )
            return
        made = list(make_elements(state, node, self.path_end, self._direction, feed, rotary))
        if made[0].is_vertical_arc and (self._side or node.compensation in {"L", "R"}):
            text = "Radius compensation is possible only in X and Y, but this arc is vertical."
            raise state.make_error(
                node.column, COMPENSATION_NOT_PERMITTED, text, "End the contour with R0 before this block."
            )
        yield from (replace(each, feed=_reduced_feed(state, each)) for each in made)

    def _add(self, elements: list[PathElement], *, hold: bool) -> Iterator[Block]:
        """Append elements to the buffer, and yield all blocks unless elements must remain buffered.

        Elements remain buffered if ``hold`` is True, if radius compensation is active, or until an approach
        is followed by an element that moves in the working plane.
        """
        if self._corner is not None and elements:
            elements[0] = self._insert_corner(elements[0])
        self._waiting += elements
        self._end = elements[-1].end
        if elements[-1].is_vertical_arc or elements[-1].end_direction is not None:
            self._direction = elements[-1].end_direction
        approaching = any(isinstance(each, _Approach) for each in self._waiting)
        if self._side or hold:
            return
        if approaching and not any(
            isinstance(each, PathElement) and each.planar_element for each in self._waiting
        ):
            return
        yield from self._release()

    def _begin(self, node: PathFunction, first: _Approach, element: PathElement) -> None:
        self._side = node.compensation
        self._waiting.append(first)
        self._end, self._direction = element.end, element.end_direction

    def _approach(self, node: PathFunction, element: PathElement) -> Iterator[Block]:
        text = "APPR is not allowed while radius compensation is active."
        hint = "End the contour with R0 or DEP before this block."
        self._state.check_condition(not self._side, node.column, COMPENSATION_NOT_PERMITTED, text, hint)
        yield from self._release()
        self._begin(node, _Approach(node, element), element)
        self._side = node.compensation if node.compensation in {"L", "R"} else ""

    def _depart(self, node: PathFunction) -> Iterator[Block]:
        if self._side:
            yield from self._close(node)
            return
        if self._direction is None:
            text = "No move precedes {form}, so its starting direction is not defined."
            hint = "Program a move before this block."
            raise self._state.make_error(
                node.column, PATH_FUNCTION_NOT_POSSIBLE, text, hint, form=node.function_name
            )
        here, direction = self.path_end, self._direction
        yield from self._release()
        yield from self._emit_all(
            plan_departure_path(self._state, node, here, direction, "", 0.0, self._set_block_feed(node))
        )

    def _demand_same_side(self, node: PathFunction) -> None:
        if not self._side or node.compensation in {"", "0", self._side}:
            return
        text = Message(
            "R{compensation} is not allowed while R{side} is active.",
            compensation=node.compensation,
            side=self._side,
        )
        hint = (
            "Write R0 before this block."
            if node.compensation in {"+", "-"}
            else "Write R0 before you change the compensation side."
        )
        raise self._state.make_error(node.column, COMPENSATION_NOT_PERMITTED, text, hint)

    def _switch_compensation(self, node: PathFunction) -> Iterator[Block]:
        """Yield the blocks of an L block without axes, which may end compensation."""
        if node.compensation == "0" and self._side:
            yield from self._close(None)

    # --- corners ------------------------------------------------------------------------------------------

    def _insert_corner(self, after: PathElement) -> PathElement:
        """Insert the buffered RND or CHF before the element ``after``, and return this element shortened."""
        corner, self._corner = self._corner, None
        assert corner is not None
        at = next(i for i in reversed(range(len(self._waiting))) if isinstance(self._waiting[i], PathElement))
        before = self._waiting[at]
        assert isinstance(before, PathElement)
        first, last = before.planar_element, after.planar_element
        size = word_values.number(
            self._state, corner.size, corner.function_name, word_values.MAX_COORDINATE, 0.0
        )
        size *= self._state.mm_per_unit
        if first is None or last is None:
            text = Message(
                "{form} must be followed by a path in the working plane.", form=corner.function_name
            )
            raise self._make_corner_error(corner, text, _CORNER_HINT)
        if size <= POINT_TOLERANCE:
            return after
        try:
            cut = (
                make_rounding(first, last, size)
                if corner.function_name == "RND"
                else chamfer(first, last, size)
            )
        except CornerError as problem:
            text = Message(
                "{form} {size} mm: {problem}.", form=corner.function_name, size=f"{size:g}", problem=problem
            )
            raise self._make_corner_error(corner, text, "Use a smaller chamfer or radius.") from None
        feed = before.feed if corner.feed is None else self._feed_of(corner)
        z = before.end[2]
        self._waiting[at] = _replace_points(before, cut[0], before.start[2], z)
        self._waiting.insert(
            at + 1, _replace_points(replace(after, feed=feed, rotary_targets_deg={}), cut[1], z, z)
        )
        return _replace_points(after, cut[2], z, after.end[2])

    def _feed_of(self, corner: CornerBlock) -> float | None:
        return word_values.evaluate_feed(self._state, corner.feed, corner.column)

    # --- from elements to blocks --------------------------------------------------------------------------

    def _release(self) -> Iterator[Block]:
        """Yield the blocks of all buffered elements and events, without compensation."""
        self._check_no_corner()
        waiting, self._waiting, self._end = self._waiting, [], None
        for index, each in enumerate(waiting):
            if isinstance(each, _InsertedEvent):
                yield from self._run(each)
            elif isinstance(each, PathElement):
                yield from self._emit(each)
            else:
                first = next(
                    (
                        e.planar_element
                        for e in waiting[index:]
                        if isinstance(e, PathElement) and e.planar_element
                    ),
                    None,
                )
                yield from self._enter(each, first, "", 0.0)

    def _check_no_corner(self) -> None:
        """Raise ProgramError if a buffered RND or CHF still has no following element."""
        corner, self._corner = self._corner, None
        if corner is not None:
            text = Message(
                "{form} must be followed by a path in the working plane.", form=corner.function_name
            )
            raise self._make_corner_error(corner, text, _CORNER_HINT)

    def _make_corner_error(self, corner: CornerBlock, text: str, hint: str) -> ProgramError:
        """Return an error at the line of RND or CHF."""
        return self._state.make_error(corner.column, ROUNDING_NOT_POSSIBLE, text, hint, self._corner_line)

    def _close(self, leave: PathFunction | None) -> Iterator[Block]:
        """Yield the compensated contour, and the departure if the contour ends with DEP."""
        self._check_no_corner()
        side, self._side = self._side, ""
        waiting, self._waiting, self._end = self._waiting, [], None
        radius = self._state.tool_radius_mm / self._state.transformation.scale_factor
        contour = CompensatedContour([e for e in waiting if isinstance(e, PathElement)], side, radius)
        for each in waiting:
            if isinstance(each, _InsertedEvent):
                yield from self._run(each)
            elif isinstance(each, _Approach):
                yield from self._enter(each, contour.first_element, side, radius)
            else:
                yield from self._emit_all(contour.generate_path(each, self._state.programmed_position))
        if leave is not None:
            feed = self._set_block_feed(leave)
            here = (
                (*contour.end_point, self._state.programmed_position[2])
                if contour.end_point
                else self._state.programmed_position
            )
            direction = contour.end_direction or self._direction or (1.0, 0.0)
            yield from self._emit_all(
                plan_departure_path(self._state, leave, here, direction, side, radius, feed)
            )

    def _enter(self, each: _Approach, first: Element | None, side: str, radius: float) -> Iterator[Block]:
        """Yield the approach to the contour.

        The approach is a straight line to the offset start point, or the path that APPR defines.
        """
        state = self._state
        entry = ContourEntry(
            each.node, state.programmed_position, each.element.end, each.element.feed, side, radius
        )
        direction = first.start_direction if first is not None else each.element.end_direction
        line, text = state.line_number, state.text
        state.line_number, state.text = each.element.line_number, each.element.block_text
        yield from self._emit_all(plan_approach_path(state, entry, direction or (1.0, 0.0)))
        state.line_number, state.text = line, text

    def _run(self, between: _InsertedEvent) -> Iterator[Block]:
        state = self._state
        line, text = state.line_number, state.text
        state.line_number, state.text = between.line_number, between.block_text
        yield from between.block_generator()
        state.line_number, state.text = line, text

    def _emit_all(self, made: Iterator[PathElement]) -> Iterator[Block]:
        for each in made:
            yield from self._emit(each)

    def _emit(self, each: PathElement) -> Iterator[Block]:
        """Yield the block of one element, with its points converted to the plane and to machine positions."""
        state = self._state
        line, text = state.line_number, state.text
        state.line_number, state.text = each.line_number, each.block_text
        yield make_element_block(state, each)
        state.line_number, state.text = line, text

    def _move_in_machine_frame(self, node: PathFunction, datum: Mapping[str, float]) -> Iterator[Block]:
        """Yield the move of a block with M91 or M92.

        The words of the block refer to machine zero (M91) or to the second machine datum (M92).
        """
        state, feed = self._state, self._set_block_feed(node)
        if feed is not None:
            warn_about_cut_start(state, node)
        goals = find_rotary_targets(state, node, dict.fromkeys(state.rotary_axis_names, 0.0))
        for axis, now in zip(LINEAR_AXES, state.linear_position, strict=True):
            if (word := node.find_word(axis)) is not None:
                value = word_values.evaluate_coordinate(state, word)
                goals[axis] = value + (now if word.is_incremental else datum.get(axis, 0.0))
        travels_mm = [
            goals.get(name, state.position_by_axis[name]) - state.position_by_axis[name]
            for name in LINEAR_AXES
        ]
        linear = any(abs(travel_mm) > POINT_TOLERANCE for travel_mm in travels_mm)
        feed = reduce_plunging_feed(state, feed, math.hypot(*travels_mm), -travels_mm[2])
        rate = None if feed is None else (state.convert_feed_to_mm_s(feed) if linear else feed / 60.0)
        yield state.make_move_block(BlockKind.RAPID if rate is None else BlockKind.FEED, goals, rate)

    # --- words --------------------------------------------------------------------------------------------

    def _set_block_feed(self, node: PathFunction) -> float | None:
        """Set the feed of the block and return it, or return None for a rapid.

        A rapid applies only to this block.
        """
        state = self._state
        column = node.axis_words[0].column if node.axis_words else node.column
        found = word_values.read_programmed_feed(state, node.feed, column)
        if found is None:
            return None
        feed = convert_to_feed_per_minute(state, *found, column)
        state.feed, state.feed_base = found
        if (rate := state.convert_feed_to_mm_s(feed)) != state.modal.feed:
            state.modal = state.modal._replace(feed=rate)
        return feed


def _reduced_feed(state: State, each: PathElement) -> float | None:
    """Return the feed of an element, reduced by the factor of M103 if the element leads downward."""
    if state.plunging_feed_factor is None:
        return each.feed
    down = each.start[2] - each.end[2]
    if each.is_vertical_arc:
        text = "A vertical arc with M103 active"
        raise make_unsupported_error(each.line_number, each.column, text)
    along = math.dist(each.start, each.end) if each.arc is None else math.hypot(each.arc.length, down)
    return reduce_plunging_feed(state, each.feed, along, down)


def _replace_points(element: PathElement, flat: Element, z0: float, z1: float) -> PathElement:
    """Return the element with its path in the working plane replaced by ``flat``.

    The element runs from the height ``z0`` to the height ``z1``, in mm.
    """
    arc = flat if isinstance(flat, Arc) else None
    return replace(element, start=(*flat.start, z0), end=(*flat.end, z1), arc=arc)
