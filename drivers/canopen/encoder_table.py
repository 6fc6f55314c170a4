"""[spindle.encoder] of the machine file: an encoder on the bus, for a spindle that an inverter turns."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from core.table_schema import DriverTable, Field, FileReading, Finding, Kind, Values, written
from drivers.canopen.canopen_nodes import DRIVE, ENCODER_PROFILE, MODULE, NODES, profile_of, sdo_address

ENCODER, POSITION = "spindle.encoder", "6004:0"  # the table, and where a node of CiA 406 has its counts
_LEAST = 16  # counts a turn of an encoder
_FIELDS = (
    Field("node", Kind.TEXT),
    Field("object", Kind.TEXT, default=""),
    Field("counts_per_rev", Kind.WHOLE, low=-100_000_000, high=100_000_000),
)


@dataclass(frozen=True, slots=True)
class EncoderTable:
    """An encoder on the spindle, on the bus: a node of its own, or a drive's second input."""

    node: str  # name in [canopen.nodes]
    index: int
    sub: int
    counts_per_rev: int  # negative: it counts down with M03


def _table(file: FileReading) -> EncoderTable:
    values = file.values
    index, sub = sdo_address(values.text(f"{ENCODER}.object") or POSITION) or (0, 0)
    counts = values.whole(f"{ENCODER}.counts_per_rev")
    return EncoderTable(values.text(f"{ENCODER}.node"), index, sub, counts)


def _rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if ENCODER in file.tables:
        yield from _beside(values)
        yield from _counts(file)
    used = values.text(f"{ENCODER}.node") if values.has(f"{ENCODER}.node") else ""
    for name in file.names(NODES):
        path = f"{NODES}.{name}.profile"
        number = values.whole(path) if values.has(path) else MODULE
        if number not in {MODULE, DRIVE, ENCODER_PROFILE}:
            yield Finding(path, str(number), "expected 401 (terminals), 402 (a drive) or 406 (an encoder)")
        elif number == ENCODER_PROFILE and name != used:
            why = f"nobody reads this encoder; {ENCODER} names the one that is read"
            yield Finding(path, str(number), why)


def _beside(values: Values) -> Iterator[Finding]:
    if values.has("machine.backend") and values.text("machine.backend") != "canopen":
        backend = written(values.text("machine.backend"))
        yield Finding(ENCODER, "", f"backend {backend} reads no encoder on a bus; take it out")
    if values.has("spindle.driver") and values.text("spindle.driver") != "vfd":
        expected = (
            'expected spindle.driver = "vfd": a drive on the bus has its own, counts_per_rev of its node'
        )
        yield Finding(ENCODER, "", expected)
    path = f"{ENCODER}.counts_per_rev"
    if values.has(path) and abs(values.number(path)) < _LEAST:
        expected = f"expected {_LEAST} or more; negative where it counts down with M03"
        yield Finding(path, f"{values.number(path):g}", expected)


def _counts(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if not values.has(f"{ENCODER}.node", f"{ENCODER}.object"):
        return
    node, counted = values.text(f"{ENCODER}.node"), values.text(f"{ENCODER}.object")
    if node not in file.names(NODES):
        yield Finding(
            f"{ENCODER}.node", written(node), "expected a node of [canopen.nodes] with profile = 406"
        )
    elif profile_of(file, node) == MODULE:
        yield Finding(
            f"{ENCODER}.node", written(node), "terminals do not count turns: expected 406 or a drive"
        )
    elif profile_of(file, node) == DRIVE and not counted:
        expected = 'missing; a drive has its second encoder where its manual says: "60E4:1"'
        yield Finding(f"{ENCODER}.object", "", expected)
    if counted and sdo_address(counted) is None:
        yield Finding(f"{ENCODER}.object", written(counted), f'expected index and sub-index: "{POSITION}"')


TABLE = DriverTable(ENCODER, _FIELDS, _table, rules=_rules)
