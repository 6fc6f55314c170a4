"""Block search with calculation for Klartext and SINUMERIK programs.

All blocks before the line are interpreted as in a run, so that tool, spindle, datum, plane, parameters, loops
and calls are those of the run. A second pass starts at other axis positions. An axis with a different
position in that pass was not positioned by the program, and the line is rejected unless the axis has never
moved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isclose

from core.interpreter.dialects import ReadProgram
from core.interpreter.restart.cut_record import CutRecord, record_cuts
from core.interpreter.restart.restart_point import Interruption, LineVisit, NoRestart, RestartPoint
from core.interpreter.restart.restart_retract import NEAR, Retract, ToolPlace
from core.interpreter.restart.state_rebuild import found_on_lathe, in_uncut_material
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import Interpretation
from core.interpreter.shared.job_setup import Setup
from core.message import Message

Watch = Callable[[float], None]

_ASIDE = 7.3  # mm or degrees; shift of the second start position, which no program positions by chance
_SAME = 1e-6
_TRIED = 5  # number of lines that are tried on each side of an unsuitable line
_SLIDES = 3  # number of linear axes of a mill, which precede its rotary axes
_WATCHED = 2000  # number of blocks between two calls of ``watch``


@dataclass(slots=True)
class _LinesOfRun:
    """Visits of all lines in a whole run: by line, the number of blocks before each visit."""

    visits: dict[int, list[int]] = field(default_factory=dict)
    waits: dict[int, str] = field(default_factory=dict)  # reason why a line is unsuitable at its first visit
    ended: int = 0  # line of the program end


class ProgramSearch:
    """Search in one program with a fixed setup.

    ``watch`` receives the number of blocks and may raise an exception to cancel the search.
    """

    def __init__(self, reading: ReadProgram, setup: Setup, watch: Watch) -> None:
        self._reading = reading
        self._setup = replace(setup, begin=None, inputs=lambda _terminal: False)
        self.watch = watch
        self._count = 0

    @cached_property
    def cut(self) -> CutRecord:
        """Record of all cuts of the program on a lathe, calculated on first use."""
        return record_cuts(self._pass().series(), self.watch)

    def find(self, line: int, visit: int = 0, broken: Interruption | None = None) -> RestartPoint | NoRestart:
        """Return the restart point of a line at its ``visit``-th execution, or why a restart is not possible.

        A ``visit`` of 0 is the interrupted pass, or the first one. ``broken`` is the interruption of the
        program.
        """
        found = self._search(line, visit, broken)
        if isinstance(found, RestartPoint):
            return found
        return NoRestart(line, found, self._nearest(line, -1, broken), self._nearest(line, 1, broken))

    # --- going through the program ------------------------------------------------------------------------

    def _pass(self, aside: float = 0.0) -> Interpretation:
        start = tuple(at + aside for at in self._setup.start)
        return self._reading.begin(replace(self._setup, start=start))

    def _watched(self, blocks: Iterator[Block]) -> Iterator[Block]:
        for block in blocks:
            self._count += 1
            if self._count % _WATCHED == 0:
                self.watch(self._count)
            yield block

    @cached_property
    def _run(self) -> _LinesOfRun:
        told, run, made = _LinesOfRun(), self._pass(), 0

        def see(line: int) -> bool:
            told.visits.setdefault(line, []).append(made)
            told.waits.setdefault(line, run.waits_for)
            return False

        run.stop_before = see
        for block in self._watched(run.blocks(to_first_error=True)):
            made = block.n
            if isinstance(block.action, ProgramEnd):
                told.ended = block.line
        return told

    def _to(self, line: int, number: int, aside: float, broken: Interruption | None) -> _Stand:
        """Return the state of a pass at the ``number``-th execution of a line."""
        run, stand, left = self._pass(aside), _Stand(), number

        def stop(at: int) -> bool:
            nonlocal left
            left -= at == line
            return not left

        run.stop_before = stop
        for block in self._watched(run.blocks(to_first_error=True)):
            stand.see(block, uncut=broken is not None and _is_uncut(block, broken))
        stand.failed = run.failed or not run.stopped_before
        stand.waits = run.waits_for
        if not stand.failed and not stand.waits:
            stand.point = run.checkpoint
        return stand

    # --- the result ---------------------------------------------------------------------------------------

    def _search(self, line: int, visit: int, broken: Interruption | None) -> RestartPoint | str:
        lines = self._reading.source.lines
        if not 1 <= line <= len(lines):
            return Message(
                "Line {line} does not exist; the last line of the program is {lines_count}.",
                line=line,
                lines_count=len(lines),
            )
        visits = self._run.visits.get(line, [])
        if not visits:
            return self._why_never(line)
        number = visit or max(1, sum(made < broken.block for made in visits) if broken is not None else 1)
        if number > len(visits):
            return Message(
                "The program reaches line {line} only {visits_count} times.",
                line=line,
                visits_count=len(visits),
            )
        here = self._to(line, number, 0.0, broken)
        other = self._to(line, number, _ASIDE, None)
        if here.failed or here.point is None:
            return Message(
                "The program cannot resume at line {line}: {waits}.",
                line=line,
                waits=here.waits or "the program has errors before this line",
            )
        at = self._places(here.point, other.point)
        if isinstance(at, str):
            return Message("The program cannot resume at line {line}: {position}", line=line, position=at)
        return self._good(line, here, at, LineVisit(number, len(visits)), broken)

    def _why_never(self, line: int) -> str:
        ended = self._run.ended
        if ended and line > ended:
            return Message("The program ends on line {ended}, before line {line}.", ended=ended, line=line)
        return Message(
            "Line {line} is empty, is a comment, is part of the previous block, or is never "
            "reached by the program.",
            line=line,
        )

    def _places(self, here: Checkpoint, other: Checkpoint | None) -> tuple[float | None, ...] | str:
        """Return machine positions, with None for an axis that has not moved; or why they are unknown."""
        if other is None:
            return "the program before this line depends on the axis positions at Cycle Start."
        found: list[float | None] = []
        for place, start in enumerate(self._setup.start):
            a, b = _at(here)[place], _at(other)[place]
            if isclose(a, b, abs_tol=_SAME):
                found.append(a)
            elif isclose(a, start, abs_tol=_SAME) and isclose(b, start + _ASIDE, abs_tol=_SAME):
                found.append(None)
            else:
                axis = self._axes[place]
                return Message(
                    "the position of {axis} at this line depends on its position at Cycle Start.", axis=axis
                )
        if all(each is None for each in found):
            return "no axis has moved before this line; start the program from its first line."
        return tuple(found)

    @property
    def _axes(self) -> tuple[str, ...]:
        kinematics = self._setup.kinematics
        return ("X", "Z", "C") if kinematics is None else kinematics.names

    def _good(
        self,
        line: int,
        here: _Stand,
        at: tuple[float | None, ...],
        visit: LineVisit,
        broken: Interruption | None,
    ) -> RestartPoint | str:
        assert here.point is not None
        point = here.point
        if self._setup.kinematics is None:
            free = (place for place, each in zip("xzc", at, strict=True) if each is None and place != "c")
            if lost := next(free, ""):
                return Message(
                    "The program cannot resume at line {line} because {lost} is not positioned before "
                    "that line.",
                    line=line,
                    lost=lost.upper(),
                )
            own_c = at[2] is not None and not self._setup.limits.spindle_is_c
            turned = point._replace(at=_at(point)) if own_c else point
            return found_on_lathe(line, turned, self.cut, visit, broken)
        skipped = here.left_out or (0, 0)
        first, last = min(skipped), max(skipped)  # a loop can end on an earlier line
        if here.left_out and not here.above(point):
            return in_uncut_material(line, first, last)
        clear = Retract(ToolPlace.CLEAR)
        return RestartPoint(line, point, clear, None, visit, left_out=(first, last), axes=at)

    def _nearest(self, line: int, way: int, broken: Interruption | None) -> int:
        """Return the nearest suitable line in one direction, or 0 if none of the first few lines is suitable.

        Each line is checked like a requested line.
        """
        near = [each for each, why in self._run.waits.items() if not why and (each - line) * way > 0]
        near.sort(key=lambda each: abs(each - line))
        good = (each for each in near[:_TRIED] if isinstance(self._search(each, 0, broken), RestartPoint))
        return next(good, 0)


@dataclass(slots=True)
class _Stand:
    """State of a pass.

    ``cutting`` means that the last move was a feed, and ``left_out`` are the first and last line of skipped
    cuts.
    """

    point: Checkpoint | None = None
    waits: str = ""
    failed: bool = False
    cutting: bool = False
    length: float = 0.0  # tool length, mm
    top: float = -inf  # machine Z of the tip at the start of the highest skipped cut, mm
    turned: bool = False  # a skipped cut moves rotary axes, so that heights cannot be compared
    left_out: tuple[int, int] | None = None

    def see(self, block: Block, *, uncut: bool) -> None:
        """Process the next block of the pass; ``uncut`` means that its cut is missing or incomplete."""
        if block.swivel is not None:
            self.length = block.swivel.system.tool_length
        if not block.moves:
            return
        self.cutting = not block.rapid
        if self.cutting and uncut:
            first = self.left_out[0] if self.left_out is not None else block.line
            self.left_out = first, block.line
            if block.travel is not None:
                self.turned = self.turned or block.swivels or block.travel.way is not None
                tip = block.travel.start[2] - self.length
                self.top = max(self.top, tip)

    def above(self, point: Checkpoint) -> bool:
        """Return whether the position was reached in rapid and is not below the start of a skipped cut."""
        return not (self.cutting or self.turned) and point.at[2] - self.length >= self.top - _SAME


def _is_uncut(block: Block, broken: Interruption) -> bool:
    """Return whether the cut of a block was not begun, or was interrupted before its end.

    A closed block, such as a full circle, counts as uncut, because its end does not show how far it was cut.
    """
    if block.n != broken.block or block.travel is None:
        return block.n > broken.done
    travel = block.travel
    if travel.length > NEAR and _is_same_place(travel.start, travel.end):
        return True
    return block.n > broken.done or not _is_same_place(broken.at, travel.end)


def _is_same_place(one: Sequence[float], other: Sequence[float]) -> bool:
    """Return whether two machine positions agree; whole revolutions of the rotary axes are ignored."""
    offs = [b - a for a, b in zip(one, other, strict=False)]
    turned = [(each + 180.0) % 360.0 - 180.0 for each in offs[_SLIDES:]]
    return all(abs(each) <= NEAR for each in (*offs[:_SLIDES], *turned))


def _at(point: Checkpoint) -> tuple[float, ...]:
    """Return the machine positions of all axes."""
    return point.at or (*point.machine, point.c + point.modal.offset_c)
