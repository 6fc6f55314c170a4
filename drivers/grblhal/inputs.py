"""Inputs: pins come with every report, auxiliary ones are asked for while nothing moves; and the station."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from core.ports import Clock, StationState
from drivers.grblhal.blocks import GrblBlocks
from drivers.grblhal.controller import Controller
from drivers.grblhal.stream import Ask
from drivers.panel_station import PanelStation

_PIN, _AUX = "pn.", "in."
_APART = 0.2  # s between two questions


class GrblInputs:
    """``M66 P… L0`` reads one auxiliary input at once; the next full report tells its state.

    In the controller it waits for a standstill, so nobody asks while anything moves: the last state counts.
    """

    def __init__(self, controller: Controller, blocks: GrblBlocks) -> None:
        self._c = controller
        self._blocks = blocks
        self._read: dict[str, bool] = {}
        self._order = [name for name in controller.config.inputs if self._port(name) is not None]
        self._asked: tuple[str, Ask] | None = None
        self._fulls = 0
        self._next = 0.0

    def states(self) -> Mapping[str, bool]:
        """By the names of the machine file; one that has never been read is not in here."""
        pins = self._c.report.pins if self._c.report is not None else ""
        states = dict(self._read)
        for name, wired in self._c.config.inputs.items():
            if wired.terminal.startswith(_PIN):
                states[name] = wired.terminal.removeprefix(_PIN) in pins
        return states

    def lacking(self) -> dict[str, str]:
        """Inputs that the controller has not, and why."""
        have = self._c.identity.inputs if self._c.identity is not None else 0
        missing: dict[str, str] = {}
        for name, wired in self._c.config.inputs.items():
            port = self._port(name)
            if port is None and not wired.terminal.startswith(_PIN):
                missing[name] = f"{wired.terminal} is neither a pin nor an auxiliary input"
            elif port is not None and port >= have:
                missing[name] = f"{wired.terminal} is not among the controller's {have} auxiliary inputs"
        return missing

    def pump(self) -> None:
        """One question at a time, and none while anything moves."""
        c, now = self._c, self._c.clock.now()
        if self._asked is not None:
            self._take(*self._asked)
        elif self._order and now >= self._next and self._blocks.quiet and self._blocks.listens:
            name = self._order.pop(0)
            self._order.append(name)
            port = self._port(name)
            if name not in self.lacking() and port is not None:
                self._next = now + _APART / len(self._order)
                self._asked = name, c.send(f"M66P{port}L0")

    def _take(self, name: str, ask: Ask) -> None:
        c = self._c
        if c.fault or c.busy or ask.error:
            self._asked = None
        elif ask.done and not self._fulls:
            self._fulls = c.fulls + 1
            c.question(full=True)
        elif ask.done and c.fulls >= self._fulls and c.report is not None:
            if c.report.input is not None:
                self._read[name] = (c.report.input > 0) != self._c.config.inputs[name].active_low
            self._asked, self._fulls = None, 0

    def _port(self, name: str) -> int | None:
        text = self._c.config.inputs[name].terminal
        number = text.removeprefix(_AUX)
        return int(number) if text.startswith(_AUX) and number.isdecimal() else None


class GrblStation:
    """The station on the screen; pins of the controller that are named for it count too."""

    def __init__(self, panel: PanelStation, inputs: GrblInputs) -> None:
        self._panel = panel
        self._inputs = inputs

    def snapshot(self) -> StationState:
        """The station now."""
        state, pins = self._panel.snapshot(), self._inputs.states()
        return dataclasses.replace(
            state,
            start=state.start or pins.get("start", False),
            hold=state.hold or pins.get("hold", False),
        )


def panel_of(clock: Clock, inputs: GrblInputs) -> PanelStation:
    """The hands on the screen, with the E-stop of the controller."""
    return PanelStation(clock, lambda: bool(inputs.states().get("estop")))
