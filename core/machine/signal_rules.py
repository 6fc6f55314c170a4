"""Rules for outputs, inputs, interlocks, M codes and terminals of a machine file."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from core.machine.hardware_model import LAMPS, PREFIX, RED
from core.machine.machine_reading import Reading
from core.machine.machine_tables import FIXED_M_CODES, LANGUAGES
from core.message import Message
from core.table_schema import Driver, FileReading, Finding, Values, written

DEVICES = ("pendant.",)
"""What begins the addresses at devices that an optional feature reads."""

# Codes of the language and the outputs they switch.
NEEDED_OUTPUTS = {
    "coolant": "M08 and M09 need this output to switch the coolant",
    "collet": ("M12 and M13 need this output to close and open the collet"),
}
ESTOP = "estop"
_NUMBERS = frozenset(str(number) for number in range(1000))
STATION_SWITCH = "spindle_auto"  # the AUTO/OFF switch of an operator station
_BUTTONS = ("start", "hold")  # a machine without these inputs uses the station on the screen
_TOPS = {"feed_pot": 1.5, "spindle_pot": 1.0}


def broken(reading: Reading) -> Iterator[Finding]:
    """Yield all findings about signals."""
    yield from _needed(reading)
    yield from _m_codes(reading)
    yield from _never_off(reading)
    yield from _lamps(reading)


def terminals(reading: Reading) -> dict[str, str]:
    """Return the terminal of each signal by the path of the signal."""
    paths = [f"io.out.{name}" for name in reading.outputs] + [f"io.in.{name}" for name in reading.inputs]
    values = reading.values
    return {path: values.text(f"{path}.at") for path in paths if values.has(f"{path}.at")}


def _needed(reading: Reading) -> Iterator[Finding]:
    for name, why in NEEDED_OUTPUTS.items():
        there = {*reading.outputs, *reading.absent}
        if name not in there and not (name == "collet" and reading.kind != "lathe"):
            yield Finding(
                f"io.out.{name}",
                "",
                Message(
                    "this output is missing; {why}. If the machine does not have this output, "
                    'write {{ at = "none" }}',
                    why=why,
                ),
                "missing",
            )
    needed = {ESTOP: "TurnDesk needs this input to monitor the E-stop"}
    values = reading.values
    if values.has("interlocks.two_hand_start") and values.flag("interlocks.two_hand_start"):
        needed["start"] = "interlocks.two_hand_start needs the output of the two-hand relay"
    if values.has("interlocks.spindle_with_collet_open") and not values.flag(
        "interlocks.spindle_with_collet_open"
    ):
        needed["collet_closed"] = "TurnDesk needs this input to reject a spindle start with the collet open"
    for name, why in needed.items():
        if name not in reading.inputs:
            yield Finding(
                Message("io.in.{name}", name=name), "", Message("missing; {why}", why=why), "missing"
            )


def _m_codes(reading: Reading) -> Iterator[Finding]:
    for code in reading.m_codes:
        path = f"m_codes.{code}"
        if code not in _NUMBERS:
            yield Finding(
                path,
                "",
                "this key must be the number of an M code, 0…999, without a leading zero",
                "broken-rule",
            )
        elif int(code) in FIXED_M_CODES[_language(reading)]:
            yield Finding(
                path,
                "",
                Message("M{code} has a fixed meaning; use a free M code", code=f"{int(code):02d}"),
                "broken-rule",
            )
        elif reading.values.has(f"{path}.output"):
            output = reading.values.text(f"{path}.output")
            if output not in reading.outputs:
                known = ", ".join(reading.outputs)
                yield Finding(
                    f"{path}.output",
                    written(output),
                    Message("this value must be an output in [io.out]: {known}", known=known),
                    "broken-rule",
                )


def _language(reading: Reading) -> str:
    """Return the MDI language, or the default of the machine's kind if it is invalid."""
    said = str(reading.values.found.get("machine.language"))
    return said if said in FIXED_M_CODES else LANGUAGES[reading.kind][0]


def ignored_codes(reading: Reading) -> Iterator[int]:
    """Yield the M codes that have no effect on this machine."""
    for code in reading.m_codes:
        keys = f"m_codes.{code}.ignored", f"m_codes.{code}.enabled"
        if code in _NUMBERS and reading.values.has(*keys) and all(map(reading.values.flag, keys)):
            yield int(code)


def enabled_codes(reading: Reading) -> Iterator[tuple[int, str, bool]]:
    """Yield number, output and state of every complete and enabled M code."""
    values = reading.values
    for code in reading.m_codes:
        path = f"m_codes.{code}"
        whole = code in _NUMBERS and values.has(f"{path}.output", f"{path}.on", f"{path}.enabled")
        if whole and values.flag(f"{path}.enabled"):
            yield int(code), values.text(f"{path}.output"), values.flag(f"{path}.on")


def disabled_codes(reading: Reading) -> Iterator[int]:
    """Yield the M codes that are defined but not enabled."""
    values = reading.values
    for code in reading.m_codes:
        path = f"m_codes.{code}.enabled"
        if code in _NUMBERS and values.has(path) and not values.flag(path):
            yield int(code)


def _never_off(reading: Reading) -> Iterator[Finding]:
    """Yield findings for outputs that an M code turns on but no code turns off; M12 handles the collet."""
    if any(path.startswith("m_codes.") for path in reading.values.wrong):
        return  # the invalid entry may be the missing code
    codes = list(enabled_codes(reading))
    off = {output for _, output, on in codes if not on} | set(NEEDED_OUTPUTS)
    for code, output, on in codes:
        if on and output not in off:
            expected = Message(
                "this M code switches {output} on, but no M code switches this output off; add "
                "an M code with on = false",
                output=output,
            )
            yield Finding(f"m_codes.{code}", "", expected, "broken-rule")


def _lamps(reading: Reading) -> Iterator[Finding]:
    """Yield findings about lamps, which the control switches automatically.

    A lamp must not indicate normal operation when the control has failed.
    """
    for name in (each for each in reading.outputs if each.startswith(PREFIX)):
        path = f"io.out.{name}"
        if name not in LAMPS:
            yield Finding(
                path,
                "",
                Message(
                    "a signal tower has the lamps {lamps}; use one of these names",
                    lamps=", ".join(LAMPS),
                ),
                "broken-rule",
            )
        elif reading.values.has(f"{path}.safe"):
            safe = reading.values.found[f"{path}.safe"]
            if safe == "keep" or (safe is True and name != RED):
                told = "true or false" if name == RED else "false"
                why = "while TurnDesk does not control the lamp, the lamp must not indicate normal operation"
                yield Finding(
                    Message("{path}.safe", path=path),
                    written(safe),
                    Message("this value must be {details}; {why}", details=told, why=why),
                    "broken-rule",
                )
    for code in reading.m_codes:
        path = f"m_codes.{code}.output"
        if reading.values.has(path) and reading.values.text(path) in LAMPS:
            yield Finding(
                path,
                written(reading.values.text(path)),
                "TurnDesk switches this lamp automatically; an M code cannot switch it",
                "broken-rule",
            )


def shared(file: FileReading, drivers: Sequence[Driver]) -> Iterator[Finding]:
    """Yield a finding for every signal or pot on a terminal that is already used, in any spelling."""
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
    """Yield a finding for every pot with an invalid range or switch."""
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


def absent_devices(file: FileReading) -> Iterator[Finding]:
    """Yield a finding for each signal at a device that this TurnDesk cannot read.

    Without this rule, a stop button on the pendant would be an input that never turns on.
    """
    analog = {f"io.analog.{name}": f"io.analog.{name}.at" for name in file.names("io.analog")}
    pots = {path: file.values.text(at) for path, at in analog.items() if file.values.has(at)}
    reserved = tuple(each for each in DEVICES if each not in file.prefixes)
    for path, terminal in {**file.terminals, **pots}.items():
        if terminal.startswith(reserved):
            why = "this TurnDesk is installed without support for this device; write another address"
            yield Finding(f"{path}.at", written(terminal), why, "absent-device")


def _backend(values: Values, drivers: Sequence[Driver]) -> Driver | None:
    return next(
        (each for each in drivers if each.backend and values.says("machine.backend", each.backend)), None
    )


def _on_the_screen(switch: str, values: Values, drivers: Sequence[Driver], inputs: Collection[str]) -> bool:
    """Return whether the switch is a button on the screen because no operator station is wired."""
    backend = _backend(values, drivers)
    wired = backend is not None and backend.inputs is not None
    return switch == STATION_SWITCH and not (wired and any(name in inputs for name in _BUTTONS))


def _line_to_add(file: FileReading, drivers: Sequence[Driver], switch: str) -> str:
    """Return the message with the line to add. Without its input, the switch would always be on AUTO."""
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
    """Return a value that is equal for two spellings of the same terminal."""
    for driver in drivers:
        found = driver.terminal(file, terminal) if driver.terminal is not None else None
        if found is not None:
            return found
    return terminal.strip().casefold()
