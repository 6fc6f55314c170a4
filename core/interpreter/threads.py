"""G33 and G34: a threading cycle → its passes, and the rapids between them.

All lengths mm, X a radius. The formulas: docs/decisions/0009-threads.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import copysign, tan

from core.interpreter import units
from core.interpreter.blocks import Block, Kind
from core.interpreter.spindle import rpm_at
from core.interpreter.state import State
from core.interpreter.statement import Statement
from core.interpreter.thread_words import Thread, read_thread

MANY_PASSES = 60
_FACE = 1e-9  # mm


def thread_blocks(state: State, made: Statement) -> Iterator[Block]:
    """The blocks of a line with G33 or G34, from S back to S. Raises ProgramError before the first one."""
    thread = read_thread(state, made)
    _warn(state, made, thread)
    return _Cutter(state, made, thread).blocks()


def pass_depths(thread: Thread) -> list[float]:
    """Depth of each pass from S, mm: I(√k - 1), so that every pass takes a chip of the same area."""
    if thread.passes == 1:
        return [thread.depth]
    cuts = [thread.first * (k**0.5 - 1.0) for k in range(1, thread.passes)]
    return [*cuts, thread.depth]


def start_z(thread: Thread, depth: float) -> float:
    """Where a pass of this depth starts: shifted along the flank in the cutting direction."""
    return thread.z0 + thread.along * depth * tan(thread.angle)


class _Cutter:
    """Makes the blocks of one cycle one after the other."""

    def __init__(self, state: State, made: Statement, thread: Thread) -> None:
        self._state = state
        self._thread = thread
        self._at = state.x, state.z
        self._like = Block(
            0, made.line, Kind.RAPID, made.part("move"), state.x, state.z, state.c, state.x, state.z, state.c,
            state.offset_x, state.offset_z, state.modal, rpm=rpm_at(state, state.x),
        )  # fmt: skip

    def blocks(self) -> Iterator[Block]:
        thread = self._thread
        retract = thread.retract
        depths = pass_depths(thread)
        for k, depth in enumerate(depths, start=1):
            z = start_z(thread, depth)
            x = thread.x0 - thread.out * depth
            slope = thread.taper / (thread.z1 - thread.z0)
            if k > 1:
                yield from self._rapid(retract, z)
            yield from self._rapid(x + slope * (z - thread.z0), z)
            end = x + thread.taper
            yield self._cut(end, thread.z1, f"({k}/{len(depths)})")
            if thread.pulls_out:
                yield self._cut(retract, thread.z1 + thread.along * abs(retract - end), "P")
            else:
                yield from self._rapid(retract, thread.z1)
        yield from self._rapid(retract, thread.z0)
        yield from self._rapid(thread.x0, thread.z0)

    def _rapid(self, x: float, z: float) -> Iterator[Block]:
        """A rapid, none where the slides stand there."""
        if max(abs(x - self._at[0]), abs(z - self._at[1])) > _FACE:
            yield self._block(x, z, Kind.RAPID, self._state.modal.rapid_rate, self._text("G00", x, z))

    def _cut(self, x: float, z: float, what: str) -> Block:
        lead = units.feed(self._thread.lead, per_rev=True, metric=self._state.modal.metric).split()[0]
        return self._block(
            x, z, Kind.THREAD, self._thread.lead, f"{self._text('G33', x, z)}K{lead} {what}", per_rev=True
        )

    def _block(
        self, x: float, z: float, kind: Kind, feed: float, text: str, *, per_rev: bool = False
    ) -> Block:
        self._state.blocks += 1
        (x0, z0), self._at = self._at, (x, z)
        return replace(
            self._like, n=self._state.blocks, kind=kind, text=text, x0=x0, z0=z0, x=x, z=z, feed=feed,
            per_rev=per_rev,
        )  # fmt: skip

    def _text(self, code: str, x: float, z: float) -> str:
        """As a line of the program would say it, in its unit and its X words."""
        state = self._state
        places = 4 if state.modal.metric else 5
        return f"{code}X{x / state.scale_x + 0.0:.{places}f}Z{z / state.scale_z + 0.0:.{places}f}"


def _warn(state: State, made: Statement, thread: Thread) -> None:
    column = made.code.column if made.code else 0
    if thread.passes > MANY_PASSES:
        text = f"The thread takes {thread.passes} passes."
        hint = "A larger I takes fewer; look at I and at the X where the tool starts."
        state.log.warn(made.line, column, "thread-passes", text, hint)
    speed = thread.lead * abs(rpm_at(state, state.x)) / 60
    needed = speed**2 / (2 * state.setup.limits.slide_accel)
    run_up = _run_up(thread)
    if run_up < needed:
        metric = state.modal.metric
        text = (
            f"The run-up is {units.length(max(run_up, 0.0), metric=metric)}; the slide needs "
            f"{units.length(needed, metric=metric)} to reach the speed of the lead."
        )
        state.log.warn(made.line, column, "thread-run-up", text, "Start farther away, or lower S.")


def _run_up(thread: Thread) -> float:
    """The way before the work begins, of the deepest pass: to part zero where the pass comes over it, else
    all of it, since nothing says where the work begins."""
    z = start_z(thread, thread.depth)
    if copysign(1.0, z) != copysign(1.0, thread.z1) and thread.z1 != 0.0:
        return abs(z)
    return abs(thread.z1 - z)
