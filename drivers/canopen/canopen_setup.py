"""Setup of a node before it starts: checks, verified configuration, and PDO mapping."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

import canopen
from canopen.pdo import PdoBase, PdoMap
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from core.message import Message
from core.ports import DriverError
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import CanBus, PollingNode
from drivers.canopen.canopen_config import AxisConfig
from drivers.canopen.canopen_nodes import ObjectValues
from drivers.canopen.canopen_objects import MODE_BITS
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.drive_profiles import MISSING_OBJECT_EFFECTS, PdoEntry

_Result = TypeVar("_Result")

_PROFILE_MASK = 0xFFFF
_EVENT_DRIVEN = 255
_INVALID, _NO_REMOTE = 1 << 31, 1 << 30  # A PDO that is being mapped; a PDO without remote request.
_MISSING_OBJECT_CODES = frozenset(
    (0x06020000, 0x06090011)
)  # SDO abort codes: object or sub-index does not exist.
# SDO abort codes: the object exists, but has no value or an invalid value.
_NO_VALUE_CODES = frozenset((0x060A0023, 0x08000024, 0x08000000))
_READ_ONLY_CODES = frozenset((0x06010000, 0x06010002))  # SDO abort codes: unsupported access, read-only.
_MAPPING_OFFSET = 0x200  # Distance from the communication record of a PDO to its mapping.
_SYNCS_AWAY, _LEAST_AWAY = 5, 20  # SYNCs and ms without setpoints after which the node must stop.
_MODE_NAMES = {
    1: "profile position",
    3: "profile velocity",
    6: "homing",
    7: "interpolated position",
    8: "CSP",
}


class NodeSetup:
    """Setup of one node by SDO.

    Every error names the node, the object and the response.
    """

    def __init__(self, bus: CanBus, name: str, node_id: int, dictionary: canopen.ObjectDictionary) -> None:
        self._bus = bus
        self._name = name
        self.node = PollingNode(node_id, dictionary)
        bus.add_node(self.node)
        self.missing_objects: dict[int, str] = {}  # Missing objects with the consequence.

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return one sentence that lists all missing objects of the node, in a tuple.

        Return an empty tuple if the node has all objects.
        """
        if not self.missing_objects:
            return ()
        objects = "; ".join(f"{index:04X}h {what}" for index, what in sorted(self.missing_objects.items()))
        return (
            Message(
                "{name}: node {node} lacks these objects: {details}",
                name=self._name,
                node=self.node.id,
                details=objects,
            ),
        )

    def enter_pre_operational(self) -> None:
        """Set the node to PRE-OPERATIONAL, because the PDO mapping may change only in this state."""
        self.node.nmt.state = "PRE-OPERATIONAL"

    def read(self, index: int, subindex: int = 0) -> int:
        """Return the value of one object, signed if the dictionary defines a signed type."""
        data = self._run_sdo(index, subindex, lambda: self.node.sdo.upload(index, subindex))
        return self._number(index, subindex, data)

    def write(self, index: int, subindex: int, value: int) -> None:
        """Write one object if its value differs, and read the value back.

        A write-only object is always written and is not read back. Raises DriverError if the node does not
        respond, rejects the value or stores a different value.
        """
        variable = self.node.object_dictionary.get_variable(index, subindex)
        blind = variable is not None and not variable.readable  # For example, the command to clear a queue.
        there = None if blind else self._read_bytes(index, subindex)
        size = len(variable) // 8 if there is None and variable is not None else len(there or b"")
        data = (value % (1 << 8 * size)).to_bytes(size, "little")
        if not self._write_if_changed(index, subindex, data, there) or blind:
            return
        kept = self._upload(index, subindex)
        if kept != data:
            shown = int.from_bytes(kept, "little")
            raise self._setup_error(
                "{name}: object {index}:{sub} remains at {shown} instead of {value}; check which "
                "values the drive allows, and check [canopen.sdo]",
                index=f"{index:04X}",
                sub=subindex,
                shown=shown,
                value=value,
            )

    def write_object_bytes(self, index: int, subindex: int, data: bytes) -> None:
        """Write the bytes of an object without reading them back.

        Raises DriverError if the node rejects the request or does not respond.
        """
        self._run_sdo(index, subindex, lambda: self.node.sdo.download(index, subindex, data))

    def configure_objects(
        self,
        default_objects: ObjectValues,
        file_objects: ObjectValues = (),
        required_objects: Iterable[int] = (),
    ) -> None:
        """Write TurnDesk's values and then the machine file's values to the objects that exist.

        ``missing_objects`` collects the objects that the node lacks. Raises DriverError if the node lacks
        an object in ``required_objects``, or a mandatory object of the machine file. The error names all
        such objects. Also raises DriverError if the node does not respond, rejects a value or stores a
        different value.
        """
        self.missing_objects = {}
        named = {(index, sub) for index, sub, _ in file_objects}
        absent = []
        for index, sub, value in (
            *(each for each in default_objects if each[:2] not in named),
            *file_objects,
        ):
            if (
                not self.write_optional_object(index, sub, value)
                and (index, sub) in named
                and index not in MISSING_OBJECT_EFFECTS
            ):
                absent.append(f"{index:04X}:{sub}")
        missing = [
            f"{index:04X}h {self.missing_objects[index]}"
            for index in required_objects
            if index in self.missing_objects
        ]
        if missing:
            raise self._setup_error(
                "{name}: node {node} cannot be used because it lacks these objects: {missing}",
                missing="; ".join(missing),
            )
        if absent:
            where = "; remove these objects from [canopen.sdo], or check the EDS file"
            raise self._setup_error(
                "{name}: node {node} has no object {absent}{place}",
                absent=", ".join(absent),
                place=where,
            )

    def write_optional_object(self, index: int, subindex: int, value: int) -> bool:
        """Write an object if the node has it, and return whether the node has it.

        Raises DriverError if the node does not respond, rejects the value or stores a different value.
        """
        if self.has_object(index, subindex):
            self.write(index, subindex, value)
            return True
        self.missing_objects[index] = MISSING_OBJECT_EFFECTS.get(index, "")
        return False

    def enable_setpoint_monitoring(self, period_s: float) -> None:
        """Make the node detect a missing SYNC or setpoint, as far as its objects support this."""
        longest = max(round(1000 * _SYNCS_AWAY * period_s), _LEAST_AWAY)
        watched = False
        for index, sub, value in ((od.SYNC_PERIOD, 0, round(1e6 * period_s)), (od.COMMANDED, 5, longest)):
            if self.has_object(index, sub):
                self.write(index, sub, value)
                watched = True
        if not watched:
            self.missing_objects[od.COMMANDED] = MISSING_OBJECT_EFFECTS[od.COMMANDED]

    def require_profile(self, profile: int) -> None:
        """Raise DriverError if the node has a device profile other than ``profile``."""
        found = self.read(od.DEVICE_TYPE) & _PROFILE_MASK
        if found != profile:
            raise self._setup_error(
                "{name}: node {node} has device profile {value} instead of {profile}; check the node "
                "numbers in [canopen.nodes]",
                value=found,
                profile=profile,
            )

    def require_modes(self, required_modes: int, family_modes: int = 0) -> None:
        """Raise DriverError if a required mode is neither in object 6502h nor in ``family_modes``.

        A node without object 6502h is assumed to support all required modes.
        """
        offered = family_modes | (
            self.read(od.SUPPORTED) if self.has_object(od.SUPPORTED, 0) else required_modes
        )
        lacking = [
            _MODE_NAMES[mode] for mode, bit in MODE_BITS.items() if required_modes & bit and not offered & bit
        ]
        if lacking:
            raise self._setup_error(
                "{name}: the drive does not support mode {lacking}; check [canopen] mode",
                lacking=", ".join(lacking),
            )

    def require_objects(self, *entries: PdoEntry) -> None:
        """Raise DriverError with the names of all objects in ``entries`` that the node lacks."""
        missing = [
            f"{entry.object_index:04X}:{entry.object_subindex}"
            for entry in entries
            if not self.has_object(entry.object_index, entry.object_subindex)
        ]
        if missing:
            raise self._setup_error(
                "{name}: node {node} cannot be used in this mode because it lacks these objects: "
                "{missing}; check [canopen] mode and the node's EDS file",
                missing=", ".join(missing),
            )

    def require_homing_method(self, method: int) -> None:
        """Raise DriverError if the homing method is not in the drive's list of methods (object 60E3h).

        A drive without this list, or with an empty list, is assumed to support the method.
        """
        listed = [
            self.read(od.HOME_METHODS, sub + 1) for sub in range(self.count_array_entries(od.HOME_METHODS))
        ]
        offered = sorted({each for each in listed if each})
        if offered and method not in offered:
            known = ", ".join(map(str, offered))
            raise self._setup_error(
                "{name}: the drive does not support homing method {method} (60E3h: {known}); check "
                "axis.{name2}.home",
                method=method,
                known=known,
                name2=self._name,
            )

    def require_counts_per_rev(self, counts: int) -> None:
        """Check the counts per motor revolution that result from the drive's objects.

        Raises DriverError if the drive's gear and feed objects do not result in ``counts`` per revolution.
        The check is skipped if the drive lacks one of these objects or one of their values is 0.
        """
        places = [(od.GEAR, 1), (od.GEAR, 2), (od.FEED, 1), (od.FEED, 2)]
        if not all(self.has_object(*place) for place in places):
            return
        motor, shaft, feed, turns = [self.read(*place) for place in places]
        if not (motor and shaft and feed and turns):
            return
        found = feed * shaft / (turns * motor)
        if abs(found - counts) > 0.5:
            raise self._setup_error(
                "{name}: the drive uses {value} counts per motor revolution (6091h, 6092h), but "
                "canopen.nodes.{name2}.counts_per_rev is {counts}",
                value=f"{found:g}",
                name2=self._name,
                counts=counts,
            )

    def count_array_entries(self, index: int) -> int:
        """Return the number of entries of an array, or 0 if the node does not have the object."""
        return self.read(index, 0) if self.has_object(index, 0) else 0

    def has_object(self, index: int, subindex: int) -> bool:
        """Return whether the node has an object, according to its dictionary and a test read.

        The test read is necessary because an EDS file may be newer than the device.
        """
        variable = self.node.object_dictionary.get_variable(index, subindex)
        if variable is None:
            return False
        return not variable.readable or not self._is_object_missing(index, subindex)

    def _read_bytes(self, index: int, sub: int) -> bytes | None:
        """Return the value of an object, or None if the object does not have a value yet."""
        variable = self.node.object_dictionary.get_variable(index, sub)
        try:
            return self._upload(index, sub)
        except DriverError as error:
            if variable is None or _abort_code(error) not in _NO_VALUE_CODES:
                raise
        return None

    def _write_if_changed(self, index: int, sub: int, data: bytes, present_data: bytes | None) -> bool:
        """Write ``data`` unless the object already has this value, and return whether it was written.

        Many drives have read-only or locked objects that already have the required value, so all
        configuration uses this method. Raises DriverError if the node rejects the value.
        """
        if present_data == data:
            return False
        try:
            self.write_object_bytes(index, sub, data)
        except DriverError as error:
            if present_data is None or _abort_code(error) not in _READ_ONLY_CODES:
                raise
            now, wanted = (self._number(index, sub, each) for each in (present_data, data))
            raise self._setup_error(
                "{name}: node {node}, object {index}:{sub} is read-only; its value is {now}, but "
                "{expected} is needed. Set it with the drive's own software, or correct [canopen.sdo]",
                reason="read-only",
                index=f"{index:04X}",
                sub=sub,
                now=now,
                expected=wanted,
            ) from error
        return True

    def _is_object_missing(self, index: int, sub: int) -> bool:
        """Return whether the node reports that it does not have the object."""
        try:
            self._upload(index, sub)
        except DriverError as error:
            if _abort_code(error) in _MISSING_OBJECT_CODES:
                return True
            if _abort_code(error) not in _NO_VALUE_CODES:
                raise
        return False

    def _upload(self, index: int, sub: int) -> bytes:
        data: bytes = self._run_sdo(index, sub, lambda: self.node.sdo.upload(index, sub))
        return data

    def map_received_objects(
        self, pdo_number: int, *entries: tuple[int, int], event_driven: bool = False
    ) -> None:
        """Map the objects that the node receives in the PDO ``pdo_number``.

        Each entry is a pair of (index + sub-index · 65536, bits).
        """
        self._configure_pdo(
            self._pdo(self.node.rpdo, pdo_number), entries, _EVENT_DRIVEN if event_driven else 1
        )

    def map_sent_objects(
        self, pdo_number: int, on_reply: Callable[[PdoMap], None], *entries: tuple[int, int], every: int = 1
    ) -> None:
        """Map the objects that the node sends in the PDO ``pdo_number`` once per ``every`` SYNCs.

        Each entry is a pair of (index + sub-index · 65536, bits). ``on_reply`` is called for each received
        PDO.
        """
        pdo = self._pdo(self.node.tpdo, pdo_number)
        self._configure_pdo(pdo, entries, every)
        pdo.callbacks[:] = [on_reply]

    def _setup_error(self, text: str, *, reason: str = "", **values: object) -> DriverError:
        """Return the error for a node that does not match the machine file.

        ``text`` may contain the fields {name} and {node}.
        """
        return DriverError(text, "drive-setup", reason=reason, name=self._name, node=self.node.id, **values)

    def _pdo(self, pdos: PdoBase, number: int) -> PdoMap:
        try:
            found: PdoMap = pdos[number]
        except KeyError as error:
            raise self._setup_error(
                "{name}: PDO {number} is not in the node's EDS file",
                number=number,
            ) from error
        return found

    def _configure_pdo(self, pdo: PdoMap, entries: tuple[tuple[int, int], ...], kind: int) -> None:
        """Map a PDO, unless it already has the required mapping.

        The check is necessary because many modules have a fixed mapping. The library's ``PdoMap.save`` is
        not used, because it writes no entries if the dictionary defines the entries as an array.
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
        mapped = self._read_mapping(base + _MAPPING_OFFSET) == wanted
        if not mapped or self.read(base, 1) != cob or self.read(base, 2) != kind:
            self._put_number(base, 1, cob | _INVALID, 4)
            self._put_number(base, 2, kind, 1)
            if not mapped:
                self._map_entries(base + _MAPPING_OFFSET, wanted)
            self._put_number(base, 1, cob, 4)
        pdo.subscribe()

    def _map_entries(self, index: int, wanted: list[int]) -> None:
        self._put_number(index, 0, 0, 1)
        for sub, entry in enumerate(wanted, 1):
            self._put_number(index, sub, entry, 4)
        self._put_number(index, 0, len(wanted), 1)

    def _read_mapping(self, index: int) -> list[int]:
        """Return the current mapping of a PDO."""
        return [self.read(index, sub) for sub in range(1, self.read(index, 0) + 1)]

    def _put_number(self, index: int, sub: int, value: int, size: int) -> None:
        self._write_if_changed(index, sub, value.to_bytes(size, "little"), self._read_bytes(index, sub))

    def _number(self, index: int, sub: int, data: bytes) -> int:
        variable = self.node.object_dictionary.get_variable(index, sub)
        signed = variable is not None and variable.data_type in canopen.objectdictionary.SIGNED_TYPES
        return int.from_bytes(data, "little", signed=signed)

    def _run_sdo(self, index: int, sub: int, transfer: Callable[[], _Result]) -> _Result:
        """Perform an SDO operation on one object and convert its errors into DriverError."""
        where = Message(
            "{name}: node {node}, object {index}:{sub}",
            name=self._name,
            node=self.node.id,
            index=f"{index:04X}",
            sub=sub,
        )
        try:
            return transfer()
        except SdoAbortedError as error:
            raise DriverError(
                "{place}: the node rejected the request: {error}", "drive-setup", place=where, error=error
            ) from error
        except SdoCommunicationError as error:
            why = self._bus.failure or Message("{error}; check cable, power and node number", error=error)
            raise DriverError("{place}: {why}", "drive-silent", place=where, why=why) from error
        except KeyError as error:
            raise DriverError(
                "{place} is not in the node's object dictionary; check its EDS file",
                "drive-setup",
                place=where,
            ) from error


def _abort_code(error: DriverError) -> int:
    """Return the SDO abort code that caused an error, or 0 if the node did not abort the request."""
    cause = error.__cause__
    return cause.code if isinstance(cause, SdoAbortedError) else 0


# --- Default objects written to every drive at each start: stops, limits and monitoring.


def build_axis_objects(config: AxisConfig, bus: CanopenTable) -> ObjectValues:
    """Return the objects to be written to an axis drive, in the units of the drive."""
    return (
        *config.profile.unit_objects,
        *build_stop_objects(bus),
        (od.WINDOW, 0, round(config.following_window / config.count)),
        (od.WINDOW_TIME, 0, round(1000 * config.following_time)),
        (od.QUICK_DECEL, 0, config.convert_to_drive_acceleration(config.amax)),
        *(build_travel_limit_objects(config) if config.absolute else ()),
    )


def build_stop_objects(bus: CanopenTable) -> ObjectValues:
    """Return the objects that make any drive stop when TurnDesk's heartbeat is missing.

    The drive makes a quick stop and then switches its power off.
    """
    return (
        (od.ABORT_OPTION, 0, 3),
        (od.QUICK_OPTION, 0, 2),
        (od.FAULT_OPTION, 0, 2),
        *build_monitoring_objects(bus),
    )


def build_monitoring_objects(bus: CanopenTable) -> ObjectValues:
    """Return the objects that make any node send its heartbeat and monitor the heartbeat of TurnDesk.

    The timeout for the heartbeat of TurnDesk is three heartbeat intervals.
    """
    return (
        (od.HEARTBEAT, 0, round(1000 * bus.heartbeat)),
        (od.WATCHED, 1, bus.host_id << 16 | round(3000 * bus.heartbeat)),
    )


def build_travel_limit_objects(config: AxisConfig) -> ObjectValues:
    """Return the objects with the drive's software limits, which are valid only after homing."""
    if config.travel is None:
        return ()
    low, high = config.travel
    return ((od.LIMITS, 1, round(low / config.count)), (od.LIMITS, 2, round(high / config.count)))
