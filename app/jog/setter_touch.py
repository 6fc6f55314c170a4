"""Touching a tool off at the tool setter: which way its tip allows, the key that is held, what was found.

The tip's quadrant says which faces it can touch: the point that the offset is of lies on its contact there.
Of a tip that is set by its nose centre (9) the centre stands a nose radius before the face.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.translation import tr
from app.jog.held_jog import Held, HeldJog
from app.jog.jog_speeds import JogDirection
from app.jog.jog_touch_off import TOUCH_X, TOUCH_Z
from app.jog.tool_setting import ToolSetting
from app.offsets.offset_changes import refusal
from app.offsets.offset_values import signed
from core.executor.commands import Command, Touch
from core.executor.snapshot import Snapshot, State, Touched, TouchPhase
from core.machine.machine_model import Machine
from core.machine.setter_table import SetterModel
from core.message import Message
from core.ports import PROBE
from core.store.store_rows import ToolRow

Way = tuple[str, int]  # axis and sign
ALL: tuple[Way, ...] = (("X", -1), ("X", 1), ("Z", -1), ("Z", 1))
CENTRE = 9  # the offset is that of the nose centre
_WAYS: dict[int, tuple[Way, ...]] = {
    1: (("X", 1), ("Z", 1)),
    2: (("X", 1), ("Z", -1)),
    3: (("X", -1), ("Z", -1)),
    4: (("X", -1), ("Z", 1)),
    5: (("Z", 1),),
    6: (("X", 1),),
    7: (("Z", -1),),
    8: (("X", -1),),
    CENTRE: ALL,
}


def ways_of(row: ToolRow | None) -> tuple[Way, ...]:
    """Which ways this tool can be touched off; all of one that was never set, none of one without a tip."""
    return ALL if row is None else _WAYS.get(row.quadrant, ())


def stands_at(place: float, way: Way, model: SetterModel, row: ToolRow | None) -> float:
    """Where the slide stands when this tip is on part zero, mm: it touched at ``place``."""
    axis, sign = way
    before = sign * row.nose_radius if row is not None and row.quadrant == CENTRE else 0.0
    return place - (model.face(axis, sign) - before)


def way_word(way: Way) -> str:
    """X−"""
    return f"{way[0]}{'+' if way[1] > 0 else '−'}"


@dataclass(slots=True)
class SetterTouch:
    """``armed``: the next key that is held touches off. ``directions`` say which key that is."""

    desk: Desk
    machine: Machine
    tool: ToolSetting
    lease: float
    directions: tuple[JogDirection, ...]
    armed: bool = False
    _presses: int = 0
    _seen: int | None = None  # number of the last touch-off that was looked at

    @property
    def model(self) -> SetterModel | None:
        """The tool setter, where this machine has one with its input."""
        return self.machine.hardware.table(SetterModel) if PROBE in self.machine.inputs else None

    def key(self) -> None:
        """P: touch the chosen tool off, or no more."""
        if self.armed:
            self.drop()
        elif why := self._barred():
            self.desk.say(why)
        else:
            self.armed = True
            self.desk.clear()

    def drop(self) -> None:
        """No key touches anything off any more."""
        self.armed = False

    def _barred(self) -> str:
        tool, snapshot = self.tool, self.desk.snapshot()
        if self.model is None:
            return tr("THIS MACHINE HAS NO TOOL SETTER")
        if why := tool.book.locked or refusal(snapshot, correction=False):
            return why
        if not tool.number:
            return tr("NO TOOL SELECTED. PRESS T AND TYPE ITS NUMBER")
        if not ways_of(tool.row):
            return tr(Message("T{number}: TIP DIRECTION NOT SET. PRESS Q AND TYPE 1…9", number=tool.number))
        return ""

    def command(self, axis: str, sign: int, button: str) -> Command | str:
        """What a press of this direction does: a touch-off, or why not."""
        ways = ways_of(self.tool.row)
        if (axis, sign) not in ways:
            text = tr("TOUCH OFF T{number} ONLY IN DIRECTION {ways}")
            words = tr(" OR ").join(way_word(way) for way in ways)
            return tr(Message(text, number=self.tool.number, ways=words))
        self._presses += 1
        return Touch(axis, sign, self.lease, self._presses, button)

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: what a touch-off has found is asked to be kept, once the slide rests."""
        if self._seen is not None and snapshot.state is State.JOG:
            return
        touched = snapshot.touched
        number = touched.number if touched is not None else 0
        if self._seen is None or touched is None or number == self._seen:
            self._seen = number
            return
        self._seen = number
        if not self.armed or self.model is None:
            return
        if touched.place is None:
            self.desk.say(tr(Message("TOUCH-OFF FAILED: {why}", why=touched.why.upper())))
        else:
            self.armed = False
            self._found(touched, touched.place, self.model)

    def _found(self, touched: Touched, place: float, model: SetterModel) -> None:
        way = (touched.axis, touched.sign)
        value = stands_at(place, way, model, self.tool.row)
        metric = self.tool.history.mode.metric
        about = signed(touched.error, metric).removeprefix("+")
        cause = tr(
            Message(
                "measured at the tool setter, direction {direction}, ±{error}",
                direction=way_word(way),
                error=about,
            )
        )
        self.tool.found(TOUCH_X if touched.axis == "X" else TOUCH_Z, value, cause)

    def prompt(self, snapshot: Snapshot) -> str:
        """What is done now, or which keys may be held; empty when nothing is touched off."""
        if not self.armed:
            return ""
        words = {
            TouchPhase.SEARCH: tr("SEARCHING FOR THE TOOL SETTER. RELEASE THE KEY TO STOP"),
            TouchPhase.BACK_OFF: tr("CONTACT MADE. BACKING OFF"),
            TouchPhase.SLOW: tr("MEASURING WITH A SLOW TOUCH"),
            TouchPhase.RETREAT: tr("CONTACT MADE. BACKING OFF"),
            TouchPhase.RETURN: tr("NO CONTACT. RETURNING"),
        }
        if snapshot.touching is not None:
            return words[snapshot.touching]
        ways = ways_of(self.tool.row)
        keys = tr(" OR ").join(
            f"{each.label} ({way_word((each.axis, each.sign))})"
            for each in self.directions
            if (each.axis, each.sign) in ways
        )
        text = tr("TOOL SETTER, T{number}: HOLD {keys} UNTIL THE AXIS RETRACTS. ESC: CANCEL")
        return tr(Message(text, number=self.tool.number, keys=keys))


@dataclass(slots=True)
class HeldTouch(HeldJog):
    """A held jog, and where ``setter`` is armed a held touch-off."""

    setter: SetterTouch | None = None
    _asked: Command | None = field(default=None)

    def _go(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        self._asked = None
        if self.setter is None or not self.setter.armed:
            HeldJog._go(self, source, axis, sign, rapid)
            return
        asked = self.setter.command(axis, sign, self.button)
        if isinstance(asked, str):
            self.say(asked)
        elif rapid:
            self.say(tr("NO RAPID DURING TOUCH-OFF. PRESS WITHOUT SHIFT"))
        else:
            self._asked = asked
            self._hold(source, axis, float(sign), False, asked)

    def _renewal(self, held: Held, /) -> Command:
        return self._asked or HeldJog._renewal(self, held)
