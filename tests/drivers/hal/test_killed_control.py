"""kill -9 of a control behind HAL while X moves: rest, everything off, HAL down, and the next start works."""

from __future__ import annotations

import signal
import tempfile
import time
from pathlib import Path

import pytest

from tests.drivers.hal.lathes import PATIENT, lathe
from tests.drivers.hal.live import halcmd, pin
from tests.killed.bench import Process, process, until
from tests.late_computer import command_was_late, tell

RUN = "app.cli.main", "run", "--headless", "--json", "--anew"
PROGRAM = "G90G94\nM03S600\nM08\nG01X3.Z0F200\nX-3.\nX3.\nX-3.\nM30\n"


LONGEST_LOOK = 0.3  # s


def moves() -> bool:
    return (pin("x-motor.out") or 0.0) > 10.0 and halcmd("gets", "out-coolant") == "TRUE"


def moves_in(control: Process) -> bool:
    """Wait until it moves; False where it has ended by itself, as on a computer that is late."""
    until(lambda: moves() or control.popen.poll() is not None, lambda: control.lines[-3:])
    if control.popen.poll() is not None:
        command_was_late(control.home)
    return control.popen.poll() is None


@pytest.mark.long
@pytest.mark.real_time
@pytest.mark.usefixtures("halrun")
def test_killed_control_ends_at_rest_with_all_off_and_hal_unloaded(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text(PROGRAM)
    words = *RUN, str(program), "--machine", str(lathe(tmp_path, PATIENT))
    with process(tmp_path / "home", *words) as control:
        assert moves_in(control)
        control.kill()
        seen = []
        looked = time.monotonic()
        while (place := pin("x-motor.out")) is not None:
            seen.append((place, pin("spindle-ramp.in"), halcmd("gets", "out-coolant"), pin("x-motor.sel")))
            before, looked = looked, time.monotonic()
            if looked - before > LONGEST_LOOK:  # HAL may be down before it is seen at rest twice
                tell("late")
        whole = [each for each in seen if None not in each and "" not in each]
        assert whole[-1][0] == pytest.approx(whole[-2][0], abs=1e-6)
        assert whole[-1][1:3] == (0.0, "FALSE")
        until(lambda: not control.family(), control.family)
        assert not [each for each in Path(tempfile.gettempdir()).glob("turndesk-hal-*") if each.is_dir()]
    with process(tmp_path / "home", *words) as again:
        assert moves_in(again)
        again.popen.send_signal(signal.SIGINT)
        until(lambda: not again.family(), again.family)
