"""The model of the Jog page: functions of its keys, and conditions for manual motion."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.late_presses import Starting
from app.desk.status import prompt_line
from app.desk.status.prompt_line import STOP_HELD
from app.desk.translation import tr
from app.jog.hand_functions import HandFunctions
from app.jog.held_jog import CONTINUOUS, JogDirection, JogSpeeds, directions_of
from app.jog.jog_handwheel import JogHandwheel, PendantJog
from app.jog.jog_homing import HomingQuestion
from app.jog.skim_and_setter import HeldTouch, SetterTouch, SkimCut
from app.jog.tilted_jog import TiltedJog
from app.jog.tool_setting import TOOL, TOUCH_X, TOUCH_Z, ToolSetting
from app.offsets.mill_touch import MillTouch
from core.executor.commands import JogStop
from core.executor.snapshot import ACTIVE, Snapshot, State
from core.machine.machine_model import Machine
from core.message import Message

LEASE = 0.25  # Maximum lease in seconds, also if the machine file specifies a longer one.

# Letters that ask for a value of the selected tool, while no question is open.
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
class JogModel:
    """The model of the Jog page, with jog, handwheel, homing, tool setting and manual functions."""

    desk: Desk
    machine: Machine
    speeds: JogSpeeds = field(init=False)
    hold: HeldTouch = field(init=False)
    wheel: JogHandwheel = field(init=False)
    home: HomingQuestion = field(init=False)
    tool: ToolSetting = field(init=False)
    skim: SkimCut = field(init=False)
    hand: HandFunctions = field(init=False)
    setter: SetterTouch = field(init=False)
    pendant: PendantJog = field(init=False)
    tilt: TiltedJog = field(init=False)
    directions: tuple[JogDirection, ...] = ()

    def __post_init__(self) -> None:
        desk = self.desk
        self.speeds = JogSpeeds(self.machine)
        self.directions = directions_of(self.machine)
        lease = min(self.machine.timing.lease, LEASE)
        self.hold = HeldTouch(
            self.speeds,
            lease,
            desk.post,
            desk.say,
            desk.clear,
            self._now,
            self.barred,
            refuses=desk.window.late.refuses,
        )
        moved = {each.axis for each in self.directions}
        names = tuple(axis.name for axis in self.machine.axes if axis.name in moved)
        self.wheel = JogHandwheel(self.machine, self.hold, names, self._wheel_barred)
        self.home = HomingQuestion(self.machine, desk)
        self.tool = ToolSetting(desk, desk.book)
        self.skim = SkimCut(desk, self.tool)
        hand = desk.pages.find(HandFunctions)
        if hand is None:
            raise RuntimeError("the desk was put together without functions by hand")
        self.hand = hand
        self.setter = SetterTouch(desk, self.machine, self.tool, lease, self.directions)
        self.hold.setter = self.setter
        self.pendant = PendantJog(self.machine, self.hold, self.wheel, names)
        self.tilt = TiltedJog(MillTouch.of(desk).machine, self._end_hold, desk.say)
        self.hold.along = self.tilt.along

    @property
    def asked(self) -> bool:
        """Whether an entry is open: a question about the tool, or the spindle speed."""
        return bool(self.tool.asked) or self.hand.asked

    def _now(self) -> float:
        return self.desk.hands.clock()

    def barred(self) -> str:
        """Return why axes cannot be jogged now. Empty if they can.

        An open homing question is canceled.
        """
        state = self.desk.snapshot().state
        if self.desk.window.is_stop_held():
            return tr(STOP_HELD)
        if self.asked:
            return tr("ARROWS DO NOT JOG WHILE YOU TYPE A VALUE. PRESS ENTER OR ESC")
        if self.home.give_up():
            return tr("HOMING CANCELED. PRESS THE ARROW AGAIN TO JOG")
        return why_no_jog(state)

    def _wheel_barred(self) -> str:
        """Return why the handwheel cannot move an axis now. An open question is not canceled."""
        if self.tilt.on:
            return tr("HANDWHEEL MOVES ONLY MACHINE AXES. F5: TURN 3D-ROT OFF FIRST")
        if self.asked:
            return tr("HANDWHEEL IS OFF WHILE YOU ENTER A VALUE")
        return why_no_jog(self.desk.snapshot().state)

    def look(self, snapshot: Snapshot) -> None:
        """Update all parts and renew the lease of the jog; called once a frame."""
        self.tilt.look(snapshot)
        self.hold.look(snapshot)
        self.pendant.look(snapshot)
        self.wheel.look(snapshot)
        self.setter.look(snapshot)
        self.tool.look(snapshot)
        self.skim.look(snapshot)
        self.hand.look(snapshot)
        if self.tool.asked and (self.hand.chosen or self.hand.asked):
            # The operator may be at the workpiece, so no line stays prepared during a question.
            self.hand.take_back()

    def prompt(self, snapshot: Snapshot) -> str:
        """Return the prompt of the page."""
        if self.tool.by_setter:
            return tr("ENTER: SAVE MEASURED VALUE   ESC: DISCARD")
        if self.tool.asked:
            return tr("TYPE VALUE OR EXPRESSION (.5-.002), PRESS ENTER. ESC: CANCEL")
        return self._prompt_of_work(snapshot) or self._prompt_of_jog(snapshot)

    def _prompt_of_work(self, snapshot: Snapshot) -> str:
        """Return the prompt for work other than jogging. Empty without such work."""
        hand = self.hand
        if hand.asked or hand.chosen or hand.under_way(snapshot):
            return hand.prompt(snapshot)
        words = self.skim.words(snapshot) or self.setter.prompt(snapshot)
        return (why_no_jog(snapshot.state) or words) if words else hand.prompt(snapshot)

    def _prompt_of_jog(self, snapshot: Snapshot) -> str:
        wheel = self.wheel.choice[0] if self.wheel.choice else ""
        why = jog_prompt(snapshot.state, self.home.lost(snapshot), wheel, self.speeds.step)
        if why:
            return why
        if not self.on_mill and not self.tool.number:
            return tr("HOLD AN ARROW TO JOG. SHIFT: RAPID   T: SELECT TOOL")
        if not self.on_mill:
            return tr("HOLD ARROW TO JOG. SHIFT: RAPID   T: TOOL   X, Z: TOUCH OFF")
        if self.tilt.on:
            return tr("HOLD A KEY TO JOG IN TILTED X' Y' Z'. SHIFT: RAPID")
        return tr("HOLD KEY TO JOG. SHIFT: RAPID   TOUCH OFF: F8 TOOL, F9 PART")

    # --- step and speed: any change ends the jog -----------------------------------------------------

    def next_step(self) -> None:
        """Handle F2: select the next step, and end the jog."""
        self._another_step()
        self.speeds.next_step()

    def choose_step(self, step: int) -> None:
        """Select a touched step, and end the jog."""
        self._another_step()
        self.speeds.step, self.hold.rapid_armed = step, False

    def next_speed(self) -> None:
        """Handle F3: select the next speed, and end the jog."""
        self._another_speed()
        self.speeds.next_speed()

    def choose_speed(self, speed: int) -> None:
        """Select a touched speed, and end the jog."""
        self._another_speed()
        self.speeds.speed, self.hold.rapid_armed = speed, False

    def arm(self) -> None:
        """Toggle rapid for the next jog by touch. Any other jog cancels it."""
        self._another_speed()
        self.hold.rapid_armed = not self.hold.rapid_armed

    def finger(self, source: str, axis: str, sign: int) -> None:
        """Handle a press on a direction by touch or mouse."""
        self.hold.press(source, axis, sign, rapid=self.hold.rapid_armed)

    def _another_step(self) -> None:
        self.hold.let_go(tr("JOG STOPPED: STEP CHANGED"))

    def _another_speed(self) -> None:
        self.hold.let_go(tr("JOG STOPPED: SPEED CHANGED"))

    # --- keys ----------------------------------------------------------------------------------------

    def ask(self, what: str) -> None:
        """Ask for a value of the tool, and end the jog."""
        self.hold.other_key()
        self.hand.take_back()
        self.skim.drop()
        self.tool.ask(what)

    @property
    def on_mill(self) -> bool:
        """Whether the machine is a mill, which has separate pages for tools and presets."""
        return self.machine.kind == "mill"

    def turn_tilt(self) -> None:
        """Toggle 3D-ROT, and switch the handwheel off."""
        self.wheel.drop("")
        self.tilt.key(why_no_jog(self.desk.snapshot().state))

    def _end_hold(self, why: str) -> None:
        self.hold.let_go(why)

    def press_hand(self, name: str) -> None:
        """Handle a touch on a manual function, and end the jog."""
        self.hold.other_key()
        self.hand.press(name)

    def ask_speed(self) -> None:
        """Ask for the spindle speed, and end the jog."""
        self.hold.other_key()
        self.hand.ask_speed()

    def show_hand(self) -> None:
        """Show or hide the manual functions, and end the jog."""
        self.hold.other_key()
        self.hand.toggle()

    def choose_master(self) -> None:
        """Ask whether the selected tool becomes the master, and end the jog."""
        self.hold.other_key()
        self.tool.master()

    def touch_at_setter(self) -> None:
        """Start a touch-off at the tool setter. End the jog, and switch the handwheel off."""
        self.hold.other_key()
        self.wheel.drop("")
        self.home.give_up()
        self.setter.key()

    @property
    def wheel_drawn(self) -> bool:
        """Whether the handwheel on the screen moves an axis now. It exists only with a simulated station."""
        return self.wheel.choice is not None and self.desk.hands.station is not None

    def turn_wheel(self, clicks: int) -> None:
        """Turn the handwheel on the screen."""
        station = self.desk.hands.station
        if self.wheel_drawn and station is not None and not self.desk.window.late.refuses(Starting.HANDWHEEL):
            station.turn_handwheel(clicks * self.wheel.counts)

    def home_key(self) -> None:
        """Handle the home key, which asks which axes to home."""
        self.hold.let_go()
        self.wheel.drop("")
        self.home.key(self.desk.snapshot(), self._no_homing())

    def home_one(self, axis: str) -> None:
        """Handle a touch on the homing target of one axis. A second touch homes the axis."""
        self.hold.let_go()
        self.wheel.drop("")
        self.home.one(axis, self.desk.snapshot(), self._no_homing())

    def _no_homing(self) -> str:
        if self.asked:
            return tr("FINISH THE ENTRY FIRST: PRESS ENTER OR ESC")
        state = self.desk.snapshot().state
        return tr("AXES ARE STILL MOVING") if state is State.JOG else why_no_jog(state)

    def opened(self) -> None:
        """Prepare for the open page: ignore earlier changes of offsets, and let Cycle Start run lines."""
        self.tool.history.opened()
        self.hand.opened()

    def typed(self, key: str) -> bool:
        """Handle a key. Return False to leave the key to the window."""
        if self.asked:
            return self.hand.typed(key) if self.hand.asked else self.tool.typed(key)
        if self.home.answer(key, self.desk.snapshot()):
            return True
        if (not self.on_mill and self.skim.typed(key)) or self.hand.typed(key):
            return True
        if key in {"v", "V"}:
            self.wheel.next_axis()
        elif self.on_mill:
            return False
        elif key in {"p", "P"}:
            self.touch_at_setter()
        elif key in {"m", "M"}:
            self.tool.master()
        elif key.lower() in LETTERS:
            self.ask(LETTERS[key.lower()])
        else:
            return False
        return True

    def takes(self, key: str) -> bool:
        """Return whether this character has a function on this page."""
        own = {"v", "b"} if self.on_mill else {*LETTERS, "m", "v", "p", "b", "c"}
        if self.asked:
            return self.hand.takes(key) or self.tool.takes(key)
        return key.lower() in own

    def escape(self) -> bool:
        """Handle Esc: end the jog, or cancel a question or entry. Return False if there was nothing to do."""
        if self.hold.held is not None:
            self.hold.let_go()
            return True
        if self.setter.armed:
            self.setter.drop()
            return True
        if self.wheel.choice is not None:
            self.wheel.drop(tr("HANDWHEEL IS OFF"))
            return True
        if self.home.give_up() or self.hand.take_back_by_key():
            return True
        return self.skim.escape() or self.tool.escape() or self.hand.hide()

    @property
    def active(self) -> bool:
        """Whether a key is held down or the handwheel is selected."""
        return self.hold.held is not None or self.wheel.choice is not None

    def let_go(self) -> None:
        """End the jog and the handwheel, because the page no longer gets key events."""
        self.hold.let_go(tr("JOG STOPPED: THIS PAGE NO LONGER HAS KEYBOARD FOCUS"))
        self.wheel.drop(tr("HANDWHEEL IS OFF: THIS PAGE NO LONGER HAS KEYBOARD FOCUS"))
        self.hold.rapid_armed = False
        self._stop_step()

    def _stop_step(self) -> None:
        if self.desk.snapshot().state is State.JOG:
            self.desk.post(JogStop())

    def leave(self) -> bool:
        """Return whether the page can close. If it can, end all motion, questions and entries."""
        self.hold.let_go()
        if not self.hand.leave():
            return False
        self.wheel.drop("")
        self._stop_step()
        self.home.give_up()
        self.hold.rapid_armed = False
        self.tilt.off()
        self.setter.drop()
        self.skim.drop()
        self.tool.forget()
        self.desk.clear()
        return True


def why_no_jog(state: State) -> str:
    """Return why manual motion is not possible in this state. Empty if it is possible."""
    words = {
        State.DISABLED: tr("DRIVES ARE OFF. PRESS D TO TURN THEM ON"),
        State.ESTOP: tr("E-STOP IS PRESSED. NO AXIS CAN MOVE"),
        State.FAULT: tr("ALARM ACTIVE. CORRECT ITS CAUSE, THEN PRESS R"),
        State.HOME: tr("HOMING. PRESS H TO STOP"),
    }
    if state in ACTIVE:
        return tr("PROGRAM RUNNING. TO JOG, LET IT END OR PRESS PAUSE, THEN R")
    if state in prompt_line.INTERRUPTED:
        return tr("PROGRAM NOT FINISHED. TO JOG, LET IT END OR CANCEL IT (R)")
    return words.get(state, "")


def jog_prompt(state: State, lost: list[str], wheel: str, step: int) -> str:
    """Return the prompt for manual motion.

    ``lost`` are the axes that are not homed. ``wheel`` is the axis of the handwheel, or empty.
    """
    why = why_no_jog(state)
    if why:
        return why
    if lost:
        return tr(
            Message(
                "{axes} NOT HOMED: SOFT LIMITS ARE OFF. JOG SLOWLY. PRESS HOME",
                axes=tr(" AND ").join(sorted(lost)),
            )
        )
    if wheel:
        return tr(Message("HANDWHEEL MOVES {axis}, ONE STEP PER CLICK. V: NEXT AXIS", axis=wheel))
    if step != CONTINUOUS:
        return tr("EACH ARROW PRESS JOGS ONE STEP. F2: STEP SIZE")
    return ""
