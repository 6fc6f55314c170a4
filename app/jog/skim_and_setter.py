"""Touch-off of a tool by a skim cut (cut, retract, stop, measure, enter) or at the tool setter.

After the cut of a diameter, X must not move until the size is entered, and after a face Z. The tool retracts
along the other axis. The offset is calculated from the axis position during the cut. If this axis moves after
the cut, the position may belong to another cut and is discarded.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum, auto

from app.desk.desk import Desk
from app.desk.status.formats import length
from app.desk.status.readouts import TURNING
from app.desk.translation import tr
from app.jog.held_jog import Held, HeldJog, JogDirection
from app.jog.tool_setting import MOVED, TOUCH_X, TOUCH_Z, TOUCHES, ToolSetting
from app.offsets.offset_changes import refusal
from app.offsets.offset_values import signed
from core.executor.commands import Command, Touch
from core.executor.snapshot import CYCLE, Snapshot, State, Touched, TouchPhase
from core.machine.machine_model import Machine
from core.machine.setter_table import SetterModel
from core.message import Message
from core.ports import PROBE
from core.store.store_rows import ToolRow

# Minimum cut in mm along the other axis with the spindle turning. A shorter cut cannot be measured.
LEAST_CUT = 0.25


class CutStep(Enum):
    """The next step of a skim cut."""

    OFF = auto()
    AXIS = auto()  # Choose a diameter or a face.
    CUT = auto()
    AWAY = auto()  # Retract along the other axis and stop the spindle.
    MEASURE = auto()  # The size is being entered.


@dataclass(slots=True)
class SkimCut:
    """A touch-off by a skim cut. Offsets change only when the size is entered. Esc cancels."""

    desk: Desk
    tool: ToolSetting
    step: CutStep = CutStep.OFF
    what: str = ""  # =
    at: float = 0.0  # Machine position of the axis during the cut in mm, by its encoder.
    # Commanded position during the cut in mm. The cutting force deflects the axis, which then springs back.
    sent: float = 0.0
    way: float = 0.0  # Distance in mm along the other axis with the spindle turning, since this axis moved.
    spoilt: str = ""  # Why the last cut is no longer valid.
    # Positions of both axes at the beginning of this distance.
    _stands: tuple[float, float] | None = field(default=None)

    @property
    def open(self) -> bool:
        """Whether a skim cut is in progress."""
        return self.step is not CutStep.OFF

    @property
    def axis(self) -> str:
        """The axis that is measured and must not move after the cut."""
        return TOUCHES[self.what].upper() if self.what else ""

    @property
    def other(self) -> str:
        """The axis along which the tool cuts and retracts."""
        return "Z" if self.axis == "X" else "X"

    # --- keys ----------------------------------------------------------------------------------------

    def begin(self) -> None:
        """Ask for the axis, or show why no tool can be set now."""
        if self.open:
            return
        why = self.tool.barred(TOUCH_X, self.desk.snapshot())
        if why:
            self.desk.say(why)
            return
        self.desk.clear()
        self.step = CutStep.AXIS

    def choose(self, what: str) -> None:
        """Select a diameter or a face as the cut."""
        why = self.tool.barred(what, self.desk.snapshot())
        if why:
            self.desk.say(why)
            return
        self.desk.clear()
        self.what, self.step = what, CutStep.CUT
        self._anew(self.desk.snapshot())

    def made(self) -> None:
        """Finish the cut, and store the position of the axis."""
        snapshot = self.desk.snapshot()
        why = self._no_cut(snapshot)
        if why:
            self.desk.say(why)
            return
        self.desk.clear()
        self.at = snapshot.tip["XZ".index(self.axis)]
        self.sent, self.step, self.spoilt = self._place(snapshot), CutStep.AWAY, ""

    def _no_cut(self, snapshot: Snapshot) -> str:
        """Return why there is no cut to measure yet. Empty if there is one."""
        if snapshot.state is not State.IDLE:
            return tr("AXES ARE STILL MOVING. WAIT UNTIL THEY STOP")
        if self.way >= LEAST_CUT:
            return ""
        if abs(snapshot.rpm_actual) <= TURNING:
            return tr("NO CUT YET, SPINDLE STOPPED. PRESS B TO START IT")
        return tr(
            Message(
                "NO CUT YET: {axis} MOVED LAST. FEED {other} WITHOUT MOVING {axis}",
                axis=self.axis,
                other=self.other,
            )
        )

    def typed(self, key: str) -> bool:
        """Handle a key. Return False to leave the key to the page."""
        if self.step is CutStep.AXIS and key.lower() in {"x", "z"}:
            self.choose(TOUCH_X if key.lower() == "x" else TOUCH_Z)
        elif self.step is CutStep.CUT and key == "Enter":
            self.made()
        elif not self.open and key in {"c", "C"}:
            self.begin()
        else:
            return False
        return True

    def escape(self) -> bool:
        """Handle Esc: cancel the skim cut. Return False if none is in progress."""
        was = self.open
        if was:
            self.drop()
            self.desk.say(tr("SKIM CUT CANCELED, NOTHING CHANGED"))
        return was

    def drop(self) -> None:
        """End the skim cut without a change of offsets."""
        if self.step is CutStep.MEASURE:
            self.tool.close()
        self.step, self.what, self.spoilt = CutStep.OFF, "", ""
        self.way, self._stands = 0.0, None

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot) -> None:
        """Follow the axes and the spindle, and advance the skim cut; called once a frame."""
        if not self.open or self.step is CutStep.AXIS:
            return
        why = self._spoilt(snapshot)
        if why:
            self.drop()
            self.desk.say(why)
        elif self.step is CutStep.CUT:
            self._follow(snapshot)
        elif abs(self._place(snapshot) - self.sent) > MOVED:
            self._moved(snapshot)
        elif self.step is CutStep.AWAY:
            self._measure(snapshot)
        elif not self.tool.asked:  # The value was saved or canceled.
            self.drop()
        elif self._turns(snapshot):
            self.tool.close()
            self.step = CutStep.AWAY

    def _spoilt(self, snapshot: Snapshot) -> str:
        """Return why the skim cut cannot continue. Empty if it can."""
        if snapshot.state in {State.ESTOP, State.FAULT, State.DISABLED, State.HOME}:
            return tr("MACHINE STOPPED. SKIM CUT CANCELED. NOTHING CHANGED")
        if not snapshot.homed[snapshot.axes.index(self.axis)]:
            return tr(Message("{axis} IS NOT HOMED. SKIM CUT CANCELED, NOTHING CHANGED", axis=self.axis))
        return ""

    def _follow(self, snapshot: Snapshot) -> None:
        """Measure the distance along the other axis with the spindle turning, since this axis moved last."""
        if self._stands is None or abs(self._place(snapshot) - self._stands[0]) > MOVED:
            self._anew(snapshot)
        elif self._turns(snapshot):
            self.way = max(self.way, abs(self._beside(snapshot) - self._stands[1]))
        elif not self.way:
            self._stands = (self._stands[0], self._beside(snapshot))

    def _anew(self, snapshot: Snapshot) -> None:
        self.way, self._stands = 0.0, (self._place(snapshot), self._beside(snapshot))

    def _moved(self, snapshot: Snapshot) -> None:
        """Discard the stored position, because the axis moved after the cut."""
        mode = self.tool.history.mode
        away = self._place(snapshot) - self.sent
        shown = length(2 * away if self.axis == "X" and mode.diameter else away, mode.metric)
        if self.step is CutStep.MEASURE:
            self.tool.close()
        self.step = CutStep.CUT
        self._anew(snapshot)
        words = tr("{axis} MOVED {away} AFTER THE CUT. NOT SAVED. CUT AGAIN OR PRESS ESC")
        self.spoilt = tr(Message(words, axis=self.axis, away=shown))

    def _measure(self, snapshot: Snapshot) -> None:
        """Ask for the size when the spindle and the axes are at rest."""
        if snapshot.state is State.IDLE and not self._turns(snapshot):
            self.step = CutStep.MEASURE
            self.tool.measured(self.what, self.at)

    @staticmethod
    def _turns(snapshot: Snapshot) -> bool:
        return abs(snapshot.rpm_actual) > TURNING or snapshot.rpm_command != 0.0

    def _place(self, snapshot: Snapshot) -> float:
        return snapshot.demand[snapshot.axes.index(self.axis)]

    def _beside(self, snapshot: Snapshot) -> float:
        return snapshot.demand[snapshot.axes.index(self.other)]

    # --- display -------------------------------------------------------------------------------------

    def words(self, snapshot: Snapshot) -> str:
        """Return the prompt for the next step."""
        if self.step is CutStep.AXIS:
            return tr("SKIM CUT. X: DIAMETER   Z: FACE   ESC: CANCEL")
        if self.step is CutStep.AWAY:
            words = tr("RETRACT {other} ONLY. DO NOT MOVE {axis}. THEN 0: STOP SPINDLE")
            return tr(Message(words, axis=self.axis, other=self.other))
        return self._words_of_cut(snapshot) if self.step is CutStep.CUT else ""

    def _words_of_cut(self, snapshot: Snapshot) -> str:
        if self.spoilt and self.way < LEAST_CUT:
            return self.spoilt
        if self.way >= LEAST_CUT and snapshot.state not in CYCLE:
            words = tr("CUT FAR ENOUGH IN {other} TO MEASURE, THEN PRESS ENTER")
            return tr(Message(words, other=self.other))
        if not self._turns(snapshot):
            return tr("START THE SPINDLE (B), THEN JOG INTO THE CUT. ESC: CANCEL")
        words = tr("JOG {axis} TO THE DEPTH OF CUT, THEN FEED IN {other}. ESC: CANCEL")
        return tr(Message(words, axis=self.axis, other=self.other))


Way = tuple[str, int]  # Axis and sign.
ALL: tuple[Way, ...] = (("X", -1), ("X", 1), ("Z", -1), ("Z", 1))
CENTRE = 9  # The offset refers to the nose center.
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
    """Return the directions in which this tool can be touched off.

    A tool that was never set allows all directions. A tool without a tip quadrant allows none.
    """
    return ALL if row is None else _WAYS.get(row.quadrant, ())


def stands_at(place: float, way: Way, model: SetterModel, row: ToolRow | None) -> float:
    """Return the machine position in mm at which this tip is on part zero. The tip touched at ``place``."""
    axis, sign = way
    before = sign * row.nose_radius if row is not None and row.quadrant == CENTRE else 0.0
    return place - (model.face(axis, sign) - before)


def way_word(way: Way) -> str:
    """Return a direction as text, for example X−."""
    return f"{way[0]}{'+' if way[1] > 0 else '−'}"


@dataclass(slots=True)
class SetterTouch:
    """Touch-off at the tool setter.

    ``armed`` means that the next direction key starts a touch-off. ``directions`` contain the keys.
    """

    desk: Desk
    machine: Machine
    tool: ToolSetting
    lease: float
    directions: tuple[JogDirection, ...]
    armed: bool = False
    _presses: int = 0
    _seen: int | None = None  # Number of the last touch-off that was processed.

    @property
    def model(self) -> SetterModel | None:
        """The tool setter from the machine file. None if the machine has no tool setter with an input."""
        return self.machine.hardware.table(SetterModel) if PROBE in self.machine.inputs else None

    def key(self) -> None:
        """Handle P: arm or cancel the touch-off of the selected tool."""
        if self.armed:
            self.drop()
        elif why := self._barred():
            self.desk.say(why)
        else:
            self.armed = True
            self.desk.clear()

    def drop(self) -> None:
        """Cancel the touch-off."""
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
        """Return the touch-off command for this direction, or the reason as text if it is not possible."""
        ways = ways_of(self.tool.row)
        if (axis, sign) not in ways:
            text = tr("TOUCH OFF T{number} ONLY IN DIRECTION {ways}")
            words = tr(" OR ").join(way_word(way) for way in ways)
            return tr(Message(text, number=self.tool.number, ways=words))
        self._presses += 1
        return Touch(axis, sign, self.lease, self._presses, button)

    def look(self, snapshot: Snapshot) -> None:
        """Ask whether to save the result of a touch-off, when the axis is at rest; called once a frame."""
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
        """Return the prompt for the touch-off. Empty if no touch-off is armed."""
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
    """A continuous jog, or a touch-off while a key is held down if ``setter`` is armed."""

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
