"""The parts counter: count, target, times; reset after asking once."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from app.desk.arithmetic import EntryError, value_of
from app.desk.pages.sheet import Key, Row, Sheet, refused
from app.desk.status import formats
from app.desk.translation import tr
from app.special.part_count import MOST, PartCounter
from app.special.special_functions import FigureFunction
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.message import Message

RESET = "PRESS Y TO SET THE COUNT TO ZERO, N TO KEEP IT"
NO_PROGRAM = "CHOOSE A PROGRAM FIRST: EVERY PROGRAM HAS ITS OWN COUNT"


class PartsCounterFunction(FigureFunction):
    """Of the program on the desk."""

    name = "PARTS COUNTER"
    use = "parts made, target, times"

    @property
    def counter(self) -> PartCounter:
        """The count of the program on the desk."""
        return self.desk.counter

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Count, target, what is left of it, times."""
        counter, last = self.counter, snapshot.last_cycle
        aim = counter.aim
        left = max(0, aim - counter.count)
        to_come = formats.duration(left * last) if aim and last else formats.NOTHING
        stop = (
            tr(Message("{count} (SET BY JOB)", count=aim)) if counter.of_job else str(aim or tr("NO TARGET"))
        )
        rows = (
            Row(("PARTS MADE", str(counter.count)), counter.reached or None),
            Row(("PART TARGET", stop)),
            Row(("PARTS TO GO", str(left) if aim else formats.NOTHING)),
            Row(("LAST CYCLE", formats.duration(last) if last else formats.NOTHING)),
            Row(("TIME FOR REMAINING PARTS", to_come)),
        )
        return Sheet(
            "PARTS COUNTER",
            ("PROGRAM", counter.program or "NO PROGRAM"),
            (0.55, 0.45),
            rows,
            question="STOP AT HOW MANY PARTS?",
            text=self.entry.text,
            notes=(
                (
                    "Cycle Repeat turns off during the cycle that reaches the part target. Enter 0 for "
                    "no part target."
                ),
                (
                    "Use NO COUNT for dry runs; the cycle is then not counted as a part. A restart "
                    "that skips lines is not counted either."
                ),
            ),
            figures=frozenset({1}),
        )

    def keys(self) -> Mapping[str, Key]:
        """Corrections of the count, the count to nought, and runs that are no parts."""
        return {
            "F2": Key("COUNT +1", partial(self.correct, 1)),
            "F3": Key("COUNT -1", partial(self.correct, -1)),
            "F4": Key("RESET", self.reset),
            "F5": Key("NO COUNT", partial(self.desk.switch, "no_count")),
        }

    def correct(self, by: int) -> None:
        """One part that was not counted, or one that is scrap."""
        if not self.counter.program:
            self.desk.say(NO_PROGRAM)
        elif self.desk.refused(Act.COUNTS):
            return
        elif self.counter.count + by < 0:
            self.desk.done("THE COUNT IS ALREADY ZERO")
        else:
            self.desk.clear()
            self.desk.keep(lambda: self.counter.correct(by))

    def reset(self) -> None:
        """Count to nought, after asking."""
        if not self.counter.program:
            self.desk.say(NO_PROGRAM)
        elif self.desk.refused(Act.COUNTS):
            return
        elif self.counter.count == 0:
            self.desk.done("THE COUNT IS ALREADY ZERO")
        else:
            self.desk.ask(RESET, partial(self.desk.keep, self.counter.reset))

    def take(self, text: str) -> bool:
        """The target, from the count on; 0 takes it away."""
        if not self.counter.program:
            self.desk.say(NO_PROGRAM)
            return False
        if self.counter.of_job:
            self.desk.say("ACTIVE JOB HAS ITS OWN COUNT. CHANGE IT IN JOBS (SHIFT+F6)")
            return False
        if self.desk.refused(Act.COUNTS):
            return False
        target = whole_number(text)
        if 0 < target <= self.counter.count:
            made = self.counter.count
            self.entry.text = refused(self.entry.text)
            self.desk.say(
                tr(Message("TARGET TOO LOW: {count} PARTS ALREADY MADE. F4: RESET COUNT", count=made))
            )
            return False
        self.desk.keep(lambda: self.counter.set_target(target))
        return True

    def prompt(self) -> str:
        """How to set the target, for the prompt line."""
        return "TYPE THE NUMBER OF PARTS   ENTER: ACCEPT   ESC: BACK"


def whole_number(text: str) -> int:
    """A number of parts as it was typed. Raises EntryError."""
    value = value_of(text)
    if value != int(value) or not 0 <= value <= MOST:
        raise EntryError(
            Message(
                "{value} is not a valid number of parts; enter a whole number from 0 to {maximum}",
                value=f"{value:g}",
                maximum=MOST,
            )
        )
    return int(value)
