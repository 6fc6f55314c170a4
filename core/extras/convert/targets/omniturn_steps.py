"""Steps of an OmniTurn program, made from its elementary blocks.

Coordinates are relative to part zero of the tool, so that the work shift (G10) and the preset (G92) are
contained in them. All offsets D and all nose radii are zero. A program is interpreted with two sets of
assumed tool offsets and start positions; a step that differs between them is rejected.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest

from core.extras.convert.conversion_messages import make_error, make_note, make_warning
from core.extras.convert.path_steps import PathStep, SpindleState, StepKind, has_same_speed
from core.extras.convert.proof.conversion_proof import ReportLine, ignore_line
from core.extras.convert.source_options import ConversionOptions
from core.extras.convert.targets.source_comments import COMMENT, SourceComments
from core.extras.convert.targets.tapping_moves import find_tapping
from core.interpreter.dialects import interpret_program
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ControlLimits, InterpreterSetup, SecondaryOffset, ToolOffset
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.source import Dialect, ProgramSource

MAX_TOOL_NUMBER = 32
_NEAR = 1e-6  # mm
_OTHER_SIDE_MM = 1.0  # cuts to the spindle axis end at most this far beyond it
_MIN_RAPID_MM_S = 100.0 * 25.4 / 60.0  # slower moves without G00 may be cuts
_BLOCK_DELETE = re.compile(r"\s*/")
_AXIS_WORD = re.compile(r"[XZ](?=\s*[-+.\d(#])", re.IGNORECASE)
_MOVES = {
    BlockKind.RAPID: StepKind.RAPID,
    BlockKind.FEED: StepKind.FEED,
    BlockKind.ARC: StepKind.ARC,
    BlockKind.THREAD: StepKind.THREAD,
}
_C_AXIS = actions.SpindleLock | actions.SpindlePositioning
_SPINDLE_ACTIONS = actions.SpindleRun | actions.SpindleStop | actions.ProgramEnd
_INPUTS = actions.InputWait | actions.InputRead


@dataclass(frozen=True, slots=True)
class InterpretedProgram:
    """Elementary blocks of an OmniTurn program, their steps, and the findings about them.

    The coordinates of the blocks are relative to part zero of the tool. Without ``is_metric``, the program
    is in inches; ``is_diameter`` means that its X words are diameters.
    """

    blocks: Sequence[Block]
    steps: Sequence[PathStep]
    findings: Sequence[Diagnostic]
    is_metric: bool = False
    is_diameter: bool = True


def make_assumed_setup(limits: ControlLimits, variant: int) -> InterpreterSetup:
    """Return a setup with assumed tool offsets and an assumed start position, and with all offsets D zero.

    The offsets of all tools differ, and so do the distances between two tools in two variants. Their odd
    values keep a move after a tool change from ending where it starts.
    """
    numbers = range(1, MAX_TOOL_NUMBER + 1)
    distance_x, distance_z = 0.79193 + 0.13719 * variant, 1.11731 + 0.17093 * variant
    return InterpreterSetup(
        tools={
            number: ToolOffset(12.7 + distance_x * number, -76.2 - distance_z * number) for number in numbers
        },
        secondary=dict.fromkeys(numbers, SecondaryOffset()),
        limits=limits,
        start=(141.37139 + 7.10719 * variant, 263.91337 + 11.30191 * variant, 0.0),
    )


def interpret_source(
    texts: Sequence[str],
    options: ConversionOptions,
    limits: ControlLimits,
    report_line: ReportLine = ignore_line,
) -> InterpretedProgram:
    """Interpret an OmniTurn program and return its blocks and steps.

    The last finding is an error if the program has errors, if it cannot be written for another control, or
    if a step depends on the tool offsets of this lathe. ``report_line`` is called with the number of each
    line that is interpreted.
    """
    first = _interpret_variant(texts, options, limits, 0, lambda line: report_line(line // 2))
    second = _interpret_variant(texts, options, limits, 1, lambda line: report_line((len(texts) + line) // 2))
    if any(each.severity is Severity.ERROR for each in first.findings):
        return _find_dependent_preset(first, second) or first
    if any(each.severity is Severity.ERROR for each in second.findings):
        return _find_dependent_preset(first, second) or second
    return _find_dependent_preset(first, second) or _find_dependent_step(first, second) or first


def _interpret_variant(
    texts: Sequence[str],
    options: ConversionOptions,
    limits: ControlLimits,
    variant: int,
    report_line: ReportLine,
) -> InterpretedProgram:
    """Interpret a program with one variant of the assumed setup."""
    source = ProgramSource("source", "".join(f"{each}\n" for each in texts), Dialect.OMNITURN)
    done = interpret_program(source, make_assumed_setup(limits, variant))
    relative = []
    for block in done.generate_blocks():
        relative.append(_relative_to_part_zero(block))
        report_line(block.line)
    blocks = [replace(each, kind=BlockKind.FEED) if _is_slow_rapid(each) else each for each in relative]
    errors = [each for each in done.diagnostics if each.severity is Severity.ERROR]
    if errors:
        return InterpretedProgram(blocks, (), errors)
    comments = SourceComments(texts, sorted({each.line for each in blocks}))
    maker = StepMaker(texts, options, limits, comments)
    maker.findings += _find_slow_rapids(relative)
    try:
        for block in blocks:
            maker.append_block(block)
    except ProgramError as error:
        return InterpretedProgram(blocks, (), [*maker.findings, error.diagnostic])
    maker.report_far_side_tools()
    if line := find_tapping(maker.steps):
        maker.findings.append(make_warning(line, 0, "tapping"))
    first = next((each.modal for each in blocks if each.moves), None)
    if first is None:
        return InterpretedProgram((), (), [*maker.findings, make_error(0, 0, "file-empty").diagnostic])
    return InterpretedProgram(
        [part for each in blocks if not maker.is_left_out(each) for part in maker.add_implied_actions(each)],
        maker.steps,
        maker.findings,
        first.metric,
        first.diameter,
    )


def _find_dependent_preset(
    first: InterpretedProgram, second: InterpretedProgram
) -> InterpretedProgram | None:
    """Return the error of the first G92 whose shift depends on the tool offsets, or None."""
    for one, other in zip(first.blocks, second.blocks, strict=False):
        shift = one.modal.preset_x - other.modal.preset_x, one.modal.preset_z - other.modal.preset_z
        if isinstance(one.action, actions.Preset) and max(map(abs, shift)) > _NEAR:
            axis = "X" if abs(shift[0]) > _NEAR else "Z"
            error = make_error(one.line, 0, "preset-before-move", number=one.modal.tool, axis=axis)
            return InterpretedProgram((), (), [error.diagnostic])
    return None


def _find_dependent_step(first: InterpretedProgram, second: InterpretedProgram) -> InterpretedProgram | None:
    """Return the error of the first step that depends on the tool offsets, or None."""
    for one, other in zip_longest(first.steps, second.steps):
        step = one or other
        assert step is not None
        if one is None or other is None or not _is_same_step(one, other):
            error = make_error(step.line, 0, "offset-dependent")
            return InterpretedProgram((), (), [*first.findings, error.diagnostic])
    return None


def _is_same_step(one: PathStep, other: PathStep) -> bool:
    """Return whether two steps differ by no more than the precision of the calculation."""
    for name in ("x", "z", "cx", "cz", "feed"):
        values = getattr(one, name), getattr(other, name)
        if (values[0] is None) != (values[1] is None):
            return False
        if values[0] is not None and abs(values[0] - values[1]) > _NEAR:
            return False
    same = replace(other, x=one.x, z=one.z, cx=one.cx, cz=one.cz, feed=one.feed)
    return same == one


def _relative_to_part_zero(block: Block) -> Block:
    """Return the block with coordinates that contain the work shift and the preset."""
    modal = block.modal
    x, z = block.offset_x - modal.drawing_zero_x, block.offset_z - modal.drawing_zero_z
    if abs(x) < _NEAR and abs(z) < _NEAR:
        return block
    return replace(
        block, x0=block.x0 + x, x=block.x + x, cx=block.cx + x, z0=block.z0 + z, z=block.z + z,
        cz=block.cz + z, offset_x=modal.drawing_zero_x, offset_z=modal.drawing_zero_z,
    )  # fmt: skip


def _is_slow_rapid(block: Block) -> bool:
    """Return whether a block is a rapid without G00 that is slow enough to be a cut.

    Moves at the feed of the first line are rapids on this lathe. If this feed is low, they may be cuts,
    which would destroy the tool at the rapid rate of another lathe.
    """
    is_rapid = block.kind is BlockKind.RAPID and not block.modal.rapid
    return is_rapid and bool(block.modal.tool) and block.feed < _MIN_RAPID_MM_S


def _find_slow_rapids(blocks: Sequence[Block]) -> list[Diagnostic]:
    """Return a note for each rate of the slow rapids, at its first line."""
    first: dict[str, int] = {}
    for each in blocks:
        if _is_slow_rapid(each):
            first.setdefault(each.modal.format_feed(each.feed, is_per_rev=False), each.line)
    return [make_note(line, 0, "slow-rapid", rate=rate) for rate, line in first.items()]


@dataclass(slots=True)
class StepMaker:
    """Conversion of elementary blocks to steps, in program order.

    ``texts`` contains the lines of the program, and ``comments`` reads their comments.
    """

    texts: Sequence[str]
    options: ConversionOptions
    limits: ControlLimits
    comments: SourceComments
    steps: list[PathStep] = field(default_factory=list)
    findings: list[Diagnostic] = field(default_factory=list)
    tool_number: int = 0
    spindle: SpindleState = field(default_factory=SpindleState)
    nose_code: int = 40
    _is_tool_new: bool = False  # since a tool change and until the next move
    _unlimited_line: int = 0  # of a surface speed without G77, unless G77 follows before the next step
    _implied_actions: dict[int, Sequence[actions.Action]] = field(default_factory=dict)  # by number of block
    _reported: set[tuple[str, object]] = field(default_factory=set)
    _cut_range: dict[int, tuple[int, float, float]] = field(default_factory=dict)  # line, min X, max X

    def append_block(self, block: Block) -> None:
        """Append the steps of a block. Raises ProgramError if another control cannot execute it."""
        self._report_block_delete(block)
        if block.plane is not None or block.travel is not None or abs(block.c - block.c0) > _NEAR:
            raise make_error(block.line, 0, "c-axis-target")
        if not isinstance(block.action, _SPINDLE_ACTIONS) and not self.is_left_out(block):
            self._follow_maximum_speed(block)
        if block.action is None:
            self._append_move(block)
        else:
            if block.modal.compensation_code == 40:
                self._select_nose_code(block)
            self._append_action(block, block.action)

    def is_left_out(self, block: Block) -> bool:
        """Return whether the converted program has no step for the action of a block."""
        action = block.action
        if isinstance(action, actions.WorkShift | actions.CycleRepeatCancel):
            return True
        number = self._find_m_code(action)
        return number is not None and number in self.options.skipped_m_codes

    def add_implied_actions(self, block: Block) -> Sequence[Block]:
        """Return the block, preceded by blocks for the actions that the program does not contain as words."""
        implied = self._implied_actions.get(block.n, ())
        return *(replace(block, kind=BlockKind.ACTION, action=each) for each in implied), block

    def _append(self, step: PathStep) -> None:
        if self._unlimited_line:
            rpm = f"{self.limits.max_rpm:g}"
            self._warn_once("G77", self._unlimited_line, "maximum-speed-added", rpm=rpm)
            self._unlimited_line = 0
        self.steps.append(replace(step, comment=self.comments.remove_pending()))

    def _warn_once(self, key: object, line: int, code: str, /, **values: object) -> None:
        if (code, key) not in self._reported:
            self._reported.add((code, key))
            self.findings.append(make_warning(line, 0, code, **values))

    def _report_block_delete(self, block: Block) -> None:
        """Report the lines with a slash, whose comments were read for this block."""
        for number in self.comments.read_lines_before(block):
            text = self.texts[number - 1]
            if _BLOCK_DELETE.match(text):
                self._warn_once(number, number, "block-delete", word=text.strip())

    # --- moves

    def _append_move(self, block: Block) -> None:
        if block.kind not in _MOVES or block.growth:
            raise make_error(block.line, 0, "c-axis-target")
        if not block.modal.tool:
            self._append_home(block)
            return
        self._select_nose_code(block)
        self._report_offset(block)
        is_first, self._is_tool_new = self._is_tool_new, False
        if not is_first and block.kind is not BlockKind.ARC and block.x == block.x0 and block.z == block.z0:
            return
        if block.kind is BlockKind.RAPID:
            self._note_rapid_rate(block)
        else:
            line, low, high = self._cut_range.get(self.tool_number, (block.line, 0.0, -_OTHER_SIDE_MM))
            ends = block.x if is_first else block.x0, block.x
            self._cut_range[self.tool_number] = line, min(low, *ends), max(high, *ends)
        per_rev = block.per_rev or block.kind is BlockKind.THREAD
        self._append(
            PathStep(
                _MOVES[block.kind], block.line, block.x, block.z, block.cx, block.cz, block.clockwise,
                block.feed * (1 if per_rev else 60), per_rev,
            )
        )  # fmt: skip

    def _note_rapid_rate(self, block: Block) -> None:
        """Report each rapid rate of the program, which another control does not have as a word."""
        rate = block.modal.format_feed(block.feed, is_per_rev=False)
        if ("rapid-rate", rate) not in self._reported:
            self._reported.add(("rapid-rate", rate))
            self.findings.append(make_note(block.line, 0, "rapid-rate", rate=rate))

    def _append_home(self, block: Block) -> None:
        """Append a move to machine home of the axes that its line names.

        Raises ProgramError for another machine position.
        """
        words = {each.upper() for each in _AXIS_WORD.findall(COMMENT.sub("", self.texts[block.line - 1]))}
        x, z = "X" in words, "Z" in words
        is_home = (not x or abs(block.mx) < _NEAR) and (not z or abs(block.mz) < _NEAR)
        if is_home and words and block.kind is BlockKind.FEED:
            raise make_error(block.line, 0, "home-feed")
        if block.kind is not BlockKind.RAPID or not is_home or not words:
            raise make_error(block.line, 0, "machine-point")
        self._append(PathStep(StepKind.HOME, block.line, 0.0 if x else None, 0.0 if z else None))

    def _select_nose_code(self, block: Block) -> None:
        code = block.modal.compensation_code
        if code == self.nose_code:
            return
        self.nose_code = code
        self.steps.append(PathStep(StepKind.NOSE, block.line, number=code))
        if code != 40:
            self._warn_once(self.tool_number, block.line, "nose-table", number=self.tool_number)

    def _report_offset(self, block: Block) -> None:
        number = block.modal.secondary
        if number and block.modal.compensation_code == 40:
            key = (self.tool_number, number)
            self._warn_once(key, block.line, "secondary-offset", number=number, tool=self.tool_number)

    def report_far_side_tools(self) -> None:
        """Report the tools that cut only beyond the spindle axis, as on a gang-tool lathe."""
        for tool, (line, low, high) in self._cut_range.items():
            if low < -_OTHER_SIDE_MM and high <= _OTHER_SIDE_MM:
                self._warn_once(tool, line, "far-side-tool", number=tool)

    # --- actions

    def _append_action(self, block: Block, action: actions.Action) -> None:
        if isinstance(action, _C_AXIS):
            raise make_error(block.line, 0, "c-axis-target")
        if isinstance(action, _INPUTS):
            raise make_error(block.line, 0, "input-of-lathe")
        if isinstance(action, actions.ToolChange):
            self._change_tool(block, action.tool)
        elif isinstance(action, actions.SpindleRun | actions.SpindleStop):
            self._append_spindle(block)
        elif isinstance(action, actions.Preset | actions.WorkShift):
            note = make_note(block.line, 0, "shift-contained")
            self.findings += [] if note in self.findings else [note]
        elif isinstance(action, actions.CycleRepeatCancel):
            self.findings.append(make_warning(block.line, 0, "left-out", word="M31"))
        elif (step := _make_plain_step(block, action)) is not None:
            if step.kind is StepKind.END and step.number == 30:
                self._stop_before_end(block)
            self._append(step)
        else:
            self._leave_out_m_code(block, action)

    def _stop_before_end(self, block: Block) -> None:
        """Append the stops that M30 of this lathe contains, because another control may not have them."""
        implied: list[actions.Action] = []
        coolant = [each.number for each in self.steps if each.kind is StepKind.M and each.number in {8, 9}]
        if coolant and coolant[-1] == 8:
            implied.append(actions.CoolantSwitch(on=False))
            self._append(PathStep(StepKind.M, block.line, number=9))
        if self.spindle.direction:
            implied.append(actions.SpindleStop())
            self._append(PathStep(StepKind.SPINDLE, block.line))
        self._implied_actions[block.n] = implied

    def _find_m_code(self, action: actions.Action | None) -> int | None:
        """Return the M code of an action that only this lathe has, or None."""
        if isinstance(action, actions.ColletSwitch):
            return 12 if action.closed else 13
        if isinstance(action, actions.OutputSwitch):
            known = self.limits.m_code_outputs.items()
            return next((code for code, output in known if output == (action.name, action.on)), -1)
        return None

    def _leave_out_m_code(self, block: Block, action: actions.Action) -> None:
        """Report an M code of this lathe. Raises ProgramError unless the options omit the code."""
        number = self._find_m_code(action)
        word = f"M{number:02d}" if number is not None and number >= 0 else block.text.strip()
        if number not in self.options.skipped_m_codes:
            raise make_error(block.line, 0, "m-code-target", word=word, number=word.lstrip("M"))
        self.findings.append(make_warning(block.line, 0, "left-out", word=word))

    def _change_tool(self, block: Block, number: int) -> None:
        if not number or number == self.tool_number:
            return
        last = next((each.kind for each in reversed(self.steps) if each.kind in _PLACES), StepKind.HOME)
        if last is not StepKind.HOME:
            key = block.line, self.tool_number
            self._warn_once(key, block.line, "tool-change-place", number=number, before=self.tool_number)
        self.tool_number, self._is_tool_new = number, True
        self._append(PathStep(StepKind.TOOL, block.line, number=number))

    def _append_spindle(self, block: Block) -> None:
        spindle = self._read_spindle(block)
        if spindle.is_css and block.modal.min_css_rpm:
            rpm = f"{block.modal.min_css_rpm:g}"
            self._warn_once(rpm, block.line, "minimum-speed", word=f"G76S{rpm}")
        if spindle != self.spindle:
            is_new_limit = spindle.is_css and has_same_speed(spindle, self.spindle)
            self.spindle = spindle
            if is_new_limit and self.steps[-1].kind is StepKind.SPINDLE:
                self.steps[-1] = replace(self.steps[-1], spindle=spindle)
            else:
                self._append(PathStep(StepKind.SPINDLE, block.line, spindle=spindle))
        self._unlimited_line = block.line if spindle.is_css and block.modal.max_css_rpm is None else 0

    def _follow_maximum_speed(self, block: Block) -> None:
        """Append a spindle step if G77 or G97 without S has changed the state since the last spindle step.

        The comments stay with the next step, because they belong to the line of the block.
        """
        spindle = self._read_spindle(block)
        if self.spindle.is_css and spindle.max_rpm != self.spindle.max_rpm:
            comment = self.comments.remove_pending()
            self._append_spindle(block)
            self.comments.restore_pending(comment)
            if spindle.direction and not spindle.is_css:
                speed = block.modal.spindle * block.modal.rpm
                self._implied_actions[block.n] = (actions.SpindleRun(speed),)

    def _read_spindle(self, block: Block) -> SpindleState:
        modal = block.modal
        if isinstance(block.action, actions.SpindleStop) or not modal.spindle:
            return SpindleState()
        if not modal.css:
            return SpindleState(modal.spindle, modal.rpm)
        most = self.limits.max_rpm if modal.max_css_rpm is None else modal.max_css_rpm
        return SpindleState(modal.spindle, round(modal.surface_speed, 6), True, most)


def _make_plain_step(block: Block, action: actions.Action) -> PathStep | None:
    """Return the step of an action that every lathe has, or None for another action."""
    match action:
        case actions.Dwell(seconds):
            return PathStep(StepKind.DWELL, block.line, number=seconds)
        case actions.ProgramEnd(reset):
            return PathStep(StepKind.END, block.line, number=30 if reset else 2)
        case actions.ProgramStop():
            return PathStep(StepKind.M, block.line, number=1 if action.optional else 0)
        case actions.CoolantSwitch(on):
            return PathStep(StepKind.M, block.line, number=8 if on else 9)
    return None


_PLACES = frozenset({StepKind.HOME, *_MOVES.values()})
