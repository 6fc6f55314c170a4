"""Cycles: what CYCL DEF tells, when a cycle is run (CYCL CALL, M99, M89), patterns of places (220, 221).

A cycle from 200 on reads its Q parameters when it is called, so that one that has been set since counts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.geometry.lines_and_arcs import Point
from core.interpreter.actions import Dwell
from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext import word_values
from core.interpreter.klartext.cycle_moves import CycleTool
from core.interpreter.klartext.hole_cycles import HOLES
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.older_cycles import OLDER
from core.interpreter.klartext.plane_functions import plane
from core.interpreter.klartext.q_functions import value
from core.language.diagnostics import Severity
from core.language.klartext.klartext_faults import CYCLE_MISSING, INPUT_VALUE, unsupported
from core.language.klartext.klartext_nodes import (
    AxisWord,
    Cycle,
    CycleCall,
    CycleLine,
    Plane,
    Positioning,
    Value,
)

_PRESET, _CIRCLE, _ROWS = 247, 220, 221
_PRESET_NUMBER = 339  # Q339
_DWELL, _CALL_PROGRAM, _ORIENT, _TILT, _TOLERANCE = 9, 12, 13, 19, 32
_NO_CYCLE = frozenset({_DWELL, _CALL_PROGRAM, _ORIENT, _TILT, _TOLERANCE})
_TRANSFORMS = frozenset({8, 10, 11})  # mirroring, rotation, scaling
_MOST_PLACES = 10_000


class Cycles:
    """The cycle that CYCL DEF has told last, and with M89 is run behind every positioning block."""

    def __init__(self, state: State) -> None:
        self._state = state
        self._number = 0
        self._lines: dict[int, CycleLine] = {}
        self.program = ""  # that cycle 12 has named
        self.modal = False

    def define(self, node: Cycle) -> Iterator[Block]:
        """CYCL DEF of a cycle from 200 on. Patterns are run at once. Raises ProgramError."""
        state = self._state
        known = node.number in HOLES or node.number in {_PRESET, _CIRCLE, _ROWS}
        if not known:
            raise unsupported(state.line, node.column, f"CYCL DEF {node.number}")
        for each in node.values:
            state.q[each.q] = value(state, each.formula)
        if node.number == _PRESET:
            self._preset(node.column)
        elif node.number in {_CIRCLE, _ROWS}:
            yield from self._pattern(node)
        else:
            self._begin(node.number)

    def _begin(self, number: int) -> None:
        """Another machining cycle is told: the one before is forgotten, a program of cycle 12 too."""
        self._number, self._lines, self.program = number, {}, ""

    def _preset(self, column: int) -> None:
        """247: no table of presets is kept here, so the workpiece's zero stays that of the machine file."""
        self._state.preset()
        text = f"Preset {self._state.q.get(_PRESET_NUMBER, 0.0):g} is not kept here."
        hint = "The workpiece's zero is that of the machine file: touch off there."
        self._state.tell_once(column, Severity.WARNING, "preset", text, hint)

    def line(self, node: CycleLine) -> Iterator[Block]:
        """A line of an older cycle. Those that are no machining are done at once. Raises ProgramError."""
        if node.number in _TRANSFORMS and node.part == 0:
            return  # the line behind it says what
        if node.number not in OLDER and node.number not in _NO_CYCLE:
            raise unsupported(self._state.line, node.column, f"CYCL DEF {node.number}")
        if node.number in _NO_CYCLE:
            yield from self._at_once(node)
            return
        if node.part == 0:
            self._begin(node.number)
        self._lines[node.part] = node

    def call(self, column: int) -> Iterator[Block]:
        """The cycle where the tool stands. Raises ProgramError where none has been told."""
        if not self._number:
            text = "No machining cycle has been told."
            raise self._state.refuse(column, CYCLE_MISSING, text, "Write CYCL DEF before.")
        if self._number in OLDER:
            tool = CycleTool(self._state, self._number, lambda _: None, column)
            yield from OLDER[self._number](self._state, tool, self._lines, column)
            return
        yield from HOLES[self._number](self._tool(self._number, column))

    def _tool(self, number: int, column: int) -> CycleTool:
        return CycleTool(self._state, number, self._state.q.get, column)

    # --- what is done at once -----------------------------------------------------------------------------

    def _at_once(self, node: CycleLine) -> Iterator[Block]:
        if node.number == _DWELL and node.part == 1 and node.words:
            seconds = value(self._state, node.words[-1].value.formula)
            yield self._state.action(Dwell(max(seconds, 0.0)))
        elif node.number == _CALL_PROGRAM and node.part == 1:
            self._begin(0)
            self.program = node.text.removeprefix("PGM").strip().strip('"')
        elif node.number == _TILT and node.part == 1:
            yield from plane(self._state, _tilted(node))
        elif node.number in {_ORIENT, _TOLERANCE}:
            self._state.unheeded(f"Cycle {node.number}", node.column)

    def call_at(self, node: CycleCall) -> Iterator[Block]:
        """CYCL CALL POS: over the place above the workpiece, whatever stands in the way below."""
        if not self._number:
            yield from self.call(node.column)
        tool = self._tool(self._number, node.column)
        if self._number not in HOLES:
            raise unsupported(self._state.line, node.column, f"CYCL CALL POS of cycle {self._number}")
        x, y = tool.here
        for word in node.axes:
            at = word_values.coordinate(self._state, word)
            if word.axis == "Z" and (at or word.incremental):
                text = "CYCL CALL POS with a Z other than +0 is not built."
                hint = "Write Z+0, and the surface into Q203."
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
        """The cycle told before at every place of a circle (220) or of rows (221)."""
        tool = self._tool(node.number, node.column)
        if self._number not in HOLES:
            text = f"Cycle {node.number} needs a machining cycle before it."
            raise self._state.refuse(node.column, CYCLE_MISSING, text, "Write its CYCL DEF before.")
        surface = tool.length(203, 0.0)
        above = surface + tool.length(204, 0.0) if tool.plain(301, 1.0) else surface + tool.length(200)
        places = _on_circle(tool) if node.number == _CIRCLE else _in_rows(tool)
        for index, place in enumerate(places):
            if index == 0 or tool.height < above:
                yield tool.to(max(above, tool.height))
            yield tool.across(place)
            yield from self.call(node.column)


def _on_circle(tool: CycleTool) -> list[Point]:
    centre, radius = (tool.length(216), tool.length(217)), tool.length(244) / 2.0
    count, first = _count(tool, 241), tool.plain(245, 0.0)
    step = tool.plain(247, 0.0)
    if not step:
        swept = tool.plain(246, first + 360.0) - first
        step = swept / count if abs(swept) >= 360.0 or count == 1 else swept / (count - 1)
    angles = (math.radians(first + step * at) for at in range(count))
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def _in_rows(tool: CycleTool) -> list[Point]:
    """Row by row, there and back."""
    x0, y0 = tool.length(225), tool.length(226)
    columns, rows = _count(tool, 242), _count(tool, 243)
    angle = math.radians(tool.plain(224, 0.0))
    found = []
    for row in range(rows):
        order = range(columns) if row % 2 == 0 else range(columns - 1, -1, -1)
        for column in order:
            u, v = column * tool.length(237), row * tool.length(238)
            found.append(
                (
                    x0 + u * math.cos(angle) - v * math.sin(angle),
                    y0 + u * math.sin(angle) + v * math.cos(angle),
                )
            )
    return found


def _count(tool: CycleTool, q: int) -> int:
    count = int(tool.plain(q))
    if not 1 <= count <= _MOST_PLACES:
        raise tool.refuse(f"Q{q} {count} is no number of places.", "Write how many there are.")
    return count


def _tilted(node: CycleLine) -> Plane:
    """Cycle 19 as a PLANE: spatial angles, without which it ends; nothing moves."""
    if not node.words:
        return Plane("RESET", (), Positioning("STAY"), node.column)
    named = {word.axis: word for word in node.words}
    words = tuple(named.get(axis, AxisWord(axis, Value(0.0)))._replace(axis=f"SP{axis}") for axis in "ABC")
    return Plane("SPATIAL", words, Positioning("STAY"), node.column)
