"""The lit words: the switches of a run, and what is on at the machine."""

from __future__ import annotations

import math
from dataclasses import dataclass

from core.executor.snapshot import Snapshot

TURNING = 1.0  # rpm above which a spindle is said to turn
AT_ZERO = 0.01  # degrees from 0 at which a table still stands there
LATHE = ("X", "Z", "C")


@dataclass(frozen=True, slots=True)
class Lamp:
    """A lit word, and the key that switches it, if one does."""

    word: str
    lit: bool
    key: str = ""
    warn: bool = False


def modes_of(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """The four switches of a run, with their keys; NO COUNT only while it is on, because few runs are dry."""
    return (
        Lamp("SINGLE BLOCK", snapshot.single_block, "S"),
        Lamp("OPTIONAL STOP", snapshot.optional_stop, "O"),
        Lamp("BLOCK DELETE", snapshot.block_delete, "/"),
        Lamp("CYCLE REPEAT", snapshot.cycle_repeat, "C"),
        *((Lamp("NO COUNT", lit=True, key="P", warn=True),) if snapshot.no_count else ()),
    )


def lamps_of(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """From the outputs that are on; their names are those of the machine files (coolant, collet, live1 …)."""
    if snapshot.axes != LATHE:
        return (
            _spindle_lamp(snapshot),
            Lamp("COOLANT", "coolant" in snapshot.outputs),
            *_table_lamps(snapshot),
        )
    return (
        _spindle_lamp(snapshot),
        Lamp("COOLANT", "coolant" in snapshot.outputs),
        _collet_lamp(snapshot),
        Lamp("LIVE TOOL", any(name.startswith("live") for name in snapshot.outputs)),
    )


def _table_lamps(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """Of a mill: whether moves count in a tilted plane, and whether the table stands anywhere but at 0."""
    tilted = snapshot.swivel is not None and snapshot.swivel.system.tilted
    rotary = zip(snapshot.axes, snapshot.actual, strict=True)
    turned = any(abs(math.remainder(at, 360.0)) > AT_ZERO for name, at in rotary if name in "ABC")
    return Lamp("TILTED PLANE", lit=tilted), Lamp("TABLE TURNED", lit=turned)


def _spindle_lamp(snapshot: Snapshot) -> Lamp:
    """Turning is told from the measured speed: one that coasts is as dangerous as one that is driven."""
    turning = abs(snapshot.rpm_actual) > TURNING
    if turning and snapshot.rpm_command == 0:
        return Lamp("SPINDLE COASTS", lit=True, warn=True)
    if turning:
        return Lamp("SPINDLE REV" if snapshot.rpm_actual < 0 else "SPINDLE FWD", lit=True)
    return Lamp("SPINDLE", lit=False)


def _collet_lamp(snapshot: Snapshot) -> Lamp:
    """The output decides, not the program's word: it is what holds the bar."""
    if "collet" in snapshot.outputs:
        return Lamp("COLLET CLOSED", lit=True)
    return Lamp("COLLET OPEN", lit=True, warn=True)
