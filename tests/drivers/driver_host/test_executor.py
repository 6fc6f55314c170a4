"""The executor sees no difference: the same run through the driver host's messages, event by event."""

from __future__ import annotations

import pytest

from core.executor.commands import CycleStart, FeedHold
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import ToolOffset
from drivers.driver_host.host_connection import HostConnection
from drivers.driver_host.host_ports import create_host_ports
from drivers.driver_host.host_server import DriverHost
from drivers.simulated.simulated_machine import Simulation
from tests.drivers.contract.simulated import BrokenLink, simulation_driven
from tests.executor.rig import Rig
from tests.executor.test_signal_lamps import tower, with_lamps
from tests.executor.test_threads import EXTERNAL
from tests.texts import text

TURN = "G90G94F300\nT1\nM03S1000\nM08\nX.5Z0\nG95F.005\nG01X.4Z-.2\nX.5\nM09\nM05\nG94F300\nZ0\nM30\n"
TOOLS = {1: ToolOffset(0.0, 0.0, 0.0)}


class FedRig(Rig):
    """The executor's rig with the driver host between it and the simulation."""

    def __post_init__(self) -> None:
        super().__post_init__()
        plain = self.sim
        self.host = DriverHost(simulation_driven(plain.ports, plain.machine))
        self.link = BrokenLink(self.host)
        ports = create_host_ports(HostConnection(self.link, self.clock))
        self.sim = Simulation(ports, plain.machine)
        self.events.clear()
        self.executor = type(self.executor)(self.machine, ports, self.events.append, self._passes)
        self.executor.run_tick()


def story(rig: Rig, text: str) -> list[tuple[float, str, str, int]]:
    rig.events.clear()
    rig.start(text, TOOLS)
    rig.until(MachineState.IDLE)
    return [(round(event.time_s, 6), event.kind, event.text, event.line_number) for event in rig.events]


@pytest.mark.parametrize("text", [TURN, EXTERNAL], ids=["turning", "thread"])
def test_part_runs_the_same_steps_with_and_without_a_driver_host(text: str) -> None:
    plain, fed = story(Rig(), text), story(FedRig(), text)
    assert fed == plain
    assert any(kind == "part" for _, kind, _, _ in fed)


def test_hold_stops_at_the_same_position_with_a_driver_host() -> None:
    places = []
    for rig in (Rig(), FedRig()):
        rig.start("G90G94F300\nG01F300\nX3Z-4\nX0Z0\nM30\n")
        rig.run(0.5)
        rig.post(FeedHold())
        rig.until(MachineState.HOLD)
        places.append(rig.shot.demand)
    assert places[0] == pytest.approx(places[1], abs=1e-12)


def test_lost_driver_host_leaves_station_and_motion_unknown() -> None:
    rig = FedRig()
    rig.ready()
    rig.link.why = "the driver host has ended"
    rig.run(0.1)
    assert not rig.sim.ports.axes.sample().enabled
    assert rig.sim.ports.station.read_state().age == float("inf")
    assert rig.sim.ports.spindle.read_fault() == "the driver host has ended"


def tripped(seconds: float, names: str) -> str:
    return text("executor.control-trip", seconds=seconds, names=names)


def test_coolant_not_renewed_in_a_cut_causes_hold_and_resumes_with_start() -> None:
    """Its terminal wants a word each .3 s; the control was away for .5 s, and the slides went on."""
    rig = FedRig()
    rig.host._refresh = {"coolant": 0.3}
    rig.start("G90G94F300\nT1\nM03S600\nM08\nX.5Z0\nG01F20Z-2\nM30\n", TOOLS)
    rig.until_true(lambda shot: shot.actual[1] < -3.0)
    for _ in range(50):
        rig.clock.advance(0.01)
        rig.host.run_cycle()
    assert not rig.sim.machine.outputs()["coolant"]
    assert rig.sim.ports.axes.sample().moving
    rig.tick()
    rig.until(MachineState.HOLD, limit=0.3)
    assert rig.shot.waiting_for == tripped(0.5, "COOLANT")
    assert rig.sim.machine.get_spindle_rpm() == pytest.approx(600.0)  # the tool was in the cut
    rig.run(1.0)
    assert rig.shot.announced == (text("executor.comes-on", output="COOLANT"),)
    rig.post(CycleStart())
    rig.run(0.05)
    assert rig.sim.machine.outputs()["coolant"]
    rig.until(MachineState.IDLE)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 0


DWELL = "G90G94F300\nT1\n{on}\nX.5Z.1\nG01F30Z-.2\nG04F3\nG01Z-.3\nG00Z.1\nM30\n"


def silent(rig: FedRig, seconds: float) -> None:
    """The control is away; the driver host goes on."""
    for _ in range(round(seconds / 0.01)):
        rig.clock.advance(0.01)
        rig.host.run_cycle()


def in_dwell_away(on: str) -> FedRig:
    """A lathe with a signal tower whose control was away for .3 s while its slides rested in a dwell."""
    rig = FedRig(with_lamps())
    rig.start(DWELL.format(on=on), TOOLS)
    rig.until_true(lambda shot: abs(shot.actual[1] + 5.08) < 0.01)
    rig.run(0.5)
    assert tower(rig) == {"green"}
    silent(rig, 0.3)
    assert tower(rig) == {"red"}  # as the file calls it safe: nobody drives it
    return rig


def test_lamp_switched_off_by_the_driver_host_does_not_cost_a_part() -> None:
    rig = in_dwell_away("")
    rig.run(1.2)
    assert tower(rig) == {"green"}
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.said("disturbed") == []


@pytest.mark.parametrize(
    ("on", "names"), [("M08", "COOLANT"), ("M03S600", "SPINDLE"), ("M03S600\nM08", "SPINDLE, COOLANT")]
)
def test_other_output_switched_off_by_driver_host_causes_hold_naming_it(on: str, names: str) -> None:
    rig = in_dwell_away(on)
    rig.tick()
    rig.until(MachineState.HOLD, limit=0.5)
    assert rig.shot.waiting_for == tripped(0.3, names)


def test_lamp_timeout_at_rest_is_not_reported() -> None:
    rig = FedRig(with_lamps())
    rig.start("G90G94F300\nX1Z.1\nG00Z.2\nM30\n")
    rig.until(MachineState.IDLE)
    rig.run(1.0)
    assert tower(rig) == {"amber"}
    silent(rig, 0.8)
    assert tower(rig) == {"red"}
    rig.run(1.2)
    assert tower(rig) == {"amber"}
    assert rig.said("disturbed") == []
