"""TurnDesk's own section of the HAL file: setpoint streams, gear, E-stop chain and samples.

The section uses standard LinuxCNC components and replaces the line ``#turndesk`` of the machine's HAL file.
It is located after the functions that read the machine and before those that drive it. See decision 0028.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from core.message import Message
from core.ports import DriverError
from drivers.hal.hal_config import HalAxis, HalConfig

MARK = "#turndesk"
BRIDGE = "turndesk"  # Name of the bridge's component.
FLOAT, BIT, COUNT = "float", "bit", "s32"
_STREAMS = ("a", "b")
_ROOM = 2.0  # Factor of an axis' acceleration, above that of setpoints, corners and a gear.
_FASTER = 1.2  # Factor of an axis' speed.
# Seconds in addition to the ramp from full speed until the bridge must have switched off the power.
_BRAKES = 0.15
_SAMPLES = 4000  # Rows buffered for the bridge.
_LOADRT = re.compile(r"^\s*loadrt\s+(\S+)\s*(.*?)\s*(?:#.*)?$")


@dataclass(frozen=True, slots=True)
class Link:
    """Pin or signal of the machine's HAL file, with TurnDesk's signals that are connected to it.

    ``path`` is its key in the machine file. ``drives`` is True if TurnDesk is the source.
    """

    path: str
    pin: str
    kind: str
    drives: bool
    ours: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BridgePin:
    """Pin of the bridge itself, with the direction in, out or io."""

    name: str
    kind: str
    way: str


@dataclass(slots=True)
class Border:
    """Contents of the section: components, order of calls, parameter values and connections."""

    modules: dict[str, list[str]] = field(default_factory=dict)  # Instances by component.
    alone: list[str] = field(default_factory=list)  # Complete loadrt lines of components without instances.
    calls: list[str] = field(default_factory=list)
    nets: dict[str, list[str]] = field(default_factory=dict)  # Pins by signal, with the source first.
    values: list[tuple[str, float]] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    pins: list[BridgePin] = field(default_factory=list)
    columns: str = ""  # Column types of the sampler.

    def add(self, component: str, name: str, **pins: str) -> None:
        """Add a component instance with its pins on signals.

        In the name of a pin, ``_`` represents ``-``; a trailing ``_`` is removed.
        """
        self.modules.setdefault(component, []).append(name)
        self.calls.append(name)
        for pin, signal in pins.items():
            self.wire(signal, f"{name}.{pin.rstrip('_').replace('_', '-')}")

    def wire(self, signal: str, *pins: str) -> None:
        """Connect pins to one of TurnDesk's signals."""
        self.nets.setdefault(signal, []).extend(pins)

    def own(self, name: str, kind: str, way: str, signal: str = "") -> str:
        """Add a pin of the bridge, connect it to a signal and return its name."""
        self.pins.append(BridgePin(name, kind, way))
        if signal:
            self.wire(signal, f"{BRIDGE}.{name}")
        return f"{BRIDGE}.{name}"

    def sample(self, kind: str, signal: str) -> None:
        """Add a column to the samples."""
        self.wire(signal, f"sampler.0.pin.{len(self.columns)}")
        self.columns += {FLOAT: "f", BIT: "b", COUNT: "s"}[kind]

    def reads(self, path: str, pin: str, kind: str, *ours: str) -> None:
        """Connect an output of the machine to TurnDesk's signals."""
        self.links.append(Link(path, pin, kind, False, ours))

    def drives(self, path: str, pin: str, kind: str, ours: str) -> None:
        """Connect an input of the machine to TurnDesk's signal, unless the pin name is empty."""
        if pin:
            self.links.append(Link(path, pin, kind, True, (ours,)))


def border_of(config: HalConfig) -> Border:
    """Build the section with its calls in the order of the servo thread."""
    border = Border()
    _streams(border, config)
    _chain(border, config)
    if config.spindle.pins.position and config.spindle.pins.index_enable:
        pin = config.spindle.pins.index_enable
        _without_leap(border, "td-spindle", "hal.spindle.index_enable", pin, "spindle-index")
    for axis in config.driven:
        _slide(border, axis)
    _spindle(border, config)
    for axis in config.driven:
        if switch := axis.switch:
            border.sample(BIT, f"td-{axis.name}-{switch}")
    _terminals(border, config)
    if config.probe is not None:
        border.sample(BIT, "td-in-probe")
    border.alone.append(f"loadrt sampler depth={_SAMPLES} cfg={border.columns}")
    border.calls.append("sampler.0")
    return border


def columns(config: HalConfig) -> int:
    """Return the columns of one stream: the row number, and for each axis position and travel per rev."""
    return 1 + 2 * len(config.driven)


# --- Two streams: one plays, and the other receives replacement rows and plays from the first of these on.
# Rows queued in HAL can thus be recalled.


def _streams(border: Border, config: HalConfig) -> None:
    count = columns(config)
    depth = round(4.0 * config.table.ahead / config.table.period)
    border.alone.append(f"loadrt streamer depth={depth},{depth} cfg={'f' * count},{'f' * count}")
    border.own("switch-at", FLOAT, "out", "td-switch-at")
    border.own("play-b", BIT, "out", "td-play-b")
    border.own("plays-b", BIT, "in", "td-plays-b")
    border.add("near", "td.near", in1="td-row", in2="td-switch-at", out="td-due")
    border.values.append(("td.near.difference", 0.25))
    border.add("not", "td.want-a", in_="td-play-b", out="td-play-a")
    border.add("and2", "td.to-b", in0="td-due", in1="td-play-b", out="td-to-b")
    border.add("and2", "td.to-a", in0="td-due", in1="td-play-a", out="td-to-a")
    border.add("flipflop", "td.which", set="td-to-b", reset="td-to-a", out="td-plays-b")
    border.add("not", "td.plays-a", in_="td-plays-b", out="td-plays-a")
    for number, which in enumerate(_STREAMS):
        border.wire(f"td-plays-{which}", f"streamer.{number}.enable")
        border.calls.append(f"streamer.{number}")
    names = ["td-row"]
    names += [f"td-{axis.name}-{what}" for axis in config.driven for what in ("at", "lead")]
    for index, name in enumerate(names):
        a, b = (f"td-{which}-{index}" for which in _STREAMS)
        border.wire(a, f"streamer.0.pin.{index}")
        border.wire(b, f"streamer.1.pin.{index}")
        border.add("mux2", f"td.column-{index}", in0=a, in1=b, sel="td-plays-b", out=name)
    border.sample(FLOAT, "td-row")


# --- E-stop chain: closed only while the machine's chain is closed, no axis has a fault and the bridge runs.


def _chain(border: Border, config: HalConfig) -> None:
    border.own("heartbeat", BIT, "out", "td-heartbeat")
    border.own("watch", BIT, "out", "td-watch")
    border.own("reset", BIT, "out", "td-reset")
    border.own("enable", BIT, "out", "td-enable")
    border.own("chain-ok", BIT, "in", "td-ok")
    border.own("alive", BIT, "in", "td-alive")
    border.own("powered", BIT, "in", "td-power")
    border.alone.append("loadrt watchdog num_inputs=1")
    border.calls += ["watchdog.set-timeouts", "watchdog.process"]
    border.wire("td-heartbeat", "watchdog.input-0")
    border.wire("td-watch", "watchdog.enable-in")
    border.wire("td-alive", "watchdog.ok-out")
    border.values.append(("watchdog.timeout-0", config.table.watchdog))
    _estop(border, config)
    border.add("and2", "td.whole", in0=_reached(border, config), in1="td-alive", out="td-whole")
    pins: dict[str, str] = {"ok_in": "td-whole", "reset": "td-reset", "ok_out": "td-ok"}
    faults = [(axis.name, axis.pins.fault) for axis in config.driven if axis.pins and axis.pins.fault]
    for name, pin in faults:
        border.own(f"{name}.fault", BIT, "in", f"td-{name}-fault")
        border.reads(f"hal.axes.{name}.fault", pin, BIT, f"td-{name}-fault")
    signals = [f"td-{name}-fault" for name, _ in faults]
    if signals:
        # The bridge brakes the other axes; if it does not, HAL switches the power off.
        border.add("timedelay", "td.patience", in_=_any_of(border, "td-any-fault", signals), out="td-fault")
        border.values.append(("td.patience.on-delay", _patience(config)))
        pins["fault_in"] = "td-fault"
    border.add("estop_latch", "td.chain", **pins)
    border.wire("td-charge", "td.chain.watchdog")
    border.drives("hal.charge_pump", config.table.charge_pump, BIT, "td-charge")
    border.add("and2", "td.power", in0="td-ok", in1="td-enable", out="td-power")
    border.add("not", "td.no-power", in_="td-power", out="td-no-power")
    border.drives("hal.machine_on", config.table.machine_on, BIT, "td-power")


def _patience(config: HalConfig) -> float:
    """Return the seconds in which the slowest axis has braked."""
    return _BRAKES + max(axis.vmax / axis.amax for axis in config.driven)


def _estop(border: Border, config: HalConfig) -> None:
    """Derive ``td-estop-ok`` from the E-stop input, for either polarity."""
    wired = config.inputs["estop"]
    raw = "td-in-estop"
    border.own("in.estop", BIT, "in", raw)
    border.reads("io.in.estop", wired.pin, BIT, raw)
    if wired.active_low:
        border.add("and2", "td.estop", in0=raw, in1=raw, out="td-estop-ok")
    else:
        border.add("not", "td.estop", in_=raw, out="td-estop-ok")


def _reached(border: Border, config: HalConfig) -> str:
    """Return the signal of a released E-stop with a current input; a frozen input counts as pressed."""
    if not config.table.link_fault:
        return "td-estop-ok"
    border.own("link-fault", BIT, "in", "td-link-fault")
    border.reads("hal.link_fault", config.table.link_fault, BIT, "td-link-fault")
    border.add("not", "td.linked", in_="td-link-fault", out="td-linked")
    border.add("and2", "td.reached", in0="td-estop-ok", in1="td-linked", out="td-reached")
    return "td-reached"


def _any_of(border: Border, name: str, signals: list[str]) -> str:
    """Return a signal that is on when any of these signals is on."""
    so_far = signals[0]
    for index, signal in enumerate(signals[1:]):
        both = f"{name}-{index}"
        border.add("or2", f"td.{name}-{index}", in0=so_far, in1=signal, out=both)
        so_far = both
    return so_far


# --- One axis: position + travel per rev · spindle revolutions. If a stream runs empty or a gear asks too
# much, the limit brakes and follows as the axis can.


def _slide(border: Border, axis: HalAxis) -> None:
    name, pins = axis.name, axis.pins
    assert pins is not None
    signal = f"td-{name}"
    border.add(
        "mult2", f"td.{name}.gear", in0=f"{signal}-lead", in1="td-spindle-feedback", out=f"{signal}-geared"
    )
    border.add("sum2", f"td.{name}.sum", in0=f"{signal}-at", in1=f"{signal}-geared", out=f"{signal}-wanted")
    free = "td-no-power"
    if axis.is_spindle:  # While the spindle turns, the setpoint of C has no effect.
        border.add("not", f"td.{name}.turns", in_="td-position_mode", out=f"{signal}-turns")
        border.add("or2", f"td.{name}.free", in0=free, in1=f"{signal}-turns", out=f"{signal}-free")
        free = f"{signal}-free"
    limited = {"in_": f"{signal}-wanted", "load": free, "out": f"{signal}-command"}
    border.add("limit3", f"td.{name}.limit", **limited)
    border.values.append((f"td.{name}.limit.maxv", _FASTER * axis.vmax))
    border.values.append((f"td.{name}.limit.maxa", _ROOM * axis.amax))
    path, command = f"hal.axes.{name}", f"{signal}-command"
    if pins.index_enable:
        _without_leap(border, signal, f"{path}.index_enable", pins.index_enable, f"{name}.index")
        border.values.append((f"{signal.replace('td-', 'td.')}.out.gain1", -1.0))
        border.add("sum2", f"td.{name}.out", in0=command, in1=f"{signal}-shift", out=f"{signal}-shifted")
        border.drives(f"{path}.command", pins.command, FLOAT, f"{signal}-shifted")
        border.reads(f"{path}.feedback", pins.feedback, FLOAT, f"{signal}-raw")
    else:
        border.drives(f"{path}.command", pins.command, FLOAT, command)
        border.reads(f"{path}.feedback", pins.feedback, FLOAT, f"{signal}-feedback")
    border.drives(f"{path}.enable", pins.enable, BIT, "td-power")
    border.sample(FLOAT, command)
    border.sample(FLOAT, f"{signal}-feedback")
    for key in ("home", "limit_low", "limit_high"):
        pin = getattr(pins, key)
        if pin:
            border.own(f"{name}.{key}", BIT, "in", f"{signal}-{key}")
            border.reads(f"{path}.{key}", pin, BIT, f"{signal}-{key}")


def _without_leap(border: Border, signal: str, path: str, pin: str, own: str) -> None:
    """Create a feedback signal that continues to count where the encoder resets to 0 at its index.

    The signal with the suffix ``shift`` is the compensated jump, and after the reset also the position of the
    index. ``own`` is the bridge pin that requests the index.
    """
    name, index = signal.replace("td-", "td.", 1), f"{signal}-index"
    border.own(own, BIT, "io", index)
    border.own(f"{own}-at", FLOAT, "in", f"{signal}-shift")
    border.links.append(Link(path, pin, BIT, False, (index,)))
    border.add("not", f"{name}.no-index", in_=index, out=f"{signal}-no-index")
    border.add(
        "and2", f"{name}.fell", in0=f"{signal}-no-index", in1=f"{signal}-index-was", out=f"{signal}-fell"
    )
    border.add("sum2", f"{name}.leap", in0=f"{signal}-raw-was", in1=f"{signal}-raw", out=f"{signal}-leap")
    border.values.append((f"{name}.leap.gain1", -1.0))
    border.add("mux2", f"{name}.made-up", in1=f"{signal}-leap", sel=f"{signal}-fell", out=f"{signal}-made-up")
    border.add("sum2", f"{name}.shift", in0=f"{signal}-shift", in1=f"{signal}-made-up", out=f"{signal}-shift")
    border.add(
        "sum2", f"{name}.feedback", in0=f"{signal}-raw", in1=f"{signal}-shift", out=f"{signal}-feedback"
    )
    border.add("sum2", f"{name}.raw-was", in0=f"{signal}-raw", out=f"{signal}-raw-was")
    border.add("and2", f"{name}.index-was", in0=index, in1=index, out=f"{signal}-index-was")


def _spindle(border: Border, config: HalConfig) -> None:
    pins, path = config.spindle.pins, "hal.spindle"
    if pins.position:
        if pins.index_enable:
            border.reads(f"{path}.position", pins.position, FLOAT, "td-spindle-raw")
        else:
            border.reads(f"{path}.position", pins.position, FLOAT, "td-spindle-feedback")
        border.sample(FLOAT, "td-spindle-feedback")
    if pins.velocity:
        border.reads(f"{path}.velocity", pins.velocity, FLOAT, "td-rps")
        border.sample(FLOAT, "td-rps")
    for key in ("at_speed", "fault", "in_position_mode", "is_oriented"):
        if getattr(pins, key):
            border.own(f"spindle.{key}", BIT, "in", f"td-spindle-{key}")
            border.reads(f"{path}.{key}", getattr(pins, key), BIT, f"td-spindle-{key}")
    if config.spindle.turned:
        _turned(border, config)


def _turned(border: Border, config: HalConfig) -> None:
    """Connect the commands that turn, orient or position the spindle; an open chain disables all of them."""
    pins, path = config.spindle.pins, "hal.spindle"
    border.own("spindle.speed", FLOAT, "out", "td-wanted-rpm")
    border.add("mux2", "td.spindle", in1="td-wanted-rpm", sel="td-ok", out="td-rpm")
    border.drives(f"{path}.speed", pins.speed, FLOAT, "td-rpm")
    if pins.speed_abs:
        border.add("abs", "td.speed-abs", in_="td-rpm", out="td-rpm-abs")
        border.drives(f"{path}.speed_abs", pins.speed_abs, FLOAT, "td-rpm-abs")
    for key, kind in (("orient_angle", FLOAT), ("orient_mode", COUNT)):
        if getattr(pins, key):
            border.own(f"spindle.{key}", kind, "out", f"td-{key}")
            border.drives(f"{path}.{key}", getattr(pins, key), kind, f"td-{key}")
    for key in ("on", "forward", "reverse", "position_mode", "orient"):
        if getattr(pins, key):
            border.own(f"spindle.{key}", BIT, "out", f"td-wanted-{key}")
            border.add("and2", f"td.spindle-{key}", in0="td-ok", in1=f"td-wanted-{key}", out=f"td-{key}")
            border.drives(f"{path}.{key}", getattr(pins, key), BIT, f"td-{key}")


# --- Outputs are safe while the chain is open; lamps of the signal tower are safe while the bridge is silent.
# Inputs and pots are passed to the bridge unchanged.


def _terminals(border: Border, config: HalConfig) -> None:
    if any(output.safe and not output.lamp for output in config.outputs.values()):
        border.add("not", "td.open", in_="td-ok", out="td-open")
    if any(output.safe and output.lamp for output in config.outputs.values()):
        border.add("not", "td.silent", in_="td-alive", out="td-silent")
    for name, output in config.outputs.items():
        wanted, real = f"td-want-{name}", f"td-out-{name}"
        border.own(f"out.{name}", BIT, "out", wanted)
        border.own(f"is.{name}", BIT, "in", real)
        if output.safe is None:
            border.add("and2", f"td.out-{name}", in0=wanted, in1=wanted, out=real)
        elif output.safe:
            forced = "td-silent" if output.lamp else "td-open"
            border.add("or2", f"td.out-{name}", in0=wanted, in1=forced, out=real)
        else:
            allows = "td-alive" if output.lamp else "td-ok"
            border.add("and2", f"td.out-{name}", in0=wanted, in1=allows, out=real)
        border.drives(f"io.out.{name}", output.pin, BIT, real)
    for name, wired in config.inputs.items():
        if name != "estop":
            border.own(f"in.{name}", BIT, "in", f"td-in-{name}")
            border.reads(f"io.in.{name}", wired.pin, BIT, f"td-in-{name}")
    for name, pot in config.pots.items():
        kind = COUNT if name == "handwheel" else FLOAT
        border.own(f"analog.{name}", kind, "in", f"td-analog-{name}")
        border.reads(f"io.analog.{name}", pot.pin, kind, f"td-analog-{name}")


# --- Output as text.


def session_text(machine: str, border: Border, thread: str, source: str) -> str:
    """Return the machine's HAL file with TurnDesk's section inserted.

    A component can be loaded only once. If both parts use a component, their instances are loaded together at
    the first place. ``source`` names the file. Raises DriverError if the mark is missing.
    """
    lines = machine.splitlines()
    place = next((n for n, line in enumerate(lines) if line.strip().lower().startswith(MARK)), None)
    if place is None:
        raise DriverError(
            "{source}: the line {mark} is missing; put it after the addf commands that read from the "
            "machine and before the addf commands that drive the machine",
            source=source,
            mark=MARK,
        )
    modules = {component: list(names) for component, names in border.modules.items()}
    before = [_together(line, modules) for line in lines[:place]]
    after = [_left_out(line, modules) for line in lines[place + 1 :]]
    return "\n".join((*before, f"# --- {MARK}", *_ours(border, thread, modules), "# ---", *after, ""))


def _instances(line: str) -> tuple[str, list[str]]:
    """Return the component that a line loads and its instances, or an empty name for other lines."""
    found = _LOADRT.match(line)
    if found is None:
        return "", []
    names, count = re.search(r"names=(\S+)", found[2]), re.search(r"count=(\d+)", found[2])
    if names:
        return found[1], names[1].split(",")
    return found[1], [f"{found[1]}.{n}" for n in range(int(count[1]) if count else 1)]


def _together(line: str, modules: dict[str, list[str]]) -> str:
    """Return the line with TurnDesk's instances added, and remove them from ``modules``."""
    component, theirs = _instances(line)
    if component not in modules:
        return line
    return f"loadrt {component} names={','.join((*theirs, *modules.pop(component)))}"


def _left_out(line: str, modules: dict[str, list[str]]) -> str:
    """Return the line as a comment if its instances are loaded earlier."""
    component, theirs = _instances(line)
    if component not in modules:
        return line
    modules[component] += theirs
    return f"# {line.strip()}  # loaded above"


def _ours(border: Border, thread: str, modules: Mapping[str, list[str]]) -> Iterator[str]:
    """Yield the lines that load, call, set and connect the section, without the bridge's own pins."""
    yield from border.alone
    yield from (f"loadrt {component} names={','.join(names)}" for component, names in modules.items())
    yield from (f"addf {call} {thread}" for call in border.calls)
    yield from (f"setp {pin} {value:.17g}" for pin, value in border.values)
    for signal, pins in border.nets.items():
        inner = [pin for pin in pins if not pin.startswith(Message("{what}.", what=BRIDGE))]
        if inner:
            yield f"net {signal} {' '.join(inner)}"


def bridge_nets(border: Border) -> Iterator[tuple[str, list[str]]]:
    """Yield the bridge's own pins by signal."""
    for signal, pins in border.nets.items():
        own = [pin for pin in pins if pin.startswith(Message("{what}.", what=BRIDGE))]
        if own:
            yield signal, own
