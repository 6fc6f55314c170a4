"""Shared parts of HAL files: C axis on the spindle drive, and Ethernet cards from Mesa.

A pid component closes the position loop of the C axis with the spindle encoder. A drive with a speed input
(±10 V, EtherCAT) receives the spindle speed, or the output of the pid component when it is used as the C
axis. If the drive also has a step input, a terminal switches it to this input for C. The pid component then
controls the step rate. All supported Mesa cards use hm2_eth with its watchdog, its encoders and pid
components.
"""

from __future__ import annotations

from core.message import Message
from core.table_schema import FileFinding
from drivers.hal.boards.hal_file_builder import HalFile, LatheAxis

C_TURN_PIN = "c-degrees.in"  # Additional pin for the spindle revolutions.
C_SPEED_FACTOR = (
    1.5  # Factor of C's speed, so that a loop with the wrong sign cannot run away at spindle speed.
)
_CHOICE, _POWER, _PID = "c-or-speed", "spindle-power", "pid.c"
_PATH = "hal.spindle.position_mode"
_SIMULATED = 100.0  # 1/s, for a simulated spindle.


def get_c_revolution_pins(file: HalFile) -> tuple[str, ...]:
    """Return the pin from which the C axis reads the spindle revolutions, or () without a C axis."""
    return (C_TURN_PIN,) if file.lathe.c_axis is not None else ()


def load_c_components(file: HalFile, *, shares_input: bool) -> None:
    """Load the components for C, which run after the encoder and before the spindle drive.

    If ``shares_input`` is True, the spindle speed and C use the same drive input.
    """
    file.add_component_instance("scale", "c-degrees")
    file.add_component_instance("pid", _PID)
    file.first_function_calls.append("c-degrees")
    file.last_function_calls.append(f"{_PID}.do-pid-calcs")
    if shares_input:
        file.add_component_instance("scale", "c-rpm")
        file.add_component_instance("mux2", _CHOICE)
        file.add_component_instance("or2", _POWER)
        file.last_function_calls += ["c-rpm", _CHOICE, _POWER]


def configure_c_position_loop(file: HalFile, axis: LatheAxis, *drives: str) -> None:
    """Configure the pid component of C with its feedback, and connect its output to ``drives``.

    The output is in degrees/s.
    """
    board = file.lathe.board_table.axes.get(axis.name)
    file.set_pin("c-degrees.gain", 360, "degrees per revolution of the spindle encoder")
    gains = {"Pgain": _SIMULATED} if board is None else {
        "Pgain": board.p, "Igain": board.i, "Dgain": board.d, "FF0": 0.0, "FF2": board.ff2
    }  # fmt: skip
    for key, gain in gains.items():
        file.set_pin(f"{_PID}.{key}", gain)
    file.set_pin(f"{_PID}.FF1", 1.0, "FF1 = 1 passes the commanded speed through unchanged")
    file.set_pin(
        f"{_PID}.maxoutput",
        C_SPEED_FACTOR * axis.max_velocity,
        "speed limit in degrees/s; also applies if a fault occurs",
    )
    file.set_pin(f"{_PID}.error-previous-target", 1)
    file.connect_position_pins(axis.name, [f"{_PID}.command"], ["c-degrees.out", f"{_PID}.feedback"])
    file.connect_pins("c-speed", f"{_PID}.output", *drives)


def get_spindle_command_pins(file: HalFile, speed_pin: str, enable_pin: str) -> tuple[str, str]:
    """Return the pins for the spindle speed in rpm and for the enable signal.

    They are the pins of the drive, or those of the selector if the drive is also the C axis.
    """
    axis = file.lathe.c_axis
    if axis is None:
        return speed_pin, enable_pin
    configure_c_position_loop(file, axis, "c-rpm.in")
    file.set_pin("c-rpm.gain", 1.0 / 6.0, "converts degrees/s to rpm")
    file.connect_pins("c-rpm", "c-rpm.out", f"{_CHOICE}.in1")
    file.connect_pins("spindle-drive-rpm", f"{_CHOICE}.out", speed_pin)
    file.connect_pins("spindle-drive-on", f"{_POWER}.out", enable_pin)
    file.connect_key_pins(
        _PATH, "spindle-is-c", f"{_CHOICE}.sel", f"{_POWER}.in1", f"{_PID}.enable", is_required=True
    )
    return f"{_CHOICE}.in0", f"{_POWER}.in0"


def get_simulated_speed_pin(file: HalFile) -> str:
    """Return the pin with the speed of the simulated spindle in rev/s.

    With C on the spindle, this is the pin of the selector between the spindle speed and C.
    """
    axis = file.lathe.c_axis
    if axis is None:
        return "spindle-rps.out"
    file.set_pin("c-rps.gain", 1.0 / 360.0)
    configure_c_position_loop(file, axis, "c-rps.in")
    file.connect_pins("c-rps", "c-rps.out", f"{_CHOICE}.in1")
    file.connect_pins("spindle-rps-cmd", "spindle-rps.out", f"{_CHOICE}.in0")
    file.connect_key_pins(_PATH, "spindle-is-c", f"{_CHOICE}.sel", f"{_PID}.enable", is_required=True)
    return f"{_CHOICE}.out"


def load_simulated_c_components(file: HalFile) -> None:
    """Load the components for C on the simulated spindle."""
    load_c_components(file, shares_input=False)
    file.add_component_instance("scale", "c-rps")
    file.add_component_instance("mux2", _CHOICE)
    file.last_function_calls += ["c-rps", _CHOICE]


def connect_drive_mode_terminal(file: HalFile) -> None:
    """Connect the terminal that switches the drive from its speed input to steps."""
    name = file.lathe.terminal_names.get(_PATH, "")
    if "." not in name:
        why = Message(
            "expected {terminals}; connect this terminal to the drive input that switches the drive from "
            "speed mode to step mode",
            terminals=file.terminal_hint,
        )
        file.findings.append(FileFinding(_PATH, name, why))
    file.connect_key_pins(_PATH, "spindle-is-c", f"{_PID}.enable", is_required=True)


# --- Mesa's Ethernet cards.


_WATCHDOG = 5_000_000  # Ns without a packet after which the card switches everything off.
CARD_NOTES = (
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


def load_ethernet_card(file: HalFile, card: str, config: str, *further: str) -> None:
    """Load hostmot2 for an Ethernet card, which each cycle of the thread reads first and writes last.

    ``further`` lists additional pins that report stale inputs of the card.
    """
    lathe = file.lathe
    file.add_load_line(f"loadrt threads name1={lathe.servo_thread} period1={lathe.servo_period_s * 1e9:.0f}")
    file.add_load_line("loadrt hostmot2")
    address = f'board_ip="{lathe.board_table.address}" ' if lathe.board_table.address else ""
    file.add_load_line(f'loadrt hm2_eth {address}config="{config}"')
    file.first_function_calls.append(f"{card}.read")
    file.start_section("Watchdog: the card turns all outputs off when it receives nothing from the computer")
    file.set_pin(f"{card}.watchdog.timeout_ns", _WATCHDOG)
    _connect_link(file, card, further)


def _connect_link(file: HalFile, card: str, other_faults: tuple[str, ...]) -> None:
    """Connect the pins that report a lost card to hal.link_fault.

    After the card is lost, hm2_eth retains the state of every input and no longer reads the watchdog.
    hm2_eth sets the parameter ``io_error`` together with the pin ``packet-error-exceeded``, which remains
    on until the driver is loaded again.
    """
    gates = _list_drive_faults(file)
    silent = f"{card}.packet-error-exceeded", f"{card}.watchdog.has_bit"
    file.connect_link_fault("or", *silent, *other_faults, extra_pins=tuple(f"{gate}.in0" for gate in gates))
    file.first_function_calls += gates


def _list_drive_faults(file: HalFile) -> list[str]:
    """Combine the drive fault of each axis with the loss of the card, and return the "or" gates.

    A drive fault is combined only if the machine file specifies it as a signal.
    """
    gates = []
    for axis in file.lathe.axes:
        path = f"hal.axes.{axis.name}.fault"
        if "." in file.lathe.terminal_names.get(path, "."):
            continue  # Not configured, or a terminal.
        gate, wired = f"{axis.name.lower()}-fault-or", file.lathe.board_table.axes[axis.name].fault_input
        gates.append(gate)
        if wired:
            key = f"board.axis.{axis.name}.fault_input"
            file.connect_terminal(
                key, f"{axis.name.lower()}-drive-fault", wired, f"{gate}.in1", is_output=False
            )
        file.connect_key_pins(path, f"{axis.name.lower()}-fault", f"{gate}.out")
    if gates:
        file.add_load_line(
            f"loadrt or2 names={','.join(gates)}", "drive fault or lost connection to the card"
        )
    return gates


def load_pid_loops(file: HalFile, axes: tuple[LatheAxis, ...]) -> None:
    """Load one ``pid`` component per axis, which runs after the setpoints are calculated."""
    names = [f"pid.{axis.name.lower()}" for axis in axes]
    if names:
        file.add_load_line(f"loadrt pid names={','.join(names)}")
        file.last_function_calls += [f"{name}.do-pid-calcs" for name in names]


def configure_encoder(file: HalFile, pin: str, counts_per_unit: float, description: str) -> None:
    """Configure a quadrature encoder with its filter enabled."""
    file.set_pin(f"{pin}.scale", counts_per_unit, description)
    for key in ("counter-mode", "index-invert", "index-mask"):
        file.set_pin(f"{pin}.{key}", 0)
    file.set_pin(f"{pin}.filter", 1)


def connect_spindle_encoder(file: HalFile, card: str, terminal: str) -> None:
    """Connect the revolutions, the speed and the index of the spindle encoder."""
    board = file.lathe.board_table.spindle
    pin = f"{card}.encoder.{board.encoder:02d}"
    file.start_section(f"Spindle: encoder {board.encoder}")
    counts = 4 * file.lathe.encoder_pulses_per_rev * (-1 if board.reversed else 1)
    configure_encoder(
        file, pin, counts, "counts per revolution: 4 x encoder lines; the position increases with M03"
    )
    file.connect_key_pins(
        "hal.spindle.position",
        "spindle-turns",
        f"{pin}.position",
        *get_c_revolution_pins(file),
        label=terminal,
    )
    file.connect_key_pins("hal.spindle.velocity", "spindle-rps", f"{pin}.velocity", label=terminal)
    file.connect_key_pins("hal.spindle.index_enable", "spindle-index", f"{pin}.index-enable", label=terminal)
