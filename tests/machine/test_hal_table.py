"""[hal]: the pins of LinuxCNC's HAL at which the control begins, and what is refused in them."""

from __future__ import annotations

import re

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from core.table_schema import FileFinding, MachineFileError
from drivers.hal.hal_table import HalTable

HAL = resources.read_machine_file("gt75-hal.toml")
PARPORT = resources.read_machine_file("gt75-parport.toml")


def changed(*pairs: tuple[str, str]) -> str:
    """The shipped file with texts replaced, which must be there."""
    text = HAL
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def only_finding(text: str) -> FileFinding:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text, "test.toml")
    (found,) = caught.value.findings
    return found


def test_shipped_hal_table_is_read_in_model_units() -> None:
    machine = parse_machine(HAL, "hal")
    table = machine.hardware.find_driver_table(HalTable)
    assert table is not None
    assert (table.period, table.ahead, table.watchdog) == (0.001, 0.1, 0.25)
    assert table.axes["X"].command == "x-servo.in"
    assert table.axes["Z"].home == ""
    assert table.spindle.position == "spindle.position-fb"
    assert machine.hardware.spindle_driver == "hal"


@pytest.mark.parametrize(
    ("old", "new", "path", "expected"),
    [
        ('command = "x-servo.in"', 'command = "x servo"', "hal.axes.X.command", "name of a HAL pin"),
        ('at = "in-guard"', 'at = "in guard"', "io.in.guard.at", "name of a HAL pin"),
        ('command = "z-servo.in"', 'command = "x-servo.in"', "hal.axes.Z.command", "hal.axes.X.command"),
        ('enable = "z-motor.sel"', 'enable = "out-coolant"', "io.out.coolant.at", "hal.axes.Z.enable"),
        ("[hal.axes.Z]", "[hal.axes.Y]", "hal.axes.Y", "unknown key"),
        ('position = "spindle.position-fb"', "", "hal.spindle.position", "encoder_ppr"),
        ('speed = "spindle-ramp.in" ', "", "hal.spindle.speed", "speed, speed_abs or on to turn the spindle"),
        ('speed = "spindle-ramp.in" ', 'speed_abs = "spindle-ramp.in" ', "hal.spindle.forward", "sign"),
        ("[hal.spindle]\n", "[hal.spindel]\n", "hal.spindel", "did you mean"),
        ('file = "gt75-hal.hal"', "", "hal.file", "missing"),
    ],
)
def test_invalid_hal_value_is_rejected_at_its_key(old: str, new: str, path: str, expected: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(changed((old, new)), "test.toml")
    found = [each for each in caught.value.findings if each.path == path]
    assert found, caught.value.findings
    assert expected in str(found[0])


@pytest.mark.parametrize("name", ["gt75-ethercat", "gt75-mesa-7i97", "gt75-mesa-7i76e"])
@pytest.mark.parametrize("inverted", ["", "-not"])
@pytest.mark.parametrize("key", ["start", "hold"])
def test_an_input_that_is_a_home_switch_too_is_rejected(name: str, inverted: str, key: str) -> None:
    """Homing on it would start a cycle or hold it."""
    text = resources.read_machine_file(f"{name}.toml")
    home = re.search(r'^home = "([^"]+)"', text, re.MULTILINE)
    assert home is not None
    shared = re.sub(
        rf'^{key} = {{ at = "[^"]+"', f'{key} = {{ at = "{home[1]}{inverted}"', text, flags=re.MULTILINE
    )
    found = only_finding(shared)
    assert (found.path, "hal.axes.X.home" in str(found)) == (f"io.in.{key}.at", True)


HOMED = "absolute = false\nhome = {{ method = {}, speed = 60, order = 1 }}"


@pytest.mark.parametrize(
    ("method", "pins", "path", "expected"),
    [
        (7, "", "axis.X.home.method", "expected a homing method that this backend supports: 1, 2, 3"),
        (
            18,
            'limit_high = "a"',
            "axis.X.home.offset",
            "below 0, because at home the axis must be clear of the limit switch",
        ),
        (1, 'limit_low = "a"', "hal.axes.X.index_enable", "required by axis.X.home.method = 1"),
        (19, 'limit_low = "a"', "hal.axes.X.home", "required by axis.X.home.method = 19"),
        (3, 'home = "a"', "hal.axes.X.index_enable", "required by axis.X.home.method = 3"),
    ],
)
def test_homing_without_its_pins_is_rejected(method: int, pins: str, path: str, expected: str) -> None:
    text = changed(("absolute = true", HOMED.format(method)), ('"x-motor.sel"', f'"x-motor.sel"\n{pins}'))
    found = only_finding(text)
    assert (found.path, expected in str(found)) == (path, True), found


def on_one_switch(method: int, offset: float) -> str:
    """Return the parallel port sample, whose home switches are on one input, homed with other values."""
    homed = f"method = {method}, speed = 40, latch = 4, offset = {offset}"
    return re.sub("method = 19, speed = 40, latch = 4, offset = -0.1", homed, PARPORT)


@pytest.mark.parametrize(
    ("method", "offset", "side"),
    [(19, 0.0, "below"), (19, 0.1, "below"), (21, 0.0, "above"), (21, -0.1, "above")],
)
def test_axes_sharing_home_switch_must_move_off_it(method: int, offset: float, side: str) -> None:
    """An axis that rests on the switch would hide the switch of the other axis."""
    with pytest.raises(MachineFileError) as caught:
        parse_machine(on_one_switch(method, offset), "test.toml")
    assert [found.path for found in caught.value.findings] == ["axis.X.home.offset", "axis.Z.home.offset"]
    for found, other in zip(caught.value.findings, ("Z", "X"), strict=True):
        assert f"expected a home offset {side} 0, because hal.axes.{other}.home uses the same" in str(found)


@pytest.mark.parametrize(("method", "offset"), [(19, -0.1), (21, 0.1)])
def test_axes_may_share_home_switch_they_move_off(method: int, offset: float) -> None:
    table = parse_machine(on_one_switch(method, offset), "test.toml").hardware.find_driver_table(HalTable)
    assert table is not None
    assert table.axes["X"].home == table.axes["Z"].home


def test_inverter_with_hal_needs_no_spindle_pin() -> None:
    vfd = (
        'vfd = { family = "delta-vfdb", port = "/dev/ttyUSB1", baud = 9600, parity = "N", stop = 2,'
        " hz_per_rpm = 0.01667 }"
    )
    text = changed(('driver = "hal" ', f'{vfd}\ndriver = "vfd" '), ('speed = "spindle-ramp.in" ', ""))
    assert parse_machine(text, "test.toml").hardware.spindle_driver == "vfd"
