"""Parts of ports that drivers share: orders that they refuse, touches of a probe, samples of the scope."""

from __future__ import annotations

import struct
from collections.abc import Container, Mapping
from typing import TypeVar

import numpy as np

from core.faults import code_of
from core.ports import DriverError, FloatArray, Latch

T = TypeVar("T")

# --- Refusals. Each function raises DriverError unless the order may be carried out.


def demand_no_fault(fault: str) -> None:
    """Refuse to switch the drives on while there is a fault."""
    if fault:
        raise DriverError(
            "the drives stay off because of a fault ({fault}); clear the fault first", "no-power", fault=fault
        )


def demand_power(fault: str, on: bool) -> None:
    """Refuse a motion with a fault, or while the drives are not ``on``."""
    if fault:
        raise DriverError("{fault}; clear the fault first", code_of(fault, "axis"), fault=fault)
    if not on:
        raise DriverError("the drives are off; switch them on first", "power-lost")


def demand_no_homing(axis: str) -> None:
    """Refuse setpoints while ``axis`` is homing; it is empty when no axis is."""
    if axis:
        raise DriverError("{name} is homing; wait until homing is complete", reason="homing", name=axis)


def demand_axis(axis: str, axes: Container[str]) -> None:
    """Refuse to home an axis that is not among ``axes``."""
    if axis not in axes:
        raise DriverError("axis {axis} does not exist", reason="no-axis", axis=f"{axis!r}")


def demand_standstill(axis: str, moving: bool) -> None:
    """Refuse to home ``axis`` while an axis is moving."""
    if moving:
        raise DriverError(
            "{axis} cannot home while an axis is moving; wait until all axes are at rest",
            "homing",
            reason="axis-moves",
            axis=axis,
        )


def demand_spindle(problem: str) -> None:
    """Refuse to turn the spindle while there is a ``problem``."""
    if problem:
        raise DriverError("the spindle stays off: {problem}", "spindle-off", problem=problem)


def demand_estop_released(pressed: bool) -> None:
    """Refuse to turn the spindle while the E-stop is ``pressed``."""
    if pressed:
        raise DriverError(
            "the spindle stays off while the E-stop is pressed; release the E-stop first", "spindle-off"
        )


def demand_free_drive(enabled: bool, turning: bool) -> None:
    """Refuse to hold the spindle's drive as C while the drives are not ``enabled``, or while it turns."""
    if not enabled:
        raise DriverError(
            "C uses the spindle drive, and the drives are off; switch them on first",
            "c-coupling",
            reason="drives-off",
        )
    if turning:
        raise DriverError(
            "C uses the spindle drive, and the spindle is turning; stop the spindle first",
            "c-coupling",
            reason="spindle-turns",
        )


def output_of(name: str, outputs: Mapping[str, T]) -> T:
    """Return the output of this name; refuse one that the machine does not have."""
    if name not in outputs:
        raise DriverError(
            "output {name} is not in the machine file; add it under [io.out]", "output", name=f"{name!r}"
        )
    return outputs[name]


def demand_output(name: str, on: bool, problem: str) -> None:
    """Refuse to switch an output on while there is a ``problem``."""
    if on and problem:
        raise DriverError("output {name} stays off: {problem}", "output", name=name, problem=problem)


# --- The touch of a probe.


class FirstTouch:
    """``core.ports.TouchInput``: axis positions when the input of a probe first came on after ``arm``."""

    def __init__(self) -> None:
        self._on = False
        self._kept: Latch | None = None

    def arm(self) -> None:
        """Forget what was kept."""
        self._kept = None

    def latched(self) -> Latch | None:
        """The first touch since."""
        return self._kept

    def _touches(self, on: bool) -> bool:
        """Return whether the input, which is ``on`` now, has made the first touch."""
        before, self._on = self._on, on
        return on and not before and self._kept is None


# --- Samples of the scope between two looks of the control, in memory that was set aside beforehand.


KEPT = 8192  # rows: eight seconds at 1 ms for a control that is late


class SampleLog:
    """Rows as ``core.ports.SampleSource`` has them, added by a driver and taken by its control."""

    def __init__(self, axes: int, kept: int = KEPT) -> None:
        self.width = 5 + 3 * axes
        self._row = struct.Struct(f"={self.width}d")
        self._kept = kept
        self._bytes = bytearray(kept * self._row.size)
        self._added = self._taken = 0
        self._rows = np.frombuffer(self._bytes, dtype=np.float64).reshape(kept, self.width)
        self._none = np.empty((0, self.width))
        self.last = -np.inf  # time of the newest row

    def add(self, t: float, *figures: float) -> None:
        """One more row; the oldest goes when there is no room."""
        self._row.pack_into(self._bytes, self._added % self._kept * self._row.size, t, *figures)
        self._added += 1
        self.last = t

    def extend(self, rows: FloatArray) -> None:
        """Add the newest of these rows, as many as the log has room for."""
        rows = rows[-self._kept :]
        at = self._added % self._kept
        head = rows[: self._kept - at]
        self._rows[at : at + len(head)] = head
        self._rows[: len(rows) - len(head)] = rows[len(head) :]
        self._added += len(rows)
        self.last = rows[-1, 0]

    def take(self, most: int = KEPT) -> FloatArray:
        """The oldest rows that have not been taken, ``most`` at a time."""
        first = max(self._taken, self._added - self._kept)
        count = min(self._added - first, most)
        if not count:
            return self._none
        self._taken = first + count
        at = first % self._kept
        if at + count <= self._kept:
            return self._rows[at : at + count].copy()
        return np.concatenate((self._rows[at:], self._rows[: at + count - self._kept]))
