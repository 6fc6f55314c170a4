"""The HAL file of a ±10 V servo lathe on a Mesa 7I97.

The file uses encoders, pid components, analog outputs and isolated I/O.
"""

from __future__ import annotations

import re

from drivers.hal.boards.board_parts import (
    CARD_NOTES,
    configure_encoder,
    connect_spindle_encoder,
    get_spindle_command_pins,
    load_c_components,
    load_ethernet_card,
    load_pid_loops,
)
from drivers.hal.boards.hal_file_builder import C_AXIS, BoardTerminal, HalFile, LatheAxis, LatheData

_CARD = "hm2_7i97.0"
_INPUT_PATTERN = re.compile(re.escape(_CARD) + r"\.inmux\.00\.input-(\d\d)(-not)?")
_OUTPUT_PATTERN = re.compile(re.escape(_CARD) + r"\.ssr\.00\.out-(\d\d)")
# Terminals by their hm2_eth names: analog outputs, A inputs of the encoders, and solid-state relays.
_ANALOG = ("TB3-04", "TB3-08", "TB3-12", "TB3-16", "TB3-20", "TB3-24")
_ENCODERS = ("TB1-01", "TB1-09", "TB1-17", "TB2-01", "TB2-09", "TB2-17")
_RELAYS = ("TB5-13/14", "TB5-15/16", "TB5-17/18", "TB5-19/20", "TB5-21/22", "TB5-23/24")
_DEGREES_RPM = 6.0  # Degrees/s per rpm.
_PWM_HZ = 48_000  # Frequency of the analog outputs, as in Mesa's samples.


def build_mesa_servo_file(lathe: LatheData) -> HalFile:
    """Build the HAL file for ±10 V velocity drives, with encoder and pid position loops."""
    hint = f"an input or relay of the card: {_CARD}.inmux.00.input-00 … -15, {_CARD}.ssr.00.out-00 … -05"
    file = HalFile(lathe, "±10 V servo drives on a Mesa 7I97", _terminal, hint)
    file.pre_motion_checks += [
        *CARD_NOTES,
        (
            "check the direction with drive power off: turn the screw by hand; the position must "
            "increase when the axis moves in the plus direction. Switch drive power on for the "
            "first time with the belt off, because an axis with the wrong loop sign runs away"
        ),
        (
            "full_speed: enter the axis speed at 10 V. Increase p from 5 until the axis "
            "hums, then halve p. Set ff2 last, using the scope"
        ),
        (
            "drift: with only the P gain (p) set, adjust the balance of the drive at 0 V until "
            "the axis stays at rest"
        ),
    ]
    turns = bool(lathe.encoder_pulses_per_rev and lathe.terminal_names.get("hal.spindle.position"))
    spindle = lathe.board_table.spindle
    channels = [board.channel for board in lathe.board_table.axes.values()] + [spindle.channel]
    encoders = 1 + max((*channels[:-1], spindle.encoder if turns else -1))
    load_ethernet_card(file, _CARD, f"num_encoders={encoders} num_pwmgens={1 + max(channels)} num_stepgens=0")
    load_pid_loops(file, lathe.driven_axes)
    if lathe.c_axis is not None:
        load_c_components(file, shares_input=True)
    file.start_section("Analog outputs")
    file.set_pin(f"{_CARD}.pwmgen.pwm_frequency", _PWM_HZ)
    for axis in lathe.driven_axes:
        _axis(file, axis)
    file.start_section("Drive power: analog outputs 0 to 3 share one enable signal")
    file.connect_enable_pins(*_enables(lathe))
    if spindle.full_speed:
        _speed(file)
    if turns:
        connect_spindle_encoder(
            file, _CARD, f"encoder {spindle.encoder} (signal A at {_ENCODERS[spindle.encoder]})"
        )
    file.connect_remaining_terminals()
    file.last_function_calls.append(f"{_CARD}.write")
    return file


def _terminal(name: str) -> BoardTerminal | None:
    if (found := _INPUT_PATTERN.fullmatch(name)) and int(found[1]) < 16:
        return BoardTerminal(is_output=False, printed_label=f"INPUT{int(found[1])}")
    if (found := _OUTPUT_PATTERN.fullmatch(name)) and int(found[1]) < len(_RELAYS):
        return BoardTerminal(is_output=True, printed_label=_RELAYS[int(found[1])])
    return None


def _enables(lathe: LatheData) -> list[str]:
    pids = [f"pid.{axis.name.lower()}.enable" for axis in lathe.driven_axes]
    # Channel 0 enables channels 0…3.
    channels = sorted({0, *(lathe.board_table.axes[axis.name].channel for axis in lathe.driven_axes)})
    return pids + [f"{_CARD}.pwmgen.{channel:02d}.enable" for channel in channels]


def _analog(file: HalFile, pin: str, full: float, what: str) -> None:
    file.set_pin(f"{pin}.output-type", 1, "pulse-width modulation on one pin")
    file.set_pin(f"{pin}.offset-mode", 1, "a duty cycle of 50 % is 0 V")
    file.set_pin(f"{pin}.scale", full, what)


def _axis(file: HalFile, axis: LatheAxis) -> None:
    board, name = file.lathe.board_table.axes[axis.name], axis.name.lower()
    out, counter, pid = (
        f"{_CARD}.pwmgen.{board.channel:02d}",
        f"{_CARD}.encoder.{board.channel:02d}",
        f"pid.{name}",
    )
    place = f"{_ANALOG[board.channel]}, encoder {board.channel} (signal A at {_ENCODERS[board.channel]})"
    file.start_section(f"Axis {axis.name}: analog output and encoder {board.channel}")
    full = _DEGREES_RPM * board.full_rpm if axis.name == C_AXIS else board.full_speed
    _analog(file, out, full, f"{axis.position_unit}/s at 10 V")
    sign = -1.0 if board.reversed else 1.0
    configure_encoder(
        file, counter, sign / axis.travel_per_count, f"counts per {axis.position_unit}: 1 / count"
    )
    for key, value in (("Pgain", board.p), ("Igain", board.i), ("Dgain", board.d), ("FF0", 0.0)):
        file.set_pin(f"{pid}.{key}", value)
    file.set_pin(f"{pid}.FF1", 1.0, "FF1 = 1 passes the commanded speed through unchanged")
    file.set_pin(f"{pid}.FF2", board.ff2)
    file.set_pin(f"{pid}.maxoutput", full, f"{axis.position_unit}/s: 10 V")
    file.set_pin(f"{pid}.error-previous-target", 1)
    file.connect_position_pins(
        axis.name, [f"{pid}.command"], [f"{counter}.position", f"{pid}.feedback"], place
    )
    index = f"hal.axes.{axis.name}.index_enable"
    file.connect_key_pins(
        index, f"{name}-index", f"{counter}.index-enable", f"{pid}.index-enable", label=place
    )
    file.connect_pins(f"{name}-output", f"{pid}.output", f"{out}.value")


def _speed(file: HalFile) -> None:
    board = file.lathe.board_table.spindle
    pin, place = f"{_CARD}.pwmgen.{board.channel:02d}", _ANALOG[board.channel]
    file.start_section(f"Spindle: analog output {board.channel}")
    _analog(file, pin, board.full_speed, "spindle speed at 10 V, in rpm")
    speed = "speed" if file.lathe.terminal_names.get("hal.spindle.speed") else "speed_abs"
    value, enable = get_spindle_command_pins(file, f"{pin}.value", f"{pin}.enable")
    file.connect_key_pins(f"hal.spindle.{speed}", "spindle-rpm-cmd", value, label=place, is_required=True)
    file.connect_key_pins(
        "hal.spindle.on", "spindle-on", enable, label=f"enable of {place}", is_required=True
    )
