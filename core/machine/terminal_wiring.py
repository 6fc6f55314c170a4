"""Which signal hangs on which terminal: one on each, and every pot with the switch that it names."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

from core.machine.can_addresses import PLAIN_MODULE, CanTerminal, can_terminal
from core.machine.hardware_tables import HardwareReading
from core.table_schema import Finding, Values, written

# --- Whether the terminals of a machine on a CAN bus are bits and words that its modules can have.


_ANALOG, _INPUT, _OUTPUT = 0x6401, 0x6000, 0x6200
_DRIVE_INPUT = 0x60FD
_BYTES, _WORDS = 8, 4  # of a module: what one PDO of each kind carries


def on_the_bus(reading: HardwareReading, signals: Mapping[str, str]) -> Iterator[Finding]:
    """A finding for every signal and pot whose terminal is no address on the bus."""
    values = reading.values
    if any(path.endswith(".profile") for path in values.wrong):
        return  # which of the nodes are modules is not known
    for path, terminal in signals.items():
        output = path.startswith("io.out.")
        if why := _wrong(reading, terminal, output=output, analog=False):
            yield Finding(f"{path}.at", written(terminal), why)
    for name in reading.analog:
        path = f"io.analog.{name}.at"
        if values.has(path) and (why := _wrong(reading, values.text(path), output=False, analog=True)):
            yield Finding(path, written(values.text(path)), why)


def _wrong(reading: HardwareReading, text: str, *, output: bool, analog: bool) -> str:
    terminal = can_terminal(text)
    sample = "401.6401.1" if analog else "401.6200.1.0" if output else "401.6000.1.0"
    if terminal is None or (terminal.bit < 0) != analog:
        return f'expected node, object, sub-index{"" if analog else " and bit"}: "{sample}"'
    profile = _profile(reading, terminal.node)
    if not profile:
        return f"expected an I/O module of [canopen.nodes]: {', '.join(modules(reading)) or 'none is there'}"
    return _object(terminal, profile, output=output, analog=analog)


def modules(reading: HardwareReading) -> list[str]:
    """Names of the I/O modules, in the order of the file."""
    return [name for name in reading.nodes if _profile_of(reading, name) == 401]


def _profile(reading: HardwareReading, node: str) -> int:
    if node == PLAIN_MODULE:
        return 401 if modules(reading) else 0
    return _profile_of(reading, node)


def _profile_of(reading: HardwareReading, name: str) -> int:
    path = f"canopen.nodes.{name}.profile"
    return int(reading.values.number(path)) if reading.values.has(path) else 0


def _object(terminal: CanTerminal, profile: int, *, output: bool, analog: bool) -> str:
    if profile == 402:
        right = terminal.index == _DRIVE_INPUT and not output and not analog and terminal.bit < 32
        return "" if right else "a drive has inputs only: 60FD.0 and bits 0…31"
    wanted = _ANALOG if analog else _OUTPUT if output else _INPUT
    most = _WORDS if analog else _BYTES
    if terminal.index != wanted or not 1 <= terminal.sub <= most:
        return f"expected object {wanted:04X}, sub-index 1…{most}"
    return "" if terminal.bit < 8 else "expected a bit, 0…7"


STATION_SWITCH = "spindle_auto"  # the AUTO/OFF switch of an operator station
_BUTTONS = ("start", "hold")  # a machine that has neither is operated by the station on the screen
_TOPS = {"feed_pot": 1.5, "spindle_pot": 1.0}
_BITS = 8


def shared(reading: HardwareReading, signals: Mapping[str, str]) -> Iterator[Finding]:
    """A finding for every signal or pot on a terminal that is taken, however it is written."""
    values, taken = reading.values, dict[object, str]()
    places = {f"{path}.at": terminal for path, terminal in signals.items()}
    for name in reading.analog:
        if values.has(f"io.analog.{name}.at"):
            places[f"io.analog.{name}.at"] = values.text(f"io.analog.{name}.at")
    for place, terminal in places.items():
        owner = place.removesuffix(".at")
        first = taken.setdefault(_same(reading, terminal), owner)
        if first != owner:
            expected = f"expected a terminal of its own; {first} is on this one"
            yield Finding(place, written(terminal), expected)


def pots(reading: HardwareReading, signals: Mapping[str, str]) -> Iterator[Finding]:
    """A finding for every pot whose range or whose switch cannot be."""
    values = reading.values
    there = (*signals, *(path.removesuffix(".at") for path in values.wrong))
    inputs = {path.removeprefix("io.in.") for path in there if path.startswith("io.in.")}
    for name in reading.analog:
        path = f"io.analog.{name}"
        switch = values.text(f"{path}.switch") if values.has(f"{path}.switch") else ""
        if switch and switch not in inputs and not _on_the_screen(switch, values, inputs):
            yield Finding(f"{path}.switch", written(switch), _line_to_add(reading, switch, signals))
        if values.has(f"{path}.range") and (top := _TOPS.get(name)) is not None:
            low, high = values.pair(f"{path}.range")
            if not 0.0 <= low < high <= top:
                yield Finding(f"{path}.range", f"[{low:g}, {high:g}]", f"expected fractions within 0…{top:g}")


def _on_the_screen(switch: str, values: Values, inputs: Collection[str]) -> bool:
    """A machine without a wired station has this switch among the buttons on the screen."""
    wired = values.has("machine.backend") and values.text("machine.backend") == "canopen"
    return switch == STATION_SWITCH and not (wired and any(name in inputs for name in _BUTTONS))


def _line_to_add(reading: HardwareReading, switch: str, signals: Mapping[str, str]) -> str:
    """Without its input a switch would stand on AUTO for ever; what to write is said to the letter."""
    backend = reading.values.text("machine.backend") if reading.values.has("machine.backend") else "sim"
    terminal = _free_input(reading, signals) if backend == "canopen" else "IN-…"
    key = switch if switch.replace("_", "").isalnum() else written(switch)
    return f'expected an input of [io.in]; add there the line: {key} = {{ at = "{terminal}" }}'


def _free_input(reading: HardwareReading, signals: Mapping[str, str]) -> str:
    taken = {_same(reading, terminal) for terminal in signals.values()}
    for number in range(len(taken) + 1):
        terminal = f"{PLAIN_MODULE}.6000.{number // _BITS + 1}.{number % _BITS}"
        if _same(reading, terminal) not in taken:
            break
    return terminal


def _same(reading: HardwareReading, terminal: str) -> object:
    """Equal for two ways to write one terminal: 401 is the first module, and hexadecimal has two cases."""
    found = can_terminal(terminal)
    if found is None:
        return terminal.strip().casefold()
    first = next(iter(modules(reading)), PLAIN_MODULE)
    return replace(found, node=first) if found.node == PLAIN_MODULE else found
