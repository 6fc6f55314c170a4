"""A CiA 401 module: inputs, outputs with a safe state of their own, analog words."""

from __future__ import annotations

from collections.abc import Iterable

import canopen

from core.ports import DriverError, Fault
from drivers.canopen import objects as od
from drivers.canopen.bus import Bus, Node
from drivers.canopen.config import ModuleConfig, Terminal
from drivers.canopen.setup import Setup
from drivers.canopen.standing import watching

BYTES = 8  # of inputs, and of outputs, that one PDO carries
_WORDS = 4  # analog ones
_DELTA = 328  # 1 % of an analog word
_AGAIN = 0.1  # s after which outputs are sent although nothing has changed
_SYNCS = 3
_KINDS = ((od.DIGITAL_IN, "bytes of inputs"), (od.DIGITAL_OUT, "bytes of outputs"), (od.ANALOG_IN, "pots"))


class Module401:
    """One module, of the size that it says it has: at most what its first PDOs carry."""

    def __init__(self, config: ModuleConfig, bus: Bus) -> None:
        self.config = config
        self._bus = bus
        self.node = Node(config.node, od.dictionary(config.name, config.eds, od.module_objects))
        bus.add_node(self.node)
        self.setup = Setup(bus, self.node, config.name)
        self.inputs = bytearray(BYTES)
        self.outputs = bytearray(BYTES)
        self.analog = [0] * _WORDS
        self.counting: set[int] = set()  # sub-indices of analog words that count: each count matters
        self.sizes = {od.DIGITAL_IN: 0, od.DIGITAL_OUT: 0, od.ANALOG_IN: 0}
        self.heard = self.answered = bus.clock.now()
        self.missing = 0
        self.trouble: Fault | str = ""
        self._sent = (-1e9, b"")

    def measure(self, needed: Iterable[Terminal]) -> None:
        """Ask how much there is of it. Raises DriverError for a terminal that it does not have."""
        self.setup.pre_operational()
        self.setup.demand_profile(401)
        most = {od.DIGITAL_IN: BYTES, od.DIGITAL_OUT: BYTES, od.ANALOG_IN: _WORDS}
        self.sizes = {index: min(self.setup.entries(index), most[index]) for index in most}
        for where in needed:
            if where.sub > self.sizes[where.index]:
                has = ", ".join(f"{self.sizes[index]} {what}" for index, what in _KINDS)
                raise DriverError(
                    f"{self.config.name}: the module has {has}, so there is no {where.index:04X}.{where.sub};"
                    " check its terminals in the machine file"
                )

    def connect(self, safe: bytes, keep: bytes) -> None:
        """Configure: what the outputs do when this computer falls silent; the mapping. DriverError."""
        inputs, outputs, words = self.sizes.values()
        for i in range(outputs):
            self.setup.write(od.ERROR_MODE, i + 1, 0xFF & ~keep[i])  # 1: takes the value, 0: keeps its state
            self.setup.write(od.ERROR_VALUE, i + 1, safe[i])
        if words:
            self.setup.write(od.ANALOG_EVENTS, 0, 1)
        for i in range(words):
            self.setup.write(od.ANALOG_DELTA, i + 1, 1 if i + 1 in self.counting else _DELTA)
        self.setup.write_all((*watching(self._bus.config), *self.config.objects))
        if outputs:
            self.setup.receive(1, *_entries(od.DIGITAL_OUT, outputs, 8), at_once=True)
        if inputs:
            self.setup.transmit(1, self._digital, *_entries(od.DIGITAL_IN, inputs, 8))
        if words:
            self.setup.transmit(2, self._words, *_entries(od.ANALOG_IN, words, 16))
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.outputs[:outputs] = bytes(self.setup.read(od.DIGITAL_OUT, i + 1) for i in range(outputs))
        self.heard, self.missing, self.trouble = self._bus.clock.now(), 0, ""

    def asked(self) -> None:
        """A SYNC is about to go out; who has nothing to send is known by its heartbeat alone."""
        if self.sizes[od.DIGITAL_IN] or self.sizes[od.ANALOG_IN]:
            self.missing += 1

    def send(self, now: float) -> None:
        """The outputs, when they have changed or it is time to say them again."""
        when, what = self._sent
        outputs = bytes(self.outputs[: self.sizes[od.DIGITAL_OUT]])
        if outputs and (outputs != what or now - when >= _AGAIN):
            self._bus.send_message(0x200 + self.config.node, outputs)
            self._sent = (now, outputs)

    def look(self, patience: float) -> None:
        """Supervise; ``trouble`` stays until the module is connected anew."""
        name, silent = self.config.name, self._bus.clock.now() - self.heard
        if silent > patience:
            self._wrong(f"{name}: no heartbeat of the I/O module for {silent:.2f} s; check cable and power")
        elif self.missing > _SYNCS:
            self._wrong(f"{name}: the I/O module does not answer SYNC; check cable and power")

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
            self._wrong(f"{self.config.name}: the I/O module has restarted; its outputs have fallen")

    def _wrong(self, what: str) -> None:
        self.trouble = self.trouble or Fault(what, "io-silent")


def _entries(index: int, count: int, bits: int) -> list[tuple[int, int]]:
    return [(index | sub << 16, bits) for sub in range(1, count + 1)]
