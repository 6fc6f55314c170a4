"""Definition of cycles with CYCL DEF, their calls (CYCL CALL, M99, M89), and patterns (220, 221).

A cycle from 200 on reads its Q parameters when it is called, so that later assignments apply.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.cycles.contour_cycles import CONTOURS, Figures, contour_data, run_contour
from core.interpreter.klartext.cycles.cycle_moves import CycleTool
from core.interpreter.klartext.cycles.hole_cycles import HOLES
from core.interpreter.klartext.cycles.older_cycles import LAST_LINE, OLDER, Told
from core.interpreter.klartext.cycles.pocket_cycles import MILLED
from core.interpreter.klartext.cycles.point_patterns import in_rows, on_circle, points
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.flow.word_values import value
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.plane_functions import plane
from core.interpreter.shared.actions import Dwell
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import ProgramError, Severity
from core.language.klartext.cycle_blocks import contour_labels
from core.language.klartext.klartext_faults import (
    CONTRADICTION,
    CYCLE_MISSING,
    CYCLE_UNKNOWN,
    INPUT_VALUE,
    INSTEAD_OF_CYCLE,
    syntax,
    unsupported,
)
from core.language.klartext.klartext_nodes import (
    AxisWord,
    ContourDef,
    ContourPart,
    Cycle,
    CycleCall,
    CycleLine,
    PatternDef,
    Plane,
    Positioning,
    Value,
)
from core.language.klartext.named_files import Row
from core.message import Message

_PRESET, _CIRCLE, _ROWS = 247, 220, 221
_CONTOUR, _CONTOUR_DATA = 14, 20
_MACHINING = HOLES | MILLED
_SURFACE = 203  # Q203
_PRESET_NUMBER = 339  # Q339
_DWELL, _CALL_PROGRAM, _ORIENT, _TILT, _TOLERANCE = 9, 12, 13, 19, 32
_NO_CYCLE = frozenset({_DWELL, _CALL_PROGRAM, _ORIENT, _CONTOUR, _TILT, _TOLERANCE})
_AT_ONCE = frozenset({_PRESET, _CIRCLE, _ROWS, _CONTOUR_DATA})
_TRANSFORMS = frozenset({8, 10, 11})  # mirroring, rotation, scaling
_MOST_CONTOURS = 128
_PROGRAM = re.compile(r"(?:PGM\b|%)\s*", re.IGNORECASE)  # text before the name in cycle 12
# words for the set-up distance in cycle 19
_SET_UP = frozenset({"ABST", "DIST", "SETUP", "SET-UP", "SET UP"})
_ON_CYLINDER = {27: "surface", 28: "slot", 29: "ridge", 39: "contour"}


_Told = Cycle | CycleLine | PatternDef | ContourDef


class Cycles:
    """The last cycle of CYCL DEF, which M89 calls after every positioning block."""

    def __init__(self, state: State) -> None:
        self._state = state
        self._number = 0
        self._lines: dict[int, CycleLine] = {}
        self.program = ""  # the program of cycle 12
        self.modal = False
        self._refused = 0  # the cycle below 200 whose first line was rejected
        self._points: list[Vector] = []  # points of PATTERN DEF
        self._contours: tuple[ContourPart, ...] = ()  # contours of cycle 14 or CONTOUR DEF

    def told(self, node: _Told) -> Iterator[Block]:
        """Yield the blocks of a CYCL DEF, PATTERN DEF or contour definition. Raises ProgramError."""
        if isinstance(node, PatternDef):
            self._points = points(self._state, node)
        elif isinstance(node, ContourDef):
            self._contours = node.parts
        elif isinstance(node, Cycle):
            yield from self.define(node)
        else:
            yield from self.line(node)

    def select_points(self, rows: Mapping[int, Row]) -> None:
        """Set the points from a point table: X, Y, and Z above Q203."""
        self._points = [(row.get("X", 0.0), row.get("Y", 0.0), row.get("Z", 0.0)) for row in rows.values()]

    def define(self, node: Cycle) -> Iterator[Block]:
        """Yield the blocks of a CYCL DEF from 200 on; only patterns are executed immediately.

        Raises ProgramError.
        """
        state = self._state
        known = node.number in _MACHINING.keys() | CONTOURS | _AT_ONCE
        text = (
            "Cycle {number} is a machine-builder cycle, and this machine does not have machine-builder "
            "cycles."
        )
        hint = "Remove this text from the program."
        state.check(not 300 <= node.number <= 399, node.column, CYCLE_UNKNOWN, text, hint, number=node.number)
        if not known:
            raise self._not_supported(node)
        for each in node.values:
            state.q[each.q] = value(state, each.formula)
        if node.number == _PRESET:
            self._preset(node.column)
        elif node.number in {_CIRCLE, _ROWS}:
            yield from self._pattern(node)
        elif node.number == _CONTOUR_DATA:
            contour_data(self._tool(node.number, node.column))
        else:
            self._begin(node.number)

    def _not_supported(self, node: Cycle | CycleLine) -> ProgramError:
        """Return the error for a cycle that is rejected by its number."""
        kind = _ON_CYLINDER.get(node.number)
        told = Message(" (cylinder surface, {kind})", kind=kind) if kind else ""
        name = Message("CYCL DEF {number}{kind}", number=node.number, kind=told)
        return unsupported(self._state.line, node.column, name, INSTEAD_OF_CYCLE.get(node.number, ""))

    def _begin(self, number: int) -> None:
        """Start the definition of another machining cycle and clear the previous one."""
        self._number, self._lines, self.program = number, {}, ""

    def _preset(self, column: int) -> None:
        """Execute cycle 247: activate the zero and basic rotation of a row of the preset table.

        Without a preset table, the zero of the machine file remains, with a warning. Raises ProgramError.
        """
        state, number = self._state, self._state.q.get(_PRESET_NUMBER, 0.0)
        found = state.setup.presets.get(int(number)) if number == int(number) else None
        if found is None and set(state.setup.presets) - {0}:
            text = "Preset {number} is not in the preset table."
            hint = "Set the preset on the PRESETS page, or correct Q339."
            raise state.refuse(column, INPUT_VALUE, text, hint, number=number)
        if (
            found is not None
            and state.plane is not None
            and state.kinematics.with_preset(found).basic != state.kinematics.basic
        ):
            text = (
                "Preset {number} rotates the workpiece and cannot be activated while a tilted plane is "
                "active."
            )
            hint = "Write PLANE RESET STAY before this block."
            raise state.refuse(column, CONTRADICTION, text, hint, number=number)
        if found is not None:
            state.kinematics = state.kinematics.with_preset(found)
        elif number:
            text = "This machine has no preset table, so preset {number} uses the zero from the machine file."
            hint = "Set the preset on the PRESETS page."
            state.tell_once(column, Severity.WARNING, "preset", text, hint, number=number)
        state.preset()

    def line(self, node: CycleLine) -> Iterator[Block]:
        """Yield the blocks of a line of a cycle below 200, which are executed immediately if not machining.

        Raises ProgramError if the cycle is not supported.
        """
        if node.number in _TRANSFORMS and node.part == 0:
            return  # the next line has the values
        if node.number not in OLDER.keys() | _NO_CYCLE:
            if node.part and node.number == self._refused:
                return  # reported at its first line
            self._refused = node.number
            raise self._not_supported(node)
        if node.number in _NO_CYCLE:
            yield from self._at_once(node)
            return
        if node.part == 0:
            self._begin(node.number)
        self._lines[node.part] = node

    @property
    def contours(self) -> tuple[ContourPart, ...]:
        """The contours of the active cycle; empty for other cycles."""
        return self._contours if self._number in CONTOURS else ()

    def call(self, column: int, figures: Figures = ()) -> Iterator[Block]:
        """Yield the blocks of the cycle at the tool position. Raises ProgramError without a defined cycle.

        ``figures`` are the contours of ``contours``, as read from their subprograms.
        """
        text = "No machining cycle is defined."
        self._state.check(self._number, column, CYCLE_MISSING, text, "Write CYCL DEF before this block.")
        self._demand_plain_feeds(column)
        if self._number in OLDER:
            self._demand_lines(column)
            tool = CycleTool(self._state, self._number, lambda _: None, column)
            yield from OLDER[self._number](Told(self._state, self._lines, column), tool)
            return
        tool = self._tool(self._number, column)
        if self._number in CONTOURS:
            self._demand_figures(figures, column)
            yield from run_contour(self._state, tool, self._number, figures, column)
            return
        yield from _MACHINING[self._number](tool)

    def _demand_figures(self, figures: Figures, column: int) -> None:
        """Raise ProgramError if no contour is defined."""
        text = "No contour is defined for cycle {number}."
        hint = "List the contour labels in cycle 14 before this block."
        self._state.check(figures, column, CYCLE_MISSING, text, hint, number=self._number)

    def _demand_lines(self, column: int) -> None:
        """Raise ProgramError if a line of a cycle below 200 is missing."""
        number = self._number
        missing = next((part for part in range(1, LAST_LINE[number] + 1) if part not in self._lines), None)
        if missing is not None:
            text = "Line {number}.{missing} of the cycle is missing."
            hint = "Complete the CYCL DEF."
            raise self._state.refuse(column, CYCLE_MISSING, text, hint, number=number, missing=missing)

    def _tool(self, number: int, column: int) -> CycleTool:
        return CycleTool(self._state, number, self._state.q.get, column)

    # --- cycles that are executed immediately ---------------------------------------------------------------

    def _at_once(self, node: CycleLine) -> Iterator[Block]:
        if node.number == _DWELL and node.part == 1 and node.words:
            yield self._state.action(Dwell(self._seconds(node.words[-1])))
        elif node.number == _CALL_PROGRAM and node.part == 1:
            self._begin(0)
            self.program = _PROGRAM.sub("", node.text).strip().strip('"')
        elif node.number == _CONTOUR:
            self._name_contours(node)
        elif node.number == _TILT and node.part == 1:
            yield from plane(self._state, self._tilted(node))
        elif node.number == _TOLERANCE or (node.number == _ORIENT and not self._orients):
            self._state.unheeded(Message("Cycle {number}", number=node.number), node.column)
        elif node.number == _ORIENT and node.part == 1:
            self._state.spindle_angle = self._angle(node)

    @property
    def _orients(self) -> bool:
        return self._state.setup.limits.spindle_oriented

    def _angle(self, node: CycleLine) -> float:
        """Return the angle of cycle 13, to which M19 turns the spindle. Raises ProgramError."""
        hint = "Write ANGLE with a value in degrees."
        self._state.check(node.words, node.column, CYCLE_MISSING, "No angle is programmed in cycle 13.", hint)
        angle = value(self._state, node.words[-1].value.formula)
        if not -360.0 <= angle <= 360.0:
            text = "{parameter} is not a valid spindle angle."
            hint = "Enter an angle from -360 to 360 degrees."
            raise self._state.refuse(node.words[-1].column, INPUT_VALUE, text, hint, parameter=angle)
        return angle

    def _name_contours(self, node: CycleLine) -> None:
        """Add the contour labels of a line of cycle 14. Raises ProgramError if there are too many."""
        if node.part == 0:
            self._contours = ()
            return
        labels = contour_labels(node.text)
        hint = "Write the labels, for example CONTOUR LABEL1 /2."
        self._state.check(labels, node.column, CYCLE_MISSING, "Cycle 14 does not list any label.", hint)
        self._contours += tuple(ContourPart(label, None) for label in labels)
        if len(self._contours) > _MOST_CONTOURS:
            raise self._state.refuse(
                node.column,
                INPUT_VALUE,
                "Cycle 14 lists {contours_count} contours; the maximum is {most_contours}.",
                "Combine some of the contours.",
                contours_count=len(self._contours),
                most_contours=_MOST_CONTOURS,
            )

    def _seconds(self, word: AxisWord) -> float:
        """Return the time of cycle 9 in seconds. Raises ProgramError if it is negative."""
        seconds = value(self._state, word.value.formula)
        if seconds < 0.0:
            text = "The dwell time of {seconds} s is negative."
            raise self._state.refuse(word.column, INPUT_VALUE, text, "Enter a time above 0.", seconds=seconds)
        return seconds

    def _tilted(self, node: CycleLine) -> Plane:
        """Return cycle 19 as a PLANE block with spatial angles; without angles, it resets the plane.

        No axis moves unless the block has a feed. Raises ProgramError for an invalid word.
        """
        if node.text and node.text.upper() not in _SET_UP:
            text = Message("{node} is not an axis.", node=node.text)
            raise syntax(self._state.line, node.column, text, "Use only A, B and C in cycle 19.")
        if not node.words:
            return Plane("RESET", (), Positioning("STAY"), node.column)
        named = {word.axis: word for word in node.words}
        way = Positioning("STAY")
        # The control positions the axes about the point at this distance from the tool.
        if node.feed is not None:
            distance = named[""].value if "" in named else None
            way = Positioning("MOVE", distance, feed=node.feed)
        words = tuple(
            named.get(axis, AxisWord(axis, Value(0.0)))._replace(axis=f"SP{axis}") for axis in "ABC"
        )
        return Plane("SPATIAL", words, way, node.column)

    def _demand_plain_feeds(self, column: int) -> None:
        """Raise ProgramError under M136; warn under M103, which does not change the feeds of a cycle."""
        if self._state.per_revolution:
            raise unsupported(self._state.line, column, "A cycle with M136 active (write M137 first)")
        if self._state.plunging is not None:
            text = "M103 does not change the feed rates of a cycle."
            self._state.tell_once(column, Severity.WARNING, "cycle-feeds", text)

    def call_pattern(self, node: CycleCall) -> Iterator[Block]:
        """Yield the blocks of CYCL CALL PAT: the cycle at each point, with moves at the safe height.

        Raises ProgramError without points or without a machining cycle.
        """
        state = self._state
        text = "Neither PATTERN DEF nor SEL PATTERN has defined any points."
        state.check(self._points, node.column, CYCLE_MISSING, text, "Write PATTERN DEF before this block.")
        text = "CYCL CALL PAT needs a preceding cycle with a number of 200 or higher."
        hint = "Write the CYCL DEF of a machining cycle before this block."
        state.check(self._number in _MACHINING, node.column, CYCLE_MISSING, text, hint)
        speed = None if node.feed is None else word_values.feed_word(state, node.feed, node.column)
        surface = state.q.get(_SURFACE, 0.0)
        try:
            for x, y, above in self._points:
                state.q[_SURFACE] = surface + above / state.scale
                tool = self._tool(self._number, node.column)
                safe = tool.length(_SURFACE) + max(tool.length(200), tool.length(204, 0.0))
                if tool.height < safe:
                    yield tool.to(safe)
                yield tool.across((x, y), None, speed)
                yield from self.call(node.column)
        finally:
            # The proof continues after an error of the cycle and needs the programmed surface.
            state.q[_SURFACE] = surface

    def call_at(self, node: CycleCall) -> Iterator[Block]:
        """Yield the blocks of CYCL CALL POS: to the position above the workpiece, then the cycle."""
        if not self._number:
            yield from self.call(node.column)
        tool = self._tool(self._number, node.column)
        if self._number not in _MACHINING:
            what = Message("CYCL CALL POS with cycle {number}", number=self._number)
            raise unsupported(self._state.line, node.column, what)
        x, y = tool.here
        for word in node.axes:
            at = word_values.coordinate(self._state, word)
            if word.axis == "Z" and (at or word.incremental):
                text = "CYCL CALL POS with a Z other than +0 is not supported."
                hint = "Write Z+0, and enter the surface coordinate in Q203."
                raise self._state.refuse(word.column, INPUT_VALUE, text, hint)
            x = (x + at if word.incremental else at) if word.axis == "X" else x
            y = (y + at if word.incremental else at) if word.axis == "Y" else y
        clear = tool.length(203, 0.0) + tool.length(200)
        if tool.height < clear:
            yield tool.to(clear)
        feed = None if node.feed is None else word_values.feed_word(self._state, node.feed, node.column)
        yield tool.across((x, y), None, feed)
        yield from self.call(node.column)

    # --- patterns -----------------------------------------------------------------------------------------

    def _pattern(self, node: Cycle) -> Iterator[Block]:
        """Yield the blocks of the previous cycle at each point of a circle (220) or of rows (221)."""
        tool = self._tool(node.number, node.column)
        if self._number not in _MACHINING:
            text = "Cycle {number} needs a preceding machining cycle."
            hint = "Write the CYCL DEF of a machining cycle before this block."
            raise self._state.refuse(node.column, CYCLE_MISSING, text, hint, number=node.number)
        surface = tool.length(203, 0.0)
        above = surface + tool.length(204, 0.0) if tool.plain(301, 1.0) else surface + tool.length(200)
        places = on_circle(tool) if node.number == _CIRCLE else in_rows(tool)
        for index, place in enumerate(places):
            if index == 0 or tool.height < above:
                yield tool.to(max(above, tool.height))
            yield tool.across(place)
            yield from self.call(node.column)
