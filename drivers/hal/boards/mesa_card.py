"""What the HAL files of Mesa's Ethernet cards share: hm2_eth, its watchdog, encoders, pid."""

from __future__ import annotations

from drivers.hal.boards.board_parts import turns
from drivers.hal.boards.hal_lines import HalFile, LatheAxis

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
    file.role("hal.spindle.position", "spindle-turns", f"{pin}.position", *turns(file), place=place)
    file.role("hal.spindle.velocity", "spindle-rps", f"{pin}.velocity", place=place)
    file.role("hal.spindle.index_enable", "spindle-index", f"{pin}.index-enable", place=place)
