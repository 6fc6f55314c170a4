"""Proof of a conversion by comparing the blocks of the converted program with the steps of the source."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import MOVE_KINDS, PathStep, StepKind
from core.extras.convert.proof.compared_steps import drop_idle, drop_repeated_speeds, select_compared_steps
from core.interpreter.dialects import interpret_program
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ControlLimits, InterpreterSetup, SecondaryOffset, ToolOffset
from core.interpreter.shared.units import get_surface_speed_unit
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, ProgramSource

EQUAL_TOLERANCE_MM = 1e-6 * 25.4  # mm
OMNITURN_RESOLUTION_MM = (0.00005 * 25.4, 0.0001)  # of OmniTurn in inches and in mm, of the radius and of Z
SPEED_RESOLUTION = 0.001  # of a written S in rpm, ft/min or m/min
_FIXED_POINT = (137.31719, 411.91337)  # mm; machine X as a radius, and machine Z
_NEAR_DWELL = 0.0005 + 1e-9  # s; half the resolution of a written dwell
_CLEARANCE = 0.0002 * 25.4  # mm; retract of a thread pass
_KINDS = {
    StepKind.RAPID: BlockKind.RAPID,
    StepKind.FEED: BlockKind.FEED,
    StepKind.ARC: BlockKind.ARC,
    StepKind.THREAD: BlockKind.THREAD,
}


ReportLine = Callable[[int], None]
"""Function that is called with the number of a source line when this line is proved."""


def ignore_line(_line: int) -> None:
    """Do nothing with the number of a proved line."""


@dataclass(frozen=True, slots=True)
class Proof:
    """Result of the proof of a conversion: the differences, and the number of compared steps.

    ``rounded_move_count`` is the number of moves with an end point that is rounded to the resolution of the
    control. ``max_rounding_mm`` is the largest such change in mm.
    """

    errors: tuple[Diagnostic, ...] = ()
    compared_step_count: int = 0
    rounded_move_count: int = 0
    max_rounding_mm: float = 0.0


def prove(
    text: str,
    source_line_numbers: Sequence[int],
    steps: Sequence[PathStep],
    limits: ControlLimits,
    *,
    is_metric: bool,
    dialect: Dialect = Dialect.OMNITURN,
    resolution_mm: float = 0.0,
    has_block_delete: bool = False,
    report_line: ReportLine = ignore_line,
) -> Proof:
    """Interpret the converted program and compare it with the steps of the source.

    ``source_line_numbers`` contains the source line of each line of ``text``. ``resolution_mm`` is the
    resolution of the coordinates; 0 means the resolution of OmniTurn. If ``has_block_delete`` is True, lines
    that begin with / are skipped. ``report_line`` is called with the source line of each interpreted block.
    """
    # Fixed point 1 replaces machine home; its odd values differ from any programmed position.
    home = _FIXED_POINT if dialect is Dialect.SINUMERIK else (0.0, 0.0)
    points = {axis: (value,) for axis, value in zip("XZ", home, strict=True)}
    limits = replace(limits, fixed_points=points)
    # All offsets differ, so that a move after a tool change moves both axes.
    tools = {number: ToolOffset(12.7 + 0.1 * number, -76.2 - 0.1 * number) for number in range(1, 33)}
    nose = dict.fromkeys(range(1, 33), SecondaryOffset())
    done = interpret_program(
        ProgramSource("converted", text, dialect),
        InterpreterSetup(tools=tools, secondary=nose, limits=limits, block_delete=has_block_delete),
    )
    blocks = []
    for block in done.generate_blocks():
        blocks.append(block)
        report_line(source_line_numbers[block.line - 1])
    errors = [each for each in done.diagnostics if each.severity is Severity.ERROR]
    if errors:
        return Proof(tuple(make_target_error(each, text, source_line_numbers) for each in errors))
    if dialect is Dialect.SINUMERIK:
        different = _find_nose_difference(blocks, steps)
        if different is not None:
            return Proof((different,))
    comparison = PathComparison(
        drop_repeated_speeds(blocks), steps, metric=is_metric,
        resolution_mm=resolution_mm or OMNITURN_RESOLUTION_MM[is_metric],
        has_thread_cycles=dialect is Dialect.OMNITURN, home=home,
    )  # fmt: skip
    return comparison.compare_steps()


def _find_nose_difference(blocks: Sequence[Block], steps: Sequence[PathStep]) -> Diagnostic | None:
    """Return the first difference between the nose compensation of the moves of a SINUMERIK program.

    The steps see X+ toward the operator, so that left and right are exchanged. The move that ends the
    compensation contains G40.
    """
    wanted: list[tuple[int, int]] = []
    code, has_tool = 40, False
    for step in steps:
        has_tool = has_tool or step.kind is StepKind.TOOL
        if step.kind is StepKind.NOSE:
            code = 40 if step.number == 40 else 83 - round(step.number)
            if code == 40 and wanted:
                wanted[-1] = wanted[-1][0], 40
        elif step.kind in MOVE_KINDS and has_tool:
            wanted.append((step.line, code))
    made = [
        each.modal.compensation_code
        for each in drop_idle(blocks, has_home_moves=False)
        if each.moves and each.modal.edge
    ]
    for (line, want), found in zip(wanted, made, strict=False):
        if want != found:
            error = make_error(
                line, 0, "proof-differs", what="the nose compensation", made=f"G{found}", wanted=f"G{want}"
            )
            return error.diagnostic
    return None


def make_target_error(found: Diagnostic, text: str, sources: Sequence[int]) -> Diagnostic:
    """Convert a finding about the converted program to a finding about the corresponding source line."""
    line = sources[found.line - 1] if found.line else 0
    made = text.splitlines()[found.line - 1] if found.line else ""
    error = make_error(line, 0, "target", made=made, message=found.message, hint=found.hint)
    return replace(error.diagnostic, hint=found.hint)


class _DifferenceError(Exception):
    """An error raised at the first difference between a converted program and its source."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class PathComparison:
    """Comparison of elementary blocks with the steps of another program, in program order.

    Usually, the blocks belong to the converted program and the steps to the source. With
    ``has_source_blocks``, the blocks belong to the source. ``resolution_mm`` is the resolution to which the
    control rounds coordinates. ``has_thread_cycles`` means that the rapids around a thread pass are those
    of a cycle, so that they are compared only within the retract of the cycle. ``home`` is the machine
    position to which the blocks move for machine home. ``feed_resolution_mm`` is the resolution to which
    the control rounds feeds and leads, and ``speed_resolution`` that of S.
    """

    def __init__(
        self,
        blocks: Sequence[Block],
        steps: Sequence[PathStep],
        *,
        metric: bool,
        resolution_mm: float,
        has_source_blocks: bool = False,
        has_thread_cycles: bool = True,
        home: tuple[float, float] = (0.0, 0.0),
        feed_resolution_mm: float = 0.0,
        speed_resolution: float = SPEED_RESOLUTION,
    ) -> None:
        self._blocks = drop_idle(blocks, has_home_moves=not has_thread_cycles)
        self._has_source_blocks, self._has_thread_cycles = has_source_blocks, has_thread_cycles
        self._metric = metric
        self._home_point = home
        self._resolution, self._near_feed = resolution_mm, feed_resolution_mm / 2
        self._near_speed = speed_resolution / 2
        self._steps = list(select_compared_steps(steps, has_partial_moves=not has_thread_cycles))
        self._at = 0
        self._tool = 0
        self._is_tool_new = False
        self._rounded = 0
        self._most = 0.0
        self._near = EQUAL_TOLERANCE_MM + resolution_mm / 2

    def compare_steps(self) -> Proof:
        """Return the result of the comparison, with the first difference as an error."""
        try:
            compared = self._compare()
        except _DifferenceError as found:
            return Proof((found.diagnostic,))
        return Proof((), compared, self._rounded, self._most)

    def _compare(self) -> int:
        compared = 0
        steps = self._steps
        at = 0
        while at < len(steps):
            step = steps[at]
            if step.kind is StepKind.TOOL:
                self._tool, self._is_tool_new = round(step.number), True
                at += 1
                continue
            count = self._thread_zone(at)
            if count:
                compared += count
                at += count
                continue
            self._one(step)
            compared += 1
            at += 1
        if self._at < len(self._blocks):
            self._differs(steps[-1].line if steps else 0, "proof-length", len(self._blocks), self._at)
        return compared

    def _next(self, step: PathStep) -> Block:
        if self._at >= len(self._blocks):
            self._differs(step.line, "proof-length", len(self._blocks), len(self._steps))
        self._at += 1
        return self._blocks[self._at - 1]

    def _differs(self, line: int, code: str, made: object, wanted: object, what: str = "") -> None:
        if self._has_source_blocks:
            made, wanted = wanted, made
        raise _DifferenceError(make_error(line, 0, code, made=made, wanted=wanted, what=what).diagnostic)

    def _same(self, step: PathStep, what: str, made: float, wanted: float, near: float) -> None:
        if abs(made - wanted) > near:
            self._differs(step.line, "proof-differs", f"{made:.6f}", f"{wanted:.6f}", what)
        if what in {"X", "Z"} and abs(made - wanted) > EQUAL_TOLERANCE_MM:
            self._rounded += 1
            self._most = max(self._most, abs(made - wanted))

    # --- one step

    def _one(self, step: PathStep) -> None:
        if step.kind is StepKind.HOME:
            self._home(step)
            return
        block = self._next(step)
        if step.kind in MOVE_KINDS:
            self._move(step, block)
        elif block.action is None:
            self._differs(step.line, "proof-differs", block.kind, step.kind, "the step")
        else:
            self._action(step, block, block.action)

    def _home(self, step: PathStep) -> None:
        """Compare a move to machine home.

        The converted program may omit this block if the axes are already at home.
        """
        at = self._at
        if not self._has_thread_cycles:
            self._compare_home(step)
        elif (
            at < len(self._blocks)
            and self._blocks[at].kind is BlockKind.RAPID
            and not self._blocks[at].modal.tool
        ):
            block = self._next(step)
            if step.x is not None:
                self._same(step, "machine X", block.mx, 0.0, EQUAL_TOLERANCE_MM)
            if step.z is not None:
                self._same(step, "machine Z", block.mz, 0.0, EQUAL_TOLERANCE_MM)

    def _compare_home(self, step: PathStep) -> None:
        """Compare a move to machine home: the named axes move there, and the others stay."""
        block = self._next(step)
        if block.kind is not BlockKind.RAPID or (block.modal.tool and block.modal.edge != 0):
            self._differs(step.line, "proof-differs", block.kind, "home", "the kind of move")
        axes = (
            ("machine X", step.x, block.machine_end[0], self._home_point[0], block.x - block.x0),
            ("machine Z", step.z, block.machine_end[1], self._home_point[1], block.z - block.z0),
        )
        for name, wanted, end, home, travel in axes:
            if wanted is None:
                self._same(step, name, travel, 0.0, EQUAL_TOLERANCE_MM)
            else:
                self._same(step, name, end, home, EQUAL_TOLERANCE_MM)

    def _move(self, step: PathStep, block: Block) -> None:
        if block.kind is not _KINDS[step.kind]:
            self._differs(step.line, "proof-differs", block.kind, step.kind, "the kind of move")
        if block.modal.tool != self._tool:
            self._differs(step.line, "proof-differs", block.modal.tool, self._tool, "T")
        self._check_first_move(step)
        for axis, made, wanted in (("X", block.x, step.x), ("Z", block.z, step.z)):
            if wanted is not None:
                self._same(step, axis, made, wanted, self._near)
        if step.kind is StepKind.RAPID:
            return
        if step.kind is StepKind.ARC:
            self._same(step, "the center in X", block.cx, step.cx, 3 * self._near)
            self._same(step, "the center in Z", block.cz, step.cz, 3 * self._near)
            if block.clockwise != step.clockwise:
                self._differs(step.line, "proof-differs", block.clockwise, step.clockwise, "clockwise")
        if step.kind is StepKind.THREAD:
            # The lead of a taper depends on its rounded end points.
            rounding = 2 * self._near / max(abs(block.z - block.z0), self._near)
            near = 1e-6 + (block.feed * rounding if block.x != block.x0 else 0.0)
            near += self._find_lead_tolerance(block)
            self._same(step, "the lead", block.feed, step.feed, near)
            return
        if block.per_rev != step.per_rev:
            self._differs(step.line, "proof-differs", block.per_rev, step.per_rev, "feed per revolution")
        made = block.feed * (1 if step.per_rev else 60)
        self._same(step, "the feed", made, step.feed, 1e-6 * step.feed + 1e-6 + self._near_feed)

    def _find_lead_tolerance(self, block: Block) -> float:
        """Return how far the rounding of F may change the lead of a thread.

        The end of the thread must not move by more than the resolution of the coordinates.
        """
        length = max(abs(block.x - block.x0), abs(block.z - block.z0), self._near)
        return min(self._near_feed, self._resolution * block.feed / length)

    def _check_first_move(self, step: PathStep) -> None:
        """Check that the first move after a tool change in the written program has both axes."""
        if self._is_tool_new and self._has_source_blocks and None in {step.x, step.z}:
            self._differs(step.line, "proof-differs", "one", "two", "the number of axes after a tool change")
        self._is_tool_new = False

    def _action(self, step: PathStep, block: Block, action: actions.Action) -> None:
        wanted = _action_of(step)
        if isinstance(action, actions.SpindleRun) and isinstance(wanted, actions.SpindleRun):
            self._spindle(step, action, wanted)
            limit = step.spindle.max_rpm
            if action.surface_speed is not None and limit and not self._has_source_blocks:
                self._same(step, "the maximum spindle speed", block.modal.max_css_rpm or 0.0, limit, 1e-3)
            return
        if isinstance(action, actions.Dwell) and isinstance(wanted, actions.Dwell):
            self._same(step, "the dwell", action.seconds, wanted.seconds, _NEAR_DWELL)
            return
        if isinstance(action, actions.ProgramStop):
            action = actions.ProgramStop(action.optional)
        # The machine file defines the outputs of other M codes, and the interpreter applies it.
        if action != wanted and not (isinstance(action, actions.OutputSwitch) and step.kind is StepKind.M):
            self._differs(step.line, "proof-differs", action, wanted, "the step")

    def _spindle(self, step: PathStep, made: actions.SpindleRun, wanted: actions.SpindleRun) -> None:
        """Compare the spindle speeds.

        With constant surface speed, the rpm of a block depends on its position, so the surface speeds are
        compared. Without a speed, the step retains the present one.
        """
        if step.spindle.direction and not step.spindle.speed and made.surface_speed is None:
            if made.rpm * step.spindle.direction <= 0:
                self._differs(step.line, "proof-differs", made, wanted, "the spindle")
            return
        css = made.surface_speed is not None
        if css != (wanted.surface_speed is not None) or (made.rpm > 0) != (wanted.rpm > 0):
            self._differs(step.line, "proof-differs", made, wanted, "the spindle")
        speeds = (made.surface_speed, wanted.surface_speed) if css else (made.rpm, wanted.rpm)
        unit = get_surface_speed_unit(is_metric=self._metric) if css else 1.0
        near = self._near_speed * unit + 1e-3
        self._same(step, "the spindle speed", speeds[0] or 0.0, speeds[1] or 0.0, near)

    # --- threads

    def _thread_zone(self, at: int) -> int:
        """Compare a thread pass and the rapids before and after it; return the number of steps compared.

        The number is 0 if the next step does not belong to a thread of a cycle.
        """
        if not self._has_thread_cycles:
            return 0
        steps, blocks = self._steps, self._blocks
        infeed = at
        while infeed < len(steps) and steps[infeed].kind is StepKind.RAPID:
            infeed += 1
        if infeed == len(steps) or steps[infeed].kind is not StepKind.THREAD:
            return 0
        end = infeed
        while end < len(steps) and steps[end].kind in {StepKind.RAPID, StepKind.THREAD}:
            end += 1
        last = self._at
        while (
            last < len(blocks)
            and blocks[last].kind in {BlockKind.RAPID, BlockKind.THREAD}
            and blocks[last].modal.tool == self._tool
        ):
            last += 1
        self._zone(steps[at:end], blocks[self._at : last])
        self._at = last
        return end - at

    def _zone(self, steps: Sequence[PathStep], blocks: Sequence[Block]) -> None:
        """Compare the steps and blocks of a thread.

        Thread cuts are compared exactly. Rapids may differ as far as the retract of the threading cycle
        permits.
        """
        made = iter(blocks)
        for step in steps:
            for block in made:
                if step.kind is StepKind.THREAD and block.kind is BlockKind.THREAD:
                    self._move(step, block)
                    break
                if (
                    step.kind is StepKind.RAPID
                    and block.kind is BlockKind.RAPID
                    and self._is_near(step, block)
                ):
                    break
                if block.kind is BlockKind.THREAD:
                    self._differs(step.line, "proof-differs", "thread", step.kind, "the kind of move")
            else:
                self._differs(step.line, "proof-length", len(blocks), len(steps))

    def _is_near(self, step: PathStep, block: Block) -> bool:
        assert step.x is not None
        assert step.z is not None
        return abs(block.x - step.x) <= _CLEARANCE and abs(block.z - step.z) <= self._near


def _action_of(step: PathStep) -> actions.Action | None:
    """Return the block action that corresponds to a step, or None if no action corresponds to it."""
    if step.kind is StepKind.SPINDLE:
        return _spindle_of(step)
    if step.kind is StepKind.DWELL:
        return actions.Dwell(step.number)
    if step.kind is StepKind.END:
        return actions.ProgramEnd(reset=step.number == 30)
    return _M_ACTIONS.get(round(step.number)) if step.kind is StepKind.M else None


def _spindle_of(step: PathStep) -> actions.Action:
    spindle = step.spindle
    if not spindle.direction:
        return actions.SpindleStop()
    if spindle.is_css:
        return actions.SpindleRun(float(spindle.direction), spindle.speed)
    return actions.SpindleRun(spindle.direction * spindle.speed)


_M_ACTIONS: Mapping[int, actions.Action] = {
    0: actions.ProgramStop(optional=False),
    1: actions.ProgramStop(optional=True),
    8: actions.CoolantSwitch(on=True),
    9: actions.CoolantSwitch(on=False),
    12: actions.ColletSwitch(closed=True),
    13: actions.ColletSwitch(closed=False),
}
