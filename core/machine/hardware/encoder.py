"""An encoder of its own on the spindle, beside an inverter: what must hold between it and the rest."""

from __future__ import annotations

from collections.abc import Iterator

from core.machine.errors import Finding
from core.machine.hardware.addresses import sdo_address
from core.machine.hardware.reading import HardwareReading
from core.machine.schema import Values, written

PATH = "spindle.encoder"
PROFILE = 406  # of CiA: an encoder that is a node by itself
POSITION = "6004:0"  # where such a node has its counts
_LEAST = 16  # counts a turn


def broken(reading: HardwareReading) -> Iterator[Finding]:
    """Every finding."""
    values = reading.values
    if PATH in reading.tables:
        yield from _place(reading)
        yield from _counts(values)
        yield from _wired(reading)
    used = values.text(f"{PATH}.node") if values.has(f"{PATH}.node") else ""
    for name in reading.nodes:
        path = f"canopen.nodes.{name}.profile"
        profile = int(values.number(path)) if values.has(path) else 401
        if profile not in {401, 402, PROFILE}:
            yield Finding(path, str(profile), "expected 401 (terminals), 402 (a drive) or 406 (an encoder)")
        elif profile == PROFILE and name != used:
            yield Finding(path, str(profile), f"nobody reads this encoder; {PATH} names the one that is read")


def _place(reading: HardwareReading) -> Iterator[Finding]:
    values = reading.values
    if values.has("machine.backend") and values.text("machine.backend") != "canopen":
        backend = written(values.text("machine.backend"))
        yield Finding(PATH, "", f"backend {backend} reads no encoder on a bus; take it out")
    if values.has("spindle.driver") and values.text("spindle.driver") != "vfd":
        expected = (
            'expected spindle.driver = "vfd": a drive on the bus has its own, counts_per_rev of its node'
        )
        yield Finding(PATH, "", expected)


def _counts(values: Values) -> Iterator[Finding]:
    path = f"{PATH}.counts_per_rev"
    if values.has(path) and abs(values.number(path)) < _LEAST:
        expected = f"expected {_LEAST} or more; negative where it counts down with M03"
        yield Finding(path, f"{values.number(path):g}", expected)


def _wired(reading: HardwareReading) -> Iterator[Finding]:
    values = reading.values
    if not values.has(f"{PATH}.node", f"{PATH}.object"):
        return
    node, place = values.text(f"{PATH}.node"), values.text(f"{PATH}.object")
    profile = f"canopen.nodes.{node}.profile"
    if node not in reading.nodes:
        yield Finding(f"{PATH}.node", written(node), "expected a node of [canopen.nodes] with profile = 406")
    elif values.has(profile) and values.number(profile) == 401:
        yield Finding(f"{PATH}.node", written(node), "terminals do not count turns: expected 406 or a drive")
    elif values.has(profile) and values.number(profile) == 402 and not place:
        expected = 'missing; a drive has its second encoder where its manual says: "60E4:1"'
        yield Finding(f"{PATH}.object", "", expected)
    if place and sdo_address(place) is None:
        yield Finding(f"{PATH}.object", written(place), f'expected index and sub-index: "{POSITION}"')
