"""Motion by a controller with its own planner, which receives as few blocks ahead as possible.

The controller executes the blocks that it has received even if the host fails. A long block is therefore sent
in parts of a fraction of a second. The parts are on the same line or circle, so the controller does not slow
down between them.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from typing import NamedTuple

from core.executor.job import ReadAhead, nominal_seconds
from core.executor.machine_context import MachineContext
from core.executor.program_motion.path_section import Overrides, Progress
from core.executor.program_motion.standstill import Wait, at_speed
from core.executor.raised_alarm import AlarmError
from core.geometry.lines_and_arcs import arc_sweep
from core.geometry.surface_speed import surface_rpm
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.message import Message
from core.motion.axis_limits import CENTRIPETAL_SHARE, MotionLimits
from core.ports import ArcOp, BlockOp, BlockSink, BlockState, LineOp, RapidOp, ThreadOp

# --- elementary blocks in parts -------------------------------------------------------------------------


LONGEST = 0.2  # s, longest part at its programmed speed
_SHORTEST_PART = 0.05  # mm, shortest part at a slow feed
_WIDEST = 3.0  # radians
_CUT = 1.0  # s of motion prepared in parts
_SLOWEST = 0.1  # lowest feed override assumed for the duration of the sent parts
_AWAY = 1.0  # s without a tick, after which the queue counts as run out
_SEEN = 4  # ticks after which the spindle follows the displayed block
_NEAR = 0.01  # mm; the controller reports thousandths


class BlockPart(NamedTuple):
    """A part of a block as a controller operation, with the block and the shortest time in seconds."""

    op: BlockOp
    block: Block
    seconds: float


class Turning(NamedTuple):
    """The spindle speed for feeds per revolution: actual over programmed speed, and the highest rpm."""

    scale: float
    highest: float


def parts_of(
    block: Block, turning: Turning, most: Callable[[Block], float] = lambda _: math.inf
) -> Iterator[BlockPart]:
    """Yield the parts of one moving block, limited to the speed ``most`` (mm/s).

    Raises AlarmError if the block has no feed rate or moves other axes than X and Z.
    """
    if block.travel is not None or block.plane is not None or block.c != block.c0:
        raise AlarmError("program", "this controller can move only X and Z", block.line)
    fastest = most(block)
    seconds = max(nominal_seconds(block), block.length / fastest)
    if block.kind is Kind.THREAD:
        start = block.x0 + block.offset_x, block.z0 + block.offset_z
        yield BlockPart(ThreadOp(*start, block.mx, block.mz, block.feed), block, seconds)
        return
    n = _cuts(block, seconds)
    for i in range(n):
        op = _op(block, i / n, (i + 1) / n, turning)
        yield BlockPart(_no_faster(op, fastest), block, seconds / n)


def _no_faster(op: RapidOp | LineOp | ArcOp, fastest: float) -> BlockOp:
    """Limit the speed of an operation, because the controller's own limits may be higher."""
    if isinstance(op, RapidOp):
        return op._replace(rate=min(op.rate, fastest))
    return op._replace(feed=min(op.feed, fastest))


def _cuts(block: Block, seconds: float) -> int:
    """Return the number of parts. The parts of an arc are shorter than half a circle.

    The controller receives only end points and the center, which do not distinguish a full circle from a zero
    move.
    """
    least = math.ceil(abs(_sweep(block)[1]) / _WIDEST) if block.kind is Kind.ARC else 1
    return max(least, min(math.ceil(seconds / LONGEST - 1e-9), math.ceil(block.length / _SHORTEST_PART)))


def _op(block: Block, begin: float, end: float, turning: Turning) -> RapidOp | LineOp | ArcOp:
    """Return the operation for the part of a block between two fractions of its length."""
    if block.kind is Kind.ARC:
        return _arc(block, begin, end, turning)
    x, z = _on_line(block, end)
    if block.kind is Kind.RAPID:
        return RapidOp(x, z, block.feed)
    return LineOp(x, z, _feed_rate(block, x - block.offset_x, turning))


def _on_line(block: Block, part: float) -> tuple[float, float]:
    if part == 1.0:
        return block.mx, block.mz
    x = block.x0 + part * (block.x - block.x0)
    z = block.z0 + part * (block.z - block.z0)
    return x + block.offset_x, z + block.offset_z


def _arc(block: Block, begin: float, end: float, turning: Turning) -> ArcOp:
    (x0, z0), (x, z) = _on_circle(block, begin), _on_circle(block, end)
    cx, cz = block.cx + block.offset_x, block.cz + block.offset_z
    return ArcOp(x0, z0, x, z, cx, cz, block.clockwise, _feed_rate(block, x - block.offset_x, turning))


def _on_circle(block: Block, part: float) -> tuple[float, float]:
    """Return the point of an arc at a fraction of its length.

    Both ends are exact, even if the rounded program gives them slightly different radii.
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
    return arc_sweep(block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise)


def _feed_rate(block: Block, x: float, turning: Turning) -> float:
    """Return the feed rate in mm/s. A feed per revolution follows the commanded spindle speed."""
    feed = block.feed
    if block.per_rev:
        rpm = abs(block.rpm)
        if block.css is not None:
            modal = block.modal
            rpm = surface_rpm(block.css, x, modal.css_min, modal.css_max or turning.highest)
        feed *= min(rpm, turning.highest) * turning.scale / 60.0
    if feed <= 0.0:
        raise AlarmError("program", Message("line {line} has no feed rate", line=block.line), block.line)
    return feed


class _Sent(NamedTuple):
    ticket: int
    piece: BlockPart


class _Surface(NamedTuple):
    """A surface speed in mm/s with its direction of rotation and rpm limits."""

    speed: float
    forward: bool
    lowest: float
    highest: float | None

    @classmethod
    def of(cls, block: Block) -> _Surface | None:
        """Return the surface speed of a block, or None."""
        if block.css is None or not block.rpm:
            return None
        return cls(block.css, block.rpm > 0.0, block.modal.css_min, block.modal.css_max)


class ControllerMotion:
    """Executes a path section by sending blocks to the controller, on the executor's thread only.

    Single block takes effect at the end of the last block that the controller has, at most
    ``BlockSink.ahead`` seconds later.
    """

    def __init__(self, context: MachineContext, sink: BlockSink) -> None:
        self._context = context
        self._sink = sink
        machine = context.machine
        self._limits = MotionLimits.of(machine.axes, machine.timing.setpoint, machine.limits.corner_tolerance)
        self._waiting: deque[Block] = deque()  # blocks not yet divided into parts
        self._pieces: deque[BlockPart] = deque()  # parts not yet sent
        self._sent: deque[_Sent] = deque()  # parts sent but not finished
        self._seconds = 0.0  # duration of the sent parts
        self._shown: Block | None = None
        self._overrides = Overrides()
        self._last: int | None = None  # number of the block after which single block sends nothing
        self._thread = False
        self._still = False  # in hold because an override is 0
        # the thread that has lost its spindle, and the target of X
        self._lost: tuple[Block, float] | None = None
        self._laid: _Surface | None = None  # the surface speed for which the spindle is set up
        self._looks = 0  # ticks spent on the block for which it is set up
        self._speed: Wait | None = None  # wait for the spindle before the next motion
        self._active = False
        self._seen = context.now  # time of the last tick of this motion
        self._dry = False  # a tick was too late, so the motion must not resume automatically

    # --- state --------------------------------------------------------------------------------------------

    @property
    def active(self) -> bool:
        """True if there is a path section."""
        return self._active

    @property
    def moving(self) -> bool:
        """True if anything is moving."""
        return self._active and self._moves(self._look())

    @property
    def block(self) -> Block | None:
        """The block being executed, or None."""
        self._look()
        return self._shown

    @property
    def following(self) -> Block | None:
        """The block after the one being executed, if it belongs to the path section."""
        if self._shown is None:
            return None
        cut = [*(each.piece.block for each in self._sent), *(each.block for each in self._pieces)]
        later = next((block for block in cut if block.n > self._shown.n), None)
        return later or (self._waiting[0] if self._waiting else None)

    @property
    def complete(self) -> bool:
        """True if no block of the path section remains to be executed."""
        return not (self._waiting or self._pieces or self._sent)

    @property
    def ended_with(self) -> Block | None:
        """The last block at the end of the path section."""
        return self.block

    @property
    def starving(self) -> float:
        """Minus infinity if the control was absent too long, otherwise infinity."""
        return -math.inf if self._dry else math.inf

    # --- requests -----------------------------------------------------------------------------------------

    def begin(self, blocks: list[Block]) -> None:
        """Start a new path section from rest. Raises AlarmError or DriverError."""
        self.forget()
        self._active, self._shown, self._seen = True, blocks[0], self._context.now
        self._thread = blocks[0].kind is Kind.THREAD
        self._waiting.extend(blocks)
        self._override()
        self._hand_over()

    def go_on(self, behind: Block | None) -> None:  # noqa: ARG002  it always goes on where it rests
        """Resume from rest within the path section: release the hold or send the next block."""
        self._last, self._dry, self._seen = None, False, self._context.now
        if not self._still:
            self._sink.resume()
        self._hand_over()

    def progress(self, feed: ReadAhead) -> Progress:
        """Apply switches and overrides, send permitted blocks and return the progress."""
        if not self._active:
            return Progress.DONE
        self._override()
        state = self._look()
        self._left_alone()
        if not self._thread and feed.pending and self._ready() < _CUT:
            self._waiting.extend(feed.take())
        self._hand_over()
        if state.held and not self._still:
            return Progress.HELD
        if self._moves(state):
            return Progress.MOVING
        return Progress.DONE if self.complete else self._resting()

    def keep_up(self) -> None:
        """Send the remaining parts of a thread pass that is stopping, including its pull-out."""
        self._look()
        if self._thread:
            self._hand_over()

    def hold(self) -> None:
        """Stop on the path; a thread pass ends first."""
        if not self._thread:
            self._sink.hold()

    def brake(self) -> None:
        """Stop at once and discard the blocks in the controller."""
        self._empty()
        self._sink.abort()

    def let_stop(self) -> None:
        """Do nothing, because the controller stops at the end of its blocks."""

    def release(self) -> bool:
        """Return False, because only the controller knows whether a thread pass still waits for its index."""
        return False

    def retract(self, block: Block) -> None:
        """Stop a thread that has lost its spindle, to retract X afterwards."""
        left = [*(each.piece.block for each in self._sent), *(each.block for each in self._pieces)]
        self._lost = block, [block, *left, *self._waiting][-1].mx
        self.brake()

    def retracted(self) -> None:
        """Retract X at rest, and raise AlarmError("thread-lost") when the tool is out.

        The alarm is also raised, without a retract, if the controller cannot start a block.
        """
        assert self._lost is not None
        block, out = self._lost
        x, z = self._context.sample.actual[:2]
        if abs(x - out) < _NEAR or self._sink.state().hindrance:
            raise AlarmError("thread-lost", line=block.line)
        self._pieces.append(BlockPart(RapidOp(out, z, block.modal.rapid_rate), block, 0.0))
        self._hand_over()

    def forget(self) -> None:
        """Clear the path section, in the controller as well."""
        self._look()
        if self._sent:
            self._sink.abort()
        self._empty()
        self._shown = self._last = self._lost = None
        self._thread = self._active = False

    # --- internal methods ---------------------------------------------------------------------------------

    def _empty(self) -> None:
        self._waiting.clear()
        self._pieces.clear()
        self._sent.clear()
        self._seconds, self._still, self._dry, self._laid, self._speed = 0.0, False, False, None, None

    def _look(self) -> BlockState:
        """Return the state of the controller and remove the blocks that it has finished."""
        state = self._sink.state()
        while self._sent and self._sent[0].ticket <= state.done:
            done = self._sent.popleft().piece
            self._shown, self._seconds = done.block, self._seconds - done.seconds
        if self._sent:
            self._shown = self._sent[0].piece.block
        return state

    def _moves(self, state: BlockState) -> bool:
        """Return whether the axes move. A controller in feed hold does not move although it has blocks."""
        return not state.held and (bool(self._sent) or not state.resting)

    def _left_alone(self) -> None:
        """Detect that the control was absent for longer than its blocks last.

        The motion then does not resume automatically.
        """
        away, self._seen = self._context.now - self._seen, self._context.now
        self._dry = self._dry or (away > _AWAY and bool(self._pieces or self._waiting))

    def _resting(self) -> Progress:
        if self._still:
            return Progress.STILL
        stepped = self._context.switches.single_block and self._last is not None
        return Progress.BLOCK_END if stepped else Progress.MOVING

    def _override(self) -> None:
        """Apply the overrides. At 0 the controller is in feed hold, except in a thread."""
        feed = self._context.feed_override
        turn = round(self._context.spindle.override, 2)
        self._overrides = Overrides(feed, min(feed, 1.0), turn)
        if feed and turn:
            self._sink.override(feed, min(feed, 1.0))
            if self._still:
                self._still = False
                self._sink.resume()
        elif not self._still and not self._thread:
            self._still = True
            self._sink.hold()

    @property
    def _cut_ahead(self) -> float:
        return sum(piece.seconds for piece in self._pieces)

    def _ready(self) -> float:
        return self._cut_ahead + (_CUT if self._waiting else 0.0)

    def _highest(self) -> float:
        """Return the highest rpm that the spindle can reach, which limits feeds per revolution."""
        reach = self._sink.reach if self._laid is not None else math.inf
        return min(self._context.spindle.highest, reach)

    def _laid_out(self, block: Block) -> bool:
        """Return whether the spindle can follow the radius in this block.

        A spindle whose speed steps depend on its last S word is set up for each surface speed, at rest. It
        must be at speed before any axis moves.
        """
        surface = _Surface.of(block)
        if surface is None or surface == self._laid or math.isinf(self._sink.reach):
            self._laid, self._speed = surface, None
            return True
        if self._sent or self._pieces or not self._sink.state().resting:
            return False
        if self._shown is not block or self._speed is None:
            self._shown, self._looks = block, 0  # the spindle follows the displayed block
            self._speed = at_speed(self._context)
        self._looks += 1
        turns = self._speed.over(self._context.now)
        if self._looks < _SEEN or not self._sink.reach or not turns:
            return False
        self._laid, self._speed = surface, None
        return True

    def _hand_over(self) -> None:
        while self._waiting and self._cut_ahead < _CUT and self._laid_out(self._waiting[0]):
            turning = Turning(self._overrides.spindle, self._highest())
            self._pieces.extend(parts_of(self._waiting.popleft(), turning, self._most))
        while self._pieces and self._may(self._pieces[0]):
            ticket = self._sink.submit(self._pieces[0].op)
            if ticket is None:
                return
            piece = self._pieces.popleft()
            self._sent.append(_Sent(ticket, piece))
            self._seconds += piece.seconds

    def _most(self, block: Block) -> float:
        """Return the highest speed of a block in mm/s.

        On a line, each axis has its own limit, as in the motion planner. On an arc, the slower axis and its
        acceleration set the limit.
        """
        if block.kind is not Kind.ARC:
            return self._sink.fastest(block.x - block.x0, block.z - block.z0)
        around = (
            CENTRIPETAL_SHARE
            * self._limits.plane_acceleration
            * math.hypot(block.x - block.cx, block.z - block.cz)
        )
        return min(self._sink.fastest(1.0, 0.0), self._sink.fastest(0.0, 1.0), math.sqrt(around))

    def _may(self, piece: BlockPart) -> bool:
        """Return whether this part may be sent now.

        Single block and the time that the controller could run alone limit the number of parts.
        """
        if self._still or self._dry or not self._single(piece.block):
            return False
        if self._thread or not self._sent:
            return True
        slow = max(min(self._overrides.feed, 1.0), _SLOWEST)
        return (self._seconds - self._sent[0].piece.seconds) / slow < self._sink.ahead

    def _single(self, block: Block) -> bool:
        if not self._context.switches.single_block or self._thread:
            self._last = None
            return True
        if self._last is None:
            self._last = self._sent[-1].piece.block.n if self._sent else block.n
        return block.n <= self._last
