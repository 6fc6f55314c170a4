"""What a simulated second costs: the lathe alone, under the executor, and each bench of the driver contract.

``python -m tests.benchmarks.bench_simulated_second [--seconds 10]`` prints milliseconds of processor time for
a second of machine time, at rest and while X moves.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable

from tests.drivers.contract.rigs import RIGS, make
from tests.drivers.machines import play, ramp, simulation
from tests.executor.rig import Rig

_BUFFERED = 1.0  # s of motion that every controller with a planner has room for
PROGRAM = "G90\nG72\nG71\nG94F60\n" + "G01Z-20.\nZ0.\n" * 20 + "M30\n"


def cost(run: Callable[[float], None], seconds: float) -> float:
    """Return milliseconds of processor time for one second of ``run``."""
    began = time.process_time()
    run(seconds)
    return 1000.0 * (time.process_time() - began) / seconds


def lathe(seconds: float) -> tuple[float, float]:
    """Return the cost of the simulated lathe alone, looked at every 10 ms: at rest, moving."""
    sim, clock = simulation()
    rest = cost(lambda length: play(sim, clock, length), seconds)
    sim.ports.axes.splice(ramp(clock.now() + 0.03, (0.0, 0.0, 0.0), 90.0 / seconds, seconds + 1.0))
    return rest, cost(lambda length: play(sim, clock, length), seconds)


def under_the_executor(seconds: float) -> tuple[float, float]:
    """Return the same with the executor, a tick every 10 ms."""
    rig = Rig(every=0.01)
    rig.ready()
    rest = cost(rig.run, seconds)
    rig.start(PROGRAM)
    rig.run(0.5)
    return rest, cost(rig.run, seconds)


def bench(name: str, seconds: float) -> tuple[float, float]:
    """Return the cost of one bench of the driver contract."""
    rig = make(name)
    try:
        rest = cost(rig.run, seconds)
        rig.ports.axes.enable(True)
        rig.run(0.2)
        moving = min(seconds, _BUFFERED) if rig.blocks is not None else seconds
        rig.go(60.0 / seconds, moving + 0.2)
        return rest, cost(rig.run, moving)
    finally:
        rig.close()


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0)
    seconds = parser.parse_args().seconds
    rows = {"simulated lathe": lathe(seconds), "with the executor": under_the_executor(seconds)}
    rows |= {f"contract: {name}": bench(name, seconds) for name in RIGS}
    sys.stdout.write(f"{'ms of processor time per simulated second':42s}   at rest   moving\n")
    for name, (rest, moving) in rows.items():
        sys.stdout.write(f"{name:42s} {rest:9.1f} {moving:8.1f}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
