"""Words of parsed Klartext blocks, such as values, axis words, feeds and M functions."""

from __future__ import annotations

from typing import NamedTuple

from core.language.formulas import Formula, Number, Operation, Parameter


class Value(NamedTuple):
    """A number, or a reference to a parameter Q, QL or QR, with its column from 1."""

    number: float
    parameter_number: int | None = None
    is_negative: bool = False  # the sign before Q
    column: int = 0
    parameter_kind: str = "Q"

    @property
    def as_formula(self) -> Formula:
        """Return the value as a formula."""
        if self.parameter_number is None:
            return Number(self.number)
        made = Parameter(self.parameter_kind, self.parameter_number, self.column)
        return Operation("negative", (made,), self.column) if self.is_negative else made


class AxisWord(NamedTuple):
    """An axis word such as ``X+10`` or ``IX+10``."""

    axis: str
    value: Value
    is_incremental: bool = False
    column: int = 0


class FeedWord(NamedTuple):
    """A feed such as ``F200``, ``FQ5``, ``FMAX`` or ``F AUTO``.

    ``FU0.1`` is a feed per revolution, and ``FZ0.05`` is a feed per tooth.
    """

    feed_kind: str  # "value", "max" or "auto"
    value: Value | None = None
    column: int = 0
    feed_unit_letter: str = ""  # U or Z; empty: a minute, under M136 a revolution


class RetractWord(NamedTuple):
    """A retract distance such as ``MB50``; the distance is None for ``MB MAX``."""

    distance: Value | None = None
    column: int = 0


class MFunction(NamedTuple):
    """An M function such as ``M3``.

    M128 can have a feed, M103 can have a factor, and M140 can have a retract and a feed.
    """

    number: int
    column: int = 0
    retract: RetractWord | None = None
    feed: FeedWord | None = None
