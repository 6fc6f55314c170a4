"""Whether the terminals of a machine on a CAN bus are bits and words that its modules can have."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from core.machine.errors import Finding
from core.machine.hardware.addresses import PLAIN_MODULE, CanTerminal, can_terminal
from core.machine.hardware.reading import HardwareReading
from core.machine.schema import written

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
