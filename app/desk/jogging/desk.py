"""The model of the Jog page: what its keys do, and what may be done now."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.jogging import notices
from app.desk.jogging.asked import TOOL
from app.desk.jogging.choices import Choices
from app.desk.jogging.directions import Direction, directions_of
from app.desk.jogging.hold import JogHold
from app.desk.jogging.home import HomeAsk
from app.desk.jogging.speeds import Speeds
from app.desk.jogging.tool import ToolSetting
from app.desk.jogging.touch import TOUCH_X, TOUCH_Z, TOUCHES
from app.desk.jogging.wheel import WheelHold
from app.desk.prompts import STOP_HELD
from app.desk.words import tr
from core.executor.commands import JogStop
from core.executor.snapshot import Snapshot, State
from core.machine.model import Machine

LEASE = 0.25  # s: no jog is held longer without renewal, whatever the machine file says

# Letters that ask something of the chosen tool, while nothing is asked.
LETTERS = {
    "t": TOOL,
    "x": TOUCH_X,
    "z": TOUCH_Z,
    "n": "nose_radius",
    "q": "quadrant",
    "w": "wear_x",
    "k": "remark",
}


@dataclass(slots=True)
class JogDesk(Choices):
    """Hold, steps and speeds, homing, tool setting. The page draws it and hands the keys on."""

    desk: Desk
    machine: Machine
    wheel: WheelHold = field(init=False)
    home: HomeAsk = field(init=False)
    tool: ToolSetting = field(init=False)
    directions: tuple[Direction, ...] = ()

    def __post_init__(self) -> None:
        desk = self.desk
        self.speeds = Speeds(self.machine)
        self.directions = directions_of(self.machine)
        self.hold = JogHold(
            self.speeds,
            min(self.machine.timing.lease, LEASE),
            desk.post,
            desk.say,
            desk.clear,
            self._now,
            self.barred,
        )
        names = tuple(dict.fromkeys(each.axis for each in self.directions))
        names = tuple(sorted(names, key=_order(self.machine)))
        self.wheel = WheelHold(self.machine, self.hold, names, self._wheel_barred)
        self.home = HomeAsk(self.machine, desk)
        self.tool = ToolSetting(desk, desk.book)

    def _now(self) -> float:
        return self.desk.hands.clock()

    def barred(self) -> str:
        """Why nothing is moved by hand now; empty when it may be."""
        state = self.desk.snapshot().state
        if self.desk.stop_held():
            return tr(STOP_HELD)
        if self.tool.asked:
            return tr("AN ENTRY IS OPEN: PRESS RETURN OR ESC; THE ARROWS MOVE NOTHING MEANWHILE")
        if self.home.give_up():
            return tr("HOMING IS NOT DONE; PRESS THE ARROW AGAIN TO JOG")
        return notices.bars(state)

    def _wheel_barred(self) -> str:
        """As ``barred``, and takes nothing back."""
        if self.tool.asked:
            return tr("AN ENTRY IS OPEN: THE HANDWHEEL IS OFF")
        return notices.bars(self.desk.snapshot().state)

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame."""
        self.hold.look(snapshot)
        self.wheel.look(snapshot)
        self.tool.look(snapshot)

    def prompt(self, snapshot: Snapshot) -> str:
        """The page's own words on the prompt line."""
        if self.tool.asked:
            return tr("TYPE A VALUE OR A SUM SUCH AS .5-.002, THEN RETURN; ESC LEAVES IT AS IT WAS")
        wheel = self.wheel.choice[0] if self.wheel.choice else ""
        return notices.prompt(snapshot.state, self.home.lost(snapshot), wheel, self.speeds.step)

    # --- keys ----------------------------------------------------------------------------------------

    def ask(self, what: str) -> None:
        """A question of the tool; what is held ends."""
        self.hold.other_key()
        if self.machine.kind == "mill" and what in TOUCHES:
            # A touched position is no length: a mill's tool would be taken for metres too short or too long.
            self.desk.say(tr("ON A MILL THE OFFSET IS THE LENGTH OF THE TOOL: MEASURE IT, AND TYPE IT ON F8"))
            return
        self.tool.ask(what)

    def choose_master(self) -> None:
        """The chosen tool becomes the master; what is held ends."""
        self.hold.other_key()
        self.tool.master()

    @property
    def wheel_drawn(self) -> bool:
        """Whether the screen's own wheel moves something now: its station is the screen's."""
        return self.wheel.choice is not None and self.desk.hands.station is not None

    def turn_wheel(self, clicks: int) -> None:
        """The wheel on the screen is turned."""
        if self.wheel_drawn and self.desk.hands.station is not None:
            self.desk.hands.station.turn_handwheel(clicks * self.wheel.counts)

    def home_key(self) -> None:
        """Home asks; home again homes all in their order."""
        self.hold.let_go()
        self.wheel.drop("")
        self.home.key(self.desk.snapshot(), self._no_homing())

    def home_one(self, axis: str) -> None:
        """A finger on one axis asks; again homes it."""
        self.hold.let_go()
        self.wheel.drop("")
        self.home.one(axis, self.desk.snapshot(), self._no_homing())

    def _no_homing(self) -> str:
        if self.tool.asked:
            return tr("AN ENTRY IS OPEN: PRESS RETURN OR ESC FIRST")
        state = self.desk.snapshot().state
        return tr("THE SLIDES ARE STILL MOVING") if state is State.JOG else notices.bars(state)

    def typed(self, key: str) -> bool:
        """A typed key; False leaves it to the window."""
        if self.tool.asked:
            return self.tool.typed(key)
        if self.home.answer(key, self.desk.snapshot()):
            return True
        if key in {"m", "M"}:
            self.tool.master()
        elif key in {"v", "V"}:
            self.wheel.next_axis()
        elif key.lower() in LETTERS:
            self.ask(LETTERS[key.lower()])
        else:
            return False
        return True

    def takes(self, key: str) -> bool:
        """Whether a character is this page's."""
        return self.tool.takes(key) or (not self.tool.asked and key.lower() in {*LETTERS, "m", "v"})

    def escape(self) -> bool:
        """Esc ends a hold, takes a question or an entry back; False when the page may be left."""
        if self.hold.held is not None:
            self.hold.let_go()
            return True
        if self.wheel.choice is not None:
            self.wheel.drop(tr("THE HANDWHEEL IS OFF"))
            return True
        return self.home.give_up() or self.tool.escape()

    @property
    def active(self) -> bool:
        """Whether something is held, or the handwheel selected."""
        return self.hold.held is not None or self.wheel.choice is not None

    def let_go(self) -> None:
        """Hands off: the keyboard, the window or the page is gone."""
        self.hold.let_go(tr("THE JOG HAS ENDED: THE KEYBOARD WENT ELSEWHERE"))
        self.wheel.drop(tr("THE HANDWHEEL IS OFF: THE KEYBOARD WENT ELSEWHERE"))
        self.armed = False
        self._stop_step()

    def _stop_step(self) -> None:
        if self.desk.snapshot().state is State.JOG:
            self.desk.post(JogStop())

    def leave(self) -> None:
        """The page goes: nothing stays held, asked or half entered."""
        self.hold.let_go()
        self.wheel.drop("")
        self._stop_step()
        self.home.give_up()
        self.armed = False
        self.tool.forget()
        self.desk.clear()


def _order(machine: Machine) -> Callable[[str], int]:
    """As the machine file has its axes."""
    return [axis.name for axis in machine.axes].index
