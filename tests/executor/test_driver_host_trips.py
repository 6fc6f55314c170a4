"""What a driver host has switched off while its control was silent: told, held, not counted; and outputs
moved by somebody else.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field

import pytest

from core.executor.commands import CycleStart, ForceOutput
from core.executor.executor import Executor
from core.executor.snapshot import MachineState
from core.faults import DriverHostTrip
from tests.executor.rig import Rig
from tests.executor.test_signal_lamps import with_lamps
from tests.texts import text

PART = "G90G94F300\nM03S1000\nM08\nG01F20Z-1\nM30\n"


@dataclass
class PlayedDriverHost:
    """Tells of one trip until it is acknowledged."""

    trip: DriverHostTrip | None = None
    acknowledged: list[int] = field(default_factory=list)

    def get_active_trip(self) -> DriverHostTrip | None:
        return self.trip

    def acknowledge_trip(self, trip: DriverHostTrip) -> None:
        self.acknowledged.append(trip.trip_number)
        self.trip = None


class FedRig(Rig):
    """The executor behind a driver host."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.host = PlayedDriverHost()
        ports = dataclasses.replace(self.sim.ports, trip_monitor=self.host)
        self.executor = Executor(self.machine, ports, self.events.append, self._passes)
        self.executor.run_tick()

    def trips(self, *outputs: str, spindle: bool = False, found: bool = False) -> None:
        """It has heard nothing for a second and a half; the outputs are off at the machine."""
        for name in outputs:
            self.sim.ports.io.write(name, False)
        self.host.trip = DriverHostTrip(7, 1.5, spindle, outputs, found)
        self.tick()
        assert self.host.acknowledged == [7]


def tripped(by: str, names: str) -> str:
    return text(f"executor.{by}-trip", seconds=1.5, names=names)


def test_driver_host_trip_at_rest_is_reported_without_a_hold() -> None:
    rig = FedRig()
    rig.ready()
    rig.post(ForceOutput("coolant", True))
    rig.trips("coolant")
    assert rig.said("disturbed") == [tripped("control", "COOLANT")]
    assert rig.state is MachineState.IDLE
    assert rig.shot.alarms == ()


def test_trip_of_lamps_alone_is_not_reported() -> None:
    rig = FedRig(with_lamps())
    rig.ready()
    rig.trips("lamp_green")
    assert rig.said("disturbed") == []


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (False, tripped("control", "SPINDLE, COOLANT")),
        (True, tripped("machine", "SPINDLE, COOLANT")),
    ],
)
def test_trip_in_a_cut_holds_and_the_part_is_not_counted(found: bool, words: str) -> None:
    rig = FedRig()
    rig.start(PART)
    rig.until_true(lambda shot: shot.actual[1] < -1.0)
    rig.trips("coolant", spindle=True, found=found)
    assert rig.said("disturbed") == [words]
    rig.until(MachineState.HOLD)
    z = rig.shot.demand[1]
    rig.run(1.0)
    outputs: set[str] = set()
    rig.watch.append(lambda shot: outputs.update(shot.outputs))
    assert rig.shot.demand[1] == z > -25.4  # of an inch: it has not gone on
    assert rig.shot.rpm_command == 0.0
    assert "coolant" not in rig.shot.outputs
    while rig.state is not MachineState.IDLE:
        rig.post(CycleStart())  # announced first, then done
        rig.run(0.9)
    assert "coolant" in outputs
    assert len(rig.said("uncounted")) == 1
    assert rig.said("part") == []


@pytest.mark.parametrize("on", [True, False])
def test_externally_changed_output_at_rest_is_reported_once_and_accepted(on: bool) -> None:
    rig = Rig()
    rig.ready()
    if not on:
        rig.post(ForceOutput("coolant", True))
        rig.run(0.6)
    rig.sim.ports.io.write("coolant", on)
    rig.run(1.0)
    words = text("executor.come-on", output="COOLANT") if on else text("executor.gone-off", output="COOLANT")
    assert rig.said("disturbed") == [text("executor.without-order", what=words)]
