"""Inputs, outputs and probe of a grblHAL controller, with the names of the machine file."""

from __future__ import annotations

from collections.abc import Mapping

from core.message import Message
from core.ports import PROBE_INPUT, DriverError, TouchLatch
from drivers.grblhal.grblhal_axes import GrblAxes
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_config import ESTOP, HARDWARE
from drivers.grblhal.grblhal_controller import GrblController
from drivers.grblhal.grblhal_report import StatusReport
from drivers.grblhal.grblhal_transport import SentLine
from drivers.port_checks import FirstTouchLatch, find_output

# --- Inputs: pins are in every report; auxiliary inputs are requested at standstill.


_PIN, _AUX = "pn.", "in."
_REQUEST_INTERVAL_S = 0.2  # Seconds between two requests.


class GrblInputs:
    """Inputs of the controller: pins, which each report contains, and auxiliary inputs.

    ``M66 P… L0`` reads one auxiliary input, and the next full report contains its state. The controller
    executes this line only at standstill, so the last known state applies during motion.
    """

    def __init__(self, controller: GrblController, blocks: GrblBlocks) -> None:
        self._c = controller
        self._blocks = blocks
        self._read: dict[str, bool] = {}
        self._order = [name for name in controller.config.inputs if self._port(name) is not None]
        self._asked: tuple[str, SentLine] | None = None
        self._fulls = 0
        self._next = 0.0

    def read_input_states(self) -> Mapping[str, bool]:
        """Return the states of the inputs by name.

        Inputs that have never been read or that the board does not have are omitted.
        """
        states, report = dict(self._read), self._c.report
        if report is None:
            return states
        for name, wired in self._c.config.inputs.items():
            letter = wired.terminal.removeprefix(_PIN)
            if wired.terminal.startswith(_PIN) and self._c.has_input_pin(letter):
                states[name] = (letter in report.pins) != wired.is_active_low
        return states

    def list_missing_inputs(self) -> dict[str, str]:
        """Return the names of the inputs that the controller lacks, each with the reason."""
        have = self._c.identity.auxiliary_input_count if self._c.identity is not None else 0
        missing: dict[str, str] = {}
        for name, wired in self._c.config.inputs.items():
            port = self._port(name)
            if name == ESTOP and wired.terminal == HARDWARE:
                continue
            if port is None and not wired.terminal.startswith(_PIN):
                missing[name] = "the terminal is neither a pin nor an auxiliary input"
            elif port is None and not self._c.has_input_pin(wired.terminal.removeprefix(_PIN)):
                missing[name] = "the controller's board does not have this input"
            elif port is not None and port >= have:
                missing[name] = Message(
                    "the terminal does not exist; the controller has {count} auxiliary inputs", count=have
                )
        return missing

    def request_next_input(self) -> None:
        """Request the next auxiliary input, if the machine is at standstill and no request is pending."""
        c, now = self._c, self._c.clock.now()
        if self._asked is not None:
            self._take(*self._asked)
        elif (
            self._order
            and now >= self._next
            and self._blocks.is_at_standstill
            and self._blocks.can_accept_lines
        ):
            name = self._order.pop(0)
            self._order.append(name)
            port = self._port(name)
            if name not in self.list_missing_inputs() and port is not None:
                self._next = now + _REQUEST_INTERVAL_S / len(self._order)
                self._asked = name, c.send_line(f"M66P{port}L0")

    def _take(self, name: str, ask: SentLine) -> None:
        c = self._c
        if c.fault or c.is_script_running or ask.error_code:
            self._asked = None
        elif ask.is_acknowledged and not self._fulls:
            self._fulls = c.full_report_count + 1
            c.request_report(full=True)
        elif ask.is_acknowledged and c.full_report_count >= self._fulls and c.report is not None:
            if c.report.input is not None:
                self._read[name] = (c.report.input > 0) != self._c.config.inputs[name].is_active_low
            self._asked, self._fulls = None, 0

    def _port(self, name: str) -> int | None:
        text = self._c.config.inputs[name].terminal
        number = text.removeprefix(_AUX)
        return int(number) if text.startswith(_AUX) and number.isdecimal() else None


_COOLANT = {"flood": "M8", "mist": "M7"}
_MIST = "M"  # A letter of the build options.
ACCESSORY_LETTERS = {"flood": "F", "mist": "M"}  # Letters of the accessories in a report.
_OBEY_TIME_S = 1.0  # Seconds from the reply to a line to a report that shows its effect.
_COLLET = "collet"  # Assumed to be closed at the start.


class GrblIO:
    """``core.ports.DigitalIO`` of the controller, with flood, mist and auxiliary outputs."""

    def __init__(self, controller: GrblController, blocks: GrblBlocks, inputs: GrblInputs) -> None:
        self._c = controller
        self._blocks = blocks
        self._inputs = inputs
        outputs = controller.config.outputs
        self._wanted = {name: name == _COLLET for name in outputs}
        self._sent: dict[str, bool] = {}  # States sent since the last reset.
        self._said_at: dict[str, float] = {}  # Time when the controller executed the change.
        self._asks: dict[str, SentLine] = {}  # Lines not yet executed, which wait for earlier blocks and M3.

    def inputs(self) -> Mapping[str, bool]:
        """Return the states of the inputs by name."""
        return self._inputs.read_input_states()

    def get_outputs(self) -> Mapping[str, bool]:
        """Return the states of the outputs by name, without outputs that the controller does not have.

        A coolant output has the reported state, except in the first second after a command. An auxiliary
        output always has the commanded state, because the controller does not report it.
        """
        accessory_report = self._c.reported_accessories
        shown = {name: on for name, on in self._wanted.items() if not self.describe_missing_output(name)}
        for name, output in self._c.config.outputs.items():
            letter = ACCESSORY_LETTERS.get(output.terminal)
            said_at = self._said_at.get(name)
            if letter is None or accessory_report is None or said_at is None or name in self._asks:
                continue
            if accessory_report[0] > said_at + _OBEY_TIME_S and self._sent.get(name) == self._wanted[name]:
                shown[name] = letter in accessory_report[1]
        return shown

    def write(self, name: str, is_on: bool) -> None:
        """Switch an output.

        Raises DriverError if the machine file does not define the output, or if the output is to be
        switched on and the controller does not have it.
        """
        find_output(name, self._wanted)
        why = self.describe_missing_output(name)
        if is_on and why:
            terminal = self._c.config.outputs[name].terminal
            raise DriverError(
                "output {name} ({terminal}) cannot be switched: {why}",
                "output",
                name=name,
                terminal=terminal,
                why=why,
            )
        if self.get_outputs().get(name, is_on) is not is_on:
            self._sent[name] = not is_on  # The actual state differs, so the change must be sent again.
        self._wanted[name] = is_on
        if not why:
            self._tell(name)

    def switch_to_safe_state(self) -> None:
        """Set every output to its safe state, as soon as the controller accepts lines."""
        for name, output in self._c.config.outputs.items():
            if output.safe_state is not None and self._wanted[name] != output.safe_state:
                self.write(name, output.safe_state)

    def describe_missing_output(self, name: str) -> str:
        """Return the reason why the controller does not have an output.

        The text is empty if the controller has the output.
        """
        terminal = self._c.config.outputs[name].terminal
        if terminal in _COOLANT:
            mist = self._c.identity is not None and _MIST in self._c.identity.build_option_letters
            return (
                ""
                if terminal != "mist" or mist
                else ("the controller's firmware does not support mist coolant")
            )
        have = self._c.identity.auxiliary_output_count if self._c.identity is not None else 0
        port = terminal.removeprefix("out.")
        if port.isdecimal() and int(port) < have:
            return ""
        return Message(
            "the terminal does not exist; the controller has {count} auxiliary outputs", count=have
        )

    def list_usable_terminals(self) -> frozenset[str]:
        """Return the inputs and outputs that a program may use.

        The names are those that ``machine_requirements`` defines.
        """
        outputs = {
            Message("output {name}", name=name)
            for name in self._wanted
            if not self.describe_missing_output(name)
        }
        there = {name for name in self._c.config.inputs if name not in self._inputs.list_missing_inputs()}
        names = there | {self._c.config.inputs[name].terminal for name in there}
        return frozenset(outputs | {Message("input {name}", name=name) for name in names})

    def handle_reset(self) -> None:
        """Record that a stop or reset has switched the coolant off.

        Auxiliary outputs are not recorded as off, because they may or may not have changed.
        """
        self._asks.clear()
        for name, output in self._c.config.outputs.items():
            if output.terminal in _COOLANT:
                self._wanted[name] = False
                self._sent[name] = False
                self._said_at[name] = self._c.clock.now()

    def send_output_changes(self) -> None:
        """Send the output changes that could not be sent earlier.

        Changes are delayed while the controller is locked, jogging or in feed hold.
        """
        for name in [name for name, ask in self._asks.items() if ask.is_acknowledged]:
            del self._asks[name]
            self._said_at[name] = self._c.clock.now()
        for name, on in self._wanted.items():
            if name in self._sent and self._sent[name] != on:
                self._tell(name)

    def _tell(self, name: str) -> None:
        if not self._blocks.can_accept_lines:
            self._sent.setdefault(name, not self._wanted[name])
            return
        on = self._sent[name] = self._wanted[name]
        self._said_at[name] = self._c.clock.now()
        terminal = self._c.config.outputs[name].terminal
        if terminal in _COOLANT:
            for line in [_COOLANT[terminal]] if on else self._coolant_off_lines():
                self._asks[name] = self._c.send_line(line)
        else:
            self._c.send_line(f"M{64 if on else 65}P{terminal.removeprefix('out.')}")

    def _coolant_off_lines(self) -> list[str]:
        """Return the lines that switch off either flood or mist.

        M9 switches off both, so the other output is then switched on again if it was on.
        """
        on = [
            _COOLANT[output.terminal]
            for name, output in self._c.config.outputs.items()
            if output.terminal in _COOLANT and self._wanted[name]
        ]
        return ["M9", *on]


# --- Probe: a report contains the pin and the position of the same moment.


_ARMED_POLLING_S = 60.0  # Seconds after arming with more frequent requests.
_TOUCH_POLLING_S = 0.5  # Seconds after a touch with more frequent requests.


class GrblProbe(FirstTouchLatch):
    """Touch input evaluated from reports, which are requested more often while the probe is armed.

    G38.2 is not used, because its motion would continue if the host were lost. A jog, in contrast, ends
    when its motion lease expires.
    """

    def __init__(self, controller: GrblController, axes: GrblAxes, inputs: GrblInputs) -> None:
        super().__init__()
        self._c, self._axes, self._inputs = controller, axes, inputs
        self._report: StatusReport | None = None
        self._at = controller.clock.now()  # Time of the last evaluated report.

    def arm_latch(self) -> None:
        """Clear the latched touch, and request reports more often from now on."""
        super().arm_latch()
        self._c.fast_polling_until = self._c.clock.now() + _ARMED_POLLING_S

    def check_touch(self) -> None:
        """Check a new report for a touch.

        Call this method once per cycle, after the controller's ``run_cycle``.
        """
        now, report = self._c.clock.now(), self._c.report
        if report is self._report or report is None:
            return
        late, self._report, self._at = now - self._at, report, now
        if self._is_first_touch(self._inputs.read_input_states().get(PROBE_INPUT, False)):
            sample = self._axes.sample()
            self._kept = TouchLatch(sample.t, sample.actual, late)
            self._c.fast_polling_until = min(self._c.fast_polling_until, now + _TOUCH_POLLING_S)
