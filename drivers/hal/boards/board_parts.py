"""C on the spindle's own drive in a HAL file: a pid around the spindle's encoder.

A drive that takes speeds (±10 V, EtherCAT) keeps taking them: of the spindle's command or, as C, of the pid.
One that takes steps beside its speed input is changed over by a terminal, and the pid speaks to its steps.
"""

from __future__ import annotations

from core.message import Message
from core.table_schema import Finding
from drivers.hal.boards.hal_lines import HalFile, LatheAxis

TURNS = "c-degrees.in"  # what the turns of the spindle's encoder go to, too
STAYS_BELOW = 1.5  # of C's own speed: a loop of the wrong sense must not run away at the spindle's
_CHOICE, _POWER, _PID = "c-or-speed", "spindle-power", "pid.c"
_PATH = "hal.spindle.position_mode"
_SIMULATED = 100.0  # 1/s, of a spindle that does what it is told


def turns(file: HalFile) -> tuple[str, ...]:
    """Further pins on the signal of the spindle's turns."""
    return (TURNS,) if file.lathe.c is not None else ()


def load(file: HalFile, *, chosen: bool) -> None:
    """Components, and where they are called: behind the encoder, and before what drives the spindle.

    ``chosen``: the spindle's speed and C go to the drive by one way.
    """
    file.instance("scale", "c-degrees")
    file.instance("pid", _PID)
    file.first.append("c-degrees")
    file.last.append(f"{_PID}.do-pid-calcs")
    if chosen:
        file.instance("scale", "c-rpm")
        file.instance("mux2", _CHOICE)
        file.instance("or2", _POWER)
        file.last += ["c-rpm", _CHOICE, _POWER]


def loop(file: HalFile, axis: LatheAxis, *drives: str) -> None:
    """The pid with what it reads, and the pins that take its speed, degrees/s."""
    board = file.lathe.board.axes.get(axis.name)
    file.setp("c-degrees.gain", 360, "degrees per revolution of the spindle encoder")
    gains = {"Pgain": _SIMULATED} if board is None else {
        "Pgain": board.p, "Igain": board.i, "Dgain": board.d, "FF0": 0.0, "FF2": board.ff2
    }  # fmt: skip
    for key, gain in gains.items():
        file.setp(f"{_PID}.{key}", gain)
    file.setp(f"{_PID}.FF1", 1.0, "FF1 = 1 passes the commanded speed through unchanged")
    file.setp(
        f"{_PID}.maxoutput",
        STAYS_BELOW * axis.vmax,
        "speed limit in degrees/s; also applies if a fault occurs",
    )
    file.setp(f"{_PID}.error-previous-target", 1)
    path = f"hal.axes.{axis.name}"
    file.role(f"{path}.command", "c-pos-cmd", f"{_PID}.command", needed=True)
    file.role(f"{path}.feedback", "c-pos-fb", "c-degrees.out", f"{_PID}.feedback", needed=True)
    file.net("c-speed", f"{_PID}.output", *drives)


def chosen_speed(file: HalFile, speed: str, on: str) -> tuple[str, str]:
    """The pins that take the spindle's speed, rpm, and enable: the drive's own, or where C is chosen."""
    axis = file.lathe.c
    if axis is None:
        return speed, on
    loop(file, axis, "c-rpm.in")
    file.setp("c-rpm.gain", 1.0 / 6.0, "converts degrees/s to rpm")
    file.net("c-rpm", "c-rpm.out", f"{_CHOICE}.in1")
    file.net("spindle-drive-rpm", f"{_CHOICE}.out", speed)
    file.net("spindle-drive-on", f"{_POWER}.out", on)
    file.role(_PATH, "spindle-is-c", f"{_CHOICE}.sel", f"{_POWER}.in1", f"{_PID}.enable", needed=True)
    return f"{_CHOICE}.in0", f"{_POWER}.in0"


def simulated(file: HalFile) -> str:
    """The simulated spindle turns as it is told or as C; the pin of the speed that it gets, turns/s."""
    axis = file.lathe.c
    if axis is None:
        return "spindle-rps.out"
    file.setp("c-rps.gain", 1.0 / 360.0)
    loop(file, axis, "c-rps.in")
    file.net("c-rps", "c-rps.out", f"{_CHOICE}.in1")
    file.net("spindle-rps-cmd", "spindle-rps.out", f"{_CHOICE}.in0")
    file.role(_PATH, "spindle-is-c", f"{_CHOICE}.sel", f"{_PID}.enable", needed=True)
    return f"{_CHOICE}.out"


def load_simulated(file: HalFile) -> None:
    """The components of that."""
    load(file, chosen=False)
    file.instance("scale", "c-rps")
    file.instance("mux2", _CHOICE)
    file.last += ["c-rps", _CHOICE]


def changed_over(file: HalFile) -> None:
    """The terminal that makes the drive listen to steps instead of its speed input."""
    name = file.lathe.names.get(_PATH, "")
    if "." not in name:
        why = Message(
            "expected {terminals}; connect this terminal to the drive input that switches the drive from "
            "speed mode to step mode",
            terminals=file.hint,
        )
        file.findings.append(Finding(_PATH, name, why))
    file.role(_PATH, "spindle-is-c", f"{_PID}.enable", needed=True)
