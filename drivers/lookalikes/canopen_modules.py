"""Devices that only switch and measure: a CiA 401 module on the simulated terminals, a CiA 406 encoder."""

from __future__ import annotations

from collections.abc import Callable

from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_nodes import CanTerminal
from drivers.lookalikes.plant import Plant

_STATION = ("estop", "start", "hold", "spindle_auto")


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
        wired = self._wired.get(sub)
        if wired is None:
            return 0
        now = self._plant.clock.now()
        state, states = self._plant.panel.state(now), self._plant.terminals.read(now)
        byte = 0
        for name, where in wired:
            on = getattr(state, name) if name in _STATION else states.get(name)
            byte |= (bool(on) is not where.active_low) << where.bit
        return byte

    def _analog(self, sub: int) -> int:
        state = self._plant.panel.state(self._plant.clock.now())
        wheel = self._config.pots.get("handwheel")
        if wheel is not None and wheel.terminal.node == self._name and wheel.terminal.sub == sub:
            return (state.handwheel + 2**15) % 2**16 - 2**15
        load = self._plant.spindle.load
        shown = {"feed_pot": state.feed_pot, "spindle_pot": state.spindle_pot, "spindle_load": load}
        for name, pot in self._config.pots.items():
            if pot.terminal.node == self._name and pot.terminal.sub == sub and name in shown:
                fraction = (shown[name] - pot.low) / (pot.high - pot.low)
                return round(32767 * min(max(fraction, 0.0), 1.0))
        return 0


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
