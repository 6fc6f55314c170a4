"""Suspicious changes of offsets on the command line: refused beyond the travel, else they need consent.

Consent is --yes, or Y at a terminal. The rule itself is the same as at the screen.
"""

from __future__ import annotations

import argparse
import sys

from app.desk.command_errors import CommandError
from app.offsets.suspicious_changes import Doubt, Suspicion, Travel, described, travel_of
from core.store.offset_fields import MM_PER_INCH, Sort
from core.store.store_rows import FIELDS, Kind, Value
from core.tool_edges import edge_name

_REASONS = {
    Doubt.TRAVEL: "beyond the travel",
    Doubt.SIDE: "the other side of the part",
    Doubt.LARGE: "a large change",
    Doubt.MASTER: "the other tools follow it",
}


def add_yes_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--yes``."""
    parser.add_argument(
        "--yes", action="store_true", help="change offsets by large amounts too; without it you are asked"
    )


def machine_travel(args: argparse.Namespace) -> Travel:
    """Return the travel of the machine of this command, mm. Raises CommandError for a bad machine file."""
    from app.compose.machine_setup import read_machine

    return travel_of(read_machine(getattr(args, "machine", None)))


def demand_meant(args: argparse.Namespace, found: dict[Kind, tuple[Suspicion, ...]], travel: Travel) -> None:
    """Raise CommandError for a value beyond the travel, or for a suspicious change without consent."""
    beyond = {kind: _only_travel(each) for kind, each in found.items() if _only_travel(each)}
    if beyond:
        raise CommandError(
            f"{_changes(beyond)}; the travel is {_travel_words(travel)}. "
            "Correct the value, or touch the tool off on the Jog page",
            "beyond-travel",
        )
    doubted = {kind: each for kind, each in found.items() if each}
    if not doubted or args.yes:
        return
    if not sys.stdin.isatty():
        raise CommandError(f"{_changes(doubted)}; give --yes if you mean it", "not-confirmed")
    sys.stderr.write(f"{_changes(doubted)}. Press Y and Return to change it: ")
    sys.stderr.flush()
    if sys.stdin.readline().strip().upper() != "Y":
        raise CommandError("you did not press Y; nothing was changed", "not-confirmed")


def _only_travel(found: tuple[Suspicion, ...]) -> tuple[Suspicion, ...]:
    return tuple(each for each in found if each.doubt is Doubt.TRAVEL)


def _changes(found: dict[Kind, tuple[Suspicion, ...]]) -> str:
    texts = (
        described(each, lambda one, kind=kind: _named(kind, one), lambda doubt: _REASONS[doubt])  # type: ignore[misc]
        for kind, each in found.items()
    )
    return ", ".join(texts)


def _named(kind: Kind, each: Suspicion) -> str:
    """T1 x +1.20000 → -15.00000 in"""
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
        f"{name} {low / MM_PER_INCH:.4g}…{high / MM_PER_INCH:.4g} in" for name, (low, high) in travel.items()
    )
