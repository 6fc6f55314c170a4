"""Inputs, outputs, pots and the operator station on CiA 401 modules, with the names from the machine file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import canopen

from core.ports import PROBE, DriverError, Fault, Latch, StationState
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_nodes import CanNode, CanTerminal
from drivers.canopen.canopen_setup import Setup, watching
from drivers.canopen.cia402_drives import Drive402
from drivers.operator_station import station_of
from drivers.port_parts import FirstTouch, demand_output, output_of

# --- A CiA 401 module: inputs, outputs with safe states, and analog words.


BYTES = 8  # Bytes of inputs or outputs in one PDO.
_WORDS = 4  # Analog words in one PDO.
_DELTA = 328  # 1 % of an analog word
_AGAIN = 0.1  # Seconds after which unchanged outputs are sent again.
_SYNCS, _BEATS = 3, 3.0  # Replies to SYNC and heartbeats that may be missing.
_KINDS = ((od.DIGITAL_IN, "input bytes"), (od.DIGITAL_OUT, "output bytes"), (od.ANALOG_IN, "pots"))


class Module401:
    """CiA 401 module with the number of terminals that it reports, limited to those of its first PDOs."""

    def __init__(self, config: CanNode, bus: Bus) -> None:
        self.config = config
        self._bus = bus
        objects = od.dictionary(config.name, config.eds, od.module_objects)
        self.setup = Setup(bus, config.name, config.id, objects)
        self.node = self.setup.node
        self.inputs = bytearray(BYTES)
        self.outputs = bytearray(BYTES)
        self.analog = [0] * _WORDS
        self.counting: set[int] = set()  # Sub-indices of analog words that are counters.
        self.sizes = {od.DIGITAL_IN: 0, od.DIGITAL_OUT: 0, od.ANALOG_IN: 0}
        self.heard = self.answered = bus.clock.now()
        self.missing = 0
        self.trouble: Fault | str = ""
        self._sent = (-1e9, b"")

    def measure(self, needed: Iterable[CanTerminal]) -> None:
        """Read the number of terminals. Raises DriverError if a needed terminal does not exist."""
        self.setup.pre_operational()
        self.setup.demand_profile(401)
        most = {od.DIGITAL_IN: BYTES, od.DIGITAL_OUT: BYTES, od.ANALOG_IN: _WORDS}
        self.sizes = {index: min(self.setup.entries(index), most[index]) for index in most}
        for where in needed:
            if where.sub > self.sizes[where.index]:
                has = ", ".join(f"{self.sizes[index]} {what}" for index, what in _KINDS)
                raise DriverError(
                    "{name}: the module has {has}, so object {index}.{sub} does not exist; check the "
                    "module's terminals in the machine file",
                    name=self.config.name,
                    has=has,
                    index=f"{where.index:04X}",
                    sub=where.sub,
                )

    def connect(self, safe: bytes, keep: bytes) -> None:
        """Configure the outputs' states after a loss of this computer, and the PDO mapping.

        Raises DriverError.
        """
        inputs, outputs, words = self.sizes.values()
        for i in range(outputs):
            self.setup.write(od.ERROR_MODE, i + 1, 0xFF & ~keep[i])  # 1: set the error value, 0: no change.
            self.setup.write(od.ERROR_VALUE, i + 1, safe[i])
        if words:
            self.setup.write(od.ANALOG_EVENTS, 0, 1)
        for i in range(words):
            self.setup.write(od.ANALOG_DELTA, i + 1, 1 if i + 1 in self.counting else _DELTA)
        self.setup.configure(watching(self._bus.config), self.config.sdo, (od.HEARTBEAT, od.WATCHED))
        if outputs:
            self.setup.receive(1, *_entries(od.DIGITAL_OUT, outputs, 8), at_once=True)
        every = self._bus.config.seldom
        if inputs:
            self.setup.transmit(1, self._digital, *_entries(od.DIGITAL_IN, inputs, 8), every=every)
        if words:
            self.setup.transmit(2, self._words, *_entries(od.ANALOG_IN, words, 16), every=every)
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.outputs[:outputs] = bytes(self.setup.read(od.DIGITAL_OUT, i + 1) for i in range(outputs))
        # Read the pots before their first PDO, because a pot at 0 would stop a cycle that starts immediately.
        self.analog[:words] = [_signed(self.setup.read(od.ANALOG_IN, i + 1)) for i in range(words)]
        self.heard, self.missing, self.trouble = self._bus.clock.now(), 0, ""

    def sync_sent(self) -> None:
        """Record that a SYNC is sent; a module without inputs is monitored by its heartbeat only."""
        if self.sizes[od.DIGITAL_IN] or self.sizes[od.ANALOG_IN]:
            self.missing += 1

    def send(self, now: float) -> None:
        """Send the outputs after a change, and periodically."""
        when, what = self._sent
        outputs = bytes(self.outputs[: self.sizes[od.DIGITAL_OUT]])
        if outputs and (outputs != what or now - when >= _AGAIN):
            self._bus.send_message(0x200 + self.config.id, outputs)
            self._sent = (now, outputs)

    @property
    def silent(self) -> bool:
        """Whether replies or heartbeats are missing for too long, so that the inputs are old."""
        return self.missing > _SYNCS or self._without_beat > _BEATS * self._bus.config.heartbeat

    @property
    def _without_beat(self) -> float:
        return self._bus.clock.now() - self.heard

    def look(self) -> None:
        """Set a fault if heartbeats or replies are missing; it remains until ``connect``."""
        name, silent = self.config.name, self._without_beat
        if silent > _BEATS * self._bus.config.heartbeat:
            self._wrong(
                "{name}: no heartbeat from the I/O module for {silent} s; check cable and power",
                name=name,
                silent=f"{silent:.2f}",
            )
        elif self.missing > _SYNCS:
            self._wrong("{name}: the I/O module does not respond to SYNC; check cable and power", name=name)

    def _digital(self, map_: canopen.pdo.PdoMap) -> None:
        self.inputs[: len(map_.data)] = map_.data
        self.missing, self.answered = 0, self._bus.clock.now()

    def _words(self, map_: canopen.pdo.PdoMap) -> None:
        for i in range(min(_WORDS, len(map_.data) // 2)):
            self.analog[i] = int.from_bytes(map_.data[2 * i : 2 * i + 2], "little", signed=True)
        if not self.sizes[od.DIGITAL_IN]:
            self.missing, self.answered = 0, self._bus.clock.now()

    def _heartbeat(self, state: int) -> None:
        self.heard = self._bus.clock.now()
        if not (self.sizes[od.DIGITAL_IN] or self.sizes[od.ANALOG_IN]):
            self.answered = self.heard
        if state == 0:
            self._wrong(
                "{name}: the I/O module has restarted; its outputs have dropped out", name=self.config.name
            )

    def _wrong(self, what: str, **values: object) -> None:
        self.trouble = self.trouble or Fault(what, "io-silent", **values)


def _signed(word: int) -> int:
    """Convert a 16-bit analog word into a signed number."""
    return (word + 2**15) % 2**16 - 2**15


def _entries(index: int, count: int, bits: int) -> list[tuple[int, int]]:
    return [(index | sub << 16, bits) for sub in range(1, count + 1)]


_FULL = 32767.0  # Full scale of an analog word.


class CanopenIO:
    """``core.ports.DigitalIO`` and ``Station`` on the modules, with the names from the machine file."""

    def __init__(self, config: CanopenConfig, bus: Bus, drives: Mapping[str, Drive402]) -> None:
        self._config = config
        self._bus = bus
        self._drives = drives
        self.modules = {module.name: Module401(module, bus) for module in config.modules}
        wheel = config.pots.get("handwheel")
        if wheel is not None:
            self._module(wheel.terminal).counting.add(wheel.terminal.sub)
        self._written: dict[str, bool] = {}
        self._heard: tuple[object, ...] = ()  # Last received words of the inputs.
        self._inputs: Mapping[str, bool] = {}
        self._wheel: tuple[int, int] | None = None  # Counter at the last reading, and accumulated counts.

    def connect(self) -> None:
        """Configure every module with the safe states of its outputs. Raises DriverError."""
        for where in self._needed():
            drive = self._drives.get(where.node)
            if drive is not None and not drive.tells_inputs:
                raise DriverError(
                    "{node}: the drive does not report digital inputs; in the machine file, assign the "
                    "inputs to an I/O module",
                    node=where.node,
                )
        for name, module in self.modules.items():
            module.measure(where for where in self._needed() if where.node == name)
            safe, keep = bytearray(BYTES), bytearray(BYTES)
            for output in self._config.outputs.values():
                where = output.terminal
                if where.node == name:
                    table = keep if output.safe is None else safe
                    table[where.sub - 1] |= (output.safe is not False) << where.bit
            module.connect(bytes(safe), bytes(keep))
        for name, output in self._config.outputs.items():
            self._written[name] = self._bit(self._module(output.terminal).outputs, output.terminal)

    def _needed(self) -> Iterator[CanTerminal]:
        """Yield all terminals of the machine file, including those of drives."""
        config = self._config
        yield from config.inputs.values()
        yield from (output.terminal for output in config.outputs.values())
        yield from (pot.terminal for pot in config.pots.values())

    def operational(self) -> None:
        """Start the modules by NMT."""
        for module in self.modules.values():
            module.node.nmt.state = "OPERATIONAL"

    def tick(self, now: float) -> str:
        """Supervise the modules and send the outputs; return the first fault, or an empty text."""
        trouble: str = ""
        for module in self.modules.values():
            module.look()
            trouble = trouble or module.trouble
            module.send(now)
        return trouble

    def clear_fault(self) -> None:
        """Configure modules again after a restart or silence. Raises DriverError."""
        if any(module.trouble for module in self.modules.values()):
            self.connect()
            self.operational()

    def inputs(self) -> Mapping[str, bool]:
        """Return all inputs by name; True is active."""
        heard = (
            *(bytes(module.inputs) for module in self.modules.values()),
            *(drive.inputs for drive in self._drives.values()),
        )
        if heard != self._heard:
            self._heard = heard
            self._inputs = {name: self._read(where) for name, where in self._config.inputs.items()}
        return self._inputs

    def outputs(self) -> Mapping[str, bool]:
        """Return all outputs by name, as last written."""
        return dict(self._written)

    def write(self, name: str, on: bool) -> None:
        """Switch one output, which is sent at the next tick. Raises DriverError."""
        output = output_of(name, self._config.outputs)
        module = self._module(output.terminal)
        demand_output(name, on, self._bus.trouble or module.trouble)
        self._switch(name, output.terminal, on)

    def _switch(self, name: str, where: CanTerminal, on: bool) -> None:
        module = self._module(where)
        raw = on is not where.active_low
        byte = module.outputs[where.sub - 1] & ~(1 << where.bit)
        module.outputs[where.sub - 1] = byte | raw << where.bit
        self._written[name] = on

    def safe(self) -> None:
        """Set every output to its safe state, immediately if the bus works."""
        for name, output in self._config.outputs.items():
            if output.safe is not None:
                self._switch(name, output.terminal, output.safe)
        if not self._bus.trouble:
            for module in self.modules.values():
                module.send(self._bus.clock.now())

    def snapshot(self) -> StationState:
        """Return the state of the operator station; its age is that of the oldest module."""
        now = self._bus.clock.now()
        age = max((now - module.answered for module in self.modules.values()), default=0.0)
        return station_of(
            self.inputs(),
            self._config.pots,
            lambda name: self._word(name) / _FULL,
            handwheel=self._turned(),
            age=age,
        )

    def _turned(self) -> int:
        """Return the handwheel counts.

        The 16-bit counter wraps around. Less than half of its range can pass between two calls.
        """
        if "handwheel" not in self._config.pots:
            return 0
        raw = self._word("handwheel")
        if self._wheel is None:
            self._wheel = (raw, 0)
        last, count = self._wheel
        count += (raw - last + 0x8000) % 0x10000 - 0x8000
        self._wheel = (raw, count)
        return count

    def _word(self, name: str) -> int:
        """Return the analog word of a pot or handwheel."""
        where = self._config.pots[name].terminal
        return self._module(where).analog[where.sub - 1]

    def _read(self, where: CanTerminal) -> bool:
        if where.node in self.modules:
            raw = self._bit(self.modules[where.node].inputs, where)
        else:
            raw = bool(self._drives[where.node].inputs >> where.bit & 1)
        return raw is not where.active_low

    def _module(self, where: CanTerminal) -> Module401:
        return self.modules[where.node]

    @staticmethod
    def _bit(data: bytearray, where: CanTerminal) -> bool:
        return bool(data[where.sub - 1] >> where.bit & 1)


# --- Probe.


_LATE = 2  # SYNCs: a module replies with its inputs of the previous SYNC.


class CanopenProbe(FirstTouch):
    """Touch input by the replies to each SYNC.

    The position latch of the drives (60B8) is not used, because its input is rarely free.
    """

    def __init__(self, axes: CanopenAxes, io: CanopenIO, sync: float) -> None:
        super().__init__()
        self._axes, self._io, self._sync = axes, io, sync

    def note(self) -> None:
        """Latch the positions at the first touch; called once per cycle of the bus."""
        if self._touches(self._io.inputs()[PROBE]):
            sample = self._axes.sample()
            self._kept = Latch(sample.t, sample.actual, _LATE * self._sync)
