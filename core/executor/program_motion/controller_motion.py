"""Motion by a controller with its own planner, which receives blocks just before it needs them.

The controller executes all blocks that it has received even if TurnDesk fails. Long blocks are therefore
sent in parts, each lasting a fraction of a second. The parts are on the same line or circle, so the
controller does not slow down between them.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from typing import NamedTuple

from core.block_ports import (
    ArcOperation,
    BlockController,
    BlockOperation,
    BlockState,
    LineOperation,
    RapidOperation,
    ThreadOperation,
)
from core.executor.job import ReadAheadQueue, compute_nominal_duration_s
from core.executor.machine_context import MachineContext
from core.executor.program_motion.path_section import OverrideFactors, SectionProgress
from core.executor.program_motion.standstill import StandstillWait, make_spindle_speed_wait
from core.executor.raised_alarm import AlarmError
from core.geometry.lines_and_arcs import compute_arc_sweep
from core.geometry.surface_speed import find_surface_rpm
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.message import Message
from core.motion.axis_limits import CENTRIPETAL_SHARE, MotionLimits

# --- elementary blocks in parts -------------------------------------------------------------------------


MAX_PART_DURATION_S = 0.2  # s, longest part at its programmed speed
_SHORTEST_PART = 0.05  # mm, shortest part at a slow feed
_MAX_ARC_SWEEP_RAD = 3.0  # radians
_CUT_AHEAD_S = 1.0  # s of motion prepared in parts
_MIN_OVERRIDE = 0.1  # lowest feed override assumed for the duration of the sent parts
_MAX_ABSENCE_S = 1.0  # s without a tick, after which the queue counts as run out
_CSS_DELAY_TICKS = 4  # ticks after which the spindle follows the displayed block
_POSITION_TOLERANCE_MM = 0.01  # mm; the controller reports thousandths


class BlockPart(NamedTuple):
    """A part of a block, as a controller operation with its minimum duration in seconds."""

    operation: BlockOperation
    block: Block
    min_duration_s: float


class SpindleSpeed(NamedTuple):
    """Spindle speed for feeds per revolution.

    It contains the ratio of the actual to the programmed speed, and the highest rpm.
    """

    speed_ratio: float
    max_rpm: float


def split_block(
    block: Block, spindle_speed: SpindleSpeed, find_max_speed: Callable[[Block], float] = lambda _: math.inf
) -> Iterator[BlockPart]:
    """Yield the parts of a block that moves axes.

    ``find_max_speed`` returns the speed limit of a block in mm/s. Raises AlarmError if the block has no
    feed rate or moves axes other than X and Z.
    """
    if block.travel is not None or block.plane is not None or block.c != block.c0:
        raise AlarmError("program", "this controller can move only X and Z", block.line)
    fastest = find_max_speed(block)
    seconds = max(compute_nominal_duration_s(block), block.length / fastest)
    if block.kind is BlockKind.THREAD:
        start = block.x0 + block.offset_x, block.z0 + block.offset_z
        yield BlockPart(ThreadOperation(*start, block.mx, block.mz, block.feed), block, seconds)
        return
    n = _count_parts(block, seconds)
    for i in range(n):
        op = _make_operation(block, i / n, (i + 1) / n, spindle_speed)
        yield BlockPart(_limit_operation_speed(op, fastest), block, seconds / n)


def _limit_operation_speed(
    op: RapidOperation | LineOperation | ArcOperation, fastest: float
) -> BlockOperation:
    """Return the operation with its speed limited to ``fastest``.

    The controller also applies its own speed limits, which may be higher.
    """
    if isinstance(op, RapidOperation):
        return op._replace(rapid_rate=min(op.rapid_rate, fastest))
    return op._replace(feed=min(op.feed, fastest))


def _count_parts(block: Block, seconds: float) -> int:
    """Return the number of parts into which a block is split.

    Each part of an arc is shorter than half a circle. The controller receives only the end points and the
    center, so it could not distinguish a full circle from a zero-length move.
    """
    least = math.ceil(abs(_sweep(block)[1]) / _MAX_ARC_SWEEP_RAD) if block.kind is BlockKind.ARC else 1
    return max(
        least, min(math.ceil(seconds / MAX_PART_DURATION_S - 1e-9), math.ceil(block.length / _SHORTEST_PART))
    )


def _make_operation(
    block: Block, begin: float, end: float, spindle_speed: SpindleSpeed
) -> RapidOperation | LineOperation | ArcOperation:
    """Return the operation for the part of a block between two fractions of its length."""
    if block.kind is BlockKind.ARC:
        return _arc(block, begin, end, spindle_speed)
    x, z = _on_line(block, end)
    if block.kind is BlockKind.RAPID:
        return RapidOperation(x, z, block.feed)
    return LineOperation(x, z, _feed_rate(block, x - block.offset_x, spindle_speed))


def _on_line(block: Block, part: float) -> tuple[float, float]:
    if part == 1.0:
        return block.mx, block.mz
    x = block.x0 + part * (block.x - block.x0)
    z = block.z0 + part * (block.z - block.z0)
    return x + block.offset_x, z + block.offset_z


def _arc(block: Block, begin: float, end: float, turning: SpindleSpeed) -> ArcOperation:
    (x0, z0), (x, z) = _point_on_arc(block, begin), _point_on_arc(block, end)
    cx, cz = block.cx + block.offset_x, block.cz + block.offset_z
    return ArcOperation(x0, z0, x, z, cx, cz, block.clockwise, _feed_rate(block, x - block.offset_x, turning))


def _point_on_arc(block: Block, part: float) -> tuple[float, float]:
    """Return the point of an arc at a fraction of its length.

    Both end points are exact, even if rounding in the program gives them slightly different radii.
    """
    if part == 0.0:
        return block.x0 + block.offset_x, block.z0 + block.offset_z
    if part == 1.0:
        return block.mx, block.mz
    start, sweep = _sweep(block)
    first = math.hypot(block.x0 - block.cx, block.z0 - block.cz)
    last = math.hypot(block.x - block.cx, block.z - block.cz)
    radius, angle = first + part * (last - first), start + part * sweep
    x, z = block.cx + radius * math.sin(angle), block.cz + radius * math.cos(angle)
    return x + block.offset_x, z + block.offset_z


def _sweep(block: Block) -> tuple[float, float]:
    return compute_arc_sweep(block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise)


def _feed_rate(block: Block, x: float, spindle_speed: SpindleSpeed) -> float:
    """Return the feed rate in mm/s. A feed per revolution follows the commanded spindle speed."""
    feed = block.feed
    if block.per_rev:
        rpm = abs(block.rpm)
        if block.css is not None:
            modal = block.modal
            rpm = find_surface_rpm(
                block.css, x, modal.min_css_rpm, modal.max_css_rpm or spindle_speed.max_rpm
            )
        feed *= min(rpm, spindle_speed.max_rpm) * spindle_speed.speed_ratio / 60.0
    if feed <= 0.0:
        raise AlarmError("program", Message("line {line} has no feed rate", line=block.line), block.line)
    return feed


class _SentPart(NamedTuple):
    ticket_number: int
    block_part: BlockPart


class _SurfaceSpeed(NamedTuple):
    """A surface speed in mm/s, with the direction of rotation and the lowest and highest spindle rpm."""

    surface_speed_mm_s: float
    is_forward: bool
    min_rpm: float
    max_rpm: float | None

    @classmethod
    def from_block(cls, block: Block) -> _SurfaceSpeed | None:
        """Return the surface speed of a block, or None if it has no surface speed or no spindle rpm."""
        if block.css is None or not block.rpm:
            return None
        return cls(block.css, block.rpm > 0.0, block.modal.min_css_rpm, block.modal.max_css_rpm)


class ControllerMotion:
    """Motion along a path section, executed by sending its blocks to the controller.

    Only the executor's thread uses it. Single block stops at the end of the last block that was sent to the
    controller, at most ``BlockController.max_queued_motion_s`` seconds later.
    """

    def __init__(self, context: MachineContext, controller: BlockController) -> None:
        self._context = context
        self._sink = controller
        machine = context.machine
        self._limits = MotionLimits.from_axes(
            machine.axes, machine.timing.setpoint_duration_s, machine.limits.corner_tolerance
        )
        self._waiting: deque[Block] = deque()  # blocks not yet divided into parts
        self._pieces: deque[BlockPart] = deque()  # parts not yet sent
        self._sent: deque[_SentPart] = deque()  # parts sent but not finished
        self._seconds = 0.0  # duration of the sent parts
        self._shown: Block | None = None
        self._overrides = OverrideFactors()
        self._last: int | None = None  # number of the block after which single block sends nothing
        self._thread = False
        self._still = False  # in hold because an override is 0
        # the thread that has lost its spindle, and the target of X
        self._lost: tuple[Block, float] | None = None
        self._laid: _SurfaceSpeed | None = None  # the surface speed for which the spindle is set up
        self._looks = 0  # ticks spent on the block for which it is set up
        self._speed: StandstillWait | None = None  # wait for the spindle before the next motion
        self._active = False
        self._seen = context.now  # time of the last tick of this motion
        self._dry = False  # a tick was too late, so the motion must not resume automatically

    # --- state --------------------------------------------------------------------------------------------

    @property
    def has_path_section(self) -> bool:
        """Return whether a path section is active."""
        return self._active

    @property
    def is_moving(self) -> bool:
        """Return whether any axis moves."""
        return self._active and self._is_moving(self._poll_controller())

    @property
    def current_block(self) -> Block | None:
        """Return the block being executed, or None if there is none."""
        self._poll_controller()
        return self._shown

    @property
    def following_block(self) -> Block | None:
        """Return the block after the one being executed, or None if it is not in the path section."""
        if self._shown is None:
            return None
        cut = [*(each.block_part.block for each in self._sent), *(each.block for each in self._pieces)]
        later = next((block for block in cut if block.n > self._shown.n), None)
        return later or (self._waiting[0] if self._waiting else None)

    @property
    def is_complete(self) -> bool:
        """Return whether all blocks of the path section have been executed."""
        return not (self._waiting or self._pieces or self._sent)

    @property
    def last_block(self) -> Block | None:
        """Return the block being executed, which at the end of the path section is its last block."""
        return self.current_block

    @property
    def starvation_time_s(self) -> float:
        """Return minus infinity if the executor paused too long to send blocks, otherwise infinity."""
        return -math.inf if self._dry else math.inf

    # --- requests -----------------------------------------------------------------------------------------

    def start_path_section(self, blocks: list[Block]) -> None:
        """Start a new path section from rest. Raises AlarmError or DriverError if the start fails."""
        self.clear_path_section()
        self._active, self._shown, self._seen = True, blocks[0], self._context.now
        self._thread = blocks[0].kind is BlockKind.THREAD
        self._waiting.extend(blocks)
        self._apply_overrides()
        self._hand_over()

    def resume(self, last_executed_block: Block | None) -> None:  # noqa: ARG002  it always continues where it rests
        """Resume from rest within the path section: end the feed hold, or send the next block."""
        self._last, self._dry, self._seen = None, False, self._context.now
        if not self._still:
            self._sink.resume()
        self._hand_over()

    def update_progress(self, read_ahead: ReadAheadQueue) -> SectionProgress:
        """Apply switches and overrides, send the permitted blocks and return the progress."""
        if not self._active:
            return SectionProgress.DONE
        self._apply_overrides()
        state = self._poll_controller()
        self._detect_absence()
        if not self._thread and read_ahead.pending_blocks and self._ready() < _CUT_AHEAD_S:
            self._waiting.extend(read_ahead.pop_pending_blocks())
        self._hand_over()
        if state.is_in_feed_hold and not self._still:
            return SectionProgress.IN_FEED_HOLD
        if self._is_moving(state):
            return SectionProgress.MOVING
        return SectionProgress.DONE if self.is_complete else self._resting()

    def extend_queue(self) -> None:
        """Send the remaining parts of a thread pass that is stopping, including its pull-out."""
        self._poll_controller()
        if self._thread:
            self._hand_over()

    def stop_on_path(self) -> None:
        """Stop on the path (feed hold). A threading pass is completed first."""
        if not self._thread:
            self._sink.stop_on_path()

    def stop_immediately(self) -> None:
        """Stop at once and discard the blocks in the controller."""
        self._empty()
        self._sink.abort_blocks()

    def discard_remaining_plan(self) -> None:
        """Do nothing, because the controller stops automatically after its last block."""

    def cancel_waiting_thread_pass(self) -> bool:
        """Return False, because only the controller knows whether a thread pass is still waiting."""
        return False

    def start_retract(self, block: Block) -> None:
        """Stop a thread pass that has lost spindle synchronization, so that X can be retracted."""
        left = [*(each.block_part.block for each in self._sent), *(each.block for each in self._pieces)]
        self._lost = block, [block, *left, *self._waiting][-1].mx
        self.stop_immediately()

    def continue_retract(self) -> None:
        """Retract X from rest, and raise AlarmError("thread-lost") when the tool is clear of the thread.

        The alarm is also raised, without a retract, if the controller cannot start a block.
        """
        assert self._lost is not None
        block, out = self._lost
        x, z = self._context.axis_sample.actual[:2]
        if abs(x - out) < _POSITION_TOLERANCE_MM or self._sink.state().start_refusal_reason:
            raise AlarmError("thread-lost", line=block.line)
        self._pieces.append(BlockPart(RapidOperation(out, z, block.modal.rapid_rate), block, 0.0))
        self._hand_over()

    def clear_path_section(self) -> None:
        """Clear the path section here and in the controller."""
        self._poll_controller()
        if self._sent:
            self._sink.abort_blocks()
        self._empty()
        self._shown = self._last = self._lost = None
        self._thread = self._active = False

    # --- internal methods ---------------------------------------------------------------------------------

    def _empty(self) -> None:
        self._waiting.clear()
        self._pieces.clear()
        self._sent.clear()
        self._seconds, self._still, self._dry, self._laid, self._speed = 0.0, False, False, None, None

    def _poll_controller(self) -> BlockState:
        """Return the state of the controller, and remove the blocks that the controller has completed."""
        state = self._sink.state()
        while self._sent and self._sent[0].ticket_number <= state.last_completed_ticket:
            done = self._sent.popleft().block_part
            self._shown, self._seconds = done.block, self._seconds - done.min_duration_s
        if self._sent:
            self._shown = self._sent[0].block_part.block
        return state

    def _is_moving(self, state: BlockState) -> bool:
        """Return whether the axes move.

        A controller in feed hold does not move although it has blocks.
        """
        return not state.is_in_feed_hold and (bool(self._sent) or not state.is_at_rest)

    def _detect_absence(self) -> None:
        """Detect that the executor paused for longer than the motion that it had sent ahead.

        In this case, the motion does not resume automatically.
        """
        away, self._seen = self._context.now - self._seen, self._context.now
        self._dry = self._dry or (away > _MAX_ABSENCE_S and bool(self._pieces or self._waiting))

    def _resting(self) -> SectionProgress:
        if self._still:
            return SectionProgress.AT_REST
        stepped = self._context.switches.single_block and self._last is not None
        return SectionProgress.BLOCK_END if stepped else SectionProgress.MOVING

    def _apply_overrides(self) -> None:
        """Apply the overrides. At an override of 0 the controller is in feed hold, except in a thread."""
        feed = self._context.feed_override
        turn = round(self._context.spindle.override, 2)
        self._overrides = OverrideFactors(feed, min(feed, 1.0), turn)
        if feed and turn:
            self._sink.set_overrides(feed, min(feed, 1.0))
            if self._still:
                self._still = False
                self._sink.resume()
        elif not self._still and not self._thread:
            self._still = True
            self._sink.stop_on_path()

    @property
    def _cut_ahead(self) -> float:
        return sum(piece.min_duration_s for piece in self._pieces)

    def _ready(self) -> float:
        return self._cut_ahead + (_CUT_AHEAD_S if self._waiting else 0.0)

    def _max_rpm(self) -> float:
        """Return the highest rpm that the spindle can reach, which limits feeds per revolution."""
        reach = self._sink.css_max_rpm if self._laid is not None else math.inf
        return min(self._context.spindle.max_rpm, reach)

    def _prepare_css(self, block: Block) -> bool:
        """Return whether the spindle can maintain constant surface speed in this block.

        If the speed steps of a spindle depend on its last S word, the spindle is prepared at rest for each
        surface speed. It must then reach its speed before any axis moves.
        """
        surface = _SurfaceSpeed.from_block(block)
        if surface is None or surface == self._laid or math.isinf(self._sink.css_max_rpm):
            self._laid, self._speed = surface, None
            return True
        if self._sent or self._pieces or not self._sink.state().is_at_rest:
            return False
        if self._shown is not block or self._speed is None:
            self._shown, self._looks = block, 0  # the spindle follows the displayed block
            self._speed = make_spindle_speed_wait(self._context)
        self._looks += 1
        turns = self._speed.is_over(self._context.now)
        if self._looks < _CSS_DELAY_TICKS or not self._sink.css_max_rpm or not turns:
            return False
        self._laid, self._speed = surface, None
        return True

    def _hand_over(self) -> None:
        while self._waiting and self._cut_ahead < _CUT_AHEAD_S and self._prepare_css(self._waiting[0]):
            turning = SpindleSpeed(self._overrides.spindle_factor, self._max_rpm())
            self._pieces.extend(split_block(self._waiting.popleft(), turning, self._max_block_speed))
        while self._pieces and self._may_send(self._pieces[0]):
            ticket = self._sink.submit_block(self._pieces[0].operation)
            if ticket is None:
                return
            piece = self._pieces.popleft()
            self._sent.append(_SentPart(ticket, piece))
            self._seconds += piece.min_duration_s

    def _max_block_speed(self, block: Block) -> float:
        """Return the highest speed of a block in mm/s.

        On a line, each axis has its own limit, as in the motion planner. On an arc, both the speed and the
        acceleration limits of the slower axis apply.
        """
        if block.kind is not BlockKind.ARC:
            return self._sink.get_max_directional_speed(block.x - block.x0, block.z - block.z0)
        around = (
            CENTRIPETAL_SHARE
            * self._limits.max_plane_acceleration
            * math.hypot(block.x - block.cx, block.z - block.cz)
        )
        return min(
            self._sink.get_max_directional_speed(1.0, 0.0),
            self._sink.get_max_directional_speed(0.0, 1.0),
            math.sqrt(around),
        )

    def _may_send(self, piece: BlockPart) -> bool:
        """Return whether a part of a block may be sent to the controller now.

        Single block limits the number of parts. In addition, the controller must not receive more motion
        than it may execute without TurnDesk.
        """
        if self._still or self._dry or not self._single(piece.block):
            return False
        if self._thread or not self._sent:
            return True
        slow = max(min(self._overrides.feed_factor, 1.0), _MIN_OVERRIDE)
        return (
            self._seconds - self._sent[0].block_part.min_duration_s
        ) / slow < self._sink.max_queued_motion_s

    def _single(self, block: Block) -> bool:
        if not self._context.switches.single_block or self._thread:
            self._last = None
            return True
        if self._last is None:
            self._last = self._sent[-1].block_part.block.n if self._sent else block.n
        return block.n <= self._last
