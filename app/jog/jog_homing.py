"""Homing from the Jog page: the state of each axis, and a question before an axis moves."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from app.desk.desk import Desk
from app.desk.translation import tr
from core.executor.commands import Home
from core.executor.snapshot import Snapshot, State
from core.machine.machine_model import Axis, Machine
from core.message import Message


class AxisState(StrEnum):
    """Homing state of an axis."""

    HOMED = "HOMED"
    LOST = "NOT HOMED"
    LOOKING = "HOMING"
    ABSOLUTE = "ABSOLUTE"  # The encoder is absolute and needs no homing.

    @property
    def words(self) -> str:
        """The translated name of the state."""
        words = {
            AxisState.HOMED: tr("HOMED"),
            AxisState.LOST: tr("NOT HOMED"),
            AxisState.LOOKING: tr("HOMING"),
            AxisState.ABSOLUTE: tr("ABSOLUTE"),
        }
        return words[self]


@dataclass(slots=True)
class HomingQuestion:
    """The question which axes to home. Enter homes all axes in order, a letter homes one axis."""

    machine: Machine
    desk: Desk
    _asked: bool = False

    @property
    def asking(self) -> bool:
        """Whether this question is open."""
        return self._asked and self.desk.asked == "Enter"

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The axes that can be homed. C of a lathe is included only if the spindle is an axis."""
        return tuple(
            a
            for a in self.machine.axes
            if a.name != "C" or self.machine.c_enabled or self.machine.kind != "lathe"
        )

    def known(self, snapshot: Snapshot) -> dict[str, AxisState]:
        """Return the homing state of every axis."""
        homed = dict(zip(snapshot.axes, snapshot.homed, strict=True))
        lost = sorted((a for a in self.axes if not homed[a.name]), key=lambda axis: axis.home_order)
        known = {a.name: AxisState.ABSOLUTE if a.absolute else AxisState.HOMED for a in self.axes}
        known |= {axis.name: AxisState.LOST for axis in lost}
        if snapshot.state is State.HOME and lost:
            known[lost[0].name] = AxisState.LOOKING
        return known

    def lost(self, snapshot: Snapshot) -> list[str]:
        """Return the names of the axes that must be homed, in homing order."""
        known = self.known(snapshot)
        order = sorted(self.axes, key=lambda axis: axis.home_order)
        return [axis.name for axis in order if known[axis.name] in {AxisState.LOST, AxisState.LOOKING}]

    def key(self, snapshot: Snapshot, why_not: str) -> None:
        """Handle the home key: ask which axes to home, or show ``why_not``."""
        lost = self.lost(snapshot)
        if why_not:
            self.desk.say(why_not)
        elif not lost:
            self.desk.say(tr("ALL AXES HOMED"))
        else:
            text = tr("HOME {first}. ENTER: ALL AXES   {letters}: ONE AXIS   ESC: CANCEL")
            order = tr(", THEN ").join(lost)
            question = tr(Message(text, first=order, letters=tr(" OR ").join(sorted(lost))))
            self.desk.ask(_stands(snapshot) + question, lambda: self._go(""), "Enter")
            self._asked = True

    def answer(self, key: str, snapshot: Snapshot) -> bool:
        """Handle the letter of an axis while the question is open. Any other key cancels the question.

        Return True if the key was an axis letter.
        """
        if not self.asking:
            return False
        name, read = key.upper(), self.desk.read
        self.give_up()
        if name in {axis.name for axis in self.axes}:
            if name not in self.lost(snapshot):
                self.desk.say(tr(Message("{axis} IS ALREADY HOMED", axis=name)))
            elif read:
                self._go(name)
            return True
        return False

    def one(self, name: str, snapshot: Snapshot, why_not: str) -> None:
        """Handle a touch on one axis: ask first, then home this axis at a second touch."""
        if self.asking and not why_not:
            self.answer(name, snapshot)
        else:
            self.key(snapshot, why_not)

    def _go(self, axis: str) -> None:
        self._asked = False
        self.desk.clear()
        self.desk.post(Home(axis))

    def give_up(self) -> bool:
        """Cancel the question. Return False if it was not open."""
        was, self._asked = self.asking, False
        if was:
            self.desk.clear()
        return was


def _stands(snapshot: Snapshot) -> str:
    """Return a warning before the question, if a tool may be in a part. Empty otherwise."""
    found = snapshot.interrupted
    if found is None:
        return ""
    return tr(Message("T{tool} MAY BE IN THE PART. JOG IT CLEAR FIRST. ", tool=found.tool))
