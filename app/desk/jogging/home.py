"""Homing: which axes know where they are, and a question before any of them moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from app.desk.words import tr
from core.executor.commands import Command, Home
from core.executor.snapshot import Snapshot, State
from core.machine.model import Axis, Machine


class Known(StrEnum):
    """Whether an axis knows its position."""

    HOMED = "HOMED"
    LOST = "NOT HOMED"
    LOOKING = "HOMING"
    ABSOLUTE = "ABSOLUTE"  # its encoder knows without homing

    @property
    def words(self) -> str:
        """For the operator."""
        words = {
            Known.HOMED: tr("HOMED"),
            Known.LOST: tr("NOT HOMED"),
            Known.LOOKING: tr("HOMING"),
            Known.ABSOLUTE: tr("ABSOLUTE"),
        }
        return words[self]


@dataclass(slots=True)
class HomeAsk:
    """The home key asks once: for all axes in their order, or for one."""

    machine: Machine
    post: Callable[[Command], None]
    say: Callable[[str], None]
    clear: Callable[[], None]
    asking: bool = False

    @property
    def axes(self) -> tuple[Axis, ...]:
        """What there is to home, C only where the spindle is an axis."""
        return tuple(
            a
            for a in self.machine.axes
            if a.name != "C" or self.machine.c_enabled or self.machine.kind != "lathe"
        )

    def known(self, snapshot: Snapshot) -> dict[str, Known]:
        """How it stands with every axis."""
        homed = dict(zip(snapshot.axes, snapshot.homed, strict=True))
        lost = sorted((a for a in self.axes if not homed[a.name]), key=lambda axis: axis.home_order)
        known = {a.name: Known.ABSOLUTE if a.absolute else Known.HOMED for a in self.axes}
        known |= {axis.name: Known.LOST for axis in lost}
        if snapshot.state is State.HOME and lost:
            known[lost[0].name] = Known.LOOKING
        return known

    def lost(self, snapshot: Snapshot) -> list[str]:
        """The axes that have to be homed, in their order."""
        known = self.known(snapshot)
        order = sorted(self.axes, key=lambda axis: axis.home_order)
        return [axis.name for axis in order if known[axis.name] in {Known.LOST, Known.LOOKING}]

    def key(self, snapshot: Snapshot, why_not: str) -> None:
        """The home key: asks, and the second time does it."""
        lost = self.lost(snapshot)
        if why_not:
            self.asking = False
            self.say(why_not)
        elif not lost:
            self.say(tr("EVERY AXIS KNOWS ITS POSITION: THERE IS NOTHING TO HOME"))
        elif not self.asking:
            self.asking = True
            text = tr("HOME {first}: PRESS HOME ONCE MORE FOR ALL, {letters} FOR ONE AXIS, ESC FOR NONE")
            order = tr(", THEN ").join(lost)
            self.say(text.format(first=order, letters=tr(" OR ").join(sorted(lost))))
        else:
            self._go("")

    def answer(self, key: str, snapshot: Snapshot) -> bool:
        """The letter of an axis while it is asked; any other key takes the question back."""
        if not self.asking:
            return False
        name = key.upper()
        if name in {axis.name for axis in self.axes}:
            if name in self.lost(snapshot):
                self._go(name)
            else:
                self.asking = False
                self.say(tr("{axis} KNOWS ITS POSITION").format(axis=name))
            return True
        self.asking = False
        self.clear()
        return False

    def one(self, name: str, snapshot: Snapshot, why_not: str) -> None:
        """A finger on one axis: the question first, then that axis."""
        if self.asking and not why_not:
            self.answer(name, snapshot)
        else:
            self.key(snapshot, why_not)

    def _go(self, axis: str) -> None:
        self.asking = False
        self.clear()
        self.post(Home(axis))

    def give_up(self) -> bool:
        """Take the question back; False when none is asked."""
        was, self.asking = self.asking, False
        if was:
            self.clear()
        return was
