"""Parts of HAL files that several boards share: C on the spindle's own drive, and Mesa's Ethernet cards.

For C a pid acts around the spindle's encoder. A drive that takes speeds (±10 V, EtherCAT) keeps taking them:
of the spindle's command or, as C, of the pid. One that takes steps beside its speed input is changed over by
a terminal, and the pid speaks to its steps.

Mesa's cards share hm2_eth, its watchdog, encoders and pid.
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


def c_turn_pins(file: HalFile) -> tuple[str, ...]:
    """Further pins on the signal of the spindle's turns."""
    return (TURNS,) if file.lathe.c is not None else ()


def load_c(file: HalFile, *, chosen: bool) -> None:
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


def close_c_loop(file: HalFile, axis: LatheAxis, *drives: str) -> None:
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
    file.positions(axis.name, [f"{_PID}.command"], ["c-degrees.out", f"{_PID}.feedback"])
    file.net("c-speed", f"{_PID}.output", *drives)


def c_speed_pins(file: HalFile, speed: str, on: str) -> tuple[str, str]:
    """The pins that take the spindle's speed, rpm, and enable: the drive's own, or where C is chosen."""
    axis = file.lathe.c
    if axis is None:
        return speed, on
    close_c_loop(file, axis, "c-rpm.in")
    file.setp("c-rpm.gain", 1.0 / 6.0, "converts degrees/s to rpm")
    file.net("c-rpm", "c-rpm.out", f"{_CHOICE}.in1")
    file.net("spindle-drive-rpm", f"{_CHOICE}.out", speed)
    file.net("spindle-drive-on", f"{_POWER}.out", on)
    file.role(_PATH, "spindle-is-c", f"{_CHOICE}.sel", f"{_POWER}.in1", f"{_PID}.enable", needed=True)
    return f"{_CHOICE}.in0", f"{_POWER}.in0"


def simulated_c_speed(file: HalFile) -> str:
    """The simulated spindle turns as it is told or as C; the pin of the speed that it gets, turns/s."""
    axis = file.lathe.c
    if axis is None:
        return "spindle-rps.out"
    file.setp("c-rps.gain", 1.0 / 360.0)
    close_c_loop(file, axis, "c-rps.in")
    file.net("c-rps", "c-rps.out", f"{_CHOICE}.in1")
    file.net("spindle-rps-cmd", "spindle-rps.out", f"{_CHOICE}.in0")
    file.role(_PATH, "spindle-is-c", f"{_CHOICE}.sel", f"{_PID}.enable", needed=True)
    return f"{_CHOICE}.out"


def load_simulated_c(file: HalFile) -> None:
    """The components of that."""
    load_c(file, chosen=False)
    file.instance("scale", "c-rps")
    file.instance("mux2", _CHOICE)
    file.last += ["c-rps", _CHOICE]


def change_over_to_c(file: HalFile) -> None:
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


# --- Mesa's Ethernet cards.


_WATCHDOG = 5_000_000  # ns without a word of this computer until the card lets everything fall
NOTES = (
    (
        "use a real-time kernel and a separate network port for the card; test halrun on its "
        "own: it must maintain a 1 ms period for an hour"
    ),
    "axis.NAME.count: check this value against a dial gauge over a 10 mm jog; X positions are radii",
    (
        "E-stop must remove drive power directly; the card's watchdog acts only when the computer "
        "sends nothing"
    ),
)


def load_card(file: HalFile, card: str, config: str, *further: str) -> None:
    """Load hostmot2 on Ethernet: read first in the thread, written last.

    ``further`` pins report that inputs of the card are not current.
    """
    lathe = file.lathe
    file.load(f"loadrt threads name1={lathe.thread} period1={lathe.period * 1e9:.0f}")
    file.load("loadrt hostmot2")
    address = f'board_ip="{lathe.board.address}" ' if lathe.board.address else ""
    file.load(f'loadrt hm2_eth {address}config="{config}"')
    file.first.append(f"{card}.read")
    file.section("Watchdog: the card turns all outputs off when it receives nothing from the computer")
    file.setp(f"{card}.watchdog.timeout_ns", _WATCHDOG)
    _link(file, card, further)


def _link(file: HalFile, card: str, further: tuple[str, ...]) -> None:
    """Report a lost card: hm2_eth keeps every input as it was, and no longer reads the watchdog.

    hm2_eth sets the parameter ``io_error`` together with the pin ``packet-error-exceeded``, which stays on
    until the driver is loaded again.
    """
    gates = _drive_faults(file)
    silent = f"{card}.packet-error-exceeded", f"{card}.watchdog.has_bit"
    file.link("or", *silent, *further, further=tuple(f"{gate}.in0" for gate in gates))
    file.first += gates


def _drive_faults(file: HalFile) -> list[str]:
    """Wire hal.axes.X.fault where it is a signal: a drive fault or the lost card. Return its gates."""
    gates = []
    for axis in file.lathe.axes:
        path = f"hal.axes.{axis.name}.fault"
        if "." in file.lathe.names.get(path, "."):
            continue  # not configured, or a terminal
        gate, wired = f"{axis.name.lower()}-fault-or", file.lathe.board.axes[axis.name].fault_input
        gates.append(gate)
        if wired:
            key = f"board.axis.{axis.name}.fault_input"
            file.at_terminal(key, f"{axis.name.lower()}-drive-fault", wired, f"{gate}.in1", drives=False)
        file.role(path, f"{axis.name.lower()}-fault", f"{gate}.out")
    if gates:
        file.load(f"loadrt or2 names={','.join(gates)}", "drive fault or lost connection to the card")
    return gates


def load_pid(file: HalFile, axes: tuple[LatheAxis, ...]) -> None:
    """One ``pid`` an axis; it is called behind the setpoints."""
    names = [f"pid.{axis.name.lower()}" for axis in axes]
    if names:
        file.load(f"loadrt pid names={','.join(names)}")
        file.last += [f"{name}.do-pid-calcs" for name in names]


def encoder(file: HalFile, pin: str, counts: float, what: str) -> None:
    """A quadrature encoder with its filter on."""
    file.setp(f"{pin}.scale", counts, what)
    for key in ("counter-mode", "index-invert", "index-mask"):
        file.setp(f"{pin}.{key}", 0)
    file.setp(f"{pin}.filter", 1)


def spindle_encoder(file: HalFile, card: str, place: str) -> None:
    """Turns, speed and index of the spindle."""
    board = file.lathe.board.spindle
    pin = f"{card}.encoder.{board.encoder:02d}"
    file.section(f"Spindle: encoder {board.encoder}")
    counts = 4 * file.lathe.encoder_lines * (-1 if board.reversed else 1)
    encoder(file, pin, counts, "counts per revolution: 4 x encoder lines; the position increases with M03")
    file.role("hal.spindle.position", "spindle-turns", f"{pin}.position", *c_turn_pins(file), place=place)
    file.role("hal.spindle.velocity", "spindle-rps", f"{pin}.velocity", place=place)
    file.role("hal.spindle.index_enable", "spindle-index", f"{pin}.index-enable", place=place)
