"""Command-line check of suspicious offset changes.

A change that exceeds the axis travel is rejected. Any other suspicious change must be confirmed by --yes,
or by Y on a terminal. The rules are the same as on the screen.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError
from app.offsets.change_rules import (
    SuspicionReason,
    SuspiciousChange,
    TravelLimits,
    describe_suspicious_changes,
    find_following_tools,
    find_suspicious_table_changes,
    find_travel_limits,
)
from core.message import Message
from core.store.store_rows import FIELDS_BY_KIND, MM_PER_INCH, FieldType, FieldValue, OffsetKind
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from core.store.store import Store

OffsetChanges = Mapping[OffsetKind, Mapping[int, Mapping[str, FieldValue]]]


def confirm_changes(store: Store, args: argparse.Namespace, changes: OffsetChanges) -> None:
    """Require the user to confirm suspicious offset changes before they are saved.

    Raises CommandError if a value exceeds the axis travel, if a suspicious change is not confirmed, or if
    the machine file with the travel limits is invalid. The option --yes confirms suspicious changes, but
    does not permit a value that exceeds the travel. The store itself rejects values that are out of range.
    """
    travel = _machine_travel(store, args)
    tables = {kind: store.offsets.get_table(kind).read_rows() for kind in changes}
    found = {
        kind: find_suspicious_table_changes(kind, tables[kind], rows, travel)
        for kind, rows in changes.items()
    }
    beyond = {kind: _only_travel(each) for kind, each in found.items() if _only_travel(each)}
    if beyond:
        raise CommandError(
            Message(
                "{beyond}; the travel is {travel}. Correct the value, or touch the tool off on the Jog page",
                beyond=_describe_suspicions(beyond, ()),
                travel=_travel_words(travel),
            ),
            "beyond-travel",
        )
    if args.yes or not any(found.values()):
        return
    doubted = _describe_suspicions(found, tables.get(OffsetKind.TOOL, {}))
    if not sys.stdin.isatty():
        raise CommandError(Message("{doubted}; add --yes to confirm", doubted=doubted), "not-confirmed")
    sys.stderr.write(Message("{doubted}. To make this change, press Y and Enter: ", doubted=doubted))
    sys.stderr.flush()
    if sys.stdin.readline().strip().upper() != "Y":
        raise CommandError("you did not press Y; nothing was changed", "not-confirmed")


def _only_travel(found: tuple[SuspiciousChange, ...]) -> tuple[SuspiciousChange, ...]:
    return tuple(each for each in found if each.kind is SuspicionReason.OUTSIDE_TRAVEL)


def _machine_travel(store: Store, args: argparse.Namespace) -> TravelLimits:
    """Return the axis travel of the command's machine in mm.

    Raises CommandError if the machine file is invalid.
    """
    from app.compose.machine.machine_setup import load_machine_in_use, read_machine

    return find_travel_limits(
        read_machine(args.machine) if args.machine else load_machine_in_use(store.settings)
    )


def _describe_suspicions(
    suspicions: Mapping[OffsetKind, tuple[SuspiciousChange, ...]], tools: Iterable[int]
) -> str:
    """Return one message that describes all suspicious changes.

    ``tools`` are the numbers of the tools that may follow a master tool.
    """
    texts = (
        describe_suspicious_changes(each, partial(_format_change, kind), partial(_reason, tools))
        for kind, each in suspicions.items()
        if each
    )
    return ", ".join(texts)


def _reason(tools: Iterable[int], each: SuspiciousChange) -> str:
    if each.kind is SuspicionReason.NEW_MASTER:
        return f"followers: {', '.join(map(format_edge_name, find_following_tools(tools, each.row_number)))}"
    words = {
        SuspicionReason.OUTSIDE_TRAVEL: "the value is outside the axis travel",
        SuspicionReason.WRONG_SIDE: "the tool would cut on the other side of the part",
        SuspicionReason.LARGE_CHANGE: "the change is unusually large",
    }
    return words[each.kind]


def _format_change(kind: OffsetKind, suspicion: SuspiciousChange) -> str:
    """Return a change as text, such as ``T1 x +1.20000 → -15.00000 in``."""
    letter = {
        OffsetKind.TOOL: format_edge_name(suspicion.row_number),
        OffsetKind.SECONDARY: f"D{suspicion.row_number}",
    }
    name = letter.get(kind, f"TOOL{suspicion.row_number}")
    field = FIELDS_BY_KIND[kind][suspicion.name]
    old = "not set" if suspicion.old_value is None else _shown(field.field_type, suspicion.old_value)
    unit = {FieldType.LENGTH: " in", FieldType.METRIC_LENGTH: " mm"}.get(field.field_type, "")
    return f"{name} {suspicion.name} {old} → {_shown(field.field_type, suspicion.new_value)}{unit}"


def _shown(sort: FieldType, value: FieldValue) -> str:
    if sort is FieldType.LENGTH:
        return f"{float(value) / MM_PER_INCH:+.5f}"
    return f"{value:+.3f}" if sort is FieldType.METRIC_LENGTH else ("yes" if value else "no")


def _travel_words(travel: TravelLimits) -> str:
    return ", ".join(
        Message(
            "{name} {low}…{high} in",
            name=name,
            low=f"{low / MM_PER_INCH:.4g}",
            high=f"{high / MM_PER_INCH:.4g}",
        )
        for name, (low, high) in travel.items()
    )
