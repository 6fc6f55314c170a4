"""C in the HAL files that ``turndesk machine hal`` writes: the spindle's own drive, or a drive of its own."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import resources
from app.compose.backends.hal_file_writer import build_hal_file
from app.compose.machine.machine_files import parse_machine
from core.table_schema import MachineFileError
from drivers.hal.boards.hal_file_builder import HalFile, render_hal_file
from tests.drivers.hal.lathes import Changes, changed
from tests.drivers.hal.test_hal_files import load

AXIS = (
    "[axis.C]\nenabled = true\nvmax = 100\namax = 600\ncount = 0.087890625\nabsolute = true\n\n"
    "[c_axis]\nfeedback = false\n\n[spindle]\n"
)
PINS = '[hal.axes.C]\ncommand = "c-pos-cmd"\nfeedback = "c-pos-fb"\n\n[hal.spindle]\n'
STEPPED = "[board.axis.C]\nchannel = 2\np = 20\n\n[board.spindle]\n"
RELAY = "hm2_7i76e.0.7i76.0.0.output-06"
# Of each shipped machine: what makes the spindle's drive C.
AS_C: dict[str, Changes] = {
    "gt75-hal": (
        ("[hal.spindle]\n", PINS + 'position_mode = "spindle-is-c"\n'),
        ('velocity = "spindle-rps.out"', 'velocity = "spindle-rps"'),
    ),
    "gt75-mesa-7i97": (
        ("[hal.spindle]\n", PINS + 'position_mode = "spindle-is-c"\n'),
        ("[board.spindle]\n", "[board.axis.C]\np = 20\n\n[board.spindle]\n"),
    ),
    "gt75-ethercat": (
        ("[hal.spindle]\n", PINS + 'position_mode = "spindle-is-c"\n'),
        ("[board.spindle]\n", "[board.axis.C]\np = 20\n\n[board.spindle]\n"),
    ),
    "gt75-mesa-7i76e": (
        ("[hal.spindle]\n", PINS + f'position_mode = "{RELAY}"\n'),
        ("[board.spindle]\n", STEPPED),
    ),
    "gt75-parport": (
        ("[hal.spindle]\n", PINS + 'position_mode = "parport.0.pin-08-out"\n'),
        ("[board.spindle]\n", STEPPED.replace("channel = 2", "#").replace("p = 20", "p = 20\n" + "step = "
         '"parport.0.pin-06-out"\ndirection = "parport.0.pin-07-out"')),
        ('coolant = { at = "parport.0.pin-08-out", safe = false }', 'coolant = { at = "none" }'),
    ),
}  # fmt: skip


def written(name: str, *changes: tuple[str, str], own: bool = False) -> HalFile:
    axis = AXIS.replace("absolute", "own_drive = true\nabsolute") if own else AXIS
    text = changed(resources.read_machine_file(f"{name}.toml"), (("[spindle]\n", axis), *changes))
    return build_hal_file(parse_machine(text, f"{name}.toml"))


def nets(file: HalFile) -> dict[str, list[str]]:
    """Pins by signal."""
    found: dict[str, list[str]] = {}
    for words in (line.split("#")[0].split() for line in render_hal_file(file).splitlines()):
        if words[:1] == ["net"]:
            found.setdefault(words[1], []).extend(words[2:])
    return found


def figure(file: HalFile, pin: str) -> float:
    found = re.search(rf"^setp {re.escape(pin)} (\S+)", render_hal_file(file), re.MULTILINE)
    assert found, pin
    return float(found[1])


def refused(name: str, *changes: tuple[str, str], own: bool = False) -> str:
    with pytest.raises(MachineFileError) as error:
        written(name, *changes, own=own)
    return str(error.value)


@pytest.mark.usefixtures("halrun")
@pytest.mark.parametrize("name", list(AS_C))
def test_halrun_loads_the_spindle_as_c(name: str, tmp_path: Path) -> None:
    done = load(tmp_path, name, render_hal_file(written(name, *AS_C[name])))
    assert done.returncode == 0, done.stderr + done.stdout
    for signal in ("c-pos-cmd", "c-pos-fb", "spindle-is-c"):
        assert re.search(rf"\s{signal}$", done.stdout, re.MULTILINE), done.stdout


@pytest.mark.parametrize("name", list(AS_C))
def test_c_uses_the_spindle_encoder_and_its_loop_runs_only_as_c(name: str) -> None:
    file = written(name, *AS_C[name])
    on = nets(file)
    assert "c-degrees.in" in on["spindle-turns"]
    assert figure(file, "c-degrees.gain") == 360.0
    assert on["c-pos-fb"] == ["c-degrees.out", "pid.c.feedback"]
    assert "pid.c.enable" in on["spindle-is-c"]
    # 100 rpm are 600 degrees/s: half as much again, whatever the spindle can do
    assert figure(file, "pid.c.maxoutput") == 900.0


@pytest.mark.parametrize(
    ("name", "rpm", "enable"),
    [
        ("gt75-mesa-7i97", "hm2_7i97.0.pwmgen.04.value", "hm2_7i97.0.pwmgen.04.enable"),
        ("gt75-ethercat", "cia402.spindle.velocity-cmd", "cia402.spindle.enable"),
    ],
)
def test_speed_controlled_drive_receives_spindle_or_c_speed(name: str, rpm: str, enable: str) -> None:
    file = written(name, *AS_C[name])
    on = nets(file)
    assert on["spindle-drive-rpm"] == ["c-or-speed.out", rpm]
    assert on["spindle-rpm-cmd"] == ["c-or-speed.in0"]
    assert on["c-rpm"] == ["c-rpm.out", "c-or-speed.in1"]
    assert on["spindle-drive-on"] == ["spindle-power.out", enable]
    assert {"c-or-speed.sel", "spindle-power.in1"} <= set(on["spindle-is-c"])
    assert figure(file, "c-rpm.gain") == pytest.approx(1 / 6)
    calls = [line.split()[1] for line in render_hal_file(file).splitlines() if line.startswith("addf")]
    reads, writes = ("hm2_7i97.0.read", "hm2_7i97.0.write")
    if name == "gt75-ethercat":
        reads, writes = "cia402.spindle.read-all", "cia402.spindle.write-all"
    order = [reads, "c-degrees", "pid.c.do-pid-calcs", "c-rpm", "c-or-speed", "spindle-power", writes]
    assert [call for call in calls if call in order] == order


@pytest.mark.parametrize(
    ("name", "pin"), [("gt75-mesa-7i76e", RELAY), ("gt75-parport", "parport.0.pin-08-out")]
)
def test_step_controlled_drive_is_switched_to_c_by_a_terminal(name: str, pin: str) -> None:
    file = written(name, *AS_C[name])
    on = nets(file)
    assert on["spindle-is-c"] == ["pid.c.enable", pin]
    steps = "hm2_7i76e.0.stepgen.02" if "7i76e" in name else "stepgen.2"
    assert on["c-speed"] == ["pid.c.output", f"{steps}.velocity-cmd"]
    assert f"{steps}.enable" in on["machine-on"]
    assert figure(file, f"{steps}.position-scale") == pytest.approx(4096 / 360)
    assert any(wire.pin == pin and wire.names == ("hal.spindle.position_mode",) for wire in file.wiring_rows)


def test_settings_required_by_c_are_reported_if_missing() -> None:
    relay, board = AS_C["gt75-mesa-7i76e"]
    assert "hal.spindle.position_mode = spindle-is-c" in refused(
        "gt75-mesa-7i76e", (relay[0], relay[1].replace(RELAY, "spindle-is-c")), board
    )
    assert "board.axis.C.p" in refused(
        "gt75-mesa-7i97",
        AS_C["gt75-mesa-7i97"][0],
        ("[board.spindle]\n", "[board.axis.C]\n[board.spindle]\n"),
    )
    assert "board.axis.C.channel = 3" in refused(
        "gt75-ethercat", AS_C["gt75-ethercat"][0],
        ("[board.spindle]\n", "[board.axis.C]\np = 20\nchannel = 3\n\n[board.spindle]\n"),
    )  # fmt: skip
    assert "position_mode" in refused("gt75-hal", ("[hal.spindle]\n", PINS))


@pytest.mark.usefixtures("halrun")
def test_c_with_its_own_drive_is_an_additional_axis(tmp_path: Path) -> None:
    own = "[board.axis.C]\nchannel = 3\np = 20\nfull_rpm = 120\n\n[board.spindle]\n"
    file = written("gt75-mesa-7i97", ("[hal.spindle]\n", PINS), ("[board.spindle]\n", own), own=True)
    assert figure(file, "hm2_7i97.0.pwmgen.03.scale") == 720.0
    assert figure(file, "hm2_7i97.0.encoder.03.scale") == pytest.approx(4096 / 360)
    assert nets(file)["spindle-rpm-cmd"] == ["hm2_7i97.0.pwmgen.04.value"]
    done = load(tmp_path, "gt75-mesa-7i97", render_hal_file(file))
    assert done.returncode == 0, done.stderr + done.stdout


def test_settings_required_by_a_separate_c_drive_are_reported() -> None:
    said = refused(
        "gt75-mesa-7i97",
        ("[hal.spindle]\n", PINS),
        ("[board.spindle]\n", "[board.axis.C]\nchannel = 2\np = 20\nfull_speed = 100\n\n[board.spindle]\n"),
        own=True,
    )
    assert "board.axis.C.full_rpm" in said
    assert "board.spindle.encoder = 2" in said
