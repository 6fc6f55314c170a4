"""CiA 402 drive, configured by SDO and controlled by PDO."""

from __future__ import annotations

import struct
from contextlib import suppress
from dataclasses import dataclass

import canopen
from canopen.emcy import EmcyError

from core.message import Message
from core.ports import DriverError, Fault, FaultCode
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_nodes import CanNode, Objects
from drivers.canopen.canopen_objects import (
    QUICK,
    DriveState,
    reset_step,
    state_of,
    towards_enabled,
)
from drivers.canopen.canopen_setup import Setup
from drivers.canopen.drive_profiles import Entry

_FOLLOWING = 0x8611  # EMCY
SYNCS = 3  # Replies that may be missing from a device that replies every 10 ms.
_COMMAND = struct.Struct("<Hbi")  # control word, mode, target
_SHOWN = struct.Struct("<Hbi")  # status word, mode, position
_TORQUE = struct.Struct("<h")  # Per mille of the rated torque.
_NAN = float("nan")
# Factor of the interval of slow values, and the maximum interval in SYNCs by CiA 301.
_RARER, _MOST_RARE = 5, 240
SPEED_TARGET, SPEED = Entry(od.TARGET_SPEED, 0, 32), Entry(od.VELOCITY, 0, 32, signed=True)
_NEEDED = (
    Entry(od.CONTROL, 0, 16),
    Entry(od.MODE, 0, 8),
    Entry(od.STATUS, 0, 16),
    Entry(od.MODE_SHOWN, 0, 8),
)


class Drive402:
    """CiA 402 drive with its commanded and reported values.

    ``goal``, ``mode``, ``extra`` and ``target`` are the commanded values, which ``command`` sends. ``target``
    is a position, or a speed for a spindle. The dictionary of reported values holds optional objects by
    index.
    """

    def __init__(self, bus: Bus, config: CanNode, target: Entry, told: tuple[Entry, ...]) -> None:
        self.bus = bus
        self.name = config.name
        self.id = config.id
        objects, self.profile = od.drive_dictionary(config)
        self.setup = Setup(bus, self.name, self.id, objects)
        self.node = self.setup.node
        self._target_object = target
        self._asked_for = (*told, self.profile.inputs)
        self._told_as: tuple[Entry, ...] = ()  # Optional objects that the drive has.
        self.told: dict[int, int] = {}  # By object index.
        self.tracks: int | None = None  # In all other modes, the target is the present position.
        self.goal = DriveState.OFF
        self.extra = 0  # bits 4, 5, 6, 8 of the control word, while enabled
        self.mode = 0
        self.target = 0
        self.word = 0  # Control word of the last command.
        self.status = 0
        self.shown_mode = 0
        self.position = 0  # counts
        self._load = _NAN
        self.missing = 0  # SYNCs without an answer
        # The last one is the time of the SYNC of the last reply.
        self.heard = self.asked = self.answered = bus.clock.now()
        self.trouble: Fault | str = ""
        self.rebooted = False
        self._resetting = False
        self._patience = bus.config.patience  # Number of replies that may be missing.
        self._beats = True  # The drive has a heartbeat.

    @property
    def state(self) -> DriveState:
        """The state in the last status word."""
        return state_of(self.status)

    @property
    def enabled(self) -> bool:
        """Whether the drive has power and follows commands."""
        return self.state is DriveState.ENABLED

    @property
    def silent(self) -> bool:
        """Whether too many replies to SYNC are missing, so that the reported values are old."""
        return self.missing > self._patience

    @property
    def tells_inputs(self) -> bool:
        """Whether the drive reports digital inputs."""
        return self.profile.inputs in self._told_as

    @property
    def inputs(self) -> int:
        """The digital inputs as bits, or 0 if the drive does not report them."""
        return self.told.get(self.profile.inputs.object, 0)

    @property
    def speed(self) -> int:
        """The measured speed in the drive's unit, or 0 if it is not mapped."""
        return self.told.get(od.VELOCITY, 0)

    @property
    def load(self) -> float:
        """The torque in percent of the rated torque, signed.

        The value is nan if the drive does not report its torque, or while the drive is silent.
        """
        return _NAN if self.silent else self._load

    def connect(self, work: DriveWork) -> None:
        """Check, configure and map the drive in PRE-OPERATIONAL. Raises DriverError if it does not match."""
        setup, records = self.setup, work.records
        setup.pre_operational()
        setup.demand_profile(402)
        setup.demand_modes(work.modes, self.profile.modes)
        setup.configure(work.standing, work.own, work.needed)
        setup.demand(*_NEEDED, self._target_object)
        if work.period:
            setup.watch_setpoints(work.period)
        setup.receive(1, (od.CONTROL, 16), (od.MODE, 8), _mapped(self._target_object))
        if records:
            setup.receive(2, (records, 64), at_once=True)
        shown = ((od.STATUS, 16), (od.MODE_SHOWN, 8), (od.POSITION, 32))
        setup.transmit(1, self._shown, *shown, every=1 if work.axis else self.bus.config.seldom)
        self._told_as = tuple(each for each in self._asked_for if setup.has(each.object, each.sub))
        if self._told_as:
            more = [_mapped(entry) for entry in self._told_as]
            setup.transmit(2, self._told, *more, every=self.bus.config.seldom)
        self._ask_load()
        self._beats = od.HEARTBEAT not in setup.lacks
        self._patience = self.bus.config.patience if work.axis else SYNCS
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.node.emcy.add_callback(self._emergency)
        self.status = setup.read(od.STATUS)
        self.position = self.target = setup.read(od.POSITION)
        self.heard, self.missing, self.rebooted, self.trouble = self.bus.clock.now(), 0, False, ""

    def _ask_load(self) -> None:
        """Map the torque for the scope if possible; a failure does not prevent operation."""
        self._load = _NAN
        if self.setup.has(od.TORQUE, 0):
            every = min(_RARER * self.bus.config.seldom, _MOST_RARE)
            with suppress(DriverError):  # Some drives cannot map the torque or have no fourth PDO.
                self.setup.transmit(4, self._torque, (od.TORQUE, 16), every=every)

    def operational(self) -> None:
        """Start the drive by NMT, after all nodes are configured."""
        self.node.nmt.state = "OPERATIONAL"

    def command(self) -> None:
        """Send the commanded values, which the drive applies at the next SYNC."""
        if self.tracks is not None and not (self.enabled and self.shown_mode == self.tracks):
            self.target = self.position  # The drive starts at its present position.
        self.word = self._next_word()
        data = _COMMAND.pack(self.word, self.mode, self.target)
        self.bus.send_message(0x200 + self.id, data)

    def sync_sent(self, now: float, *, counted: bool = True) -> None:
        """Record that a SYNC is sent; with ``counted``, a reply is expected."""
        self.missing, self.asked = self.missing + counted, now

    def push(self, record: bytes) -> None:
        """Send one record to the queue in the drive."""
        self.bus.send_message(0x300 + self.id, record)

    def clear(self) -> None:
        """Start to reset a fault; the drive is without power afterwards."""
        self.goal, self.extra, self._resetting = DriveState.OFF, 0, True

    def look(self, patience: float) -> None:
        """Set a fault for missing heartbeats or replies, or a drive fault; it remains until ``forget``.

        ``patience`` is the heartbeat timeout in seconds.
        """
        now = self.bus.clock.now()
        if self._beats and now - self.heard > patience:
            self._wrong(
                "{name}: no heartbeat from the drive for {now} s; check cable and power",
                "drive-silent",
                name=self.name,
                now=f"{now - self.heard:.2f}",
            )
        elif self.silent:
            self._wrong(
                "{name}: the drive does not respond to SYNC; check cable and power",
                "drive-silent",
                name=self.name,
            )
        elif self.state in {DriveState.FAULT, DriveState.REACTING} and not self._resetting:
            self._wrong("{name}: drive fault", "axis", name=self.name)

    def forget(self) -> None:
        """Clear the stored fault."""
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

    def _wrong(self, what: str, code: FaultCode, **values: object) -> None:
        self.trouble = self.trouble or Fault(what, code, **values)

    def _shown(self, map_: canopen.pdo.PdoMap) -> None:
        self.status, self.shown_mode, self.position = _SHOWN.unpack(map_.data)
        self.missing, self.answered = 0, self.asked

    def _torque(self, map_: canopen.pdo.PdoMap) -> None:
        self._load = _TORQUE.unpack(map_.data)[0] / 10.0

    def _told(self, map_: canopen.pdo.PdoMap) -> None:
        if len(map_.data) != sum(entry.bits for entry in self._told_as) // 8:
            raise ValueError(f"{len(map_.data)} bytes")
        at = 0
        for index, _, bits, signed in self._told_as:
            size = bits // 8
            self.told[index] = int.from_bytes(map_.data[at : at + size], "little", signed=signed)
            at += size

    def _heartbeat(self, state: int) -> None:
        self.heard = self.bus.clock.now()
        if state == 0:
            self.rebooted = True
            self._wrong(
                "{name}: the drive has restarted; its position is lost", "drive-restarted", name=self.name
            )
        elif state == 4:
            self._wrong("{name}: the drive was stopped by an NMT command", "axis", name=self.name)

    def _emergency(self, error: EmcyError) -> None:
        if error.code & 0xFF00:
            what = Message(
                "{name}: {description} (EMCY {code})",
                name=self.name,
                description=error.get_desc().lower() or "drive error",
                code=f"{error.code:04X}",
            )
            self._wrong(what, "following" if error.code == _FOLLOWING else "axis")


def _mapped(entry: Entry) -> tuple[int, int]:
    """Return a PDO entry as (object + sub · 65536, bits)."""
    return entry.object | entry.sub << 16, entry.bits


@dataclass(frozen=True, slots=True)
class DriveWork:
    """Configuration of a drive: modes as bits of 0x6502, written objects, and the object of its queue.

    ``needed`` lists objects without which the drive cannot be used. ``period`` is the setpoint period in
    seconds that the drive must monitor.
    """

    modes: int
    standing: Objects
    own: Objects = ()
    needed: tuple[int, ...] = ()
    records: int = 0
    period: float = 0.0
    axis: bool = True  # Replies to each SYNC; a spindle replies every 10 ms.
