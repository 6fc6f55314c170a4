"""What was found of the first move of a start: the verdicts, and the legs that are drawn."""

from __future__ import annotations

from typing import NamedTuple

from core.executor.commands import Clearance

Legs = tuple[tuple[float, float, bool], ...]
"""A path in machine X and Z, mm, with whether each leg is a rapid."""


class FirstMoveSeen(NamedTuple):
    """The answer to one question: the verdict here and that of Cycle Repeat, and the legs that are drawn.

    ``zero`` is machine X and Z, mm, with the tip for which they are drawn on part zero.
    """

    verdicts: tuple[Clearance, ...]
    legs: Legs = ()
    zero: tuple[float, float] = (0.0, 0.0)

    @property
    def clearance(self) -> Clearance:
        """The verdict on a start from where the axes are."""
        return self.verdicts[0]
