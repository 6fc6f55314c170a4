"""Stored data of measured parts: features, readings, cycles and corrections.

The module also writes readings as CSV.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.status.formats import MM_PER_INCH
from app.production.cycle_recorder import COMPLETE
from app.production.parts_book import MAX_ROWS, ProductionRecords
from core.file_replacement import write_atomically
from core.store.production import measured_parts, part_cycles
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CorrectionRow, CycleRow, CycleTime
from core.store.store import Store
from core.store.store_rows import format_utc

if TYPE_CHECKING:
    from core.extras.quality.measured_feature import MeasuredFeature

BOOK_KEY = "quality"  # name of this data in the parts book
_DAYS = timedelta(days=2)


@dataclass(frozen=True, slots=True)
class PartsData:
    """Stored data of the parts of one program. Every table lists its oldest rows first.

    ``last_change_numbers`` contains the number of the latest change of each offset axis.
    """

    program_name: str = ""
    features: tuple[FeatureRow, ...] = ()
    readings: tuple[ReadingRow, ...] = ()
    last_change_numbers: dict[tuple[str, int, str], int] = field(default_factory=dict)
    cycles: tuple[CycleRow, ...] = ()
    corrections: tuple[CorrectionRow, ...] = ()
    recent_cycle_times: tuple[
        CycleTime, ...
    ] = ()  # cycles of all programs within the longest time of a shift

    @property
    def complete_cycles(self) -> tuple[CycleRow, ...]:
        """Return the complete cycles with a representative cycle time.

        A cycle that was completed by a restart has no representative time and is excluded.
        """
        return tuple(row for row in self.cycles if row.outcome == COMPLETE and row.seconds > 0.0)

    def select_readings(self, feature_id: int) -> tuple[ReadingRow, ...]:
        """Return the readings of a feature in the order of measurement."""
        return tuple(row for row in self.readings if row.feature == feature_id)

    def select_readings_since_correction(self, row: FeatureRow) -> tuple[ReadingRow, ...]:
        """Return the readings of parts that were started after the feature's offset was last changed.

        A part with an unknown start time is included only if the offset was never changed.
        """
        last = self.last_change_numbers.get((row.by_kind, row.number, make_measured_feature(row).axis), 0)
        return tuple(each for each in self.select_readings(row.id) if not last or each.offset_change >= last)


def make_measured_feature(row: FeatureRow) -> MeasuredFeature:
    """Return the measured feature that a stored row describes."""
    from core.extras.quality.measured_feature import CorrectingOffset, FeatureKind, MeasuredFeature

    return MeasuredFeature(
        row.name,
        FeatureKind(row.kind),
        row.nominal,
        row.low,
        row.high,
        CorrectingOffset(row.by_kind),
        row.number,
        row.grows,
        row.every,
        row.sample,
    )


def make_feature_row(feature: MeasuredFeature, program: str, feature_id: int) -> FeatureRow:
    """Return the row to store for a feature.

    ``feature_id`` is 0 for a new feature.
    """
    return FeatureRow(
        feature_id,
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


def read_parts_data(store: Store, program: str, max_rows: int = MAX_ROWS) -> PartsData:
    """Read the stored data of a program.

    The result contains the latest ``max_rows`` rows of each type, or all rows if ``max_rows`` is -1.
    Reading can take a long time. Raises StoreError if the data cannot be read.
    """
    with store.read() as connection:
        return PartsData(
            program,
            measured_parts.read_features(connection, program),
            measured_parts.read_readings(connection, program, max_rows),
            measured_parts.read_last_corrections(connection),
            part_cycles.read_cycles(connection, program, max_rows),
            part_cycles.read_corrections(connection, program, max_rows),
            part_cycles.read_cycle_times_since(connection, format_utc(datetime.now(UTC) - _DAYS)),
        )


def get_loaded_parts_data(book: ProductionRecords) -> PartsData:
    """Return the stored part data of the loaded program.

    The result has no rows while the data are still being read.
    """
    found = book.current_data.feature_data.get(BOOK_KEY)
    if isinstance(found, PartsData) and found.program_name == book.current_data.program_name:
        return found
    return PartsData(book.current_data.program_name)


CSV_COLUMNS = (
    "feature", "part", "value", "unit", "nominal", "lower", "upper", "good", "at", "source", "gauge",
    "corrected_by",
)  # fmt: skip
_PER = {"in": MM_PER_INCH, "mm": 1.0}


def make_readings_csv(data: PartsData) -> str:
    """Return the readings as CSV text with one line per reading, in the order of measurement."""
    out = io.StringIO()
    table = csv.writer(out)
    table.writerow(CSV_COLUMNS)
    table.writerows(make_csv_rows(data))
    return out.getvalue()


def make_csv_rows(data: PartsData) -> Iterator[tuple[object, ...]]:
    """Yield the CSV cells of each reading in the order of ``CSV_COLUMNS``."""
    features = {row.id: row for row in data.features}
    for each in data.readings:
        feature, per = make_measured_feature(features[each.feature]), _PER[each.unit]
        low, high = feature.limits
        nominal_and_limits = (round(value / per, 7) for value in (feature.nominal, low, high))
        good = "yes" if feature.good(each.value) else "no"
        sizes = round(each.value / per, 7), each.unit, *nominal_and_limits, good
        yield feature.name, each.part, *sizes, each.at, each.source, each.gauge, feature.corrected_by


def write_readings_csv(data: PartsData, folder: Path) -> Path:
    """Write the file ``PROGRAM-readings.csv`` atomically and return its path.

    Raises OSError if the file cannot be written.
    """
    path = folder / f"{Path(data.program_name).stem}-readings.csv"
    write_atomically(path, make_readings_csv(data).encode())
    return path
