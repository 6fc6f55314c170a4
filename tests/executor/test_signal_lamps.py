"""The signal tower: what is lit in which state, what a fault leaves, and what a lamp may never do."""

from __future__ import annotations

import dataclasses

import pytest

from app.compose.machine.machine_files import load_machine, parse_machine
from core.executor.commands import CycleStart, FeedHold, ForceOutput, PreventNextPart, Reset, SetSwitch
from core.executor.executor import Executor
from core.executor.snapshot import MachineState
from core.machine.machine_model import Machine
from core.ports import DriverError, UnknownPart
from core.table_schema import MachineFileError
from tests.executor.rig import FINE, Rig
from tests.texts import text

PART = "G90G94F300\nX1Z.1\nG01F30Z-1\nG00Z.1\nM30\n"
STOPPED = PART.replace("M30", "M00\nM30")
ALL = "".join(
    f'lamp_{name} = {{ at = "OUT-2{number}", safe = {safe} }}\n'
    for number, (name, safe) in enumerate(
        (("red", "true"), ("amber", "false"), ("green", "false"), ("buzzer", "false"))
    )
)


def with_lamps(lamps: str = ALL, also: str = "") -> Machine:
    text = load_machine().text
    head, rest = text.split("[io.out]", 1)
    line, below = rest.split("\n", 1)
    return parse_machine(f"{head}[io.out]{line}\n{lamps}{below}\n{also}", "lamps.toml")


def tower(rig: Rig) -> set[str]:
    """What is really on, at the machine."""
    return {
        name[5:] for name, on in rig.sim.ports.io.get_outputs().items() if on and name.startswith("lamp_")
    }


def times(rig: Rig, seconds: float) -> dict[str, int]:
    """How often each lamp comes on in this time."""
    found, before = dict.fromkeys(("red", "amber", "green", "buzzer"), 0), tower(rig)
    for _ in range(round(seconds / 0.01)):
        rig.tick()
        now = tower(rig)
        for name in now - before:
            found[name] += 1
        before = now
    return found


@pytest.fixture
def rig() -> Rig:
    return Rig(with_lamps(), every=FINE)


def test_lamps_are_off_before_anything_runs(rig: Rig) -> None:
    rig.ready()
    rig.run(3.0)
    assert tower(rig) == set()


def test_lamp_is_green_in_a_cycle_and_amber_when_the_part_is_done(rig: Rig) -> None:
    rig.start(PART)
    rig.run(0.5)
    assert tower(rig) == {"green"}
    rig.until(MachineState.IDLE)
    rig.run(0.1)
    assert tower(rig) == {"amber", "buzzer"}
    rig.run(0.5)
    assert tower(rig) == {"amber"}
    assert times(rig, 5.0) == {"red": 0, "amber": 0, "green": 0, "buzzer": 0}  # steady
    rig.run(0.5)
    rig.post(CycleStart())
    rig.run(0.3)
    assert tower(rig) == {"green"}


def test_lamp_stays_green_between_repeated_parts(rig: Rig) -> None:
    rig.post(SetSwitch("cycle_repeat", True))
    rig.start(PART)
    rig.run(0.3)
    for _ in range(800):
        rig.tick()
        assert tower(rig) == {"green"}
    assert rig.shot.parts >= 2


@pytest.mark.parametrize("how", ["hold", "stop"])
def test_a_stop_blinks_amber_and_buzzes_once(rig: Rig, how: str) -> None:
    rig.start(PART if how == "hold" else STOPPED)
    if how == "hold":
        rig.run(0.5)
        rig.post(FeedHold())
    rig.until(MachineState.HOLD, MachineState.PROGRAM_STOP)
    assert times(rig, 0.05)["buzzer"] <= 1
    assert times(rig, 10.0) == {"red": 0, "amber": 10, "green": 0, "buzzer": 0}  # once a second


def test_alarm_blinks_red_and_clears_amber_and_green(rig: Rig) -> None:
    rig.start(PART)
    rig.run(0.5)
    rig.sim.machine.drive_fault("X")
    rig.until(MachineState.FAULT)
    assert "green" not in tower(rig)
    found = times(rig, 10.0)
    assert found["red"] in {9, 10}  # once a second
    assert (found["amber"], found["green"]) == (0, 0)
    assert found["buzzer"] == 2  # three seconds by turns, the first began with the alarm


def test_estop_lights_red_without_the_buzzer(rig: Rig) -> None:
    rig.start(PART)
    rig.run(0.5)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.run(1.5)
    assert tower(rig) == {"red"}
    assert times(rig, 5.0) == {"red": 0, "amber": 0, "green": 0, "buzzer": 0}


def test_blocked_next_part_blinks_amber_next_to_green(rig: Rig) -> None:
    rig.start(PART.replace("F30", "F10"))
    rig.run(0.3)
    rig.post(PreventNextPart("T1: its life is gone"))
    rig.run(1.2)
    found = times(rig, 2.0)
    assert (found["amber"], found["green"]) == (2, 0)
    assert "green" in tower(rig)


def test_shutdown_sets_the_lamps_to_their_configured_safe_state(rig: Rig) -> None:
    rig.start(PART)
    rig.run(0.5)
    rig.executor.shut_down()
    assert tower(rig) == {"red"}


def test_externally_switched_off_lamp_is_relit_without_a_hold(rig: Rig) -> None:
    rig.start(PART)
    rig.run(0.5)
    rig.sim.ports.io.write("lamp_green", False)  # somebody else
    rig.run(0.02)
    assert tower(rig) == set()
    rig.run(1.1)
    assert (rig.state, tower(rig)) == (MachineState.RUN, {"green"})
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


class Broken:
    """Terminals that refuse lamps."""

    def __init__(self, real: object, error: BaseException) -> None:
        self._real, self._error, self.tried = real, error, 0

    def __getattr__(self, name: str) -> object:
        return getattr(self._real, name)

    def write(self, name: str, on: bool) -> None:
        if name.startswith("lamp_"):
            self.tried += 1
            raise self._error
        self._real.write(name, on)  # type: ignore[attr-defined]


@pytest.mark.parametrize("error", [DriverError("the module is away", "output"), ZeroDivisionError("odd")])
def test_rejected_lamp_output_is_reported_once_and_stops_nothing(rig: Rig, error: BaseException) -> None:
    broken = Broken(rig.sim.ports.io, error)
    ports = dataclasses.replace(rig.sim.ports, io=broken)  # type: ignore[arg-type]
    rig.executor = Executor(rig.machine, ports, rig.events.append, rig._passes)
    rig.executor.run_tick()
    rig.start(PART)
    rig.run(1.0)
    assert rig.state is MachineState.RUN
    assert broken.tried <= 8  # four lamps, and no more for five seconds
    assert [said for said in rig.said("disturbed") if "LAMP_GREEN" in said] == [
        text("executor.lamp-not-switched", lamp="LAMP_GREEN", why=error)
    ]


def test_lamps_are_not_reported_or_switched_while_outputs_are_unknown(rig: Rig) -> None:
    rig.start(PART)
    rig.run(0.5)
    lost = dataclasses.replace(rig.sim.ports, unknown=lambda: frozenset({UnknownPart.OUTPUTS}))
    rig.executor = Executor(rig.machine, lost, rig.events.append, rig._passes)
    rig.run(1.0)
    assert UnknownPart.OUTPUTS in rig.shot.unknown  # F10 3 shows no state of them then
    assert tower(rig) == {"green"}  # as it was left: nothing was written


def test_lamps_can_be_tested_manually_only_at_rest(rig: Rig) -> None:
    rig.ready()
    rig.post(ForceOutput("lamp_red", True))
    rig.run(0.5)
    assert tower(rig) == {"red", "amber", "green", "buzzer"}
    rig.run(2.0)
    assert tower(rig) == set()
    rig.start(PART)
    rig.run(0.3)
    rig.post(ForceOutput("lamp_red", True))
    rig.run(0.1)
    assert tower(rig) == {"green"}
    assert text("executor.output-not-now", output="lamp_red", state="RUNNING") in rig.said("refused")[-1]


def test_a_machine_at_rest_sleeps_with_a_lamp_on(rig: Rig) -> None:
    rig.start(PART)
    rig.until(MachineState.IDLE)
    rig.run(4.0)
    assert tower(rig) == {"amber"}
    assert rig.executor._rest.wait_for_wakeup()


def test_machine_without_lamps_switches_only_its_own_outputs() -> None:
    rig = Rig(every=FINE)
    assert rig.machine.lamp_outputs == ()
    rig.start(PART)
    rig.until(MachineState.IDLE)
    assert rig.shot.outputs == frozenset({"collet"})


def test_lamps_are_in_the_snapshot_but_not_in_the_modal_outputs(rig: Rig) -> None:
    rig.start(PART)
    rig.run(0.5)
    assert "lamp_green" in rig.shot.outputs
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.post(Reset())
    assert "lamp_green" not in rig.shot.modal.outputs


@pytest.mark.parametrize(
    ("lamps", "also", "path", "value"),
    [
        ('lamp_blue = { at = "OUT-21", safe = false }\n', "", "io.out.lamp_blue", ""),
        ('lamp_green = { at = "OUT-21", safe = true }\n', "", "io.out.lamp_green.safe", "true"),
        ('lamp_red = { at = "OUT-21", safe = "keep" }\n', "", "io.out.lamp_red.safe", '"keep"'),
        (
            'lamp_red = { at = "OUT-21", safe = true }\n',
            '[m_codes.71]\noutput = "lamp_red"\non = true\n[m_codes.72]\noutput = "lamp_red"\non = false\n',
            "m_codes.71.output",
            '"lamp_red"',
        ),
    ],
)
def test_machine_file_with_an_invalid_lamp_is_rejected(lamps: str, also: str, path: str, value: str) -> None:
    with pytest.raises(MachineFileError) as told:
        with_lamps(lamps, also)
    finding = told.value.findings[0]
    assert (finding.path, finding.value) == (path, value)
