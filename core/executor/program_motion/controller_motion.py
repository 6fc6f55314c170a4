"""Motion by a controller that plans by itself: it gets a cycle's blocks, no more than it must have.

What has been handed over runs to its end whatever becomes of the host. So a long block goes out in parts of a
fraction of a second on its own line or circle, between which the controller does not slow down.
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


LONGEST = 0.2  # s of a piece at its programmed speed
_SHORTEST_PART = 0.05  # mm; a slow feed is not cut up finer
_WIDEST = 3.0  # radians
_CUT = 1.0  # s of motion that lie ready in pieces
_SLOWEST = 0.1  # of the feed: what has been handed over counts as no longer than that
_AWAY = 1.0  # s; setpoints would have run out too
_SEEN = 4  # looks in which the spindle has been told of a block that is shown
_NEAR = 0.01  # mm; the controller reports thousandths


class BlockPart(NamedTuple):
    """A part of a block for the controller, the block, and the seconds that it takes at least."""

    op: BlockOp
    block: Block
    seconds: float


class Turning(NamedTuple):
    """What feeds per revolution go by: spindle speed over programmed speed, and the highest rpm allowed."""

    scale: float
    highest: float


def parts_of(
    block: Block, turning: Turning, most: Callable[[Block], float] = lambda _: math.inf
) -> Iterator[BlockPart]:
    """The parts of one moving block, none faster than ``most`` (mm/s) allows it.

    Raises AlarmError for what has no speed or is not X and Z alone.
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
    """The controller's own limits may be wider than those that were proved."""
    if isinstance(op, RapidOp):
        return op._replace(rate=min(op.rate, fastest))
    return op._replace(feed=min(op.feed, fastest))


def _cuts(block: Block, seconds: float) -> int:
    """An arc in parts of less than half a turn: the controller has ends and centre only, which do not tell a
    whole turn from none.
    """
    least = math.ceil(abs(_sweep(block)[1]) / _WIDEST) if block.kind is Kind.ARC else 1
    return max(least, min(math.ceil(seconds / LONGEST - 1e-9), math.ceil(block.length / _SHORTEST_PART)))


def _op(block: Block, begin: float, end: float, turning: Turning) -> RapidOp | LineOp | ArcOp:
    """The part of a block between two fractions of its way."""
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
    """Exact at both ends, where the radii may differ by a rounding of the program."""
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
    """mm/s. A feed per revolution follows the spindle's command, as it does with setpoints."""
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
    """A surface speed, mm/s: as M03 or M04 turns, and its clamps."""

    speed: float
    forward: bool
    lowest: float
    highest: float | None

    @classmethod
    def of(cls, block: Block) -> _Surface | None:
        """That of a block, if any."""
        if block.css is None or not block.rpm:
            return None
        return cls(block.css, block.rpm > 0.0, block.modal.css_min, block.modal.css_max)


class ControllerMotion:
    """A path section given to the controller block by block, on the executor's thread alone.

    Single block acts at the end of the last block that the controller has, ``BlockSink.ahead`` away at most.
    """

    def __init__(self, context: MachineContext, sink: BlockSink) -> None:
        self._context = context
        self._sink = sink
        machine = context.machine
        self._limits = MotionLimits.of(machine.axes, machine.timing.setpoint, machine.limits.corner_tolerance)
        self._waiting: deque[Block] = deque()  # not yet cut
        self._pieces: deque[BlockPart] = deque()  # cut, not yet handed over
        self._sent: deque[_Sent] = deque()  # handed over, not yet done
        self._seconds = 0.0  # that the sent ones take
        self._shown: Block | None = None
        self._overrides = Overrides()
        self._last: int | None = None  # single block: nothing behind this block is handed over
        self._thread = False
        self._still = False  # held because an override is 0
        self._lost: tuple[Block, float] | None = None  # thread without its spindle, and where X goes
        self._laid: _Surface | None = None  # what the spindle is laid out for
        self._looks = 0  # at the block before which it is
        self._speed: Wait | None = None  # for which nothing moves
        self._active = False
        self._seen = context.now  # when it was last followed
        self._dry = False  # it was followed too late

    # --- how it stands ------------------------------------------------------------------------------------

    @property
    def active(self) -> bool:
        """Whether there is a path section at all."""
        return self._active

    @property
    def moving(self) -> bool:
        """Whether anything still moves."""
        return self._active and self._moves(self._look())

    @property
    def block(self) -> Block | None:
        """The block being moved."""
        self._look()
        return self._shown

    @property
    def following(self) -> Block | None:
        """The block behind it, when it has been read into the path section."""
        if self._shown is None:
            return None
        cut = [*(each.piece.block for each in self._sent), *(each.block for each in self._pieces)]
        later = next((block for block in cut if block.n > self._shown.n), None)
        return later or (self._waiting[0] if self._waiting else None)

    @property
    def complete(self) -> bool:
        """Whether nothing of the path section is left to be moved."""
        return not (self._waiting or self._pieces or self._sent)

    @property
    def ended_with(self) -> Block | None:
        """At the end of the path section: its last block."""
        return self.block

    @property
    def starving(self) -> float:
        """Minus infinity where the control was away too long, else endless: it stops by itself."""
        return -math.inf if self._dry else math.inf

    # --- what is asked ------------------------------------------------------------------------------------

    def begin(self, blocks: list[Block]) -> None:
        """A new path section, from rest. Raises AlarmError, DriverError."""
        self.forget()
        self._active, self._shown, self._seen = True, blocks[0], self._context.now
        self._thread = blocks[0].kind is Kind.THREAD
        self._waiting.extend(blocks)
        self._override()
        self._hand_over()

    def go_on(self, behind: Block | None) -> None:  # noqa: ARG002  it always goes on where it rests
        """From rest within the path section: the controller goes on, or gets the next block."""
        self._last, self._dry, self._seen = None, False, self._context.now
        if not self._still:
            self._sink.resume()
        self._hand_over()

    def progress(self, feed: ReadAhead) -> Progress:
        """Follow switches and overrides, hand over what may be, and say how far it is."""
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
        """A thread pass that is being held ends: what pulls out of it is handed over."""
        self._look()
        if self._thread:
            self._hand_over()

    def hold(self) -> None:
        """Come to rest on the path; a thread pass first ends."""
        if not self._thread:
            self._sink.hold()

    def brake(self) -> None:
        """Come to rest at once; what the controller still has is void."""
        self._empty()
        self._sink.abort()

    def let_stop(self) -> None:
        """The controller stops by itself."""

    def release(self) -> bool:
        """Never gives a thread pass back: the controller alone knows whether it still waits for its index."""
        return False

    def retract(self, block: Block) -> None:
        """Begin to leave a thread whose spindle is lost: stop, to draw X back then."""
        left = [*(each.piece.block for each in self._sent), *(each.block for each in self._pieces)]
        self._lost = block, [block, *left, *self._waiting][-1].mx
        self.brake()

    def retracted(self) -> None:
        """At rest: draw back, or be done. Raises AlarmError("thread-lost") in the end."""
        assert self._lost is not None
        block, out = self._lost
        x, z = self._context.sample.actual[:2]
        if abs(x - out) < _NEAR or self._sink.state().hindrance:
            raise AlarmError("thread-lost", line=block.line)
        self._pieces.append(BlockPart(RapidOp(out, z, block.modal.rapid_rate), block, 0.0))
        self._hand_over()

    def forget(self) -> None:
        """The path section is over, or nothing of it holds any more: the controller forgets it too."""
        self._look()
        if self._sent:
            self._sink.abort()
        self._empty()
        self._shown = self._last = self._lost = None
        self._thread = self._active = False

    # --- inside -------------------------------------------------------------------------------------------

    def _empty(self) -> None:
        self._waiting.clear()
        self._pieces.clear()
        self._sent.clear()
        self._seconds, self._still, self._dry, self._laid, self._speed = 0.0, False, False, None, None

    def _look(self) -> BlockState:
        """The state of the controller; blocks that it has done are forgotten."""
        state = self._sink.state()
        while self._sent and self._sent[0].ticket <= state.done:
            done = self._sent.popleft().piece
            self._shown, self._seconds = done.block, self._seconds - done.seconds
        if self._sent:
            self._shown = self._sent[0].piece.block
        return state

    def _moves(self, state: BlockState) -> bool:
        """A controller that is held rests, with all that it still has to move."""
        return not state.held and (bool(self._sent) or not state.resting)

    def _left_alone(self) -> None:
        """A control that was away for longer than its blocks last does not go on: nobody expects it."""
        away, self._seen = self._context.now - self._seen, self._context.now
        self._dry = self._dry or (away > _AWAY and bool(self._pieces or self._waiting))

    def _resting(self) -> Progress:
        if self._still:
            return Progress.STILL
        stepped = self._context.switches.single_block and self._last is not None
        return Progress.BLOCK_END if stepped else Progress.MOVING

    def _override(self) -> None:
        """Feed and rapid override; at 0 the controller is held. Threads know neither."""
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
        """rpm that feeds a turn count by at most: the spindle comes no further."""
        reach = self._sink.reach if self._laid is not None else math.inf
        return min(self._context.spindle.highest, reach)

    def _laid_out(self, block: Block) -> bool:
        """Whether the spindle can follow the radius in this block. One whose steps count from its last S is
        laid out for each surface speed, at rest, and turns as it ought to before anything moves.
        """
        surface = _Surface.of(block)
        if surface is None or surface == self._laid or math.isinf(self._sink.reach):
            self._laid, self._speed = surface, None
            return True
        if self._sent or self._pieces or not self._sink.state().resting:
            return False
        if self._shown is not block or self._speed is None:
            self._shown, self._looks = block, 0  # the spindle follows what is shown
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
        """mm/s: as the time law has it, each axis by itself on a line, the slower one and its
        acceleration on an arc.
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
        """Whether the controller gets this one now: by single block, and by how far it could run on alone."""
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
