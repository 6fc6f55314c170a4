"""Threading cycles G33 and G34, with their passes and the rapids between the passes.

All lengths are in mm, with X as a radius. The formulas are in
docs/decisions/0004-contours-and-cycles-calculated-first.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, copysign, radians, tan

from core.interpreter.omniturn.codes.code_rules import check_conditions, check_word_number, number
from core.interpreter.omniturn.motion.straight_moves import check_move_after_tool, round_to_resolution
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.message import Message

# --- words and checks of a thread


MAX_PASS_COUNT = 1000  # a real thread takes fewer than 100 passes
_MIN_LEAD = 0.0254  # mm/rev; the finest pitch of ISO 1501 is 0.08 mm
_ROUNDING = 1 + 1e-9
_CLICK = 1e-6  # of a pass; tolerance for the rounding of √ and decimal fractions
_NEAR = 1e-6  # mm


@dataclass(frozen=True, slots=True)
class ThreadCycle:
    """The data of one threading cycle, in mm with X as a radius, and in radians.

    - ``start_x`` and ``start_z`` are the start point.
    - ``x_outward_sign`` is the sign of X away from the part.
    - ``z_cutting_sign`` is the sign of Z in the cutting direction.
    - ``depth_mm`` is the depth of the last pass, measured from the start point.
    - ``first_infeed_mm`` is the I word per side.
    - ``taper_mm`` is the change of X from the start to the end of the thread.
    """

    start_x: float
    start_z: float
    end_z: float
    x_outward_sign: float
    z_cutting_sign: float
    depth_mm: float
    first_infeed_mm: float
    lead_mm: float
    taper_mm: float
    flank_angle_rad: float
    pass_count: int
    has_pullout: bool

    @property
    def retract_x(self) -> float:
        """Return X of the return move, farther from the part than the start point by 3 times I.

        The taper is added if the far end is farther from the part than the start point.
        """
        return self.start_x + self.x_outward_sign * (
            3 * self.first_infeed_mm + max(self.x_outward_sign * self.taper_mm, 0.0)
        )


def read_threading_cycle(state: State, statement: Statement) -> ThreadCycle:
    """Return the threading cycle of a line. Raises ProgramError if the cycle is invalid."""
    if state.tool_line:
        check_move_after_tool(state, statement.line, None, None)
    number(state, statement, "P")
    lead = _lead(state, statement)
    _check_spindle(state, statement, lead)
    along, z1 = _cutting_direction(state, statement)
    single = statement.one_shot_code == 34
    first = check_word_number(state, statement, "I", _read_radius_word(state, statement, "I")) or 0.0
    depth, out = (0.0, copysign(1.0, first)) if single else _depth(state, statement)
    once = single or "O" in statement.words
    angle = radians(number(state, statement, "C") or 0.0) if "C" in statement.words else 0.0
    thread = ThreadCycle(
        start_x=state.x,
        start_z=state.z,
        end_z=z1,
        x_outward_sign=out,
        z_cutting_sign=along,
        depth_mm=depth,
        first_infeed_mm=abs(first),
        lead_mm=lead,
        taper_mm=_read_radius_word(state, statement, "A") or 0.0,
        flank_angle_rad=angle,
        pass_count=1 if once else _count(statement, depth, first, lead),
        has_pullout="P" in statement.words,
    )
    if along * (z1 - state.z) <= depth * tan(angle) + _NEAR:
        text = "Because of the flank angle, the last pass would start beyond its end point in Z."
        raise statement.make_error("C", "thread-angle", text, "Start farther away from the end point Z.")
    return thread


def _lead(state: State, statement: Statement) -> float:
    lead, feed = statement.get_value("K"), statement.words.get("F")
    if lead is None and feed is not None:
        raise statement.make_error(
            "F",
            "thread-lead-missing",
            "The lead K is missing, but the line contains {feed}.",
            Message("Did you mean K{feed}?", feed=feed.text[1:]),
            feed=feed.text,
        )
    coarser = ("Use G35 for a larger lead.", "Use G35F2 for a larger lead.", "Correct K.")[state.modal.coarse]
    value = (
        check_word_number(state, statement, "K", lead and lead * state.mm_per_z_unit, extra_remedy=coarser)
        or 0.0
    )
    if value < _MIN_LEAD:
        least = state.modal.format_feed(_MIN_LEAD, is_per_rev=True)
        text = "{text}: the minimum lead is {minimum}."
        raise statement.make_error(
            "K", "thread-lead-range", text, "Correct K.", text=statement.words["K"].text, minimum=least
        )
    return value


def _check_spindle(state: State, statement: Statement, lead: float) -> None:
    check_conditions(state, statement, statement.code_entry)
    modal, rpm = state.modal, abs(state.compute_rpm_at(state.x))
    speed, most = lead * rpm / 60, state.setup.limits.max_feed_mm_s
    if speed > most * _ROUNDING:
        shown = modal.format_feed(speed, is_per_rev=False)
        limit = modal.format_feed(most, is_per_rev=False)
        text = "At {rpm} rpm this lead needs a feed of {value}; the maximum is {limit}."
        hint = "Lower S."
        raise statement.make_error(
            "K", "feed-over-speed", text, hint, rpm=f"{rpm:.0f}", value=shown, limit=limit
        )


def _cutting_direction(state: State, statement: Statement) -> tuple[float, float]:
    """Return the sign of Z in the cutting direction, and the Z coordinate of the thread end in mm."""
    z = check_word_number(state, statement, "Z", round_to_resolution(state, statement, "Z")) or 0.0
    z1 = (z if state.absolute else state.pz + z) + state.secondary_z
    if abs(z1 - state.z) <= _NEAR:
        text = "The thread ends at the same Z where it starts."
        raise statement.make_error("Z", "thread-length", text, "Correct Z, or move the tool away before G33.")
    return copysign(1.0, z1 - state.z), z1


def _depth(state: State, statement: Statement) -> tuple[float, float]:
    """Return the depth of the last pass from the start point, and the sign of X away from the part."""
    x = check_word_number(state, statement, "X", round_to_resolution(state, statement, "X")) or 0.0
    x1 = (x if state.absolute else state.px + x) + state.secondary_x
    here = Message("the tool is at radius {x}", x=state.modal.format_length(state.x))
    if abs(x1 - state.x) <= _NEAR:
        text = "{text} leaves no material to cut because {position}."
        hint = "Position the tool at the depth of the first pass before this line."
        raise statement.make_error(
            "X", "thread-side", text, hint, text=statement.words["X"].text, position=here
        )
    if x1 * state.x < 0:
        text = "{text} is on the other side of the spindle centerline: {position}."
        hint = "Check the sign of X and the start position of the tool."
        raise statement.make_error(
            "X", "thread-side", text, hint, text=statement.words["X"].text, position=here
        )
    return abs(x1 - state.x), copysign(1.0, state.x - x1)


def _count(statement: Statement, depth: float, first_infeed: float, lead: float) -> int:
    """Return the number of passes.

    Raises ProgramError if I is greater than the lead, or if more than 1000 passes are needed.
    """
    text = "{text}: the first pass would be deeper than the lead."
    hint = "Correct I (the depth of the first pass) or K."
    statement.check_condition(
        first_infeed <= lead, "I", "thread-depth", text, hint, text=statement.words["I"].text
    )
    count = max(ceil((depth / first_infeed + 1.0) ** 2 - _CLICK), 1)
    if count > MAX_PASS_COUNT:
        text = "The thread would take {count} passes; the maximum is {most_passes}."
        raise statement.make_error(
            "I", "thread-passes", text, "Correct I.", count=f"{count:,}", most_passes=f"{MAX_PASS_COUNT:,}"
        )
    return count


def _read_radius_word(state: State, statement: Statement, letter: str) -> float | None:
    """Return the I or A word in mm as a radius, or None if the word is missing.

    Under G72, the word is programmed as a diameter.
    """
    value = round_to_resolution(state, statement, letter)
    return None if value is None else value * state.mm_per_x_unit / state.mm_per_z_unit


PASS_COUNT_WARNING_LIMIT = 60
_FACE = 1e-9  # mm


def generate_thread_blocks(state: State, statement: Statement) -> Iterator[Block]:
    """Generate the blocks of a G33 or G34 line, which start and end at the same point.

    If ProgramError is raised, no block has been generated.
    """
    thread = read_threading_cycle(state, statement)
    _warn(state, statement, thread)
    return _ThreadBlockGenerator(state, statement, thread).generate_blocks()


def compute_pass_depths(thread: ThreadCycle) -> list[float]:
    """Return the depth of each pass from the start point, in mm.

    After k passes, the depth is I(√k - 1), so that each pass removes the same area.
    """
    if thread.pass_count == 1:
        return [thread.depth_mm]
    cuts = [thread.first_infeed_mm * (k**0.5 - 1.0) for k in range(1, thread.pass_count)]
    return [*cuts, thread.depth_mm]


def compute_start_z(thread: ThreadCycle, depth: float) -> float:
    """Return the start Z in mm of a threading pass at this depth.

    The start is shifted in the cutting direction, along the flank of the thread.
    """
    return thread.start_z + thread.z_cutting_sign * depth * tan(thread.flank_angle_rad)


class _ThreadBlockGenerator:
    """Generator of the blocks of one threading cycle."""

    def __init__(self, state: State, statement: Statement, thread: ThreadCycle) -> None:
        self._state, self._line, self._thread = state, statement.line, thread
        self._rpm = state.compute_rpm_at(state.x)

    def generate_blocks(self) -> Iterator[Block]:
        thread = self._thread
        retract = thread.retract_x
        depths = compute_pass_depths(thread)
        for k, depth in enumerate(depths, start=1):
            z = compute_start_z(thread, depth)
            x = thread.start_x - thread.x_outward_sign * depth
            slope = thread.taper_mm / (thread.end_z - thread.start_z)
            if k > 1:
                yield from self._rapid(retract, z)
            yield from self._rapid(x + slope * (z - thread.start_z), z)
            end = x + thread.taper_mm
            yield self._cut(end, thread.end_z, f"({k}/{len(depths)})")
            if thread.has_pullout:
                yield self._cut(retract, thread.end_z + thread.z_cutting_sign * abs(retract - end), "P")
            else:
                yield from self._rapid(retract, thread.end_z)
        yield from self._rapid(retract, thread.start_z)
        yield from self._rapid(thread.start_x, thread.start_z)
        self._state.x, self._state.z = thread.start_x, thread.start_z

    def _rapid(self, x: float, z: float) -> Iterator[Block]:
        """Yield a rapid, unless the axes are already at the target."""
        if max(abs(x - self._state.x), abs(z - self._state.z)) > _FACE:
            yield self._block(x, z, BlockKind.RAPID, self._state.modal.rapid_rate, self._text("G00", x, z))

    def _cut(self, x: float, z: float, what: str) -> Block:
        lead = self._state.modal.format_feed(self._thread.lead_mm, is_per_rev=True).split()[0]
        text = f"{self._text('G33', x, z)}K{lead} {what}"
        return self._block(x, z, BlockKind.THREAD, self._thread.lead_mm, text)

    def _block(self, x: float, z: float, kind: BlockKind, feed: float, text: str) -> Block:
        state, per_rev = self._state, kind is BlockKind.THREAD
        start, state.x, state.z = (state.x, state.z, state.c), x, z
        return state.move(kind, self._line, text, start, feed, is_feed_per_rev=per_rev, rpm=self._rpm)

    def _text(self, code: str, x: float, z: float) -> str:
        """Return the motion as a program line, in the active unit and as radius or diameter."""
        state = self._state
        places = 4 if state.modal.metric else 5
        return f"{code}X{x / state.mm_per_x_unit + 0.0:.{places}f}Z{z / state.mm_per_z_unit + 0.0:.{places}f}"


def _warn(state: State, statement: Statement, thread: ThreadCycle) -> None:
    """Log a warning for a thread with too many passes or too short a run-up.

    The limit of passes is ``PASS_COUNT_WARNING_LIMIT``. The run-up is too short if Z cannot reach the
    threading feed within it.
    """
    if thread.pass_count > PASS_COUNT_WARNING_LIMIT:
        text = "The thread takes {passes} passes."
        hint = "Check I (a larger I gives fewer passes) and the X start position of the tool."
        state.log.add_warning(
            statement.line, statement.code_column, "thread-passes", text, hint, passes=thread.pass_count
        )
    speed = thread.lead_mm * abs(state.compute_rpm_at(state.x)) / 60
    needed = speed**2 / (2 * state.setup.limits.z_acceleration_mm_s2)
    run_up = _run_up(thread)
    if run_up < needed:
        state.log.add_warning(
            statement.line,
            statement.code_column,
            "thread-run-up",
            "The acceleration distance is {run_up}, but the Z axis needs {needed} to reach the threading "
            "feed rate.",
            "Start farther from the thread, or reduce S.",
            run_up=state.modal.format_length(max(run_up, 0.0)),
            needed=state.modal.format_length(needed),
        )


def _run_up(thread: ThreadCycle) -> float:
    """Return the run-up of the deepest pass in front of the part, in mm.

    If the pass crosses part zero, the run-up ends at part zero. Otherwise, the run-up is the whole pass,
    because the start of the part is unknown.
    """
    z = compute_start_z(thread, thread.depth_mm)
    if copysign(1.0, z) != copysign(1.0, thread.end_z) and thread.end_z != 0.0:
        return abs(z)
    return abs(thread.end_z - z)
