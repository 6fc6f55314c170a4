"""Which signal hangs on which terminal: one on each, and every pot with the switch that it names."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

from core.machine.errors import Finding
from core.machine.hardware.addresses import PLAIN_MODULE, can_terminal
from core.machine.hardware.reading import HardwareReading
from core.machine.hardware.terminals import modules
from core.machine.schema import Values, written

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
