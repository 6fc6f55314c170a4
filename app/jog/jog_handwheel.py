"""The handwheel of the Jog page, and jog buttons at the machine.

The axis of the handwheel is selected by key, by touch or by switches of the operator station. After the
handwheel was switched off, the key selects it again. A switch must first be turned to another position.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.late_presses import Starting
from app.desk.pages.sheet import following
from app.desk.translation import tr
from app.jog.held_jog import BEGINS, CONTINUOUS, RENEWED, HeldJog, JogSpeeds
from core.executor.commands import Command, Wheel, WheelOff
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.machine.station_rules import (
    AXIS_BUTTON,
    ENABLE,
    FACTORS,
    JOG_RAPID,
    STEP_BUTTON,
    WHEEL,
    jog_button,
    selector,
)
from core.message import Message

FINE = 2  # Index of the step .001 in.
_LONG = 0  # Index of the step .1 in, which is for keys only.
_OF_FACTOR = {1: 3, 10: 2, 100: 1}  # Step index for each multiple of the smallest step.

Choice = tuple[str, int]  # Axis and step index.


@dataclass(slots=True)
class JogHandwheel:
    """The handwheel. ``choice`` is the axis and step that it moves, or None."""

    machine: Machine
    hold: HeldJog
    names: tuple[str, ...]  # Axes that can be jogged, in order.
    barred: Callable[[], str]  # Returns why the handwheel is off now; called every frame.
    choice: Choice | None = None
    _by_hand: str = ""
    _left: Choice | None = None  # The switch positions when the handwheel was switched off.
    _asked: float = 0.0
    _posted: float = 0.0
    _looked: float = 0.0

    @property
    def there(self) -> bool:
        """Whether the machine has a handwheel."""
        return WHEEL in self.machine.hardware.analog

    @property
    def counts(self) -> int:
        """The number of encoder counts per click, or 0 without a handwheel."""
        return self.machine.hardware.analog[WHEEL].counts_per_click if self.there else 0

    @property
    def switched(self) -> bool:
        """Whether switches of the operator station select the axis."""
        return any(selector(name) in self.machine.inputs for name in self.names)

    @property
    def _speeds(self) -> JogSpeeds:
        return self.hold.speeds

    @property
    def _post(self) -> Callable[[Command], None]:
        return self.hold.post

    def next_axis(self) -> None:
        """Select the next axis, or no axis after the last one."""
        self.choose(following(("", *self.names), self.choice[0] if self.choice else ""))

    def next_step(self) -> None:
        """Select the next step for a click, by a button of the handwheel."""
        if any(name in self.machine.inputs for name in FACTORS):
            return
        fine = range(FINE - 1, FINE + 2)
        self._speeds.step = following(
            tuple(fine), self._speeds.step if self._speeds.step in fine else fine[-1]
        )

    def choose(self, axis: str) -> None:
        """Select an axis by key or touch. An empty name switches the handwheel off."""
        self._left = None
        if not self.there:
            self.hold.say(tr("THIS MACHINE HAS NO HANDWHEEL"))
        elif self.switched:
            self.hold.say(tr("SELECT THE HANDWHEEL AXIS WITH THE OPERATOR PANEL SWITCH"))
        elif axis and self.hold.refuses(Starting.HANDWHEEL):
            pass
        elif axis and (why := self.barred()):
            self.hold.say(why)
        else:
            self.hold.let_go()
            self.drop("")
            self._by_hand = axis
            if axis and self._speeds.step in {CONTINUOUS, _LONG}:
                self._speeds.step = FINE
            self.hold.clear()

    def drop(self, why: str) -> None:
        """Switch the handwheel off, and show why."""
        self._by_hand = ""
        if self.choice is not None:
            self._left, self.choice = self.choice, None
            self._post(WheelOff())
            self.hold.stop(why)  # This shows the reason again when the axis is at rest.

    def look(self, snapshot: Snapshot) -> None:
        """Renew the selected handwheel, or switch it off; called once a frame."""
        now = self.hold.clock()
        away, self._looked = now - self._looked, now
        if not self.there:
            return
        wanted = self._wanted(snapshot)
        if self.choice is not None and away > self.hold.lease:
            self.drop(tr("SCREEN FROZE. HANDWHEEL IS OFF"))
        elif self.choice is not None and (why := self.barred()):
            self.drop(why)
        elif wanted != self.choice and self.choice is not None:
            axis = self._by_hand if wanted is not None else ""
            self.drop("")
            self._by_hand, self._left = axis, None  # The step or the switch has changed.
        elif self.choice is not None and now - self._asked > BEGINS and not snapshot.wheel:
            why = snapshot.wheel_ended.upper()  # Reason of the control.
            self.drop(tr(Message("HANDWHEEL IS OFF: {why}", why=why)) if why else "")
        elif wanted is not None and not self.barred():
            self._renew(wanted, now)

    def _wanted(self, snapshot: Snapshot) -> Choice | None:
        """Return the axis and step that key, touch or switches select, or None.

        If no switch selects the step, the page's step applies.
        """
        axis, step = self._by_hand, self._speeds.step
        if self.switched:
            on = [name for name in self.names if selector(name) in snapshot.inputs]
            axis = on[0] if len(on) == 1 else ""
            step = FINE if step in {CONTINUOUS, _LONG} else step
        if any(name in self.machine.inputs for name in FACTORS):
            factors = [factor for name, factor in FACTORS.items() if name in snapshot.inputs]
            step = _OF_FACTOR[factors[0]] if len(factors) == 1 else CONTINUOUS
        wanted = (axis, step) if axis and step not in {CONTINUOUS, _LONG} else None
        if wanted != self._left:
            self._left = None
        return wanted if self._left is None else None

    def _renew(self, wanted: Choice, now: float) -> None:
        if self.choice is None:
            self._asked = now
        elif now - self._posted < self.hold.lease / RENEWED:
            return
        self.choice, self._posted = wanted, now
        axis, step = wanted
        self._post(Wheel(axis, self._speeds.distance(axis, self.hold.mode, step), self.hold.lease))


_AWAY = 0.25  # Seconds between two updates. Presses during a longer interval are ignored.


@dataclass(slots=True)
class PendantJog:
    """Jog buttons at the machine. ``buttons`` contains the axis and sign of each input that jogs."""

    machine: Machine
    hold: HeldJog
    wheel: JogHandwheel
    names: tuple[str, ...]  # Axes that can be jogged.
    buttons: dict[str, tuple[str, int]] = field(default_factory=dict)
    _on: frozenset[str] = frozenset()
    _looked: float = -1e9

    def __post_init__(self) -> None:
        both = ((axis, sign) for axis in self.names for sign in (1, -1))
        named = {jog_button(axis, sign): (axis, sign) for axis, sign in both}
        self.buttons = {name: way for name, way in named.items() if name in self.machine.inputs}

    def look(self, snapshot: Snapshot) -> None:
        """Handle presses and releases of the buttons; called once a frame."""
        now, before, on = self.hold.clock(), self._on, snapshot.inputs
        away, self._looked, self._on = now - self._looked, now, on
        for name in self.buttons:
            if name in before and name not in on:
                self.hold.release(name)
        if away > _AWAY:
            if self.buttons.keys() & (on - before):
                self.hold.say(tr("SCREEN FROZE. RELEASE THE BUTTON, THEN PRESS AGAIN"))
            return
        if JOG_RAPID in before and JOG_RAPID not in on:
            self.hold.shift_released()
        for name in on - before:
            self._press(name, on)

    def _press(self, name: str, on: frozenset[str]) -> None:
        if name == AXIS_BUTTON:
            self.wheel.next_axis()
        elif name == STEP_BUTTON:
            self.wheel.next_step()
        elif name in self.buttons:
            if ENABLE in self.machine.inputs and ENABLE not in on:
                self.hold.say(tr("ENABLING SWITCH NOT PRESSED. HOLD IT AND PRESS JOG BUTTON"))
                return
            axis, sign = self.buttons[name]
            self.hold.press(name, axis, sign, rapid=JOG_RAPID in on, button=name)
