"""Results of a proof and of the part, in mm and seconds with X as a radius."""

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
    """Times in seconds that add up to the cycle time.

    ``wait`` is the time for spindle, collet and the start of each motion.
    """

    cutting: float = 0.0
    rapid: float = 0.0
    dwell: float = 0.0
    wait: float = 0.0

    @property
    def cycle(self) -> float:
        """The cycle time. Waits for the operator at M00 and M01 are not included."""
        return self.cutting + self.rapid + self.dwell + self.wait


@dataclass(frozen=True, slots=True)
class Reach:
    """The ranges that the program uses: program frame, unsigned rpm, and path feed in mm/s."""

    x: Range = (0.0, 0.0)
    z: Range = (0.0, 0.0)
    c: Range = (0.0, 0.0)
    rpm: Range = (0.0, 0.0)
    feed: Range = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class MillFigures:
    """The results of a program on a mill.

    ``axes`` is the order of the axes, and ``reach`` their ranges in machine positions. ``final`` is the end
    of the last block in its working plane, or None without a block.
    """

    axes: tuple[str, ...]
    reach: tuple[Range, ...]
    final: Swivel | None


@dataclass(frozen=True, slots=True)
class Ways:
    """The paths through a program, by its inputs and by block delete on and off.

    ``cycle`` is the least and the greatest cycle time of the paths in seconds. ``unproved`` is the number of
    paths that were not proved.
    """

    proved: int = 1
    unproved: int = 0
    cycle: Range = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Report:
    """The proof of one program. If it has errors, the values cover only what could be interpreted."""

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
    # mm of deviation that the machine file permits at joints of chords; 0: only rounding
    corner_tolerance: float = 0.0

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """The diagnostics that prevent a start."""
        return tuple(d for d in self.diagnostics if d.severity is Severity.ERROR)


def in_order(found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return the findings in the order of lines and columns."""
    return tuple(sorted(found, key=lambda each: (each.line, each.column)))


@dataclass(frozen=True, slots=True)
class PartReport:
    """The results of the part, in mm and mm³.

    ``last`` is the last piece that was parted off, or the material in the chuck. ``shapes`` are the tools by
    T, specified or assumed, or None if no cutting shape is known. ``assumed`` contains a sentence for each
    assumption, and ``unchecked`` the checks that lacked data.
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
