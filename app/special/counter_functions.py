"""Special functions (F10) for the parts counter and its times, and for tool life and its limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow, following, refused
from app.desk.status import formats
from app.desk.status.formats import NO_VALUE
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.production.parts_watch import ProductionMonitor
from app.programs.run_history import MAX_COUNT, PartCounter
from app.special.special_functions import NumericEntryFunction
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.message import Message
from core.production.tool_life import ToolLife, ToolLifeError, ToolLifeState, check_tool_life
from core.store.production import tool_lives
from core.store.production.tool_lives import ToolLifeRow
from core.store.store_rows import OFFSET_NUMBERS

LIMIT_FIELDS = ("PARTS", "MINUTES", "WARN AT %")
_LABELS = {"PARTS": "PARTS", "MINUTES": "MINUTES", "WARN AT %": "WARN"}
LIFE_TONES = {
    ToolLifeState.NO_LIMIT: StatusTone.OFF,
    ToolLifeState.OK: StatusTone.RUN,
    ToolLifeState.WARNING: StatusTone.PAUSE,
    ToolLifeState.USED_UP: StatusTone.ALARM,
}


class ToolLifeFunction(NumericEntryFunction):
    """Special function (F10) for tool life, with one row per tool.

    A typed limit applies to the selected tool.
    """

    name = "TOOL LIFE"
    use = "insert life in parts and minutes"

    def __init__(self, desk: Desk, parts_watch: ProductionMonitor) -> None:
        super().__init__(desk)
        self.parts_watch = parts_watch
        self.limit_kind = LIMIT_FIELDS[0]

    def list_tools(self) -> tuple[ToolLife, ...]:
        """Return the displayed tools in the order of their T numbers."""
        lives = self.parts_watch.tool_life_monitor.find_tool_lives()
        numbers = sorted({*lives, *self.desk.offset_book.tool_offsets} & set(OFFSET_NUMBERS))
        return tuple(lives.get(number, ToolLife(number)) for number in numbers)

    @property
    def row_count(self) -> int:
        """Return the number of displayed tools."""
        return len(self.list_tools())

    @property
    def selected_tool(self) -> ToolLife | None:
        """Return the selected tool, or None if no tool is listed."""
        tools = self.list_tools()
        return tools[self.marked] if self.marked < len(tools) else None

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of tool life: limit, use, remaining life and stop setting of each tool."""
        self.marked = max(0, min(self.marked, self.row_count - 1))
        rows = tuple(self._row(each) for each in self.list_tools())
        tool = self.selected_tool
        question = (
            tr(Message("T{number} {limit}?", number=tool.number, limit=tr(self.limit_kind))) if tool else ""
        )
        heads = ("T", "PARTS", "MINUTES", "STOPS", "REMAINING", "USED")
        notes = (
            (
                "Only time at feed counts toward the tool-life minutes. Enter 0 for no limit. STOP: "
                "no new part starts once the tool life is used up."
            ),
        )
        return TableContent(
            "TOOL LIFE",
            heads,
            (0.1, 0.13, 0.14, 0.13, 0.17, 0.33),
            rows,
            self.marked,
            question,
            self.entry.text,
            notes,
        )

    def _row(self, life: ToolLife) -> TableRow:
        parts = str(life.limit_parts) if life.limit_parts else NO_VALUE
        minutes = f"{life.limit_seconds / 60.0:g}" if life.limit_seconds else NO_VALUE
        left = life.remaining_part_count
        words = NO_VALUE if left is None else tr(Message("{count} parts", count=left))
        stops = tr("STOP") if life.stops else NO_VALUE
        tone = LIFE_TONES[life.state]
        cells = (f"T{life.number}", parts, minutes, stops, words, life.words)
        bar = life.share if life.state is not ToolLifeState.NO_LIMIT else None
        return TableRow(cells, life.state is not ToolLifeState.NO_LIMIT, tone, bar)

    def handle_key(self, key: str) -> bool:
        """Handle a key of the tool life table.

        Arrow keys move the selection, and other keys edit the entry.
        """
        return self.move_selection(key) or super().handle_key(key)

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys for the type of limit, the stop setting and a new insert."""
        return {
            "F2": FunctionKey(_LABELS[following(LIMIT_FIELDS, self.limit_kind)], self._next_limit),
            "F3": FunctionKey("STOP", self.toggle_tool_life_stop),
            "F4": FunctionKey("INSERT", self.confirm_new_insert),
        }

    def _next_limit(self) -> None:
        self.desk.clear_prompt_line()
        self.entry.text, self.limit_kind = "", following(LIMIT_FIELDS, self.limit_kind)

    def accept_entry(self, text: str) -> bool:
        """Set a limit of the selected tool.

        Raise InvalidEntryError for an invalid value.
        """
        tool = self.selected_tool
        if tool is None:
            self.desk.say(tr("NO TOOL HAS OFFSETS YET"))
            return False
        value = evaluate_expression(text)
        if self.limit_kind == "PARTS" and value != int(value):
            raise InvalidEntryError(
                Message("{value} is not a valid number of parts; type a whole number", value=f"{value:g}")
            )
        wanted = {
            "PARTS": lambda: replace(tool, limit_parts=int(value)),
            "MINUTES": lambda: replace(tool, limit_seconds=60.0 * value),
            "WARN AT %": lambda: replace(tool, warn=value / 100.0),
        }[self.limit_kind]()
        return self._set(wanted)

    def _set(self, wanted: ToolLife) -> bool:
        try:
            check_tool_life(wanted)
        except ToolLifeError as error:
            raise InvalidEntryError(str(error)) from error
        row = ToolLifeRow(wanted.number, wanted.limit_parts, wanted.limit_seconds, wanted.warn, wanted.stops)
        done = partial(self.desk.say, tr(Message("T{number} SAVED", number=wanted.number)))
        minutes = Message("{limit_seconds} min", limit_seconds=f"{row.limit_seconds / 60.0:g}")
        change_text = Message(
            "T{number} tool life: {limit_parts} parts, {minutes}, warn at {warn}",
            number=row.number,
            limit_parts=row.limit_parts,
            minutes=minutes,
            warn=f"{row.warn:.0%}",
        )
        self.parts_watch.production_records.write_change(
            ProtectedChange.LIVES,
            lambda c: tool_lives.save_tool_life_limits(c, row),
            done,
            self.parts_watch.report_refusal,
            f"{change_text}, {'stops' if row.stops else 'no stop at end of tool life'}",
        )
        return True

    def toggle_tool_life_stop(self) -> None:
        """Handle F3: turn the stop at the end of tool life on or off."""
        tool = self.selected_tool
        if tool is not None:
            self.desk.clear_prompt_line()
            self._set(replace(tool, stops=not tool.stops))

    def confirm_new_insert(self) -> None:
        """Handle F4: record a new insert in the holder after the operator confirms."""
        tool = self.selected_tool
        if tool is None:
            return
        asked = tr("NEW INSERT IN T{number}? OLD INSERT USED: {words}. Y: YES   N: NO")
        self.desk.ask_operator(
            tr(Message(asked, number=tool.number, words=tool.words)),
            lambda: self.parts_watch.tool_life_monitor.record_insert_change(
                tool.number, tool.words, self.desk.say
            ),
        )

    def prompt_text(self) -> str:
        """Return the prompt, or why tool life cannot be changed now."""
        return self.parts_watch.production_records.lock_reason or (
            "TYPE THE LIFE LIMIT. F2: NEXT LIMIT   F4: NEW INSERT"
        )


RESET = "PRESS Y TO SET THE COUNT TO ZERO, N TO KEEP IT"
NO_PROGRAM_LOADED = "CHOOSE A PROGRAM FIRST: EVERY PROGRAM HAS ITS OWN COUNT"


class PartsCounterFunction(NumericEntryFunction):
    """Special function for the parts counter of the loaded program."""

    name = "PARTS COUNTER"
    use = "parts made, target, times"

    @property
    def part_counter(self) -> PartCounter:
        """Return the parts counter of the loaded program."""
        return self.desk.program_runs.part_counter

    def make_table(self, snapshot: Snapshot) -> TableContent:
        """Return the table with count, target, remaining parts and times."""
        counter, last = self.part_counter, snapshot.last_cycle
        aim = counter.effective_target_count
        left = max(0, aim - counter.part_count)
        to_come = formats.format_duration(left * last) if aim and last else formats.NO_VALUE
        stop = (
            tr(Message("{count} (SET BY JOB)", count=aim))
            if counter.job_target_count
            else str(aim or tr("NO TARGET"))
        )
        rows = (
            TableRow(("PARTS MADE", str(counter.part_count)), counter.is_complete or None),
            TableRow(("PART TARGET", stop)),
            TableRow(("PARTS TO GO", str(left) if aim else formats.NO_VALUE)),
            TableRow(("LAST CYCLE", formats.format_duration(last) if last else formats.NO_VALUE)),
            TableRow(("TIME FOR REMAINING PARTS", to_come)),
        )
        return TableContent(
            "PARTS COUNTER",
            ("PROGRAM", counter.program_name or "NO PROGRAM"),
            (0.55, 0.45),
            rows,
            entry_prompt="STOP AT HOW MANY PARTS?",
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
            numeric_columns=frozenset({1}),
        )

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys that correct or reset the count, or turn counting off or on."""
        return {
            "F2": FunctionKey("COUNT +1", partial(self.correct_part_count, 1)),
            "F3": FunctionKey("COUNT -1", partial(self.correct_part_count, -1)),
            "F4": FunctionKey("RESET", self.confirm_count_reset),
            "F5": FunctionKey("NO COUNT", partial(self.desk.toggle_switch, "no_count")),
        }

    def correct_part_count(self, change: int) -> None:
        """Correct the count for a part that was not counted, or for a scrapped part."""
        if not self.part_counter.program_name:
            self.desk.say(NO_PROGRAM_LOADED)
        elif self.desk.is_refused(ProtectedChange.COUNTS):
            return
        elif self.part_counter.part_count + change < 0:
            self.desk.show_success("THE COUNT IS ALREADY ZERO")
        else:
            self.desk.clear_prompt_line()
            self.desk.try_save(lambda: self.part_counter.correct_count(change))

    def confirm_count_reset(self) -> None:
        """Reset the count to zero after the operator confirms."""
        if not self.part_counter.program_name:
            self.desk.say(NO_PROGRAM_LOADED)
        elif self.desk.is_refused(ProtectedChange.COUNTS):
            return
        elif self.part_counter.part_count == 0:
            self.desk.show_success("THE COUNT IS ALREADY ZERO")
        else:
            self.desk.ask_operator(RESET, partial(self.desk.try_save, self.part_counter.reset_count))

    def accept_entry(self, text: str) -> bool:
        """Set the target number of parts.

        A value of 0 removes the target. Raise InvalidEntryError for an invalid value.
        """
        if not self.part_counter.program_name:
            self.desk.say(NO_PROGRAM_LOADED)
            return False
        if self.part_counter.job_target_count:
            self.desk.say("ACTIVE JOB HAS ITS OWN COUNT. CHANGE IT IN JOBS (SHIFT+F6)")
            return False
        if self.desk.is_refused(ProtectedChange.COUNTS):
            return False
        target = parse_part_count(text)
        if 0 < target <= self.part_counter.part_count:
            made = self.part_counter.part_count
            self.entry.text = refused(self.entry.text)
            self.desk.say(
                tr(Message("TARGET TOO LOW: {count} PARTS ALREADY MADE. F4: RESET COUNT", count=made))
            )
            return False
        self.desk.try_save(lambda: self.part_counter.set_target(target))
        return True

    def prompt_text(self) -> str:
        """Return the prompt for the target."""
        return "TYPE THE NUMBER OF PARTS   ENTER: ACCEPT   ESC: BACK"


def parse_part_count(text: str) -> int:
    """Return a typed number of parts as an integer.

    Raise InvalidEntryError for an invalid number.
    """
    value = evaluate_expression(text)
    if value != int(value) or not 0 <= value <= MAX_COUNT:
        raise InvalidEntryError(
            Message(
                "{value} is not a valid number of parts; enter a whole number from 0 to {maximum}",
                value=f"{value:g}",
                maximum=MAX_COUNT,
            )
        )
    return int(value)
