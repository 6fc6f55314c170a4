"""All devices of a machine on one bus, with the simulated slides, spindle and terminals behind them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import can
from canopen import ObjectDictionary
from canopen.objectdictionary import ODVariable

from core.ports import Clock
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import opened
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_nodes import CanNode
from drivers.canopen.drive_profiles import DriveProfile
from drivers.simulators.canopen_axis_drive import AxisDrive
from drivers.simulators.canopen_modules import EncoderDevice, TerminalBoard
from drivers.simulators.canopen_node import Device, DeviceNetwork, DeviceNode
from drivers.simulators.canopen_spindle_drive import SpindleDrive
from drivers.simulators.plant import Plant
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_hands import PlantHands, Schedule

_SETTLED = 1e-9


class DevicePlant(Plant):
    """The simulated machine, its slides moved by drives that think for themselves."""

    def __init__(self, config: SimConfig, clock: Clock) -> None:
        super().__init__(config, clock)
        self.drives: dict[str, AxisDrive] = {}
        self.spindle_drive: SpindleDrive | None = None
        self._at = clock.now()

    def advance(self) -> float:
        """Bring everything up to the clock in steps of the model; returns the clock's time."""
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
        """Whether further steps change nothing until a frame or a hand comes."""
        if self.spindle.faults.belt or (self.spindle_drive is not None and not self.spindle_drive.rests):
            return False
        return all(drive.rests for drive in self.drives.values())

    def trip(self, fault: str) -> None:
        """The drive named before the colon gives up, with an EMCY."""
        name = fault.partition(":")[0]
        self.drives[name].power.trip()
        self.drives[name].emergency(0x4210)

    def press_estop(self) -> None:
        """The hardware chain: drives brake and lose power, the spindle too."""
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
    """``pump`` takes in what has come and lets time pass; call it from one thread."""

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
        self.cut = False  # the cable is off
        self.arrival: Callable[[float], float] | None = None  # a frame's time stamp to this clock's time
        self._early: can.Message | None = None
        self._build()

    def pump(self, wait: float = 0.0) -> None:
        """Everything that is due now; waits at most so many seconds for the first frame."""
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
                self._early = message  # a peer that was away takes each frame at its time, not all at once
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
        """Pull the cable out or put it in again: nothing is heard on either side."""
        self.cut = out
        for node in self.nodes.values():
            node.silent = out

    def close(self) -> None:
        """Let the bus go."""
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
    """The dictionary of a drive, as its EDS file or its family has it; what it says no value of is 0."""
    objects, profile = od.drive_dictionary(node)
    for entry in objects.values():
        for variable in [entry] if isinstance(entry, ODVariable) else entry.values():
            if variable.default is None and variable.data_type in ODVariable.STRUCT_TYPES:
                variable.default = 0
    return objects, profile
