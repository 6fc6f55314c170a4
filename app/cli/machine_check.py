"""What ``turndesk machine check`` does."""

from __future__ import annotations

import json
import sys

from app.cli.errors import EXIT_ERRORS, EXIT_OK, EXIT_USAGE
from core.machine.load import MachineFileError, named_machine
from core.machine.model import Machine
from core.ports import DriverError

Row = tuple[str, str, str]
# States that are no trouble: an E-stop that is pressed answers as it should.
_GOOD = ("ok", "on", "off", "E-stop")


def check(file: str | None, *, json_wanted: bool) -> int:
    """Validates, connects and reports; answers the exit status."""
    try:
        machine = named_machine(file)
    except MachineFileError as error:
        errors = [finding._asdict() for finding in error.errors]
        _report(json_wanted, {"file": error.source, "errors": errors, "ports": []})
        sys.stderr.write("".join(f"turndesk: {error.source}: {finding}\n" for finding in error.errors))
        return EXIT_USAGE
    rows, warnings, trouble = _connected(machine)
    ports = [dict(zip(("name", "state", "detail"), row, strict=True)) for row in rows]
    _report(
        json_wanted,
        {
            "file": machine.source,
            "machine": machine.name,
            "backend": machine.backend,
            "errors": [],
            "ports": ports,
            "warnings": warnings,
        },
    )
    if not json_wanted:
        _write_table(machine, rows)
    sys.stderr.write("".join(f"turndesk: {machine.source}: {text}\n" for text in (*warnings, *trouble)))
    return EXIT_ERRORS if trouble else EXIT_OK


def _connected(machine: Machine) -> tuple[list[Row], list[str], list[str]]:
    """What the ports answer, what is worth knowing, and what is wrong."""
    from app.compose.checking import check_ports

    try:
        rows, warnings = check_ports(machine)
    except DriverError as error:
        return [], [], [str(error)]
    bad = [f"{name}: {state} {detail}".rstrip() for name, state, detail in rows if state not in _GOOD]
    return rows, warnings, bad


def _report(json_wanted: bool, report: dict[str, object]) -> None:
    if json_wanted:
        sys.stdout.write(json.dumps(report) + "\n")


def _write_table(machine: Machine, rows: list[Row]) -> None:
    width = max((len(name) for name, _, _ in rows), default=0)
    sys.stdout.write(f"{machine.source} is good: {machine.name}, backend {machine.backend}\n")
    sys.stdout.write(
        "".join(f"  {name:<{width}}  {state:<4} {detail}".rstrip() + "\n" for name, state, detail in rows)
    )
