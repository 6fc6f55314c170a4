"""Counters of F10: parts with target and times, and tool life with its limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from app.desk.arithmetic import EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet, following, refused
from app.desk.status import formats
from app.desk.status.formats import NOTHING
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.production.parts_watch import PartsWatch
from app.programs.run_history import MOST, PartCounter
from app.special.special_functions import FigureFunction
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.message import Message
from core.production.tool_life import LifeState, ToolLife, ToolLifeError, check_life
from core.store.production import tool_lives
from core.store.production.tool_lives import LifeRow
from core.store.store_rows import OFFSETS

LIMITS = ("PARTS", "MINUTES", "WARN AT %")
_LABELS = {"PARTS": "PARTS", "MINUTES": "MINUTES", "WARN AT %": "WARN"}
TONES = {
    LifeState.NO_LIMIT: Tone.OFF,
    LifeState.GOOD: Tone.RUN,
    LifeState.WARNED: Tone.PAUSE,
    LifeState.SPENT: Tone.ALARM,
}


class ToolLifeFunction(FigureFunction):
    """Special function for tool life, with one row per tool.

    A typed limit applies to the selected tool.
    """

    name = "TOOL LIFE"
    use = "insert life in parts and minutes"

    def __init__(self, desk: Desk, watch: PartsWatch) -> None:
        super().__init__(desk)
        self.watch = watch
        self.limit = LIMITS[0]

    def tools(self) -> tuple[ToolLife, ...]:
        """Return the displayed tools in the order of T numbers."""
        lives = self.watch.lives.lives()
        numbers = sorted({*lives, *self.desk.book.tools} & set(OFFSETS))
        return tuple(lives.get(number, ToolLife(number)) for number in numbers)

    @property
    def count(self) -> int:
        """Number of displayed tools."""
        return len(self.tools())

    @property
    def tool(self) -> ToolLife | None:
        """Selected tool, or None."""
        tools = self.tools()
        return tools[self.marked] if self.marked < len(tools) else None

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table with limits, use, remaining life and stop."""
        self.marked = max(0, min(self.marked, self.count - 1))
        rows = tuple(self._row(each) for each in self.tools())
        tool = self.tool
        question = tr(Message("T{number} {limit}?", number=tool.number, limit=tr(self.limit))) if tool else ""
        heads = ("T", "PARTS", "MINUTES", "STOPS", "REMAINING", "USED")
        notes = (
            (
                "Only time at feed counts toward the tool-life minutes. Enter 0 for no limit. STOP: "
                "no new part starts once the tool life is used up."
            ),
        )
        return Sheet("TOOL LIFE", heads, (0.1, 0.13, 0.14, 0.13, 0.17, 0.33), rows, self.marked, question,
                     self.entry.text, notes)  # fmt: skip

    def _row(self, life: ToolLife) -> Row:
        parts = str(life.limit_parts) if life.limit_parts else NOTHING
        minutes = f"{life.limit_seconds / 60.0:g}" if life.limit_seconds else NOTHING
        left = life.parts_left
        words = NOTHING if left is None else tr(Message("{count} parts", count=left))
        stops = tr("STOP") if life.stops else NOTHING
        tone = TONES[life.state]
        cells = (f"T{life.number}", parts, minutes, stops, words, life.words)
        bar = life.share if life.state is not LifeState.NO_LIMIT else None
        return Row(cells, life.state is not LifeState.NO_LIMIT, tone, bar)

    def typed(self, key: str) -> bool:
        """Handle a key: arrows move the selection, and other keys edit the entry."""
        return self.moves(key) or super().typed(key)

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys for the type of limit, the stop and a new insert."""
        return {
            "F2": Key(_LABELS[following(LIMITS, self.limit)], self._next_limit),
            "F3": Key("STOP", self.turn_stop),
            "F4": Key("INSERT", self.insert),
        }

    def _next_limit(self) -> None:
        self.desk.clear()
        self.entry.text, self.limit = "", following(LIMITS, self.limit)

    def take(self, text: str) -> bool:
        """Set a limit of the selected tool. Raises EntryError."""
        tool = self.tool
        if tool is None:
            self.desk.say(tr("NO TOOL HAS OFFSETS YET"))
            return False
        value = value_of(text)
        if self.limit == "PARTS" and value != int(value):
            raise EntryError(
                Message("{value} is not a valid number of parts; type a whole number", value=f"{value:g}")
            )
        wanted = {
            "PARTS": lambda: replace(tool, limit_parts=int(value)),
            "MINUTES": lambda: replace(tool, limit_seconds=60.0 * value),
            "WARN AT %": lambda: replace(tool, warn=value / 100.0),
        }[self.limit]()
        return self._set(wanted)

    def _set(self, wanted: ToolLife) -> bool:
        try:
            check_life(wanted)
        except ToolLifeError as error:
            raise EntryError(str(error)) from error
        row = LifeRow(wanted.number, wanted.limit_parts, wanted.limit_seconds, wanted.warn, wanted.stops)
        done = partial(self.desk.say, tr(Message("T{number} SAVED", number=wanted.number)))
        minutes = Message("{limit_seconds} min", limit_seconds=f"{row.limit_seconds / 60.0:g}")
        told = Message(
            "T{number} tool life: {limit_parts} parts, {minutes}, warn at {warn}",
            number=row.number,
            limit_parts=row.limit_parts,
            minutes=minutes,
            warn=f"{row.warn:.0%}",
        )
        self.watch.book.write(
            Act.LIVES,
            lambda c: tool_lives.set_limits(c, row),
            done,
            self.watch.refuse,
            f"{told}, {'stops' if row.stops else 'no stop at end of tool life'}",
        )
        return True

    def turn_stop(self) -> None:
        """Turn the stop at the end of tool life on or off (F3)."""
        tool = self.tool
        if tool is not None:
            self.desk.clear()
            self._set(replace(tool, stops=not tool.stops))

    def insert(self) -> None:
        """Record a new insert in the holder, after confirmation (F4)."""
        tool = self.tool
        if tool is None:
            return
        asked = tr("NEW INSERT IN T{number}? OLD INSERT USED: {words}. Y: YES   N: NO")
        self.desk.ask(
            tr(Message(asked, number=tool.number, words=tool.words)),
            lambda: self.watch.lives.change_insert(tool.number, tool.words, self.desk.say),
        )

    def prompt(self) -> str:
        """Return the prompt, or the reason why changes are not possible."""
        return self.watch.book.locked or ("TYPE THE LIFE LIMIT. F2: NEXT LIMIT   F4: NEW INSERT")


RESET = "PRESS Y TO SET THE COUNT TO ZERO, N TO KEEP IT"
NO_PROGRAM = "CHOOSE A PROGRAM FIRST: EVERY PROGRAM HAS ITS OWN COUNT"


class PartsCounterFunction(FigureFunction):
    """Special function for the parts counter of the loaded program."""

    name = "PARTS COUNTER"
    use = "parts made, target, times"

    @property
    def counter(self) -> PartCounter:
        """Parts counter of the loaded program."""
        return self.desk.runs.counter

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Return the table with count, target, remaining parts and times."""
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
        """Return the function keys for corrections, the reset and cycles that are not counted."""
        return {
            "F2": Key("COUNT +1", partial(self.correct, 1)),
            "F3": Key("COUNT -1", partial(self.correct, -1)),
            "F4": Key("RESET", self.reset),
            "F5": Key("NO COUNT", partial(self.desk.switch, "no_count")),
        }

    def correct(self, by: int) -> None:
        """Correct the count by one part that was not counted or is scrap."""
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
        """Reset the count to zero, after confirmation."""
        if not self.counter.program:
            self.desk.say(NO_PROGRAM)
        elif self.desk.refused(Act.COUNTS):
            return
        elif self.counter.count == 0:
            self.desk.done("THE COUNT IS ALREADY ZERO")
        else:
            self.desk.ask(RESET, partial(self.desk.keep, self.counter.reset))

    def take(self, text: str) -> bool:
        """Set the target number of parts. 0 removes the target. Raises EntryError."""
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
        """Return the prompt for the target."""
        return "TYPE THE NUMBER OF PARTS   ENTER: ACCEPT   ESC: BACK"


def whole_number(text: str) -> int:
    """Return a typed number of parts as an integer. Raises EntryError."""
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
