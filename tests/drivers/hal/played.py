"""The lathe behind HAL on the step clock: driver, bridge, servo thread, and a hand at each of its wires."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from app.compose.backends.hal_backend import create_hal_config
from app.compose.backends.simulated_backend import create_sim_config
from app.compose.machine.machine_files import parse_machine
from drivers.hal.bridge.packets import flatten_pieces
from drivers.hal.hal_machine import HalMachine
from drivers.setpoint_pieces import MotionPiece
from drivers.simulators.hal_simulator import HalSimulator
from drivers.wakeups import ManualClock
from tests.drivers.contract.hal import hal_text

LIMIT = ('fault = "x-fault"\n', 'fault = "x-fault"\nlimit_high = "x-high"\n')
TICK = 0.01  # s
STILL = (0.0, 0.0)


class Bench:
    """The lathe with a limit switch at the end of X, its bridge, and a driver that listens."""

    def __init__(self, *changes: tuple[str, str]) -> None:
        text = hal_text(homing=True)
        for old, new in (LIMIT, *changes):
            assert old in text, old
            text = text.replace(old, new, 1)
        machine = parse_machine(text, "gt75-hal.toml")
        config = create_hal_config(machine)
        self.clock = ManualClock()
        self.far = HalSimulator(config, create_sim_config(machine), self.clock)
        self.driver = HalMachine(config, self.clock, self.far.restart_bridge, self.far.plant.advance)
        self.axes = self.driver.ports.axes

    @property
    def bridge(self) -> tuple[str, str]:
        """What has stopped it, in words and by its code."""
        return self.far.bridge.fault, self.far.bridge.fault_code

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK)):
            self.clock.advance(TICK)
            self.far.plant.advance()
            self.driver.run_cycle()

    def told(self, what: str, numbers: tuple[float, ...] = (), **words: object) -> None:
        """An order as it comes to the bridge, whatever a driver would have thought of it."""
        self.far.bridge.queue_packet({"do": what, **words}, numbers)
        self.run(2 * TICK)

    def pin(self, name: str) -> float:
        """One of the bridge's own."""
        return self.far.bridge.pins[name]

    def wire(self, name: str, on: bool) -> None:
        """A pin of the machine that nothing else moves."""
        self.far.servo_thread.cells[self.far.servo_thread.machine_cells[name]] = float(on)

    def x_goes(self, speed: float) -> None:
        """At once, from where it stands, for ten seconds."""
        t = self.clock.now() + 0.05
        self.told(
            "splice", tuple(flatten_pieces([MotionPiece(t, 10.0, (self.x, self.z), (speed, 0.0), STILL)]))
        )

    @property
    def x(self) -> float:
        return self.far.plant_controls.get_true_positions()[0]

    @property
    def z(self) -> float:
        return self.far.plant_controls.get_true_positions()[1]


@contextmanager
def powered(*changes: tuple[str, str]) -> Iterator[Bench]:
    """With its drives on, and these changes of its machine file."""
    made = Bench(*changes)
    made.run(0.3)
    made.axes.enable(True)
    made.run(0.5)
    assert made.axes.sample().enabled
    yield made
    made.driver.close()
