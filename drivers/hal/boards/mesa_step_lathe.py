"""HAL file of a step lathe on a Mesa 7I76E: step generators, spindle encoder, analog spindle, field I/O."""

from __future__ import annotations

import re

from drivers.hal.boards.board_parts import (
    NOTES,
    change_over_to_c,
    close_c_loop,
    load_c,
    load_card,
    load_pid,
    spindle_encoder,
)
from drivers.hal.boards.hal_lines import HalFile, Lathe, LatheAxis, Terminal

_CARD = "hm2_7i76e.0"
_FIELD = f"{_CARD}.7i76.0.0"  # Field I/O of the card, at the first smart serial port.
_PIN = re.compile(re.escape(_FIELD) + r"\.(input|output)-(\d\d)(-not)?")
_FIELD_ERRORS = 50  # Five failed transfers in a row.
_LATCHED_US = -50  # As in files of LinuxCNC's pncconf.
_FF1, _MOST_ERROR = 1.0, 0.0127  # Maximum error per period in mm (.0005 in).


def mesa_step_lathe(lathe: Lathe) -> HalFile:
    """Build the HAL file for step generators of the card.

    ``mode = "velocity"`` closes the position loop by a pid, as Mesa's samples do.
    """
    hint = f"an input or output of the card: {_FIELD}.input-00 … -31, {_FIELD}.output-00 … -15"
    file = HalFile(lathe, "step drives on a Mesa 7I76E", _terminal, hint)
    file.notes += [
        *NOTES,
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
    encoder = bool(lathe.encoder_lines and lathe.names.get("hal.spindle.position"))
    steps = 1 + max((board.channel for board in lathe.board.axes.values()), default=0)
    load_card(
        file,
        _CARD,
        f"num_encoders={int(encoder)} num_pwmgens=0 num_stepgens={steps} sserial_port_0=0xxxxxxx",
        "field-lost.over",
    )
    _field(file)
    _timing(file)
    load_pid(file, tuple(axis for axis in lathe.driven if lathe.board.axes[axis.name].mode == "velocity"))
    for axis in lathe.driven:
        _axis(file, axis)
    if lathe.c is not None:
        _spindle_c(file, lathe.c)
    file.section("Drive power")
    file.enable(*_enables(lathe))
    _speed(file)
    if encoder:
        spindle_encoder(file, _CARD, "TB3 encoder")
    file.rest()
    file.last.append(f"{_CARD}.write")
    return file


def _field(file: HalFile) -> None:
    """Monitor the serial link to the field I/O, whose inputs also freeze if transfers fail."""
    file.load("loadrt conv_u32_float names=field-errors")
    file.load("loadrt wcomp names=field-lost")
    file.first[1:1] = ["field-errors", "field-lost"]
    file.section("Field I/O: the serial link to the card can fail while the card itself still works")
    file.net("field-error-count", f"{_CARD}.sserial.port-0.fault-count", "field-errors.in")
    file.net("field-error-level", "field-errors.out", "field-lost.in")
    file.setp("field-lost.min", -1)
    file.setp(
        "field-lost.max",
        _FIELD_ERRORS,
        "error counter: each failed transfer adds 10, each good transfer subtracts 1",
    )


def _timing(file: HalFile) -> None:
    """Latch the step counts at a fixed time before the read, independent of the Ethernet delay."""
    file.section(
        "Step counts: latched by the card's timer, so that Ethernet jitter does not appear as axis movement"
    )
    file.setp(
        f"{_CARD}.dpll.01.timer-us",
        _LATCHED_US,
        "time between latching and reading the step counts; must be longer than the worst-case delay",
    )
    file.setp(f"{_CARD}.stepgen.timer-number", 1)


def _terminal(name: str) -> Terminal | None:
    found = _PIN.fullmatch(name)
    if (
        found is None
        or int(found[2]) > (31 if found[1] == "input" else 15)
        or (found[1] == "output" and found[3])
    ):
        return None
    kind, number = found[1], int(found[2])
    return Terminal(drives=kind == "output", place=f"{_block(kind, number)} {kind.upper()}{number}")


def _block(kind: str, number: int) -> str:
    """Return the terminal block of a field input or output, according to Mesa's manual of the 7I76."""
    return "TB6" if number < (16 if kind == "input" else 8) else "TB5"


def _enables(lathe: Lathe) -> list[str]:
    pins = []
    for axis in lathe.axes:
        board = lathe.board.axes[axis.name]
        own = axis is not lathe.c and board.mode == "velocity"
        pins += [f"pid.{axis.name.lower()}.enable"] if own else []
        pins.append(f"{_CARD}.stepgen.{board.channel:02d}.enable")
    return pins


def _steps(file: HalFile, axis: LatheAxis) -> str:
    """Configure the step generator of an axis and return its pin."""
    board = file.lathe.board.axes[axis.name]
    pin = f"{_CARD}.stepgen.{board.channel:02d}"
    sign = -1.0 if board.reversed else 1.0
    file.setp(f"{pin}.position-scale", sign / axis.count, f"steps per {axis.unit}: 1 / count")
    for key, value in (
        ("steplen", "step"),
        ("stepspace", "space"),
        ("dirsetup", "setup"),
        ("dirhold", "hold"),
    ):
        file.setp(f"{pin}.{key}", getattr(board, f"{value}_ns"), "ns")
    file.setp(f"{pin}.step_type", 0, "step and direction")
    file.setp(
        f"{pin}.maxvel",
        1.5 * axis.vmax,
        "set this limit above the highest commanded velocity; if the limit takes effect, position is lost",
    )
    file.setp(f"{pin}.maxaccel", 2.5 * axis.amax)
    return pin


def _spindle_c(file: HalFile, axis: LatheAxis) -> None:
    """Configure C on the spindle drive: step commands, with the spindle encoder as feedback."""
    load_c(file, chosen=False)
    file.section(
        f"C: step generator {file.lathe.board.axes[axis.name].channel} for the spindle drive, "
        "with feedback from the spindle encoder"
    )
    pin = _steps(file, axis)
    file.setp(f"{pin}.control-type", 1)
    close_c_loop(file, axis, f"{pin}.velocity-cmd")
    change_over_to_c(file)


def _axis(file: HalFile, axis: LatheAxis) -> None:
    board, name = file.lathe.board.axes[axis.name], axis.name.lower()
    place = f"TB{2 if board.channel < 4 else 3} STEP{board.channel} DIR{board.channel}"
    file.section(f"Axis {axis.name}: step generator {board.channel}, {board.mode} mode")
    pin = _steps(file, axis)
    if board.mode == "position":
        file.setp(f"{pin}.control-type", 0)
        file.positions(axis.name, [f"{pin}.position-cmd"], [f"{pin}.position-fb"], place)
        return
    file.setp(f"{pin}.control-type", 1)
    file.setp(
        f"pid.{name}.Pgain",
        board.p or 1.0 / file.lathe.period,
        "P gain in 1/s; corrects a position error within one period",
    )
    for key, gain in (
        ("Igain", board.i),
        ("Dgain", board.d),
        ("FF0", 0.0),
        ("FF1", _FF1),
        ("FF2", board.ff2),
    ):
        file.setp(f"pid.{name}.{key}", gain)
    file.setp(f"pid.{name}.maxerror", max(_MOST_ERROR, 2.0 * axis.count), axis.unit)
    file.setp(f"pid.{name}.maxoutput", 1.5 * axis.vmax, f"{axis.unit}/s")
    file.setp(f"pid.{name}.error-previous-target", 1)
    measured = f"{pin}.position-fb", f"pid.{name}.feedback"
    file.positions(axis.name, [f"pid.{name}.command"], measured, place)
    file.net(f"{name}-vel-cmd", f"pid.{name}.output", f"{pin}.velocity-cmd")


def _speed(file: HalFile) -> None:
    """Connect the isolated analog output with its enable and direction."""
    full = file.lathe.board.spindle.full_speed
    if not full:
        return
    file.section("Spindle: analog output 0…10 V, enable and direction of the 7I76E")
    file.setp(f"{_FIELD}.spinout-scalemax", full, "spindle speed at 10 V, in rpm")
    file.setp(f"{_FIELD}.spinout-minlim", 0)
    file.setp(f"{_FIELD}.spinout-maxlim", min(full, file.lathe.rpm_max), "rpm")
    file.role(
        "hal.spindle.speed_abs", "spindle-rpm-abs", f"{_FIELD}.spinout", place="TB4 SPINOUT", needed=True
    )
    file.role("hal.spindle.on", "spindle-on", f"{_FIELD}.spinena", place="TB4 SPINENA", needed=True)
    file.role("hal.spindle.reverse", "spindle-reverse", f"{_FIELD}.spindir", place="TB4 SPINDIR")
