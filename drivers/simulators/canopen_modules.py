"""Devices that only switch and measure: a CiA 401 module on the simulated terminals, a CiA 406 encoder."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from core.ports import StationState
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_nodes import CanTerminal
from drivers.simulators.plant import Plant

_STATION = frozenset({"estop", "start", "hold", "spindle_auto"})


class TerminalBoard:
    """Outputs switch what hangs on the plant; inputs and pots are read from it."""

    def __init__(self, name: str, config: CanopenConfig, plant: Plant) -> None:
        self._name = name
        self._config = config
        self._plant = plant
        self.outputs = bytearray(8)
        self.values: dict[tuple[int, int], int] = {}
        self._wired: dict[int, list[tuple[str, CanTerminal]]] = {}  # inputs by sub-index
        for name_of_input, where in config.inputs.items():
            if where.node == name:
                self._wired.setdefault(where.sub, []).append((name_of_input, where))
        self._hands: object = None  # of the plant, as ``_bytes`` of the inputs show them
        self._bytes: dict[int, int] = {}
        self._pots = {
            pot.terminal.sub: (of, pot) for of, pot in config.pots.items() if pot.terminal.node == name
        }
        for output, model in config.outputs.items():
            if plant.terminals.outputs.get(output):
                self.outputs[model.terminal.sub - 1] |= 1 << model.terminal.bit

    def read(self, index: int, sub: int) -> int | None:
        """What lives in the module."""
        if index == od.DEVICE_TYPE:
            return 0x000F0191
        if index == od.DIGITAL_IN and sub:
            return self._inputs(sub)
        if index == od.DIGITAL_OUT and sub:
            return self.outputs[sub - 1]
        if index == od.ANALOG_IN and sub:
            return self._analog(sub) if self.values.get((od.ANALOG_EVENTS, 0)) else 0
        return None

    def write(self, index: int, sub: int, value: int) -> None:
        """What the host says."""
        self.values[index, sub] = value
        if index == od.DIGITAL_OUT:
            self._switch(sub, value)

    def host_lost(self) -> None:
        """Every output that has an error value takes it; the others stay."""
        for sub in range(1, 9):
            mode = self.values.get((od.ERROR_MODE, sub), 0xFF)
            value = self.values.get((od.ERROR_VALUE, sub), 0)
            self._switch(sub, self.outputs[sub - 1] & ~mode | value & mode)

    def reset(self) -> None:
        """A module without power drops what it can; the valve of the collet stays where it is."""
        for sub in range(1, 9):
            kept = self.values.get((od.ERROR_MODE, sub), 0)
            self._switch(sub, self.outputs[sub - 1] & ~kept if kept else self.outputs[sub - 1])
        self.values.clear()

    def _switch(self, sub: int, value: int) -> None:
        self.outputs[sub - 1] = value & 0xFF
        now = self._plant.clock.now()
        for name, output in self._config.outputs.items():
            where = output.terminal
            on = bool(value >> where.bit & 1)
            board = self._plant.terminals
            if where.node == self._name and where.sub == sub and board.outputs.get(name) is not on:
                board.write(name, on, now)

    def _inputs(self, sub: int) -> int:
        hands = self._plant.hands(self._plant.clock.now())
        if hands is not self._hands:
            self._hands, self._bytes = hands, {}
        if sub not in self._bytes:
            self._bytes[sub] = self._byte(sub, *hands)
        return self._bytes[sub]

    def _byte(self, sub: int, state: StationState, inputs: Mapping[str, bool]) -> int:
        byte = 0
        for name, where in self._wired.get(sub, ()):
            on = getattr(state, name) if name in _STATION else inputs.get(name)
            byte |= (bool(on) is not where.active_low) << where.bit
        return byte

    def _analog(self, sub: int) -> int:
        if sub not in self._pots:
            return 0
        name, pot = self._pots[sub]
        state, _ = self._plant.hands(self._plant.clock.now())
        if name == "handwheel":
            return (state.handwheel + 2**15) % 2**16 - 2**15
        shown = self._plant.spindle.load if name == "spindle_load" else getattr(state, name)
        fraction = (shown - pot.low) / (pot.high - pot.low)
        return round(32767 * min(max(fraction, 0.0), 1.0))


# --- A CiA 406 encoder on the simulated spindle, and the second input of a drive with one behind it.


TURNS = 4096  # it goes round after so many


class EncoderDevice:
    """``stuck`` no longer turns with the spindle: its coupling has come off."""

    def __init__(self, plant: Plant, counts: int) -> None:
        self._plant = plant
        self.counts = counts  # a turn, signed
        self.turns = TURNS
        self.steps = abs(counts)  # as it says of itself
        self.stuck: int | None = None
        self.values: dict[tuple[int, int], int] = {}
        self._readers: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020196,
            od.ENCODER_RESOLUTION: lambda: self.steps,
            od.ENCODER_TURNS: lambda: self.turns,
            od.ENCODER_POSITION: lambda: self.position % (self.steps * self.turns),
        }

    def read(self, index: int, _sub: int) -> int | None:
        """What lives in the device."""
        reader = self._readers.get(index)
        return None if reader is None else reader()

    @property
    def position(self) -> int:
        """Counts since it was made."""
        return round(self._plant.spindle.turns * self.counts) if self.stuck is None else self.stuck

    def come_off(self) -> None:
        """The coupling: it stays where it is."""
        self.stuck = self.position

    def write(self, index: int, sub: int, value: int) -> None:
        """What the host says."""
        self.values[index, sub] = value

    def host_lost(self) -> None:
        """It only measures."""

    def reset(self) -> None:
        """It knows its turns without power."""
        self.values.clear()
