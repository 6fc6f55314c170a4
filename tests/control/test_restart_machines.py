"""Reset replaces a killed control behind LinuxCNC's HAL and behind a grblHAL controller."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

import resources
from app.compose.machine.machine_files import load_machine
from app.desk.data_folder import HOME_VARIABLE
from core.executor.commands import (
    ConfirmStart,
    CycleStart,
    EnableDrives,
    LoadJob,
    ReplaceStartClearances,
    Reset,
    StartClearance,
)
from core.executor.job import Proof
from core.executor.snapshot import MachineState, Snapshot
from core.machine.machine_model import Machine
from tests.control.bench import LONG, job_of
from tests.control.test_restart import Desk, desk
from tests.drivers.hal.halrun import folder_for_all, hal_is_up, halrun
from tests.drivers.hal.lathes import PATIENT, Changes, changed, lathe
from tests.free_port import free_port
from tests.killed.bench import Process, process, until

__all__ = ["halrun"]
pytestmark = [
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc"),
    pytest.mark.real_time,
]
# The spindle brakes for 8 s, and the board needs 11 s to be configured.
SLOW: Changes = (
    ("accel_rpm_s = 1500", "accel_rpm_s = 75"),
    ("\ntimeout_s = 5\n", "\ntimeout_s = 60\n"),
)
SLOW_HAL: Changes = (
    ("setp spindle-ramp.maxv 1500 ", "setp spindle-ramp.maxv 75 "),
    ("loadrt limit2 names=spindle-ramp", "loadusr -w sleep 11\nloadrt limit2 names=spindle-ramp"),
)


@pytest.fixture
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder that the user of HAL can read, with the data folder in it."""
    with folder_for_all() as made:
        monkeypatch.setenv(HOME_VARIABLE, str(made / "home"))
        yield made


@pytest.fixture
def hal_until_down(halrun: None) -> Iterator[None]:
    """HAL for this test, whose driver host may shut it down after the control has ended."""
    yield
    until(lambda: not hal_is_up(), lambda: "HAL was not shut down")


@pytest.fixture
def grbl_file(folder: Path) -> Path:
    """The machine file of the shipped grblHAL lathe with a controller on this computer."""
    file = folder / "grbl.toml"
    text = resources.read_machine_file("gt75-grblhal.toml")
    file.write_text(changed(text, [("/dev/ttyACM0", f"tcp://127.0.0.1:{free_port()}")]))
    return file


@contextmanager
def controller(file: Path) -> Iterator[Process]:
    """The simulated controller, ready for connections."""
    with process(file.parent / "peer", "app.cli.main", "machine", "peer", str(file)) as peer:
        assert peer.popen.stdout is not None
        assert b"grblHAL" in peer.popen.stdout.readline()
        yield peer


def one_button(file: Path) -> Machine:
    """The machine of this file with one start button."""
    machine = load_machine(file)
    return replace(machine, interlocks=replace(machine.interlocks, two_hand_start=False))


def start(screen: Desk, machine: Machine) -> None:
    """Drives on, a program loaded and started, and X moves."""
    job, live = job_of(LONG, machine), screen.live
    screen.wait(lambda: live.snapshot.state is MachineState.DISABLED and not live.snapshot.unknown)
    screen.post(EnableDrives())
    screen.until(MachineState.IDLE)
    screen.post(LoadJob(job, Proof(job.digest, ())))
    screen.wait(lambda: live.snapshot.program == "part.nc")
    if live.snapshot.interrupted is not None:  # read, and meant all the same
        screen.post(ConfirmStart(live.snapshot.interrupted.at))
        looked = live.client.clock.now() + 1.0
        screen.wait(lambda: live.client.clock.now() > looked)
    shot = live.snapshot
    screen.post(ReplaceStartClearances((StartClearance(job.digest, shot.demand, shot.begun),)), CycleStart())
    screen.until(MachineState.RUN)
    screen.wait(lambda: live.snapshot.demand[0] > shot.demand[0] + 1.0)


def kill(screen: Desk) -> None:
    """Kill the control, and see its alarm."""
    os.kill(screen.process, signal.SIGKILL)
    screen.until(MachineState.FAULT)
    assert screen.alarms == ["control-silent"]


def reset(screen: Desk) -> Snapshot:
    """Press Reset once; what the new control shows, with the program loaded."""
    killed, said = screen.process, len(screen.said)
    screen.post(Reset())
    screen.wait(lambda: screen.process != killed or len(screen.said) > said + 1)
    assert screen.process != killed, screen.said
    screen.wait(lambda: screen.live.snapshot.program == "part.nc")
    shot = screen.live.snapshot
    assert shot.state is MachineState.DISABLED
    assert (shot.rpm_command, shot.rpm_actual, shot.alarms) == (0.0, pytest.approx(0.0, abs=5.0), ())
    assert shot.interrupted is not None
    return shot


@pytest.mark.usefixtures("hal_until_down")
@pytest.mark.parametrize(
    ("machine", "hal"),
    [((), ()), pytest.param(SLOW, SLOW_HAL, marks=pytest.mark.long)],
    ids=["quick", "slow"],
)
def test_reset_restarts_a_killed_control_with_hal(folder: Path, machine: Changes, hal: Changes) -> None:
    """The new control waits until the driver host has stopped the spindle and shut down HAL."""
    made = one_button(lathe(folder, (*PATIENT, *machine), hal))
    with desk(folder / "home", made) as screen:
        start(screen, made)
        kill(screen)
        reset(screen)
        start(screen, made)
        assert screen.alarms == ["control-silent"]
        assert [event.kind for event in screen.events].count("start") == 2


def test_reset_restarts_a_killed_control_with_grblhal(grbl_file: Path) -> None:
    """The controller retains the position after it has finished its blocks.

    These last at most 0.6 s at 10 in/min, which is 4.2 mm/s; the last snapshot may be 0.2 s old.
    """
    machine = one_button(grbl_file)
    with controller(grbl_file), desk(grbl_file.parent / "home", machine) as screen:
        start(screen, machine)
        before = screen.live.snapshot.actual[0]
        kill(screen)
        after = reset(screen)
        assert before <= after.actual[0] <= before + 0.8 * 10.0 * 25.4 / 60.0
        assert all(after.homed)
        assert after.outputs == {"collet"}
        start(screen, machine)
        assert screen.alarms == ["control-silent"]


def test_control_without_its_controller_is_not_started_until_it_is_back(grbl_file: Path) -> None:
    machine = one_button(grbl_file)
    with desk_with_lost_controller(grbl_file, machine) as screen:
        killed = screen.process
        screen.post(Reset())
        screen.wait(lambda: len(screen.said) == 2)
        screen.wait(lambda: not screen.live.is_restarting)
        assert screen.process == killed
        assert screen.live.snapshot.state is MachineState.FAULT
        with controller(grbl_file):
            reset(screen)


@contextmanager
def desk_with_lost_controller(file: Path, machine: Machine) -> Iterator[Desk]:
    """A screen whose control was killed together with the controller."""
    with controller(file) as peer, desk(file.parent / "home", machine) as screen:
        start(screen, machine)
        kill(screen)
        peer.kill()
        yield screen
