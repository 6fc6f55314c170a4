"""A CiA 402 drive: configured and read back by SDO, driven by PDO."""

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
SYNCS = 3  # answers that may be missing of what answers every 10 ms
_COMMAND = struct.Struct("<Hbi")  # control word, mode, target
_SHOWN = struct.Struct("<Hbi")  # status word, mode, position
_TORQUE = struct.Struct("<h")  # per mille of the rated one
_NAN = float("nan")
_RARER, _MOST_RARE = 5, 240  # times what need not be known at each SYNC; SYNCs, as CiA 301 counts them
SPEED_TARGET, SPEED = Entry(od.TARGET_SPEED, 0, 32), Entry(od.VELOCITY, 0, 32, signed=True)
_NEEDED = (
    Entry(od.CONTROL, 0, 16),
    Entry(od.MODE, 0, 8),
    Entry(od.STATUS, 0, 16),
    Entry(od.MODE_SHOWN, 0, 8),
)


class Drive402:
    """``word`` and ``goal`` are what is wanted; ``exchange`` sends it, the answers come with the bus's pump.

    ``target`` is the object that the command carries: a position, or a speed for a spindle. ``told`` is what
    the drive tells besides, as far as it has it.
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
        self._told_as: tuple[Entry, ...] = ()  # what of it the drive has
        self.told: dict[int, int] = {}  # by object
        self.tracks: int | None = None  # in any mode but this one its target is the place where it stands
        self.goal = DriveState.OFF
        self.extra = 0  # bits 4, 5, 6, 8 of the control word, while enabled
        self.mode = 0
        self.target = 0
        self.word = 0  # of the last command
        self.status = 0
        self.shown_mode = 0
        self.position = 0  # counts
        self._load = _NAN
        self.missing = 0  # SYNCs without an answer
        self.heard = self.asked = self.answered = bus.clock.now()  # answered: the SYNC that it shows
        self.trouble: Fault | str = ""
        self.rebooted = False
        self._resetting = False
        self._patience = bus.config.patience  # answers that it may leave out
        self._beats = True  # it has a heartbeat that can be watched

    @property
    def state(self) -> DriveState:
        """As the last status word has it."""
        return state_of(self.status)

    @property
    def enabled(self) -> bool:
        """Power is on and the drive obeys."""
        return self.state is DriveState.ENABLED

    @property
    def silent(self) -> bool:
        """Whether it has left too many SYNCs unanswered: what it shows is of before."""
        return self.missing > self._patience

    @property
    def tells_inputs(self) -> bool:
        """Whether it has digital inputs that can be read."""
        return self.profile.inputs in self._told_as

    @property
    def inputs(self) -> int:
        """Its digital inputs; none are on where it tells none."""
        return self.told.get(self.profile.inputs.object, 0)

    @property
    def speed(self) -> int:
        """What it turns at, in its unit, where it was asked for that."""
        return self.told.get(od.VELOCITY, 0)

    @property
    def load(self) -> float:
        """Per cent of the rated torque, signed; nan where it tells none, and while it is silent."""
        return _NAN if self.silent else self._load

    def connect(self, work: DriveWork) -> None:
        """Check, configure and map it in PRE-OPERATIONAL. Raises DriverError with what does not fit."""
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
        """Have it tell its torque where it can: a figure for the scope, for which no start is refused."""
        self._load = _NAN
        if self.setup.has(od.TORQUE, 0):
            every = min(_RARER * self.bus.config.seldom, _MOST_RARE)
            with suppress(DriverError):  # some map it nowhere, or have no fourth PDO
                self.setup.transmit(4, self._torque, (od.TORQUE, 16), every=every)

    def operational(self) -> None:
        """NMT start; only after every node has been configured."""
        self.node.nmt.state = "OPERATIONAL"

    def command(self) -> None:
        """Send what is wanted; the drive applies it at the next SYNC."""
        if self.tracks is not None and not (self.enabled and self.shown_mode == self.tracks):
            self.target = self.position  # it begins where it stands, whatever moved it meanwhile
        self.word = self._next_word()
        data = _COMMAND.pack(self.word, self.mode, self.target)
        self.bus.send_message(0x200 + self.id, data)

    def sync_sent(self, now: float, *, counted: bool = True) -> None:
        """A SYNC goes out; ``counted``: an answer to it is waited for."""
        self.missing, self.asked = self.missing + counted, now

    def push(self, record: bytes) -> None:
        """One more record for the queue in the drive."""
        self.bus.send_message(0x300 + self.id, record)

    def clear(self) -> None:
        """Begin to reset a fault; ends without power, whatever was wanted before."""
        self.goal, self.extra, self._resetting = DriveState.OFF, 0, True

    def look(self, patience: float) -> None:
        """Supervise: heartbeat, answers, status. ``trouble`` stays until ``forget``."""
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
    """As a PDO's entries are written: object + sub · 65536, bits."""
    return entry.object | entry.sub << 16, entry.bits


@dataclass(frozen=True, slots=True)
class DriveWork:
    """What a drive is configured for: bits of 0x6502, what is written, and the object of its queue.

    ``needed`` are objects without which it cannot be used; ``period`` of setpoints that it has to watch.
    """

    modes: int
    standing: Objects
    own: Objects = ()
    needed: tuple[int, ...] = ()
    records: int = 0
    period: float = 0.0
    axis: bool = True  # it answers each SYNC; a spindle every 10 ms
