"""What a cycle asks of what moves its blocks: our own setpoints, or a controller that plans by itself."""

from __future__ import annotations

from enum import Enum
from typing import Protocol

from core.executor.feed import BlockFeed
from core.interpreter.elementary_blocks import Block


class Progress(Enum):
    """How far the present stretch is."""

    DONE = "there is none, or it has come to its end"
    MOVING = "it moves"
    BLOCK_END = "at rest where single block wants it"
    STILL = "at rest because the override is 0"
    HELD = "at rest because something outside the control holds it"


class Moving(Protocol):
    """Blocks from rest to rest, under overrides, single block and read-ahead."""

    @property
    def active(self) -> bool:
        """Whether there is a stretch at all."""
        ...

    @property
    def moving(self) -> bool:
        """Whether anything still moves."""
        ...

    @property
    def block(self) -> Block | None:
        """The block being moved."""
        ...

    @property
    def following(self) -> Block | None:
        """The block behind it, when it belongs to the stretch."""
        ...

    @property
    def complete(self) -> bool:
        """Whether nothing of the stretch is left to be begun."""
        ...

    @property
    def ended_with(self) -> Block | None:
        """At the end of the stretch: its last block, which may go nowhere."""
        ...

    @property
    def starving(self) -> float:
        """When the slides stop for want of setpoints; endless where that cannot be."""
        ...

    def begin(self, blocks: list[Block]) -> None:
        """A new stretch, from rest. Raises TroubleError, MotionError, DriverError."""
        ...

    def go_on(self, behind: Block | None) -> None:
        """From rest within the stretch; with single block to the end of the block after it."""
        ...

    def progress(self, feed: BlockFeed) -> Progress:
        """Follow switches and overrides, take read-ahead blocks in, and say how far it is."""
        ...

    def keep_up(self) -> None:
        """While it is being stopped: what must go on until the slides rest."""
        ...

    def hold(self) -> None:
        """Come to rest as soon as the path allows; a thread pass ends behind its pull-out."""
        ...

    def brake(self) -> None:
        """Come to rest at once on the path, to be given up."""
        ...

    def let_stop(self) -> None:
        """The queue was not refilled in time: the slides stop where it ends."""
        ...

    def release(self) -> bool:
        """Give a thread pass back that still waits for its index; False when it moves."""
        ...

    def retreat(self, block: Block) -> None:
        """Begin to leave a thread whose spindle is lost."""
        ...

    def retreated(self) -> None:
        """At rest: draw back, or be done. Raises TroubleError("thread-lost") in the end."""
        ...

    def forget(self) -> None:
        """The stretch is over, or nothing of it holds any more."""
        ...
