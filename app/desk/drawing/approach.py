"""The way by which the tool goes back to a place in the middle of a program, leg by leg."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Leg:
    """One straight move to (z, x) in the part's frame (machine less tool offset); mm, X a radius.

    ``label`` tells what it is and when: ``1 X``, ``2 Z``. The first leg is where the tool stands now; its
    ``rapid`` means nothing.
    """

    z: float
    x: float
    rapid: bool = True
    label: str = ""
