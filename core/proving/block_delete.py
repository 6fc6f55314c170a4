"""Block delete: a program with ``/`` is proved with the switch on and off, for it may stand either way.

Cycle Start goes by the switch as it stands. What is wrong with it the other way alone is a warning: to turn
the switch is to prove the program again.
"""

from __future__ import annotations

import re
from dataclasses import replace

from core.language.diagnostics import Severity
from core.language.source import Dialect, Source
from core.message import Message
from core.proving.proof_report import Report, Ways, in_order

# / is first on a line; SINUMERIK and Klartext let the number of the block stand before it.
_DELETED = {
    Dialect.OMNITURN: re.compile(r"^[^\S\n]*/", re.MULTILINE),
    Dialect.SINUMERIK: re.compile(r"^[^\S\n]*(?:[N:][^\S\n]*[0-9]+[^\S\n]*)?/", re.MULTILINE | re.IGNORECASE),
    Dialect.KLARTEXT: re.compile(r"^[^\S\n]*(?:[0-9]+[^\S\n]*)?/", re.MULTILINE),
}


def deletes_blocks(source: Source) -> bool:
    """Whether ``/`` stands before a line of the program or of its subprograms."""
    return ("/" in source.text and _DELETED[source.dialect].search(source.text) is not None) or any(
        map(deletes_blocks, source.subprograms)
    )


def with_the_other(report: Report, other: Report, *, deleted: bool) -> Report:
    """The report of the switch as it stands, with warnings of what was found with it the other way."""
    known = {(found.line, found.code, found.severity) for found in report.diagnostics}
    switch = "on" if deleted else "off"
    found = [
        replace(
            each,
            severity=Severity.WARNING,
            message=Message("With block delete {switch}: {item}", switch=switch, item=each.message),
        )
        for each in other.diagnostics
        if each.severity is not Severity.NOTE and (each.line, each.code, each.severity) not in known
    ]
    (low, high), (other_low, other_high) = report.ways.cycle, other.ways.cycle
    return replace(
        report,
        diagnostics=in_order([*report.diagnostics, *found]),
        ways=Ways(
            report.ways.proved + other.ways.proved,
            report.ways.unproved + other.ways.unproved,
            (min(low, other_low), max(high, other_high)),
        ),
    )
