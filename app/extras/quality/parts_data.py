"""Measured parts of a program as they are kept: features, readings, cycles, corrections; readings as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

from app.desk.status.formats import MM_PER_INCH
from app.production.cycle_recorder import COMPLETE
from app.production.parts_book import NEWEST, PartsBook
from core.extras.quality.measured_feature import CorrectedBy, Feature, FeatureKind
from core.file_placing import write_in_place
from core.store.production import measured_parts, part_cycles
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CorrectionRow, CycleRow, CycleTime
from core.store.store import Store
from core.store.store_rows import utc

FEATURE = "quality"  # name of this data in the book
_DAYS = timedelta(days=2)


@dataclass(frozen=True, slots=True)
class PartsData:
    """Of one program, oldest first; ``corrected``: newest change of an axis."""

    program: str = ""
    features: tuple[FeatureRow, ...] = ()
    readings: tuple[ReadingRow, ...] = ()
    corrected: dict[tuple[str, int, str], int] = field(default_factory=dict)
    cycles: tuple[CycleRow, ...] = ()
    corrections: tuple[CorrectionRow, ...] = ()
    day: tuple[CycleTime, ...] = ()  # when all programs ran, as long ago as a shift may be

    @property
    def whole_cycles(self) -> tuple[CycleRow, ...]:
        """Those whose time is that of the program: none that a restart has finished, or somebody given up."""
        return tuple(row for row in self.cycles if row.outcome == COMPLETE and row.seconds > 0.0)

    def readings_of(self, feature: int) -> tuple[ReadingRow, ...]:
        """Readings of a feature in the order in which they were taken."""
        return tuple(row for row in self.readings if row.feature == feature)

    def since_correction(self, row: FeatureRow) -> tuple[ReadingRow, ...]:
        """Readings of parts that were begun after the last change of what corrects the feature.

        A part of which nobody knows when it was begun counts only where nothing was ever changed.
        """
        last = self.corrected.get((row.by_kind, row.number, feature_of(row).axis), 0)
        return tuple(each for each in self.readings_of(row.id) if not last or each.offset_change >= last)


def feature_of(row: FeatureRow) -> Feature:
    """A kept feature as it is reckoned with."""
    return Feature(
        row.name,
        FeatureKind(row.kind),
        row.nominal,
        row.low,
        row.high,
        CorrectedBy(row.by_kind),
        row.number,
        row.grows,
        row.every,
        row.sample,
    )


def row_of(feature: Feature, program: str, number: int) -> FeatureRow:
    """The row that keeps a feature; ``number`` is its id, 0 for a new one."""
    return FeatureRow(
        number,
        program,
        feature.name,
        feature.kind.value,
        feature.nominal,
        feature.low,
        feature.high,
        feature.by.value,
        feature.number,
        feature.grows,
        feature.every,
        feature.sample,
    )


def parts_data(store: Store, program: str, limit: int = NEWEST) -> PartsData:
    """What is kept of a program, the newest so many of each; -1: all. Takes its time. Raises StoreError."""
    with store.read() as connection:
        return PartsData(
            program,
            measured_parts.features(connection, program),
            measured_parts.readings(connection, program, limit),
            measured_parts.last_corrections(connection),
            part_cycles.cycles(connection, program, limit),
            part_cycles.corrections(connection, program, limit),
            part_cycles.times_since(connection, utc(datetime.now(UTC) - _DAYS)),
        )


def parts_of(book: PartsBook) -> PartsData:
    """What the book knows of the program on the desk; nothing until it is read."""
    found = book.now.more.get(FEATURE)
    if isinstance(found, PartsData) and found.program == book.now.program:
        return found
    return PartsData(book.now.program)


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
