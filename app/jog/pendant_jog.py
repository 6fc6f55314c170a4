"""Buttons beside the slides that jog: a pendant's, or wired ones. Held as a key is, by the same rules.

A press is seen to come: a button that is down when the page is opened, or stayed down while nobody looked,
moves nothing before it has been let go.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.translation import tr
from app.jog.held_jog import HeldJog
from app.jog.jog_handwheel import JogHandwheel
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.machine.station_rules import AXIS_BUTTON, ENABLE, JOG_RAPID, STEP_BUTTON, jog_button

_AWAY = 0.25  # s between two looks; what was pressed in a longer one is old


@dataclass(slots=True)
class PendantJog:
    """``buttons`` are the inputs that jog: axis and sign of each."""

    machine: Machine
    hold: HeldJog
    wheel: JogHandwheel
    names: tuple[str, ...]  # axes that can be jogged
    buttons: dict[str, tuple[str, int]] = field(default_factory=dict)
    _on: frozenset[str] = frozenset()
    _looked: float = -1e9

    def __post_init__(self) -> None:
        both = ((axis, sign) for axis in self.names for sign in (1, -1))
        named = {jog_button(axis, sign): (axis, sign) for axis, sign in both}
        self.buttons = {name: way for name, way in named.items() if name in self.machine.inputs}

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: what went down and what came up."""
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
