"""What breaks by itself, and when: the faults of a machine file."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from core.ports import DriverError
from drivers.simulated.config import PlannedFault
from drivers.simulated.machine import SimMachine


class Schedule:
    """Breaks and mends as time passes; the plant calls it with the clock's time."""

    def __init__(self, machine: SimMachine, faults: Sequence[PlannedFault]) -> None:
        self._acts: list[tuple[float, Callable[[], None]]] = []
        for fault in faults:
            breaks, mends = _acts(machine, fault)
            self._acts.append((fault.at, breaks))
            if fault.seconds > 0.0 and mends is not None:
                self._acts.append((fault.at + fault.seconds, mends))
        self._acts.sort(key=lambda act: act[0])

    def due(self, now: float) -> None:
        """Everything up to ``now``, in order."""
        while self._acts and self._acts[0][0] <= now:
            self._acts.pop(0)[1]()


def _acts(machine: SimMachine, fault: PlannedFault) -> tuple[Callable[[], None], Callable[[], None] | None]:
    """How it breaks, and how it is mended; a drive's fault stays until somebody clears it."""
    axis, value, text = fault.axis, fault.value, fault.text
    known: dict[str, tuple[Callable[[], None], Callable[[], None] | None]] = {
        "jam": (lambda: machine.jam(axis), lambda: machine.jam(axis, on=False)),
        "encoder_stuck": (
            lambda: machine.encoder_stuck(axis),
            lambda: machine.encoder_stuck(axis, on=False),
        ),
        "runaway": (lambda: machine.runaway(axis, value), lambda: machine.runaway(axis, 0.0)),
        "drive_fault": (lambda: machine.drive_fault(axis, text or "drive fault"), None),
        "spindle_bog": (lambda: machine.spindle_bog(value), lambda: machine.spindle_bog(1.0)),
        "spindle_wander": (lambda: machine.spindle_wander(value), lambda: machine.spindle_wander(0.0)),
        "spindle_ignores_stop": (
            machine.spindle_ignores_stop,
            lambda: machine.spindle_ignores_stop(on=False),
        ),
        "spindle_fault": (
            lambda: machine.spindle_fault(text or "spindle drive fault"),
            lambda: machine.spindle_fault(""),
        ),
        "collet_sensor_stuck": (
            machine.collet_sensor_stuck,
            lambda: machine.collet_sensor_stuck(on=False),
        ),
        "station_silent": (machine.station_silent, lambda: machine.station_silent(on=False)),
        "pot_noise": (lambda: machine.pot_noise(value), lambda: machine.pot_noise(0.0)),
        "estop": (machine.press_estop, machine.release_estop),
    }
    if fault.what not in known:
        raise DriverError(f"the simulation cannot break {fault.what!r}")
    return known[fault.what]
