"""What became of the stock, and what went wrong on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.language.diagnostics import Diagnostic
from core.part.stock import Stock
from core.part.tool_shape import ToolShape
from core.part.turned_part import Piece


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
