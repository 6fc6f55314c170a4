"""Data for a report from the proving pass: moves, times by tool, stops and material."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from core.interpreter.shared.actions import ProgramStop
from core.interpreter.shared.elementary_blocks import Block, TimedSeries
from core.interpreter.shared.working_plane import Corners
from core.part.turned_part import Piece
from core.proving.part_proof import PartProof
from core.proving.program_timeline import MotionSpan, RestSpan
from core.proving.program_tools import PartSetting
from core.proving.tip_moves import LiveStep, Steps, TipMove, live_move

MOST_MOVES = 20_000  # maximum number of drawn moves
_MOST_STOPS = 500


@dataclass(slots=True)
class ToolTime:
    """Times of one tool in seconds: cutting, rapid and rest."""

    cutting: float = 0.0
    rapid: float = 0.0
    rest: float = 0.0

    @property
    def total(self) -> float:
        """Total time in seconds."""
        return self.cutting + self.rapid + self.rest


@dataclass(frozen=True, slots=True)
class Stop:
    """Program stop M00, or M01 if ``optional``: line, time in seconds and message to the operator."""

    line: int
    at: float
    optional: bool
    message: str


@dataclass(slots=True)
class RunRecord:
    """Recorder of the spans of a proving pass."""

    setting: PartSetting
    moves: list[TipMove] = field(default_factory=list)
    times: dict[int, ToolTime] = field(default_factory=dict)
    stops: list[Stop] = field(default_factory=list)
    secondary: set[int] = field(default_factory=set)  # D numbers that are called
    settable: set[int] = field(default_factory=set)  # zero offsets that are called, 54 to 59
    blank: Corners | None = None  # corners of BLK FORM on a mill
    cut_short: bool = False  # not all moves are drawn
    _steps: Steps = field(default_factory=Steps)
    _part: PartProof = field(init=False)
    _tool: int = 0

    def __post_init__(self) -> None:
        self._part = PartProof(self.setting)

    def see(self, span: MotionSpan | RestSpan) -> None:
        """Add the moves, times and stops of the next span of the program."""
        self._part.see(span)
        for each in span.times_of_parts():
            if isinstance(each, TimedSeries):
                self._count(each.series.pattern, float((each.t1 - each.t0).sum()))
            else:
                block, t0, t1 = each
                self._count(block, t1 - t0)
                self._stop(block, t0)
        if isinstance(span, MotionSpan):
            self._draw(span)
        elif span.block is not None:
            list(self._steps.of([span.block]))
        else:
            self._time.rest += span.t1 - span.t0

    @property
    def _time(self) -> ToolTime:
        return self.times.setdefault(self._tool, ToolTime())

    def _count(self, block: Block, seconds: float) -> None:
        modal = block.modal
        self._tool = modal.tool
        self.secondary |= {modal.secondary} - {0}
        self.settable |= {modal.settable} - {0}
        if block.swivel is not None:
            self.blank = block.swivel.system.blank
        time = self._time
        if not block.moves:
            time.rest += seconds
        elif block.rapid:
            time.rapid += seconds
        else:
            time.cutting += seconds

    def _stop(self, block: Block, at: float) -> None:
        action = block.action
        if isinstance(action, ProgramStop) and len(self.stops) < _MOST_STOPS:
            self.stops.append(Stop(block.line, at, action.optional, action.message))

    def _draw(self, span: MotionSpan) -> None:
        for part in span.parts:
            if len(self.moves) > MOST_MOVES:
                self.cut_short = True
                return
            for step in self._steps.of(part):
                if isinstance(step, TipMove):
                    self.moves.append(step)
                elif isinstance(step, LiveStep):
                    self.moves.append(live_move(step))

    def metal_at(self, blocks: Collection[int]) -> dict[int, Piece]:
        """Return the material before each of these blocks, if a tool moved in X and Z."""
        return self._part.metal_at(blocks)
