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
from drivers.canopen.canopen_bus import open_can_interface
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_nodes import CanNode, CanTerminal
from drivers.canopen.drive_profiles import DriveProfile
from drivers.simulators.canopen_axis_drive import AxisDrive
from drivers.simulators.canopen_node import DeviceNetwork, DeviceNode, NodeDevice
from drivers.simulators.canopen_spindle_drive import SimulatedSpindleDrive
from drivers.simulators.plant import SimulatedPlant
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_controls import FaultSchedule, PlantControls

_STATION_NAMES = frozenset({"estop", "start", "hold", "spindle_auto"})


class SimulatedIoModule:
    """Simulated CiA 401 module that is connected to the inputs, outputs and pots of the plant."""

    def __init__(self, name: str, config: CanopenConfig, plant: SimulatedPlant) -> None:
        self._name = name
        self._config = config
        self._plant = plant
        self.output_bytes = bytearray(8)
        self.values: dict[tuple[int, int], int] = {}
        self._wired: dict[int, list[tuple[str, CanTerminal]]] = {}  # Inputs by sub-index.
        for name_of_input, where in config.inputs.items():
            if where.node_name == name:
                self._wired.setdefault(where.object_subindex, []).append((name_of_input, where))
        self._hands: object = None  # State of the plant that ``_bytes`` represents.
        self._bytes: dict[int, int] = {}
        self._pots = {
            pot.terminal.object_subindex: (of, pot)
            for of, pot in config.pots.items()
            if pot.terminal.node_name == name
        }
        for output, model in config.outputs.items():
            if plant.terminals.output_states.get(output):
                self.output_bytes[model.terminal.object_subindex - 1] |= 1 << model.terminal.bit_number

    def read(self, index: int, subindex: int) -> int | None:
        """Return the calculated value of an object, or None if the stored value is to be used."""
        if index == od.DEVICE_TYPE:
            return 0x000F0191
        if index == od.DIGITAL_IN and subindex:
            return self._inputs(subindex)
        if index == od.DIGITAL_OUT and subindex:
            return self.output_bytes[subindex - 1]
        if index == od.ANALOG_IN and subindex:
            return self._analog(subindex) if self.values.get((od.ANALOG_EVENTS, 0)) else 0
        return None

    def write(self, index: int, subindex: int, value: int) -> None:
        """Apply a value that the host has written to an object."""
        self.values[index, subindex] = value
        if index == od.DIGITAL_OUT:
            self._switch(subindex, value)

    def handle_host_loss(self) -> None:
        """Set every output that has an error mode to its error value; the other outputs do not change."""
        for sub in range(1, 9):
            mode = self.values.get((od.ERROR_MODE, sub), 0xFF)
            value = self.values.get((od.ERROR_VALUE, sub), 0)
            self._switch(sub, self.output_bytes[sub - 1] & ~mode | value & mode)

    def reset(self) -> None:
        """Switch off all outputs that have an error mode, as after a loss of power.

        Bistable outputs, such as the collet valve, do not change.
        """
        for sub in range(1, 9):
            kept = self.values.get((od.ERROR_MODE, sub), 0)
            self._switch(sub, self.output_bytes[sub - 1] & ~kept if kept else self.output_bytes[sub - 1])
        self.values.clear()

    def _switch(self, sub: int, value: int) -> None:
        self.output_bytes[sub - 1] = value & 0xFF
        now = self._plant.clock.now()
        for name, output in self._config.outputs.items():
            where = output.terminal
            on = bool(value >> where.bit_number & 1)
            board = self._plant.terminals
            if (
                where.node_name == self._name
                and where.object_subindex == sub
                and board.output_states.get(name) is not on
            ):
                board.write(name, on, now)

    def _inputs(self, sub: int) -> int:
        hands = self._plant.read_station_and_inputs(self._plant.clock.now())
        if hands is not self._hands:
            self._hands, self._bytes = hands, {}
        if sub not in self._bytes:
            self._bytes[sub] = self._byte(sub, *hands)
        return self._bytes[sub]

    def _byte(self, sub: int, state: StationState, inputs: Mapping[str, bool]) -> int:
        byte = 0
        for name, where in self._wired.get(sub, ()):
            on = getattr(state, name) if name in _STATION_NAMES else inputs.get(name)
            byte |= (bool(on) is not where.is_active_low) << where.bit_number
        return byte

    def _analog(self, sub: int) -> int:
        if sub not in self._pots:
            return 0
        name, pot = self._pots[sub]
        state, _ = self._plant.read_station_and_inputs(self._plant.clock.now())
        if name == "handwheel":
            return (state.handwheel + 2**15) % 2**16 - 2**15
        shown = self._plant.spindle.load_percent if name == "spindle_load" else getattr(state, name)
        fraction = (shown - pot.low_value) / (pot.high_value - pot.low_value)
        return round(32767 * min(max(fraction, 0.0), 1.0))


# --- A CiA 406 encoder on the simulated spindle, or at the second encoder input of a drive.


ENCODER_REVOLUTION_COUNT = 4096  # Number of revolutions after which the position wraps.


class SimulatedEncoder:
    """Simulated CiA 406 encoder on the spindle.

    If its coupling is detached, ``stuck`` is the constant position of the encoder; otherwise it is None.
    """

    def __init__(self, plant: SimulatedPlant, counts_per_rev: int) -> None:
        self._plant = plant
        self.counts = counts_per_rev  # Per revolution, signed.
        self.turns = ENCODER_REVOLUTION_COUNT
        self.steps = abs(counts_per_rev)  # The resolution that the encoder reports.
        self.stuck: int | None = None
        self.values: dict[tuple[int, int], int] = {}
        self._readers: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020196,
            od.ENCODER_RESOLUTION: lambda: self.steps,
            od.ENCODER_TURNS: lambda: self.turns,
            od.ENCODER_POSITION: lambda: self.position % (self.steps * self.turns),
        }

    def read(self, index: int, _sub: int) -> int | None:
        """Return the calculated value of an object, or None if the stored value is to be used."""
        reader = self._readers.get(index)
        return None if reader is None else reader()

    @property
    def position(self) -> int:
        """Return the position in counts since the start of the simulation."""
        return round(self._plant.spindle.revolutions * self.counts) if self.stuck is None else self.stuck

    def detach_coupling(self) -> None:
        """Detach the coupling, so that the position no longer changes."""
        self.stuck = self.position

    def write(self, index: int, subindex: int, value: int) -> None:
        """Store a value that the host has written to an object."""
        self.values[index, subindex] = value

    def handle_host_loss(self) -> None:
        """Do nothing, because an encoder does not need to react to the loss of the host."""

    def reset(self) -> None:
        """Clear the stored values; the absolute position does not change."""
        self.values.clear()


_SETTLED_S = 1e-9


class CanopenPlant(SimulatedPlant):
    """Simulated machine whose axes are moved by simulated CANopen drives."""

    def __init__(self, config: SimConfig, clock: Clock) -> None:
        super().__init__(config, clock)
        self.axis_drives: dict[str, AxisDrive] = {}
        self.spindle_drive: SimulatedSpindleDrive | None = None
        self._at = clock.now()

    def advance(self) -> float:
        """Advance the model step by step to the current time of the clock.

        Returns this time in seconds.
        """
        now = self.clock.now()
        with self.lock:
            self._apply_faults(now)
            step, rests = self.config.model_step_s, False
            while self._at + step <= now + _SETTLED_S:
                self._at += step
                if not rests:
                    self._step_drives(step)
                    rests = self._are_drives_idle()
            if self.spindle_drive is not None:
                self.spindle_drive.last_step_s = self._at
            if now > self.spindle.time_s:
                self.spindle.advance_to(now)
        return now

    def _step_drives(self, step: float) -> None:
        if self.spindle_drive is not None:
            self.spindle_drive.advance(self._at)
        for drive in self.axis_drives.values():
            drive.advance(step)
        if self.spindle.faults.belt_slip_fraction:
            self.spindle.set_cutting(self._at, is_cutting=self.is_cutting())

    def _are_drives_idle(self) -> bool:
        """Return whether the drives will not change before a frame arrives or the operator acts."""
        if self.spindle.faults.belt_slip_fraction or (
            self.spindle_drive is not None and not self.spindle_drive.is_idle
        ):
            return False
        return all(drive.is_idle for drive in self.axis_drives.values())

    def trip_drives(self, fault: str) -> None:
        """Trip the drive that ``fault`` names before its colon, and send the EMCY frame of this drive."""
        name = fault.partition(":")[0]
        self.axis_drives[name].power_states.enter_fault()
        self.axis_drives[name].send_emergency(0x4210)

    def press_estop(self) -> None:
        """Activate STO: the axes brake and then lose power, and the spindle coasts."""
        with self.action_lock:
            now = self.advance()
            self.station_panel.estop = True
            for drive in self.axis_drives.values():
                drive.power_states.is_sto_active = True
                drive.power_states.start_quick_stop()
            if self.spindle_drive is not None:
                self.spindle_drive.power_states.is_sto_active = True
                self.spindle_drive.power_states.switch_off()
            self.spindle.remove_power(now)


class CanopenDevices:
    """All simulated devices on one bus; only one thread may call ``process_frames``."""

    def __init__(self, config: CanopenConfig, sim: SimConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.plant = CanopenPlant(sim, clock)
        self.machine = PlantControls(self.plant)
        if sim.planned_faults:
            self.plant.apply_due_faults = FaultSchedule(self.machine, sim.planned_faults).apply_due_actions
        self.network = DeviceNetwork(open_can_interface(config.bus_settings))
        self.nodes: dict[str, DeviceNode] = {}
        self.encoder: SimulatedEncoder | None = None
        self.is_cable_disconnected = False  # The cable is disconnected.
        # Converts the time stamp of a frame to the time of this clock.
        self.convert_arrival_time: Callable[[float], float] | None = None
        self._early: can.Message | None = None
        self._build()

    def process_frames(self, timeout_s: float = 0.0) -> None:
        """Process received frames and advance the devices.

        The method waits at most ``timeout_s`` seconds for the first frame.
        """
        now = self.plant.advance()
        if self.plant.axis_drives and not self.plant.station_panel.estop:
            self._reset_sto()
        bus = self.network.bus
        while bus is not None:
            message = self._early or bus.recv(timeout_s)
            self._early = None
            if message is None:
                break
            if self.convert_arrival_time is not None and self.convert_arrival_time(message.timestamp) > now:
                self._early = message  # A process that was suspended handles each frame at its own time.
                break
            timeout_s = 0.0
            if not self.is_cable_disconnected and not message.is_error_frame:
                self._deliver(message.arbitration_id, bytes(message.data))
        for node in self.nodes.values():
            node.run_cycle(now)

    def _deliver(self, can_id: int, data: bytes) -> None:
        for node in self.nodes.values():
            if can_id in node.accepted_can_ids:
                node.handle_frame(can_id, data)

    def cable(self, *, is_disconnected: bool) -> None:
        """Disconnect or reconnect the bus cable, for both directions of transfer."""
        self.is_cable_disconnected = is_disconnected
        for node in self.nodes.values():
            node.is_silent = is_disconnected

    def close(self) -> None:
        """Close the connection to the bus."""
        if self.network.bus is not None:
            self.network.bus.shutdown()
            self.network.bus = None

    def _build(self) -> None:
        config, plant = self.config, self.plant
        for axis in config.axes:
            if axis.node is not None:
                servo = plant.servos[plant.axis_names.index(axis.name)]
                objects, profile = _simulated_dictionary(axis.node)
                counts = axis.counts_per_rev
                drive = AxisDrive(servo, partial(self._emergency, axis.name), profile, counts)
                plant.axis_drives[axis.name] = drive
                self._add(axis.name, axis.node.id, drive, objects)
        if config.spindle is not None:
            counts = config.spindle.node.counts_per_rev
            as_c = plant.config.axes[plant.axis_names.index("C")] if config.spindle.is_c_axis else None
            objects, profile = _simulated_dictionary(config.spindle.node)
            spindle = SimulatedSpindleDrive(
                plant.spindle, counts, partial(self._emergency, "spindle"), as_c, profile
            )
            plant.spindle_drive = spindle
            self._add("spindle", config.spindle.node.id, spindle, objects)
        if config.encoder is not None:
            self.encoder = encoder = SimulatedEncoder(plant, config.encoder.counts_per_rev)
            if config.encoder.node is not None:
                self._add(config.encoder.name, config.encoder.node.id, encoder, od.build_encoder_dictionary())
            else:
                plant.axis_drives[config.encoder.name].read_second_encoder = lambda: encoder.position
        for module in config.io_modules:
            board = SimulatedIoModule(module.name, config, plant)
            self._add(module.name, module.id, board, od.build_module_dictionary())

    def _add(self, name: str, number: int, device: NodeDevice, objects: ObjectDictionary) -> None:
        self.nodes[name] = DeviceNode(self.network, number, objects, device)

    def _emergency(self, name: str, code: int) -> None:
        self.nodes[name].send_emergency(code)

    def _reset_sto(self) -> None:
        for drive in self.plant.axis_drives.values():
            drive.power_states.is_sto_active = False
        if self.plant.spindle_drive is not None:
            self.plant.spindle_drive.power_states.is_sto_active = False


def _simulated_dictionary(node: CanNode) -> tuple[ObjectDictionary, DriveProfile]:
    """Return the object dictionary and the profile of a drive, from its EDS file or its drive family.

    Numeric objects without a default value are set to 0.
    """
    objects, profile = od.load_drive_dictionary(node)
    for entry in objects.values():
        for variable in [entry] if isinstance(entry, ODVariable) else entry.values():
            if variable.default is None and variable.data_type in ODVariable.STRUCT_TYPES:
                variable.default = 0
    return objects, profile
