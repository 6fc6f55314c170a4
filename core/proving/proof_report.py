"""What proving found, and what became of the stock: figures in mm and seconds, X a radius."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from core.interpreter.shared.machine_requirements import Need
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect
from core.part.stock import Stock
from core.part.tool_shape import ToolShape
from core.part.turned_part import Piece

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import Swivel


Range = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Times:
    """Seconds, together the cycle time. ``wait`` is for spindle, collet and the start of each motion."""

    cutting: float = 0.0
    rapid: float = 0.0
    dwell: float = 0.0
    wait: float = 0.0

    @property
    def cycle(self) -> float:
        """The whole cycle; waits of M00 and M01 are the operator's and not in it."""
        return self.cutting + self.rapid + self.dwell + self.wait


@dataclass(frozen=True, slots=True)
class Reach:
    """What the program reaches: program frame, rpm unsigned, feed in mm/s along the path."""

    x: Range = (0.0, 0.0)
    z: Range = (0.0, 0.0)
    c: Range = (0.0, 0.0)
    rpm: Range = (0.0, 0.0)
    feed: Range = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class MillFigures:
    """What a program does on a mill: its axes in order, the machine positions that each of them reaches, and
    where the last block stands in its working plane; None where there was no block.
    """

    axes: tuple[str, ...]
    reach: tuple[Range, ...]
    final: Swivel | None


@dataclass(frozen=True, slots=True)
class Ways:
    """The ways through a program, by its inputs and with block delete on and off.

    ``cycle`` is the least and the greatest cycle time of them, s; ``unproved`` counts those not gone through.
    """

    proved: int = 1
    unproved: int = 0
    cycle: Range = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Report:
    """One program, proved. Figures cover what could be interpreted when there are errors."""

    name: str
    dialect: Dialect
    metric: bool
    blocks: int
    elementary: int
    diagnostics: tuple[Diagnostic, ...]
    times: Times
    cutting_length: float
    rapid_length: float
    tools: tuple[int, ...]
    missing_tools: tuple[int, ...]
    reach: Reach
    final: tuple[float, float, float]  # program frame
    machine_final: tuple[float, ...]
    mill: MillFigures | None = None
    needs: tuple[Need, ...] = ()
    ways: Ways = field(default_factory=Ways)
    stops: int = 0  # M00
    optional_stops: int = 0  # M01
    corner_tolerance: float = 0.0  # mm that the machine file allows where chords meet; 0: rounding alone

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """The diagnostics that refuse the run."""
        return tuple(d for d in self.diagnostics if d.severity is Severity.ERROR)


def in_order(found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Findings in the order of lines and columns."""
    return tuple(sorted(found, key=lambda each: (each.line, each.column)))


@dataclass(frozen=True, slots=True)
class PartReport:
    """What became of the stock: mm and mm³. ``last`` is the last part that came off, or what the chuck holds.

    ``shapes`` are the tools by T, described or assumed, None where nothing is known that would cut.
    ``assumed`` are sentences, one for each thing that nobody has said, ``unchecked`` what could not be looked
    at for want of it.
    """

    stock: Stock | None
    volume: float
    removed: float
    left: float
    last: Piece | None
    milled: bool
    pieces: tuple[Piece, ...]
    assumed: tuple[str, ...]
    findings: tuple[Diagnostic, ...]
    unchecked: tuple[str, ...] = ()
    shapes: Mapping[int, ToolShape | None] = field(default_factory=dict)
    sides: tuple[Piece, Piece] | None = None
