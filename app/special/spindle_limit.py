"""The maximum spindle speed until restart."""

from __future__ import annotations

from collections.abc import Mapping

from app.desk.arithmetic import EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.status import formats
from app.desk.status.readouts import UNKNOWN
from app.desk.translation import tr
from app.special.special_functions import FigureFunction
from core.access.access_table import Act
from core.executor.commands import SpindleLimit
from core.executor.snapshot import Snapshot
from core.machine.machine_model import SpindleModel
from core.message import Message
from core.ports import Unknown

LIFT = "PRESS Y TO REMOVE THE LIMIT, N TO KEEP IT"


class SpindleSpeedLimit(FigureFunction):
    """A limit for this workpiece, chuck or bar: it is gone when the control is started again."""

    name = "MAXIMUM SPINDLE SPEED"
    use = "spindle speed limit until restart"

    def __init__(self, desk: Desk, spindle: SpindleModel) -> None:
        super().__init__(desk)
        self.spindle = spindle

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """The machine's speed, the limit, and what turns now."""
        limit = snapshot.spindle_limit
        rows = (
            Row(("MACHINE MAXIMUM", formats.rpm(self.spindle.rpm_max), "rpm")),
            Row(
                ("ACTIVE LIMIT", formats.rpm(limit) if limit else "NONE", "rpm" if limit else ""),
                bool(limit),
            ),
            Row(("COMMANDED SPEED", formats.rpm(snapshot.rpm_command), "rpm")),
            Row(("MEASURED SPEED", _measured(snapshot), "rpm")),
        )
        return Sheet(
            "MAXIMUM SPINDLE SPEED",
            ("", "", ""),
            (0.55, 0.3, 0.15),
            rows,
            question="MAXIMUM SPINDLE SPEED?",
            text=self.entry.text,
            notes=(
                "If a program commands a higher speed, the spindle runs at the limit.",
                "The limit takes effect at once, even while a program runs.",
            ),
            figures=frozenset({1}),
        )

    def keys(self) -> Mapping[str, Key]:
        """F4 lifts the limit."""
        return {"F4": Key("NO LIMIT", self.lift)}

    def lift(self) -> None:
        """The machine's own maximum again; asked once, because something may be in the chuck."""
        if not self.desk.snapshot().spindle_limit:
            self.desk.say("NO SPINDLE SPEED LIMIT IS ACTIVE")
        elif not self.desk.refused(Act.SPINDLE_LIMIT):
            self.desk.ask(LIFT, self._lifted)

    def _lifted(self) -> None:
        if not self.desk.refused(Act.SPINDLE_LIMIT):
            self._limit(None)

    def _limit(self, rpm: float | None) -> None:
        before = self.desk.snapshot().spindle_limit
        self.desk.post(SpindleLimit(rpm))
        told = " → ".join(
            Message("{speed} rpm", speed=f"{each:g}") if each else "none" for each in (before, rpm)
        )
        self.desk.access.persistence.note_change(Message("spindle speed limit: {details}", details=told))

    def take(self, text: str) -> bool:
        """The limit, where this spindle can turn at it."""
        rpm = value_of(text)
        low, high = self.spindle.rpm_min, self.spindle.rpm_max
        if not low <= rpm <= high:
            raise EntryError(
                Message(
                    "{rpm} rpm is outside the range of this spindle, {low} to {high} rpm",
                    rpm=f"{rpm:g}",
                    low=f"{low:g}",
                    high=f"{high:g}",
                )
            )
        limit = self.desk.snapshot().spindle_limit
        if limit and rpm > limit and self.desk.refused(Act.SPINDLE_LIMIT):
            return False
        self._limit(rpm)
        self.desk.done(tr(Message("SPINDLE LIMITED TO {rpm} RPM UNTIL RESTART", rpm=formats.rpm(rpm))))
        return True

    def prompt(self) -> str:
        """How to set the limit, for the prompt line."""
        return "TYPE A SPEED OR EXPRESSION   ENTER: ACCEPT   ESC: BACK"


def _measured(snapshot: Snapshot) -> str:
    return UNKNOWN if Unknown.SPINDLE in snapshot.unknown else formats.rpm(snapshot.rpm_actual)
