"""What is done while nothing moves: waits, and what comes next in the order of blocks."""

from __future__ import annotations

from enum import Enum, auto

from core.executor.bench import Bench
from core.executor.feed import BlockFeed, needs_speed
from core.executor.waits import Wait, at_speed, carry_out, in_position
from core.interpreter.elementary_blocks import Block, Kind


class Next(Enum):
    """What the cycle has to do now."""

    WAIT = auto()  # nothing: something is waited for
    GO_ON = auto()  # ask again: a wait is over, or has been begun
    BLOCK_END = auto()  # stop for single block
    MOTION = auto()  # begin the blocks that are pending
    ACTION = auto()  # carry out the block that needed the standstill
    END = auto()  # nothing comes any more
    NOTHING = auto()  # not in this tick


class Standstill:
    """``done`` is for single block: something was executed since the last stop."""

    def __init__(self, bench: Bench, feed: BlockFeed) -> None:
        self._bench, self._feed = bench, feed
        self._wait: Wait | None = None
        self._settled = True  # in position since the last motion
        self.done = False

    @property
    def label(self) -> str | None:
        """In words, what is waited for; empty for what is too short to show, None without a wait."""
        return self._wait.label() if self._wait is not None else None

    def next(self) -> Next:
        """One thing at a time. Raises TroubleError for a wait that takes too long and for bad blocks."""
        feed = self._feed
        if self._wait is not None:
            return self._look(self._wait)
        if not self._settled:
            self._wait = in_position(self._bench)
            return Next.GO_ON
        if self.done and self._bench.switches.single_block:
            return Next.BLOCK_END
        if feed.pending:
            self._settled, self.done = False, True
            return Next.MOTION
        if feed.stop is not None:
            return Next.ACTION
        if feed.trouble is not None:
            raise feed.trouble
        return Next.END if feed.ended else Next.NOTHING

    def carry_out(self, block: Block) -> None:
        """Do what an action says, or wait for the speed that a cutting block needs. Raises as ``waits``."""
        if block.action is not None:
            self._wait = carry_out(block, self._bench)
        elif needs_speed(block):
            self._wait = at_speed(self._bench, thread=block.kind is Kind.THREAD)
        if self._wait is None:
            self._waited()

    def wait_for(self, label: str) -> None:
        """Stand until another cycle takes the place of this one."""
        if self._wait is None:
            self._wait = Wait(lambda: label, lambda _: False, self._bench.now)

    def held(self, seconds: float) -> None:
        """The cycle was held so long: it does not count."""
        if self._wait is not None:
            self._wait.shift(seconds)

    def _look(self, wait: Wait) -> Next:
        if not wait.over(self._bench.now):
            return Next.WAIT
        self._wait = None
        self._waited()
        return Next.GO_ON

    def _waited(self) -> None:
        if not self._settled:
            self._settled = True
        elif self._feed.stop is not None:
            self.done = self._feed.stop.action is not None
            self._feed.pass_stop()
