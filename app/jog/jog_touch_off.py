"""Touching off: where the slide stood when the tip touched, and where part zero is by what is typed.

Touch X: the diameter that was cut or touched is measured and typed; machine X less half of it is where the
tip stands on part zero. Touch Z: the position of the face that the tip touches, 0 for part zero itself.
"""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.arithmetic import EntryError, value_of
from app.desk.translation import tr
from app.offsets.offset_changes import OffsetHistory, OffsetQuestions
from app.offsets.offset_table import NewTool
from app.offsets.offset_values import TOOL_FIELDS, Mode, to_mm, word
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.offsets.touch_off import Touch

TOUCH_X, TOUCH_Z = "touch x", "touch z"
TOUCHES = {TOUCH_X: "x", TOUCH_Z: "z"}
MOVED = 0.005  # mm: more than this since the question was opened is no longer where the tip touched


def refusal(what: str, snapshot: Snapshot) -> str:
    """Why nothing is touched off now; empty when it may be."""
    axis = TOUCHES[what].upper()
    if not snapshot.homed[snapshot.axes.index(axis)]:
        return tr(Message("{axis} IS NOT HOMED AND ITS POSITION IS UNKNOWN. HOME IT FIRST", axis=axis))
    if snapshot.state not in {State.IDLE, State.DISABLED}:
        return tr("TOUCH OFF ONLY WITH THE MACHINE STOPPED AND READY")
    return ""


def slide(what: str, snapshot: Snapshot) -> float:
    """Machine position of the touched axis, mm."""
    return snapshot.tip["xz".index(TOUCHES[what])]


@dataclass(slots=True)
class TouchOff:
    """One touch of one axis; ``at`` is the machine position when the question was opened, mm.

    ``found`` is where the tip stands on part zero as the tool setter has found it, machine mm, and ``cause``
    says how: then there is nothing to type, and the slide may have gone on.
    """

    what: str = ""
    at: float = 0.0
    alone: bool = False  # of the master: the others stay
    found: float | None = None
    cause: str = ""
    by_cut: bool = False  # what is typed was measured on a cut of the tool itself

    @property
    def name(self) -> str:
        """The field of a tool that it sets."""
        return TOUCHES[self.what]

    def open(self, what: str, snapshot: Snapshot) -> None:
        """The tip touches now: remember where the slide stands."""
        self.what, self.at, self.alone = what, slide(what, snapshot), False
        self.found, self.cause, self.by_cut = None, "", False

    def cut(self, what: str, at: float) -> None:
        """The tip has cut what is measured with the slide there."""
        self.what, self.at, self.alone = what, at, False
        self.found, self.cause, self.by_cut = None, "", True

    def set(self, what: str, found: float, cause: str) -> None:
        """The tool setter has found it. It stands at the machine: the master is set for itself."""
        self.what, self.found, self.cause, self.alone, self.by_cut = what, found, cause, True, False

    def place(self, text: str, mode: Mode) -> float:
        """Where the tip stands on part zero, machine mm and X a radius. Raises EntryError."""
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
        """Save what was touched; the answer is why not. X and Z of a new tool are saved together.

        Raises EntryError for a text that is no value.
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
        """Return the touch of this axis, with part zero at ``place``, machine mm."""
        return Touch(place, None, self.alone) if self.name == "x" else Touch(None, place, self.alone)

    def _tip(self, place: float) -> float | None:
        """Return X of the tip from part zero when it touched, mm; None if a touch did not measure X."""
        return self.at - place if self.name == "x" and self.found is None else None

    def moved(self, snapshot: Snapshot) -> bool:
        """Whether the slide has left the place of the touch. Of a cut the skim cut itself knows."""
        return self.found is None and not self.by_cut and abs(slide(self.what, snapshot) - self.at) > MOVED

    def _reason(self, text: str, mode: Mode) -> str:
        """What the history says of it."""
        if self.cause:
            return f"{self.cause}{tr(', this tool only') if self.alone else ''}"
        unit = "MM " if mode.metric else ""
        names = (
            (tr("skim cut Ø"), tr("skim cut Z")) if self.by_cut else (tr("touch-off Ø"), tr("touch-off Z"))
        )
        what = names[self.what != TOUCH_X]
        return f"{unit}{what} {text.strip()}{tr(', this tool only') if self.alone else ''}"
