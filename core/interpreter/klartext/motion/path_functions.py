"""Execution of path functions, with buffered elements.

RND and CHF need the next element, APPR needs the first element of the contour, and compensation (RL, RR)
needs all elements up to R0 or DEP. Until then, the elements are buffered with the blocks between them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

from core.geometry.chamfer_and_rounding import CornerError, chamfer, rounding
from core.geometry.lines_and_arcs import Arc, Element, Point
from core.geometry.rotation_frames import Vector
from core.geometry.working_plane import HelixMove, seen
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import SAME_POINT, SLIDES, State
from core.interpreter.klartext.motion.feed_rates import per_minute, plunged, rotary_feed
from core.interpreter.klartext.motion.path_elements import PathElement, elements, goal, pole_plane
from core.interpreter.klartext.motion.plane_functions import swivelled
from core.interpreter.klartext.motion.radius_compensation import Contour, Entry, way_in, way_out
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import COMPENSATION, PREVIOUS, ROUNDING, WRONG_AXIS, unsupported
from core.language.klartext.klartext_nodes import AxisWord, Corner, Move, Pole
from core.message import Message

AT_TARGET = 0.001  # degrees; position error of the table above which a cut causes a warning

Event = Callable[[], Iterator[Block]]


@dataclass(slots=True)
class _Between:
    """Blocks between buffered elements, such as M functions, with ``line`` and ``text`` of their block."""

    event: Event
    line: int
    text: str


@dataclass(slots=True)
class _Approach:
    """APPR, or the block that turns compensation on; the contour begins at its end."""

    node: Move
    element: PathElement


_Waiting = PathElement | _Between | _Approach
_BETWEEN = "Put RND or CHF between two contour elements."


class PathRunner:
    """Generator of the blocks of path functions.

    ``datum`` in ``move`` has the machine positions to which M91 and M92 refer; None without them.
    """

    def __init__(self, state: State) -> None:
        self._state = state
        self._waiting: list[_Waiting] = []
        self._corner: Corner | None = None
        self._corner_line = 0
        self._side = ""  # L or R while radius compensation is active
        self._end: Vector | None = None  # end of the buffered path, in program coordinates
        self._direction: Point | None = None  # direction at the end of the path

    @property
    def waits_for(self) -> str:
        """Reason why elements are buffered, so that no pass can begin here; empty without one."""
        if self._side:
            return "radius compensation is active"
        return "the previous block is part of an unfinished corner" if self._waiting or self._corner else ""

    @property
    def here(self) -> Vector:
        """End of the path in program coordinates, in mm; under compensation, of the contour."""
        return self._state.programmed if self._end is None else self._end

    def pole(self, node: Pole) -> None:
        """Set the pole of CC; without axes, it is the end of the path."""
        here = dict(zip(SLIDES, self.here, strict=True))
        for word in node.axes:
            value = word_values.coordinate(self._state, word)
            here[word.axis] = here[word.axis] + value if word.incremental else value
        self._state.pole_plane = order = pole_plane(node, self._state.pole_plane)
        first, second, _ = seen(order, (here["X"], here["Y"], here["Z"]))
        self._state.pole = first, second

    def corner(self, node: Corner) -> None:
        """Add RND or CHF to the buffered element. Raises ProgramError without a buffered element."""
        last = next((each for each in reversed(self._waiting) if isinstance(each, PathElement)), None)
        if last is None or last.flat is None or self._corner is not None:
            text = "{form} must follow a path in the working plane."
            raise self._state.refuse(node.column, ROUNDING, text, _BETWEEN, form=node.form)
        self._corner, self._corner_line = node, self._state.line

    def between(self, event: Event) -> Iterator[Block]:
        """Execute an event between two elements, immediately if no element is buffered."""
        if not self._waiting:
            yield from event()
            return
        self._waiting.append(_Between(event, self._state.line, self._state.text))

    def finish(self, column: int, what: str) -> Iterator[Block]:
        """Yield all buffered blocks before ``what``. Raises ProgramError while compensation is active."""
        text = "{what} is not allowed while radius compensation is active."
        hint = "End the contour with R0 or DEP before this block."
        self._state.check(not self._side, column, COMPENSATION, text, hint, what=what)
        yield from self._release()

    def end(self) -> Iterator[Block]:
        """Yield the remaining blocks at the end of the program, with a warning if compensation is active."""
        if self._side:
            text = "The program ends while radius compensation is active."
            hint = "End the contour with R0 or DEP."
            self._state.log.warn(self._state.line, 0, "compensation-left-on", text, hint)
            yield from self._close(None)
        yield from self._release()

    # --- moves --------------------------------------------------------------------------------------------

    def move(self, node: Move, *, datum: Mapping[str, float] | None, corner_behind: bool) -> Iterator[Block]:
        """Yield the blocks of a path function and of earlier buffered elements. Raises ProgramError."""
        if not node.axes and not node.words and node.form == "L":
            if node.feed is not None:
                self._take_feed(node)
            yield from self._switched(node)
            return
        self._demand_axes(node)
        if node.form == "LN":
            self._demand_uncompensated(node)
        if datum is not None:
            yield from self.finish(node.column, "M91")
            yield from self._by_machine(node, datum)
            return
        made = list(self._elements(node))
        if node.form.startswith("APPR"):
            yield from self._approach(node, made[0])
        elif node.form.startswith("DEP"):
            yield from self._depart(node)
        elif node.compensation in {"L", "R"} and not self._side:
            yield from self._release()
            self._begin(node, _Approach(node, made[-1]), made[-1])
        elif node.compensation == "0" and self._side:
            yield from self._close(None)
            yield from self._add(list(self._elements(node)), hold=corner_behind)
        else:
            self._demand_same_side(node)
            yield from self._add(made, hold=corner_behind)

    def _elements(self, node: Move) -> Iterator[PathElement]:
        state, feed = self._state, self._take_feed(node)
        if feed is not None:
            _warn(state, node)
        rotary = _rotary(state, node, state.kinematics.zero)
        if rotary and self._side:
            text = "A rotary axis cannot move while radius compensation is active."
            raise state.refuse(node.column, COMPENSATION, text, "End the contour with R0 before this block.")
        if node.form.startswith(("APPR", "DEP")):
            yield PathElement(
                self.here, goal(state, node, self.here), feed, state.line, state.text, node.column
            )
            return
        made = list(elements(state, node, self.here, self._direction, feed, rotary))
        if made[0].upright and (self._side or node.compensation in {"L", "R"}):
            text = "Radius compensation is possible only in X and Y, but this arc is vertical."
            raise state.refuse(node.column, COMPENSATION, text, "End the contour with R0 before this block.")
        yield from (replace(each, feed=_plunged(state, each)) for each in made)

    def _add(self, made: list[PathElement], *, hold: bool) -> Iterator[Block]:
        """Append elements to the buffer, and yield all blocks unless an element must wait."""
        if self._corner is not None and made:
            made[0] = self._rounded(made[0])
        self._waiting += made
        self._end = made[-1].end
        if made[-1].upright or made[-1].end_direction is not None:
            self._direction = made[-1].end_direction
        approaching = any(isinstance(each, _Approach) for each in self._waiting)
        if self._side or hold:
            return
        if approaching and not any(isinstance(each, PathElement) and each.flat for each in self._waiting):
            return
        yield from self._release()

    def _begin(self, node: Move, first: _Approach, element: PathElement) -> None:
        self._side = node.compensation
        self._waiting.append(first)
        self._end, self._direction = element.end, element.end_direction

    def _approach(self, node: Move, element: PathElement) -> Iterator[Block]:
        text = "APPR is not allowed while radius compensation is active."
        hint = "End the contour with R0 or DEP before this block."
        self._state.check(not self._side, node.column, COMPENSATION, text, hint)
        yield from self._release()
        self._begin(node, _Approach(node, element), element)
        self._side = node.compensation if node.compensation in {"L", "R"} else ""

    def _depart(self, node: Move) -> Iterator[Block]:
        if self._side:
            yield from self._close(node)
            return
        if self._direction is None:
            text = "No move precedes {form}, so its starting direction is not defined."
            hint = "Program a move before this block."
            raise self._state.refuse(node.column, PREVIOUS, text, hint, form=node.form)
        here, direction = self.here, self._direction
        yield from self._release()
        yield from self._emit_all(way_out(self._state, node, here, direction, "", 0.0, self._take_feed(node)))

    def _demand_uncompensated(self, node: Move) -> None:
        """Raise ProgramError for LN with a tool vector or with compensation along the normal."""
        state = self._state
        if any(word.axis[0] == "T" for word in node.words):
            raise unsupported(state.line, node.column, "LN with a tool direction vector (TX TY TZ)")
        row = state.setup.mill_tools.get(state.modal.tool)
        off = (*state.oversize, *((row.dl, row.dr, row.dr2) if row is not None else ()))
        if any(off) or node.compensation in {"L", "R"} or self._side:
            raise unsupported(state.line, node.column, "LN with 3D compensation (DL, DR, DR2, RL, RR)")

    def _demand_same_side(self, node: Move) -> None:
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
        raise self._state.refuse(node.column, COMPENSATION, text, hint)

    def _switched(self, node: Move) -> Iterator[Block]:
        """Yield the blocks of an L without axes, which may end compensation."""
        if node.compensation == "0" and self._side:
            yield from self._close(None)

    # --- corners ------------------------------------------------------------------------------------------

    def _rounded(self, after: PathElement) -> PathElement:
        """Insert the buffered corner between the last element and this one, and return this one trimmed."""
        corner, self._corner = self._corner, None
        assert corner is not None
        at = next(i for i in reversed(range(len(self._waiting))) if isinstance(self._waiting[i], PathElement))
        before = self._waiting[at]
        assert isinstance(before, PathElement)
        first, last = before.flat, after.flat
        size = word_values.number(self._state, corner.size, corner.form, word_values.MOST_COORDINATE, 0.0)
        size *= self._state.scale
        if first is None or last is None:
            text = Message("{form} must be followed by a path in the working plane.", form=corner.form)
            raise self._no_corner(corner, text, _BETWEEN)
        if size <= SAME_POINT:
            return after
        try:
            cut = rounding(first, last, size) if corner.form == "RND" else chamfer(first, last, size)
        except CornerError as problem:
            text = Message(
                "{form} {size} mm: {problem}.", form=corner.form, size=f"{size:g}", problem=problem
            )
            raise self._no_corner(corner, text, "Use a smaller chamfer or radius.") from None
        feed = before.feed if corner.feed is None else self._feed_of(corner)
        z = before.end[2]
        self._waiting[at] = _reshaped(before, cut[0], before.start[2], z)
        self._waiting.insert(at + 1, _reshaped(replace(after, feed=feed, rotary={}), cut[1], z, z))
        return _reshaped(after, cut[2], z, after.end[2])

    def _feed_of(self, corner: Corner) -> float | None:
        return word_values.feed_word(self._state, corner.feed, corner.column)

    # --- from elements to blocks --------------------------------------------------------------------------

    def _release(self) -> Iterator[Block]:
        """Yield all buffered blocks without compensation."""
        self._demand_no_corner()
        waiting, self._waiting, self._end = self._waiting, [], None
        for index, each in enumerate(waiting):
            if isinstance(each, _Between):
                yield from self._run(each)
            elif isinstance(each, PathElement):
                yield from self._emit(each)
            else:
                first = next((e.flat for e in waiting[index:] if isinstance(e, PathElement) and e.flat), None)
                yield from self._enter(each, first, "", 0.0)

    def _demand_no_corner(self) -> None:
        """Raise ProgramError if a corner still waits for the next element."""
        corner, self._corner = self._corner, None
        if corner is not None:
            text = Message("{form} must be followed by a path in the working plane.", form=corner.form)
            raise self._no_corner(corner, text, _BETWEEN)

    def _no_corner(self, corner: Corner, text: str, hint: str) -> ProgramError:
        """Return an error at the line of RND or CHF."""
        return self._state.refuse(corner.column, ROUNDING, text, hint, self._corner_line)

    def _close(self, leave: Move | None) -> Iterator[Block]:
        """Yield the compensated contour, and the departure of DEP if there is one."""
        self._demand_no_corner()
        side, self._side = self._side, ""
        waiting, self._waiting, self._end = self._waiting, [], None
        radius = self._state.tool_radius / self._state.figure.factor
        contour = Contour([e for e in waiting if isinstance(e, PathElement)], side, radius)
        for each in waiting:
            if isinstance(each, _Between):
                yield from self._run(each)
            elif isinstance(each, _Approach):
                yield from self._enter(each, contour.first, side, radius)
            else:
                yield from self._emit_all(contour.pieces(each, self._state.programmed))
        if leave is not None:
            feed = self._take_feed(leave)
            here = (*contour.end, self._state.programmed[2]) if contour.end else self._state.programmed
            direction = contour.end_direction or self._direction or (1.0, 0.0)
            yield from self._emit_all(way_out(self._state, leave, here, direction, side, radius, feed))

    def _enter(self, each: _Approach, first: Element | None, side: str, radius: float) -> Iterator[Block]:
        """Yield the approach to the contour: a straight line to the offset start, or the form of APPR."""
        state = self._state
        entry = Entry(each.node, state.programmed, each.element.end, each.element.feed, side, radius)
        direction = first.start_direction if first is not None else each.element.end_direction
        line, text = state.line, state.text
        state.line, state.text = each.element.line, each.element.text
        yield from self._emit_all(way_in(state, entry, direction or (1.0, 0.0)))
        state.line, state.text = line, text

    def _run(self, between: _Between) -> Iterator[Block]:
        state = self._state
        line, text = state.line, state.text
        state.line, state.text = between.line, between.text
        yield from between.event()
        state.line, state.text = line, text

    def _emit_all(self, made: Iterator[PathElement]) -> Iterator[Block]:
        for each in made:
            yield from self._emit(each)

    def _emit(self, each: PathElement) -> Iterator[Block]:
        """Yield the block of one element, converted to plane and machine coordinates."""
        state = self._state
        line, text = state.line, state.text
        state.line, state.text = each.line, each.text
        yield self._block(each)
        state.line, state.text = line, text

    def _block(self, each: PathElement) -> Block:
        state = self._state
        if each.arc is not None:
            return self._arc(each, each.arc)
        if state.m128 and each.rotary:
            return swivelled(state, each)
        goals: Mapping[str, float] = dict(zip(SLIDES, state.machine(each.end), strict=True))
        if not any(abs(goals[name] - state.at[name]) > SAME_POINT for name in SLIDES):
            goals = {}
        rate = None if each.feed is None else state.path_feed(each.feed)
        if rate is not None and each.feed is not None and not goals:
            rate = rotary_feed(state, each.feed, each.rotary)
        return state.move(Kind.RAPID if rate is None else Kind.FEED, {**goals, **each.rotary}, rate)

    def _arc(self, each: PathElement, arc: Arc) -> Block:
        state = self._state
        names = state.names
        columns = names.index("X"), names.index("Y"), names.index("Z")
        if each.upright:
            arc, frame = state.figure.upright(arc, each.order)
            w0, w1 = (seen(each.order, at)[2] * state.figure.factor for at in (each.start, each.end))
            way = HelixMove(state.place, arc, w0, w1, state.there, columns, frame)
        else:
            z0, z1 = (state.figure.plane((0.0, 0.0, at))[2] for at in (each.start[2], each.end[2]))
            way = HelixMove(state.place, state.figure.arc(arc), z0, z1, state.there, columns)
        goals = dict(zip(SLIDES, state.machine(each.end), strict=True))
        rate = None if each.feed is None else state.path_feed(each.feed)
        return state.move(Kind.PLANE_ARC, goals, rate, way)

    def _by_machine(self, node: Move, datum: Mapping[str, float]) -> Iterator[Block]:
        """Yield the move with M91 or M92, whose words refer to machine zero or the second machine datum."""
        state, feed = self._state, self._take_feed(node)
        if feed is not None:
            _warn(state, node)
        goals = _rotary(state, node, dict.fromkeys(state.rotary_names, 0.0))
        for axis, now in zip(SLIDES, state.slides, strict=True):
            if (word := node.word(axis)) is not None:
                value = word_values.coordinate(state, word)
                goals[axis] = value + (now if word.incremental else datum.get(axis, 0.0))
        ways = [goals.get(name, state.at[name]) - state.at[name] for name in SLIDES]
        linear = any(abs(way) > SAME_POINT for way in ways)
        feed = plunged(state, feed, math.hypot(*ways), -ways[2])
        rate = None if feed is None else (state.path_feed(feed) if linear else feed / 60.0)
        yield state.move(Kind.RAPID if rate is None else Kind.FEED, goals, rate)

    # --- words --------------------------------------------------------------------------------------------

    def _demand_axes(self, node: Move) -> None:
        for word in node.axes:
            if word.axis not in self._state.at:
                text = "This machine has no {axis} axis."
                raise self._state.refuse(word.column, WRONG_AXIS, text, "Remove the word.", axis=word.axis)

    def _take_feed(self, node: Move) -> float | None:
        """Set the feed of the block and return it; None for a rapid, which applies only to this block."""
        state = self._state
        column = node.axes[0].column if node.axes else node.column
        found = word_values.programmed_feed(state, node.feed, column)
        if found is None:
            return None
        feed = per_minute(state, *found, column)
        state.feed, state.feed_per = found
        if (rate := state.path_feed(feed)) != state.modal.feed:
            state.modal = state.modal._replace(feed=rate)
        return feed


def _plunged(state: State, each: PathElement) -> float | None:
    """Return the feed of an element, which M103 reduces for downward moves."""
    if state.plunging is None:
        return each.feed
    down = each.start[2] - each.end[2]
    if each.upright:
        text = "A vertical arc with M103 active"
        raise unsupported(each.line, each.column, text)
    along = math.dist(each.start, each.end) if each.arc is None else math.hypot(each.arc.length, down)
    return plunged(state, each.feed, along, down)


def _reshaped(element: PathElement, flat: Element, z0: float, z1: float) -> PathElement:
    """Return the element between other points of the working plane."""
    arc = flat if isinstance(flat, Arc) else None
    return replace(element, start=(*flat.start, z0), end=(*flat.end, z1), arc=arc)


def _rotary(state: State, node: Move, zero: Mapping[str, float]) -> dict[str, float]:
    """Return the targets of the rotary axes; modulo axes move the shorter distance.

    Words are relative to ``zero``. With M127, the travel is the difference of the displayed angles. An
    incremental word is the travel itself.
    """
    found = {}
    for axis in state.kinematics.rotaries:
        word: AxisWord | None = node.word(axis.name)
        if word is not None:
            value, now = word_values.coordinate(state, word), state.at[axis.name]
            state.table_known = state.table_known or not word.incremental
            begin = now - zero[axis.name]
            way = axis.travel(begin, value) if state.short_way else value - axis.displayed(begin)
            found[axis.name] = now + (value if word.incremental else way)
    return found


def _warn(state: State, node: Move) -> None:
    """Warn once of a cut with the table in another position than the plane, or with the spindle stopped."""
    if all(word.axis not in SLIDES for word in node.axes) and not node.words:
        return
    if not state.modal.spindle and "spindle" not in state.reported:
        state.reported.add("spindle")
        text, hint = "The spindle is stopped during this feed move.", ("Start the spindle with M3 or M4.")
        state.log.warn(state.line, 0, "spindle-stopped", text, hint)
    plane = state.plane
    if plane is None or ("table", plane.line) in state.reported:
        return
    off = [
        axis.name
        for axis in state.kinematics.rotaries
        if abs(axis.travel(plane.targets[axis.name], state.at[axis.name])) > AT_TARGET
    ]
    if off:
        state.reported.add(("table", plane.line))
        text = "The position of {off} does not match the plane programmed on line {line}."
        hint = (
            "Position the rotary axes before the cut with L A+Q120 C+Q122 R0 FMAX, or write TURN in the "
            "PLANE block."
        )
        state.log.warn(state.line, 0, "table-elsewhere", text, hint, off=" and ".join(off), line=plane.line)
