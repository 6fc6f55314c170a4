"""Handwheel of the Jog page, and jog buttons on the machine.

The operator selects the axis of the handwheel by key or touch, or by switches of the operator station.
After the handwheel was turned off, a key can select the same axis again. A switch must first be set to
another position.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.late_presses import BlockedLateAction
from app.desk.pages.table_content import following
from app.desk.translation import tr
from app.jog.held_jog import CONTINUOUS_STEP_INDEX, MOTION_TIMEOUT_S, RENEWALS_PER_LEASE, HeldJog, JogSpeeds
from core.executor.commands import Command, DeselectHandwheel, SelectHandwheel
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.machine.station_rules import (
    AXIS_BUTTON,
    HANDWHEEL_ENABLE_INPUT,
    HANDWHEEL_INPUT,
    JOG_RAPID_INPUT,
    STEP_BUTTON,
    STEP_FACTORS,
    get_axis_selector_input,
    get_jog_button_input,
)
from core.message import Message

FINE_STEP_INDEX = 2  # Index of the step .001 in.
_LONG_STEP_INDEX = 0  # Index of the step .1 in, which is for keys only.
_STEP_BY_FACTOR = {1: 3, 10: 2, 100: 1}  # Step index for each multiple of the smallest step.

WheelChoice = tuple[str, int]  # Axis and step index.


@dataclass(slots=True)
class JogHandwheel:
    """Handwheel that moves the selected axis on the Jog page.

    ``wheel_choice`` is the selected axis and step, or None if no axis is selected.
    """

    machine: Machine
    held_jog: HeldJog
    axis_names: tuple[str, ...]  # Axes that can be jogged, in order.
    find_refusal: Callable[[], str]  # Returns why the handwheel is off now; called every frame.
    wheel_choice: WheelChoice | None = None
    _by_hand: str = ""
    _left: WheelChoice | None = None  # The switch positions when the handwheel was switched off.
    _asked: float = 0.0
    _posted: float = 0.0
    _looked: float = 0.0

    @property
    def is_available(self) -> bool:
        """Return whether the machine has a handwheel."""
        return HANDWHEEL_INPUT in self.machine.hardware.analog_inputs

    @property
    def counts_per_click(self) -> int:
        """Return the number of encoder counts per click, or 0 if the machine has no handwheel."""
        return (
            self.machine.hardware.analog_inputs[HANDWHEEL_INPUT].counts_per_click if self.is_available else 0
        )

    @property
    def has_axis_switch(self) -> bool:
        """Return whether the operator station has switches that select the axis of the handwheel."""
        return any(get_axis_selector_input(name) in self.machine.inputs for name in self.axis_names)

    @property
    def _speeds(self) -> JogSpeeds:
        return self.held_jog.jog_speeds

    @property
    def _post(self) -> Callable[[Command], None]:
        return self.held_jog.post_command

    def select_next_axis(self) -> None:
        """Select the next axis of the handwheel, or turn the handwheel off after the last axis."""
        self.select_axis(following(("", *self.axis_names), self.wheel_choice[0] if self.wheel_choice else ""))

    def select_next_step(self) -> None:
        """Select the next distance per click.

        A button of the handwheel also calls this method.
        """
        if any(name in self.machine.inputs for name in STEP_FACTORS):
            return
        fine = range(FINE_STEP_INDEX - 1, FINE_STEP_INDEX + 2)
        self._speeds.step_index = following(
            tuple(fine), self._speeds.step_index if self._speeds.step_index in fine else fine[-1]
        )

    def select_axis(self, axis: str) -> None:
        """Select the axis of the handwheel by key or touch.

        An empty axis name turns the handwheel off.
        """
        self._left = None
        if not self.is_available:
            self.held_jog.show_message(tr("THIS MACHINE HAS NO HANDWHEEL"))
        elif self.has_axis_switch:
            self.held_jog.show_message(tr("SELECT THE HANDWHEEL AXIS WITH THE OPERATOR PANEL SWITCH"))
        elif axis and self.held_jog.refuses_late_press(BlockedLateAction.HANDWHEEL):
            pass
        elif axis and (why := self.find_refusal()):
            self.held_jog.show_message(why)
        else:
            self.held_jog.release_all_keys()
            self.turn_off("")
            self._by_hand = axis
            if axis and self._speeds.step_index in {CONTINUOUS_STEP_INDEX, _LONG_STEP_INDEX}:
                self._speeds.step_index = FINE_STEP_INDEX
            self.held_jog.clear_message()

    def turn_off(self, reason: str) -> None:
        """Turn the handwheel off by deselecting its axis, and show the reason."""
        self._by_hand = ""
        if self.wheel_choice is not None:
            self._left, self.wheel_choice = self.wheel_choice, None
            self._post(DeselectHandwheel())
            self.held_jog.stop_jog(reason)  # This shows the reason again when the axis is at rest.

    def update(self, snapshot: Snapshot) -> None:
        """Renew the control's selection of the handwheel axis, or turn the handwheel off.

        This method is called once per frame.
        """
        now = self.held_jog.read_clock()
        away, self._looked = now - self._looked, now
        if not self.is_available:
            return
        wanted = self._find_wanted_choice(snapshot)
        if self.wheel_choice is not None and away > self.held_jog.motion_lease_s:
            self.turn_off(tr("SCREEN FROZE. HANDWHEEL IS OFF"))
        elif self.wheel_choice is not None and (why := self.find_refusal()):
            self.turn_off(why)
        elif wanted != self.wheel_choice and self.wheel_choice is not None:
            axis = self._by_hand if wanted is not None else ""
            self.turn_off("")
            self._by_hand, self._left = axis, None  # The step or the switch has changed.
        elif self.wheel_choice is not None and now - self._asked > MOTION_TIMEOUT_S and not snapshot.wheel:
            why = snapshot.wheel_ended.upper()  # Reason of the control.
            self.turn_off(tr(Message("HANDWHEEL IS OFF: {why}", why=why)) if why else "")
        elif wanted is not None and not self.find_refusal():
            self._renew(wanted, now)

    def _find_wanted_choice(self, snapshot: Snapshot) -> WheelChoice | None:
        """Return the axis and the step that the operator requests, or None if no axis is selected.

        They are requested by key, touch or switches. If no switch selects the step, the step of the Jog
        page applies.
        """
        axis, step = self._by_hand, self._speeds.step_index
        if self.has_axis_switch:
            on = [name for name in self.axis_names if get_axis_selector_input(name) in snapshot.inputs]
            axis = on[0] if len(on) == 1 else ""
            step = FINE_STEP_INDEX if step in {CONTINUOUS_STEP_INDEX, _LONG_STEP_INDEX} else step
        if any(name in self.machine.inputs for name in STEP_FACTORS):
            factors = [factor for name, factor in STEP_FACTORS.items() if name in snapshot.inputs]
            step = _STEP_BY_FACTOR[factors[0]] if len(factors) == 1 else CONTINUOUS_STEP_INDEX
        wanted = (axis, step) if axis and step not in {CONTINUOUS_STEP_INDEX, _LONG_STEP_INDEX} else None
        if wanted != self._left:
            self._left = None
        return wanted if self._left is None else None

    def _renew(self, wanted: WheelChoice, now: float) -> None:
        if self.wheel_choice is None:
            self._asked = now
        elif now - self._posted < self.held_jog.motion_lease_s / RENEWALS_PER_LEASE:
            return
        self.wheel_choice, self._posted = wanted, now
        axis, step = wanted
        self._post(
            SelectHandwheel(
                axis,
                self._speeds.find_step_length(axis, self.held_jog.value_mode, step),
                self.held_jog.motion_lease_s,
            )
        )


_MAX_UPDATE_INTERVAL_S = 0.25  # Seconds between two updates. Presses during a longer interval are ignored.


@dataclass(slots=True)
class MachineJogButtons:
    """Jog buttons on the machine.

    ``jog_buttons`` contains the axis and sign of each jog input by input name.
    """

    machine: Machine
    held_jog: HeldJog
    handwheel: JogHandwheel
    axis_names: tuple[str, ...]  # Axes that can be jogged.
    jog_buttons: dict[str, tuple[str, int]] = field(default_factory=dict)
    _on: frozenset[str] = frozenset()
    _looked: float = -1e9

    def __post_init__(self) -> None:
        both = ((axis, sign) for axis in self.axis_names for sign in (1, -1))
        named = {get_jog_button_input(axis, sign): (axis, sign) for axis, sign in both}
        self.jog_buttons = {name: jog_move for name, jog_move in named.items() if name in self.machine.inputs}

    def update(self, snapshot: Snapshot) -> None:
        """Handle presses and releases of the jog buttons. This method is called once per frame."""
        now, before, on = self.held_jog.read_clock(), self._on, snapshot.inputs
        away, self._looked, self._on = now - self._looked, now, on
        for name in self.jog_buttons:
            if name in before and name not in on:
                self.held_jog.release_key(name)
        if away > _MAX_UPDATE_INTERVAL_S:
            if self.jog_buttons.keys() & (on - before):
                self.held_jog.show_message(tr("SCREEN FROZE. RELEASE THE BUTTON, THEN PRESS AGAIN"))
            return
        if JOG_RAPID_INPUT in before and JOG_RAPID_INPUT not in on:
            self.held_jog.release_shift_key()
        for name in on - before:
            self._press(name, on)

    def _press(self, name: str, on: frozenset[str]) -> None:
        if name == AXIS_BUTTON:
            self.handwheel.select_next_axis()
        elif name == STEP_BUTTON:
            self.handwheel.select_next_step()
        elif name in self.jog_buttons:
            if HANDWHEEL_ENABLE_INPUT in self.machine.inputs and HANDWHEEL_ENABLE_INPUT not in on:
                self.held_jog.show_message(tr("ENABLING SWITCH NOT PRESSED. HOLD IT AND PRESS JOG BUTTON"))
                return
            axis, sign = self.jog_buttons[name]
            self.held_jog.handle_direction_press(
                name, axis, sign, is_rapid=JOG_RAPID_INPUT in on, button_name=name
            )
