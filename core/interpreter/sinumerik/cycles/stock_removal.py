"""Stock removal with CYCLE95, which roughs and finishes a contour along Z or X, outside or inside.

``contour_passes`` calculates the passes. The cycle calculates its start point from the contour and not from
the tool position. The passes are calculated for the nose center, so that tapers and arcs are accurate, and
are output as the path of the tip. The contour is a subprogram, or the lines between two labels.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from core.geometry.contour_offset import RoughingArea, TrimError
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, shift_element
from core.interpreter.shared.contour_passes import (
    MAX_COMPARISON_COUNT,
    MAX_ELEMENT_COUNT,
    ContourClearanceError,
    ContourFrame,
    CycleMove,
    RoughingPlanner,
    make_contour_frame,
)
from core.interpreter.shared.contour_stage import make_element
from core.interpreter.shared.control_flow import MAIN_FILE
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    DEFAULT_RETRACT_MM,
    WRONG_MACHINING_TYPE,
    CycleCall,
    CycleStep,
    make_dwell_steps,
)
from core.interpreter.sinumerik.flow.control_structures import Routine, find_label_index
from core.interpreter.sinumerik.flow.variable_assignments import set_parameters
from core.interpreter.sinumerik.motion.chamfers_and_roundings import SinumerikCornerStage, make_corner
from core.interpreter.sinumerik.motion.linear_moves import make_straight_block
from core.interpreter.sinumerik.motion.sinumerik_arcs import make_arc_block
from core.interpreter.sinumerik.setup.modes_and_offsets import set_modal_functions
from core.interpreter.sinumerik.sinumerik_state import ARC_MOTIONS, MotionKind, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement, make_statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.control_statements import ControlKeyword
from core.language.sinumerik.sinumerik_alarms import make_alarm_diagnostic
from core.language.sinumerik.sinumerik_words import ARC_WORDS, CORNER_WORDS, POSITION_WORDS
from core.language.sinumerik.sinumerik_words import LexedBlock as SourceLine
from core.language.sinumerik.word_table import DIAMETER_GROUP, DISTANCE_MODE_GROUP, MOTION_GROUP, PLANE_GROUP
from core.message import Message
from core.tool_edges import TIP_DIRECTIONS

WRONG_CONTOUR_DEFINITION = 61605
_MOTIONS = frozenset({0, 1, 2, 3})
_GROUPS = frozenset({MOTION_GROUP, DISTANCE_MODE_GROUP, PLANE_GROUP, DIAMETER_GROUP})
_ALLOWED_FLOW_WORDS = frozenset(
    {ControlKeyword.PROCEDURE, ControlKeyword.MESSAGE, ControlKeyword.STOP_READING, ControlKeyword.RETURN}
)
_WORDS = (POSITION_WORDS | ARC_WORDS | CORNER_WORDS) - {"C", "Y", "J"} | {
    *("F", "FB", "FRC", "FRCM", "OVR", "S", "LIMS", "ADIS", "ADISPOS", "DITS", "DITE")
}
"""Words that are allowed in a contour. Only positions, arcs and corners have an effect."""

_CANCELED_BY_ZERO = frozenset({"RNDM", "OFFN"})
"""Words that are allowed with the value 0, because the function is off in a contour."""

_END = frozenset({2, 17, 30})


def find_contour_lines(
    contour_name: str, active_routine: Routine, contour_routine: Routine | None
) -> list[SourceLine] | None:
    """Return the lines of the contour with this name, or None if no such contour exists."""
    if ":" in contour_name:
        first, last = (part.strip() for part in contour_name.split(":", 1))
        start = find_label_index(
            ControlKeyword.GOTO, first, active_routine, active_routine.line_range.start - 1
        )
        end = (
            None
            if start is None
            else find_label_index(ControlKeyword.GOTO_FORWARD, last, active_routine, start)
        )
        if start is None or end is None:
            return None
        return [active_routine.get_line(at) for at in range(start, end + 1)]
    return (
        None
        if contour_routine is None
        else [contour_routine.get_line(at) for at in contour_routine.line_range]
    )


def read_contour(state: SinumerikState, lines: Iterable[SourceLine], log: DiagnosticLog) -> list[Element]:
    """Return the lines and arcs of a contour in the program frame, in mm.

    The first move leads to the first point of the contour. The active state does not change, and ``log``
    receives the warnings. Raises ProgramError for a line that is not allowed in a contour, and for an invalid
    assignment.
    """
    reader = _Reader(state, log)
    for line in lines:
        if line.skip_level is not None and state.setup.block_delete:
            continue
        if line.is_executable and reader.read_line(line):
            break
    return reader.read_elements()


class _Reader:
    def __init__(self, state: SinumerikState, log: DiagnosticLog) -> None:
        own = copy.copy(state)
        own.log, own.moved_by_tool = log, set(state.moved_by_tool)
        own.call_site = MAIN_FILE  # the cycle call relocates the findings
        own.variables = copy.copy(state.variables)
        own.variables.variable_scope = state.variables.variable_scope.copy()
        own.variables.r_parameters = dict(state.variables.r_parameters)
        own.threads, own.rounding, own.motion = (), 0.0, MotionKind.LINE
        # The feeds of a contour have no effect, so a missing feed is not an error.
        own.set_modal_state(state.modal._replace(feed=1.0, per_rev=False, css=False))
        self._state = own
        self._corners = SinumerikCornerStage(own, own.log)
        self._blocks: list[Block] = []

    def read_line(self, line: SourceLine) -> bool:
        """Read one line, and return whether this line ends the contour.

        Raises ProgramError for a line that is not allowed in a contour, and for an invalid assignment.
        """
        for found in line.errors:
            raise ProgramError(found)
        if (
            line.called_name
            or line.is_modal_call
            or (
                line.control_statement is not None
                and line.control_statement.keyword not in _ALLOWED_FLOW_WORDS
            )
        ):
            raise _refused(line, "a contour can contain only moves, but this line contains a call or a jump")
        if line.control_statement is not None:
            return line.control_statement.keyword is ControlKeyword.RETURN
        statement = make_statement(line)
        self._check(statement)
        set_parameters(self._state, statement)
        if statement.g_words:
            set_modal_functions(self._state, statement)
        if statement.has_position_word or not ARC_WORDS.isdisjoint(statement.words):
            block = (make_arc_block if self._state.motion in ARC_MOTIONS else make_straight_block)(
                self._state, statement
            )
            corner = make_corner(self._state, statement, block)
            self._blocks += self._corners.accept_item(block, corner)
        return bool(_END & statement.m_words.keys())

    def _check(self, statement: Statement) -> None:
        groups = statement.g_words.keys() - _GROUPS
        if groups:
            word = statement.g_words[min(groups)]
            raise _refused(
                statement.lexed_block, Message("{line} is not allowed in a contour", line=word.text)
            )
        motion = statement.get_g_code(MOTION_GROUP)
        if motion is not None and motion not in _MOTIONS:
            raise _refused(statement.lexed_block, "a contour can contain only G0, G1, G2 and G3")
        for name in sorted(statement.words.keys() - _WORDS - {"C"}):
            word = statement.words[name]
            if name in _CANCELED_BY_ZERO and self._state.number(statement, word) == 0.0:
                continue
            raise _refused(
                statement.lexed_block, Message("{line} is not allowed in a contour", line=word.text)
            )
        if "C" in statement.words or statement.frame_word is not None:
            raise _refused(statement.lexed_block, "C and frames are not allowed in a contour")

    def read_elements(self) -> list[Element]:
        """Return all elements after the first move."""
        self._blocks += self._corners.flush_at_program_end()
        elements = [make_element(block) for block in self._blocks[1:] if block.moves]
        return [each for each in elements if each.length > _SAME]


def _refused(line: SourceLine, why: str) -> ProgramError:
    return ProgramError(
        make_alarm_diagnostic(
            line.line_number,
            1,
            WRONG_CONTOUR_DEFINITION,
            line.block_name,
            Message("{what}.", what=why),
            "Remove this text from the program.",
        )
    )


MISSING_INFEED = 61610
_SAME = 1e-6  # mm
# With a VARI above this value, the steps between passes are left; here, the last pass along the contour cuts
# them.
_ROUNDING = 200


class MachiningType(NamedTuple):
    """The machining type that VARI specifies.

    ``is_transverse`` means that the passes are along X instead of Z.
    """

    is_transverse: bool
    is_internal: bool
    has_roughing: bool
    has_finishing: bool


def read_machining_type(cycle: CycleCall) -> MachiningType:
    """Return the machining type for VARI 1 to 12 or 201 to 212. Raises ProgramError for any other value."""
    value = cycle.read_number("VARI", -1.0)
    number = round(value) % _ROUNDING
    if value != round(value) or value < 1 or number not in range(1, 13) or value > _ROUNDING + 12:
        wrong = "{name} is {value}; valid types are 1 to 12"
        missing = "{name} is missing; valid types are 1 to 12"
        hint = "Enter 1 for roughing, 5 for finishing or 9 for both, for external machining along Z."
        text = wrong if cycle.has_argument("VARI") else missing
        raise cycle.make_parameter_error("VARI", text, hint, WRONG_MACHINING_TYPE, value=value)
    rest = (number - 1) % 4
    return MachiningType(rest % 2 == 1, rest >= 2, number <= 4 or number >= 9, number >= 5)


def run_stock_removal(cycle: CycleCall, contour: list[Element]) -> Iterator[Block]:
    """Return the blocks of CYCLE95. If ProgramError is raised, no block has been generated."""
    kind = read_machining_type(cycle)
    text = "{name} refers to a contour without lines or arcs"
    cycle.check_parameter(contour, "NPP", text, "Write the points of the contour.", WRONG_CONTOUR_DEFINITION)
    if len(contour) > MAX_ELEMENT_COUNT:
        text = "{name} has {contour_count} elements; the maximum is {most_elements}"
        hint = "Split the contour into smaller parts."
        raise cycle.make_parameter_error(
            "NPP", text, hint, contour_count=f"{len(contour):,}", most_elements=f"{MAX_ELEMENT_COUNT:,}"
        )
    plan = _Plan(cycle, kind, contour)
    steps = plan.plan_approach()
    if kind.has_roughing:
        steps += plan.plan_roughing()
    if kind.has_finishing:
        steps += plan.plan_finishing()
    cycle.state.moved_by_tool.clear()  # The cycle moves both axes to programmed positions.
    return cycle.make_blocks(steps)


class _Plan:
    """Planner of stock removal. Depth is X and length is Z, or the reverse for passes along X."""

    def __init__(self, cycle: CycleCall, kind: MachiningType, contour: list[Element]) -> None:
        self._cycle, self._kind = cycle, kind
        self._off = cycle.read_unsigned_length_mm("_VRT") or DEFAULT_RETRACT_MM
        self._left = cycle.read_unsigned_length_mm("FAL")
        self._allow = cycle.read_unsigned_length_mm("FALX"), cycle.read_unsigned_length_mm("FALZ")
        if kind.is_transverse:
            contour = [_swapped(each) for each in contour]
            self._allow = self._allow[1], self._allow[0]
        self._contour = contour
        self._signs = self._free_side()
        self._nose, self._tip = _tool_nose(cycle)
        self._contour = self._extend_contour()
        self._start = self._start_point()

    def _free_side(self) -> tuple[float, float]:
        """Return the signs of the directions in depth and length toward the open side of the contour."""
        if self._kind.is_transverse:  # The face is on the right side.
            return 1.0, (-1.0 if self._kind.is_internal else 1.0)
        first, last = self._contour[0].start, self._contour[-1].end
        out = -1.0 if self._kind.is_internal else 1.0
        deep, other = (first, last) if out * first[0] <= out * last[0] else (last, first)
        return out, (1.0 if deep[1] >= other[1] else -1.0)

    def _extend_contour(self) -> list[Element]:
        """Return the contour with its ends extended by the nose radius where they lead straight outward.

        An end is extended only if it is a straight line in the infeed direction that leads to the open
        side. The tip then reaches the programmed end.
        """
        *_, last = contour = list(self._contour)
        contour[-1] = self._straight_out(last)
        contour[0] = self._straight_out(contour[0].make_reversed()).make_reversed()
        return contour

    def _straight_out(self, element: Element) -> Element:
        (x0, z0), (x, z) = element.start, element.end
        if not isinstance(element, Line) or abs(z - z0) > _SAME or (x - x0) * self._signs[0] <= 0.0:
            return element
        return Line(element.start, (x + self._signs[0] * self._nose, z))

    def _start_point(self) -> Point:
        """Return the start point of the cycle, outside both ends of the contour.

        The start point is at the outermost depth of the contour, at a distance of the allowance plus _VRT
        in front of it.
        """
        out, front = self._signs
        boxes = [each.bounding_box for each in self._contour]
        depth = max(b[1] for b in boxes) if out > 0 else min(b[0] for b in boxes)
        length = max(b[3] for b in boxes) if front > 0 else min(b[2] for b in boxes)
        (allow_depth, allow_length), left = self._allow, self._left + self._nose
        return depth + out * (allow_depth + left), length + front * (allow_length + left + self._off)

    def _area(self, contour: Sequence[Element], left: float) -> tuple[RoughingArea, ContourFrame]:
        ends = contour[0].start, contour[-1].end
        view = make_contour_frame(self._start, *ends)
        try:
            return RoughingArea(view.transform_contour(contour), left + self._nose), view
        except TrimError:
            text = "with allowance {name}, no continuous path along the contour is possible"
            hint = "Reduce FAL, or widen the narrow part of the contour."
            raise self._cycle.make_parameter_error("FAL", text, hint, 61606) from None

    def plan_approach(self) -> list[CycleStep]:
        """Return the steps to the start point: first in depth, away from the part, and then in length."""
        out, _ = self._signs
        depth, length = self._start
        x, z = self._cycle.x - self._tip[0], self._cycle.z - self._tip[1]
        here = (z, x) if self._kind.is_transverse else (x, z)
        clear = depth + out * self._off
        if out * here[0] > out * clear:
            clear = here[0]
        return [self._step(CycleMove(clear, here[1], 1.0)), self._step(CycleMove(clear, length, 1.0)),
                self._step(CycleMove(depth, length, 1.0))]  # fmt: skip

    def plan_roughing(self) -> list[CycleStep]:
        """Return the roughing steps: equal passes of at most MID, then a pass along the contour.

        The last pass leaves the allowance.
        """
        cycle = self._cycle
        infeed = cycle.read_unsigned_length_mm("MID")
        text = "{name} is missing, so the depth of a pass is not defined"
        cycle.check_parameter(infeed, "MID", text, "Write MID.", MISSING_INFEED)
        contour, left = self._with_allowance()
        area, view = self._area(contour, left)
        text = "{name} specifies a contour with no material to cut"
        cycle.check_parameter(
            area.max_depth > 0, "NPP", text, "Check the direction of the contour.", WRONG_CONTOUR_DEFINITION
        )
        text = "{name} would need {count} passes, which is too many"
        count = cycle.compute_pass_count(
            area.max_depth, infeed, "MID", text, maximum=MAX_COMPARISON_COUNT // len(contour)
        )
        rougher = RoughingPlanner(area, 1.0, self._off)
        rougher.add_roughing_passes(count)
        if rougher.has_plunged and not cycle.read_number("FF2") and cycle.state.modal.feed is None:
            text = "{name} is missing, but the contour has a relief cut"
            raise cycle.make_parameter_error("FF2", text, "Write FF2.", 61003)
        moves = self._run(rougher, view)
        return self._fed(moves, cycle.read_feed("FF1"), cycle.read_feed("FF2"), breaks=True)

    def plan_finishing(self) -> list[CycleStep]:
        """Return the steps of the finishing pass along the contour."""
        area, view = self._area(self._contour, 0.0)
        return self._fed(
            self._run(RoughingPlanner(area, 1.0, self._off), view), self._cycle.read_feed("FF3"), None
        )

    def _run(self, rougher: RoughingPlanner, view: ContourFrame) -> list[CycleMove]:
        try:
            rougher.add_finishing_pass(is_reversed=view.is_reversed)
        except ContourClearanceError:
            text = "{name} specifies a contour that the tool cannot approach or leave with enough clearance"
            hint = "End the contour at a point where the tool can leave it."
            raise self._cycle.make_parameter_error("NPP", text, hint, 61607) from None
        return [view.transform_move(move) for move in rougher.moves]

    def _with_allowance(self) -> tuple[list[Element], float]:
        """Return the contour shifted by FALX and FALZ, and the remaining allowance.

        A contour with a recess is not shifted. Its allowance is the larger of the two values.
        """
        depth, length_allowance = self._allow
        out, front = self._signs
        if not depth and not length_allowance:
            return self._contour, self._left
        flat = [
            (point[0] * out, -point[1] * front) for each in self._contour for point in (each.start, each.end)
        ]
        rises = all(b[0] >= a[0] - _SAME for a, b in pairwise(flat))
        falls = all(b[0] <= a[0] + _SAME for a, b in pairwise(flat))
        if (rises or falls) and not self._left:
            return [shift_element(each, out * depth, front * length_allowance) for each in self._contour], 0.0
        return self._contour, max(depth, length_allowance, self._left)

    def _fed(
        self, moves: Sequence[CycleMove], feed: float | None, plunge: float | None, *, breaks: bool = False
    ) -> list[CycleStep]:
        cycle = self._cycle
        if feed is None:
            name = "FF1" if breaks else "FF3"
            raise cycle.make_parameter_error(
                name, "{name} is missing, and no F is active", "Write {name}.", 61003
            )
        steps: list[CycleStep] = []
        at = self._start
        for move in moves:
            # In a recess, the tool moves only in depth, away from the front of the area.
            deeper = self._signs[0] * (at[0] - move.x) > _SAME and abs(move.z - at[1]) < _SAME
            into = deeper and abs(at[1] - self._start[1]) > _SAME
            speed = plunge if into and plunge is not None else feed
            steps += self._break_chips(at, move, speed) if breaks else [self._step(move, speed)]
            at = move.x, move.z
        return steps

    def _break_chips(self, position: Point, move: CycleMove, feed: float) -> list[CycleStep]:
        """Return a cut that breaks chips: after each distance DAM, the tool dwells for DT."""
        length, seconds = self._cycle.read_unsigned_length_mm("DAM"), self._cycle.read_number("DT")
        travel_mm = move.z - position[1]
        if (
            not length
            or move.rapid_rate_mm_s is not None
            or move.center is not None
            or abs(travel_mm) <= length + _SAME
        ):
            return [self._step(move, feed)]
        steps: list[CycleStep] = []
        text = "{name} would interrupt a pass {count} times, which is too many"
        count = self._cycle.compute_pass_count(abs(travel_mm), length, "DAM", text, "Correct the value.")
        for k in range(1, count + 1):
            share = min(k * length / abs(travel_mm), 1.0)
            between = CycleMove(position[0] + (move.x - position[0]) * share, position[1] + travel_mm * share)
            steps.append(self._step(between, feed))
            if k < count:
                steps += make_dwell_steps(seconds)
        return steps

    def _step(self, move: CycleMove, feed: float | None = None) -> CycleStep:
        """Convert a motion of the nose center in depth and length to a step of the tip in X and Z."""
        dx, dz = self._tip
        at, centre, clockwise = (move.x, move.z), move.center, move.is_clockwise
        if self._kind.is_transverse:
            at, centre = (move.z, move.x), None if centre is None else (centre[1], centre[0])
            clockwise = centre is not None and not clockwise
        about = None if centre is None else (centre[0] + dx, centre[1] + dz)
        return CycleStep(
            at[0] + dx, at[1] + dz, None if move.rapid_rate_mm_s is not None else feed, about, clockwise
        )


def _tool_nose(cycle: CycleCall) -> tuple[float, Point]:
    """Return the nose radius, and the position of the tip relative to the nose center in mm (X, Z).

    Without a tip quadrant, the position of the center is unknown. The tip then follows the contour, and a
    warning is logged.
    """
    edge = cycle.state.edge
    if not cycle.state.modal.edge or not edge.nose_radius:
        return 0.0, (0.0, 0.0)
    if not edge.quadrant:
        text = "the tool has no tip quadrant, so {call} ignores the nose radius on tapers and arcs."
        hint = "Enter the tip quadrant on the TOOL OFFSETS page (F8)."
        cycle.log_warning("comp-no-quadrant", text, hint)
        return 0.0, (0.0, 0.0)
    z, x = TIP_DIRECTIONS[edge.quadrant]
    return edge.nose_radius, (x * edge.nose_radius, z * edge.nose_radius)


def _swapped(element: Element) -> Element:
    (x0, z0), (x1, z1) = element.start, element.end
    if isinstance(element, Line):
        return Line((z0, x0), (z1, x1))
    return Arc((z0, x0), (z1, x1), (element.center[1], element.center[0]), not element.clockwise)
