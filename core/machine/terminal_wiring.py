"""Which signal hangs on which terminal: one on each, and every pot with the switch that it names."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from core.message import Message
from core.table_schema import Driver, FileReading, Finding, Values, written

STATION_SWITCH = "spindle_auto"  # the AUTO/OFF switch of an operator station
_BUTTONS = ("start", "hold")  # a machine that has neither is operated by the station on the screen
_TOPS = {"feed_pot": 1.5, "spindle_pot": 1.0}


def shared(file: FileReading, drivers: Sequence[Driver]) -> Iterator[Finding]:
    """A finding for every signal or pot on a terminal that is taken, however it is written."""
    taken: dict[object, str] = {}
    places = {f"{path}.at": terminal for path, terminal in file.terminals.items()}
    places |= {f"{path}.at": terminal for path, terminal in file.pots().items()}
    for place, terminal in places.items():
        owner = place.removesuffix(".at")
        first = taken.setdefault(_same(file, drivers, terminal), owner)
        if first != owner:
            expected = Message("{first} already uses this terminal; choose another terminal", first=first)
            yield Finding(place, written(terminal), expected, "broken-rule")


def pots(file: FileReading, drivers: Sequence[Driver]) -> Iterator[Finding]:
    """A finding for every pot whose range or whose switch cannot be."""
    values = file.values
    there = (*file.terminals, *(path.removesuffix(".at") for path in values.wrong))
    inputs = {path.removeprefix("io.in.") for path in there if path.startswith("io.in.")}
    for name in file.names("io.analog"):
        path = f"io.analog.{name}"
        switch = values.text(f"{path}.switch") if values.has(f"{path}.switch") else ""
        if switch and switch not in inputs and not _on_the_screen(switch, values, drivers, inputs):
            yield Finding(
                f"{path}.switch", written(switch), _line_to_add(file, drivers, switch), "broken-rule"
            )
        if values.has(f"{path}.range") and (top := _TOPS.get(name)) is not None:
            low, high = values.pair(f"{path}.range")
            if not 0.0 <= low < high <= top:
                yield Finding(
                    f"{path}.range",
                    Message("[{low}, {high}]", low=f"{low:g}", high=f"{high:g}"),
                    Message("the range limits are fractions and must be between 0 and {top}", top=f"{top:g}"),
                    "broken-rule",
                )


def _backend(values: Values, drivers: Sequence[Driver]) -> Driver | None:
    return next(
        (each for each in drivers if each.backend and values.says("machine.backend", each.backend)), None
    )


def _on_the_screen(switch: str, values: Values, drivers: Sequence[Driver], inputs: Collection[str]) -> bool:
    """A machine without a wired station has this switch among the buttons on the screen."""
    backend = _backend(values, drivers)
    wired = backend is not None and backend.inputs is not None
    return switch == STATION_SWITCH and not (wired and any(name in inputs for name in _BUTTONS))


def _line_to_add(file: FileReading, drivers: Sequence[Driver], switch: str) -> str:
    """Without its input a switch would stand on AUTO for ever; what to write is said to the letter."""
    backend = _backend(file.values, drivers)
    terminal = _free_input(file, drivers, backend) if backend is not None else "IN-…"
    key = switch if switch.replace("_", "").isalnum() else written(switch)
    return Message(
        "this switch must be an input in [io.in]; add this line to that table: {key} = "
        '{{ at = "{terminal}" }}',
        key=key,
        terminal=terminal,
    )


def _free_input(file: FileReading, drivers: Sequence[Driver], backend: Driver) -> str:
    if backend.inputs is None:
        return "IN-…"
    taken = {_same(file, drivers, terminal) for terminal in file.terminals.values()}
    return next(each for each in backend.inputs() if _same(file, drivers, each) not in taken)


def _same(file: FileReading, drivers: Sequence[Driver], terminal: str) -> object:
    """Equal for two ways to write one terminal."""
    for driver in drivers:
        found = driver.terminal(file, terminal) if driver.terminal is not None else None
        if found is not None:
            return found
    return terminal.strip().casefold()
