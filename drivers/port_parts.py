"""What drivers do alike at their ports: refuse orders in the same words, keep the first touch of a probe."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import TypeVar

from core.ports import DriverError, Latch, code_of

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
