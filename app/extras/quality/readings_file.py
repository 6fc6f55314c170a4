"""Readings of a program as CSV for a spreadsheet: sizes in the unit in which they were read."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path

from app.desk.status.formats import MM_PER_INCH
from app.extras.quality.parts_data import PartsData, feature_of
from core.file_placing import write_in_place

HEAD = (
    "feature", "part", "value", "unit", "nominal", "lower", "upper", "good", "at", "source", "gauge",
    "corrected_by",
)  # fmt: skip
_PER = {"in": MM_PER_INCH, "mm": 1.0}


def readings_text(data: PartsData) -> str:
    """One line a reading, in the order in which they were taken."""
    out = io.StringIO()
    table = csv.writer(out)
    table.writerow(HEAD)
    table.writerows(reading_lines(data))
    return out.getvalue()


def reading_lines(data: PartsData) -> Iterator[tuple[object, ...]]:
    """The cells of each reading, as ``HEAD`` names them."""
    features = {row.id: row for row in data.features}
    for each in data.readings:
        feature, per = feature_of(features[each.feature]), _PER[each.unit]
        low, high = feature.limits
        figures = (round(value / per, 7) for value in (feature.nominal, low, high))
        good = "yes" if feature.good(each.value) else "no"
        sizes = round(each.value / per, 7), each.unit, *figures, good
        yield feature.name, each.part, *sizes, each.at, each.source, each.gauge, feature.corrected_by


def write_readings(data: PartsData, folder: Path) -> Path:
    """Writes ``PROGRAM-readings.csv`` whole; answers its path. Raises OSError."""
    path = folder / f"{Path(data.program).stem}-readings.csv"
    write_in_place(path, readings_text(data).encode())
    return path
