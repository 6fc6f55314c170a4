"""Feed and spindle as the operator reads them: programmed or commanded, measured, and the overrides."""

from __future__ import annotations

import math
from dataclasses import dataclass

from app.desk import formats
from app.desk.lamps import LATHE, TURNING
from core.executor.snapshot import Snapshot


@dataclass(frozen=True, slots=True)
class FeedView:
    """Programmed and actual feed in the unit of the program's mode."""

    value: str
    unit: str
    actual: str
    actual_unit: str
    override: float


@dataclass(frozen=True, slots=True)
class SpindleView:
    """Commanded and actual rpm, surface speed, override and the AUTO/OFF switch."""

    direction: str
    rpm: str
    actual: str
    surface: str
    surface_label: str
    override: float
    auto: bool


def feed_view(snapshot: Snapshot, metric: bool) -> FeedView:
    """Feed as it is programmed and as it is measured; ``metric``: mm, else inches."""
    modal = snapshot.modal
    per_rev = modal.per_rev and not snapshot.rapid
    turns = abs(snapshot.rpm_actual) / 60
    if snapshot.turns:
        value = formats.fixed(snapshot.feed * (1 if per_rev else 60), 4 if per_rev else 1)
        return FeedView(value, formats.turn_unit(per_rev), formats.NOTHING, "", snapshot.feed_override)
    if per_rev:
        speed = snapshot.velocity / turns if turns > TURNING / 60 else math.nan
    else:
        speed = snapshot.velocity
    unit = formats.feed_unit(metric, per_rev)
    known = snapshot.rapid or snapshot.feed > 0
    value = "RAPID" if snapshot.rapid else formats.feed(snapshot.feed, metric, modal.per_rev)
    return FeedView(
        value=value if known else formats.NOTHING,
        unit="" if snapshot.rapid else unit,
        actual=formats.feed(speed, metric, per_rev) if math.isfinite(speed) else formats.NOTHING,
        actual_unit=unit,
        override=snapshot.feed_override,
    )


def spindle_view(snapshot: Snapshot, metric: bool) -> SpindleView:
    """Speed as it is commanded and measured, and the surface speed in m/min or feet/min."""
    modal = snapshot.modal
    radius = snapshot.actual[0] - snapshot.offset[0]
    lathe = snapshot.axes == LATHE  # on a mill it would be the tool's, whose radius nobody knows
    surface = 2 * math.pi * radius * snapshot.rpm_actual / 60 if lathe else math.nan
    command = snapshot.rpm_command
    direction = "M03 FWD" if command > 0 else "M04 REV" if command < 0 else "M05 OFF"
    return SpindleView(
        direction=f"{direction} · G96" if modal.css else direction,
        rpm=formats.rpm(command),
        actual=formats.rpm(snapshot.rpm_actual),
        surface=formats.surface_speed(surface, metric),
        surface_label="M/MIN" if metric else "SFM",
        override=snapshot.spindle_override,
        auto=snapshot.spindle_auto,
    )
