"""Spindle and outputs of the controller: lines at a standstill, override steps while it moves."""

from __future__ import annotations

import math
from collections.abc import Mapping

from core.ports import DriverError
from drivers.grblhal.blocks import GrblBlocks
from drivers.grblhal.controller import Controller
from drivers.grblhal.gcode import number
from drivers.grblhal.inputs import GrblInputs
from drivers.grblhal.overrides import LEAST, MOST

_COOLANT = {"flood": "M8", "mist": "M7"}
_COLLET = "collet"  # stays closed as it was found


class GrblSpindle:
    """``core.ports.Spindle``: M3, M4 and M5 while nothing moves, and else the override of the last S."""

    def __init__(self, controller: Controller, blocks: GrblBlocks) -> None:
        self._c = controller
        self._blocks = blocks
        self._wanted = 0.0
        self._said = 0.0  # of the last M3 or M4, signed
        self._runs = False  # in the controller: a stop or a reset ends that

    def run(self, rpm: float) -> None:
        """Signed rpm; 0 stops. Raises DriverError while the controller takes no lines."""
        if rpm and self._blocks.hindrance():
            raise DriverError(f"the spindle stays off: {self._blocks.hindrance()}")
        self._wanted = rpm
        self.pump()

    def coast(self) -> None:
        """The controller knows no other stop than M5."""
        self.run(0.0)

    def speed(self) -> float:
        """Measured where the controller has an encoder, else as it was commanded; signed."""
        report = self._c.report
        if report is None or report.speeds is None or len(report.speeds) < 2:
            return 0.0
        if report.measured is not None:
            return math.copysign(abs(report.measured), self._said)
        percent = self._c.overrides[2] if self._c.overrides and len(self._c.overrides) > 2 else 100
        return self._said * percent / 100.0 if report.speeds[1] else 0.0

    def angle(self) -> tuple[float, float] | None:
        """The controller keeps it to itself."""
        return None

    def fault(self) -> str:
        """Alarms are those of the axes."""
        return ""

    def voided(self) -> None:
        """A stop or a reset has switched it off; nothing switches it on again but the program."""
        self._wanted, self._runs = 0.0, False

    def pump(self) -> None:
        """Bring the controller to what is wanted."""
        c = self._c
        if not c.ready:
            return
        if self._wanted == 0.0:
            if self._runs:
                self._runs = False
                c.send("M5")
        elif self._blocks.quiet and (not self._runs or self._wanted != self._said):
            self._runs, self._said = True, self._wanted
            self._blocks.overrides.want_spindle(100)
            c.send(f"M{3 if self._wanted > 0.0 else 4}S{number(abs(self._wanted))}")
        elif self._runs and not self._blocks.quiet and self._wanted * self._said > 0.0:
            share = round(100.0 * self._wanted / self._said)
            self._blocks.overrides.want_spindle(min(max(share, LEAST), MOST))


class GrblIO:
    """``core.ports.DigitalIO``: flood, mist and auxiliary outputs."""

    def __init__(self, controller: Controller, inputs: GrblInputs) -> None:
        self._c = controller
        self._inputs = inputs
        outputs = controller.config.outputs
        self._wanted = {name: name == _COLLET for name in outputs}
        self._sent: dict[str, bool] = {}  # what the controller has been told since it last forgot

    def inputs(self) -> Mapping[str, bool]:
        """By the names of the machine file."""
        return self._inputs.states()

    def outputs(self) -> Mapping[str, bool]:
        """As last asked for."""
        return dict(self._wanted)

    def write(self, name: str, on: bool) -> None:
        """Raises DriverError for an output that the machine or the controller has not."""
        if name not in self._wanted:
            raise DriverError(f"output {name!r} is not in the machine file; add it under [io.out]")
        why = self.lacking(name)
        if on and why:
            raise DriverError(f"output {name} cannot be switched: {why}")
        self._wanted[name] = on
        if not why:
            self._tell(name)

    def safe(self) -> None:
        """Every output to its safe state; said again once the controller listens."""
        for name, output in self._c.config.outputs.items():
            if output.safe is not None and self._wanted[name] != output.safe:
                self.write(name, output.safe)

    def lacking(self, name: str) -> str:
        """Why the controller has no such output; empty when it has."""
        terminal = self._c.config.outputs[name].terminal
        if terminal in _COOLANT:
            return ""
        have = self._c.identity.outputs if self._c.identity is not None else 0
        port = terminal.removeprefix("out.")
        if port.isdecimal() and int(port) < have:
            return ""
        return f"{terminal} is not among the controller's {have} auxiliary outputs"

    def able(self) -> frozenset[str]:
        """What a program may ask of the terminals, as ``core.interpreter.needs`` names it."""
        outputs = {f"output {name}" for name in self._wanted if not self.lacking(name)}
        there = {name for name in self._c.config.inputs if name not in self._inputs.lacking()}
        names = there | {self._c.config.inputs[name].terminal for name in there}
        return frozenset(outputs | {f"input {name}" for name in names})

    def voided(self) -> None:
        """A stop or a reset switches coolant off; what auxiliary outputs do then nobody tells."""
        for name, output in self._c.config.outputs.items():
            if output.terminal in _COOLANT:
                self._wanted[name] = False
                self._sent[name] = False

    def pump(self) -> None:
        """Say what could not be said while the controller was locked."""
        for name, on in self._wanted.items():
            if name in self._sent and self._sent[name] != on:
                self._tell(name)

    def _tell(self, name: str) -> None:
        if not self._c.ready:
            self._sent.setdefault(name, not self._wanted[name])
            return
        on = self._sent[name] = self._wanted[name]
        terminal = self._c.config.outputs[name].terminal
        if terminal in _COOLANT:
            for line in [_COOLANT[terminal]] if on else self._coolant_off():
                self._c.send(line)
        else:
            self._c.send(f"M{64 if on else 65}P{terminal.removeprefix('out.')}")

    def _coolant_off(self) -> list[str]:
        """M9 ends both; what is to stay on is said again."""
        on = [
            _COOLANT[output.terminal]
            for name, output in self._c.config.outputs.items()
            if output.terminal in _COOLANT and self._wanted[name]
        ]
        return ["M9", *on]
