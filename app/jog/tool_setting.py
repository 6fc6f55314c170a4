"""Tool setting on the Jog page: selection of a tool, touch-off, and entry of its other fields."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.arithmetic import CHARACTERS, LONGEST, EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import edited, refused
from app.desk.translation import tr
from app.offsets.change_rules import CORRECTIONS
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_changes import OffsetHistory, OffsetQuestions, follower_names, refusal
from app.offsets.offset_table import NewTool, ToolFields
from app.offsets.offset_values import (
    TOOL_FIELDS,
    Mode,
    heading,
    not_set,
    shown_value,
    signed,
    to_mm,
    value_typed,
    word,
)
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.offsets.touch_off import Touch
from core.store.store_rows import OFFSETS, REMARK_LONGEST, Kind, Sort, ToolRow
from core.tool_edges import edge_name, edge_number

TOUCH_X, TOUCH_Z = "touch x", "touch z"
TOUCHES = {TOUCH_X: "x", TOUCH_Z: "z"}
MOVED = 0.005  # Tolerance in mm. After a larger move, the axis is no longer where the tip touched.


def touch_refusal(what: str, snapshot: Snapshot) -> str:
    """Return why an axis cannot be touched off now. Empty if it can."""
    axis = TOUCHES[what].upper()
    if not snapshot.homed[snapshot.axes.index(axis)]:
        return tr(Message("{axis} IS NOT HOMED AND ITS POSITION IS UNKNOWN. HOME IT FIRST", axis=axis))
    if snapshot.state not in {State.IDLE, State.DISABLED}:
        return tr("TOUCH OFF ONLY WITH THE MACHINE STOPPED AND READY")
    return ""


def slide(what: str, snapshot: Snapshot) -> float:
    """Return the machine position of the touched axis in mm."""
    return snapshot.tip["xz".index(TOUCHES[what])]


@dataclass(slots=True)
class TouchOff:
    """One touch-off of one axis. ``at`` is the machine position at the touch in mm.

    ``found`` is the machine position in mm with the tip on part zero, as the tool setter measured it.
    ``cause`` describes the measurement. Such a value needs no entry, and the axis may move afterwards.
    """

    what: str = ""
    at: float = 0.0
    alone: bool = False  # Only this tool changes, although it is the master.
    found: float | None = None
    cause: str = ""
    by_cut: bool = False  # The entered size was measured on a skim cut.

    @property
    def name(self) -> str:
        """The field of the tool that the touch-off sets."""
        return TOUCHES[self.what]

    def open(self, what: str, snapshot: Snapshot) -> None:
        """Store the present position of the axis as the touch."""
        self.what, self.at, self.alone = what, slide(what, snapshot), False
        self.found, self.cause, self.by_cut = None, "", False

    def cut(self, what: str, at: float) -> None:
        """Store the machine position of a skim cut in mm."""
        self.what, self.at, self.alone = what, at, False
        self.found, self.cause, self.by_cut = None, "", True

    def set(self, what: str, found: float, cause: str) -> None:
        """Store a measurement of the tool setter. Other tools do not follow a master in this case."""
        self.what, self.found, self.cause, self.alone, self.by_cut = what, found, cause, True, False

    def place(self, text: str, mode: Mode) -> float:
        """Return the machine position in mm with the tip on part zero, X as a radius. Raises EntryError."""
        if self.found is not None:
            return self._within(self.found)
        typed = value_of(text) * (0.5 if self.what == TOUCH_X else 1.0)
        return self._within(self.at - to_mm(typed, mode.metric))

    def _within(self, place: float) -> float:
        if not TOOL_FIELDS[self.name].takes(place):
            raise EntryError(
                tr(Message("the {axis} offset would be outside the allowed range", axis=word(self.name)))
            )
        return place

    def save(self, number: int, text: str, history: OffsetHistory, new: NewTool) -> str:
        """Save the touch-off. Return why it was rejected, or an empty text.

        X and Z of a new tool are saved together. Raises EntryError for an invalid entry.
        """
        place, book, ask = self.place(text, history.mode), history.book, OffsetQuestions(history)
        if number in book.tools:
            return ask.touch_off(
                number, self.touch(place), self._reason(text, history.mode), self._tip(place)
            )
        values = new.add(number, self.name, place)
        new.tip = self._tip(place) if self.name == "x" else new.tip
        if len(values) < 2:
            return ""
        x, z = (float(values[name]) for name in ("x", "z"))
        why = ask.touch_off(number, Touch(x, z), self.cause or tr("touch-off of a new tool"), new.tip)
        if not why:
            new.drop()
        return why

    def touch(self, place: float) -> Touch:
        """Return the touch of this axis.

        ``place`` is the machine position in mm with the tip on part zero.
        """
        return Touch(place, None, self.alone) if self.name == "x" else Touch(None, place, self.alone)

    def _tip(self, place: float) -> float | None:
        """Return X of the tip relative to part zero at the touch in mm. None if X was not touched."""
        return self.at - place if self.name == "x" and self.found is None else None

    def moved(self, snapshot: Snapshot) -> bool:
        """Return whether the axis has moved since the touch. A skim cut checks this itself."""
        return self.found is None and not self.by_cut and abs(slide(self.what, snapshot) - self.at) > MOVED

    def _reason(self, text: str, mode: Mode) -> str:
        """Return the text for the history."""
        if self.cause:
            return f"{self.cause}{tr(', this tool only') if self.alone else ''}"
        unit = "MM " if mode.metric else ""
        names = (
            (tr("skim cut Ø"), tr("skim cut Z")) if self.by_cut else (tr("touch-off Ø"), tr("touch-off Z"))
        )
        what = names[self.what != TOUCH_X]
        return f"{unit}{what} {text.strip()}{tr(', this tool only') if self.alone else ''}"


TOOL = "tool"  # The question for the tool number.
Pair = tuple[float, float]
_AFTER = {"wear_x": "wear_z"}  # The question that follows an answer.


@dataclass(slots=True)
class ToolSetting:
    """The selected tool with the open question and the entered text."""

    desk: Desk
    book: OffsetBook
    history: OffsetHistory = field(init=False)
    fields: ToolFields = field(init=False)
    touching: TouchOff = field(default_factory=TouchOff)
    number: int = 0
    asked: str = ""  # The open question: a touch, "tool", a field, or empty.
    text: str = ""
    _active: int = -1  # The active tool at the last update.

    def __post_init__(self) -> None:
        self.history = OffsetHistory(self.desk, Kind.TOOL, keys="F8, F5")
        self.fields = ToolFields(self.history)

    # --- display -------------------------------------------------------------------------------------

    @property
    def row(self) -> ToolRow | None:
        """The offset of the selected tool. None if the tool was never set."""
        return self.book.tools.get(self.number)

    @property
    def masters(self) -> bool:
        """Whether the master tool is being touched off."""
        return self.asked in TOUCHES and self.row is not None and self.row.master

    @property
    def by_setter(self) -> bool:
        """Whether the question is about a measurement of the tool setter."""
        return self.asked in TOUCHES and self.touching.found is not None

    def found(self, what: str, value: float, cause: str) -> None:
        """Ask whether to save a measurement of the tool setter.

        ``value`` is the machine position in mm with the tip on part zero. A suspicious value is asked only
        once, by the question for suspicious changes.
        """
        self.asked, self.text = what, ""
        self.touching.set(what, value, cause)
        if self.row is not None and OffsetQuestions(self.history).doubts(
            self.number, self.touching.touch(value)
        ):
            self._enter()

    def measured(self, what: str, at: float) -> None:
        """Ask for the size of a skim cut. ``at`` is the machine position during the cut in mm."""
        self.desk.clear()
        self.asked, self.text = what, ""
        self.touching.cut(what, at)

    @property
    def moved(self) -> float | None:
        """The measured position minus the present offset with wear in mm.

        None without a measurement of the tool setter or without a present offset.
        """
        if not self.by_setter or self.row is None or self.touching.found is None:
            return None
        return self.touching.found - self.row.offset["xz".index(self.touching.name)]

    def question(self) -> str:
        """Return the open question. Empty without a question."""
        name = edge_name(self.number)
        if self.asked == TOOL:
            return tr("TOOL NUMBER?")
        if self.by_setter:
            return tr(
                Message(
                    "SAVE {tool} {axis} MEASURED AT THE TOOL SETTER?",
                    tool=name,
                    axis=self.touching.name.upper(),
                )
            )
        if self.asked == TOUCH_X:
            return tr(Message("{tool} MEASURED DIAMETER?", tool=name))
        if self.asked == TOUCH_Z:
            return tr(Message("{tool} Z POSITION OF THE FACE?", tool=name))
        return f"{name}  {word(self.asked)}?" if self.asked else ""

    def note(self) -> str:
        """Return a note that the operator must read before answering. Empty without a note."""
        number, new = self.number, self.fields.new
        if self.masters and self.touching.alone:
            return tr(
                Message(
                    "ONLY T{number} CHANGES. L: APPLY TO ALL TOOLS",
                    number=edge_number(number),
                )
            )
        if self.masters:
            return tr(
                Message(
                    "T{number} IS THE MASTER. ALSO ADJUSTED: {others}. L: THIS TOOL ONLY",
                    number=edge_number(number),
                    others=follower_names(self.book.tools, number) or tr("no tools"),
                )
            )
        if new.number and new.number == number:
            text = tr("T{number} IS NOT SET YET. TOUCH OFF {axis} TOO")
            return tr(Message(text, number=edge_number(number), axis=new.missing.upper()))
        return ""

    def old_to_new(self) -> str:
        """Return the change that the entry would make, or else the last change."""
        if not self.asked or self.asked == TOOL:
            return self.history.last_in_words
        mode, name, row = self.history.mode, TOUCHES.get(self.asked, self.asked), self.row
        touched, title = self.asked in TOUCHES, heading(name, mode)
        was = shown_value(name, getattr(row, name), mode) if row else not_set(unread=self.book.unread)
        try:
            value = self.touching.place(self.text, mode) if touched else value_typed(name, self.text, mode)
            ends = _wear_that_ends(row, f"wear_{name}", mode) if touched else ""
            apart = self._apart(name, mode)
            return f"{title}  {was}  →  {shown_value(name, value, mode)}{apart}{ends}"
        except EntryError:
            return f"{title}  {was}  →  …"  # An incomplete expression is not an error yet.

    def _apart(self, name: str, mode: Mode) -> str:
        """Return the difference between the measured and the present offset as text."""
        if self.moved is None:
            return ""
        shown = 2 * self.moved if name == "x" and mode.diameter else self.moved
        return f"   {tr('DIFFERENCE')} {signed(shown, mode.metric)}"

    def tip(self, snapshot: Snapshot) -> Pair | None:
        """Return the position of the tip relative to part zero in mm. None if the tool was never set."""
        if self.row is None:
            return None
        x, z = self.row.offset
        return snapshot.tip[0] - x, snapshot.tip[1] - z

    def from_master(self) -> Pair | None:
        """Return the offset of this tool minus the master's in mm. None unless both are set."""
        master = self.book.tools.get(self.book.master)
        if self.row is None or master is None:
            return None
        (x, z), (mx, mz) = self.row.offset, master.offset
        return x - mx, z - mz

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot) -> None:
        """Select the active tool when it changes; called once a frame.

        A change of the unit discards the entry.
        """
        before = self.history.mode
        self.history.look(snapshot)
        if self.history.mode != before and self.asked:
            self.close()
            self.desk.say(tr("UNITS OR DIAMETER/RADIUS CHANGED. NOT SAVED. RE-ENTER VALUE"))
        if snapshot.modal.tool != self._active:
            self._active = snapshot.modal.tool
            if self._active and not self.asked:
                self._choose(self._active)

    def _choose(self, number: int) -> None:
        if number != self.number:
            self.number = number
            self.fields.new.drop()

    # --- questions -----------------------------------------------------------------------------------

    def ask(self, what: str) -> None:
        """Open a question, or show why this is not possible."""
        snapshot = self.desk.snapshot()
        why = "" if what == TOOL else self.barred(what, snapshot)
        if why:
            self.desk.say(why)
            return
        self.desk.clear()
        self.asked, self.text = what, ""
        if what == "remark" and self.row is not None:
            self.text = self.row.remark
        if what in TOUCHES:
            self.touching.open(what, snapshot)

    def barred(self, what: str, snapshot: Snapshot) -> str:
        """Return why this question cannot be opened now. Empty if it can."""
        why = self.book.locked or refusal(snapshot, correction=what in CORRECTIONS[Kind.TOOL])
        if why or not self.number:
            return why or _which_tool()
        if what in TOUCHES:
            return touch_refusal(what, snapshot)
        if self.row is None:
            return tr(
                Message("T{number} IS NOT SET. TOUCH OFF X AND Z FIRST", number=edge_number(self.number))
            )
        return ""

    def close(self) -> None:
        """Close the question."""
        self.asked, self.text = "", ""

    def forget(self) -> None:
        """Close the question, and discard an incomplete new tool."""
        self.close()
        self.fields.new.drop()

    def takes(self, key: str) -> bool:
        """Return whether a character can be entered."""
        return self.asked == "remark" or (bool(self.asked) and not self.by_setter and key in CHARACTERS)

    def typed(self, key: str) -> bool:
        """Handle a key while a question is open. Return False if the key has no meaning in an entry."""
        if key == "Enter":
            self._enter()
        elif key in {"Back", "Delete"} or (len(key) == 1 and self.takes(key)):
            self.text = edited(self.text, key, REMARK_LONGEST if self.asked == "remark" else LONGEST)
        elif key in {"l", "L"} and self.masters:
            self.touching.alone = not self.touching.alone
        else:
            return False
        return True

    def _enter(self) -> None:
        try:
            why = self._answer()
        except EntryError as error:
            self.text = refused(self.text)
            why = tr(Message("REJECTED: {why}", why=error))
        if why:
            self.desk.say(why)

    def _answer(self) -> str:
        """Process the answer. Return why it was rejected, or an empty text. Raises EntryError."""
        if self.asked == TOOL:
            return self._tool()
        snapshot = self.desk.snapshot()
        why = self.barred(self.asked, snapshot)
        if why:
            return why
        return self._touched(snapshot) if self.asked in TOUCHES else self._field()

    def _tool(self) -> str:
        value = value_of(self.text)
        if value not in OFFSETS:
            raise EntryError(tr(Message("T{number:g} does not exist; tools are T1…32", number=value)))
        self._choose(int(value))
        self.close()
        return ""

    def _touched(self, snapshot: Snapshot) -> str:
        if self.touching.moved(snapshot):
            return tr("AXIS MOVED AFTER TOUCH-OFF. PRESS ESC, THEN TOUCH OFF AGAIN")
        why = self.touching.save(self.number, self.text, self.history, self.fields.new)
        if not why:
            self.close()
        return why or self.note()

    def _field(self) -> str:
        name, text = self.asked, self.text
        keeps = not text.strip() and TOOL_FIELDS[name].sort is not Sort.TEXT
        why = "" if keeps else self.fields.save(self.number, name, text)
        if not why:
            self.close()
            self.asked = "" if self.desk.asked else _AFTER.get(name, "")
        return why

    def master(self) -> None:
        """Ask whether the selected tool becomes the master, or whether no tool is if it is the master now."""
        why = self.barred("master", self.desk.snapshot())
        self.close()
        self.history.answer(why or self.fields.master(self.number))

    def undo(self) -> None:
        """Ask whether the last change of the selected tool is undone."""
        self.close()
        self.history.answer(self.undo_barred() or OffsetQuestions(self.history).undo(Kind.TOOL, self.number))

    def undo_barred(self) -> str:
        """Return why the last change of the selected tool cannot be undone now. Empty if it can."""
        why = self.book.locked or refusal(self.desk.snapshot(), correction=False)
        return why or ("" if self.number else _which_tool())

    def escape(self) -> bool:
        """Close the question, and discard an incomplete new tool. Return False if there was neither."""
        was = bool(self.asked or self.fields.new.number)
        if was and self.number:
            self.desk.say(tr(Message("T{number} NOT CHANGED", number=edge_number(self.number))))
        self.forget()
        return was


def _which_tool() -> str:
    return tr("NO TOOL SELECTED. PRESS T AND TYPE ITS NUMBER")


def _wear_that_ends(row: ToolRow | None, name: str, mode: Mode) -> str:
    """Return the text of the wear that a touch-off resets to zero, because the new geometry includes it."""
    if row is None or not getattr(row, name):
        return ""
    return (
        f"   {word(name)}  {shown_value(name, getattr(row, name), mode)}  →  {shown_value(name, 0.0, mode)}"
    )
