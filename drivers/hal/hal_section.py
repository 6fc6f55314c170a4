"""TurnDesk's own section of the HAL file: setpoint streams, gear, E-stop chain and samples.

The section uses standard LinuxCNC components and replaces the line ``#turndesk`` of the machine's HAL file.
It is placed between the functions that read the hardware and those that write it. See decision 0028.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from core.message import Message
from core.ports import DriverError
from drivers.hal.hal_config import HalAxis, HalConfig

TURNDESK_COMMENT = "#turndesk"
BRIDGE_COMPONENT = "turndesk"  # Name of the bridge's component.
FLOAT, BIT, COUNT = "float", "bit", "s32"
_STREAM_NAMES = ("a", "b")
_ACCEL_FACTOR = 2.0  # Factor of an axis' acceleration, above that of setpoints, corners and a gear.
_MAX_SPEED_FACTOR = 1.2  # Factor of an axis' speed.
# Seconds in addition to the ramp from full speed until the bridge must have switched off the power.
_BRAKING_RESERVE_S = 0.15
_SAMPLES = 4000  # Rows buffered for the bridge.
_LOADRT = re.compile(r"^\s*loadrt\s+(\S+)\s*(.*?)\s*(?:#.*)?$")


@dataclass(frozen=True, slots=True)
class MachinePinLink:
    """A pin or signal of the machine's HAL file, with TurnDesk's signals that are connected to it.

    ``path`` is its key in the machine file. ``is_driven_by_turndesk`` is True if TurnDesk is the source.
    """

    machine_file_key: str
    pin_name: str
    hal_type: str
    is_driven_by_turndesk: bool
    turndesk_signals: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BridgePin:
    """A pin of the bridge itself, with the direction in, out or io."""

    name: str
    hal_type: str
    direction: str


@dataclass(slots=True)
class HalSection:
    """TurnDesk's section of a HAL file: components, order of calls, parameter values and connections."""

    module_instances: dict[str, list[str]] = field(default_factory=dict)  # Instances by component.
    loadrt_lines: list[str] = field(
        default_factory=list
    )  # Complete loadrt lines of components without instances.
    function_calls: list[str] = field(default_factory=list)
    pins_by_signal: dict[str, list[str]] = field(
        default_factory=dict
    )  # Pins by signal, with the source first.
    pin_values: list[tuple[str, float]] = field(default_factory=list)
    machine_links: list[MachinePinLink] = field(default_factory=list)
    bridge_pins: list[BridgePin] = field(default_factory=list)
    sample_column_types: str = ""  # Column types of the sampler.

    def add_component(self, component: str, name: str, **pins: str) -> None:
        """Add a component instance, and connect its pins to signals.

        In the name of a pin, each underscore represents a hyphen; a trailing underscore is removed.
        """
        self.module_instances.setdefault(component, []).append(name)
        self.function_calls.append(name)
        for pin, signal in pins.items():
            self.connect_pins(signal, f"{name}.{pin.rstrip('_').replace('_', '-')}")

    def connect_pins(self, signal: str, *pins: str) -> None:
        """Connect pins to one of TurnDesk's signals."""
        self.pins_by_signal.setdefault(signal, []).extend(pins)

    def add_bridge_pin(self, name: str, hal_type: str, direction: str, signal: str = "") -> str:
        """Add a pin of the bridge, connect it to a signal, and return its name."""
        self.bridge_pins.append(BridgePin(name, hal_type, direction))
        if signal:
            self.connect_pins(signal, f"{BRIDGE_COMPONENT}.{name}")
        return f"{BRIDGE_COMPONENT}.{name}"

    def add_sample_column(self, kind: str, signal: str) -> None:
        """Add a column to the sample rows that HAL sends to the bridge."""
        self.connect_pins(signal, f"sampler.0.pin.{len(self.sample_column_types)}")
        self.sample_column_types += {FLOAT: "f", BIT: "b", COUNT: "s"}[kind]

    def connect_machine_output(self, key: str, pin: str, hal_type: str, *ours: str) -> None:
        """Connect an output of the machine to TurnDesk's signals."""
        self.machine_links.append(MachinePinLink(key, pin, hal_type, False, ours))

    def connect_machine_input(self, key: str, pin: str, hal_type: str, turndesk_signal: str) -> None:
        """Connect an input of the machine to TurnDesk's signal, unless the pin name is empty."""
        if pin:
            self.machine_links.append(MachinePinLink(key, pin, hal_type, True, (turndesk_signal,)))


def build_hal_section(config: HalConfig) -> HalSection:
    """Return the section, with its calls in the order of the servo thread."""
    border = HalSection()
    _streams(border, config)
    _chain(border, config)
    if config.spindle.pins.position and config.spindle.pins.index_enable:
        pin = config.spindle.pins.index_enable
        _add_smooth_start(border, "td-spindle", "hal.spindle.index_enable", pin, "spindle-index")
    for axis in config.driven_axes:
        _slide(border, axis)
    _spindle(border, config)
    for axis in config.driven_axes:
        if switch := axis.switch_key:
            border.add_sample_column(BIT, f"td-{axis.name}-{switch}")
    _terminals(border, config)
    if config.probe_input is not None:
        border.add_sample_column(BIT, "td-in-probe")
    border.loadrt_lines.append(f"loadrt sampler depth={_SAMPLES} cfg={border.sample_column_types}")
    border.function_calls.append("sampler.0")
    return border


def count_stream_columns(config: HalConfig) -> int:
    """Return the number of columns of one stream.

    The columns are the row number and, for each axis, the position and the travel per revolution.
    """
    return 1 + 2 * len(config.driven_axes)


# --- Two streams: one plays, and the other receives replacement rows and plays from the first of these on.
# Rows queued in HAL can thus be recalled.


def _streams(border: HalSection, config: HalConfig) -> None:
    count = count_stream_columns(config)
    depth = round(4.0 * config.hal_table.ahead / config.hal_table.period)
    border.loadrt_lines.append(f"loadrt streamer depth={depth},{depth} cfg={'f' * count},{'f' * count}")
    border.add_bridge_pin("switch-at", FLOAT, "out", "td-switch-at")
    border.add_bridge_pin("play-b", BIT, "out", "td-play-b")
    border.add_bridge_pin("plays-b", BIT, "in", "td-plays-b")
    border.add_component("near", "td.near", in1="td-row", in2="td-switch-at", out="td-due")
    border.pin_values.append(("td.near.difference", 0.25))
    border.add_component("not", "td.want-a", in_="td-play-b", out="td-play-a")
    border.add_component("and2", "td.to-b", in0="td-due", in1="td-play-b", out="td-to-b")
    border.add_component("and2", "td.to-a", in0="td-due", in1="td-play-a", out="td-to-a")
    border.add_component("flipflop", "td.which", set="td-to-b", reset="td-to-a", out="td-plays-b")
    border.add_component("not", "td.plays-a", in_="td-plays-b", out="td-plays-a")
    for number, which in enumerate(_STREAM_NAMES):
        border.connect_pins(f"td-plays-{which}", f"streamer.{number}.enable")
        border.function_calls.append(f"streamer.{number}")
    names = ["td-row"]
    names += [f"td-{axis.name}-{what}" for axis in config.driven_axes for what in ("at", "lead")]
    for index, name in enumerate(names):
        a, b = (f"td-{which}-{index}" for which in _STREAM_NAMES)
        border.connect_pins(a, f"streamer.0.pin.{index}")
        border.connect_pins(b, f"streamer.1.pin.{index}")
        border.add_component("mux2", f"td.column-{index}", in0=a, in1=b, sel="td-plays-b", out=name)
    border.add_sample_column(FLOAT, "td-row")


# --- E-stop chain: closed only while the machine's chain is closed, no axis has a fault and the bridge runs.


def _chain(border: HalSection, config: HalConfig) -> None:
    border.add_bridge_pin("heartbeat", BIT, "out", "td-heartbeat")
    border.add_bridge_pin("watch", BIT, "out", "td-watch")
    border.add_bridge_pin("reset", BIT, "out", "td-reset")
    border.add_bridge_pin("enable", BIT, "out", "td-enable")
    border.add_bridge_pin("chain-ok", BIT, "in", "td-ok")
    border.add_bridge_pin("alive", BIT, "in", "td-alive")
    border.add_bridge_pin("powered", BIT, "in", "td-power")
    border.loadrt_lines.append("loadrt watchdog num_inputs=1")
    border.function_calls += ["watchdog.set-timeouts", "watchdog.process"]
    border.connect_pins("td-heartbeat", "watchdog.input-0")
    border.connect_pins("td-watch", "watchdog.enable-in")
    border.connect_pins("td-alive", "watchdog.ok-out")
    border.pin_values.append(("watchdog.timeout-0", config.hal_table.watchdog))
    _add_estop(border, config)
    border.add_component(
        "and2", "td.whole", in0=_reached_signal(border, config), in1="td-alive", out="td-whole"
    )
    pins: dict[str, str] = {"ok_in": "td-whole", "reset": "td-reset", "ok_out": "td-ok"}
    faults = [(axis.name, axis.pins.fault) for axis in config.driven_axes if axis.pins and axis.pins.fault]
    for name, pin in faults:
        border.add_bridge_pin(f"{name}.fault", BIT, "in", f"td-{name}-fault")
        border.connect_machine_output(f"hal.axes.{name}.fault", pin, BIT, f"td-{name}-fault")
    signals = [f"td-{name}-fault" for name, _ in faults]
    if signals:
        # The bridge brakes the other axes; if it does not, HAL switches the power off.
        border.add_component(
            "timedelay", "td.patience", in_=_add_or(border, "td-any-fault", signals), out="td-fault"
        )
        border.pin_values.append(("td.patience.on-delay", _watchdog_delay(config)))
        pins["fault_in"] = "td-fault"
    border.add_component("estop_latch", "td.chain", **pins)
    border.connect_pins("td-charge", "td.chain.watchdog")
    border.connect_machine_input("hal.charge_pump", config.hal_table.charge_pump, BIT, "td-charge")
    border.add_component("and2", "td.power", in0="td-ok", in1="td-enable", out="td-power")
    border.add_component("not", "td.no-power", in_="td-power", out="td-no-power")
    border.connect_machine_input("hal.machine_on", config.hal_table.machine_on, BIT, "td-power")


def _watchdog_delay(config: HalConfig) -> float:
    """Return the longest braking time of an axis plus a reserve, in seconds, for the watchdog."""
    return _BRAKING_RESERVE_S + max(axis.vmax / axis.amax for axis in config.driven_axes)


def _add_estop(border: HalSection, config: HalConfig) -> None:
    """Add the signal ``td-estop-ok``, which is derived from the E-stop input with either polarity."""
    wired = config.inputs["estop"]
    raw = "td-in-estop"
    border.add_bridge_pin("in.estop", BIT, "in", raw)
    border.connect_machine_output("io.in.estop", wired.pin_name, BIT, raw)
    if wired.is_active_low:
        border.add_component("and2", "td.estop", in0=raw, in1=raw, out="td-estop-ok")
    else:
        border.add_component("not", "td.estop", in_=raw, out="td-estop-ok")


def _reached_signal(border: HalSection, config: HalConfig) -> str:
    """Return the signal that is on while the E-stop is released and the inputs are up to date.

    A stale E-stop input is treated as pressed.
    """
    if not config.hal_table.link_fault:
        return "td-estop-ok"
    border.add_bridge_pin("link-fault", BIT, "in", "td-link-fault")
    border.connect_machine_output("hal.link_fault", config.hal_table.link_fault, BIT, "td-link-fault")
    border.add_component("not", "td.linked", in_="td-link-fault", out="td-linked")
    border.add_component("and2", "td.reached", in0="td-estop-ok", in1="td-linked", out="td-reached")
    return "td-reached"


def _add_or(border: HalSection, name: str, signals: list[str]) -> str:
    """Add gates that combine signals by "or", and return the resulting signal."""
    so_far = signals[0]
    for index, signal in enumerate(signals[1:]):
        both = f"{name}-{index}"
        border.add_component("or2", f"td.{name}-{index}", in0=so_far, in1=signal, out=both)
        so_far = both
    return so_far


# --- One axis: position + travel per rev · spindle revolutions. If a stream runs empty or a gear asks too
# much, the limit brakes and follows as the axis can.


def _slide(border: HalSection, axis: HalAxis) -> None:
    name, pins = axis.name, axis.pins
    assert pins is not None
    signal = f"td-{name}"
    border.add_component(
        "mult2", f"td.{name}.gear", in0=f"{signal}-lead", in1="td-spindle-feedback", out=f"{signal}-geared"
    )
    border.add_component(
        "sum2", f"td.{name}.sum", in0=f"{signal}-at", in1=f"{signal}-geared", out=f"{signal}-wanted"
    )
    free = "td-no-power"
    if axis.is_spindle_c_axis:  # While the spindle turns, the setpoint of C has no effect.
        border.add_component("not", f"td.{name}.turns", in_="td-position_mode", out=f"{signal}-turns")
        border.add_component("or2", f"td.{name}.free", in0=free, in1=f"{signal}-turns", out=f"{signal}-free")
        free = f"{signal}-free"
    limited = {"in_": f"{signal}-wanted", "load": free, "out": f"{signal}-command"}
    border.add_component("limit3", f"td.{name}.limit", **limited)
    border.pin_values.append((f"td.{name}.limit.maxv", _MAX_SPEED_FACTOR * axis.vmax))
    border.pin_values.append((f"td.{name}.limit.maxa", _ACCEL_FACTOR * axis.amax))
    path, command = f"hal.axes.{name}", f"{signal}-command"
    if pins.index_enable:
        _add_smooth_start(border, signal, f"{path}.index_enable", pins.index_enable, f"{name}.index")
        border.pin_values.append((f"{signal.replace('td-', 'td.')}.out.gain1", -1.0))
        border.add_component(
            "sum2", f"td.{name}.out", in0=command, in1=f"{signal}-shift", out=f"{signal}-shifted"
        )
        border.connect_machine_input(f"{path}.command", pins.command, FLOAT, f"{signal}-shifted")
        border.connect_machine_output(f"{path}.feedback", pins.feedback, FLOAT, f"{signal}-raw")
    else:
        border.connect_machine_input(f"{path}.command", pins.command, FLOAT, command)
        border.connect_machine_output(f"{path}.feedback", pins.feedback, FLOAT, f"{signal}-feedback")
    border.connect_machine_input(f"{path}.enable", pins.enable, BIT, "td-power")
    border.add_sample_column(FLOAT, command)
    border.add_sample_column(FLOAT, f"{signal}-feedback")
    for key in ("home", "limit_low", "limit_high"):
        pin = getattr(pins, key)
        if pin:
            border.add_bridge_pin(f"{name}.{key}", BIT, "in", f"{signal}-{key}")
            border.connect_machine_output(f"{path}.{key}", pin, BIT, f"{signal}-{key}")


def _add_smooth_start(border: HalSection, signal: str, path: str, pin: str, own_signal: str) -> None:
    """Create a feedback signal that stays continuous when the encoder resets to 0 at its index.

    The signal with the suffix "shift" is the compensated jump. After the reset, it is also the position of
    the index. ``own_signal`` is the bridge pin that requests the index.
    """
    name, index = signal.replace("td-", "td.", 1), f"{signal}-index"
    border.add_bridge_pin(own_signal, BIT, "io", index)
    border.add_bridge_pin(f"{own_signal}-at", FLOAT, "in", f"{signal}-shift")
    border.machine_links.append(MachinePinLink(path, pin, BIT, False, (index,)))
    border.add_component("not", f"{name}.no-index", in_=index, out=f"{signal}-no-index")
    border.add_component(
        "and2", f"{name}.fell", in0=f"{signal}-no-index", in1=f"{signal}-index-was", out=f"{signal}-fell"
    )
    border.add_component(
        "sum2", f"{name}.leap", in0=f"{signal}-raw-was", in1=f"{signal}-raw", out=f"{signal}-leap"
    )
    border.pin_values.append((f"{name}.leap.gain1", -1.0))
    border.add_component(
        "mux2", f"{name}.made-up", in1=f"{signal}-leap", sel=f"{signal}-fell", out=f"{signal}-made-up"
    )
    border.add_component(
        "sum2", f"{name}.shift", in0=f"{signal}-shift", in1=f"{signal}-made-up", out=f"{signal}-shift"
    )
    border.add_component(
        "sum2", f"{name}.feedback", in0=f"{signal}-raw", in1=f"{signal}-shift", out=f"{signal}-feedback"
    )
    border.add_component("sum2", f"{name}.raw-was", in0=f"{signal}-raw", out=f"{signal}-raw-was")
    border.add_component("and2", f"{name}.index-was", in0=index, in1=index, out=f"{signal}-index-was")


def _spindle(border: HalSection, config: HalConfig) -> None:
    pins, path = config.spindle.pins, "hal.spindle"
    if pins.position:
        if pins.index_enable:
            border.connect_machine_output(f"{path}.position", pins.position, FLOAT, "td-spindle-raw")
        else:
            border.connect_machine_output(f"{path}.position", pins.position, FLOAT, "td-spindle-feedback")
        border.add_sample_column(FLOAT, "td-spindle-feedback")
    if pins.velocity:
        border.connect_machine_output(f"{path}.velocity", pins.velocity, FLOAT, "td-rps")
        border.add_sample_column(FLOAT, "td-rps")
    for key in ("at_speed", "fault", "in_position_mode", "is_oriented"):
        if getattr(pins, key):
            border.add_bridge_pin(f"spindle.{key}", BIT, "in", f"td-spindle-{key}")
            border.connect_machine_output(f"{path}.{key}", getattr(pins, key), BIT, f"td-spindle-{key}")
    if config.spindle.is_driven_by_hal:
        _add_spindle_turns(border, config)


def _add_spindle_turns(border: HalSection, config: HalConfig) -> None:
    """Connect the spindle commands for speed, orientation and position mode.

    An open E-stop chain disables all of these commands.
    """
    pins, path = config.spindle.pins, "hal.spindle"
    border.add_bridge_pin("spindle.speed", FLOAT, "out", "td-wanted-rpm")
    border.add_component("mux2", "td.spindle", in1="td-wanted-rpm", sel="td-ok", out="td-rpm")
    border.connect_machine_input(f"{path}.speed", pins.speed, FLOAT, "td-rpm")
    if pins.speed_abs:
        border.add_component("abs", "td.speed-abs", in_="td-rpm", out="td-rpm-abs")
        border.connect_machine_input(f"{path}.speed_abs", pins.speed_abs, FLOAT, "td-rpm-abs")
    for key, kind in (("orient_angle", FLOAT), ("orient_mode", COUNT)):
        if getattr(pins, key):
            border.add_bridge_pin(f"spindle.{key}", kind, "out", f"td-{key}")
            border.connect_machine_input(f"{path}.{key}", getattr(pins, key), kind, f"td-{key}")
    for key in ("on", "forward", "reverse", "position_mode", "orient"):
        if getattr(pins, key):
            border.add_bridge_pin(f"spindle.{key}", BIT, "out", f"td-wanted-{key}")
            border.add_component(
                "and2", f"td.spindle-{key}", in0="td-ok", in1=f"td-wanted-{key}", out=f"td-{key}"
            )
            border.connect_machine_input(f"{path}.{key}", getattr(pins, key), BIT, f"td-{key}")


# --- Outputs are safe while the chain is open; lamps of the signal tower are safe while the bridge is silent.
# Inputs and pots are passed to the bridge unchanged.


def _terminals(border: HalSection, config: HalConfig) -> None:
    if any(output.safe_state and not output.is_lamp for output in config.outputs.values()):
        border.add_component("not", "td.open", in_="td-ok", out="td-open")
    if any(output.safe_state and output.is_lamp for output in config.outputs.values()):
        border.add_component("not", "td.silent", in_="td-alive", out="td-silent")
    for name, output in config.outputs.items():
        wanted, real = f"td-want-{name}", f"td-out-{name}"
        border.add_bridge_pin(f"out.{name}", BIT, "out", wanted)
        border.add_bridge_pin(f"is.{name}", BIT, "in", real)
        if output.safe_state is None:
            border.add_component("and2", f"td.out-{name}", in0=wanted, in1=wanted, out=real)
        elif output.safe_state:
            forced = "td-silent" if output.is_lamp else "td-open"
            border.add_component("or2", f"td.out-{name}", in0=wanted, in1=forced, out=real)
        else:
            allows = "td-alive" if output.is_lamp else "td-ok"
            border.add_component("and2", f"td.out-{name}", in0=wanted, in1=allows, out=real)
        border.connect_machine_input(f"io.out.{name}", output.pin_name, BIT, real)
    for name, wired in config.inputs.items():
        if name != "estop":
            border.add_bridge_pin(f"in.{name}", BIT, "in", f"td-in-{name}")
            border.connect_machine_output(f"io.in.{name}", wired.pin_name, BIT, f"td-in-{name}")
    for name, pot in config.pots.items():
        kind = COUNT if name == "handwheel" else FLOAT
        border.add_bridge_pin(f"analog.{name}", kind, "in", f"td-analog-{name}")
        border.connect_machine_output(f"io.analog.{name}", pot.pin_name, kind, f"td-analog-{name}")


# --- Output as text.


def insert_hal_section(machine_text: str, section: HalSection, thread_name: str, source_name: str) -> str:
    """Return the machine's HAL file with TurnDesk's section inserted.

    A component can be loaded only once. If the file and the section use the same component, their instances
    are loaded together at the first load line. ``source_name`` is the name of the file. Raises DriverError
    if the line ``#turndesk`` is missing.
    """
    lines = machine_text.splitlines()
    place = next(
        (n for n, line in enumerate(lines) if line.strip().lower().startswith(TURNDESK_COMMENT)), None
    )
    if place is None:
        raise DriverError(
            "{source}: the line {mark} is missing; put it after the addf commands that read from the "
            "machine and before the addf commands that drive the machine",
            source=source_name,
            mark=TURNDESK_COMMENT,
        )
    modules = {component: list(names) for component, names in section.module_instances.items()}
    before = [_merge_instances(line, modules) for line in lines[:place]]
    after = [_comment_out_load(line, modules) for line in lines[place + 1 :]]
    return "\n".join(
        (
            *before,
            f"# --- {TURNDESK_COMMENT}",
            *_section_lines(section, thread_name, modules),
            "# ---",
            *after,
            "",
        )
    )


def _parse_instances(line: str) -> tuple[str, list[str]]:
    """Return the component that a line loads, with its instances, or an empty name for other lines."""
    found = _LOADRT.match(line)
    if found is None:
        return "", []
    names, count = re.search(r"names=(\S+)", found[2]), re.search(r"count=(\d+)", found[2])
    if names:
        return found[1], names[1].split(",")
    return found[1], [f"{found[1]}.{n}" for n in range(int(count[1]) if count else 1)]


def _merge_instances(line: str, modules: dict[str, list[str]]) -> str:
    """Return the line with TurnDesk's instances added, and remove these instances from ``modules``."""
    component, theirs = _parse_instances(line)
    if component not in modules:
        return line
    return f"loadrt {component} names={','.join((*theirs, *modules.pop(component)))}"


def _comment_out_load(line: str, modules: dict[str, list[str]]) -> str:
    """Return the line as a comment if its instances are already loaded by an earlier line."""
    component, theirs = _parse_instances(line)
    if component not in modules:
        return line
    modules[component] += theirs
    return f"# {line.strip()}  # loaded above"


def _section_lines(border: HalSection, thread: str, modules: Mapping[str, list[str]]) -> Iterator[str]:
    """Yield the HAL lines that load, call, set and connect the components of the section.

    The lines also connect the pins, except the bridge's own pins.
    """
    yield from border.loadrt_lines
    yield from (f"loadrt {component} names={','.join(names)}" for component, names in modules.items())
    yield from (f"addf {call} {thread}" for call in border.function_calls)
    yield from (f"setp {pin} {value:.17g}" for pin, value in border.pin_values)
    for signal, pins in border.pins_by_signal.items():
        inner = [pin for pin in pins if not pin.startswith(Message("{what}.", what=BRIDGE_COMPONENT))]
        if inner:
            yield f"net {signal} {' '.join(inner)}"


def list_bridge_nets(border: HalSection) -> Iterator[tuple[str, list[str]]]:
    """Yield each signal with the bridge's own pins that are connected to it."""
    for signal, pins in border.pins_by_signal.items():
        own = [pin for pin in pins if pin.startswith(Message("{what}.", what=BRIDGE_COMPONENT))]
        if own:
            yield signal, own
