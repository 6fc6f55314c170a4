"""What ``turndesk machine check`` does."""

from __future__ import annotations

import json
import sys
import textwrap
from collections.abc import Iterator, Sequence

from app.cli.errors import EXIT_ERRORS, EXIT_OK, EXIT_USAGE, CommandError
from core.machine.changes import Change
from core.machine.load import MachineFileError, named_machine
from core.machine.model import Machine

WIDTH = 80
Rows = Sequence[tuple[str, str, str, str]]  # name, where it hangs, state, detail


def check(file: str | None, *, json_wanted: bool) -> int:
    """Validates, connects and reports; answers the exit status."""
    from app.compose.checking import check_ports

    try:
        machine = named_machine(file)
    except MachineFileError as error:
        errors = [finding._asdict() for finding in error.errors]
        _report(json_wanted, {"file": error.source, "errors": errors, "ports": []})
        sys.stderr.write("".join(f"turndesk: {error.source}: {finding}\n" for finding in error.errors))
        return EXIT_USAGE
    answers, told = check_ports(machine), _changed(machine)
    _report(
        json_wanted,
        {
            "file": machine.source,
            "machine": machine.name,
            "backend": machine.backend,
            "errors": [],
            "changes": [change._asdict() for change in told],
            "ports": [row._asdict() for row in answers.rows],
            "warnings": answers.warnings,
            "trouble": answers.trouble,
        },
    )
    if not json_wanted:
        sys.stdout.write(f"{machine.source} is good: {machine.name}, backend {machine.backend}\n")
        sys.stdout.write("".join(f"{line}\n" for line in table(answers.rows)))
        sys.stdout.write("".join(f"  changed since it was accepted: {change}\n" for change in told))
    said = (*answers.warnings, *answers.trouble)
    sys.stderr.write("".join(f"turndesk: {machine.source}: {text}\n" for text in said))
    return EXIT_ERRORS if answers.trouble else EXIT_OK


def _changed(machine: Machine) -> Sequence[Change]:
    """What differs from the accepted file; nothing where no store can be read."""
    from app.cli.machine_accept import changed

    try:
        return changed(machine)
    except CommandError as error:
        sys.stderr.write(f"turndesk: {error}\n")
        return ()


def table(rows: Rows) -> Iterator[str]:
    """Lines of at most 80 characters; a detail that is longer goes on below itself."""
    widths = [max((len(row[column]) for row in rows), default=0) for column in range(3)]
    start = " " * (2 + sum(width + 2 for width in widths))
    for *cells, detail in rows:
        head = "  " + "".join(f"{cell:<{width}}  " for cell, width in zip(cells, widths, strict=True))
        text = textwrap.wrap(detail, max(WIDTH - len(start), 30)) or [""]
        yield (head + text[0]).rstrip()
        yield from (start + more for more in text[1:])


def _report(json_wanted: bool, report: dict[str, object]) -> None:
    if json_wanted:
        sys.stdout.write(json.dumps(report) + "\n")
