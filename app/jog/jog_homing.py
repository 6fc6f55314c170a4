"""Homing from the Jog page: the homing state of each axis, and a question before an axis moves."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from app.desk.desk import Desk
from app.desk.translation import tr
from core.executor.commands import HomeAxes
from core.executor.snapshot import MachineState, Snapshot
from core.machine.machine_model import Axis, Machine
from core.message import Message


class HomingState(StrEnum):
    """Homing state of an axis."""

    HOMED = "HOMED"
    NOT_HOMED = "NOT HOMED"
    HOMING = "HOMING"
    ABSOLUTE = "ABSOLUTE"  # The encoder is absolute and needs no homing.

    @property
    def state_name(self) -> str:
        """Return the translated name of the homing state for display."""
        words = {
            HomingState.HOMED: tr("HOMED"),
            HomingState.NOT_HOMED: tr("NOT HOMED"),
            HomingState.HOMING: tr("HOMING"),
            HomingState.ABSOLUTE: tr("ABSOLUTE"),
        }
        return words[self]


@dataclass(slots=True)
class HomingQuestion:
    """Question that asks which axes to home.

    Enter homes all axes in order. The letter of an axis homes only that axis.
    """

    machine: Machine
    desk: Desk
    _asked: bool = False

    @property
    def is_open(self) -> bool:
        """Return whether the homing question is open."""
        return self._asked and self.desk.confirmation_key == "Enter"

    @property
    def homing_axes(self) -> tuple[Axis, ...]:
        """Return the axes that can be homed.

        C of a lathe is included only if the spindle is used as an axis.
        """
        return tuple(
            a
            for a in self.machine.axes
            if a.name != "C" or self.machine.is_c_enabled or self.machine.kind != "lathe"
        )

    def find_homing_states(self, snapshot: Snapshot) -> dict[str, HomingState]:
        """Return the homing state of every axis."""
        homed = dict(zip(snapshot.axes, snapshot.homed, strict=True))
        lost = sorted((a for a in self.homing_axes if not homed[a.name]), key=lambda axis: axis.home_order)
        known = {
            a.name: HomingState.ABSOLUTE if a.is_position_absolute else HomingState.HOMED
            for a in self.homing_axes
        }
        known |= {axis.name: HomingState.NOT_HOMED for axis in lost}
        if snapshot.state is MachineState.HOMING and lost:
            known[lost[0].name] = HomingState.HOMING
        return known

    def find_unhomed_axes(self, snapshot: Snapshot) -> list[str]:
        """Return the names of the axes that are not homed yet, in the order of homing."""
        known = self.find_homing_states(snapshot)
        order = sorted(self.homing_axes, key=lambda axis: axis.home_order)
        return [
            axis.name for axis in order if known[axis.name] in {HomingState.NOT_HOMED, HomingState.HOMING}
        ]

    def handle_home_key(self, snapshot: Snapshot, refusal: str) -> None:
        """Ask which axes to home after the home key was pressed.

        If ``refusal`` is not empty, it is shown instead of the question.
        """
        lost = self.find_unhomed_axes(snapshot)
        if refusal:
            self.desk.say(refusal)
        elif not lost:
            self.desk.say(tr("ALL AXES HOMED"))
        else:
            text = tr("HOME {first}. ENTER: ALL AXES   {letters}: ONE AXIS   ESC: CANCEL")
            order = tr(", THEN ").join(lost)
            question = tr(Message(text, first=order, letters=tr(" OR ").join(sorted(lost))))
            self.desk.ask_operator(_make_tool_warning(snapshot) + question, lambda: self._go(""), "Enter")
            self._asked = True

    def handle_axis_key(self, key: str, snapshot: Snapshot) -> bool:
        """Handle a key while the question is open, and return whether it was the letter of an axis.

        The letter of an axis starts homing that axis. Any other key cancels the question.
        """
        if not self.is_open:
            return False
        name, read = key.upper(), self.desk.was_question_read
        self.cancel()
        if name in {axis.name for axis in self.homing_axes}:
            if name not in self.find_unhomed_axes(snapshot):
                self.desk.say(tr(Message("{axis} IS ALREADY HOMED", axis=name)))
            elif read:
                self._go(name)
            return True
        return False

    def handle_axis_touch(self, name: str, snapshot: Snapshot, refusal: str) -> None:
        """Handle a touch on the homing key of one axis.

        The first touch asks for confirmation, and the second touch homes the axis.
        """
        if self.is_open and not refusal:
            self.handle_axis_key(name, snapshot)
        else:
            self.handle_home_key(snapshot, refusal)

    def _go(self, axis: str) -> None:
        self._asked = False
        self.desk.clear_prompt_line()
        self.desk.post(HomeAxes(axis))

    def cancel(self) -> bool:
        """Cancel the homing question, and return whether it was open."""
        was, self._asked = self.is_open, False
        if was:
            self.desk.clear_prompt_line()
        return was


def _make_tool_warning(snapshot: Snapshot) -> str:
    """Return a warning that a tool may still be in the part after an interrupted run, if necessary.

    The warning precedes the homing question. It is an empty string if no run was interrupted.
    """
    found = snapshot.interrupted
    if found is None:
        return ""
    return tr(Message("T{tool} MAY BE IN THE PART. JOG IT CLEAR FIRST. ", tool=found.tool))
