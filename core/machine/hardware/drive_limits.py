"""Whether an axis stays inside what the file tells its drive or controller to allow."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.machine.errors import Finding
from core.machine.hardware.reading import HardwareReading

_LIMITS = 0x607D  # CiA 402: software position limits, sub-index 1 lowest, 2 highest, in counts
_MOST = 2**31 - 1  # counts that an object of 32 bits with a sign can tell
_GRBL_AXES = {"X": 0, "Y": 1, "Z": 2}
# Settings by their first number: what is compared, the factor from the model's unit to the controller's.
_GRBL = ((110, "vmax", 60.0, "mm/min"), (120, "amax", 1.0, "mm/s²"))
_GRBL_TRAVEL = 130


def outside(reading: HardwareReading, axes: tuple[str, ...]) -> Iterator[Finding]:
    """A finding for every axis that could be sent where its drive does not go."""
    for axis in axes:
        if axis in reading.nodes:
            yield from _of_a_drive(reading, axis)
        if axis in _GRBL_AXES:
            yield from _of_the_controller(reading, axis)


def _of_a_drive(reading: HardwareReading, axis: str) -> Iterator[Finding]:
    values, path = reading.values, f"axis.{axis}.travel"
    if not values.has(path, f"axis.{axis}.count"):
        return
    count, ends = values.number(f"axis.{axis}.count"), values.pair(path)
    if math.inf in map(abs, ends):
        return  # a rotary axis without an end
    if max(map(abs, ends)) / count > _MOST:
        expected = f"is more than a drive can count: {_MOST} counts of {count:g}"
        yield Finding(path, "", expected)
    for node in ("all", axis):
        for entry in reading.sdo.get(node, []):
            if entry.index != _LIMITS or entry.sub not in {1, 2}:
                continue
            value = entry.value - 2**32 if entry.value > _MOST else entry.value
            needed = round(ends[entry.sub - 1] / count)
            if value > needed if entry.sub == 1 else value < needed:
                place = f'canopen.sdo.{node}."{entry.address}"'
                yield Finding(place, str(entry.value), f"cuts {path}, which needs {needed} counts")


def _of_the_controller(reading: HardwareReading, axis: str) -> Iterator[Finding]:
    values, offset = reading.values, _GRBL_AXES[axis]
    for first, key, factor, unit in _GRBL:
        path = f"axis.{axis}.{key}"
        if values.has(path):
            yield from _too_small(reading, first + offset, values.number(path) * factor, path, unit)
    path = f"axis.{axis}.travel"
    if values.has(path):
        low, high = values.pair(path)
        yield from _too_small(reading, _GRBL_TRAVEL + offset, high - low, path, "mm")


def _too_small(
    reading: HardwareReading, number: int, needed: float, path: str, unit: str
) -> Iterator[Finding]:
    setting = reading.settings.get(number)
    if isinstance(setting, str) or setting is None or setting >= needed * (1 - 1e-6):
        return
    expected = f"expected {needed:.6g} {unit} or more, for {path}"
    yield Finding(f"grblhal.settings.{number}", f"{setting:g}", expected)
