"""Definition of cycles with CYCL DEF, and their calls by CYCL CALL, M99, M89 and patterns.

Patterns are the cycles 220 and 221. Cycles numbered 200 or higher read their Q parameters when they are
called, so that later assignments have an effect.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.cycles.contour_cycles import (
    CONTOUR_CYCLES,
    ContourSequence,
    check_contour_data,
    run_contour_cycle,
)
from core.interpreter.klartext.cycles.cycle_moves import CycleTool
from core.interpreter.klartext.cycles.hole_cycles import HOLE_CYCLES
from core.interpreter.klartext.cycles.milling_cycle_table import MILLING_CYCLES
from core.interpreter.klartext.cycles.older_cycles import LAST_LINE_NUMBERS, OLDER_CYCLES, OlderCycleData
from core.interpreter.klartext.cycles.point_patterns import (
    compute_circle_points,
    compute_points,
    compute_row_points,
)
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.flow.word_values import value
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.plane_functions import plane
from core.interpreter.shared.actions import Dwell
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import ProgramError, Severity
from core.language.klartext.cycle_blocks import parse_contour_labels
from core.language.klartext.klartext_faults import (
    CONTRADICTION,
    CYCLE_ALTERNATIVES,
    CYCLE_MISSING,
    CYCLE_UNKNOWN,
    INPUT_VALUE_INCORRECT,
    make_syntax_error,
    make_unsupported_error,
)
from core.language.klartext.klartext_nodes import (
    ContourDefinition,
    ContourPart,
    CycleCall,
    CycleDefinition,
    CycleLine,
    PatternDefinition,
    PlaneBlock,
    RotaryPositioning,
)
from core.language.klartext.klartext_words import AxisWord, Value
from core.language.klartext.named_files import TableRow
from core.message import Message

_PRESET, _CIRCLE, _ROWS = 247, 220, 221
_CONTOUR, _CONTOUR_DATA = 14, 20
_MACHINING = HOLE_CYCLES | MILLING_CYCLES
_SURFACE = 203  # Q203
_PRESET_NUMBER = 339  # Q339
_DWELL, _CALL_PROGRAM, _ORIENT, _TILT, _TOLERANCE = 9, 12, 13, 19, 32
_NON_MACHINING_CYCLES = frozenset({_DWELL, _CALL_PROGRAM, _ORIENT, _CONTOUR, _TILT, _TOLERANCE})
_IMMEDIATE_CYCLES = frozenset({_PRESET, _CIRCLE, _ROWS, _CONTOUR_DATA})
_TRANSFORMS = frozenset({8, 10, 11})  # mirroring, rotation, scaling
_MAX_CONTOURS = 128
_PROGRAM = re.compile(r"(?:PGM\b|%)\s*", re.IGNORECASE)  # text before the name in cycle 12
# words for the set-up distance in cycle 19
_SET_UP_WORDS = frozenset({"ABST", "DIST", "SETUP", "SET-UP", "SET UP"})
_CYLINDER_CYCLES = {27: "surface", 28: "slot", 29: "ridge", 39: "contour"}
_DefinitionNode = CycleDefinition | CycleLine | PatternDefinition | ContourDefinition


class ActiveCycle:
    """The cycle of the last CYCL DEF, which CYCL CALL, M99 and M89 call."""

    def __init__(self, state: State) -> None:
        self._state = state
        self._number = 0
        self._lines: dict[int, CycleLine] = {}
        self.called_program = ""  # the program of cycle 12
        self.is_modal = False
        self._refused = 0  # the cycle below 200 whose first line was rejected
        self._points: list[Vector] = []  # points of PATTERN DEF
        self._contours: tuple[ContourPart, ...] = ()  # contours of cycle 14 or CONTOUR DEF

    def execute_definition(self, node: _DefinitionNode) -> Iterator[Block]:
        """Yield the blocks of a CYCL DEF, PATTERN DEF or contour definition.

        Raises ProgramError for an invalid definition.
        """
        if isinstance(node, PatternDefinition):
            self._points = compute_points(self._state, node)
        elif isinstance(node, ContourDefinition):
            self._contours = node.parts
        elif isinstance(node, CycleDefinition):
            yield from self.define_cycle(node)
        else:
            yield from self.add_cycle_line(node)

    def select_points(self, rows: Mapping[int, TableRow]) -> None:
        """Set the pattern points from point table rows, which contain X, Y and the height above Q203."""
        self._points = [(row.get("X", 0.0), row.get("Y", 0.0), row.get("Z", 0.0)) for row in rows.values()]

    def define_cycle(self, node: CycleDefinition) -> Iterator[Block]:
        """Yield the blocks of a CYCL DEF for a cycle with Q parameters.

        These are the contour cycles (20 to 29 and 39) and the cycles numbered 200 or higher. Cycle 20
        (contour data), cycles 220 and 221 (patterns) and cycle 247 (preset) are executed immediately; only
        a pattern yields blocks. Any other cycle becomes the active cycle. Raises ProgramError for an
        unsupported cycle or invalid values.
        """
        state = self._state
        known = node.cycle_number in _MACHINING.keys() | CONTOUR_CYCLES | _IMMEDIATE_CYCLES
        text = (
            "Cycle {number} is a machine-builder cycle, and this machine does not have machine-builder "
            "cycles."
        )
        hint = "Remove this text from the program."
        state.check_condition(
            not 300 <= node.cycle_number <= 399,
            node.column,
            CYCLE_UNKNOWN,
            text,
            hint,
            number=node.cycle_number,
        )
        if not known:
            raise self._not_supported(node)
        for each in node.parameters:
            state.q_values[each.parameter_number] = value(state, each.formula)
        if node.cycle_number == _PRESET:
            self._preset(node.column)
        elif node.cycle_number in {_CIRCLE, _ROWS}:
            yield from self._pattern(node)
        elif node.cycle_number == _CONTOUR_DATA:
            check_contour_data(self._tool(node.cycle_number, node.column))
        else:
            self._begin(node.cycle_number)

    def _not_supported(self, node: CycleDefinition | CycleLine) -> ProgramError:
        """Return the error for a cycle that TurnDesk does not support."""
        kind = _CYLINDER_CYCLES.get(node.cycle_number)
        kind_suffix = Message(" (cylinder surface, {kind})", kind=kind) if kind else ""
        name = Message("CYCL DEF {number}{kind}", number=node.cycle_number, kind=kind_suffix)
        return make_unsupported_error(
            self._state.line_number, node.column, name, CYCLE_ALTERNATIVES.get(node.cycle_number, "")
        )

    def _begin(self, number: int) -> None:
        """Start the definition of a machining cycle, replacing the previous cycle definition."""
        self._number, self._lines, self.called_program = number, {}, ""

    def _preset(self, column: int) -> None:
        """Execute cycle 247, which activates a preset with its zero and its basic rotation.

        The cycle also resets datum shift, mirroring, rotation and scaling. If no preset table exists, the
        zero of the machine file remains active, and a warning is logged for a number other than 0. Raises
        ProgramError for an undefined preset, and for a preset that changes the basic rotation while a
        tilted plane is active.
        """
        state, number = self._state, self._state.q_values.get(_PRESET_NUMBER, 0.0)
        found = state.setup.presets.get(int(number)) if number == int(number) else None
        if found is None and set(state.setup.presets) - {0}:
            text = "Preset {number} is not in the preset table."
            hint = "Set the preset on the PRESETS page, or correct Q339."
            raise state.make_error(column, INPUT_VALUE_INCORRECT, text, hint, number=number)
        if (
            found is not None
            and state.active_plane is not None
            and state.kinematics.apply_preset(found).workpiece_rotation != state.kinematics.workpiece_rotation
        ):
            text = (
                "Preset {number} rotates the workpiece and cannot be activated while a tilted plane is "
                "active."
            )
            hint = "Write PLANE RESET STAY before this block."
            raise state.make_error(column, CONTRADICTION, text, hint, number=number)
        if found is not None:
            state.kinematics = state.kinematics.apply_preset(found)
        elif number:
            text = "This machine has no preset table, so preset {number} uses the zero from the machine file."
            hint = "Set the preset on the PRESETS page."
            state.log_finding_once(column, Severity.WARNING, "preset", text, hint, number=number)
        state.reset_transformations()

    def add_cycle_line(self, node: CycleLine) -> Iterator[Block]:
        """Yield the blocks of one definition line of a cycle numbered below 200.

        Cycles without machining are executed immediately. Raises ProgramError for an invalid value of such
        a cycle. For an unsupported cycle, raises ProgramError at the first line only.
        """
        if node.cycle_number in _TRANSFORMS and node.line_number == 0:
            return  # the next line has the values
        if node.cycle_number not in OLDER_CYCLES.keys() | _NON_MACHINING_CYCLES:
            if node.line_number and node.cycle_number == self._refused:
                return  # reported at its first line
            self._refused = node.cycle_number
            raise self._not_supported(node)
        if node.cycle_number in _NON_MACHINING_CYCLES:
            yield from self._at_once(node)
            return
        if node.line_number == 0:
            self._begin(node.cycle_number)
        self._lines[node.line_number] = node

    @property
    def contours(self) -> tuple[ContourPart, ...]:
        """Return the contour parts of the active cycle, or an empty tuple if it is not a contour cycle."""
        return self._contours if self._number in CONTOUR_CYCLES else ()

    def call_cycle(self, column: int, contours: ContourSequence = ()) -> Iterator[Block]:
        """Yield the blocks of the active cycle at the tool position.

        ``contours`` are the contours that were read from the subprograms of the active cycle. Raises
        ProgramError if no cycle is defined, if M136 is active, if a line or a contour of the cycle is
        missing, or if the data of the cycle are invalid.
        """
        text = "No machining cycle is defined."
        self._state.check_condition(
            self._number, column, CYCLE_MISSING, text, "Write CYCL DEF before this block."
        )
        self._check_feed_modes(column)
        if self._number in OLDER_CYCLES:
            self._check_lines(column)
            tool = CycleTool(self._state, self._number, lambda _: None, column)
            yield from OLDER_CYCLES[self._number](OlderCycleData(self._state, self._lines, column), tool)
            return
        tool = self._tool(self._number, column)
        if self._number in CONTOUR_CYCLES:
            self._check_contours(contours, column)
            yield from run_contour_cycle(self._state, tool, self._number, contours, column)
            return
        yield from _MACHINING[self._number](tool)

    def _check_contours(self, contours: ContourSequence, column: int) -> None:
        """Raise ProgramError if the contour of a contour cycle is not defined."""
        text = "No contour is defined for cycle {number}."
        hint = "List the contour labels in cycle 14 before this block."
        self._state.check_condition(contours, column, CYCLE_MISSING, text, hint, number=self._number)

    def _check_lines(self, column: int) -> None:
        """Raise ProgramError if the definition of a cycle numbered below 200 is incomplete."""
        number = self._number
        missing = next(
            (part for part in range(1, LAST_LINE_NUMBERS[number] + 1) if part not in self._lines), None
        )
        if missing is not None:
            text = "Line {number}.{missing} of the cycle is missing."
            hint = "Complete the CYCL DEF."
            raise self._state.make_error(column, CYCLE_MISSING, text, hint, number=number, missing=missing)

    def _tool(self, number: int, column: int) -> CycleTool:
        return CycleTool(self._state, number, self._state.q_values.get, column)

    # --- cycles that are executed immediately ---------------------------------------------------------------

    def _at_once(self, node: CycleLine) -> Iterator[Block]:
        if node.cycle_number == _DWELL and node.line_number == 1 and node.words:
            yield self._state.make_action_block(Dwell(self._seconds(node.words[-1])))
        elif node.cycle_number == _CALL_PROGRAM and node.line_number == 1:
            self._begin(0)
            self.called_program = _PROGRAM.sub("", node.text).strip().strip('"')
        elif node.cycle_number == _CONTOUR:
            self._name_contours(node)
        elif node.cycle_number == _TILT and node.line_number == 1:
            yield from plane(self._state, self._make_tilt_plane(node))
        elif node.cycle_number == _TOLERANCE or (node.cycle_number == _ORIENT and not self._orients):
            self._state.log_ignored_function(Message("Cycle {number}", number=node.cycle_number), node.column)
        elif node.cycle_number == _ORIENT and node.line_number == 1:
            self._state.spindle_angle_deg = self._angle(node)

    @property
    def _orients(self) -> bool:
        return self._state.setup.limits.can_orient_spindle

    def _angle(self, node: CycleLine) -> float:
        """Return the spindle angle that cycle 13 defines for M19, in degrees.

        Raises ProgramError if the angle is missing or is not from -360 to 360 degrees.
        """
        hint = "Write ANGLE with a value in degrees."
        self._state.check_condition(
            node.words, node.column, CYCLE_MISSING, "No angle is programmed in cycle 13.", hint
        )
        angle = value(self._state, node.words[-1].value.as_formula)
        if not -360.0 <= angle <= 360.0:
            text = "{parameter} is not a valid spindle angle."
            hint = "Enter an angle from -360 to 360 degrees."
            raise self._state.make_error(
                node.words[-1].column, INPUT_VALUE_INCORRECT, text, hint, parameter=angle
            )
        return angle

    def _name_contours(self, node: CycleLine) -> None:
        """Add the contour labels that one line of cycle 14 lists.

        Raises ProgramError if the line has no label, or if the cycle has more than 128 labels.
        """
        if node.line_number == 0:
            self._contours = ()
            return
        labels = parse_contour_labels(node.text)
        hint = "Write the labels, for example CONTOUR LABEL1 /2."
        self._state.check_condition(
            labels, node.column, CYCLE_MISSING, "Cycle 14 does not list any label.", hint
        )
        self._contours += tuple(ContourPart(label, None) for label in labels)
        if len(self._contours) > _MAX_CONTOURS:
            raise self._state.make_error(
                node.column,
                INPUT_VALUE_INCORRECT,
                "Cycle 14 lists {contours_count} contours; the maximum is {most_contours}.",
                "Combine some of the contours.",
                contours_count=len(self._contours),
                most_contours=_MAX_CONTOURS,
            )

    def _seconds(self, word: AxisWord) -> float:
        """Return the dwell time of cycle 9 in seconds. Raises ProgramError if the time is negative."""
        seconds = value(self._state, word.value.as_formula)
        if seconds < 0.0:
            text = "The dwell time of {seconds} s is negative."
            raise self._state.make_error(
                word.column, INPUT_VALUE_INCORRECT, text, "Enter a time above 0.", seconds=seconds
            )
        return seconds

    def _make_tilt_plane(self, node: CycleLine) -> PlaneBlock:
        """Convert cycle 19 to a PLANE block and return the block.

        The block contains spatial angles, or resets the plane if cycle 19 has no angles. No axis moves
        unless the block has a feed. Raises ProgramError for an invalid word.
        """
        if node.text and node.text.upper() not in _SET_UP_WORDS:
            text = Message("{node} is not an axis.", node=node.text)
            raise make_syntax_error(
                self._state.line_number, node.column, text, "Use only A, B and C in cycle 19."
            )
        if not node.words:
            return PlaneBlock("RESET", (), RotaryPositioning("STAY"), node.column)
        named = {word.axis: word for word in node.words}
        positioning = RotaryPositioning("STAY")
        # The control positions the axes about the point at this distance from the tool.
        if node.feed is not None:
            distance = named[""].value if "" in named else None
            positioning = RotaryPositioning("MOVE", distance, feed=node.feed)
        words = tuple(
            named.get(axis, AxisWord(axis, Value(0.0)))._replace(axis=f"SP{axis}") for axis in "ABC"
        )
        return PlaneBlock("SPATIAL", words, positioning, node.column)

    def _check_feed_modes(self, column: int) -> None:
        """Raise ProgramError if M136 is active, and log a warning if M103 is active.

        M103 does not change the feeds of a cycle.
        """
        if self._state.is_feed_per_revolution:
            raise make_unsupported_error(
                self._state.line_number, column, "A cycle with M136 active (write M137 first)"
            )
        if self._state.plunging_feed_factor is not None:
            text = "M103 does not change the feed rates of a cycle."
            self._state.log_finding_once(column, Severity.WARNING, "cycle-feeds", text)

    def call_pattern(self, node: CycleCall) -> Iterator[Block]:
        """Yield the blocks of CYCL CALL PAT, which executes the cycle at each point of the pattern.

        The tool moves between the points at the safe height. Raises ProgramError if points or a machining
        cycle are missing.
        """
        state = self._state
        text = "Neither PATTERN DEF nor SEL PATTERN has defined any points."
        state.check_condition(
            self._points, node.column, CYCLE_MISSING, text, "Write PATTERN DEF before this block."
        )
        text = "CYCL CALL PAT needs a preceding cycle with a number of 200 or higher."
        hint = "Write the CYCL DEF of a machining cycle before this block."
        state.check_condition(self._number in _MACHINING, node.column, CYCLE_MISSING, text, hint)
        speed = None if node.feed is None else word_values.evaluate_feed(state, node.feed, node.column)
        surface = state.q_values.get(_SURFACE, 0.0)
        try:
            for x, y, above in self._points:
                state.q_values[_SURFACE] = surface + above / state.mm_per_unit
                tool = self._tool(self._number, node.column)
                safe = tool.read_length_mm(_SURFACE) + max(
                    tool.read_length_mm(200), tool.read_length_mm(204, 0.0)
                )
                if tool.z_position < safe:
                    yield tool.move_to_z(safe)
                yield tool.move_straight((x, y), None, speed)
                yield from self.call_cycle(node.column)
        finally:
            # The proof continues after an error of the cycle and needs the programmed surface.
            state.q_values[_SURFACE] = surface

    def call_at_position(self, node: CycleCall) -> Iterator[Block]:
        """Yield the blocks of CYCL CALL POS.

        The blocks are a move to the position above the workpiece, and then the cycle.
        """
        if not self._number:
            yield from self.call_cycle(node.column)
        tool = self._tool(self._number, node.column)
        if self._number not in _MACHINING:
            what = Message("CYCL CALL POS with cycle {number}", number=self._number)
            raise make_unsupported_error(self._state.line_number, node.column, what)
        x, y = tool.xy_position
        for word in node.axis_words:
            at = word_values.evaluate_coordinate(self._state, word)
            if word.axis == "Z" and (at or word.is_incremental):
                text = "CYCL CALL POS with a Z other than +0 is not supported."
                hint = "Write Z+0, and enter the surface coordinate in Q203."
                raise self._state.make_error(word.column, INPUT_VALUE_INCORRECT, text, hint)
            x = (x + at if word.is_incremental else at) if word.axis == "X" else x
            y = (y + at if word.is_incremental else at) if word.axis == "Y" else y
        clear = tool.read_length_mm(203, 0.0) + tool.read_length_mm(200)
        if tool.z_position < clear:
            yield tool.move_to_z(clear)
        feed = None if node.feed is None else word_values.evaluate_feed(self._state, node.feed, node.column)
        yield tool.move_straight((x, y), None, feed)
        yield from self.call_cycle(node.column)

    # --- patterns -----------------------------------------------------------------------------------------

    def _pattern(self, node: CycleDefinition) -> Iterator[Block]:
        """Yield the blocks of the active cycle at each point of a pattern.

        The pattern is a circle (cycle 220) or a grid (cycle 221). Raises ProgramError if no machining cycle
        is active, or if a parameter is missing or invalid.
        """
        tool = self._tool(node.cycle_number, node.column)
        if self._number not in _MACHINING:
            text = "Cycle {number} needs a preceding machining cycle."
            hint = "Write the CYCL DEF of a machining cycle before this block."
            raise self._state.make_error(node.column, CYCLE_MISSING, text, hint, number=node.cycle_number)
        surface = tool.read_length_mm(203, 0.0)
        above = (
            surface + tool.read_length_mm(204, 0.0)
            if tool.read_choice(301, (0, 1), 1.0)
            else surface + tool.read_length_mm(200)
        )
        places = compute_circle_points(tool) if node.cycle_number == _CIRCLE else compute_row_points(tool)
        for index, place in enumerate(places):
            if index == 0 or tool.z_position < above:
                yield tool.move_to_z(max(above, tool.z_position))
            yield tool.move_straight(place)
            yield from self.call_cycle(node.column)
