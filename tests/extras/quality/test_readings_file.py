"""The file of readings for a spreadsheet after a power cut."""

from __future__ import annotations

from pathlib import Path

from app.extras.quality.parts_data import PartsData, write_readings_csv
from tests.power_cut import cut_everywhere

OLD = b"part,value\n1,12.7\n"


def test_readings_csv_is_replaced_atomically(tmp_path: Path) -> None:
    path = tmp_path / "pin-readings.csv"

    def again() -> None:
        path.write_bytes(OLD)
        write_readings_csv(PartsData("pin.nc"), tmp_path)

    told = cut_everywhere(again, path.read_bytes)
    assert len(set(told)) == 2
    assert told[0] == OLD
