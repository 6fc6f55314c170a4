"""The piece in the collet, and whether the end of its program makes a part."""

from __future__ import annotations

from core.executor.bench import Bench
from core.executor.job import Job
from core.executor.standing import Counters


class Piece:
    """A program from its first line is a new piece; a restart goes on with the one that was given up.

    Elementary blocks are numbered through a whole run and a restart keeps their numbers, so they tell what a
    restart leaves out. A piece of which something was left out makes no part: who did that
    by other means adds it to the count on F10.
    """

    def __init__(self) -> None:
        self._broken_off = ("", 0)  # program and line
        self._begun = 0  # blocks of it without a gap
        self._whole = True  # nothing is left out by what runs now
        self.restarted = False

    def begin(self, job: Job) -> None:
        """What is going to run."""
        begin = job.setup.begin
        self.restarted = begin is not None
        if begin is None or self._broken_off[0] != job.source.name:
            self._begun = 0
        self._whole = begin is None or begin.checkpoint.blocks <= self._begun
        self._broken_off = ("", 0)

    def break_off(self, program: str, line: int, blocks: int) -> None:
        """It was given up at this line, with so many blocks begun."""
        self._broken_off = (program, line)
        if self._whole:
            self._begun = max(self._begun, blocks)

    @property
    def broken_off(self) -> tuple[str, int]:
        """Program and line where it was given up; nobody, 0: it was not."""
        return self._broken_off

    def end(self) -> None:
        """The program has come to its end: what follows is another piece."""
        self._broken_off, self._begun, self._whole, self.restarted = ("", 0), 0, True, False

    @property
    def why_none(self) -> str:
        """Why its end makes no part; empty when it makes one."""
        return "" if self._whole else "a restart left something of it out"


class PartCount:
    """Counts parts and keeps cycle times; ``counters`` is what everybody reads."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self.counters = Counters()
        self.piece = Piece()

    @property
    def why_none(self) -> str:
        """Why the program under way will make no part; empty when it will make one."""
        return "NO COUNT is on" if self._bench.switches.no_count else self.piece.why_none

    def ended(self) -> None:
        """The program has come to its end. The time of a restart is not that of a cycle."""
        counters, seconds, why = self.counters, self.counters.cycle, self.why_none
        counters.cycle = 0.0
        counters.ends += 1
        if not self.piece.restarted:
            counters.last_cycle = seconds
        if why:
            self._bench.say("uncounted", f"{why}; {seconds:.2f} s")
        else:
            counters.parts += 1
            self._bench.say("part", f"part {counters.parts}, {seconds:.2f} s")
        self.piece.end()
