"""Inputs, outputs, pots and the operator station by the names of the machine file, on CiA 401 modules."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from core.ports import DriverError, StationState
from drivers.canopen.bus import Bus
from drivers.canopen.config import CanopenConfig, Terminal
from drivers.canopen.drive import Drive402
from drivers.canopen.module import BYTES, Module401

_FULL = 32767.0  # of an analog word


class CanopenIO:
    """``core.ports.DigitalIO`` and ``Station`` on the modules, by the names of the machine file."""

    def __init__(self, config: CanopenConfig, bus: Bus, drives: Mapping[str, Drive402]) -> None:
        self._config = config
        self._bus = bus
        self._drives = drives
        self.modules = {module.name: Module401(module, bus) for module in config.modules}
        wheel = config.pots.get("handwheel")
        if wheel is not None:
            self._module(wheel.terminal).counting.add(wheel.terminal.sub)
        self._written: dict[str, bool] = {}
        self._wheel: tuple[int, int] | None = None  # its counter at the last look, and what was counted

    def connect(self) -> None:
        """Configure every module with the safe states of its outputs. Raises DriverError."""
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

    def _needed(self) -> Iterator[Terminal]:
        """All terminals of the machine file, those of drives too."""
        config = self._config
        yield from config.inputs.values()
        yield from (output.terminal for output in config.outputs.values())
        yield from (pot.terminal for pot in config.pots.values())

    def operational(self) -> None:
        """NMT start of the modules."""
        for module in self.modules.values():
            module.node.nmt.state = "OPERATIONAL"

    def tick(self, now: float) -> str:
        """Supervise and send; what is wrong with a module, or nothing."""
        trouble: str = ""
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
            raise DriverError(f"output {name!r} is not in the machine file; add it under [io.out]", "output")
        module = self._module(output.terminal)
        if on and (self._bus.trouble or module.trouble):
            raise DriverError(f"output {name} stays off: {self._bus.trouble or module.trouble}", "output")
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
            handwheel=self._turned(),
            age=age,
        )

    def _turned(self) -> int:
        """The wheel's counter goes round after 16 bits; nobody turns half of that between two looks."""
        wheel = self._config.pots.get("handwheel")
        if wheel is None:
            return 0
        raw = self._module(wheel.terminal).analog[wheel.terminal.sub - 1]
        if self._wheel is None:
            self._wheel = (raw, 0)
        last, count = self._wheel
        count += (raw - last + 0x8000) % 0x10000 - 0x8000
        self._wheel = (raw, count)
        return count

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
