"""CiA 401 modules: inputs, outputs with a safe state of their own in the module, pots."""

from __future__ import annotations

from collections.abc import Mapping

import canopen

from core.ports import DriverError, StationState
from drivers.canopen import objects as od
from drivers.canopen.bus import Bus, Node
from drivers.canopen.config import CanopenConfig, ModuleConfig, Terminal
from drivers.canopen.drive import Drive402
from drivers.canopen.setup import Setup

_FULL = 32767.0  # of an analog word
_BYTES = 8
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
        self.inputs = bytearray(_BYTES)
        self.outputs = bytearray(_BYTES)
        self.analog = [0] * 4
        self.heard = self.answered = bus.clock.now()
        self.missing = 0
        self.trouble = ""
        self._sent = (-1e9, b"")

    def connect(self, safe: bytes, keep: bytes) -> None:
        """Configure: what the outputs do when this computer falls silent; the mapping. DriverError."""
        self.setup.pre_operational()
        self.setup.demand_profile(401)
        beat = self._bus.config.heartbeat
        for i in range(_BYTES):
            self.setup.write(od.ERROR_MODE, i + 1, 0xFF & ~keep[i])  # 1: takes the value, 0: keeps its state
            self.setup.write(od.ERROR_VALUE, i + 1, safe[i])
        self.setup.write(od.ANALOG_EVENTS, 0, 1)
        for i in range(len(self.analog)):
            self.setup.write(od.ANALOG_DELTA, i + 1, _DELTA)
        self.setup.write(od.HEARTBEAT, 0, round(1000 * beat))
        self.setup.write(od.WATCHED, 1, self._bus.config.host_id << 16 | round(3000 * beat))
        self.setup.write_all(self.config.objects)
        self.setup.receive(1, *_bytes(od.DIGITAL_OUT), at_once=True)
        self.setup.transmit(1, self._digital, *_bytes(od.DIGITAL_IN))
        self.setup.transmit(2, self._words, *((od.ANALOG_IN | i << 16, 16) for i in range(1, 5)))
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.outputs[:] = bytes(self.setup.read(od.DIGITAL_OUT, i + 1) for i in range(_BYTES))
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
    return [(index | sub << 16, 8) for sub in range(1, _BYTES + 1)]


class CanopenIO:
    """``core.ports.DigitalIO`` and ``Station`` on the modules, by the names of the machine file."""

    def __init__(self, config: CanopenConfig, bus: Bus, drives: Mapping[str, Drive402]) -> None:
        self._config = config
        self._bus = bus
        self._drives = drives
        self.modules = {module.name: Module401(module, bus) for module in config.modules}
        self._written: dict[str, bool] = {}

    def connect(self) -> None:
        """Configure every module with the safe states of its outputs. Raises DriverError."""
        for name, module in self.modules.items():
            safe, keep = bytearray(_BYTES), bytearray(_BYTES)
            for output in self._config.outputs.values():
                where = output.terminal
                if where.node == name:
                    table = keep if output.safe is None else safe
                    table[where.sub - 1] |= (output.safe is not False) << where.bit
            module.connect(bytes(safe), bytes(keep))
        for name, output in self._config.outputs.items():
            self._written[name] = self._bit(self._module(output.terminal).outputs, output.terminal)

    def operational(self) -> None:
        """NMT start of the modules."""
        for module in self.modules.values():
            module.node.nmt.state = "OPERATIONAL"

    def tick(self, now: float) -> str:
        """Supervise and send; what is wrong with a module, or nothing."""
        trouble = ""
        for module in self.modules.values():
            module.look(3.0 * self._bus.config.heartbeat)
            trouble = trouble or module.trouble
            module.send(now)
        return trouble

    def clear_fault(self) -> None:
        """Configure anew what has restarted or was silent. Raises DriverError."""
        if any(module.trouble for module in self.modules.values()):
            self.connect()
            self.operational()

    def inputs(self) -> Mapping[str, bool]:
        """All inputs by name; active is True."""
        return {name: self._read(where) for name, where in self._config.inputs.items()}

    def outputs(self) -> Mapping[str, bool]:
        """All outputs as last written."""
        return dict(self._written)

    def write(self, name: str, on: bool) -> None:
        """Switch one output; it goes out with the next tick. Raises DriverError."""
        output = self._config.outputs.get(name)
        if output is None:
            raise DriverError(f"output {name!r} is not in the machine file; add it under [io.out]")
        module = self._module(output.terminal)
        if on and (self._bus.trouble or module.trouble):
            raise DriverError(f"output {name} stays off: {self._bus.trouble or module.trouble}")
        self._switch(name, output.terminal, on)

    def _switch(self, name: str, where: Terminal, on: bool) -> None:
        module = self._module(where)
        raw = on is not where.active_low
        byte = module.outputs[where.sub - 1] & ~(1 << where.bit)
        module.outputs[where.sub - 1] = byte | raw << where.bit
        self._written[name] = on

    def safe(self) -> None:
        """Every output to its safe state; at once, as far as the bus is alive."""
        for name, output in self._config.outputs.items():
            if output.safe is not None:
                self._switch(name, output.terminal, output.safe)
        if not self._bus.trouble:
            for module in self.modules.values():
                module.send(self._bus.clock.now())

    def snapshot(self) -> StationState:
        """The operator station as its inputs have it; its age is that of the oldest module."""
        inputs = self.inputs()
        now = self._bus.clock.now()
        age = max((now - module.answered for module in self.modules.values()), default=0.0)
        pot = self._config.pots.get("spindle_pot")
        auto = inputs.get(pot.switch, True) if pot is not None and pot.switch else True
        return StationState(
            estop=inputs.get("estop", False),
            start=inputs.get("start", False),
            hold=inputs.get("hold", False),
            spindle_auto=inputs.get("spindle_auto", auto),
            spindle_pot=self._pot("spindle_pot"),
            feed_pot=self._pot("feed_pot"),
            age=age,
        )

    def _pot(self, name: str) -> float:
        pot = self._config.pots.get(name)
        if pot is None:
            return 1.0
        raw = self._module(pot.terminal).analog[pot.terminal.sub - 1]
        return pot.low + (pot.high - pot.low) * min(max(raw / _FULL, 0.0), 1.0)

    def _read(self, where: Terminal) -> bool:
        if where.node in self.modules:
            raw = self._bit(self.modules[where.node].inputs, where)
        else:
            raw = bool(self._drives[where.node].inputs >> where.bit & 1)
        return raw is not where.active_low

    def _module(self, where: Terminal) -> Module401:
        return self.modules[where.node]

    @staticmethod
    def _bit(data: bytearray, where: Terminal) -> bool:
        return bool(data[where.sub - 1] >> where.bit & 1)
