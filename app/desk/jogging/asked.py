"""Tool setting in words: what is asked, what the answer would make of the tool, where its tip stands."""

from __future__ import annotations

from typing import Protocol

from app.desk.arithmetic import EntryError
from app.desk.jogging.touch import TOUCH_X, TOUCH_Z, TOUCHES, TouchOff
from app.desk.words import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_history import Ledger
from app.offsets.offset_values import Mode, marked, not_set, shown_value, value_typed, word
from app.offsets.tool_cells import ToolCells
from core.executor.snapshot import Snapshot
from core.store.rows import ToolRow

TOOL = "tool"  # asked: its number
Pair = tuple[float, float]


class Setting(Protocol):
    """What these words need of the tool setting."""

    number: int
    asked: str
    text: str

    @property
    def ledger(self) -> Ledger: ...

    @property
    def cells(self) -> ToolCells: ...

    @property
    def touching(self) -> TouchOff: ...

    @property
    def book(self) -> OffsetBook: ...

    @property
    def row(self) -> ToolRow | None: ...

    @property
    def masters(self) -> bool: ...


def question(setting: Setting) -> str:
    """What is asked now; empty when nothing is."""
    name = f"T{setting.number}"
    if setting.asked == TOOL:
        return tr("TOOL NUMBER?")
    if setting.asked == TOUCH_X:
        return tr("{tool} MEASURED DIAMETER?").format(tool=name)
    if setting.asked == TOUCH_Z:
        return tr("{tool} Z POSITION OF THE FACE?").format(tool=name)
    return f"{name}  {word(setting.asked)}?" if setting.asked else ""


def note(setting: Setting) -> str:
    """What has to be known before the answer is entered."""
    number, new = setting.number, setting.cells.new
    if setting.masters and setting.touching.alone:
        return tr("T{number} ALONE: THE OTHERS STAY (L: ALL FOLLOW)").format(number=number)
    if setting.masters:
        return tr("T{number} IS THE MASTER: ALL TOOLS FOLLOW (L: IT ALONE)").format(number=number)
    if new.number and new.number == number:
        text = tr("T{number} IS SET WHEN {axis} IS TOUCHED TOO")
        return text.format(number=number, axis=new.missing.upper())
    return ""


def old_to_new(setting: Setting) -> str:
    """What the answer would make of the tool, or else the last change."""
    if not setting.asked or setting.asked == TOOL:
        return setting.ledger.last_told
    mode, name, row = setting.ledger.mode, TOUCHES.get(setting.asked, setting.asked), setting.row
    touched, mark = setting.asked in TOUCHES, marked(name, mode)
    title = f"{word(name)} {mark}" if mark else word(name)
    was = shown_value(name, getattr(row, name), mode) if row else not_set()
    try:
        value = (
            setting.touching.place(setting.text, mode) if touched else value_typed(name, setting.text, mode)
        )
        ends = _wear_that_ends(row, f"wear_{name}", mode) if touched else ""
        return f"{title}  {was}  →  {shown_value(name, value, mode)}{ends}"
    except EntryError:
        return f"{title}  {was}  →  …"  # half a sum is no mistake yet


def _wear_that_ends(row: ToolRow | None, name: str, mode: Mode) -> str:
    """The wear of the touched axis is in the new geometry and begins again at nought."""
    if row is None or not getattr(row, name):
        return ""
    return (
        f"   {word(name)}  {shown_value(name, getattr(row, name), mode)}  →  {shown_value(name, 0.0, mode)}"
    )


def tip(setting: Setting, snapshot: Snapshot) -> Pair | None:
    """Where the tip of the chosen tool stands from part zero, mm; None when it was never set."""
    if setting.row is None:
        return None
    x, z = setting.row.offset
    return snapshot.tip[0] - x, snapshot.tip[1] - z


def from_master(setting: Setting) -> Pair | None:
    """How far this tip stands from that of the master, mm; None without two such tools."""
    master = setting.book.tools.get(setting.book.master)
    if setting.row is None or master is None:
        return None
    (x, z), (mx, mz) = setting.row.offset, master.offset
    return x - mx, z - mz
