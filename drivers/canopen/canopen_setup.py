"""Setup of a node before it runs: checks, configuration with read-back, and PDO mapping."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

import canopen
from canopen.pdo import PdoBase, PdoMap
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from core.message import Message
from core.ports import DriverError
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import Bus, Node
from drivers.canopen.canopen_config import AxisConfig
from drivers.canopen.canopen_nodes import Objects
from drivers.canopen.canopen_objects import MODE_BITS
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.drive_profiles import WITHOUT, Entry

_Answer = TypeVar("_Answer")

_PROFILE = 0xFFFF
_AT_ONCE = 255
_INVALID, _NO_REMOTE = 1 << 31, 1 << 30  # A PDO that is being mapped; a PDO without remote request.
_NO_SUCH_OBJECT = frozenset((0x06020000, 0x06090011))  # SDO abort codes: object or sub-index does not exist.
# SDO abort codes: the object exists, but has no value or an invalid value.
_NO_VALUE = frozenset((0x060A0023, 0x08000024, 0x08000000))
_READ_ONLY = frozenset((0x06010000, 0x06010002))  # SDO abort codes: unsupported access, read-only.
_MAPS = 0x200  # Distance from the communication record of a PDO to its mapping.
_SYNCS_AWAY, _LEAST_AWAY = 5, 20  # SYNCs and ms without setpoints after which the node must stop.
_NAMES = {1: "profile position", 3: "profile velocity", 6: "homing", 7: "interpolated position", 8: "CSP"}


class Setup:
    """Setup of one node by SDO; each error names the node, the object and the response."""

    def __init__(self, bus: Bus, name: str, number: int, objects: canopen.ObjectDictionary) -> None:
        self._bus = bus
        self._name = name
        self.node = Node(number, objects)
        bus.add_node(self.node)
        self.lacks: dict[int, str] = {}  # Missing objects with the consequence.

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence about all objects that the node lacks, or an empty tuple."""
        if not self.lacks:
            return ()
        told = "; ".join(f"{index:04X}h {what}" for index, what in sorted(self.lacks.items()))
        return (
            Message(
                "{name}: node {node} lacks these objects: {details}",
                name=self._name,
                node=self.node.id,
                details=told,
            ),
        )

    def pre_operational(self) -> None:
        """Set the node to PRE-OPERATIONAL, the only state in which PDO mapping may change."""
        self.node.nmt.state = "PRE-OPERATIONAL"

    def read(self, index: int, sub: int = 0) -> int:
        """Return one object as a number, signed if the dictionary says so."""
        data = self._sdo(index, sub, lambda: self.node.sdo.upload(index, sub))
        return self._number(index, sub, data)

    def write(self, index: int, sub: int, value: int) -> None:
        """Write one object if its value differs, and read it back.

        Raises DriverError if the node rejects the value or stores another one.
        """
        variable = self.node.object_dictionary.get_variable(index, sub)
        blind = variable is not None and not variable.readable  # For example, the command to clear a queue.
        there = None if blind else self._value(index, sub)
        size = len(variable) // 8 if there is None and variable is not None else len(there or b"")
        data = (value % (1 << 8 * size)).to_bytes(size, "little")
        if not self._put(index, sub, data, there) or blind:
            return
        kept = self._upload(index, sub)
        if kept != data:
            shown = int.from_bytes(kept, "little")
            raise self._unfit(
                "{name}: object {index}:{sub} remains at {shown} instead of {value}; check which "
                "values the drive allows, and check [canopen.sdo]",
                index=f"{index:04X}",
                sub=sub,
                shown=shown,
                value=value,
            )

    def write_bytes(self, index: int, sub: int, data: bytes) -> None:
        """Write an object that cannot be read back. Raises DriverError."""
        self._sdo(index, sub, lambda: self.node.sdo.download(index, sub, data))

    def configure(self, standing: Objects, own: Objects = (), needed: Iterable[int] = ()) -> None:
        """Write TurnDesk's values, then those of the machine file, to the objects that the node has.

        ``lacks`` lists the missing objects. Raises DriverError that names all missing objects of ``needed``,
        or those of the machine file that are not optional.
        """
        self.lacks = {}
        named = {(index, sub) for index, sub, _ in own}
        absent = []
        for index, sub, value in (*(each for each in standing if each[:2] not in named), *own):
            if not self.try_write(index, sub, value) and (index, sub) in named and index not in WITHOUT:
                absent.append(f"{index:04X}:{sub}")
        missing = [f"{index:04X}h {self.lacks[index]}" for index in needed if index in self.lacks]
        if missing:
            raise self._unfit(
                "{name}: node {node} cannot be used because it lacks these objects: {missing}",
                missing="; ".join(missing),
            )
        if absent:
            where = "; remove these objects from [canopen.sdo], or check the EDS file"
            raise self._unfit(
                "{name}: node {node} has no object {absent}{place}",
                absent=", ".join(absent),
                place=where,
            )

    def try_write(self, index: int, sub: int, value: int) -> bool:
        """Write an object if the node has it, and return whether it has. Raises DriverError."""
        if self.has(index, sub):
            self.write(index, sub, value)
            return True
        self.lacks[index] = WITHOUT.get(index, "")
        return False

    def watch_setpoints(self, period: float) -> None:
        """Make the node detect a missing SYNC or setpoint, by the means that it supports."""
        longest = max(round(1000 * _SYNCS_AWAY * period), _LEAST_AWAY)
        watched = False
        for index, sub, value in ((od.SYNC_PERIOD, 0, round(1e6 * period)), (od.COMMANDED, 5, longest)):
            if self.has(index, sub):
                self.write(index, sub, value)
                watched = True
        if not watched:
            self.lacks[od.COMMANDED] = WITHOUT[od.COMMANDED]

    def demand_profile(self, profile: int) -> None:
        """Raise DriverError if the device profile differs from the machine file."""
        found = self.read(od.DEVICE_TYPE) & _PROFILE
        if found != profile:
            raise self._unfit(
                "{name}: node {node} has device profile {value} instead of {profile}; check the node "
                "numbers in [canopen.nodes]",
                value=found,
                profile=profile,
            )

    def demand_modes(self, modes: int, known: int = 0) -> None:
        """Raise DriverError if a needed mode is neither in 0x6502 nor in ``known``."""
        offered = known | (self.read(od.SUPPORTED) if self.has(od.SUPPORTED, 0) else modes)
        lacking = [_NAMES[mode] for mode, bit in MODE_BITS.items() if modes & bit and not offered & bit]
        if lacking:
            raise self._unfit(
                "{name}: the drive does not support mode {lacking}; check [canopen] mode",
                lacking=", ".join(lacking),
            )

    def demand(self, *entries: Entry) -> None:
        """Raise DriverError that names all missing objects of ``entries``."""
        missing = [
            f"{entry.object:04X}:{entry.sub}" for entry in entries if not self.has(entry.object, entry.sub)
        ]
        if missing:
            raise self._unfit(
                "{name}: node {node} cannot be used in this mode because it lacks these objects: "
                "{missing}; check [canopen] mode and the node's EDS file",
                missing=", ".join(missing),
            )

    def demand_homing(self, method: int) -> None:
        """Raise DriverError if the homing method is not in the drive's list (0x60E3)."""
        listed = [self.read(od.HOME_METHODS, sub + 1) for sub in range(self.entries(od.HOME_METHODS))]
        offered = sorted({each for each in listed if each})
        if offered and method not in offered:
            known = ", ".join(map(str, offered))
            raise self._unfit(
                "{name}: the drive does not support homing method {method} (60E3h: {known}); check "
                "axis.{name2}.home",
                method=method,
                known=known,
                name2=self._name,
            )

    def demand_turn(self, counts: int) -> None:
        """Raise DriverError if gear and feed of the drive give other counts per motor revolution."""
        places = [(od.GEAR, 1), (od.GEAR, 2), (od.FEED, 1), (od.FEED, 2)]
        if not all(self.has(*place) for place in places):
            return
        motor, shaft, feed, turns = [self.read(*place) for place in places]
        if not (motor and shaft and feed and turns):
            return
        found = feed * shaft / (turns * motor)
        if abs(found - counts) > 0.5:
            raise self._unfit(
                "{name}: the drive uses {value} counts per motor revolution (6091h, 6092h), but "
                "canopen.nodes.{name2}.counts_per_rev is {counts}",
                value=f"{found:g}",
                name2=self._name,
                counts=counts,
            )

    def entries(self, index: int) -> int:
        """Return the number of entries of an array, or 0 if the node does not have the object."""
        return self.read(index, 0) if self.has(index, 0) else 0

    def has(self, index: int, sub: int) -> bool:
        """Return whether the node has an object, by its dictionary and by a test read.

        The test is necessary because an EDS file may be newer than the device.
        """
        variable = self.node.object_dictionary.get_variable(index, sub)
        if variable is None:
            return False
        return not variable.readable or not self._refused(index, sub)

    def _value(self, index: int, sub: int) -> bytes | None:
        """Return the value of an object, or None if the object does not have a value yet."""
        variable = self.node.object_dictionary.get_variable(index, sub)
        try:
            return self._upload(index, sub)
        except DriverError as error:
            if variable is None or _abort(error) not in _NO_VALUE:
                raise
        return None

    def _put(self, index: int, sub: int, data: bytes, there: bytes | None) -> bool:
        """Write ``data`` unless the object already has this value; return whether it was written.

        Raises DriverError. All configuration uses this method, because many drives have objects that are
        read-only or locked but already have the required value.
        """
        if there == data:
            return False
        try:
            self.write_bytes(index, sub, data)
        except DriverError as error:
            if there is None or _abort(error) not in _READ_ONLY:
                raise
            now, wanted = (self._number(index, sub, each) for each in (there, data))
            raise self._unfit(
                "{name}: node {node}, object {index}:{sub} is read-only; its value is {now}, but "
                "{expected} is needed. Set it with the drive's own software, or correct [canopen.sdo]",
                reason="read-only",
                index=f"{index:04X}",
                sub=sub,
                now=now,
                expected=wanted,
            ) from error
        return True

    def _refused(self, index: int, sub: int) -> bool:
        """Return whether the node reports that it does not have the object."""
        try:
            self._upload(index, sub)
        except DriverError as error:
            if _abort(error) in _NO_SUCH_OBJECT:
                return True
            if _abort(error) not in _NO_VALUE:
                raise
        return False

    def _upload(self, index: int, sub: int) -> bytes:
        data: bytes = self._sdo(index, sub, lambda: self.node.sdo.upload(index, sub))
        return data

    def receive(self, number: int, *entries: tuple[int, int], at_once: bool = False) -> None:
        """Map the objects that the node receives in PDO ``number`` as (object + sub · 65536, bits)."""
        self._map(self._pdo(self.node.rpdo, number), entries, _AT_ONCE if at_once else 1)

    def transmit(
        self, number: int, heard: Callable[[PdoMap], None], *entries: tuple[int, int], every: int = 1
    ) -> None:
        """Map the objects that the node sends in PDO ``number`` at every ``every``-th SYNC."""
        pdo = self._pdo(self.node.tpdo, number)
        self._map(pdo, entries, every)
        pdo.callbacks[:] = [heard]

    def _unfit(self, text: str, *, reason: str = "", **values: object) -> DriverError:
        """Return the error for a node that does not match; the text may contain name and number."""
        return DriverError(text, "drive-setup", reason=reason, name=self._name, node=self.node.id, **values)

    def _pdo(self, pdos: PdoBase, number: int) -> PdoMap:
        try:
            found: PdoMap = pdos[number]
        except KeyError as error:
            raise self._unfit(
                "{name}: PDO {number} is not in the node's EDS file",
                number=number,
            ) from error
        return found

    def _map(self, pdo: PdoMap, entries: tuple[tuple[int, int], ...], kind: int) -> None:
        """Map a PDO unless it already has the required mapping, because many modules have a fixed mapping.

        The library's ``save`` writes no entries if the dictionary has them as an array.
        """
        base = pdo.com_record.od.index
        pdo.clear()
        for index, bits in entries:
            pdo.add_variable(index & 0xFFFF, index >> 16, bits)
        cob = pdo.predefined_cob_id
        pdo.cob_id, pdo.trans_type, pdo.enabled = cob, kind, True
        assert cob is not None
        # If a PDO does not support remote requests, this bit cannot be changed.
        cob |= self.read(base, 1) & _NO_REMOTE
        wanted = [(index & 0xFFFF) << 16 | (index >> 16) << 8 | bits for index, bits in entries]
        mapped = self._mapped(base + _MAPS) == wanted
        if not mapped or self.read(base, 1) != cob or self.read(base, 2) != kind:
            self._put_number(base, 1, cob | _INVALID, 4)
            self._put_number(base, 2, kind, 1)
            if not mapped:
                self._map_entries(base + _MAPS, wanted)
            self._put_number(base, 1, cob, 4)
        pdo.subscribe()

    def _map_entries(self, index: int, wanted: list[int]) -> None:
        self._put_number(index, 0, 0, 1)
        for sub, entry in enumerate(wanted, 1):
            self._put_number(index, sub, entry, 4)
        self._put_number(index, 0, len(wanted), 1)

    def _mapped(self, index: int) -> list[int]:
        """Return the present mapping of a PDO."""
        return [self.read(index, sub) for sub in range(1, self.read(index, 0) + 1)]

    def _put_number(self, index: int, sub: int, value: int, size: int) -> None:
        self._put(index, sub, value.to_bytes(size, "little"), self._value(index, sub))

    def _number(self, index: int, sub: int, data: bytes) -> int:
        variable = self.node.object_dictionary.get_variable(index, sub)
        signed = variable is not None and variable.data_type in canopen.objectdictionary.SIGNED_TYPES
        return int.from_bytes(data, "little", signed=signed)

    def _sdo(self, index: int, sub: int, do: Callable[[], _Answer]) -> _Answer:
        """Perform an SDO operation on one object and convert its errors into DriverError."""
        where = Message(
            "{name}: node {node}, object {index}:{sub}",
            name=self._name,
            node=self.node.id,
            index=f"{index:04X}",
            sub=sub,
        )
        try:
            return do()
        except SdoAbortedError as error:
            raise DriverError(
                "{place}: the node rejected the request: {error}", "drive-setup", place=where, error=error
            ) from error
        except SdoCommunicationError as error:
            why = self._bus.trouble or Message("{error}; check cable, power and node number", error=error)
            raise DriverError("{place}: {why}", "drive-silent", place=where, why=why) from error
        except KeyError as error:
            raise DriverError(
                "{place} is not in the node's object dictionary; check its EDS file",
                "drive-setup",
                place=where,
            ) from error


def _abort(error: DriverError) -> int:
    """Return the SDO abort code that caused an error, or 0."""
    cause = error.__cause__
    return cause.code if isinstance(cause, SdoAbortedError) else 0


# --- Default objects written to every drive at each start: stops, limits and monitoring.


def axis_objects(config: AxisConfig, bus: CanopenTable) -> Objects:
    """Return the objects written to an axis drive, in its own units."""
    return (
        *config.profile.units,
        *stopping(bus),
        (od.WINDOW, 0, round(config.following_window / config.count)),
        (od.WINDOW_TIME, 0, round(1000 * config.following_time)),
        (od.QUICK_DECEL, 0, config.acceleration(config.amax)),
        *(limits(config) if config.absolute else ()),
    )


def stopping(bus: CanopenTable) -> Objects:
    """Return the objects for any drive: a quick stop without a heartbeat of TurnDesk, then power off."""
    return (
        (od.ABORT_OPTION, 0, 3),
        (od.QUICK_OPTION, 0, 2),
        (od.FAULT_OPTION, 0, 2),
        *watching(bus),
    )


def watching(bus: CanopenTable) -> Objects:
    """Return the objects for any node: its heartbeat, and a timeout of three heartbeats of TurnDesk."""
    return (
        (od.HEARTBEAT, 0, round(1000 * bus.heartbeat)),
        (od.WATCHED, 1, bus.host_id << 16 | round(3000 * bus.heartbeat)),
    )


def limits(config: AxisConfig) -> Objects:
    """Return the software limits of the drive, which are valid only after homing."""
    if config.travel is None:
        return ()
    low, high = config.travel
    return ((od.LIMITS, 1, round(low / config.count)), (od.LIMITS, 2, round(high / config.count)))
