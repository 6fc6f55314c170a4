"""Suspicious offset changes on the command line: rejected beyond the travel, otherwise confirmed.

A change is confirmed by --yes, or by Y on a terminal. The rules are the same as on the screen.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError
from app.offsets.change_rules import (
    Doubt,
    Suspicion,
    Travel,
    described,
    followers,
    suspicions_of,
    travel_of,
)
from core.message import Message
from core.store.store_rows import FIELDS, MM_PER_INCH, Kind, Sort, Value
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from core.store.store import Store

Changes = Mapping[Kind, Mapping[int, Mapping[str, Value]]]


def demand_meant(store: Store, args: argparse.Namespace, changes: Changes) -> None:
    """Raise CommandError if a value exceeds the travel, or if a suspicious change is not confirmed.

    The store itself rejects values out of range.
    """
    travel = _machine_travel(store, args)
    tables = {kind: store.offsets.table(kind).read_rows() for kind in changes}
    found = {kind: suspicions_of(kind, tables[kind], rows, travel) for kind, rows in changes.items()}
    beyond = {kind: _only_travel(each) for kind, each in found.items() if _only_travel(each)}
    if beyond:
        raise CommandError(
            Message(
                "{beyond}; the travel is {travel}. Correct the value, or touch the tool off on the Jog page",
                beyond=_described(beyond, ()),
                travel=_travel_words(travel),
            ),
            "beyond-travel",
        )
    if args.yes or not any(found.values()):
        return
    doubted = _described(found, tables.get(Kind.TOOL, {}))
    if not sys.stdin.isatty():
        raise CommandError(Message("{doubted}; add --yes to confirm", doubted=doubted), "not-confirmed")
    sys.stderr.write(Message("{doubted}. To make this change, press Y and Enter: ", doubted=doubted))
    sys.stderr.flush()
    if sys.stdin.readline().strip().upper() != "Y":
        raise CommandError("you did not press Y; nothing was changed", "not-confirmed")


def _only_travel(found: tuple[Suspicion, ...]) -> tuple[Suspicion, ...]:
    return tuple(each for each in found if each.doubt is Doubt.TRAVEL)


def _machine_travel(store: Store, args: argparse.Namespace) -> Travel:
    """Return the travel of the command's machine in mm. Raises CommandError if its file is invalid."""
    from app.compose.machine.machine_setup import machine_in_use, read_machine

    return travel_of(read_machine(args.machine) if args.machine else machine_in_use(store.settings))


def _described(found: Mapping[Kind, tuple[Suspicion, ...]], tools: Iterable[int]) -> str:
    """Return one text for all suspicious changes; ``tools`` are the tools that may follow a master tool."""
    texts = (
        described(each, partial(_named, kind), partial(_reason, tools))
        for kind, each in found.items()
        if each
    )
    return ", ".join(texts)


def _reason(tools: Iterable[int], each: Suspicion) -> str:
    if each.doubt is Doubt.MASTER:
        return f"followers: {', '.join(map(edge_name, followers(tools, each.number)))}"
    words = {
        Doubt.TRAVEL: "the value is outside the axis travel",
        Doubt.SIDE: "the tool would cut on the other side of the part",
        Doubt.LARGE: "the change is unusually large",
    }
    return words[each.doubt]


def _named(kind: Kind, each: Suspicion) -> str:
    """Return a change as text, such as T1 x +1.20000 → -15.00000 in."""
    letter = {Kind.TOOL: edge_name(each.number), Kind.SECONDARY: f"D{each.number}"}
    name = letter.get(kind, f"TOOL{each.number}")
    field = FIELDS[kind][each.name]
    old = "not set" if each.old is None else _shown(field.sort, each.old)
    unit = {Sort.LENGTH: " in", Sort.METRIC: " mm"}.get(field.sort, "")
    return f"{name} {each.name} {old} → {_shown(field.sort, each.new)}{unit}"


def _shown(sort: Sort, value: Value) -> str:
    if sort is Sort.LENGTH:
        return f"{float(value) / MM_PER_INCH:+.5f}"
    return f"{value:+.3f}" if sort is Sort.METRIC else ("yes" if value else "no")


def _travel_words(travel: Travel) -> str:
    return ", ".join(
        Message(
            "{name} {low}…{high} in",
            name=name,
            low=f"{low / MM_PER_INCH:.4g}",
            high=f"{high / MM_PER_INCH:.4g}",
        )
        for name, (low, high) in travel.items()
    )
