"""Inputs and outputs of the controller by the names of the machine file."""

from __future__ import annotations

from collections.abc import Mapping

from core.message import Message
from core.ports import PROBE, DriverError, Latch
from drivers.grblhal.grblhal_axes import GrblAxes
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_config import ESTOP, HARDWARE
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_report import Report
from drivers.grblhal.grblhal_wire import Ask
from drivers.port_parts import FirstTouch, output_of

# --- Inputs: pins come with every report, auxiliary ones are asked for while nothing moves.


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
        """By the names of the machine file; one that has never been read, or that the board has not, is not
        in here.
        """
        states, report = dict(self._read), self._c.report
        if report is None:
            return states
        for name, wired in self._c.config.inputs.items():
            letter = wired.terminal.removeprefix(_PIN)
            if wired.terminal.startswith(_PIN) and self._c.has_pin(letter):
                states[name] = (letter in report.pins) != wired.active_low
        return states

    def lacking(self) -> dict[str, str]:
        """Inputs that the controller has not, and why."""
        have = self._c.identity.inputs if self._c.identity is not None else 0
        missing: dict[str, str] = {}
        for name, wired in self._c.config.inputs.items():
            port = self._port(name)
            if name == ESTOP and wired.terminal == HARDWARE:
                continue
            if port is None and not wired.terminal.startswith(_PIN):
                missing[name] = "the terminal is neither a pin nor an auxiliary input"
            elif port is None and not self._c.has_pin(wired.terminal.removeprefix(_PIN)):
                missing[name] = "the controller's board does not have this input"
            elif port is not None and port >= have:
                missing[name] = Message(
                    "the terminal does not exist; the controller has {count} auxiliary inputs", count=have
                )
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


_COOLANT = {"flood": "M8", "mist": "M7"}
_MIST = "M"  # among the letters of its build
LETTERS = {"flood": "F", "mist": "M"}  # among the accessories of its reports
_OBEYS = 1.0  # s from the answer to a line to a report that has it
_COLLET = "collet"  # stays closed as it was found


class GrblIO:
    """``core.ports.DigitalIO``: flood, mist and auxiliary outputs."""

    def __init__(self, controller: Controller, blocks: GrblBlocks, inputs: GrblInputs) -> None:
        self._c = controller
        self._blocks = blocks
        self._inputs = inputs
        outputs = controller.config.outputs
        self._wanted = {name: name == _COLLET for name in outputs}
        self._sent: dict[str, bool] = {}  # what the controller has been told since it last forgot
        self._said_at: dict[str, float] = {}  # when the controller has carried it out
        self._asks: dict[str, Ask] = {}  # lines that it has not carried out: they wait behind blocks and M3

    def inputs(self) -> Mapping[str, bool]:
        """By the names of the machine file."""
        return self._inputs.states()

    def outputs(self) -> Mapping[str, bool]:
        """Coolant as the controller tells it, a second late; of auxiliary outputs it tells nothing. What it
        has not is not in here.
        """
        told = self._c.accessories
        shown = {name: on for name, on in self._wanted.items() if not self.lacking(name)}
        for name, output in self._c.config.outputs.items():
            letter = LETTERS.get(output.terminal)
            said_at = self._said_at.get(name)
            if letter is None or told is None or said_at is None or name in self._asks:
                continue
            if told[0] > said_at + _OBEYS and self._sent.get(name) == self._wanted[name]:
                shown[name] = letter in told[1]
        return shown

    def write(self, name: str, on: bool) -> None:
        """Raises DriverError for an output that the machine or the controller has not."""
        output_of(name, self._wanted)
        why = self.lacking(name)
        if on and why:
            terminal = self._c.config.outputs[name].terminal
            raise DriverError(
                "output {name} ({terminal}) cannot be switched: {why}",
                "output",
                name=name,
                terminal=terminal,
                why=why,
            )
        if self.outputs().get(name, on) is not on:
            self._sent[name] = not on  # whatever it was told before: to be said, as soon as it listens
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
            mist = self._c.identity is not None and _MIST in self._c.identity.letters
            return (
                ""
                if terminal != "mist" or mist
                else ("the controller's firmware does not support mist coolant")
            )
        have = self._c.identity.outputs if self._c.identity is not None else 0
        port = terminal.removeprefix("out.")
        if port.isdecimal() and int(port) < have:
            return ""
        return Message(
            "the terminal does not exist; the controller has {count} auxiliary outputs", count=have
        )

    def able(self) -> frozenset[str]:
        """What a program may ask of the terminals, by the names of ``machine_requirements``."""
        outputs = {Message("output {name}", name=name) for name in self._wanted if not self.lacking(name)}
        there = {name for name in self._c.config.inputs if name not in self._inputs.lacking()}
        names = there | {self._c.config.inputs[name].terminal for name in there}
        return frozenset(outputs | {Message("input {name}", name=name) for name in names})

    def voided(self) -> None:
        """A stop or a reset switches coolant off; what auxiliary outputs do then nobody tells."""
        self._asks.clear()
        for name, output in self._c.config.outputs.items():
            if output.terminal in _COOLANT:
                self._wanted[name] = False
                self._sent[name] = False
                self._said_at[name] = self._c.clock.now()

    def pump(self) -> None:
        """Say what could not be said while the controller was locked, jogged or held."""
        for name in [name for name, ask in self._asks.items() if ask.done]:
            del self._asks[name]
            self._said_at[name] = self._c.clock.now()
        for name, on in self._wanted.items():
            if name in self._sent and self._sent[name] != on:
                self._tell(name)

    def _tell(self, name: str) -> None:
        if not self._blocks.listens:
            self._sent.setdefault(name, not self._wanted[name])
            return
        on = self._sent[name] = self._wanted[name]
        self._said_at[name] = self._c.clock.now()
        terminal = self._c.config.outputs[name].terminal
        if terminal in _COOLANT:
            for line in [_COOLANT[terminal]] if on else self._coolant_off():
                self._asks[name] = self._c.send(line)
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


# --- The probe: a report tells its pin and the place at once.


_ASKS = 60.0  # s from arming on in which it asks more often
_BEHIND = 0.5  # s behind a touch in which it still does


class GrblProbe(FirstTouch):
    """Touches by reports that are asked for more often meanwhile.

    G38.2 is not used: it runs to its end when nobody is there any more, where a jog ends with its lease.
    """

    def __init__(self, controller: Controller, axes: GrblAxes, inputs: GrblInputs) -> None:
        super().__init__()
        self._c, self._axes, self._inputs = controller, axes, inputs
        self._report: Report | None = None
        self._at = controller.clock.now()  # of the last report that was looked at

    def arm(self) -> None:
        """Forget what was kept, and look often."""
        super().arm()
        self._c.hurry_until = self._c.clock.now() + _ASKS

    def pump(self) -> None:
        """Once a round, behind the conversation's own."""
        now, report = self._c.clock.now(), self._c.report
        if report is self._report or report is None:
            return
        late, self._report, self._at = now - self._at, report, now
        if self._touches(self._inputs.states().get(PROBE, False)):
            sample = self._axes.sample()
            self._kept = Latch(sample.t, sample.actual, late)
            self._c.hurry_until = min(self._c.hurry_until, now + _BEHIND)
