"""Simulated CANopen devices of a machine on one bus, connected to the simulated plant.

In addition to the drives, there are a CiA 401 I/O module and a CiA 406 encoder.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import can
from canopen import ObjectDictionary
from canopen.objectdictionary import ODVariable

from core.ports import Clock, StationState
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import opened
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_nodes import CanNode, CanTerminal
from drivers.canopen.drive_profiles import DriveProfile
from drivers.simulators.canopen_axis_drive import AxisDrive
from drivers.simulators.canopen_node import Device, DeviceNetwork, DeviceNode
from drivers.simulators.canopen_spindle_drive import SpindleDrive
from drivers.simulators.plant import Plant
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_hands import PlantHands, Schedule

_STATION = frozenset({"estop", "start", "hold", "spindle_auto"})


class TerminalBoard:
    """Simulated CiA 401 module whose inputs, outputs and pots are those of the plant."""

    def __init__(self, name: str, config: CanopenConfig, plant: Plant) -> None:
        self._name = name
        self._config = config
        self._plant = plant
        self.outputs = bytearray(8)
        self.values: dict[tuple[int, int], int] = {}
        self._wired: dict[int, list[tuple[str, CanTerminal]]] = {}  # Inputs by sub-index.
        for name_of_input, where in config.inputs.items():
            if where.node == name:
                self._wired.setdefault(where.sub, []).append((name_of_input, where))
        self._hands: object = None  # State of the plant that ``_bytes`` represents.
        self._bytes: dict[int, int] = {}
        self._pots = {
            pot.terminal.sub: (of, pot) for of, pot in config.pots.items() if pot.terminal.node == name
        }
        for output, model in config.outputs.items():
            if plant.terminals.outputs.get(output):
                self.outputs[model.terminal.sub - 1] |= 1 << model.terminal.bit

    def read(self, index: int, sub: int) -> int | None:
        """Return the value of an object that the module calculates, or None if the stored value applies."""
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
        """Apply an object value that the host has written."""
        self.values[index, sub] = value
        if index == od.DIGITAL_OUT:
            self._switch(sub, value)

    def host_lost(self) -> None:
        """Set every output with an error mode to its error value; the others do not change."""
        for sub in range(1, 9):
            mode = self.values.get((od.ERROR_MODE, sub), 0xFF)
            value = self.values.get((od.ERROR_VALUE, sub), 0)
            self._switch(sub, self.outputs[sub - 1] & ~mode | value & mode)

    def reset(self) -> None:
        """Switch off the outputs that have an error mode, as a loss of power does.

        Bistable outputs, such as the collet valve, do not change.
        """
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


# --- A CiA 406 encoder on the simulated spindle, or at the second encoder input of a drive.


TURNS = 4096  # Number of revolutions after which the position wraps.


class EncoderDevice:
    """Simulated CiA 406 encoder on the spindle; ``stuck`` is its position when the coupling is off."""

    def __init__(self, plant: Plant, counts: int) -> None:
        self._plant = plant
        self.counts = counts  # Per revolution, signed.
        self.turns = TURNS
        self.steps = abs(counts)  # The resolution that the encoder reports.
        self.stuck: int | None = None
        self.values: dict[tuple[int, int], int] = {}
        self._readers: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020196,
            od.ENCODER_RESOLUTION: lambda: self.steps,
            od.ENCODER_TURNS: lambda: self.turns,
            od.ENCODER_POSITION: lambda: self.position % (self.steps * self.turns),
        }

    def read(self, index: int, _sub: int) -> int | None:
        """Return the value of an object that the encoder calculates, or None if the stored value applies."""
        reader = self._readers.get(index)
        return None if reader is None else reader()

    @property
    def position(self) -> int:
        """The counts since the start of the simulation."""
        return round(self._plant.spindle.turns * self.counts) if self.stuck is None else self.stuck

    def come_off(self) -> None:
        """Detach the coupling, so that the position no longer changes."""
        self.stuck = self.position

    def write(self, index: int, sub: int, value: int) -> None:
        """Store an object value that the host has written."""
        self.values[index, sub] = value

    def host_lost(self) -> None:
        """Do nothing, because an encoder only measures."""

    def reset(self) -> None:
        """Clear the stored values; the absolute position is preserved."""
        self.values.clear()


_SETTLED = 1e-9


class DevicePlant(Plant):
    """Simulated machine whose axes are moved by simulated CANopen drives."""

    def __init__(self, config: SimConfig, clock: Clock) -> None:
        super().__init__(config, clock)
        self.drives: dict[str, AxisDrive] = {}
        self.spindle_drive: SpindleDrive | None = None
        self._at = clock.now()

    def advance(self) -> float:
        """Advance the model to the present time of the clock in steps, and return this time in seconds."""
        now = self.clock.now()
        with self.lock:
            self._break(now)
            step, rests = self.config.step, False
            while self._at + step <= now + _SETTLED:
                self._at += step
                if not rests:
                    self._step_drives(step)
                    rests = self._drives_rest()
            if self.spindle_drive is not None:
                self.spindle_drive.at = self._at
            if now > self.spindle.t:
                self.spindle.advance(now)
        return now

    def _step_drives(self, step: float) -> None:
        if self.spindle_drive is not None:
            self.spindle_drive.step(self._at)
        for drive in self.drives.values():
            drive.step(step)
        if self.spindle.faults.belt:
            self.spindle.cut_load(self._at, cutting=self.cuts())

    def _drives_rest(self) -> bool:
        """Return whether further steps change nothing until a frame arrives or the operator acts."""
        if self.spindle.faults.belt or (self.spindle_drive is not None and not self.spindle_drive.rests):
            return False
        return all(drive.rests for drive in self.drives.values())

    def trip(self, fault: str) -> None:
        """Trip the drive that is named before the colon, and send its EMCY."""
        name = fault.partition(":")[0]
        self.drives[name].power.trip()
        self.drives[name].emergency(0x4210)

    def press_estop(self) -> None:
        """Activate STO: the axes brake and lose power, and the spindle coasts."""
        with self.touch:
            now = self.advance()
            self.panel.estop = True
            for drive in self.drives.values():
                drive.power.sto = True
                drive.power.quick_stop()
            if self.spindle_drive is not None:
                self.spindle_drive.power.sto = True
                self.spindle_drive.power.off()
            self.spindle.cut(now)


class CanopenDevices:
    """All simulated devices on one bus; ``pump`` must be called from one thread only."""

    def __init__(self, config: CanopenConfig, sim: SimConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.plant = DevicePlant(sim, clock)
        self.machine = PlantHands(self.plant)
        if sim.faults:
            self.plant.due = Schedule(self.machine, sim.faults).due
        self.network = DeviceNetwork(opened(config.bus))
        self.nodes: dict[str, DeviceNode] = {}
        self.encoder: EncoderDevice | None = None
        self.cut = False  # The cable is disconnected.
        # Converts the time stamp of a frame to the time of this clock.
        self.arrival: Callable[[float], float] | None = None
        self._early: can.Message | None = None
        self._build()

    def pump(self, wait: float = 0.0) -> None:
        """Process received frames and advance the devices; ``wait`` limits the seconds to the first frame."""
        now = self.plant.advance()
        if self.plant.drives and not self.plant.panel.estop:
            self._reset_sto()
        bus = self.network.bus
        while bus is not None:
            message = self._early or bus.recv(wait)
            self._early = None
            if message is None:
                break
            if self.arrival is not None and self.arrival(message.timestamp) > now:
                self._early = message  # A process that was suspended handles each frame at its own time.
                break
            wait = 0.0
            if not self.cut and not message.is_error_frame:
                self._deliver(message.arbitration_id, bytes(message.data))
        for node in self.nodes.values():
            node.tick(now)

    def _deliver(self, can_id: int, data: bytes) -> None:
        for node in self.nodes.values():
            if can_id in node.hears:
                node.take(can_id, data)

    def cable(self, *, out: bool) -> None:
        """Disconnect or connect the bus cable in both directions."""
        self.cut = out
        for node in self.nodes.values():
            node.silent = out

    def close(self) -> None:
        """Shut down the connection to the bus."""
        if self.network.bus is not None:
            self.network.bus.shutdown()
            self.network.bus = None

    def _build(self) -> None:
        config, plant = self.config, self.plant
        for axis in config.axes:
            if axis.node is not None:
                servo = plant.servos[plant.names.index(axis.name)]
                objects, profile = _played(axis.node)
                counts = axis.counts_per_rev
                drive = AxisDrive(servo, partial(self._emergency, axis.name), profile, counts)
                plant.drives[axis.name] = drive
                self._add(axis.name, axis.node.id, drive, objects)
        if config.spindle is not None:
            counts = config.spindle.node.counts_per_rev
            as_c = plant.config.axes[plant.names.index("C")] if config.spindle.is_c else None
            objects, profile = _played(config.spindle.node)
            spindle = SpindleDrive(plant.spindle, counts, partial(self._emergency, "spindle"), as_c, profile)
            plant.spindle_drive = spindle
            self._add("spindle", config.spindle.node.id, spindle, objects)
        if config.encoder is not None:
            self.encoder = encoder = EncoderDevice(plant, config.encoder.counts_per_rev)
            if config.encoder.node is not None:
                self._add(config.encoder.name, config.encoder.node.id, encoder, od.encoder_objects())
            else:
                plant.drives[config.encoder.name].second = lambda: encoder.position
        for module in config.modules:
            board = TerminalBoard(module.name, config, plant)
            self._add(module.name, module.id, board, od.module_objects())

    def _add(self, name: str, number: int, device: Device, objects: ObjectDictionary) -> None:
        self.nodes[name] = DeviceNode(self.network, number, objects, device)

    def _emergency(self, name: str, code: int) -> None:
        self.nodes[name].emergency(code)

    def _reset_sto(self) -> None:
        for drive in self.plant.drives.values():
            drive.power.sto = False
        if self.plant.spindle_drive is not None:
            self.plant.spindle_drive.power.sto = False


def _played(node: CanNode) -> tuple[ObjectDictionary, DriveProfile]:
    """Return the object dictionary and the profile of a drive, from its EDS file or its family.

    Numbers without a default value are 0.
    """
    objects, profile = od.drive_dictionary(node)
    for entry in objects.values():
        for variable in [entry] if isinstance(entry, ODVariable) else entry.values():
            if variable.default is None and variable.data_type in ODVariable.STRUCT_TYPES:
                variable.default = 0
    return objects, profile
