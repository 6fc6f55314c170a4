"""A lathe behind HAL, each once with a real halrun: homing, limits, chain, handwheel, setter, C, G96.

Its slides, switches, encoders and drives are HAL's stock components; what they do is looked at by halcmd.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from core.executor.commands import (
    DeselectHandwheel,
    EnableDrives,
    HomeAxes,
    Reset,
    SelectHandwheel,
    TouchOffTool,
)
from core.executor.snapshot import MachineState, Snapshot
from drivers.hal.boards.hal_file_builder import render_hal_file
from tests.drivers.hal.halrun import folder_for_all, halrun_on_path
from tests.drivers.hal.lathes import PATIENT, Changes, lathe
from tests.drivers.hal.live import LiveLathe, live
from tests.drivers.hal.test_written_c import AS_C, written
from tests.late_computer import tell

pytestmark = [pytest.mark.long, pytest.mark.real_time]
SWITCH, INDEX, TIP = -2.0, 5.0, -4.0  # mm, as HAL counts: X's home switch, turns of Z's encoder, the setter

HAL: Changes = (
    ("loadrt lowpass names=x-servo,z-servo\n", "loadrt lowpass names=x-servo\n"),
    (
        "loadrt scale names=spindle-rps,",
        "loadrt sum2 names=z-error\nloadrt comp names=x-switch,tip\n"
        "loadrt scale names=z-vel,z-mm,spindle-rps,",
    ),
    ("loadrt sim_spindle names=spindle\n", "loadrt sim_spindle names=spindle,z-encoder\n"),
    (
        "addf spindle servo-thread\n",
        "".join(
            f"addf {name} servo-thread\n" for name in ("spindle", "z-encoder", "z-mm", "x-switch", "tip")
        ),
    ),
    (
        "addf z-servo servo-thread\n",
        "".join(f"addf {name} servo-thread\n" for name in ("z-error", "z-vel")),
    ),
    # Z's loop is closed over an encoder that begins anew at its index; 5 mm a turn.
    (
        "setp z-servo.gain 0.67\nnet z-pos-cmd z-servo.in\nnet z-servo-out z-servo.out z-motor.in1\n"
        "net z-pos-fb z-motor.out z-motor.in0\n",
        "setp z-error.gain1 -1\nsetp z-vel.gain 670\nsetp z-encoder.scale 0.2\nsetp z-mm.gain 5\n"
        "net z-pos-cmd z-error.in0\nnet z-off z-error.out z-vel.in\nnet z-wanted z-vel.out z-motor.in1\n"
        "net z-speed z-motor.out z-encoder.velocity-cmd\nnet z-turns z-encoder.position-fb z-mm.in\n"
        "net z-pos-fb z-mm.out z-error.in1\n",
    ),
    (
        "newsig in-guard bit\n",
        "newsig in-guard bit\nnewsig mpg s32\nnewsig x-high bit\nnewsig x-fault bit\n"
        f"setp x-switch.in1 {SWITCH}\nsetp tip.in1 {TIP}\n"
        "net x-pos-fb x-switch.in0 tip.in0\nnet x-home x-switch.out\nnet in-probe tip.out\n",
    ),
)
MACHINE: Changes = (
    *PATIENT,
    ("absolute = true", "absolute = false\nhome = { order = 1, method = 21, speed = 40, latch = 10 }"),
    ("absolute = true", "absolute = false\nhome = { order = 2, method = 34, speed = 40, latch = 30 }"),
    (
        "[spindle]\n",
        "[axis.C]\nenabled = true\nvmax = 200\namax = 600\ncount = 0.02\nabsolute = true\n\n"
        "[c_axis]\nfeedback = false\n\n[spindle]\n",
    ),
    (
        'guard = { at = "in-guard" }\n',
        'guard = { at = "in-guard" }\nprobe = { at = "in-probe" }\n',
    ),
    ("[m_codes]", '[io.analog]\nhandwheel = { at = "mpg", counts_per_click = 4 }\n\n[m_codes]'),
    (
        'enable = "x-motor.sel"\n',
        'enable = "x-motor.sel"\nhome = "x-home"\nlimit_high = "x-high"\nfault = "x-fault"\n',
    ),
    (
        'command = "z-servo.in"\nfeedback = "z-motor.out"\n',
        'command = "z-error.in0"\nfeedback = "z-mm.out"\nindex_enable = "z-encoder.index-enable"\n',
    ),
    (
        "[hal.spindle]\n",
        '[hal.axes.C]\ncommand = "c-pos-cmd"\nfeedback = "c-pos-fb"\n\n'
        '[hal.spindle]\nposition_mode = "spindle-is-c"\n',
    ),
    ('velocity = "spindle-rps.out"', 'velocity = "spindle-rps"'),
    (
        "[board]",
        "[setter]\nx = 0\nz = 0\nwidth = 0.1\novertravel = 0.15\nspeed = 20\nslow = 5\nsearch = 0.5\n"
        "back_off = 0.02\n\n[board]",
    ),
)


@pytest.fixture(scope="module")
def behind_hal() -> Iterator[LiveLathe]:
    text = render_hal_file(written("gt75-hal", *AS_C["gt75-hal"]))  # the spindle's drive is C
    with folder_for_all() as folder, halrun_on_path(), live(lathe(folder, MACHINE, HAL, text)) as made:
        yield made


@pytest.fixture
def homed(behind_hal: LiveLathe) -> LiveLathe:
    """Drives on, every axis homed, whatever was before."""
    made = behind_hal
    made.ready()
    if not all(made.shot.homed):
        made.post(HomeAxes())
        made.until(
            lambda shot: (shot.state is not MachineState.HOMING and all(shot.homed)) or bool(shot.alarms)
        )
        assert not made.shot.alarms, made.shot.alarms
    return made


def feedback(made: LiveLathe, pin: str) -> float:
    found = made.pin(pin)
    assert found is not None
    return found


def test_x_homes_on_its_switch_and_z_on_its_index(homed: LiveLathe) -> None:
    homed.until(lambda shot: shot.actual[1] == pytest.approx(feedback(homed, "z-mm.out"), abs=1e-3))
    x, z = homed.shot.actual[0], homed.shot.actual[1]
    # X counts from where its switch goes off, to one period of the slow way; Z from its encoder's index.
    assert feedback(homed, "x-motor.out") - x == pytest.approx(SWITCH, abs=10 / 60 * 25.4 * 0.002)
    assert feedback(homed, "z-mm.out") == pytest.approx(z, abs=1e-3)


def test_spindle_as_c_finds_its_index_positions_and_turns_again(homed: LiveLathe) -> None:
    homed.run("G90G94F100\nM19\nC90S60\nM30\n")  # it has never turned: its index is looked for
    c = homed.shot.axes.index("C")
    turns = feedback(homed, "spindle.position-fb")  # whole at its index
    # Whole turns of programs that ran before it do not matter.
    assert math.remainder(homed.shot.actual[c] - 90.0, 360.0) == pytest.approx(0.0, abs=0.2)
    assert math.remainder(turns - 0.25, 1.0) == pytest.approx(0.0, abs=0.002)
    homed.run("G90G94F100\nM03S300\nG04F.3\nM05\nM30\n")  # the same drive turns as the spindle again
    assert homed.pin("c-or-speed.sel") == 0.0


def test_limit_switch_brakes_and_removes_power(homed: LiveLathe) -> None:
    homed.start("G90G94F100\nG01X1.F100\nM30\n")
    homed.until(lambda shot: shot.velocity > 10.0)
    homed.set("x-high", 1)
    homed.until(lambda shot: bool(shot.alarms))
    assert homed.codes[0] == "limit-switch"
    assert "X" in homed.shot.alarms[0].cause
    homed.until(lambda _: homed.pin("x-motor.sel") == 0.0)  # once it has braked
    homed.set("x-high", 0)


def test_fault_of_one_drive_removes_power_from_all(homed: LiveLathe) -> None:
    homed.set("x-fault", 1)
    homed.until(lambda shot: bool(shot.alarms))
    assert homed.codes[0] == "axis"
    homed.until(lambda _: homed.pin("z-motor.sel") == 0.0)
    homed.set("x-fault", 0)


def test_estop_is_latched_in_hal_and_its_release_restores_nothing(homed: LiveLathe) -> None:
    homed.start("G90G94F100\nM03S500\nM08\nG04F30\nM30\n")
    homed.until(lambda _: homed.is_on("out-coolant"))
    homed.set("in-estop-ok", 0)
    homed.state(MachineState.ESTOP)
    dead = "x-motor.sel", "z-motor.sel", "spindle-ramp.in"
    # In the servo thread's next period: on a busy computer the control hears of it before.
    homed.until(lambda _: [homed.pin(each) for each in dead] == [0.0, 0.0, 0.0])
    assert not homed.is_on("out-coolant")
    homed.set("in-estop-ok", 1)
    homed.until(lambda shot: shot.state is not MachineState.ESTOP)
    assert [homed.pin(each) for each in dead] == [0.0, 0.0, 0.0]
    homed.post(Reset(), EnableDrives())
    homed.state(MachineState.IDLE)
    assert not homed.is_on("out-coolant")
    assert homed.pin("spindle-ramp.in") == 0.0


def test_handwheel_moves_its_axis_by_one_step_per_click(homed: LiveLathe) -> None:
    before = feedback(homed, "z-mm.out")
    wheel = SelectHandwheel("Z", 0.254, 0.25)
    for _ in range(10):
        homed.post(wheel)
    began = homed.clock.now()

    def there(shot: Snapshot) -> bool:
        homed.executor.post(wheel)
        if homed.stalled_at > began:  # its lease may have lapsed, and clicks of then do not count
            tell("late")
        return shot.actual[1] - before > 5 * 0.254 - 0.01

    homed.set("mpg", 20)  # counts: five clicks
    homed.until(there)
    for _ in range(30):
        homed.post(wheel)
    assert feedback(homed, "z-mm.out") - before == pytest.approx(5 * 0.254, abs=0.002)
    homed.post(DeselectHandwheel())
    homed.state(MachineState.IDLE)


def test_tool_is_touched_off_at_the_setter(homed: LiveLathe) -> None:
    homed.run("G90G94F100\nG00X-.05Z0\nM30\n")
    home = feedback(homed, "x-motor.out") - homed.shot.actual[0]

    def touched_under_a_lease(shot: Snapshot) -> bool:
        homed.executor.post(TouchOffTool("X", -1, 0.5, 1))
        return shot.touched is not None

    began = homed.clock.now()
    homed.until(touched_under_a_lease)
    touched = homed.shot.touched
    assert touched is not None
    if homed.stalled_at > began:  # the first touch may have been seen further away than the slide backs off
        tell("late")
    assert touched.touch_position_mm is not None, touched.why
    assert touched.touch_position_mm == pytest.approx(TIP - home, abs=touched.uncertainty_mm + 0.001)
    assert touched.uncertainty_mm < 0.005
    homed.state(MachineState.IDLE)


def test_constant_surface_speed_follows_x(homed: LiveLathe) -> None:
    homed.run("G90G94F100\nG00X.6Z0\nM30\n")
    homed.start("G90G94F100\nM03S500\nG94F60\nG96S250\nG76S300\nG77S2500\nG01X.3\nG04F9\nM30\n")
    homed.until(lambda shot: shot.waiting_for == "DWELL")
    wanted = 250 * 12 / (2 * math.pi * 0.3)  # ft/min at a radius of .3 in
    homed.until(lambda shot: abs(shot.rpm_actual - wanted) < 0.01 * wanted)
    assert homed.pin("spindle-ramp.in") == pytest.approx(wanted, rel=0.005)
    homed.post(Reset())
