"""One CiA 402 drive: configured and read back by SDO, driven by PDO, and never switched on by itself."""

from __future__ import annotations

import struct

import canopen
from canopen.emcy import EmcyError

from core.ports import Fault, FaultCode
from drivers.canopen import objects as od
from drivers.canopen.bus import Bus, Node
from drivers.canopen.setup import Setup
from drivers.canopen.states import QUICK, DriveState, reset_step, state_of, towards_enabled

_FOLLOWING = 0x8611  # EMCY
SYNCS = 3  # answers that may be missing before a drive counts as silent
_COMMAND = struct.Struct("<Hbi")  # control word, mode, target
_SHOWN = struct.Struct("<Hbi")  # status word, mode, position
_MORE = struct.Struct("<iI")  # following error of an axis or speed of a spindle, digital inputs


class Drive402:
    """``word`` and ``goal`` are what is wanted; ``exchange`` sends it, the answers come with the bus's pump.

    ``target`` is the object that the command carries: a position, or a speed for a spindle.
    """

    def __init__(self, bus: Bus, name: str, node: int, eds: str, target: int, more: int) -> None:
        self.bus = bus
        self.name = name
        self.id = node
        self.node = Node(node, od.dictionary(name, eds, od.drive_objects))
        bus.add_node(self.node)
        self.setup = Setup(bus, self.node, name)
        self._target_object, self._more_object = target, more
        self.goal = DriveState.OFF
        self.extra = 0  # bits 4, 5, 6, 8 of the control word, while enabled
        self.mode = 0
        self.target = 0
        self.word = 0  # of the last command
        self.status = 0
        self.shown_mode = 0
        self.position = 0  # counts
        self.more = 0
        self.inputs = 0  # 0x60FD
        self.missing = 0  # SYNCs without an answer
        self.heard = self.asked = self.answered = bus.clock.now()  # answered: the SYNC that it shows
        self.trouble: Fault | str = ""
        self.rebooted = False
        self._resetting = False

    @property
    def state(self) -> DriveState:
        """As the last status word has it."""
        return state_of(self.status)

    @property
    def enabled(self) -> bool:
        """Power is on and the drive obeys."""
        return self.state is DriveState.ENABLED

    def connect(
        self, mappings: tuple[int, ...], modes: int, values: tuple[tuple[int, int, int], ...]
    ) -> None:
        """Check, configure and map it in PRE-OPERATIONAL. Raises DriverError with what does not fit.

        ``modes``: bits of 0x6502 that are needed. ``mappings``: objects received beside the command.
        """
        self.setup.pre_operational()
        self.setup.demand_profile(402)
        self.setup.demand_modes(modes)
        self.setup.write_all(values)
        self.setup.receive(1, (od.CONTROL, 16), (od.MODE, 8), (self._target_object, 32))
        if mappings:
            self.setup.receive(2, *((index, 64) for index in mappings), at_once=True)
        self.setup.transmit(1, self._shown, (od.STATUS, 16), (od.MODE_SHOWN, 8), (od.POSITION, 32))
        self.setup.transmit(2, self._told, (self._more_object, 32), (od.INPUTS_402, 32))
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.node.emcy.add_callback(self._emergency)
        self.status = self.setup.read(od.STATUS)
        self.position = self.target = self.setup.read(od.POSITION)
        self.heard, self.missing, self.rebooted, self.trouble = self.bus.clock.now(), 0, False, ""

    def operational(self) -> None:
        """NMT start; only after every node has been configured."""
        self.node.nmt.state = "OPERATIONAL"

    def command(self) -> None:
        """Send what is wanted; the drive applies it at the next SYNC."""
        self.word = self._next_word()
        data = _COMMAND.pack(self.word, self.mode, self.target)
        self.bus.send_message(0x200 + self.id, data)
        self.missing, self.asked = self.missing + 1, self.bus.clock.now()

    def push(self, record: bytes) -> None:
        """One more record for the queue in the drive."""
        self.bus.send_message(0x300 + self.id, record)

    def clear(self) -> None:
        """Begin to reset a fault; ends without power, whatever was wanted before."""
        self.goal, self.extra, self._resetting = DriveState.OFF, 0, True

    def look(self, patience: float) -> None:
        """Supervise: heartbeat, answers, status. ``trouble`` stays until ``forget``."""
        now = self.bus.clock.now()
        if now - self.heard > patience:
            self._wrong(
                f"{self.name}: no heartbeat for {now - self.heard:.2f} s; check cable and power",
                "drive-silent",
            )
        elif self.missing > SYNCS:
            self._wrong(f"{self.name}: the drive does not answer SYNC; check cable and power", "drive-silent")
        elif self.state in {DriveState.FAULT, DriveState.REACTING} and not self._resetting:
            self._wrong(f"{self.name}: drive fault", "axis")

    def forget(self) -> None:
        """The operator has seen it."""
        self.trouble = ""

    def _next_word(self) -> int:
        state = self.state
        if self._resetting:
            self._resetting = state in {DriveState.FAULT, DriveState.REACTING}
            return reset_step(state, self.word)
        if self.goal is DriveState.ENABLED:
            word = towards_enabled(state)
            return word | self.extra if state is DriveState.ENABLED else word
        if self.goal is DriveState.QUICK_STOP and state in {DriveState.ENABLED, DriveState.QUICK_STOP}:
            return QUICK
        return 0

    def _wrong(self, what: str, code: FaultCode) -> None:
        self.trouble = self.trouble or Fault(what, code)

    def _shown(self, map_: canopen.pdo.PdoMap) -> None:
        self.status, self.shown_mode, self.position = _SHOWN.unpack(map_.data)
        self.missing, self.answered = 0, self.asked

    def _told(self, map_: canopen.pdo.PdoMap) -> None:
        self.more, self.inputs = _MORE.unpack(map_.data)

    def _heartbeat(self, state: int) -> None:
        self.heard = self.bus.clock.now()
        if state == 0:
            self.rebooted = True
            self._wrong(f"{self.name}: the drive has restarted; its reference is lost", "drive-restarted")
        elif state == 4:
            self._wrong(f"{self.name}: the drive was stopped by NMT", "axis")

    def _emergency(self, error: EmcyError) -> None:
        if error.code & 0xFF00:
            what = f"{error.get_desc().lower() or 'drive error'} (EMCY {error.code:04X})"
            self._wrong(f"{self.name}: {what}", "following" if error.code == _FOLLOWING else "axis")
