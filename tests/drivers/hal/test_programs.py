"""Programs through a real halrun: the shipped lathe of HAL's own components, with real processes and time."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.backends.machine_check import check_machine
from app.compose.machine.machine_files import load_machine, load_shipped_machine
from tests.drivers.hal.lathes import PATIENT, lathe, run
from tests.texts import text

PIECE = """\
G90G94F100
G00X.5Z.2
G01X.4Z0F30
G02X.5Z-.1I.4K-.1
M08
G04F.2
M09
G00X.6Z.3
M30
"""


@pytest.mark.long
@pytest.mark.usefixtures("halrun")
@pytest.mark.real_time
def test_program_ends_at_its_proved_position(tmp_path: Path) -> None:
    done = run(tmp_path, PIECE, lathe(tmp_path, PATIENT))
    assert "complete" in done.stdout, done.stdout + done.stderr
    assert "at X radius 0.60000  Z 0.30000 in" in done.stdout
    assert "0 underruns" in done.stdout


@pytest.mark.long
@pytest.mark.usefixtures("halrun")
def test_every_pin_of_the_machine_file_is_listed_by_machine_check() -> None:
    answers = check_machine(load_shipped_machine("gt75-hal"))
    assert not answers.faults
    pins = {row.name: row for row in answers.rows}
    assert pins["hal.axes.X.command"].at == "x-servo.in"
    assert {row.state for row in answers.rows} == {"ok", "not checked"}  # the board is simulated


@pytest.mark.long
@pytest.mark.usefixtures("halrun")
@pytest.mark.parametrize(
    ("old", "new", "row", "why"),
    [
        ('"x-servo.in"', '"x-servo.inn"', "hal.axes.X.command", text("drivers.hal-no-pin")),
        ('"x-motor.out"', '"x-motor.sel"', "hal.axes.X.feedback", "is of type bit; expected type float"),
        ('"x-servo.in"', '"x-servo.out"', "hal.axes.X.command", "this pin is an output"),
        ('"z-motor.out"', '"z-servo.in"', "hal.axes.Z.feedback", "this pin is an input"),
        ('"spindle-ramp.in"', '"spindle.velocity-cmd"', "hal.spindle.speed", "spindle-rps"),
    ],
)
def test_pin_that_differs_from_the_machine_file_is_named_by_check(
    old: str, new: str, row: str, why: str, tmp_path: Path
) -> None:
    answers = check_machine(load_machine(lathe(tmp_path, ((old, new),))))
    wrong = [each for each in answers.rows if each.result_text == "FAIL"]
    assert [each.name for each in wrong] == [row]
    assert why in wrong[0].detail
    assert answers.faults
