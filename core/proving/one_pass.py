"""One pass through a program, proved: what is found in its blocks, and what adds up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from core.interpreter.actions import Dwell, ProgramStop
from core.interpreter.elementary_blocks import Block, Series
from core.interpreter.machine_requirements import Need, first_needs, needs_of
from core.language.diagnostics import Diagnostic
from core.language.source import Source
from core.machine.model import Machine
from core.proving.cutting_checks import CuttingChecks
from core.proving.interlock import c_findings
from core.proving.passing import Part
from core.proving.report import MillFigures, Report, Times
from core.proving.stretches import Moved, Rested
from core.proving.tally import Tally
from core.proving.timeline import Timeline
from core.proving.travel import travel_findings

_AT_ONCE = 1000  # blocks that are looked at together
MAX_FINDINGS = 100  # a broken offset makes every line of a program leave the travel; nobody reads more


class Pass:
    """What adds up while a program passes by once."""

    def __init__(self, machine: Machine, checks: CuttingChecks) -> None:
        self._machine = machine
        self._checks = checks
        self._tally = Tally()
        self._unseen: list[Part] = []
        self._waiting = 0  # blocks in them
        self._cutting = self._rapid = self._dwell = self._wait = 0.0
        self._beyond: dict[tuple[int, str], Diagnostic] = {}
        self._needs: tuple[Need, ...] = ()
        self._before: Block | None = None
        self.last: Block | None = None
        self.last_move: Block | None = None
        self.elementary = 0
        self._stops = self._optional_stops = 0

    @property
    def checks(self) -> CuttingChecks:
        """Those of cutting, as far as the program has passed by."""
        return self._checks

    def add(self, stretch: Moved | Rested) -> None:
        """The next stretch of the timeline."""
        if isinstance(stretch, Moved):
            self._moved(stretch)
        else:
            self._rested(stretch)

    def _moved(self, stretch: Moved) -> None:
        spent = stretch.chunk.t1 - stretch.chunk.t0
        rapid = float(spent[_rapid(stretch.parts)].sum())
        self._rapid += rapid
        self._cutting += float(spent.sum()) - rapid
        self._unseen += stretch.parts
        for part in stretch.parts:
            self._checks.look(part)
        self._waiting += len(spent)
        self.elementary += len(spent)
        if stretch.last is not None:
            self.last = self.last_move = stretch.last
        if self._waiting >= _AT_ONCE:
            self._see()

    def _see(self) -> None:
        """Lengths and reach of the blocks that have come in; many at once, for motions of three blocks."""
        parts, self._unseen, self._waiting = self._unseen, [], 0
        self._tally.add(parts)
        for part in parts:
            self._need(part)
            if len(self._beyond) < MAX_FINDINGS:
                self._look_beyond(part)

    def _look_beyond(self, part: Part) -> None:
        for finding in (*travel_findings(part, self._machine), *c_findings(part, self._machine)):
            self._beyond.setdefault((finding.line, finding.message[:1]), finding)

    def _need(self, blocks: Part) -> None:
        """Only a controller that plans by itself can lack what a program needs."""
        if blocks and self._machine.backend == "grblhal":
            unlike = blocks[:1] if isinstance(blocks, Series) else blocks  # what one needs, all need
            self._needs = first_needs((*self._needs, *needs_of(unlike, self._before)))
            self._before = blocks[-1]

    def _rested(self, stretch: Rested) -> None:
        spent = stretch.t1 - stretch.t0
        if stretch.block is None:
            self._wait += spent
            return
        self.elementary += 1
        self.last = stretch.block
        self._checks.look([stretch.block])
        self._need([stretch.block])
        if isinstance(stretch.block.action, ProgramStop):
            self._optional_stops += stretch.block.action.optional
            self._stops += not stretch.block.action.optional
        if isinstance(stretch.block.action, Dwell):
            self._dwell += spent
        else:
            self._wait += spent

    def report(self, timeline: Timeline, source: Source) -> Report:
        """All of it, when the program has passed by."""
        self._see()
        beyond = list(self._beyond.values())[:MAX_FINDINGS]
        found = [*timeline.diagnostics, *beyond, *self._checks.findings]
        interpreter, last, tally = timeline.interpreter, self.last, self._tally
        end = self.last_move  # in its own frame: M30 takes the work shift away, and moves nothing
        return Report(
            name=source.name,
            dialect=source.dialect,
            metric=bool(last and last.modal.metric),
            blocks=interpreter.source_blocks,
            elementary=self.elementary,
            diagnostics=tuple(sorted(found, key=lambda d: (d.line, d.column))),
            times=Times(self._cutting, self._rapid, self._dwell, self._wait),
            cutting_length=tally.cutting_length,
            rapid_length=tally.rapid_length,
            tools=tuple(sorted(interpreter.used_tools)),
            missing_tools=tuple(sorted(interpreter.missing_tools)),
            reach=tally.reach,
            final=(end.x, end.z, _shown_c(end)) if end else _lathe(timeline.start),
            machine_final=end.machine_end if end else timeline.start,
            mill=self._mill(),
            needs=self._needs,
            stops=self._stops,
            optional_stops=self._optional_stops,
        )

    def _mill(self) -> MillFigures | None:
        if self._machine.kind != "mill":
            return None
        return MillFigures(
            axes=tuple(axis.name for axis in self._machine.axes),
            reach=tuple(span.range for span in self._tally.axes),
            final=self.last.swivel if self.last else None,
        )


def _rapid(parts: Sequence[Part]) -> npt.NDArray[np.bool_]:
    """For each block whether it is a rapid."""
    found: list[bool] = []
    for part in parts:
        series = isinstance(part, Series)
        found += [part[0].rapid] * len(part) if series else [block.rapid for block in part]
    return np.array(found, dtype=bool)


def _lathe(start: tuple[float, ...]) -> tuple[float, float, float]:
    """X, Z and C of a start in the machine's order."""
    return start[0], start[1], start[-1]


def _shown_c(block: Block) -> float:
    """C of the end as the program counts it."""
    return block.c % 360.0 if block.modal.wraps_c else block.c
