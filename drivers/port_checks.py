"""Helpers that several drivers use to implement ports: command checks, probe latches and scope samples."""

from __future__ import annotations

import struct
from collections.abc import Container, Mapping
from typing import TypeVar

import numpy as np

from core.faults import SPINDLE_TURNS, get_fault_code
from core.ports import DriverError, FloatArray, TouchLatch

T = TypeVar("T")

# --- Checks: each function raises DriverError unless the command is permitted.


def require_no_fault(fault: str) -> None:
    """Raise DriverError if a fault prevents the drives from switching on.

    If ``fault`` is an empty string, there is no fault.
    """
    if fault:
        raise DriverError(
            "the drives stay off because of a fault ({fault}); clear the fault first", "no-power", fault=fault
        )


def require_drive_power(fault: str, is_powered: bool) -> None:
    """Raise DriverError if a fault is active or the drives are off, because no axis may then move."""
    if fault:
        raise DriverError("{fault}; clear the fault first", get_fault_code(fault, "axis"), fault=fault)
    if not is_powered:
        raise DriverError("the drives are off; switch them on first", "power-lost")


def require_no_homing(axis: str) -> None:
    """Raise DriverError if an axis is homing.

    ``axis`` is the name of the homing axis, or an empty string if no axis is homing.
    """
    if axis:
        raise DriverError("{name} is homing; wait until homing is complete", reason="homing", name=axis)


def require_existing_axis(axis: str, axes: Container[str]) -> None:
    """Raise DriverError if ``axis`` is not one of ``axes``."""
    if axis not in axes:
        raise DriverError("axis {axis} does not exist", reason="no-axis", axis=f"{axis!r}")


def require_standstill(axis: str, is_moving: bool) -> None:
    """Raise DriverError if any axis is moving, because homing ``axis`` requires all axes at rest."""
    if is_moving:
        raise DriverError(
            "{axis} cannot home while an axis is moving; wait until all axes are at rest",
            "homing",
            reason="axis-moves",
            axis=axis,
        )


def require_spindle_ready(problem: str) -> None:
    """Raise DriverError if ``problem`` describes a reason why the spindle cannot turn."""
    if problem:
        raise DriverError("the spindle stays off: {problem}", "spindle-off", problem=problem)


def require_estop_released(is_pressed: bool) -> None:
    """Raise DriverError if the E-stop is pressed, because the spindle cannot turn then."""
    if is_pressed:
        raise DriverError(
            "the spindle stays off while the E-stop is pressed; release the E-stop first", "spindle-off"
        )


def require_stopped_spindle(is_turning: bool) -> None:
    """Raise DriverError if the spindle is turning, because its drive orients it only from standstill."""
    if is_turning:
        raise DriverError(
            "the spindle cannot be oriented while it is turning; stop it first",
            "spindle-off",
            reason=SPINDLE_TURNS,
        )


def require_free_spindle_drive(is_enabled: bool, is_turning: bool) -> None:
    """Raise DriverError if the spindle drive cannot become the C axis.

    This is the case if the drives of the axes are off (``is_enabled`` is False) or the spindle is turning.
    """
    if not is_enabled:
        raise DriverError(
            "C uses the spindle drive, and the drives are off; switch them on first",
            "c-coupling",
            reason="drives-off",
        )
    if is_turning:
        raise DriverError(
            "C uses the spindle drive, and the spindle is turning; stop the spindle first",
            "c-coupling",
            reason=SPINDLE_TURNS,
        )


def find_output(name: str, outputs: Mapping[str, T]) -> T:
    """Return the output with this name.

    Raises DriverError if the machine file does not define the output.
    """
    if name not in outputs:
        raise DriverError(
            "output {name} is not in the machine file; add it under [io.out]", "output", name=f"{name!r}"
        )
    return outputs[name]


def require_output_allowed(name: str, is_on: bool, problem: str) -> None:
    """Raise DriverError if the output is to be switched on although ``problem`` prevents this."""
    if is_on and problem:
        raise DriverError("output {name} stays off: {problem}", "output", name=name, problem=problem)


# --- Touch of a probe.


class FirstTouchLatch:
    """Probe input (``core.ports.TouchInput``) that latches the axis positions at the first touch.

    Calling ``arm_latch`` permits the next latching.
    """

    def __init__(self) -> None:
        self._on = False
        self._kept: TouchLatch | None = None

    def arm_latch(self) -> None:
        """Clear the latched touch, so that the next touch is latched."""
        self._kept = None

    def read_latch(self) -> TouchLatch | None:
        """Return the first touch since the last call of ``arm_latch``, or None if there was no touch."""
        return self._kept

    def _is_first_touch(self, is_on: bool) -> bool:
        """Return whether the input has just turned on and no touch is latched yet."""
        before, self._on = self._on, is_on
        return is_on and not before and self._kept is None


# --- Samples for the scope in preallocated memory.


LOG_ROWS = 8192  # Rows, which cover eight seconds at 1 ms for a delayed control.


class SampleRingBuffer:
    """Ring buffer of sample rows in the format of ``core.ports.SampleSource``."""

    def __init__(self, axis_count: int, capacity: int = LOG_ROWS) -> None:
        self.row_width = 5 + 3 * axis_count
        self._row = struct.Struct(f"={self.row_width}d")
        self._kept = capacity
        self._bytes = bytearray(capacity * self._row.size)
        self._added = self._taken = 0
        self._rows = np.frombuffer(self._bytes, dtype=np.float64).reshape(capacity, self.row_width)
        self._none = np.empty((0, self.row_width))
        self.newest_time_s = -np.inf  # Time of the newest row.

    def append_row(self, time_s: float, *values: float) -> None:
        """Append one row at time ``time_s``.

        If the buffer is full, the oldest row is discarded.
        """
        self._row.pack_into(self._bytes, self._added % self._kept * self._row.size, time_s, *values)
        self._added += 1
        self.newest_time_s = time_s

    def append_rows(self, rows: FloatArray) -> None:
        """Append rows.

        If there are more rows than the buffer can store, only the newest of them are stored.
        """
        rows = rows[-self._kept :]
        at = self._added % self._kept
        head = rows[: self._kept - at]
        self._rows[at : at + len(head)] = head
        self._rows[: len(rows) - len(head)] = rows[len(head) :]
        self._added += len(rows)
        self.newest_time_s = rows[-1, 0]

    def pop_rows(self, max_rows: int = LOG_ROWS) -> FloatArray:
        """Remove and return at most ``max_rows`` of the oldest rows."""
        first = max(self._taken, self._added - self._kept)
        count = min(self._added - first, max_rows)
        if not count:
            return self._none
        self._taken = first + count
        at = first % self._kept
        if at + count <= self._kept:
            return self._rows[at : at + count].copy()
        return np.concatenate((self._rows[at:], self._rows[: at + count - self._kept]))
