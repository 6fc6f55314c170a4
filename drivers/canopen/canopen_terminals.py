"""Inputs, outputs, pots and the operator station on CiA 401 modules, named as in the machine file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import canopen

from core.ports import PROBE_INPUT, DriverError, Fault, StationState, TouchLatch
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_nodes import CanNode, CanTerminal
from drivers.canopen.canopen_setup import NodeSetup, build_monitoring_objects
from drivers.canopen.cia402_drives import Cia402Drive
from drivers.operator_station import build_station_state
from drivers.port_checks import FirstTouchLatch, find_output, require_output_allowed

# --- A CiA 401 module: inputs, outputs with safe states, and analog words.


PDO_BYTE_COUNT = 8  # Bytes of inputs or outputs in one PDO.
_PDO_WORDS = 4  # Analog words in one PDO.
_ANALOG_DELTA = 328  # 1 % of an analog word
_RESEND_PERIOD_S = 0.1  # Seconds after which unchanged outputs are sent again.
_SYNCS, _BEATS = 3, 3.0  # Replies to SYNC and heartbeats that may be missing.
_TERMINAL_KINDS = ((od.DIGITAL_IN, "input bytes"), (od.DIGITAL_OUT, "output bytes"), (od.ANALOG_IN, "pots"))


class Cia401Module:
    """I/O module on the CAN bus (CiA 401), with the number of terminals that it reports.

    Only the terminals in the first PDOs of the module can be used.
    """

    def __init__(self, config: CanNode, bus: CanBus) -> None:
        self.config = config
        self._bus = bus
        objects = od.load_object_dictionary(config.name, config.eds, od.build_module_dictionary)
        self.setup = NodeSetup(bus, config.name, config.id, objects)
        self.node = self.setup.node
        self.inputs = bytearray(PDO_BYTE_COUNT)
        self.outputs = bytearray(PDO_BYTE_COUNT)
        self.analog = [0] * _PDO_WORDS
        self.counter_subindices: set[int] = set()  # Sub-indices of analog words that are counters.
        self.terminal_counts = {od.DIGITAL_IN: 0, od.DIGITAL_OUT: 0, od.ANALOG_IN: 0}
        self.last_heartbeat_s = self.last_reply_s = bus.clock.now()
        self.missing_reply_count = 0
        self.failure: Fault | str = ""
        self._sent = (-1e9, b"")

    def read_terminal_counts(self, required_terminals: Iterable[CanTerminal]) -> None:
        """Read the number of terminals from the module.

        Raises DriverError if the node does not respond or is not a CiA 401 module, or if a required
        terminal does not exist.
        """
        self.setup.enter_pre_operational()
        self.setup.require_profile(401)
        most = {od.DIGITAL_IN: PDO_BYTE_COUNT, od.DIGITAL_OUT: PDO_BYTE_COUNT, od.ANALOG_IN: _PDO_WORDS}
        self.terminal_counts = {
            index: min(self.setup.count_array_entries(index), most[index]) for index in most
        }
        for where in required_terminals:
            if where.object_subindex > self.terminal_counts[where.index]:
                has = ", ".join(f"{self.terminal_counts[index]} {what}" for index, what in _TERMINAL_KINDS)
                raise DriverError(
                    "{name}: the module has {has}, so object {index}.{sub} does not exist; check the "
                    "module's terminals in the machine file",
                    name=self.config.name,
                    has=has,
                    index=f"{where.index:04X}",
                    sub=where.object_subindex,
                )

    def connect(self, safe_values: bytes, retained_bits: bytes) -> None:
        """Configure the PDO mapping, and the output states that apply if this computer fails.

        ``safe_values`` contains the states as bits; the outputs in ``retained_bits`` must not change.
        Raises DriverError if the module does not respond, rejects a value, or lacks the heartbeat objects.
        """
        inputs, outputs, words = self.terminal_counts.values()
        for i in range(outputs):
            self.setup.write(
                od.ERROR_MODE, i + 1, 0xFF & ~retained_bits[i]
            )  # 1: set the error value, 0: no change.
            self.setup.write(od.ERROR_VALUE, i + 1, safe_values[i])
        if words:
            self.setup.write(od.ANALOG_EVENTS, 0, 1)
        for i in range(words):
            self.setup.write(od.ANALOG_DELTA, i + 1, 1 if i + 1 in self.counter_subindices else _ANALOG_DELTA)
        self.setup.configure_objects(
            build_monitoring_objects(self._bus.config), self.config.sdo, (od.HEARTBEAT, od.WATCHED)
        )
        if outputs:
            self.setup.map_received_objects(1, *_entries(od.DIGITAL_OUT, outputs, 8), event_driven=True)
        every = self._bus.config.slow_reply_divisor
        if inputs:
            self.setup.map_sent_objects(1, self._digital, *_entries(od.DIGITAL_IN, inputs, 8), every=every)
        if words:
            self.setup.map_sent_objects(2, self._words, *_entries(od.ANALOG_IN, words, 16), every=every)
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.outputs[:outputs] = bytes(self.setup.read(od.DIGITAL_OUT, i + 1) for i in range(outputs))
        # Read the pots before their first PDO, because a pot at 0 would stop a cycle that starts immediately.
        self.analog[:words] = [_to_signed(self.setup.read(od.ANALOG_IN, i + 1)) for i in range(words)]
        self.last_heartbeat_s, self.missing_reply_count, self.failure = self._bus.clock.now(), 0, ""

    def record_sync(self) -> None:
        """Record that a SYNC was sent, to which a module with inputs must reply.

        A module without inputs is monitored only by its heartbeat.
        """
        if self.terminal_counts[od.DIGITAL_IN] or self.terminal_counts[od.ANALOG_IN]:
            self.missing_reply_count += 1

    def send_outputs(self, now_s: float) -> None:
        """Send the outputs if they have changed, and again every 0.1 s."""
        when, what = self._sent
        outputs = bytes(self.outputs[: self.terminal_counts[od.DIGITAL_OUT]])
        if outputs and (outputs != what or now_s - when >= _RESEND_PERIOD_S):
            self._bus.send_message(0x200 + self.config.id, outputs)
            self._sent = (now_s, outputs)

    @property
    def is_silent(self) -> bool:
        """Return whether so many replies or heartbeats are missing that the inputs may be outdated."""
        return self.missing_reply_count > _SYNCS or self._without_beat > _BEATS * self._bus.config.heartbeat

    @property
    def _without_beat(self) -> float:
        return self._bus.clock.now() - self.last_heartbeat_s

    def supervise_module(self) -> None:
        """Set a fault if heartbeats or replies are missing.

        The fault remains active until ``connect`` is called.
        """
        name, silent = self.config.name, self._without_beat
        if silent > _BEATS * self._bus.config.heartbeat:
            self._wrong(
                "{name}: no heartbeat from the I/O module for {silent} s; check cable and power",
                name=name,
                silent=f"{silent:.2f}",
            )
        elif self.missing_reply_count > _SYNCS:
            self._wrong("{name}: the I/O module does not respond to SYNC; check cable and power", name=name)

    def _digital(self, map_: canopen.pdo.PdoMap) -> None:
        self.inputs[: len(map_.data)] = map_.data
        self.missing_reply_count, self.last_reply_s = 0, self._bus.clock.now()

    def _words(self, map_: canopen.pdo.PdoMap) -> None:
        for i in range(min(_PDO_WORDS, len(map_.data) // 2)):
            self.analog[i] = int.from_bytes(map_.data[2 * i : 2 * i + 2], "little", signed=True)
        if not self.terminal_counts[od.DIGITAL_IN]:
            self.missing_reply_count, self.last_reply_s = 0, self._bus.clock.now()

    def _heartbeat(self, state: int) -> None:
        self.last_heartbeat_s = self._bus.clock.now()
        if not (self.terminal_counts[od.DIGITAL_IN] or self.terminal_counts[od.ANALOG_IN]):
            self.last_reply_s = self.last_heartbeat_s
        if state == 0:
            self._wrong(
                "{name}: the I/O module has restarted; its outputs have dropped out", name=self.config.name
            )

    def _wrong(self, what: str, **values: object) -> None:
        self.failure = self.failure or Fault(what, "io-silent", **values)


def _to_signed(word: int) -> int:
    """Convert a 16-bit analog word into a signed number."""
    return (word + 2**15) % 2**16 - 2**15


def _entries(index: int, count: int, bits: int) -> list[tuple[int, int]]:
    return [(index | sub << 16, bits) for sub in range(1, count + 1)]


_ANALOG_FULL_SCALE = 32767.0  # Full scale of an analog word.


class CanopenIO:
    """Inputs, outputs and operator station on the I/O modules, with the names of the machine file.

    The class implements ``core.ports.DigitalIO`` and ``core.ports.OperatorStation``.
    """

    def __init__(self, config: CanopenConfig, bus: CanBus, drives: Mapping[str, Cia402Drive]) -> None:
        self._config = config
        self._bus = bus
        self._drives = drives
        self.modules = {module.name: Cia401Module(module, bus) for module in config.io_modules}
        wheel = config.pots.get("handwheel")
        if wheel is not None:
            self._module(wheel.terminal).counter_subindices.add(wheel.terminal.object_subindex)
        self._written: dict[str, bool] = {}
        self._heard: tuple[object, ...] = ()  # Last received words of the inputs.
        self._inputs: Mapping[str, bool] = {}
        self._wheel: tuple[int, int] | None = None  # Counter at the last reading, and accumulated counts.

    def connect(self) -> None:
        """Configure every module, including the safe states of its outputs.

        Raises DriverError if a module does not respond, or if a module or drive does not match the machine
        file.
        """
        for where in self._required_terminals():
            drive = self._drives.get(where.node_name)
            if drive is not None and not drive.reports_inputs:
                raise DriverError(
                    "{node}: the drive does not report digital inputs; in the machine file, assign the "
                    "inputs to an I/O module",
                    node=where.node_name,
                )
        for name, module in self.modules.items():
            module.read_terminal_counts(
                where for where in self._required_terminals() if where.node_name == name
            )
            safe, keep = bytearray(PDO_BYTE_COUNT), bytearray(PDO_BYTE_COUNT)
            for output in self._config.outputs.values():
                where = output.terminal
                if where.node_name == name:
                    table = keep if output.safe_state is None else safe
                    table[where.object_subindex - 1] |= (output.safe_state is not False) << where.bit_number
            module.connect(bytes(safe), bytes(keep))
        for name, output in self._config.outputs.items():
            self._written[name] = self._bit(self._module(output.terminal).outputs, output.terminal)

    def _required_terminals(self) -> Iterator[CanTerminal]:
        """Yield all terminals in the machine file, including the terminals of drives."""
        config = self._config
        yield from config.inputs.values()
        yield from (output.terminal for output in config.outputs.values())
        yield from (pot.terminal for pot in config.pots.values())

    def start_nodes(self) -> None:
        """Start the modules by NMT."""
        for module in self.modules.values():
            module.node.nmt.state = "OPERATIONAL"

    def run_cycle(self, now: float) -> str:
        """Supervise the modules, and send the outputs.

        Returns the first fault, or an empty string if there is no fault.
        """
        fault_text: str = ""
        for module in self.modules.values():
            module.supervise_module()
            fault_text = fault_text or module.failure
            module.send_outputs(now)
        return fault_text

    def clear_fault(self) -> None:
        """Configure all modules again if a module has restarted or did not respond.

        Raises DriverError if a module cannot be configured.
        """
        if any(module.failure for module in self.modules.values()):
            self.connect()
            self.start_nodes()

    def inputs(self) -> Mapping[str, bool]:
        """Return the states of all inputs by name; True means active."""
        raw_inputs = (
            *(bytes(module.inputs) for module in self.modules.values()),
            *(drive.digital_inputs for drive in self._drives.values()),
        )
        if raw_inputs != self._heard:
            self._heard = raw_inputs
            self._inputs = {name: self._read(where) for name, where in self._config.inputs.items()}
        return self._inputs

    def get_outputs(self) -> Mapping[str, bool]:
        """Return the states of all outputs by name, as last commanded."""
        return dict(self._written)

    def write(self, name: str, is_on: bool) -> None:
        """Switch one output; the module receives the change at the next tick.

        Raises DriverError if the output does not exist, or if it is to be switched on during a fault.
        """
        output = find_output(name, self._config.outputs)
        module = self._module(output.terminal)
        require_output_allowed(name, is_on, self._bus.failure or module.failure)
        self._switch(name, output.terminal, is_on)

    def _switch(self, name: str, where: CanTerminal, on: bool) -> None:
        module = self._module(where)
        raw = on is not where.is_active_low
        byte = module.outputs[where.object_subindex - 1] & ~(1 << where.bit_number)
        module.outputs[where.object_subindex - 1] = byte | raw << where.bit_number
        self._written[name] = on

    def switch_to_safe_state(self) -> None:
        """Set every output to its safe state, and send the outputs at once unless the bus has failed."""
        for name, output in self._config.outputs.items():
            if output.safe_state is not None:
                self._switch(name, output.terminal, output.safe_state)
        if not self._bus.failure:
            for module in self.modules.values():
                module.send_outputs(self._bus.clock.now())

    def read_state(self) -> StationState:
        """Return the state of the operator station.

        The age of the state is the age of the oldest module reply.
        """
        now = self._bus.clock.now()
        age = max((now - module.last_reply_s for module in self.modules.values()), default=0.0)
        return build_station_state(
            self.inputs(),
            self._config.pots,
            lambda name: self._read_analog(name) / _ANALOG_FULL_SCALE,
            handwheel=self._update_wheel_counts(),
            age_s=age,
        )

    def _update_wheel_counts(self) -> int:
        """Update and return the handwheel counts since power-up.

        The 16-bit counter wraps around, so it must change by less than half of its range between two calls.
        """
        if "handwheel" not in self._config.pots:
            return 0
        raw = self._read_analog("handwheel")
        if self._wheel is None:
            self._wheel = (raw, 0)
        last, count = self._wheel
        count += (raw - last + 0x8000) % 0x10000 - 0x8000
        self._wheel = (raw, count)
        return count

    def _read_analog(self, name: str) -> int:
        """Return the analog word of a pot or handwheel."""
        where = self._config.pots[name].terminal
        return self._module(where).analog[where.object_subindex - 1]

    def _read(self, where: CanTerminal) -> bool:
        if where.node_name in self.modules:
            raw = self._bit(self.modules[where.node_name].inputs, where)
        else:
            raw = bool(self._drives[where.node_name].digital_inputs >> where.bit_number & 1)
        return raw is not where.is_active_low

    def _module(self, where: CanTerminal) -> Cia401Module:
        return self.modules[where.node_name]

    @staticmethod
    def _bit(data: bytearray, where: CanTerminal) -> bool:
        return bool(data[where.object_subindex - 1] >> where.bit_number & 1)


# --- Probe.


_INPUT_DELAY_SYNCS = 2  # SYNCs: a module replies with its inputs of the previous SYNC.


class CanopenProbe(FirstTouchLatch):
    """Probe input of an I/O module, which the module reports after each SYNC.

    The position latch of the drives (object 60B8h) is not used, because its input is usually occupied.
    """

    def __init__(self, axes: CanopenAxes, io: CanopenIO, sync_period_s: float) -> None:
        super().__init__()
        self._axes, self._io, self._sync = axes, io, sync_period_s

    def record_touch(self) -> None:
        """Latch the axis positions at the first touch; call this method once per bus cycle."""
        if self._is_first_touch(self._io.inputs()[PROBE_INPUT]):
            sample = self._axes.sample()
            self._kept = TouchLatch(sample.t, sample.actual, _INPUT_DELAY_SYNCS * self._sync)
