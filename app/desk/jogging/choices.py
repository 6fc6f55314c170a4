"""Which step and which speed a hand move has: any change ends what is held."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.jogging.hold import JogHold
from app.desk.jogging.speeds import Speeds
from app.desk.words import tr


@dataclass(slots=True)
class Choices:
    """Of the Jog page; ``armed``: the next finger that holds goes rapid."""

    speeds: Speeds = field(init=False)
    hold: JogHold = field(init=False)
    armed: bool = field(init=False, default=False)

    def next_step(self) -> None:
        """F2: another increment ends what is held."""
        self._another_step()
        self.speeds.next_step()

    def choose_step(self, step: int) -> None:
        """A finger on one of the steps."""
        self._another_step()
        self.speeds.step, self.armed = step, False

    def next_speed(self) -> None:
        """F3: another speed ends what is held."""
        self._another_speed()
        self.speeds.next_speed()

    def choose_speed(self, speed: int) -> None:
        """A finger on one of the speeds."""
        self._another_speed()
        self.speeds.speed, self.armed = speed, False

    def arm(self) -> None:
        """A finger on RAPID: the next hold goes rapid, and only that one."""
        self._another_speed()
        self.armed = not self.armed

    def finger(self, source: str, axis: str, sign: int) -> None:
        """A finger or the mouse goes down on a direction."""
        rapid, self.armed = self.armed, False
        self.hold.press(source, axis, sign, rapid=rapid)

    def _another_step(self) -> None:
        self.hold.let_go(tr("ANOTHER STEP WAS CHOSEN: THE JOG HAS ENDED"))

    def _another_speed(self) -> None:
        self.hold.let_go(tr("ANOTHER SPEED WAS CHOSEN: THE JOG HAS ENDED"))
