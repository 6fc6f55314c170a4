"""Data that the proving pass collects for a report: moves, times by tool, stops and material."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from core.interpreter.shared.actions import ProgramStop
from core.interpreter.shared.elementary_blocks import Block, TimedSeries
from core.interpreter.shared.working_plane import BlankCorners
from core.part.turned_part import PartedPiece
from core.proving.part_proof import PartProof
from core.proving.program_timeline import MotionSpan, RestSpan
from core.proving.program_tools import PartSettings
from core.proving.tip_moves import LiveToolStep, StepConverter, TipMove, make_live_tool_move

MAX_MOVES = 20_000  # maximum number of drawn moves
_MAX_STOPS = 500


@dataclass(slots=True)
class ToolTimes:
    """Times of one tool in seconds: cutting, rapid and other time."""

    cutting_s: float = 0.0
    rapid_s: float = 0.0
    other_s: float = 0.0

    @property
    def total_time_s(self) -> float:
        """Return the total time in seconds."""
        return self.cutting_s + self.rapid_s + self.other_s


@dataclass(frozen=True, slots=True)
class PlannedStop:
    """Program stop M00, or M01 if ``is_optional`` is True.

    It has a line number, a time in seconds and a message to the operator.
    """

    line_number: int
    time_s: float
    is_optional: bool
    message: str


@dataclass(slots=True)
class ReportRecorder:
    """Recorder of the data for a report.

    It collects the data from the time spans that a proving pass produces.
    """

    part_settings: PartSettings
    tip_moves: list[TipMove] = field(default_factory=list)
    tool_times: dict[int, ToolTimes] = field(default_factory=dict)
    program_stops: list[PlannedStop] = field(default_factory=list)
    used_secondary_offsets: set[int] = field(default_factory=set)  # D numbers that are called
    used_zero_offsets: set[int] = field(default_factory=set)  # zero offsets that are called, 54 to 59
    blank_corners: BlankCorners | None = None  # corners of BLK FORM on a mill
    is_truncated: bool = False  # not all moves are drawn
    _steps: StepConverter = field(default_factory=StepConverter)
    _part: PartProof = field(init=False)
    _tool: int = 0

    def __post_init__(self) -> None:
        self._part = PartProof(self.part_settings)

    def add_time_span(self, span: MotionSpan | RestSpan) -> None:
        """Add the moves, times and stops of the next time span."""
        self._part.add_span(span)
        for each in span.iter_group_times():
            if isinstance(each, TimedSeries):
                self._count(each.series.pattern, float((each.end_times_s - each.start_times_s).sum()))
            else:
                block, t0, t1 = each
                self._count(block, t1 - t0)
                self._stop(block, t0)
        if isinstance(span, MotionSpan):
            self._draw(span)
        elif span.block is not None:
            list(self._steps.convert_blocks([span.block]))
        else:
            self._time.other_s += span.end_time_s - span.start_time_s

    @property
    def _time(self) -> ToolTimes:
        return self.tool_times.setdefault(self._tool, ToolTimes())

    def _count(self, block: Block, seconds: float) -> None:
        modal = block.modal
        self._tool = modal.tool
        self.used_secondary_offsets |= {modal.secondary} - {0}
        self.used_zero_offsets |= {modal.settable} - {0}
        if block.swivel is not None:
            self.blank_corners = block.swivel.system.blank_corners
        time = self._time
        if not block.moves:
            time.other_s += seconds
        elif block.rapid:
            time.rapid_s += seconds
        else:
            time.cutting_s += seconds

    def _stop(self, block: Block, at: float) -> None:
        action = block.action
        if isinstance(action, ProgramStop) and len(self.program_stops) < _MAX_STOPS:
            self.program_stops.append(PlannedStop(block.line, at, action.optional, action.message))

    def _draw(self, span: MotionSpan) -> None:
        for part in span.block_groups:
            if len(self.tip_moves) > MAX_MOVES:
                self.is_truncated = True
                return
            for step in self._steps.convert_blocks(part):
                if isinstance(step, TipMove):
                    self.tip_moves.append(step)
                elif isinstance(step, LiveToolStep):
                    self.tip_moves.append(make_live_tool_move(step))

    def find_material_before_blocks(self, block_numbers: Collection[int]) -> dict[int, PartedPiece]:
        """Return the material before each of the given blocks.

        Blocks without X or Z motion are omitted.
        """
        return self._part.find_material_before_blocks(block_numbers)
