"""The lit words: the switches of a run, and what is on at the machine."""

from __future__ import annotations

from dataclasses import dataclass

from core.executor.snapshot import Snapshot

TURNING = 1.0  # rpm above which a spindle is said to turn


@dataclass(frozen=True, slots=True)
class Lamp:
    """A lit word, and the key that switches it, if one does."""

    word: str
    lit: bool
    key: str = ""
    warn: bool = False


def modes_of(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """The four switches of a run, with their keys."""
    return (
        Lamp("SINGLE BLOCK", snapshot.single_block, "S"),
        Lamp("OPTIONAL STOP", snapshot.optional_stop, "O"),
        Lamp("BLOCK DELETE", snapshot.block_delete, "/"),
        Lamp("CYCLE REPEAT", snapshot.cycle_repeat, "C"),
    )


def lamps_of(snapshot: Snapshot) -> tuple[Lamp, ...]:
    """From the outputs that are on; their names are those of the machine files (coolant, collet, live1 …)."""
    return (
        _spindle_lamp(snapshot),
        Lamp("COOLANT", "coolant" in snapshot.outputs),
        _collet_lamp(snapshot),
        Lamp("LIVE TOOL", any(name.startswith("live") for name in snapshot.outputs)),
    )


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
