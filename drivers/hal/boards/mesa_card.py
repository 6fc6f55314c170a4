"""What the HAL files of Mesa's Ethernet cards share: hm2_eth, its watchdog, encoders, pid."""

from __future__ import annotations

from drivers.hal.boards.hal_lines import HalFile, LatheAxis
from drivers.hal.boards.spindle_as_c import turns

_WATCHDOG = 5_000_000  # ns without a word of this computer until the card lets everything fall
NOTES = (
    "a real-time kernel and a network port of the card's own; halrun alone must hold 1 ms for an hour",
    "axis.….count: dial gauge against 10 mm of jog; X counts on the radius",
    "E-stop must take the drives' power itself; the card's watchdog only ends steps and voltages",
)


def load_card(file: HalFile, card: str, config: str) -> None:
    """hostmot2 on Ethernet: read first in the thread, written last; a card that hears nothing lets go."""
    lathe = file.lathe
    file.load(f"loadrt threads name1={lathe.thread} period1={lathe.period * 1e9:.0f}")
    file.load("loadrt hostmot2")
    address = f'board_ip="{lathe.board.address}" ' if lathe.board.address else ""
    file.load(f'loadrt hm2_eth {address}config="{config}"')
    file.first.append(f"{card}.read")
    file.section("Watchdog: a card that hears nothing lets everything fall; that is a fault of the axes")
    file.say("Reset alone does not bring it back: start the control again.")
    file.setp(f"{card}.watchdog.timeout_ns", _WATCHDOG)
    _faults(file, card)


def _faults(file: HalFile, card: str) -> None:
    """hal.axes.X.fault as a signal: the card's watchdog, or the drive's own fault where that is wired."""
    gates = []
    silent = [f"{card}.watchdog.has_bit"]
    for axis in file.lathe.axes:
        path = f"hal.axes.{axis.name}.fault"
        if "." in file.lathe.names.get(path, "."):
            continue  # not said, or a terminal
        gate, wired = f"{axis.name.lower()}-fault-or", file.lathe.board.axes[axis.name].fault_input
        gates.append(gate)
        silent.append(f"{gate}.in0")
        if wired:
            key = f"board.axis.{axis.name}.fault_input"
            file.at_terminal(key, f"{axis.name.lower()}-drive-fault", wired, f"{gate}.in1", drives=False)
        file.role(path, f"{axis.name.lower()}-fault", f"{gate}.out")
    if gates:
        file.load(f"loadrt or2 names={','.join(gates)}", "a fault is the drive's own, or the card's watchdog")
        file.first += gates
        file.net("card-silent", *silent)


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
    encoder(file, pin, counts, "counts a turn: 4 x lines; it rises with M03")
    file.role("hal.spindle.position", "spindle-turns", f"{pin}.position", *turns(file), place=place)
    file.role("hal.spindle.velocity", "spindle-rps", f"{pin}.velocity", place=place)
    file.role("hal.spindle.index_enable", "spindle-index", f"{pin}.index-enable", place=place)
