"""Our own part of the HAL file: setpoints out of a stream, the gear, the E-stop chain, samples back.

It is made of LinuxCNC's stock components and stands in the place of the line ``#turndesk`` of the machine's
HAL file: behind what reads the machine, before what drives it. See decision 0028.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from core.message import Message
from core.ports import DriverError
from drivers.hal.hal_config import HalAxis, HalConfig

MARK = "#turndesk"
BRIDGE = "turndesk"  # the component that the bridge is
FLOAT, BIT, COUNT = "float", "bit", "s32"
_STREAMS = ("a", "b")
_ROOM = 2.0  # of an axis' acceleration: setpoints, their corners and a gear stay below it
_FASTER = 1.2  # of its speed
_BRAKES = 0.15  # s beyond the ramp from full speed in which the bridge must have taken the power itself
_SAMPLES = 4000  # rows that wait for the bridge
_LOADRT = re.compile(r"^\s*loadrt\s+(\S+)\s*(.*?)\s*(?:#.*)?$")


@dataclass(frozen=True, slots=True)
class Link:
    """A pin or signal of the machine's HAL file, and what of ours hangs on it.

    ``path`` is its key in the machine file. ``drives``: ours is the source.
    """

    path: str
    pin: str
    kind: str
    drives: bool
    ours: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BridgePin:
    """A pin of the bridge itself: ``way`` is in, out or io."""

    name: str
    kind: str
    way: str


@dataclass(slots=True)
class Border:
    """What is loaded, in which order it is called, what it is set to, and what hangs on what."""

    modules: dict[str, list[str]] = field(default_factory=dict)  # instances by component
    alone: list[str] = field(default_factory=list)  # whole loadrt lines of components without instances
    calls: list[str] = field(default_factory=list)
    nets: dict[str, list[str]] = field(default_factory=dict)  # pins by signal, the source first
    values: list[tuple[str, float]] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    pins: list[BridgePin] = field(default_factory=list)
    columns: str = ""  # of the sampler

    def add(self, component: str, name: str, **pins: str) -> None:
        """One more instance, its pins on signals; ``_`` in the name of a pin is ``-``, at its end nothing."""
        self.modules.setdefault(component, []).append(name)
        self.calls.append(name)
        for pin, signal in pins.items():
            self.wire(signal, f"{name}.{pin.rstrip('_').replace('_', '-')}")

    def wire(self, signal: str, *pins: str) -> None:
        """Pins on a signal of ours."""
        self.nets.setdefault(signal, []).extend(pins)

    def own(self, name: str, kind: str, way: str, signal: str = "") -> str:
        """A pin of the bridge, on a signal."""
        self.pins.append(BridgePin(name, kind, way))
        if signal:
            self.wire(signal, f"{BRIDGE}.{name}")
        return f"{BRIDGE}.{name}"

    def sample(self, kind: str, signal: str) -> None:
        """One more column of what comes back."""
        self.wire(signal, f"sampler.0.pin.{len(self.columns)}")
        self.columns += {FLOAT: "f", BIT: "b", COUNT: "s"}[kind]

    def reads(self, path: str, pin: str, kind: str, *ours: str) -> None:
        """Something of the machine's that we read."""
        self.links.append(Link(path, pin, kind, False, ours))

    def drives(self, path: str, pin: str, kind: str, ours: str) -> None:
        """Something of the machine's that we drive; nothing where it has no such pin."""
        if pin:
            self.links.append(Link(path, pin, kind, True, (ours,)))


def border_of(config: HalConfig) -> Border:
    """Everything of ours in the servo thread, in the order in which it is called."""
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
    """Of one stream: the row's number; each axis' place and its way a turn of the spindle."""
    return 1 + 2 * len(config.driven)


# --- Two streams. One plays; the other takes what shall be played instead, and plays from that row on: rows
# that are queued in HAL can be recalled.


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


# --- The E-stop chain: whole only while the machine's own is, no axis has a fault, and the bridge lives.


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
        # The bridge brakes the others; where it does not, HAL takes the power.
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
    """s in which the slowest slide has braked."""
    return _BRAKES + max(axis.vmax / axis.amax for axis in config.driven)


def _estop(border: Border, config: HalConfig) -> None:
    """``td-estop-ok`` out of the input estop, which the machine file says whichever way it is wired."""
    wired = config.inputs["estop"]
    raw = "td-in-estop"
    border.own("in.estop", BIT, "in", raw)
    border.reads("io.in.estop", wired.pin, BIT, raw)
    if wired.active_low:
        border.add("and2", "td.estop", in0=raw, in1=raw, out="td-estop-ok")
    else:
        border.add("not", "td.estop", in_=raw, out="td-estop-ok")


def _reached(border: Border, config: HalConfig) -> str:
    """Return the signal of a released E-stop whose input is current: a frozen input is a pressed E-stop."""
    if not config.table.link_fault:
        return "td-estop-ok"
    border.own("link-fault", BIT, "in", "td-link-fault")
    border.reads("hal.link_fault", config.table.link_fault, BIT, "td-link-fault")
    border.add("not", "td.linked", in_="td-link-fault", out="td-linked")
    border.add("and2", "td.reached", in0="td-estop-ok", in1="td-linked", out="td-reached")
    return "td-reached"


def _any_of(border: Border, name: str, signals: list[str]) -> str:
    """The signal that is on when one of these is."""
    so_far = signals[0]
    for index, signal in enumerate(signals[1:]):
        both = f"{name}-{index}"
        border.add("or2", f"td.{name}-{index}", in0=so_far, in1=signal, out=both)
        so_far = both
    return so_far


# --- One axis: place + way a turn · turns of the spindle. Where a stream runs dry or a gear asks for too
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
    if axis.is_spindle:  # what C is sent while the spindle turns is where it stands when it is held
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
    """``signal-feedback`` counts on where the encoder (``signal-raw``) leaps to 0 at its index.

    ``signal-shift`` is what is made up for: after the leap also where the index was. ``own`` is the bridge's
    pin that asks for the index.
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
    """What turns the spindle, stops it at an angle, or makes it C; all of it off while the chain is open."""
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


# --- Outputs are safe while the chain is open, lamps of the signal tower while the bridge is silent.
# Inputs and pots go to the bridge as they are.


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


# --- As text.


def session_text(machine: str, border: Border, thread: str, source: str) -> str:
    """The machine's HAL file with our part in its place. Raises DriverError where it has none.

    A component can be loaded once only: where the machine's file loads one of ours too, the instances of both
    are loaded together, where the first of them is needed. ``source`` names the file.
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
    """The component that a line loads, and its instances; nothing for any other line."""
    found = _LOADRT.match(line)
    if found is None:
        return "", []
    names, count = re.search(r"names=(\S+)", found[2]), re.search(r"count=(\d+)", found[2])
    if names:
        return found[1], names[1].split(",")
    return found[1], [f"{found[1]}.{n}" for n in range(int(count[1]) if count else 1)]


def _together(line: str, modules: dict[str, list[str]]) -> str:
    """Loads our instances with the machine's; they are taken out of ``modules``."""
    component, theirs = _instances(line)
    if component not in modules:
        return line
    return f"loadrt {component} names={','.join((*theirs, *modules.pop(component)))}"


def _left_out(line: str, modules: dict[str, list[str]]) -> str:
    """Its instances are loaded with ours, further up."""
    component, theirs = _instances(line)
    if component not in modules:
        return line
    modules[component] += theirs
    return f"# {line.strip()}  # loaded above"


def _ours(border: Border, thread: str, modules: Mapping[str, list[str]]) -> Iterator[str]:
    """Loading, order, figures and wiring; the bridge hangs itself on it when it is there."""
    yield from border.alone
    yield from (f"loadrt {component} names={','.join(names)}" for component, names in modules.items())
    yield from (f"addf {call} {thread}" for call in border.calls)
    yield from (f"setp {pin} {value:.17g}" for pin, value in border.values)
    for signal, pins in border.nets.items():
        inner = [pin for pin in pins if not pin.startswith(Message("{what}.", what=BRIDGE))]
        if inner:
            yield f"net {signal} {' '.join(inner)}"


def bridge_nets(border: Border) -> Iterator[tuple[str, list[str]]]:
    """The bridge's own pins by signal."""
    for signal, pins in border.nets.items():
        own = [pin for pin in pins if pin.startswith(Message("{what}.", what=BRIDGE))]
        if own:
            yield signal, own
