"""The HAL file of a step lathe on a Mesa 7I76E.

The file uses step generators, a spindle encoder, an analog spindle output and field I/O.
"""

from __future__ import annotations

import re

from drivers.hal.boards.board_parts import (
    CARD_NOTES,
    configure_c_position_loop,
    connect_drive_mode_terminal,
    connect_spindle_encoder,
    load_c_components,
    load_ethernet_card,
    load_pid_loops,
)
from drivers.hal.boards.hal_file_builder import BoardTerminal, HalFile, LatheAxis, LatheData

_CARD = "hm2_7i76e.0"
_FIELD = f"{_CARD}.7i76.0.0"  # Field I/O of the card, at the first smart serial port.
_PIN = re.compile(re.escape(_FIELD) + r"\.(input|output)-(\d\d)(-not)?")
_FIELD_ERRORS = 50  # Five failed transfers in a row.
_LATCHED_US = -50  # As in files of LinuxCNC's pncconf.
_FF1, _MOST_ERROR = 1.0, 0.0127  # Maximum error per period in mm (.0005 in).


def build_mesa_step_file(lathe: LatheData) -> HalFile:
    """Build the HAL file for the step generators of the card.

    With ``mode = "velocity"``, a pid component closes the position loop, as in Mesa's sample files.
    """
    hint = f"an input or output of the card: {_FIELD}.input-00 … -31, {_FIELD}.output-00 … -15"
    file = HalFile(lathe, "step drives on a Mesa 7I76E", _terminal, hint)
    file.pre_motion_checks += [
        *CARD_NOTES,
        (
            "step_ns, space_ns, setup_ns, hold_ns: use the values in the drive manual; a "
            "drive that misses step pulses does not report a fault"
        ),
        "spindle: full_speed is the spindle speed when the inverter input is at 10 V",
        (
            "firmware 7i76e_7i76x1D.bit, as delivered; to check it: mesaflash --device 7i76e "
            "--addr ADDRESS --readhmid"
        ),
    ]
    encoder = bool(lathe.encoder_pulses_per_rev and lathe.terminal_names.get("hal.spindle.position"))
    steps = 1 + max((board.channel for board in lathe.board_table.axes.values()), default=0)
    load_ethernet_card(
        file,
        _CARD,
        f"num_encoders={int(encoder)} num_pwmgens=0 num_stepgens={steps} sserial_port_0=0xxxxxxx",
        "field-lost.over",
    )
    _configure_field_io(file)
    _configure_timing(file)
    load_pid_loops(
        file,
        tuple(axis for axis in lathe.driven_axes if lathe.board_table.axes[axis.name].mode == "velocity"),
    )
    for axis in lathe.driven_axes:
        _axis(file, axis)
    if lathe.c_axis is not None:
        _connect_spindle_c(file, lathe.c_axis)
    file.start_section("Drive power")
    file.connect_enable_pins(*_enables(lathe))
    _connect_spindle(file)
    if encoder:
        connect_spindle_encoder(file, _CARD, "TB3 encoder")
    file.connect_remaining_terminals()
    file.last_function_calls.append(f"{_CARD}.write")
    return file


def _configure_field_io(file: HalFile) -> None:
    """Monitor the card's serial link to its field I/O, because its inputs freeze if transfers fail."""
    file.add_load_line("loadrt conv_u32_float names=field-errors")
    file.add_load_line("loadrt wcomp names=field-lost")
    file.first_function_calls[1:1] = ["field-errors", "field-lost"]
    file.start_section("Field I/O: the serial link to the card can fail while the card itself still works")
    file.connect_pins("field-error-count", f"{_CARD}.sserial.port-0.fault-count", "field-errors.in")
    file.connect_pins("field-error-level", "field-errors.out", "field-lost.in")
    file.set_pin("field-lost.min", -1)
    file.set_pin(
        "field-lost.max",
        _FIELD_ERRORS,
        "error counter: each failed transfer adds 10, each good transfer subtracts 1",
    )


def _configure_timing(file: HalFile) -> None:
    """Latch the step counts at a fixed time before they are read, independent of the Ethernet delay."""
    file.start_section(
        "Step counts: latched by the card's timer, so that Ethernet jitter does not appear as axis movement"
    )
    file.set_pin(
        f"{_CARD}.dpll.01.timer-us",
        _LATCHED_US,
        "time between latching and reading the step counts; must be longer than the worst-case delay",
    )
    file.set_pin(f"{_CARD}.stepgen.timer-number", 1)


def _terminal(name: str) -> BoardTerminal | None:
    found = _PIN.fullmatch(name)
    if (
        found is None
        or int(found[2]) > (31 if found[1] == "input" else 15)
        or (found[1] == "output" and found[3])
    ):
        return None
    kind, number = found[1], int(found[2])
    return BoardTerminal(
        is_output=kind == "output", printed_label=f"{_terminal_block(kind, number)} {kind.upper()}{number}"
    )


def _terminal_block(kind: str, number: int) -> str:
    """Return the terminal block of a field input or output, according to Mesa's manual of the 7I76."""
    return "TB6" if number < (16 if kind == "input" else 8) else "TB5"


def _enables(lathe: LatheData) -> list[str]:
    pins = []
    for axis in lathe.axes:
        board = lathe.board_table.axes[axis.name]
        own = axis is not lathe.c_axis and board.mode == "velocity"
        pins += [f"pid.{axis.name.lower()}.enable"] if own else []
        pins.append(f"{_CARD}.stepgen.{board.channel:02d}.enable")
    return pins


def _configure_steps(file: HalFile, axis: LatheAxis) -> str:
    """Configure the step generator of an axis, and return its pin."""
    board = file.lathe.board_table.axes[axis.name]
    pin = f"{_CARD}.stepgen.{board.channel:02d}"
    sign = -1.0 if board.reversed else 1.0
    file.set_pin(
        f"{pin}.position-scale", sign / axis.travel_per_count, f"steps per {axis.position_unit}: 1 / count"
    )
    for key, value in (
        ("steplen", "step"),
        ("stepspace", "space"),
        ("dirsetup", "setup"),
        ("dirhold", "hold"),
    ):
        file.set_pin(f"{pin}.{key}", getattr(board, f"{value}_ns"), "ns")
    file.set_pin(f"{pin}.step_type", 0, "step and direction")
    file.set_pin(
        f"{pin}.maxvel",
        1.5 * axis.max_velocity,
        "set this limit above the highest commanded velocity; if the limit takes effect, position is lost",
    )
    file.set_pin(f"{pin}.maxaccel", 2.5 * axis.max_acceleration)
    return pin


def _connect_spindle_c(file: HalFile, axis: LatheAxis) -> None:
    """Configure the C axis on the spindle drive, with step commands and spindle encoder feedback."""
    load_c_components(file, shares_input=False)
    file.start_section(
        f"C: step generator {file.lathe.board_table.axes[axis.name].channel} for the spindle drive, "
        "with feedback from the spindle encoder"
    )
    pin = _configure_steps(file, axis)
    file.set_pin(f"{pin}.control-type", 1)
    configure_c_position_loop(file, axis, f"{pin}.velocity-cmd")
    connect_drive_mode_terminal(file)


def _axis(file: HalFile, axis: LatheAxis) -> None:
    board, name = file.lathe.board_table.axes[axis.name], axis.name.lower()
    place = f"TB{2 if board.channel < 4 else 3} STEP{board.channel} DIR{board.channel}"
    file.start_section(f"Axis {axis.name}: step generator {board.channel}, {board.mode} mode")
    pin = _configure_steps(file, axis)
    if board.mode == "position":
        file.set_pin(f"{pin}.control-type", 0)
        file.connect_position_pins(axis.name, [f"{pin}.position-cmd"], [f"{pin}.position-fb"], place)
        return
    file.set_pin(f"{pin}.control-type", 1)
    file.set_pin(
        f"pid.{name}.Pgain",
        board.p or 1.0 / file.lathe.servo_period_s,
        "P gain in 1/s; corrects a position error within one period",
    )
    for key, gain in (
        ("Igain", board.i),
        ("Dgain", board.d),
        ("FF0", 0.0),
        ("FF1", _FF1),
        ("FF2", board.ff2),
    ):
        file.set_pin(f"pid.{name}.{key}", gain)
    file.set_pin(f"pid.{name}.maxerror", max(_MOST_ERROR, 2.0 * axis.travel_per_count), axis.position_unit)
    file.set_pin(f"pid.{name}.maxoutput", 1.5 * axis.max_velocity, f"{axis.position_unit}/s")
    file.set_pin(f"pid.{name}.error-previous-target", 1)
    measured = f"{pin}.position-fb", f"pid.{name}.feedback"
    file.connect_position_pins(axis.name, [f"pid.{name}.command"], measured, place)
    file.connect_pins(f"{name}-vel-cmd", f"pid.{name}.output", f"{pin}.velocity-cmd")


def _connect_spindle(file: HalFile) -> None:
    """Connect the isolated analog output of the spindle, with its enable and direction signals."""
    full = file.lathe.board_table.spindle.full_speed
    if not full:
        return
    file.start_section("Spindle: analog output 0…10 V, enable and direction of the 7I76E")
    file.set_pin(f"{_FIELD}.spinout-scalemax", full, "spindle speed at 10 V, in rpm")
    file.set_pin(f"{_FIELD}.spinout-minlim", 0)
    file.set_pin(f"{_FIELD}.spinout-maxlim", min(full, file.lathe.max_rpm), "rpm")
    file.connect_key_pins(
        "hal.spindle.speed_abs", "spindle-rpm-abs", f"{_FIELD}.spinout", label="TB4 SPINOUT", is_required=True
    )
    file.connect_key_pins(
        "hal.spindle.on", "spindle-on", f"{_FIELD}.spinena", label="TB4 SPINENA", is_required=True
    )
    file.connect_key_pins("hal.spindle.reverse", "spindle-reverse", f"{_FIELD}.spindir", label="TB4 SPINDIR")
