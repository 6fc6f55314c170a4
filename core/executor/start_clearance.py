"""The verdict on the first move of a start: does it meet the part, the chuck or the tailstock.

The executor computes no geometry. A worker of the screen computes the verdict for one job at one position of
the axes and posts it; the executor only compares. A verdict for another position is no verdict.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

SAME: Final = 0.01  # mm: a verdict for a position farther away than this does not count

UNCHECKED: Final = "start-unchecked"
INSIDE: Final = "tool-in-part"
CROSSES: Final = "first-move-crosses"


@dataclass(frozen=True, slots=True)
class Clearance:
    """The verdict on a start of the job with this digest, with the axes at ``at`` (machine mm).

    ``begun`` is the number of runs that had begun by then: a run may change the part. ``code`` is ``INSIDE``
    or ``CROSSES`` where the start is refused, with the sentence ``why``; both are empty where it is clear.
    ``warned`` is announced before the start: the part is not known, or is assumed. ``repeats`` marks the
    position at which the program ends, from which Cycle Repeat begins.
    """

    job: str
    at: tuple[float, ...]
    begun: int
    code: str = ""
    why: str = ""
    warned: str = ""
    repeats: bool = False

    def applies_to(self, job: str, at: Sequence[float], begun: int) -> bool:
        """Return whether this is the verdict on a start of this job here and now."""
        if self.job != job or (self.begun != begun and not self.repeats):
            return False
        return all(abs(a - b) <= SAME for a, b in zip(self.at, at, strict=False))


def verdict(
    known: Iterable[Clearance], job: str, at: Sequence[float], begun: int, *, repeats: bool = False
) -> Clearance | None:
    """Return the verdict on this start, None: it has not been computed yet."""
    found = (each for each in known if each.repeats is repeats and each.applies_to(job, at, begun))
    return next(found, None)
