"""Rules for outputs, inputs, interlocks, M codes and terminals of a machine file."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from core.machine.hardware_model import LAMP_NAMES, LAMP_PREFIX, RED
from core.machine.machine_reading import MachineReading
from core.machine.machine_tables import FIXED_M_CODES, LANGUAGES
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import DriverDeclaration, FileFinding, FileValues, MachineFileReading

DEVICE_PREFIXES = ("pendant.",)
"""Prefixes of device addresses that optional features read."""

# Codes of the language and the outputs they switch.
REQUIRED_OUTPUTS = {
    "coolant": "M08 and M09 need this output to switch the coolant",
    "collet": ("M12 and M13 need this output to close and open the collet"),
}
ESTOP_INPUT = "estop"
_NUMBERS = frozenset(str(number) for number in range(1000))
SPINDLE_SWITCH_INPUT = "spindle_auto"  # the AUTO/OFF switch of an operator station
_BUTTONS = ("start", "hold")  # a machine without these inputs uses the station on the screen
_POT_MAXIMA = {"feed_pot": 1.5, "spindle_pot": 1.0}


def check_signals(reading: MachineReading) -> Iterator[FileFinding]:
    """Yield all findings about signals."""
    yield from _needed(reading)
    yield from _m_codes(reading)
    yield from _check_outputs_turn_off(reading)
    yield from _check_lamps(reading)


def map_terminals_by_signal(reading: MachineReading) -> dict[str, str]:
    """Return the terminal of each signal, by the key path of the signal."""
    paths = [f"io.out.{name}" for name in reading.outputs] + [f"io.in.{name}" for name in reading.inputs]
    values = reading.values
    return {path: values.text(f"{path}.at") for path in paths if values.has_values(f"{path}.at")}


def _needed(reading: MachineReading) -> Iterator[FileFinding]:
    for name, why in REQUIRED_OUTPUTS.items():
        there = {*reading.outputs, *reading.missing_outputs}
        if name not in there and not (name == "collet" and reading.kind != "lathe"):
            yield FileFinding(
                f"io.out.{name}",
                "",
                Message(
                    "this output is missing; {why}. If the machine does not have this output, "
                    'write {{ at = "none" }}',
                    why=why,
                ),
                "missing",
            )
    needed = {ESTOP_INPUT: "TurnDesk needs this input to monitor the E-stop"}
    values = reading.values
    if values.has_values("interlocks.two_hand_start") and values.read_flag("interlocks.two_hand_start"):
        needed["start"] = "interlocks.two_hand_start needs the output of the two-hand relay"
    if values.has_values("interlocks.spindle_with_collet_open") and not values.read_flag(
        "interlocks.spindle_with_collet_open"
    ):
        needed["collet_closed"] = "TurnDesk needs this input to reject a spindle start with the collet open"
    for name, why in needed.items():
        if name not in reading.inputs:
            yield FileFinding(
                Message("io.in.{name}", name=name), "", Message("missing; {why}", why=why), "missing"
            )


def _m_codes(reading: MachineReading) -> Iterator[FileFinding]:
    for code in reading.m_codes:
        path = f"m_codes.{code}"
        if code not in _NUMBERS:
            yield FileFinding(
                path,
                "",
                "this key must be the number of an M code, 0…999, without a leading zero",
                "broken-rule",
            )
        elif int(code) in FIXED_M_CODES[_mdi_language(reading)]:
            yield FileFinding(
                path,
                "",
                Message("M{code} has a fixed meaning; use a free M code", code=f"{int(code):02d}"),
                "broken-rule",
            )
        elif reading.values.has_values(f"{path}.output"):
            output = reading.values.text(f"{path}.output")
            if output not in reading.outputs:
                known = ", ".join(reading.outputs)
                yield FileFinding(
                    f"{path}.output",
                    format_toml_value(output),
                    Message("this value must be an output in [io.out]: {known}", known=known),
                    "broken-rule",
                )


def _mdi_language(reading: MachineReading) -> str:
    """Return the MDI language, or the default language of the kind of machine if it is invalid."""
    said = str(reading.values.values_by_path.get("machine.language"))
    return said if said in FIXED_M_CODES else LANGUAGES[reading.kind][0]


def list_ignored_m_codes(reading: MachineReading) -> Iterator[int]:
    """Yield the M codes that have no effect on this machine."""
    for code in reading.m_codes:
        keys = f"m_codes.{code}.ignored", f"m_codes.{code}.enabled"
        if code in _NUMBERS and reading.values.has_values(*keys) and all(map(reading.values.read_flag, keys)):
            yield int(code)


def list_enabled_m_codes(reading: MachineReading) -> Iterator[tuple[int, str, bool]]:
    """Yield the number, output and output state of every complete and enabled M code."""
    values = reading.values
    for code in reading.m_codes:
        path = f"m_codes.{code}"
        whole = code in _NUMBERS and values.has_values(f"{path}.output", f"{path}.on", f"{path}.enabled")
        if whole and values.read_flag(f"{path}.enabled"):
            yield int(code), values.text(f"{path}.output"), values.read_flag(f"{path}.on")


def list_disabled_m_codes(reading: MachineReading) -> Iterator[int]:
    """Yield the M codes that are defined but not enabled."""
    values = reading.values
    for code in reading.m_codes:
        path = f"m_codes.{code}.enabled"
        if code in _NUMBERS and values.has_values(path) and not values.read_flag(path):
            yield int(code)


def _check_outputs_turn_off(reading: MachineReading) -> Iterator[FileFinding]:
    """Yield findings for outputs that an M code turns on but no M code turns off.

    The collet is an exception, because M12 and M13 switch it.
    """
    if any(path.startswith("m_codes.") for path in reading.values.invalid_paths):
        return  # the invalid entry may be the missing code
    codes = list(list_enabled_m_codes(reading))
    off = {output for _, output, on in codes if not on} | set(REQUIRED_OUTPUTS)
    for code, output, on in codes:
        if on and output not in off:
            expected = Message(
                "this M code switches {output} on, but no M code switches this output off; add "
                "an M code with on = false",
                output=output,
            )
            yield FileFinding(f"m_codes.{code}", "", expected, "broken-rule")


def _check_lamps(reading: MachineReading) -> Iterator[FileFinding]:
    """Yield findings about invalid lamps. The control switches the lamps automatically.

    A lamp must not indicate normal operation when the control has failed.
    """
    for name in (each for each in reading.outputs if each.startswith(LAMP_PREFIX)):
        path = f"io.out.{name}"
        if name not in LAMP_NAMES:
            yield FileFinding(
                path,
                "",
                Message(
                    "a signal tower has the lamps {lamps}; use one of these names",
                    lamps=", ".join(LAMP_NAMES),
                ),
                "broken-rule",
            )
        elif reading.values.has_values(f"{path}.safe"):
            safe = reading.values.values_by_path[f"{path}.safe"]
            if safe == "keep" or (safe is True and name != RED):
                accepted_values = "true or false" if name == RED else "false"
                why = "while TurnDesk does not control the lamp, the lamp must not indicate normal operation"
                yield FileFinding(
                    Message("{path}.safe", path=path),
                    format_toml_value(safe),
                    Message("this value must be {details}; {why}", details=accepted_values, why=why),
                    "broken-rule",
                )
    for code in reading.m_codes:
        path = f"m_codes.{code}.output"
        if reading.values.has_values(path) and reading.values.text(path) in LAMP_NAMES:
            yield FileFinding(
                path,
                format_toml_value(reading.values.text(path)),
                "TurnDesk switches this lamp automatically; an M code cannot switch it",
                "broken-rule",
            )


def check_shared_terminals(
    file: MachineFileReading, drivers: Sequence[DriverDeclaration]
) -> Iterator[FileFinding]:
    """Yield a finding for every signal or analog input on a terminal that is already used.

    Different spellings of the same terminal are recognized.
    """
    taken: dict[object, str] = {}
    places = {f"{path}.at": terminal for path, terminal in file.terminals.items()}
    places |= {f"{path}.at": terminal for path, terminal in file.find_wired_pots().items()}
    for place, terminal in places.items():
        owner = place.removesuffix(".at")
        first = taken.setdefault(_normalize_terminal(file, drivers, terminal), owner)
        if first != owner:
            expected = Message("{first} already uses this terminal; choose another terminal", first=first)
            yield FileFinding(place, format_toml_value(terminal), expected, "broken-rule")


def check_potentiometers(
    file: MachineFileReading, drivers: Sequence[DriverDeclaration]
) -> Iterator[FileFinding]:
    """Yield a finding for every potentiometer with an invalid range or switch."""
    values = file.file_values
    there = (*file.terminals, *(path.removesuffix(".at") for path in values.invalid_paths))
    inputs = {path.removeprefix("io.in.") for path in there if path.startswith("io.in.")}
    for name in file.list_table_keys("io.analog"):
        path = f"io.analog.{name}"
        switch = values.text(f"{path}.switch") if values.has_values(f"{path}.switch") else ""
        if switch and switch not in inputs and not _is_screen_button(switch, values, drivers, inputs):
            yield FileFinding(
                f"{path}.switch",
                format_toml_value(switch),
                _suggest_line(file, drivers, switch),
                "broken-rule",
            )
        if values.has_values(f"{path}.range") and (top := _POT_MAXIMA.get(name)) is not None:
            low, high = values.read_pair(f"{path}.range")
            if not 0.0 <= low < high <= top:
                yield FileFinding(
                    f"{path}.range",
                    Message("[{low}, {high}]", low=f"{low:g}", high=f"{high:g}"),
                    Message("the range limits are fractions and must be between 0 and {top}", top=f"{top:g}"),
                    "broken-rule",
                )


def check_missing_devices(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding for each terminal on a device that this installation does not support.

    Without this rule, a stop button on such a device would be an input that never turns on.
    """
    analog = {f"io.analog.{name}": f"io.analog.{name}.at" for name in file.list_table_keys("io.analog")}
    pots = {path: file.file_values.text(at) for path, at in analog.items() if file.file_values.has_values(at)}
    reserved = tuple(each for each in DEVICE_PREFIXES if each not in file.address_prefixes)
    for path, terminal in {**file.terminals, **pots}.items():
        if terminal.startswith(reserved):
            why = "this TurnDesk is installed without support for this device; write another address"
            yield FileFinding(f"{path}.at", format_toml_value(terminal), why, "absent-device")


def _backend(values: FileValues, drivers: Sequence[DriverDeclaration]) -> DriverDeclaration | None:
    return next(
        (
            each
            for each in drivers
            if each.backend_name and values.has_text("machine.backend", each.backend_name)
        ),
        None,
    )


def _is_screen_button(
    switch: str, values: FileValues, drivers: Sequence[DriverDeclaration], inputs: Collection[str]
) -> bool:
    """Return whether a switch is a button on the screen, because no operator station is wired."""
    backend = _backend(values, drivers)
    wired = backend is not None and backend.inputs is not None
    return switch == SPINDLE_SWITCH_INPUT and not (wired and any(name in inputs for name in _BUTTONS))


def _suggest_line(file: MachineFileReading, drivers: Sequence[DriverDeclaration], switch: str) -> str:
    """Return a message that suggests a line for [io.in] that defines an input for this switch.

    Without an input, the switch would always be at AUTO.
    """
    backend = _backend(file.file_values, drivers)
    terminal = _free_input(file, drivers, backend) if backend is not None else "IN-…"
    key = switch if switch.replace("_", "").isalnum() else format_toml_value(switch)
    return Message(
        "this switch must be an input in [io.in]; add this line to that table: {key} = "
        '{{ at = "{terminal}" }}',
        key=key,
        terminal=terminal,
    )


def _free_input(
    file: MachineFileReading, drivers: Sequence[DriverDeclaration], backend: DriverDeclaration
) -> str:
    if backend.inputs is None:
        return "IN-…"
    taken = {_normalize_terminal(file, drivers, terminal) for terminal in file.terminals.values()}
    return next(each for each in backend.inputs() if _normalize_terminal(file, drivers, each) not in taken)


def _normalize_terminal(
    file: MachineFileReading, drivers: Sequence[DriverDeclaration], terminal: str
) -> object:
    """Return a normal form of a terminal name, which is equal for all spellings of the terminal."""
    for driver in drivers:
        found = driver.normalize_terminal(file, terminal) if driver.normalize_terminal is not None else None
        if found is not None:
            return found
    return terminal.strip().casefold()
