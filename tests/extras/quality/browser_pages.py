"""The shift report of a made-up morning, for the pictures of pages in a browser."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from typing import NamedTuple

from app.extras.quality.shift_page import make_shift_html
from app.extras.quality.shift_results import Shift, calculate_shift_results
from core.store.event_log import add_events
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.store import Store
from core.store.store_rows import EventRow, format_utc

BEGIN = datetime(2026, 3, 2, 6, tzinfo=UTC)


class Run(NamedTuple):
    """Parts one behind the other, and what stood behind them."""

    program: str
    parts: int
    seconds: float  # of the shortest; every third takes one more, every fifth another
    stop: str
    stood: float
    line: int = 0


MORNING = (
    Run("bushing.nc", 20, 151.0, "FEED HOLD", 95.0, 14),
    Run("bushing.nc", 36, 151.0, "E-STOP", 1260.0, 14),
    Run("bushing.nc", 23, 151.0, "BETWEEN CYCLES", 1500.0),
    Run("grooves.nc", 41, 92.0, "", 0.0),
)
ALARM = "102 FOLLOWING ERROR: X STANDS 0.31 mm OFF"
SIZES = (0, 1, 2, 4, 6, 11, 12, 13)  # ten thousandths of an inch off, of every tenth part


def written(folder: Path) -> dict[str, tuple[Path, tuple[int, int]]]:
    """Write the pages; return the file and the size of the window of each, by the name of its picture."""
    page = folder / "shift.html"
    page.write_text(shift_report(folder), encoding="utf-8")
    return {"shift": (page, (740, 830))}


def shift_report(folder: Path) -> str:
    """The HTML of a made-up morning, kept in a store in the folder."""
    with Store.open(folder) as store:
        _fill(store)
        shift = Shift(BEGIN.timestamp(), (BEGIN + timedelta(hours=8)).timestamp())
        found = calculate_shift_results(store, shift, shift.end_s + 120.0)
        return make_shift_html(found, "GT-75", "2026-03-02 14:02", is_metric=False)


def _fill(store: Store) -> None:
    """Parts, stops, an alarm, readings that leave their tolerance, and two lives."""
    at, part = BEGIN + timedelta(minutes=4), 0
    for run in MORNING:
        for number in range(run.parts):
            part = part + 1 if part and run.program == "bushing.nc" else number + 1
            seconds = run.seconds + (number % 3 == 0) + (number % 5 == 0)
            end = at + timedelta(seconds=seconds)
            made = CycleRow(
                f"{at:%H%M%S}", run.program, part, format_utc(at), format_utc(end), seconds, "COMPLETE"
            )
            store.write(partial(part_cycles.save_cycle, row=made)).result()
            at = end + timedelta(seconds=3)
        if run.stop:
            stop = ProductionStopRow(
                f"{at:%H%M%S}", "", run.program, format_utc(at), run.stood, run.stop, run.line
            )
            store.write(partial(part_cycles.save_stop, row=stop)).result()
        if run.stop == "E-STOP":
            alarm = EventRow(format_utc(at), "alarm", ALARM, run.line)
            store.write(partial(add_events, events=[alarm])).result()
        at += timedelta(seconds=run.stood)
    feature = FeatureRow(0, "bushing.nc", "OUTSIDE", "diameter", 22.225, -0.0254, 0.0254, "tool", 1, 1, 5, 1)
    kept = store.write(partial(measured_parts.save_feature, row=feature)).result()
    for number, off in enumerate(SIZES, start=1):
        read = format_utc(BEGIN + timedelta(minutes=26 * number))
        size = 22.225 + off * 0.00254
        row = ReadingRow(0, kept, 10 * number, size, "in", read, "gauge", "micrometer")
        store.write(partial(measured_parts.add_reading, row=row)).result()
    store.write(partial(tool_lives.save_tool_life_limits, row=ToolLifeRow(1, 200, 0.0, 0.9, True))).result()
    store.write(lambda c: tool_lives.save_insert_use(c, 1, 184, 4020.0)).result()
