"""The count of parts: the workpiece in the collet, and whether the end of its program makes it a part."""

from __future__ import annotations

from core.executor.control_status import Counters
from core.executor.job import Job
from core.executor.machine_context import MachineContext
from core.executor.snapshot import Event
from core.message import Message


class Workpiece:
    """A program from its first line is a new piece; a restart goes on with the one that was given up.

    Elementary blocks are numbered through a whole run and a restart keeps their numbers, so they tell what a
    restart leaves out. A piece of which something was left out makes no part, nor one in whose cycle spindle
    or outputs were off that the program had on: who finds it good adds it to the count on F10.
    """

    def __init__(self) -> None:
        self._begun = 0  # blocks of it without a gap
        self._whole = True  # nothing is left out by what runs now
        self.restarted = False
        self.disturbed = ""  # what was switched off behind the program's back

    def begin(self, job: Job, begun: int) -> None:
        """What is going to run; ``begun`` blocks of the piece were begun before it was interrupted."""
        begin = job.setup.begin
        self.restarted = begin is not None
        self._begun = 0 if begin is None else begun
        self.disturbed = "" if begin is None else self.disturbed
        self._whole = begin is None or (not begin.skips_cuts and begin.checkpoint.blocks <= self._begun)

    def begun_to(self, block: int) -> int:
        """How many blocks are begun without a gap when what runs has come to this one."""
        return max(self._begun, block) if self._whole else self._begun

    def end(self) -> None:
        """The program has come to its end: what follows is another piece."""
        self._begun, self._whole, self.restarted, self.disturbed = 0, True, False, ""

    @property
    def why_none(self) -> str:
        """Why its end makes no part; empty when it makes one."""
        if self.disturbed:
            return Message(
                "the cycle was disturbed ({disturbed}); measure the part and, if it is good, add it "
                "to the part count on page F10",
                disturbed=self.disturbed,
            )
        return "" if self._whole else "a restart skipped part of the program"


class PartCount:
    """Counts parts and keeps cycle times; ``counters`` is what everybody reads."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self.counters = Counters()
        self.piece = Workpiece()

    @property
    def why_none(self) -> str:
        """Why the program under way will make no part; empty when it will make one."""
        return "NO COUNT is on" if self._context.switches.no_count else self.piece.why_none

    def ended(self) -> None:
        """The program has come to its end. The time of a restart is not that of a cycle."""
        counters, seconds, why = self.counters, self.counters.cycle, self.why_none
        counters.cycle, load = 0.0, counters.take_load()
        counters.ends += 1
        if not self.piece.restarted:
            counters.last_cycle, counters.timed = seconds, counters.timed + 1
        if why:
            text, line = Message("{why}; {seconds} s", why=why, seconds=f"{seconds:.2f}"), self._context.line
            self._context.log_event(Event(self._context.now, "uncounted", text, line, load=load))
        else:
            counters.parts += 1
            counters.made += 1
            text, line = (
                Message(
                    "part {parts} completed in {seconds} s", parts=counters.parts, seconds=f"{seconds:.2f}"
                ),
                self._context.line,
            )
            self._context.log_event(
                Event(self._context.now, "part", text, line, part=counters.made, load=load)
            )
        self.piece.end()
