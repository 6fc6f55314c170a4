"""Wear of a simulated slide: a loose gib, and an encoder that counts wrongly once a turn of the screw."""

from __future__ import annotations

import math

_CREEP = 2.0  # mm/s; slower than this a loose slide sticks and slips
_STICKS = 0.25  # of the play by which the screw winds up further before a slide that sticks breaks loose
TURN = 5.0  # mm of slide for one turn of its screw


class WornAxis:
    """What is wrong between the motor and the place that is told.

    With a loose gib the drive still goes by its motor, but what is measured is the slide: it stays behind by
    half of the play whichever way it goes, so a reversal loses all of it. Below 2 mm/s it sticks until the
    screw has wound up a quarter of the play more, then slips to where it belongs.

    A bad encoder deceives the drive as well. ``ripple`` is the amplitude of an error that comes once a turn,
    as of a disc that is not centred; ``missed`` is what is not counted at one spot of each turn.
    """

    def __init__(self) -> None:
        self.gib = 0.0  # mm of play
        self.ripple = 0.0  # mm
        self.missed = 0.0  # mm
        self.turn = TURN
        self.slide = 0.0  # where the slide is, while the gib is loose

    @property
    def deceives(self) -> bool:
        """Whether the drive is told another place than its motor's."""
        return self.ripple != 0.0 or self.missed != 0.0

    def loosen(self, play: float, p: float) -> None:
        """The gib has ``play`` mm from now on, with the slide at ``p``; 0 sets it again."""
        self.gib, self.slide = play, p

    def counted(self, p: float) -> float:
        """What the encoder says of a motor at ``p``."""
        turns = p / self.turn
        return p + self.ripple * math.sin(2.0 * math.pi * turns) - self.missed * math.floor(turns)

    def carry(self, p: float, v: float) -> None:
        """The motor is at ``p`` now, at the velocity ``v``, and takes the slide along."""
        play = 0.5 * self.gib
        behind = p - self.slide
        if abs(behind) > play * (1.0 + 2.0 * _STICKS if abs(v) < _CREEP else 1.0):
            self.slide = p - math.copysign(play, behind)
