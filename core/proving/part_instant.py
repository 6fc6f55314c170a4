"""The part at one time of a program, as it is shown: section, tool, what was hit.

Arrays of their own, which another thread may keep.
"""

from __future__ import annotations

from typing import NamedTuple

from core.language.diagnostics import Diagnostic
from core.part.clamping import Clamping
from core.part.solid_bodies import Round
from core.part.stock import Stock
from core.part.swept_edge import FloatArray, Point


class Half(NamedTuple):
    """One side of the section: ``edges`` (columns + 1,) of Z, rising; metal from ``low`` to ``high`` (layers,
    columns), radii; mm."""

    edges: FloatArray
    low: FloatArray
    high: FloatArray


class Hit(NamedTuple):
    """Metal that was met where nothing may be met: ``finding``, and from ``low`` to ``high`` at each ``z``
    (n,), ``wide`` mm of Z each."""

    finding: Diagnostic
    z: FloatArray
    low: FloatArray
    high: FloatArray
    wide: float


class PlacedTool(NamedTuple):
    """A tool where it stands: its control point ``at``, its outlines (k, 2) of Z and r, mm.

    ``assumed``: nobody has described it, its body is what such tools have. ``round``: about which axis it is.
    """

    number: int
    at: Point
    cutting: tuple[FloatArray, ...]
    body: tuple[FloatArray, ...]
    assumed: bool
    round: Round = Round.NOT


class PartInstant(NamedTuple):
    """The part when ``block`` blocks are done and ``share`` of the next.

    ``near`` is the side of the section at X+, ``far`` that beyond the axis; None: there is no metal.
    ``hits`` and ``findings`` are those that have come up by then. ``reach`` is how far the tip may go, from
    and to which Z and r.
    """

    block: int
    share: float
    line: int
    near: Half | None
    far: Half | None
    stock: Stock | None
    tool: PlacedTool | None
    hits: tuple[Hit, ...]
    findings: tuple[Diagnostic, ...]
    pieces: int
    clamping: Clamping | None = None
    is_open: bool = False
    reach: tuple[Point, Point] | None = None
    c: float = 0.0  # degrees at which the part is held, or was last
