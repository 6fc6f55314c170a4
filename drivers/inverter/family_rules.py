"""Rules for the keys of an inverter family file.

Each address must be read only once, and every reported value must be at an address that is read.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from core.message import Message
from core.table_schema import FileFinding
from drivers.inverter.family_table import (
    ABSENT_REGISTER,
    FamilyTable,
    ParameterKeys,
    ReadRequestKeys,
    RegisterTable,
    StateKeys,
    WriteRequestKeys,
)

_PARITIES = {"N", "E", "O"}
_CODE_FORMAT_PATTERN = re.compile(r"[^{}]*\{code(:0?\d?[dX])?\}[^{}]*")
RegisterAddress = tuple[str, int]  # "register" or "coil", and its number


def check_family(table: FamilyTable) -> Iterator[FileFinding]:
    """Yield findings about invalid or contradictory values in a table whose types are correct."""
    said = table.serial_line.parity.split()
    if not said or not set(said) <= _PARITIES:
        yield _finding("line.parity", 'expected one or more of "N", "E" and "O"')
    yield from _parameters(table.parameters)
    if table.register_table is not None:
        yield from _registers(table.register_table)


def _finding(path: str, text: str) -> FileFinding:
    return FileFinding(path, "", text, "broken-rule")


def _parameters(parameters: Iterable[ParameterKeys]) -> Iterator[FileFinding]:
    taken: dict[int, str] = {}
    for number, each in enumerate(parameters, 1):
        path = f"parameter[{number}]"
        if (each.value == ABSENT_REGISTER) is (each.counts_per_s == 0.0):
            yield _finding(path, "expected either value or counts_per_s; use one of them")
        if each.value != ABSENT_REGISTER and not each.why.strip():
            yield _finding(f"{path}.why", "this value is missing; say what the value does")
        first = taken.setdefault(each.register, path)
        if first != path:
            yield _used(f"{path}.register", each.register, first)


def _used(path: str, register: int, first: str) -> FileFinding:
    text = "register {register} is already in {first}; use each register once"
    return _finding(path, Message(text, register=f"0x{register:04X}", first=first))


def _registers(table: RegisterTable) -> Iterator[FileFinding]:
    read: dict[RegisterAddress, str] = {}
    for number, each in enumerate(table.read_requests, 1):
        yield from _read(each, f"read[{number}]", read)
    written = {
        table.commanded_frequency.register + n: "frequency" for n in range(table.commanded_frequency.words)
    }
    for name, writes in table.command_writes.items():
        for number, write in enumerate(writes, 1):
            yield from _write(write, f"command.{name}[{number}]", written)
    for name, state in table.state_conditions.items():
        yield from _state(state, f"report.{name}", read)
    yield from _reported(table, read)
    yield from _code(table)


def _one_kind(each: ReadRequestKeys | WriteRequestKeys | StateKeys, path: str) -> Iterator[FileFinding]:
    if (each.register == ABSENT_REGISTER) is (each.coil == ABSENT_REGISTER):
        yield _finding(path, "expected either register or coil; use one of them")


def _addresses(each: ReadRequestKeys | StateKeys, count: int = 1) -> list[RegisterAddress]:
    kind, first = ("coil", each.coil) if each.register == ABSENT_REGISTER else ("register", each.register)
    return [(kind, first + n) for n in range(count)]


def _read(each: ReadRequestKeys, path: str, read: dict[RegisterAddress, str]) -> Iterator[FileFinding]:
    yield from _one_kind(each, path)
    addresses = _addresses(each, each.count)
    if addresses[-1][1] > 0xFFFF:
        yield _finding(f"{path}.count", "the last address is above 0xFFFF; use a smaller count")
    if twice := [address for address in addresses if address in read]:
        yield _used(path, twice[0][1], read[twice[0]])
    read |= dict.fromkeys(addresses, path)


def _write(each: WriteRequestKeys, path: str, written: dict[int, str]) -> Iterator[FileFinding]:
    yield from _one_kind(each, path)
    if (each.register == ABSENT_REGISTER) is not (each.value == ABSENT_REGISTER):
        yield _finding(path, "a register needs a value, and a coil needs on; correct the keys")
    if each.register in written:
        yield _used(path, each.register, written[each.register])


def _state(state: StateKeys, path: str, read: dict[RegisterAddress, str]) -> Iterator[FileFinding]:
    yield from _one_kind(state, path)
    if state.register != ABSENT_REGISTER and not state.values:
        yield _finding(f"{path}.values", "this value is missing; list the values for which the state is on")
    if [value for value in state.values if value != int(value) & state.mask]:
        yield _finding(f"{path}.values", "a value has bits outside mask; correct mask or values")
    yield from _unread(path, _addresses(state), read)


def _reported(table: RegisterTable, read: dict[RegisterAddress, str]) -> Iterator[FileFinding]:
    for name, each in (("output", table.output_frequency), ("setpoint", table.reported_setpoint)):
        addresses = [("register", each.register + n) for n in range(each.words)]
        yield from _unread(f"report.{name}", addresses, read)
    yield from _unread("report.current", [("register", table.output_current.register)], read)


def _unread(
    path: str, addresses: Iterable[RegisterAddress], read: dict[RegisterAddress, str]
) -> Iterator[FileFinding]:
    for kind, address in addresses:
        if address != ABSENT_REGISTER and (kind, address) not in read:
            text = "{kind} {address} is not in any read; add it to a [[read]] table"
            yield _finding(path, Message(text, kind=kind, address=f"0x{address:04X}"))


def _code(table: RegisterTable) -> Iterator[FileFinding]:
    if not _CODE_FORMAT_PATTERN.fullmatch(table.fault_code.shown):
        yield _finding("report.fault_code.shown", "expected text with one {code}, {code:02d} or {code:04X}")
    if "fault" not in table.state_conditions and not table.is_fault_code_polled:
        text = "a fault code that is not in any read needs report.fault; add the fault state or the read"
        yield _finding("report.fault_code", text)
