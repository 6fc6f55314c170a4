"""The HAL file of a lathe with step and direction signals on a parallel port.

The file uses software step generators and a software encoder.
"""

from __future__ import annotations

import re

from drivers.hal.boards.board_parts import (
    configure_c_position_loop,
    connect_drive_mode_terminal,
    get_c_revolution_pins,
    load_c_components,
)
from drivers.hal.boards.hal_file_builder import BoardTerminal, HalFile, LatheAxis, LatheData

_PIN = re.compile(r"parport\.0\.pin-(\d\d)-(in|in-not|out)")
_OUTPUT_PINS = frozenset(("01", "02", "03", "04", "05", "06", "07", "08", "09", "14", "16", "17"))
_INPUT_PINS = frozenset(("10", "11", "12", "13", "15"))


def build_parallel_port_file(lathe: LatheData) -> HalFile:
    """Build the HAL file with software step generators, software encoder and PWM speed signal."""
    hint = (
        "a parallel port pin: parport.0.pin-02-out … -09-out, -01-out, -14-out, -16-out or "
        "-17-out; parport.0.pin-10-in … -13-in or -15-in"
    )
    file = HalFile(lathe, "step and direction on a parallel port", _terminal, hint)
    file.pre_motion_checks += [
        (
            "run latency-test: the base period must be longer than the worst latency; a "
            "real-time kernel is required"
        ),
        ("axis.NAME.count: check this value against a dial gauge over a 10 mm jog; X positions are radii"),
        (
            "pulse times: use the values in the drive manual; if the direction signal changes "
            "too late, a step is lost at each reversal"
        ),
        (
            "E-stop must remove drive power directly, because the port gives no signal when this "
            "computer hangs"
        ),
    ]
    encoder = bool(lathe.encoder_pulses_per_rev and lathe.terminal_names.get("hal.spindle.position"))
    _load(file, encoder=encoder)
    for channel, axis in enumerate(lathe.axes):
        _axis(file, channel, axis)
    if lathe.c_axis is not None:
        connect_drive_mode_terminal(file)
    file.start_section("Drive power")
    file.connect_enable_pins(*(f"stepgen.{channel}.enable" for channel in range(len(lathe.axes))))
    if lathe.board_table.spindle.pwm:
        _speed(file)
    if encoder:
        _encoder(file)
    file.connect_remaining_terminals()
    return file


def _load(file: HalFile, *, encoder: bool) -> None:
    lathe, axes = file.lathe, file.lathe.axes
    pwm = bool(lathe.board_table.spindle.pwm)
    threads = f"name1=base-thread fp1=0 period1={lathe.board_table.base_us * 1000}"
    file.add_load_line(
        f"loadrt threads {threads} name2={lathe.servo_thread} period2={lathe.servo_period_s * 1e9:.0f}"
    )
    file.add_load_line(
        f'loadrt hal_parport cfg="{lathe.board_table.address or "0x378"} out"',
        "parallel port pins 2 to 9 are outputs",
    )
    kinds = ["v" if axis is lathe.c_axis else "p" for axis in axes]
    file.add_load_line(f"loadrt stepgen step_type={','.join('0' * len(axes))} ctrl_type={','.join(kinds)}")
    if encoder:
        file.add_load_line("loadrt encoder num_chan=1")
    if pwm:
        file.add_load_line("loadrt pwmgen output_type=0")
    file.base_thread_calls += ["parport.0.read", "stepgen.make-pulses"]
    file.base_thread_calls += ["encoder.update-counters"] * encoder + ["pwmgen.make-pulses"] * pwm
    file.base_thread_calls += ["parport.0.write", "parport.0.reset"]
    file.first_function_calls += ["stepgen.capture-position", *["encoder.capture-position"] * encoder]
    if lathe.c_axis is not None:
        load_c_components(file, shares_input=False)
    file.last_function_calls += ["stepgen.update-freq", *["pwmgen.update"] * pwm]


def _terminal(name: str) -> BoardTerminal | None:
    found = _PIN.fullmatch(name)
    if found is None or found[1] not in (_OUTPUT_PINS if found[2] == "out" else _INPUT_PINS):
        return None
    return BoardTerminal(is_output=found[2] == "out", printed_label=f"DB25 pin {int(found[1])}")


def _axis(file: HalFile, channel: int, axis: LatheAxis) -> None:
    board, name = file.lathe.board_table.axes[axis.name], axis.name.lower()
    pin = f"stepgen.{channel}"
    file.start_section(f"Axis {axis.name}: step generator {channel}")
    sign = -1.0 if board.reversed else 1.0
    file.set_pin(
        f"{pin}.position-scale", sign / axis.travel_per_count, f"steps per {axis.position_unit}: 1 / count"
    )
    file.set_pin(
        f"{pin}.maxvel",
        1.5 * axis.max_velocity,
        "set this limit above the highest commanded velocity; if the limit takes effect, position is lost",
    )
    file.set_pin(f"{pin}.maxaccel", 2.5 * axis.max_acceleration)
    file.set_pin(
        f"{pin}.steplen",
        1,
        "step pulse length in ns, rounded up to one base period; parport.reset ends the step pulse",
    )
    file.set_pin(f"{pin}.stepspace", 0)
    file.set_pin(f"{pin}.dirsetup", board.setup_ns)
    file.set_pin(f"{pin}.dirhold", board.hold_ns)
    if axis is file.lathe.c_axis:
        file.add_comment(
            "after the switch to step mode, the spindle drive follows these step pulses; the "
            "spindle encoder reports the spindle position"
        )
        configure_c_position_loop(file, axis, f"{pin}.velocity-cmd")
    else:
        file.connect_position_pins(axis.name, [f"{pin}.position-cmd"], [f"{pin}.position-fb"])
    for what, port in (("step", board.step), ("dir", board.direction)):
        file.connect_terminal(
            f"board.axis.{axis.name}.{'step' if what == 'step' else 'direction'}",
            f"{name}-{what}",
            port,
            f"{pin}.{what}",
        )
    if _terminal(board.step) is not None:
        file.set_pin(f"{board.step}-reset", 1, "the step pulse ends within the base period")
        file.set_pin("parport.0.reset-time", board.step_ns)


def _speed(file: HalFile) -> None:
    board = file.lathe.board_table.spindle
    file.start_section("Spindle: PWM speed signal, which a converter changes to 0…10 V")
    file.set_pin("pwmgen.0.scale", board.full_speed, "spindle speed at 10 V, in rpm")
    file.set_pin("pwmgen.0.pwm-freq", board.pwm_hz, "Hz")
    file.connect_key_pins("hal.spindle.speed_abs", "spindle-rpm-abs", "pwmgen.0.value", is_required=True)
    file.connect_key_pins("hal.spindle.on", "spindle-on", "pwmgen.0.enable", is_required=True)
    file.connect_terminal("board.spindle.pwm", "spindle-pwm", board.pwm, "pwmgen.0.pwm")


def _encoder(file: HalFile) -> None:
    board = file.lathe.board_table.spindle
    file.start_section("Spindle encoder")
    counts = 4 * file.lathe.encoder_pulses_per_rev * (-1 if board.reversed else 1)
    file.set_pin("encoder.0.position-scale", counts, "counts per revolution: 4 x encoder lines")
    for phase, port in (("A", board.phase_a), ("B", board.phase_b), ("Z", board.phase_z)):
        if port:
            key = f"board.spindle.phase_{phase.lower()}"
            file.connect_terminal(
                key, f"spindle-{phase.lower()}", port, f"encoder.0.phase-{phase}", is_output=False
            )
    file.connect_key_pins(
        "hal.spindle.position", "spindle-turns", "encoder.0.position", *get_c_revolution_pins(file)
    )
    file.connect_key_pins("hal.spindle.velocity", "spindle-rps", "encoder.0.velocity")
    if board.phase_z:
        file.connect_key_pins("hal.spindle.index_enable", "spindle-index", "encoder.0.index-enable")
