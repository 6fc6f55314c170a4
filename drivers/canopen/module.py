"""A CiA 401 module: inputs, outputs with a safe state of their own, analog words."""

from __future__ import annotations

import canopen

from drivers.canopen import objects as od
from drivers.canopen.bus import Bus, Node
from drivers.canopen.config import ModuleConfig
from drivers.canopen.setup import Setup
from drivers.canopen.standing import watching

BYTES = 8  # of inputs, and of outputs
_DELTA = 328  # 1 % of an analog word
_AGAIN = 0.1  # s after which outputs are sent although nothing has changed
_SYNCS = 3


class Module401:
    """One module: eight bytes of inputs and of outputs, four analog words."""

    def __init__(self, config: ModuleConfig, bus: Bus) -> None:
        self.config = config
        self._bus = bus
        self.node = Node(config.node, od.dictionary(config.name, config.eds, od.module_objects))
        bus.add_node(self.node)
        self.setup = Setup(bus, self.node, config.name)
        self.inputs = bytearray(BYTES)
        self.outputs = bytearray(BYTES)
        self.analog = [0] * 4
        self.counting: set[int] = set()  # sub-indices of analog words that count: each count matters
        self.heard = self.answered = bus.clock.now()
        self.missing = 0
        self.trouble = ""
        self._sent = (-1e9, b"")

    def connect(self, safe: bytes, keep: bytes) -> None:
        """Configure: what the outputs do when this computer falls silent; the mapping. DriverError."""
        self.setup.pre_operational()
        self.setup.demand_profile(401)
        for i in range(BYTES):
            self.setup.write(od.ERROR_MODE, i + 1, 0xFF & ~keep[i])  # 1: takes the value, 0: keeps its state
            self.setup.write(od.ERROR_VALUE, i + 1, safe[i])
        self.setup.write(od.ANALOG_EVENTS, 0, 1)
        for i in range(len(self.analog)):
            self.setup.write(od.ANALOG_DELTA, i + 1, 1 if i + 1 in self.counting else _DELTA)
        self.setup.write_all((*watching(self._bus.config), *self.config.objects))
        self.setup.receive(1, *_bytes(od.DIGITAL_OUT), at_once=True)
        self.setup.transmit(1, self._digital, *_bytes(od.DIGITAL_IN))
        self.setup.transmit(2, self._words, *((od.ANALOG_IN | i << 16, 16) for i in range(1, 5)))
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.outputs[:] = bytes(self.setup.read(od.DIGITAL_OUT, i + 1) for i in range(BYTES))
        self.heard, self.missing, self.trouble = self._bus.clock.now(), 0, ""

    def send(self, now: float) -> None:
        """The outputs, when they have changed or it is time to say them again."""
        when, what = self._sent
        if bytes(self.outputs) != what or now - when >= _AGAIN:
            self._bus.send_message(0x200 + self.config.node, bytes(self.outputs))
            self._sent = (now, bytes(self.outputs))

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
        for i in range(min(4, len(map_.data) // 2)):
            self.analog[i] = int.from_bytes(map_.data[2 * i : 2 * i + 2], "little", signed=True)

    def _heartbeat(self, state: int) -> None:
        self.heard = self._bus.clock.now()
        if state == 0:
            self._wrong(f"{self.config.name}: the I/O module has restarted; its outputs have fallen")

    def _wrong(self, what: str) -> None:
        self.trouble = self.trouble or what


def _bytes(index: int) -> list[tuple[int, int]]:
    return [(index | sub << 16, 8) for sub in range(1, BYTES + 1)]
