"""Result types of a program proof and of its part, in mm and seconds with X as a radius."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from core.interpreter.shared.machine_requirements import MachineRequirement
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect
from core.part.stock import Stock
from core.part.tool_shape import ToolShape
from core.part.turned_part import PartedPiece

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import PlanePosition


ValueRange = tuple[float, float]


@dataclass(frozen=True, slots=True)
class ProgramTimes:
    """Times in seconds whose sum is the cycle time.

    ``wait_time_s`` is the time for the spindle, the collet and the start of each motion.
    """

    cutting_time_s: float = 0.0
    rapid_time_s: float = 0.0
    dwell_time_s: float = 0.0
    wait_time_s: float = 0.0

    @property
    def cycle_time_s(self) -> float:
        """Return the cycle time in seconds.

        Waits for the operator at M00 and M01 are not included.
        """
        return self.cutting_time_s + self.rapid_time_s + self.dwell_time_s + self.wait_time_s


@dataclass(frozen=True, slots=True)
class ProgramRanges:
    """The ranges that the program uses.

    Positions are in the program's frame, spindle speeds are unsigned rpm, and path feeds are in mm/s.
    """

    x_range: ValueRange = (0.0, 0.0)
    z_range: ValueRange = (0.0, 0.0)
    c_range: ValueRange = (0.0, 0.0)
    rpm_range: ValueRange = (0.0, 0.0)
    feed_range: ValueRange = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class MillResults:
    """The results of a program on a mill.

    ``axis_names`` is the order of the axes, and ``axis_ranges`` are their ranges in machine positions.
    ``final_position`` is the end of the last block in its working plane, or None without a block.
    """

    axis_names: tuple[str, ...]
    axis_ranges: tuple[ValueRange, ...]
    final_position: PlanePosition | None


@dataclass(frozen=True, slots=True)
class BranchSummary:
    """The paths through a program that result from its inputs and from block delete on and off.

    ``cycle_time_range`` is the shortest and the longest cycle time of the paths in seconds.
    ``unproved_count`` is the number of paths that were not proved.
    """

    proved_count: int = 1
    unproved_count: int = 0
    cycle_time_range: ValueRange = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ProofReport:
    """The proof of one program.

    If the program has errors, the values cover only the part of the program that could be interpreted.
    """

    name: str
    dialect: Dialect
    is_metric: bool
    block_count: int
    elementary_block_count: int
    diagnostics: tuple[Diagnostic, ...]
    program_times: ProgramTimes
    cutting_length_mm: float
    rapid_length_mm: float
    tool_numbers: tuple[int, ...]
    missing_tool_numbers: tuple[int, ...]
    program_ranges: ProgramRanges
    final_position: tuple[float, float, float]  # program frame
    machine_final_position: tuple[float, ...]
    mill_results: MillResults | None = None
    required_functions: tuple[MachineRequirement, ...] = ()
    branch_summary: BranchSummary = field(default_factory=BranchSummary)
    stop_count: int = 0  # M00
    optional_stop_count: int = 0  # M01
    # mm of deviation that the machine file permits at joints of chords; 0: only rounding
    corner_tolerance_mm: float = 0.0

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """Return the diagnostics that prevent a start."""
        return tuple(d for d in self.diagnostics if d.severity is Severity.ERROR)


def sort_findings(findings: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the findings in the order of their lines and columns."""
    return tuple(sorted(findings, key=lambda each: (each.line, each.column)))


@dataclass(frozen=True, slots=True)
class PartReport:
    """The results of the part, in mm and mm³.

    ``last_piece`` is the last piece that was parted off, or the material in the chuck. ``tool_shapes`` are
    the tool shapes by T number, specified or assumed; a shape is None if no cutting shape is known.
    ``assumptions`` contains a sentence for each assumption, and ``unchecked_data`` lists the missing data
    that prevented checks.
    """

    stock: Stock | None
    stock_volume_mm3: float
    removed_volume_mm3: float
    remaining_volume_mm3: float
    last_piece: PartedPiece | None
    is_milled: bool
    parted_pieces: tuple[PartedPiece, ...]
    assumptions: tuple[str, ...]
    findings: tuple[Diagnostic, ...]
    unchecked_data: tuple[str, ...] = ()
    tool_shapes: Mapping[int, ToolShape | None] = field(default_factory=dict)
    section_halves: tuple[PartedPiece, PartedPiece] | None = None
