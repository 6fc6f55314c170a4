"""A night shift of 10 000 parts: what leaks, what drifts, and whether every count is what was made.

``python -m tests.benchmarks.bench_night_shift [--parts 10000] [--seed 1] [--keep FOLDER]``: desk, executor,
simulated lathe and store on a clock that is moved as fast as this computer can; bars, faults, holds, resets,
corrections and inserts come by chance. Prints a line every so many parts, and keeps its figures for
``docs/reliability.md``. What does not agree ends it with status 1.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from app.desk.data_folder import HOME_VARIABLE, find_data_folder
from core.store.production import part_cycles
from core.store.store import Store
from tests.benchmarks.footprint import Footprint, footprint, keep_result, plain
from tests.benchmarks.night_operator import Operator
from tests.benchmarks.night_shift import INCH, NAME, RADIUS, NightShift, Truth, night_shift

LINES = 20  # that are printed

Figures = dict[str, Any]


def soak(parts: int, seed: int, say: Callable[[str], object], keep: Callable[[Figures], object]) -> Figures:
    """The figures of a night of so many parts in the folder that ``TURNDESK_HOME`` names.

    ``keep`` is given those of so far, once in a while: a night that is broken off has told something.
    """
    begun = time.process_time()
    with night_shift() as shift:
        operator = Operator(shift, seed)
        operator.begin()
        marks: dict[str, Footprint] = {}
        for number in range(LINES):
            operator.make(parts * (number + 1) // LINES - shift.shot.parts)
            shift.saved()
            marks[str(shift.shot.parts)] = mark = footprint(find_data_folder())
            say(f"{shift.shot.parts:6d} parts, {shift.clock.now() / 3600:5.2f} h, {mark}\n")
            keep({**_figures(shift, operator, marks), "seed": seed})
        operator.finish()
        figures = _figures(shift, operator, marks)
    return {**figures, "seed": seed, "processor_s": round(time.process_time() - begun)}


def _figures(shift: NightShift, operator: Operator, marks: dict[str, Footprint]) -> Figures:
    counts = counted(shift)
    return {
        "parts": shift.shot.parts,
        "machine_hours": round(shift.clock.now() / 3600, 2),
        "marks": plain(marks),
        "counts": counts,
        "disagree": disagreeing(shift, operator, counts),
        "done": dict(sorted(operator.did.items())),
        "alarms": dict(sorted(shift.witness.truth.alarms.items())),
        "drift": drift(shift),
        "at the bar stop": {str(place): ticks for place, ticks in shift.witness.truth.at_stop.items()},
        "underruns": shift.shot.underruns,
    }


def counted(shift: NightShift) -> dict[str, int]:
    """Parts by everybody who counts them, and what was seen of the slides."""
    by = {"executor": shift.shot.parts, "desk": shift.desk.program_runs.part_counter.part_count}
    return by | counted_in(shift.store, shift.witness.truth)


def counted_in(store: Store, truth: Truth) -> dict[str, int]:
    """The same of the store alone."""
    with store.read() as connection:
        cycles = Counter(row.outcome for row in part_cycles.read_cycles(connection, NAME, -1))
        [(readings,)] = connection.execute("SELECT count(*) FROM part_readings").fetchall()
        [(events,)] = connection.execute("SELECT count(*) FROM events WHERE kind = 'part'").fetchall()
        [(inserts,)] = connection.execute("SELECT count(*) FROM insert_changes").fetchall()
    return {
        "seen at the slides": truth.pins - truth.given_up - truth.uncounted,
        "store": store.runs.read_part_count(NAME),
        "log": events,
        "cycles": cycles["COMPLETE"],
        "pins without count": truth.uncounted,
        "cycles without count": cycles["NOT COUNTED"],
        "pins of programs that were broken off": truth.given_up,
        "readings": readings,
        "inserts": inserts,
    }


def disagreeing(shift: NightShift, operator: Operator, counts: dict[str, int]) -> list[str]:
    """Sentences; empty when every count is what was made."""
    made = counts["seen at the slides"]
    wrong = [
        f"{who}: {counts[who]} of {made}"
        for who in ("executor", "desk", "store", "log", "cycles")
        if counts[who] != made
    ]
    pairs = (
        ("pins without count", counts["cycles without count"]),
        ("readings", operator.did["reading"]),
        ("inserts", operator.did["insert"]),
    )
    wrong += [f"{what}: {counts[what]} against {other}" for what, other in pairs if counts[what] != other]
    return wrong


def drift(shift: NightShift) -> dict[str, float]:
    """How many places one place has become in a night, and how far a turned radius is from its figures."""
    truth = shift.witness.truth
    spread = max((max(places) - min(places) for places in truth.turned.values()), default=0.0)
    off = max(
        (abs(x - (offset + RADIUS * INCH)) for offset, xs in truth.turned.items() for x in xs), default=0.0
    )
    return {
        "places of the bar stop": len(truth.at_stop),
        "turned radii with one offset, spread mm": spread,
        "turned radius against offset and program, mm": off,
        "offsets that were turned with": len(truth.turned),
        "slide against setpoint at rest, worst mm": round(truth.lag, 6),
    }


def main() -> int:
    """Print the night, keep its figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--parts", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder of the figures")
    wanted = parser.parse_args()
    keep = partial(keep_result, "night_shift", folder=wanted.keep)
    with tempfile.TemporaryDirectory() as home:
        os.environ[HOME_VARIABLE] = home
        figures = soak(wanted.parts, wanted.seed, _say, keep)
    _say(f"{keep(figures)}\n")
    for wrong in figures["disagree"]:
        _say(f"DISAGREES: {wrong}\n")
    return 1 if figures["disagree"] else 0


def _say(text: str) -> None:
    sys.stdout.write(text)
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
