"""LinuxCNC's stock components as far as our part of the HAL file uses them, on cells that stand for signals.

Written from their sources of 2026; ``limit3`` follows its limits in a simpler way.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable

Cells = dict[str, float]  # by signal, or by pin where it is on none
Pin = Callable[[str], str]  # a pin's name to its cell
Step = Callable[[float], None]  # one call of a function of the thread, with its period in s

_DEPTH = 8192  # of a stream whose depth nobody asks for
_HAIR = 1e-9


class Fifo:
    """``hal.stream``: rows between a process and the servo thread."""

    def __init__(self, depth: int = _DEPTH) -> None:
        self._rows: deque[tuple[float, ...]] = deque()
        self._most = depth

    @property
    def depth(self) -> int:
        """Rows that wait."""
        return len(self._rows)

    @property
    def writable(self) -> bool:
        """Whether there is room."""
        return len(self._rows) < self._most

    @property
    def readable(self) -> bool:
        """Whether a row waits."""
        return bool(self._rows)

    def write(self, row: tuple[float, ...]) -> None:
        """One row; the oldest is kept where there is no room."""
        if self.writable:
            self._rows.append(row)

    def read(self) -> tuple[float, ...]:
        """The oldest row."""
        return self._rows.popleft()


def step_of(component: str, name: str, cells: Cells, at: Pin, value: Callable[[str], float]) -> Step:
    """The function of one instance. ``value`` has what was set for a pin or parameter."""
    kinds: dict[str, Callable[[], Step]] = {
        "near": lambda: _near(cells, name, at, value),
        "not": lambda: _of_one(cells, name, at, lambda a: not a),
        "abs": lambda: _of_one(cells, name, at, abs),
        "and2": lambda: _of_two(cells, name, at, lambda a, b: bool(a and b)),
        "or2": lambda: _of_two(cells, name, at, lambda a, b: bool(a or b)),
        "mult2": lambda: _of_two(cells, name, at, lambda a, b: a * b),
        "sum2": lambda: _sum2(cells, name, at, value),
        "mux2": lambda: _mux2(cells, *(at(f"{name}.{pin}") for pin in ("sel", "in0", "in1", "out"))),
        "flipflop": lambda: _flipflop(cells, *(at(f"{name}.{pin}") for pin in ("set", "reset", "out"))),
        "estop_latch": lambda: _latch(cells, name, at),
        "timedelay": lambda: _timedelay(cells, name, at, value),
        "limit3": lambda: _limit3(cells, name, at, value),
    }
    return kinds[component]()


def _assign(cells: Cells, out: str, of: Callable[[], float]) -> Step:
    def step(_period: float) -> None:
        cells[out] = of()

    return step


def _of_one(cells: Cells, name: str, at: Pin, of: Callable[[float], float]) -> Step:
    one = at(f"{name}.in")
    return _assign(cells, at(f"{name}.out"), lambda: of(cells[one]))


def _of_two(cells: Cells, name: str, at: Pin, of: Callable[[float, float], float]) -> Step:
    one, other, out = (at(f"{name}.{pin}") for pin in ("in0", "in1", "out"))
    return _assign(cells, out, lambda: of(cells[one], cells[other]))


def _near(cells: Cells, name: str, at: Pin, value: Callable[[str], float]) -> Step:
    difference = value(f"{name}.difference")
    one, other = at(f"{name}.in1"), at(f"{name}.in2")
    return _assign(cells, at(f"{name}.out"), lambda: abs(cells[one] - cells[other]) <= difference)


def _sum2(cells: Cells, name: str, at: Pin, value: Callable[[str], float]) -> Step:
    one, other, out = (at(f"{name}.{pin}") for pin in ("in0", "in1", "out"))
    first, second = (value(f"{name}.gain{n}") or 1.0 for n in range(2))
    return _assign(cells, out, lambda: first * cells[one] + second * cells[other])


def _mux2(cells: Cells, sel: str, one: str, other: str, out: str) -> Step:
    return _assign(cells, out, lambda: cells[other] if cells[sel] else cells[one])


def _flipflop(cells: Cells, set_: str, reset: str, out: str) -> Step:
    def step(_period: float) -> None:
        if cells[reset]:
            cells[out] = False
        elif cells[set_]:
            cells[out] = True

    return step


def _latch(cells: Cells, name: str, at: Pin) -> Step:
    ok_in, fault_in, reset, ok_out, watchdog = (
        at(f"{name}.{pin}") for pin in ("ok-in", "fault-in", "reset", "ok-out", "watchdog")
    )
    before = [False]

    def step(_period: float) -> None:
        rising, before[0] = cells[reset] and not before[0], bool(cells[reset])
        if not cells[ok_in] or cells[fault_in]:
            cells[ok_out] = False
        elif rising:
            cells[ok_out] = True
        if cells[ok_out]:
            cells[watchdog] = not cells[watchdog]

    return step


def _timedelay(cells: Cells, name: str, at: Pin, value: Callable[[str], float]) -> Step:
    in_, out, longest = at(f"{name}.in"), at(f"{name}.out"), value(f"{name}.on-delay")
    on = [0.0]

    def step(period: float) -> None:
        on[0] = on[0] + period if cells[in_] else 0.0
        cells[out] = on[0] > longest

    return step


def _limit3(cells: Cells, name: str, at: Pin, value: Callable[[str], float]) -> Step:
    """What its speed and acceleration let through passes as it is; else it brakes and catches up."""
    in_, load, out = (at(f"{name}.{pin}") for pin in ("in", "load", "out"))
    maxv, maxa = value(f"{name}.maxv"), value(f"{name}.maxa")
    was = [0.0, 0.0]  # the input, and the speed of the output

    def step(period: float) -> None:
        wanted, place, speed = cells[in_], cells[out], was[1]
        goal_speed, was[0] = (wanted - was[0]) / period, wanted
        need = (wanted - place) / period
        if cells[load]:
            cells[out], was[1] = wanted, 0.0
            return
        room = maxa * period
        if abs(need) <= maxv * (1 + _HAIR) and abs(need - speed) <= room * (1 + _HAIR):
            cells[out], was[1] = wanted, need
            return
        off = wanted - place
        chase = goal_speed + math.copysign(math.sqrt(2.0 * maxa * abs(off)), off)
        chase = min(max(chase, -maxv), maxv)
        was[1] = min(max(chase, speed - room), speed + room)
        cells[out] = place + was[1] * period

    return step


def streamer(cells: Cells, fifo: Fifo, enable: str, pins: list[str]) -> Step:
    """One row a period while it is enabled; the last row stays."""

    def step(_period: float) -> None:
        if cells[enable] and fifo.readable:
            for pin, figure in zip(pins, fifo.read(), strict=True):
                cells[pin] = figure

    return step


def sampler(cells: Cells, fifo: Fifo, pins: list[str]) -> Step:
    """One row a period."""

    def step(_period: float) -> None:
        fifo.write(tuple([cells[pin] for pin in pins]))

    return step


def watchdog(cells: Cells, input_: str, enable: str, out: str, timeout: float) -> Step:
    """Without a change of the input for so long it bites, until ``enable`` has been off and on again."""
    was = [0.0, False, False]  # s since the last change, the input, enable

    def step(period: float) -> None:
        since, last, enabled = was
        now, on = cells[input_], bool(cells[enable])
        since = 0.0 if bool(now) is not last else since + period
        if on and not enabled:
            cells[out], since = True, 0.0
        elif not on or since > timeout:
            cells[out] = False
        was[:] = [since, bool(now), on]

    return step
