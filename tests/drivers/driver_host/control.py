"""A control for tests that kill it: drives on, a long path, spindle and coolant on, then it keeps looking."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

from app.compose.backends.driver_host_process import DriverHostProcess
from app.compose.machine.machine_files import load_machine
from core.faults import get_fault_code
from core.ports import MotionSegments
from drivers.driver_host.host_ports import create_host_ports
from drivers.wakeups import RealClock

SPEED, CRUISE, UP = 20.0, 1.4, 0.02  # mm/s, s, s: 28.4 mm of X and as much of Z
TICK = 0.02


def main(path: str) -> None:
    clock = RealClock()
    host = DriverHostProcess(load_machine(Path(path)), clock)
    ports = create_host_ports(host.connection)
    ports.axes.enable(True)
    ports.spindle.set_speed(600.0)
    ports.io.write("coolant", True)
    ports.io.write("collet", True)
    at = clock.now() + ports.axes.commit + 0.1
    p, v, a = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    for axis in (0, 1):
        p[:, axis] = [0.0, 0.5 * SPEED * UP, 0.5 * SPEED * UP + SPEED * CRUISE]
        v[:, axis] = [0.0, SPEED, SPEED]
        a[:, axis] = [SPEED / UP, 0.0, -SPEED / UP]
    ports.axes.splice(
        MotionSegments(at + np.array([0.0, UP, UP + CRUISE]), np.array([UP, CRUISE, UP]), p, v, a)
    )
    sys.stdout.write(json.dumps({"feeder": host.process.pid, "warnings": list(ports.warnings)}) + "\n")
    sys.stdout.flush()
    while True:
        sample = ports.axes.sample()
        if sample.fault:
            sys.stdout.write(
                json.dumps({"fault": sample.fault, "code": get_fault_code(sample.fault, "axis")}) + "\n"
            )
            sys.stdout.flush()
            return
        clock.sleep_until(clock.now() + TICK)


if __name__ == "__main__":
    main(sys.argv[1])
