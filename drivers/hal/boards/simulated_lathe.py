"""HAL file of a lathe without hardware, with axes and spindle simulated by standard LinuxCNC components."""

from __future__ import annotations

from drivers.hal.boards.board_parts import c_turn_pins, load_simulated_c, simulated_c_speed
from drivers.hal.boards.hal_lines import HalFile, Lathe, Terminal, signal_of

_TRAILS = 0.67  # Fraction of the distance to its setpoint that an axis moves in one period.
_SWITCHES = 0.3  # Seconds for the collet to close and to open.


def simulated_lathe(lathe: Lathe) -> HalFile:
    """Build the HAL file with axes that lag their setpoints, a ramped spindle, and inputs set by hand."""
    file = HalFile(
        lathe,
        "lathe simulated with standard LinuxCNC components, without hardware",
        _terminal,
        "the name of a signal",
    )
    names = [axis.name.lower() for axis in lathe.driven]
    file.load(f"loadrt threads name1={lathe.thread} period1={lathe.period * 1e9:.0f}")
    file.load(f"loadrt lowpass names={','.join(f'{name}-servo' for name in names)}")
    file.load(f"loadrt mux2 names={','.join(f'{name}-motor' for name in names)}")
    file.load("loadrt limit2 names=spindle-ramp")
    file.load("loadrt scale names=spindle-rps")
    file.load("loadrt sim_spindle names=spindle")
    file.load("loadrt timedelay names=collet-switch")
    file.first += ["spindle-ramp", "spindle-rps", "spindle"]
    file.last += [f"{name}-{what}" for what in ("servo", "motor") for name in names] + ["collet-switch"]
    if lathe.c is not None:
        load_simulated_c(file)
    file.section(
        "Axes: each axis lags its setpoint by half of the distance that it travels in one "
        "period; an axis without power does not move"
    )
    for axis in lathe.driven:
        _slide(file, axis.name)
    file.enable(*(f"{name}-motor.sel" for name in names))
    _spindle(file)
    _hands(file)
    return file


def _terminal(name: str) -> Terminal | None:
    return Terminal(drives=False, place="collet's switch") if name == "collet-switch.out" else None


def _slide(file: HalFile, axis: str) -> None:
    name, path = axis.lower(), f"hal.axes.{axis}"
    file.setp(f"{name}-servo.gain", _TRAILS)
    file.role(f"{path}.command", f"{name}-pos-cmd", f"{name}-servo.in", needed=True)
    file.net(f"{name}-servo-out", f"{name}-servo.out", f"{name}-motor.in1")
    file.role(f"{path}.feedback", f"{name}-pos-fb", f"{name}-motor.out", f"{name}-motor.in0", needed=True)


def _spindle(file: HalFile) -> None:
    file.section("Spindle: ramped speed in rpm, speed in rev/s, position in revolutions")
    file.setp("spindle-ramp.maxv", file.lathe.rpm_accel, "rpm/s")
    file.setp("spindle-rps.gain", 1.0 / 60.0)
    file.setp("spindle.scale", 1.0)
    file.role("hal.spindle.speed", "spindle-rpm-cmd", "spindle-ramp.in")
    file.net("spindle-rpm", "spindle-ramp.out", "spindle-rps.in")
    file.role("hal.spindle.velocity", "spindle-rps", simulated_c_speed(file), "spindle.velocity-cmd")
    further = c_turn_pins(file)
    file.role("hal.spindle.position", "spindle-turns", "spindle.position-fb", *further)
    file.role("hal.spindle.index_enable", "spindle-index", "spindle.index-enable")


def _hands(file: HalFile) -> None:
    """Create inputs and outputs as signals; ``halcmd sets in-guard 1`` operates a switch."""
    file.section("Inputs and outputs are signals; to set a signal by hand: halcmd sets NAME 1")
    for path, name in file.lathe.names.items():
        if path.startswith(("io.", "hal.link_fault")) and "." not in name:
            file.signal(path, name)
    closed = [file.lathe.names.get(f"io.in.{name}", ".") for name in ("estop", "hold", "guard")]
    file.say("Contacts that are closed at startup: E-stop circuit, hold button, guard")
    file.sections[-1].lines.extend(f"sets {signal} 1" for signal in closed if "." not in signal)
    collet = file.lathe.names.get("io.out.collet", signal_of("io.out.collet"))
    if "io.out.collet" in file.lathe.names:
        file.say("The collet switch follows the collet valve; the collet is clamped at startup.")
        for delay in ("on-delay", "off-delay"):
            file.setp(f"collet-switch.{delay}", _SWITCHES)
        file.net(collet, "collet-switch.in")
        file.sections[-1].lines.append(f"sets {collet} 1")
    file.rest()
