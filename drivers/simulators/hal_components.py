"""Simulated versions of the LinuxCNC components in TurnDesk's section of the HAL file.

The components operate on cells, which replace the HAL signals. They follow the LinuxCNC sources of 2026,
except that ``limit3`` approaches its limits in a simpler manner.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from typing import Any

SignalCells = dict[str, float]  # By signal, or by pin if it is not connected to a signal.
FindCellName = Callable[[str], str]  # Maps the name of a pin to its cell.
PeriodFunction = Callable[[float], None]  # One call of a thread function, with the period in s.

_DEFAULT_DEPTH = 8192  # Default depth of a stream.
_COMPARE_TOLERANCE = 1e-9


class RowFifo:
    """Replacement for ``hal.stream``, which is a FIFO of rows between a process and the servo thread."""

    def __init__(self, depth: int = _DEFAULT_DEPTH) -> None:
        self._rows: deque[tuple[float, ...]] = deque()
        self._most = depth

    @property
    def row_count(self) -> int:
        """Return the number of rows in the FIFO."""
        return len(self._rows)

    @property
    def writable(self) -> bool:
        """Return whether the FIFO has space for another row."""
        return len(self._rows) < self._most

    @property
    def readable(self) -> bool:
        """Return whether the FIFO contains a row."""
        return bool(self._rows)

    def write(self, row: tuple[float, ...]) -> None:
        """Append one row, or discard the row if the FIFO is full."""
        if self.writable:
            self._rows.append(row)

    def read(self) -> tuple[float, ...]:
        """Remove and return the oldest row."""
        return self._rows.popleft()


# Formulas of the components without memory, with their pins and parameters.
_FORMULAS = {
    "near": "abs({in1} - {in2}) <= {difference}",
    "not": "not {in}",
    "abs": "abs({in})",
    "and2": "bool({in0} and {in1})",
    "or2": "bool({in0} or {in1})",
    "mult2": "{in0} * {in1}",
    "sum2": "{gain0} * {in0} + {gain1} * {in1}",
    "mux2": "{in1} if {sel} else {in0}",
}


class ThreadProgram:
    """Functions of a HAL thread, compiled in order into one function that operates on ``cells``."""

    def __init__(self, cells: SignalCells) -> None:
        self._cells = cells
        self._steps: list[PeriodFunction] = []
        self._lines: list[str] = []

    def add_call(self, step: PeriodFunction) -> None:
        """Append a function that is called once per period."""
        self._lines.append(f"steps[{len(self._steps)}](period)")
        self._steps.append(step)

    def add_component(
        self, component_type: str, name: str, pin_lookup: FindCellName, get_pin_value: Callable[[str], float]
    ) -> None:
        """Append the function of one component to the thread.

        ``get_pin_value`` returns the configured value of a pin or parameter.
        """
        if component_type in _FORMULAS:
            self._lines.append(
                f"cells[{pin_lookup(f'{name}.out')!r}] = "
                f"{_formula(component_type, name, pin_lookup, get_pin_value)}"
            )
        else:
            self.add_call(_COMPONENT_STEPS[component_type](self._cells, name, pin_lookup, get_pin_value))

    def compile_calls(self) -> PeriodFunction:
        """Compile all calls into one function, which is several times faster than separate calls."""
        names: dict[str, Any] = {"cells": self._cells, "steps": self._steps}
        exec("\n    ".join(["def run(period):", *self._lines, "return"]), names)
        run: PeriodFunction = names["run"]
        return run


def _formula(component: str, name: str, at: FindCellName, value: Callable[[str], float]) -> str:
    pins = {pin: f"cells[{at(f'{name}.{pin}')!r}]" for pin in ("in", "in0", "in1", "in2", "sel")}
    gains = {f"gain{n}": value(f"{name}.gain{n}") or 1.0 for n in range(2)}
    return _FORMULAS[component].format(**pins, **gains, difference=value(f"{name}.difference"))


def _flipflop(
    cells: SignalCells, name: str, at: FindCellName, _value: Callable[[str], float]
) -> PeriodFunction:
    set_, reset, out = (at(f"{name}.{pin}") for pin in ("set", "reset", "out"))

    def update_flipflop(_period: float) -> None:
        if cells[reset]:
            cells[out] = False
        elif cells[set_]:
            cells[out] = True

    return update_flipflop


def _latch(cells: SignalCells, name: str, at: FindCellName, _value: Callable[[str], float]) -> PeriodFunction:
    ok_in, fault_in, reset, ok_out, watchdog = (
        at(f"{name}.{pin}") for pin in ("ok-in", "fault-in", "reset", "ok-out", "watchdog")
    )
    before = [False]

    def update_latch(_period: float) -> None:
        rising, before[0] = cells[reset] and not before[0], bool(cells[reset])
        if not cells[ok_in] or cells[fault_in]:
            cells[ok_out] = False
        elif rising:
            cells[ok_out] = True
        if cells[ok_out]:
            cells[watchdog] = not cells[watchdog]

    return update_latch


def _timedelay(
    cells: SignalCells, name: str, at: FindCellName, value: Callable[[str], float]
) -> PeriodFunction:
    in_, out, longest = at(f"{name}.in"), at(f"{name}.out"), value(f"{name}.on-delay")
    on = [0.0]

    def update_time_delay(period: float) -> None:
        on[0] = on[0] + period if cells[in_] else 0.0
        cells[out] = on[0] > longest

    return update_time_delay


def _create_limit3(
    cells: SignalCells, name: str, at: FindCellName, value: Callable[[str], float]
) -> PeriodFunction:
    """Return the function of the component ``limit3``.

    Values within the limits pass unchanged. Otherwise the output brakes and then catches up with the input.
    """
    in_, load, out = (at(f"{name}.{pin}") for pin in ("in", "load", "out"))
    maxv, maxa = value(f"{name}.maxv"), value(f"{name}.maxa")
    was = [0.0, 0.0]  # The last input and the speed of the output.

    def update_limited_output(period: float) -> None:
        wanted, place, speed = cells[in_], cells[out], was[1]
        goal_speed, was[0] = (wanted - was[0]) / period, wanted
        need = (wanted - place) / period
        if cells[load]:
            cells[out], was[1] = wanted, 0.0
            return
        room = maxa * period
        if abs(need) <= maxv * (1 + _COMPARE_TOLERANCE) and abs(need - speed) <= room * (
            1 + _COMPARE_TOLERANCE
        ):
            cells[out], was[1] = wanted, need
            return
        off = wanted - place
        chase = goal_speed + math.copysign(math.sqrt(2.0 * maxa * abs(off)), off)
        chase = min(max(chase, -maxv), maxv)
        was[1] = min(max(chase, speed - room), speed + room)
        cells[out] = place + was[1] * period

    return update_limited_output


_COMPONENT_STEPS = {
    "flipflop": _flipflop,
    "estop_latch": _latch,
    "timedelay": _timedelay,
    "limit3": _create_limit3,
}


def create_streamer(cells: SignalCells, fifo: RowFifo, enable_pin: str, pins: list[str]) -> PeriodFunction:
    """Return a function that writes one row of ``fifo`` to the pins in each period.

    The function writes only while ``enable_pin`` is on. Without a new row, the pins retain their values.
    """

    def write_row_to_pins(_period: float) -> None:
        if cells[enable_pin] and fifo.readable:
            for pin, figure in zip(pins, fifo.read(), strict=True):
                cells[pin] = figure

    return write_row_to_pins


def create_sampler(cells: SignalCells, fifo: RowFifo, pins: list[str]) -> PeriodFunction:
    """Return a function that appends the values of the pins to ``fifo`` in each period."""

    def append_sample(_period: float) -> None:
        fifo.write(tuple([cells[pin] for pin in pins]))

    return append_sample


def watchdog(
    cells: SignalCells, input_pin: str, enable_pin: str, ok_pin: str, timeout_s: float
) -> PeriodFunction:
    """Return a function that turns ``ok_pin`` off if its input is unchanged for ``timeout_s`` s.

    ``ok_pin`` remains off until ``enable_pin`` is switched off and on again.
    """
    was = [0.0, False, False]  # Seconds since the last change, the input, and enable.

    def update_watchdog(period: float) -> None:
        since, last, enabled = was
        now, on = cells[input_pin], bool(cells[enable_pin])
        since = 0.0 if bool(now) is not last else since + period
        if on and not enabled:
            cells[ok_pin], since = True, 0.0
        elif not on or since > timeout_s:
            cells[ok_pin] = False
        was[:] = [since, bool(now), on]

    return update_watchdog
