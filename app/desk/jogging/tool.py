"""Tool setting: a tool is chosen, its tip touches, and what was measured is typed.

Touch X: the tip stands where it cut, the diameter it made is measured and typed; then machine X less half of
that diameter is where the tip stands on part zero. Touch Z: the position of the face that it touches.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.arithmetic import LONGEST, EntryError, value_of
from app.desk.desk import Desk
from app.desk.offsets import allowed
from app.desk.offsets.book import OffsetBook
from app.desk.offsets.dialogue import CHARACTERS
from app.desk.offsets.entry import TOOL_FIELDS, shown_value, value_typed, word
from app.desk.offsets.figures import in_words, not_set, to_mm
from app.desk.offsets.ledger import Ledger
from app.desk.words import tr
from core.executor.snapshot import Snapshot, State
from core.store.fields import Sort
from core.store.rows import OFFSETS, REMARK_LONGEST, Kind, ToolRow
from core.store.toolset import Touch

TOUCH_X, TOUCH_Z, TOOL = "touch x", "touch z", "tool"
TOUCHES = {TOUCH_X: ("X", "x"), TOUCH_Z: ("Z", "z")}
MOVED = 0.005  # mm: more than this since the question was opened is no longer where the tip touched
_AFTER = {"wear_x": "wear_z"}  # what is asked after an answer


@dataclass(slots=True)
class ToolSetting:
    """What is asked of the chosen tool, what is typed, and what was touched so far."""

    desk: Desk
    book: OffsetBook
    ledger: Ledger = field(init=False)
    number: int = 0
    asked: str = ""  # a touch, "tool", a field of a tool, or nothing
    text: str = ""
    alone: bool = False  # of the master: the others stay
    half: dict[str, float] = field(default_factory=dict)  # X or Z of a tool that was never set
    _at: float = 0.0  # machine position of the touched axis, when the question was opened
    _active: int = -1  # the tool that was loaded at the last look

    def __post_init__(self) -> None:
        self.ledger = Ledger(self.desk, self.book, Kind.TOOL)

    # --- what is shown -------------------------------------------------------------------------------

    @property
    def row(self) -> ToolRow | None:
        """The chosen tool; None when it was never set."""
        return self.book.tools.get(self.number)

    @property
    def question(self) -> str:
        """What is asked now; empty when nothing is."""
        name = f"T{self.number}"
        if self.asked == TOOL:
            return tr("TOOL NUMBER?")
        if self.asked == TOUCH_X:
            return tr("{tool} MEASURED DIAMETER?").format(tool=name)
        if self.asked == TOUCH_Z:
            return tr("{tool} Z POSITION OF THE FACE?").format(tool=name)
        return f"{name}  {word(self.asked)}?" if self.asked else ""

    @property
    def note(self) -> str:
        """What has to be known before the answer is entered."""
        if self.asked in TOUCHES and self.row is not None and self.row.master:
            if self.alone:
                return tr("T{number} ALONE: THE OTHERS STAY (L: ALL FOLLOW)").format(number=self.number)
            return tr("T{number} IS THE MASTER: ALL TOOLS FOLLOW (L: IT ALONE)").format(number=self.number)
        if self.half:
            left = "Z" if "x" in self.half else "X"
            return tr("T{number} IS SET WHEN {axis} IS TOUCHED TOO").format(number=self.number, axis=left)
        return ""

    @property
    def old_to_new(self) -> str:
        """What the answer would make of the tool, or else the last change."""
        if not self.asked or self.asked == TOOL:
            return self.ledger.last_told
        mode = self.ledger.mode
        try:
            if self.asked in TOUCHES:
                _axis, name = TOUCHES[self.asked]
                new = shown_value(name, self._touched(), mode)
                was = shown_value(name, getattr(self.row, name), mode) if self.row else not_set()
                return f"{word(name)}  {was}  →  {new}"
            new = shown_value(self.asked, value_typed(self.asked, self.text, mode), mode)
        except EntryError:
            new = "…"
        name = TOUCHES[self.asked][1] if self.asked in TOUCHES else self.asked
        was = shown_value(name, getattr(self.row, name), mode) if self.row else not_set()
        return f"{word(name)}  {was}  →  {new}"

    def tip(self, snapshot: Snapshot) -> tuple[float, float] | None:
        """Where the tip of the chosen tool stands from part zero, mm; None when it was never set."""
        if self.row is None:
            return None
        x, z = self.row.offset
        return snapshot.tip[0] - x, snapshot.tip[1] - z

    def from_master(self) -> tuple[float, float] | None:
        """How far this tip stands from that of the master, mm; None without two such tools."""
        master = self.book.tools.get(self.book.master)
        if self.row is None or master is None:
            return None
        (x, z), (mx, mz) = self.row.offset, master.offset
        return x - mx, z - mz

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot) -> None:
        """Follow the loaded tool until another is chosen; an entry in another unit is given up."""
        before = self.ledger.mode
        self.ledger.look(snapshot)
        if self.ledger.mode != before and self.asked:
            self.close()
            self.desk.say(
                tr("THE CONTROL HAS CHANGED ITS UNIT OR ITS X: NOTHING WAS CHANGED, ENTER IT AGAIN")
            )
        if snapshot.modal.tool != self._active:
            self._active = snapshot.modal.tool
            if self._active and not self.asked:
                self._choose(self._active)

    def _choose(self, number: int) -> None:
        if number != self.number:
            self.number, self.half = number, {}

    # --- questions -----------------------------------------------------------------------------------

    def ask(self, what: str) -> None:
        """Open a question; says why not."""
        snapshot = self.desk.snapshot()
        why = "" if what == TOOL else self._barred(what, snapshot)
        if why:
            self.desk.say(why)
            return
        self.desk.clear()
        self.asked, self.text, self.alone = what, "", False
        if what == "remark" and self.row is not None:
            self.text = self.row.remark
        if what in TOUCHES:
            self._at = snapshot.tip["XZ".index(TOUCHES[what][0])]

    def _barred(self, what: str, snapshot: Snapshot) -> str:
        why = self.book.locked or allowed.refusal(snapshot, correction=what in allowed.CORRECTIONS)
        if why or not self.number:
            return why or tr("WHICH TOOL? PRESS T AND TYPE ITS NUMBER FIRST")
        if what not in TOUCHES:
            return "" if self.row is not None else self._never()
        axis = TOUCHES[what][0]
        if not snapshot.homed[snapshot.axes.index(axis)]:
            return tr("{axis} IS NOT HOMED: ITS POSITION MEANS NOTHING YET").format(axis=axis)
        if snapshot.state not in {State.IDLE, State.DISABLED}:
            return tr("TOUCH OFF WITH THE MACHINE AT REST AND READY")
        return ""

    def _never(self) -> str:
        return tr("T{number} WAS NEVER SET: TOUCH X AND Z FIRST").format(number=self.number)

    def close(self) -> None:
        """Nothing is asked any more."""
        self.asked, self.text, self.alone = "", "", False

    def takes(self, key: str) -> bool:
        """Whether a character goes to the entry."""
        return self.asked == "remark" or (bool(self.asked) and key in CHARACTERS)

    def typed(self, key: str) -> bool:
        """A key while something is asked; False when it means nothing in an entry."""
        if key == "Enter":
            self._enter()
        elif key == "Back":
            self.text = self.text[:-1]
        elif key == "Delete":
            self.text = ""
        elif len(key) == 1 and self.takes(key):
            if len(self.text) < (REMARK_LONGEST if self.asked == "remark" else LONGEST):
                self.text += key
        elif key in {"l", "L"} and self.asked in TOUCHES and self.row is not None and self.row.master:
            self.alone = not self.alone
        else:
            return False
        return True

    def _enter(self) -> None:
        try:
            why = self._answer()
        except EntryError as error:
            why = tr("REFUSED: {why}").format(why=error)
        if why:
            self.desk.say(why)

    def _answer(self) -> str:
        """Do what was answered; the answer is why not. Raises EntryError for a text that is no value."""
        if self.asked == TOOL:
            return self._tool()
        snapshot = self.desk.snapshot()
        why = self._barred(self.asked, snapshot)
        if why:
            return why
        return self._touch(snapshot) if self.asked in TOUCHES else self._field()

    def _tool(self) -> str:
        value = value_of(self.text)
        if value not in OFFSETS:
            raise EntryError(tr("T{number:g} does not exist; tools are T1…32").format(number=value))
        self._choose(int(value))
        self.close()
        return ""

    def _touched(self) -> float:
        """Where the tip stands on part zero, by what is typed; machine mm, X a radius. Raises EntryError."""
        share = 0.5 if self.asked == TOUCH_X else 1.0
        return self._at - to_mm(value_of(self.text) * share, self.ledger.mode.metric)

    def _touch(self, snapshot: Snapshot) -> str:
        axis, name = TOUCHES[self.asked]
        place, new = self._touched(), 0.0
        if abs(snapshot.tip["XZ".index(axis)] - self._at) > MOVED:
            return tr("THE SLIDE HAS MOVED SINCE: PRESS ESC AND TOUCH AGAIN")
        field_ = TOOL_FIELDS[name]
        new = place
        if not field_.takes(new):
            raise EntryError(tr("{axis} would be out of range").format(axis=axis))
        if self.row is None:
            return self._first(name, new)
        why = self.book.touch_off(self.number, Touch(**{name: new}, alone=self.alone), self._reason())
        if not why:
            self.close()
        return why

    def _first(self, name: str, new: float) -> str:
        """X and Z of a tool that was never set are saved together: half an offset would run into the part."""
        values = {**self.half, name: new}
        if len(values) == 2:
            why = self.book.touch_off(
                self.number, Touch(values["x"], values["z"]), tr("touched off, new tool")
            )
            if not why:
                self.half = {}
                self.close()
            return why
        self.half = values
        self.close()
        return self.note

    def _reason(self) -> str:
        """What the history says of a touch."""
        unit = "MM " if self.ledger.mode.metric else ""
        what = tr("touched Ø") if self.asked == TOUCH_X else tr("touched Z")
        return f"{unit}{what} {self.text.strip()}{tr(', alone') if self.alone else ''}"

    def _field(self) -> str:
        name, mode, row = self.asked, self.ledger.mode, self.row
        following = _AFTER.get(name, "")
        if row is None:
            return self._never()
        keeps = not self.text.strip() and TOOL_FIELDS[name].sort is not Sort.TEXT
        if not keeps:
            value = value_typed(name, self.text, mode)
            if value != getattr(row, name):
                unit = "MM " if mode.metric else ""
                why = self.book.change(
                    Kind.TOOL, self.number, {name: value}, f"{unit}{word(name)} {self.text.strip()}"
                )
                if why:
                    return why
        self.close()
        if following:
            self.asked = following
        return ""

    def master(self) -> None:
        """The chosen tool becomes the master; being it already, none is."""
        why = self._barred("master", self.desk.snapshot())
        if why or self.row is None:
            self.desk.say(why)
        elif self.row.master:
            self.ledger.answer(self.book.choose_master(0, tr("no master")))
        else:
            self.ledger.answer(self.book.choose_master(self.number, tr("chosen as master")))

    def undo(self) -> None:
        """Take the last change of the tools back."""
        self.close()
        self.ledger.undo(self.book.locked or allowed.refusal(self.desk.snapshot(), correction=False))

    def escape(self) -> bool:
        """Close the question, forget half a tool; False when there was nothing."""
        was = bool(self.asked or self.half)
        if was:
            self.desk.say(tr("T{number} IS AS IT WAS").format(number=self.number) if self.number else "")
        self.close()
        self.half = {}
        return was

    def described(self) -> str:
        """The chosen tool in one line."""
        return in_words(self.row, self.ledger.mode)
