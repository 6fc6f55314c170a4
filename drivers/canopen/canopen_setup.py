"""What every node goes through before it may run: checked, written, read back, mapped."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import canopen
from canopen.pdo import PdoBase, PdoMap
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from core.ports import DriverError, Segments
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import Bus, Node
from drivers.canopen.canopen_config import AxisConfig
from drivers.canopen.canopen_objects import MODE_BITS
from drivers.canopen.canopen_table import BusConfig, Objects

_Answer = TypeVar("_Answer")

_PROFILE = 0xFFFF
_ON_SYNC, _AT_ONCE = 1, 255
_INVALID = 1 << 31  # a PDO that is being mapped
_NO_SUCH_OBJECT = 0x06020000  # abort code of SDO
_MAPS = 0x200  # from the communication record of a PDO to its mapping
_NAMES = {1: "profile position", 3: "profile velocity", 6: "homing", 7: "interpolated position", 8: "CSP"}


class Setup:
    """SDO work on one node; each failure names node, object and what was answered."""

    def __init__(self, bus: Bus, name: str, number: int, objects: canopen.ObjectDictionary) -> None:
        self._bus = bus
        self._name = name
        self.node = Node(number, objects)
        bus.add_node(self.node)
        self.warnings: tuple[str, ...] = ()

    def pre_operational(self) -> None:
        """PDO mapping may only change there."""
        self.node.nmt.state = "PRE-OPERATIONAL"

    def read(self, index: int, sub: int = 0) -> int:
        """One object as a number; signed where the dictionary says so."""
        data = self._sdo(index, sub, lambda: self.node.sdo.upload(index, sub))
        return self._number(index, sub, data)

    def write(self, index: int, sub: int, value: int) -> None:
        """Write one object and read it back. Raises DriverError when the node keeps something else."""
        size = len(self._sdo(index, sub, lambda: self.node.sdo.upload(index, sub)))
        data = (value % (1 << 8 * size)).to_bytes(size, "little")
        self._sdo(index, sub, lambda: self.node.sdo.download(index, sub, data))
        kept = self._sdo(index, sub, lambda: self.node.sdo.upload(index, sub))
        if kept != data:
            shown = int.from_bytes(kept, "little")
            raise DriverError(
                f"{self._name}: object {index:04X}:{sub} stays at {shown} instead of {value};"
                f" check what the drive allows and [canopen.sdo]",
                "drive-setup",
            )

    def write_all(self, values: tuple[tuple[int, int, int], ...]) -> None:
        """One after the other; a later value of the same object wins. ``warnings``: what it did without."""
        for index, sub, value in values:
            if index in od.MAY_LACK and self._lacks(index, sub):
                self.warnings = (f"{self._name}: {od.MAY_LACK[index]}",)
            else:
                self.write(index, sub, value)

    def demand_profile(self, profile: int) -> None:
        """Is it the kind of device that the machine file says? Raises DriverError."""
        found = self.read(od.DEVICE_TYPE) & _PROFILE
        if found != profile:
            raise DriverError(
                f"{self._name}: node {self.node.id} is a device of profile {found}, expected {profile};"
                " check the node numbers in [canopen.nodes]",
                "drive-setup",
            )

    def demand_modes(self, modes: int) -> None:
        """Does it offer what is needed? Raises DriverError naming what is not."""
        offered = self.read(od.SUPPORTED)
        lacking = [_NAMES[mode] for mode, bit in MODE_BITS.items() if modes & bit and not offered & bit]
        if lacking:
            raise DriverError(
                f"{self._name}: the drive has no mode {', '.join(lacking)}; see [canopen] mode", "drive-setup"
            )

    def entries(self, index: int) -> int:
        """How many entries an array of the node has; 0 where the node has no such object."""
        return 0 if self._lacks(index, 0) else self.read(index, 0)

    def _lacks(self, index: int, sub: int) -> bool:
        """Whether the node says that it has no such object."""
        try:
            self.read(index, sub)
        except DriverError as error:
            refusal = error.__cause__
            if isinstance(refusal, SdoAbortedError) and refusal.code == _NO_SUCH_OBJECT:
                return True
            raise
        return False

    def receive(self, number: int, *entries: tuple[int, int], at_once: bool = False) -> None:
        """Map what the node receives in PDO ``number``: (object, bits)."""
        self._map(self._pdo(self.node.rpdo, number), entries, _AT_ONCE if at_once else _ON_SYNC)

    def transmit(self, number: int, heard: Callable[[PdoMap], None], *entries: tuple[int, int]) -> None:
        """Map what the node sends in PDO ``number`` at each SYNC: (object + sub · 65536, bits)."""
        pdo = self._pdo(self.node.tpdo, number)
        self._map(pdo, entries, _ON_SYNC)
        pdo.callbacks[:] = [heard]

    def _pdo(self, pdos: PdoBase, number: int) -> PdoMap:
        try:
            found: PdoMap = pdos[number]
        except KeyError as error:
            raise DriverError(
                f"{self._name}: PDO {number} is not in the node's EDS file", "drive-setup"
            ) from error
        return found

    def _map(self, pdo: PdoMap, entries: tuple[tuple[int, int], ...], kind: int) -> None:
        """The library's own ``save`` writes no entries where the dictionary has them as an array.

        A mapping that is already there is left alone: many modules have none that can be changed.
        """
        base = pdo.com_record.od.index
        pdo.clear()
        for index, bits in entries:
            pdo.add_variable(index & 0xFFFF, index >> 16, bits)
        cob = pdo.predefined_cob_id
        pdo.cob_id, pdo.trans_type, pdo.enabled = cob, kind, True
        assert cob is not None
        self._put(base, 1, cob | _INVALID, 4)
        self._put(base, 2, kind, 1)
        wanted = [(index & 0xFFFF) << 16 | (index >> 16) << 8 | bits for index, bits in entries]
        if self._mapped(base + _MAPS) != wanted:
            self._put(base + _MAPS, 0, 0, 1)
            for sub, entry in enumerate(wanted, 1):
                self._put(base + _MAPS, sub, entry, 4)
            self._put(base + _MAPS, 0, len(wanted), 1)
        self._put(base, 1, cob, 4)
        pdo.subscribe()

    def _mapped(self, index: int) -> list[int]:
        """What a PDO carries so far."""
        return [self.read(index, sub) for sub in range(1, self.read(index, 0) + 1)]

    def _put(self, index: int, sub: int, value: int, size: int) -> None:
        data = value.to_bytes(size, "little")
        self._sdo(index, sub, lambda: self.node.sdo.download(index, sub, data))

    def _number(self, index: int, sub: int, data: bytes) -> int:
        variable = self.node.object_dictionary.get_variable(index, sub)
        signed = variable is not None and variable.data_type in canopen.objectdictionary.SIGNED_TYPES
        return int.from_bytes(data, "little", signed=signed)

    def _sdo(self, index: int, sub: int, do: Callable[[], _Answer]) -> _Answer:
        """Do something with one object; what can go wrong becomes one sentence."""
        where = f"{self._name}: node {self.node.id}, object {index:04X}:{sub}"
        try:
            return do()
        except SdoAbortedError as error:
            raise DriverError(f"{where}: refused by the node: {error}", "drive-setup") from error
        except SdoCommunicationError as error:
            why = self._bus.trouble or f"{error}; check cable, power and node number"
            raise DriverError(f"{where}: {why}", "drive-silent") from error
        except KeyError as error:
            raise DriverError(
                f"{where}: not in the node's object dictionary; check its EDS file", "drive-setup"
            ) from error


# --- What every drive is told at each start unless the machine file says otherwise: stops, limits, watching.


def axis_objects(config: AxisConfig, bus: BusConfig) -> Objects:
    """For one axis drive."""
    return (
        *stopping(bus),
        (od.WINDOW, 0, round(config.following_window / config.count)),
        (od.WINDOW_TIME, 0, round(1000 * config.following_time)),
        (od.QUICK_DECEL, 0, round(config.amax / config.count)),
        *(limits(config) if config.absolute else ()),
    )


def stopping(bus: BusConfig) -> Objects:
    """For any drive: quick stop when our heartbeat is missing, then no power."""
    return (
        (od.ABORT_OPTION, 0, 3),
        (od.QUICK_OPTION, 0, 2),
        (od.FAULT_OPTION, 0, 2),
        *watching(bus),
    )


def watching(bus: BusConfig) -> Objects:
    """For any node: its heartbeat, and ours, which it misses after three."""
    return (
        (od.HEARTBEAT, 0, round(1000 * bus.heartbeat)),
        (od.WATCHED, 1, bus.host_id << 16 | round(3000 * bus.heartbeat)),
    )


def limits(config: AxisConfig) -> Objects:
    """The drive's own software limits; they mean something once it knows where home is."""
    if config.travel is None:
        return ()
    low, high = config.travel
    return ((od.LIMITS, 1, round(low / config.count)), (od.LIMITS, 2, round(high / config.count)))


def check_limits(segments: Segments, axes: Sequence[AxisConfig], homed: Sequence[bool]) -> None:
    """The last line before the wire, behind the control's own. Raises DriverError."""
    for i, axis in enumerate(axes):
        if abs(segments.v[:, i]).max() > axis.vmax * 1.001 + 0.01:
            raise DriverError(
                f"{axis.name}: setpoints faster than {axis.vmax:.1f}/s; nothing was queued", "drive-limits"
            )
        if axis.travel is None or not homed[i]:
            continue
        low, high = axis.travel
        if segments.p[:, i].min() < low - 0.01 or segments.p[:, i].max() > high + 0.01:
            raise DriverError(
                f"{axis.name}: setpoints leave {low:.2f}…{high:.2f}; nothing was queued", "drive-limits"
            )
