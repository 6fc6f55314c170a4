"""Passes through programs and lines of MDI, one at a time: begun, repeated, ended, given up."""

from __future__ import annotations

from collections.abc import Callable

from core.executor import prepared
from core.executor.bench import Bench
from core.executor.blockwise.mover import BlockMover
from core.executor.cycle import Cycle
from core.executor.feed import Pass
from core.executor.inherited import as_it_is, given_up, interrupted
from core.executor.interpret import circumstances
from core.executor.job import Job, outdated
from core.executor.mover import Mover
from core.executor.moving import Moving
from core.executor.piece import Piece
from core.executor.player import Player
from core.executor.snapshot import Starts, State
from core.executor.standing import Counters, Standing
from core.interpreter.actions import ProgramEnd
from core.interpreter.modal import Modal
from core.interpreter.setup import Setup
from core.language.dialect import Dialect
from core.motion.limits import MotionLimits


class Rounds:
    """The cycle under way, if any, and what stands between two of them. On the executor's thread alone."""

    def __init__(
        self, bench: Bench, passes: Callable[[Job, Setup], Pass], enter: Callable[[State], None]
    ) -> None:
        self._bench = bench
        self._passes = passes
        self._enter = enter
        self.mover = _mover(bench)
        self.standing = Standing()
        self.counters = Counters()
        self.cycle: Cycle | None = None
        self._source: Pass | None = None
        self._line = False  # what is under way is a line of MDI
        self.piece = Piece()

    def refusal(self, state: State) -> str:
        """Why what Cycle Start would begin may not begin; empty when it may."""
        return prepared.refusal(self._bench, state, self.standing)

    def begin(self) -> None:
        """The program, a restart in it, or the line of MDI; whatever was prepared counts once."""
        standing, bench = self.standing, self._bench
        job = prepared.job_of(standing)
        assert job is not None
        self.counters.cycle = 0.0
        self._line = standing.starts is Starts.LINE
        self.counters.lines += self._line
        if standing.starts is Starts.RESTART:
            standing.starts = Starts.PROGRAM
        standing.prepared = standing.prepared_proof = None
        if not self._line:
            self.piece.begin(job)
        self._open(job)
        self._enter(State.RUN)
        bench.say("mdi" if self._line else "start", job.source.text if self._line else job.source.name)
        begin = job.setup.begin
        if begin is not None and not begin.single:
            bench.say("restart", f"from line {begin.line}")

    @property
    def uncounted(self) -> str:
        """Why what is under way will be no part; empty when it will be one."""
        if self._line:
            return "a line of MDI"
        return "NO COUNT is on" if self._bench.switches.no_count else self.piece.why_none

    def leave(self) -> bool:
        """A cycle that was reset is over as soon as the slides rest; True once it is."""
        if self.cycle is None or not self.cycle.at_rest:
            return False
        said = "the line was given up by reset" if self._line else "program given up by reset"
        kind = "mdi" if self._line else "end"
        self.forget()
        self._enter(State.IDLE)
        self._bench.say(kind, said)
        return True

    def forget(self) -> None:
        """What an interrupted program leaves in force is what M30 would have left; MDI keeps its modes."""
        if self.cycle is not None:
            left = self.cycle.modal
            self._stand(interrupted(left) if self._line else given_up(left))
            job, block = self.standing.job, self.cycle.current
            if not self._line and job is not None and block is not None:
                self.piece.break_off(job.source.name, block.line, block.n)
        self.cycle = self._source = None
        self._bench.line = 0
        self.mover.forget()

    def _stand(self, modal: Modal, *, tool_open: bool = False) -> None:
        """Unit and rapid rate are OmniTurn's own: what other dialects did with theirs does not count."""
        job, before = self.standing.job, self.standing.modal
        if not self._line and job is not None and job.source.dialect is not Dialect.OMNITURN:
            modal = modal._replace(metric=before.metric, rapid_rate=before.rapid_rate)
        self.standing.modal, self.standing.tool_open = modal, tool_open

    def look(self) -> None:
        """Between two cycles: what stands is what the machine really does."""
        if self.cycle is None:
            self.standing.modal = as_it_is(self.standing.modal, self._bench)

    def _open(self, job: Job) -> None:
        """A pass from where the slides stand now; nothing is kept of an earlier one."""
        at, _ = self._bench.ports.axes.demand_at(self._bench.now)
        setup = circumstances(job.setup, at, self._bench.terminal)
        self.mover.forget()
        begins = Modal(metric=setup.metric, rapid_rate=setup.last_rapid)
        if setup.begin is not None:
            begins = setup.begin.checkpoint.modal
        self._source = self._passes(job, setup)
        self.cycle = Cycle(self._bench, self.mover, self._source, begins, self._enter, self._ended)

    def _ended(self, end: ProgramEnd | None) -> None:
        """M30 and M02, or the end of a line of MDI."""
        if end is not None and end.reset:
            self._end_functions()
        if self._line:
            self._line_ended()
            return
        job, bench = self.standing.job, self._bench
        self._count()
        if end is not None and end.reset and bench.switches.cycle_repeat and job is not None:
            old = outdated(job, self.cycle.modal) if self.cycle is not None else ""
            if not old:
                self._open(job)
                return
            bench.say("refused", f"no repeat: {old}, and the program says nothing of it")
        bench.say("end", "program end")
        self._over()

    def _count(self) -> None:
        """A part, unless it is none; the time of a restart is not that of a cycle."""
        counters, seconds, why = self.counters, self.counters.cycle, self.uncounted
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

    def _line_ended(self) -> None:
        left = self._source.left() if self._source is not None and self._source.left is not None else None
        self._over()
        if left is not None:
            self._stand(as_it_is(left.modal, self._bench), tool_open=left.tool_line != 0)
        self._bench.say("mdi", "done")

    def _over(self) -> None:
        left = self.cycle.modal if self.cycle is not None else self.standing.modal
        self.forget()
        self._stand(left)
        if not self._line:
            self.piece.end()
        self._enter(State.IDLE)

    def _end_functions(self) -> None:
        """M30 ends what M functions have begun; the collet stays."""
        bench = self._bench
        bench.spindle.stop()
        for name, on in bench.ports.io.outputs().items():
            if on and name != "collet":
                bench.ports.io.write(name, False)


def _mover(bench: Bench) -> Moving:
    """By setpoints, or block by block where the controller plans by itself."""
    machine = bench.machine
    if bench.ports.blocks is not None:
        return BlockMover(bench, bench.ports.blocks)
    limits = MotionLimits.of(machine.axes, machine.timing.setpoint)
    return Mover(bench, Player(bench.ports.axes, limits, machine.timing.lookahead))
