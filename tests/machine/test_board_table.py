"""[board]: what the HAL file is written for, and what is refused in it and in the pins that [hal] names."""

from __future__ import annotations

import pytest

import resources
from app.compose.backends.hal_file_writer import build_hal_file
from app.compose.machine.machine_files import parse_machine
from app.desk.command_errors import CommandError
from core.table_schema import FileFinding, MachineFileError
from drivers.hal.boards.hal_file_builder import render_hal_file
from tests.coded import raises_code
from tests.texts import text as wording


def changed(name: str, *pairs: tuple[str, str]) -> str:
    """A shipped file with texts replaced, which must be there."""
    text = resources.read_machine_file(f"gt75-{name}.toml")
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def refused(text: str) -> tuple[FileFinding, ...]:
    with pytest.raises(MachineFileError) as caught:
        build_hal_file(parse_machine(text, "test.toml"))
    return caught.value.findings


STEP, SERVO, BUS, PORT = "mesa-7i76e", "mesa-7i97", "ethercat", "parport"
BOARDS = '"sim", "parport", "mesa-7i76e", "mesa-7i97", "ethercat"'


@pytest.mark.parametrize(
    ("name", "old", "new", "path", "expected"),
    [
        (
            STEP,
            'kind = "mesa-7i76e"',
            'kind = "mesa-7i77"',
            "board.kind",
            wording("machine.one-of", choices=BOARDS),
        ),
        (STEP, 'address = "192.168.1.121"', 'address = "eth0"', "board.address", "the card's address"),
        (PORT, 'address = "0x378"', 'address = "lpt1"', "board.address", "0x378"),
        (STEP, "channel = 1", "channel = 0", "board.axis.Z.channel", "board.axis.X.channel already uses"),
        (STEP, "channel = 1", "channel = 5", "board.axis.Z.channel", "0 to 4"),
        (
            STEP,
            "channel = 1\n",
            "",
            "board.axis.Z.channel",
            f"missing; expected {wording('machine.step-channel')}",
        ),
        (STEP, "encoder = 0 ", "encoder = 1 ", "board.spindle.encoder", wording("machine.only-encoder")),
        (
            STEP,
            "full_speed = 3500 ",
            "# ",
            "board.spindle.full_speed",
            "missing; expected the spindle speed at 10 V",
        ),
        (STEP, 'speed_abs = "spindle-rpm-abs"', "", "hal.spindle.speed", "an output for the spindle speed"),
        (
            STEP,
            "encoder_ppr = 1024 ",
            "encoder_ppr = 0 ",
            "spindle.encoder_ppr",
            "the line count of the encoder",
        ),
        (
            STEP,
            "step_ns = 5000 ",
            "step_ns = 99000 ",
            "axis.X.vmax",
            "33333 steps/s, but the maximum for the specified step_ns and space_ns",
        ),
        (STEP, "[board.axis.Z]", "[board.axis.Y]", "board.axis.Y", "unknown key"),
        (
            STEP,
            "[board.axis.Z]",
            "[board.axis.Y]",
            "board.axis.Z",
            "missing; specify the board outputs that move axis Z",
        ),
        (
            SERVO,
            "full_speed = 400 ",
            "# ",
            "board.axis.X.full_speed",
            "missing; expected the axis speed at 10 V",
        ),
        (SERVO, "full_speed = 400 ", "full_speed = 299 ", "board.axis.X.full_speed", "at least axis.X.vmax"),
        (SERVO, "p = 20 ", "# ", "board.axis.X.p", "missing; expected the P gain"),
        (SERVO, "channel = 4 ", "channel = 2 ", "board.spindle.channel", "4 or 5"),
        (SERVO, "channel = 1\n", "channel = 4\n", "board.axis.Z.channel", wording("machine.servo-channel")),
        (BUS, 'vendor = "0x0000026c"  ', "# ", "board.axis.X.vendor", "missing"),
        (BUS, 'product = "0x0000003c"', 'product = "60"', "board.axis.X.product", "ethercat slaves -v"),
        (
            BUS,
            "velocity_per_rpm = 68.2666667 ",
            "# ",
            "board.spindle.velocity_per_rpm",
            "object 60FF at 1 rpm",
        ),
        (BUS, "channel = 2", "channel = 1", "board.spindle.channel", "board.axis.Z.channel already uses"),
        (
            BUS,
            "channel = 2\n",
            "",
            "board.spindle.channel",
            f"missing; expected {wording('machine.bus-position')}",
        ),
        (PORT, 'step = "parport.0.pin-02-out"', "", "board.axis.X.step", ("the pin for the step signal")),
        (PORT, "vmax = 50 ", "vmax = 200 ", "axis.X.vmax", "base_us = 50 is 16667 steps/s"),
        (PORT, 'phase_b = "parport.0.pin-15-in"', "", "board.spindle.phase_b", "missing"),
    ],
)
def test_invalid_board_table_is_rejected(name: str, old: str, new: str, path: str, expected: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(changed(name, (old, new)), "test.toml")
    found = [each for each in caught.value.findings if each.path == path]
    assert found, caught.value.findings
    assert expected in str(found[0])


INPUT = "hm2_7i76e.0.7i76.0.0.input"


@pytest.mark.parametrize(
    ("name", "old", "new", "path", "expected"),
    [
        (STEP, f"{INPUT}-01", f"{INPUT}-32", "io.in.guard", "the board does not have this pin"),
        (
            STEP,
            f'"{INPUT}-01"',
            '"hm2_7i76e.0.7i76.0.0.output-09"',
            "io.in.guard",
            "this terminal is an output; expected an input",
        ),
        (
            STEP,
            "7i76.0.0.output-01",
            "7i76.0.0.input-20",
            "io.out.coolant",
            "this terminal is an input; expected an output",
        ),
        (STEP, f'"{INPUT}-10"', '"x-home"', "hal.axes.X.home", "this signal is not connected to a pin"),
        (STEP, '"x-pos-cmd"', '"pid.z.command"', "hal.axes.X.command", "expected pid.x.command, the name of"),
        (STEP, 'machine_on = "hm2_7i76e.0.7i76.0.0.output-00"', "", "hal.machine_on", "missing"),
        (
            SERVO,
            "input-11-not",
            "input-16-not",
            "board.axis.Z.fault_input",
            "the board does not have this pin",
        ),
        (BUS, "DI.din-1", "DI.din-8", "io.in.guard", "EL1008"),
        (
            PORT,
            "parport.0.pin-08-out",
            "parport.0.pin-02-out",
            "io.out.coolant",
            "board.axis.X.step already uses",
        ),
        (PORT, "parport.0.pin-11-in", "parport.0.pin-14-in", "io.in.collet_closed", "does not have this pin"),
        (
            STEP,
            '"x-pos-fb"',
            f'"x-pos-fb"\nenable = "{INPUT}-12"',
            "hal.axes.X.enable",
            "or remove this key: hal",
        ),
        (
            PORT,
            'pwm = "parport.0.pin-17-out"',
            'pwm = "parport.0.pin-15-in"',
            "board.spindle.pwm",
            "this terminal is an input",
        ),
    ],
)
def test_pins_missing_on_board_are_rejected(name: str, old: str, new: str, path: str, expected: str) -> None:
    (found,) = refused(changed(name, (old, new)))
    assert (found.path, expected in str(found)) == (path, True), found


@pytest.mark.parametrize(
    ("name", "old", "new", "path"),
    [
        (STEP, "channel = 1\n", 'channel = "one"\n', "board.axis.Z.channel"),
        (STEP, "step_ns = 5000 ", 'step_ns = "slow" ', "board.axis.X.step_ns"),
        (STEP, "full_speed = 3500 ", 'full_speed = "fast" ', "board.spindle.full_speed"),
        (STEP, "encoder_ppr = 1024 ", 'encoder_ppr = "many" ', "spindle.encoder_ppr"),
        (PORT, '"0x378"\nbase_us = 50 ', '"0x378"\nbase_us = "fifty" ', "board.base_us"),
        (BUS, 'vendor = "0x0000026c" ', "vendor = 620 ", "board.axis.X.vendor"),
        (SERVO, "[board.axis.Z]\nchannel = 1\n", "[board.axis]\nZ = 1\n[board.axis.Q]\n", "board.axis.Z"),
    ],
)
def test_invalid_board_value_is_reported_once(name: str, old: str, new: str, path: str) -> None:
    """Nothing is made of it: no rate of steps, no scale and no second channel is missed behind it."""
    with pytest.raises(MachineFileError) as caught:
        parse_machine(changed(name, (old, new)), "test.toml")
    assert [each.path for each in caught.value.findings if "Q" not in each.path] == [path], (
        caught.value.findings
    )


def test_board_without_hal_table_is_rejected() -> None:
    text = resources.read_machine_file("gt75.toml") + '\n[board]\nkind = "sim"\n'
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text, "test.toml")
    (error, *_) = caught.value.findings
    assert error.path == "hal"
    assert (
        "missing; [board] requires the table [hal], because [board] describes the hardware "
        "connected to the pins that [hal] specifies"
    ) in str(error)


def test_analog_input_missing_on_board_is_rejected() -> None:
    pot = '[io.analog]\nfeed_pot = { at = "hm2_7i76e.0.7i76.0.0.analogin0", range = [0, 1.5] }\n\n[m_codes]'
    (found,) = refused(changed(STEP, ("[m_codes]", pot)))
    assert found.path == "io.analog.feed_pot"


def test_hal_file_of_machine_without_board_or_hal_is_rejected() -> None:
    with raises_code(CommandError, "no-board", "[board]", '"sim", "parport"'):
        build_hal_file(parse_machine(changed("hal", ('[board]\nkind = "sim"', "")), "test.toml"))
    with raises_code(CommandError, "not-hal"):
        build_hal_file(parse_machine(resources.read_machine_file("gt75.toml"), "gt75.toml"))


# --- what the words of the file become


def lines(text: str) -> list[str]:
    return [
        line.split("#")[0].rstrip()
        for line in render_hal_file(build_hal_file(parse_machine(text, "test.toml"))).splitlines()
    ]


def test_reversed_axis_changes_sign_of_scale() -> None:
    assert "setp hm2_7i76e.0.stepgen.00.position-scale 393.7007874" in lines(changed(STEP))
    turned = lines(changed(STEP, ("reversed = false", "reversed = true")))
    assert "setp hm2_7i76e.0.stepgen.00.position-scale -393.7007874" in turned


def test_position_mode_leaves_position_loop_to_card() -> None:
    found = lines(changed(STEP, ('mode = "velocity"', 'mode = "position"')))
    assert "setp hm2_7i76e.0.stepgen.00.control-type 0" in found
    assert "net x-pos-cmd hm2_7i76e.0.stepgen.00.position-cmd" in found
    assert "loadrt pid names=pid.z" in found


def test_one_switch_may_be_home_and_limit() -> None:
    both = changed(STEP, (f'home = "{INPUT}-10"', f'home = "{INPUT}-10"\nlimit_high = "{INPUT}-10"'))
    file = build_hal_file(parse_machine(both, "test.toml"))
    (wire,) = [wire for wire in file.wiring_rows if wire.pin == f"{INPUT}-10"]
    assert wire.names == ("hal.axes.X.home", "hal.axes.X.limit_high")


def test_all_enable_pins_are_on_one_signal() -> None:
    relay = 'feedback = "x-pos-fb"\nenable = "hm2_7i76e.0.7i76.0.0.output-15"'
    found = lines(changed(STEP, ('feedback = "x-pos-fb"', relay)))
    (net,) = [line for line in found if line.startswith("net machine-on ")]
    for pin in ("pid.x.enable", "stepgen.01.enable", "output-00", "output-15"):
        assert pin in net


VFD = """driver = "vfd"
[spindle.vfd]
family = "delta-vfdb"
port = "/dev/ttyUSB1"
baud = 9600
parity = "N"
stop = 2
hz_per_rpm = 0.01667
# """


def without_spindle(name: str, *, encoder: bool) -> str:
    """The shipped file with the spindle on an inverter of its own line; what the board has of one is out."""
    head, said = changed(name, ('driver = "hal" ', VFD)).split("[hal.spindle]\n")
    pins, board = said.split("[board]\n")
    board, ours = board.split("[board.spindle]\n")
    kept = ("position", "velocity", "index_enable", "phase_", "encoder", "reversed") if encoder else ()
    of = [
        "".join(f"{line}\n" for line in part.splitlines() if line.startswith(kept)) for part in (pins, ours)
    ]
    if not encoder:
        head = head.replace("encoder_ppr = ", "encoder_ppr = 0  # ", 1)
        of = ["", ""]
    return f"{head}[hal.spindle]\n{of[0]}\n[board]\n{board}[board.spindle]\n{of[1]}"


@pytest.mark.parametrize(
    ("name", "turned", "read"),
    [
        (STEP, ("spinout",), ("encoder.00",)),
        (SERVO, ("pwmgen.04",), ("encoder.02",)),
        (BUS, ("cia402.spindle", "spindle-per-s"), ()),
        (PORT, ("pwmgen",), ("encoder",)),
    ],
)
@pytest.mark.parametrize("encoder", [True, False])
def test_spindle_not_driven_by_board_has_only_its_encoder(
    name: str, turned: tuple[str, ...], read: tuple[str, ...], encoder: bool
) -> None:
    if name == BUS and encoder:
        pytest.skip("its encoder is the spindle drive's own")
    found = lines(without_spindle(name, encoder=encoder))
    for word in turned:
        assert not [line for line in found if word in line]
    for word in read:
        assert bool([line for line in found if word in line]) is encoder
    assert bool([line for line in found if "spindle" in line]) is encoder
    assert [line for line in found if "pid.x" in line or "stepgen.0" in line or "cia402.x" in line]


def test_inverter_on_serial_line_leaves_analog_output_unused() -> None:
    vfd = 'driver = "vfd"\nvfd = { family = "delta-vfdb", port = "/dev/ttyUSB1", baud = 9600, parity = "N",'
    vfd += " stop = 2, hz_per_rpm = 0.01667 }\n"
    found = lines(changed(STEP, ('driver = "hal" ', f"{vfd}# "), ('speed_abs = "spindle-rpm-abs"\n', ""),
                          ('on = "spindle-on"\n', ""), ('reverse = "spindle-reverse"\n', "")))  # fmt: skip
    assert not [line for line in found if "spinout" in line]
    assert "setp hm2_7i76e.0.encoder.00.scale 4096" in found
