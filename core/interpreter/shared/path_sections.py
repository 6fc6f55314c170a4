"""Where a path section ends: the blocks before which all comes to rest, in a run as in its forecast."""

from __future__ import annotations

from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.elementary_blocks import Block, Kind


def needs_speed(block: Block) -> bool:
    """Whether this block must not begin before the spindle is at its speed; rapids may."""
    return block.moves and not block.rapid


class SectionEnds:
    """Goes with the elementary blocks of one pass through a program, in their order.

    A standstill is needed before every action, before the first block after a spindle command that must not
    begin without its speed, and before and behind each thread pass, which is the thread or a chain of them,
    and what pulls out of it. All other blocks are moved through without one: they are one path section.
    """

    def __init__(self) -> None:
        self._new_speed = False  # a speed was commanded that no block has waited for yet
        self._pass = 0  # of the thread pass under way: 1 in its threads, 2 in what pulls out of them

    @property
    def in_thread(self) -> bool:
        """Whether the block before belongs to a thread pass, which what comes next may end."""
        return self._pass > 0

    def rests_before(self, block: Block) -> bool:
        """Whether all has to be at rest before ``block``, which comes next.

        While it is waited for the answer stays the same, until ``rested``.
        """
        if block.action is not None:
            self._new_speed = self._new_speed or isinstance(block.action, SpindleRun)
            return True
        if self._pass == 1 and _pulls_out(block):
            self._pass = 1 if block.continues else 2
            return False
        return self._pass > 0 or block.kind is Kind.THREAD or (self._new_speed and needs_speed(block))

    def rested(self, block: Block) -> None:
        """All is at rest, and ``block``, before which it had to be, begins."""
        if block.action is None:
            self._new_speed = self._new_speed and not needs_speed(block)
            self._pass = int(block.kind is Kind.THREAD)


def _pulls_out(block: Block) -> bool:
    """Behind a thread: its pull-out, or a rapid straight out."""
    return block.kind is Kind.THREAD or (block.kind is Kind.RAPID and block.z == block.z0)
