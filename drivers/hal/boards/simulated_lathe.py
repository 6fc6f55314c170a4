"""The HAL file of a lathe without hardware.

Standard LinuxCNC components simulate the axes and the spindle.
"""

from __future__ import annotations

from drivers.hal.boards.board_parts import (
    get_c_revolution_pins,
    get_simulated_speed_pin,
    load_simulated_c_components,
)
from drivers.hal.boards.hal_file_builder import BoardTerminal, HalFile, LatheData, get_signal_name

_FOLLOWING_FRACTION = 0.67  # Fraction of the distance to its setpoint that an axis moves in one period.
_SWITCHES = 0.3  # Seconds for the collet to close and to open.


def build_simulated_file(lathe: LatheData) -> HalFile:
    """Build a HAL file without hardware, in which the axes lag their setpoints and the spindle ramps.

    Inputs are set manually.
    """
    file = HalFile(
        lathe,
        "lathe simulated with standard LinuxCNC components, without hardware",
        _terminal,
        "the name of a signal",
    )
    names = [axis.name.lower() for axis in lathe.driven_axes]
    file.add_load_line(f"loadrt threads name1={lathe.servo_thread} period1={lathe.servo_period_s * 1e9:.0f}")
    file.add_load_line(f"loadrt lowpass names={','.join(f'{name}-servo' for name in names)}")
    file.add_load_line(f"loadrt mux2 names={','.join(f'{name}-motor' for name in names)}")
    file.add_load_line("loadrt limit2 names=spindle-ramp")
    file.add_load_line("loadrt scale names=spindle-rps")
    file.add_load_line("loadrt sim_spindle names=spindle")
    file.add_load_line("loadrt timedelay names=collet-switch")
    file.first_function_calls += ["spindle-ramp", "spindle-rps", "spindle"]
    file.last_function_calls += [f"{name}-{what}" for what in ("servo", "motor") for name in names] + [
        "collet-switch"
    ]
    if lathe.c_axis is not None:
        load_simulated_c_components(file)
    file.start_section(
        "Axes: each axis lags its setpoint by half of the distance that it travels in one "
        "period; an axis without power does not move"
    )
    for axis in lathe.driven_axes:
        _slide(file, axis.name)
    file.connect_enable_pins(*(f"{name}-motor.sel" for name in names))
    _spindle(file)
    _add_manual_signals(file)
    return file


def _terminal(name: str) -> BoardTerminal | None:
    return (
        BoardTerminal(is_output=False, printed_label="collet's switch")
        if name == "collet-switch.out"
        else None
    )


def _slide(file: HalFile, axis: str) -> None:
    name, path = axis.lower(), f"hal.axes.{axis}"
    file.set_pin(f"{name}-servo.gain", _FOLLOWING_FRACTION)
    file.connect_key_pins(f"{path}.command", f"{name}-pos-cmd", f"{name}-servo.in", is_required=True)
    file.connect_pins(f"{name}-servo-out", f"{name}-servo.out", f"{name}-motor.in1")
    file.connect_key_pins(
        f"{path}.feedback", f"{name}-pos-fb", f"{name}-motor.out", f"{name}-motor.in0", is_required=True
    )


def _spindle(file: HalFile) -> None:
    file.start_section("Spindle: ramped speed in rpm, speed in rev/s, position in revolutions")
    file.set_pin("spindle-ramp.maxv", file.lathe.acceleration_rpm_per_s, "rpm/s")
    file.set_pin("spindle-rps.gain", 1.0 / 60.0)
    file.set_pin("spindle.scale", 1.0)
    file.connect_key_pins("hal.spindle.speed", "spindle-rpm-cmd", "spindle-ramp.in")
    file.connect_pins("spindle-rpm", "spindle-ramp.out", "spindle-rps.in")
    file.connect_key_pins(
        "hal.spindle.velocity", "spindle-rps", get_simulated_speed_pin(file), "spindle.velocity-cmd"
    )
    further = get_c_revolution_pins(file)
    file.connect_key_pins("hal.spindle.position", "spindle-turns", "spindle.position-fb", *further)
    file.connect_key_pins("hal.spindle.index_enable", "spindle-index", "spindle.index-enable")


def _add_manual_signals(file: HalFile) -> None:
    """Create a signal for each input and output, which replaces the wiring.

    For example, ``halcmd sets in-guard 1`` operates a switch.
    """
    file.start_section("Inputs and outputs are signals; to set a signal by hand: halcmd sets NAME 1")
    for path, name in file.lathe.terminal_names.items():
        if path.startswith(("io.", "hal.link_fault")) and "." not in name:
            file.add_unconnected_signal(path, name)
    closed = [file.lathe.terminal_names.get(f"io.in.{name}", ".") for name in ("estop", "hold", "guard")]
    file.add_comment("Contacts that are closed at startup: E-stop circuit, hold button, guard")
    file.sections[-1].lines.extend(f"sets {signal} 1" for signal in closed if "." not in signal)
    collet = file.lathe.terminal_names.get("io.out.collet", get_signal_name("io.out.collet"))
    if "io.out.collet" in file.lathe.terminal_names:
        file.add_comment("The collet switch follows the collet valve; the collet is clamped at startup.")
        for delay in ("on-delay", "off-delay"):
            file.set_pin(f"collet-switch.{delay}", _SWITCHES)
        file.connect_pins(collet, "collet-switch.in")
        file.sections[-1].lines.append(f"sets {collet} 1")
    file.connect_remaining_terminals()
