"""Command ``turndesk parts``, which prints stored part counts, times, readings and corrections."""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from app.desk.command_errors import EXIT_OK, CommandError
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.extras.quality.parts_data import PartsData
    from core.store.store import Store


def add_parser(subparsers: SubParsers) -> None:
    """Declare the options of the command."""
    parser = subparsers.add_parser("parts")
    parser.add_argument("name", nargs="?", metavar="PROGRAM", help="program to show (default: all)")
    form = parser.add_mutually_exclusive_group()
    form.add_argument(
        "--csv", action="store_true", help="print one line per reading on stdout, as CSV for a spreadsheet"
    )
    form.add_argument("--json", action="store_true", help="print only JSON on stdout")


def run(args: argparse.Namespace) -> int:
    """Print the stored data of one program or of all programs.

    Raises CommandError if the requested program has no data, or if the store cannot be read.
    """
    from app.cli.store_command import open_store

    with open_store(read_only=True) as store:
        names = _names(store, args.name)
        if args.json:
            sys.stdout.write(json.dumps(_make_json(store, names), indent=1) + "\n")
        elif args.csv:
            _write_csv(store, names)
        else:
            sys.stdout.writelines(_lines(store, names))
    return EXIT_OK


def _names(store: Store, wanted: str | None) -> list[str]:
    """Return the requested program name, or the names of all programs with stored data."""
    from core.store.production import measured_parts, part_cycles

    known = {row.program for row in store.runs.read_run_records()}
    with store.read() as connection:
        known |= {row.program for row in measured_parts.read_features(connection)}
        known |= part_cycles.programs(connection)
    if wanted is None:
        return sorted(known)
    if wanted not in known:
        raise CommandError(
            Message(
                "no data is stored for {expected}; 'turndesk parts' lists the programs that have data",
                expected=wanted,
            ),
            "unknown-program",
        )
    return [wanted]


def _data(store: Store, name: str) -> PartsData:
    from app.extras.quality.parts_data import read_parts_data

    return read_parts_data(store, name, max_rows=-1)


# --- JSON ------------------------------------------------------------------------------------------------


def _make_json(store: Store, names: Sequence[str]) -> dict[str, object]:
    """Return the JSON object with the stored data.

    Lengths are in mm, durations are in seconds and times are in UTC. X of corrections is a radius.
    """
    from core.store.production import part_cycles, tool_lives

    with store.read() as connection:
        lives = [row._asdict() for row in tool_lives.read_tool_lives(connection).values()]
        changes = [row._asdict() for row in tool_lives.read_insert_changes(connection, -1)]
        stops = part_cycles.read_stops(connection, None, -1)
    return {
        "programs": [_program(store, name) for name in names],
        "stops": [row._asdict() for row in stops if row.program in names],
        "tool_lives": lives,
        "insert_changes": changes,
    }


def _program(store: Store, name: str) -> dict[str, object]:
    data = _data(store, name)
    return {
        "program": name,
        "parts": store.runs.read_part_count(name),
        "cycles": [row._asdict() for row in data.cycles],
        "features": [
            {
                **row._asdict(),
                "readings": [each._asdict() for each in data.select_readings(row.id)],
                "capability": _capability(data, row.id),
            }
            for row in data.features
        ],
        "corrections": [row._asdict() for row in data.corrections],
    }


def _capability(data: PartsData, number: int) -> dict[str, object] | None:
    """Return Cp, Cpk, Pp and Ppk of a feature, or None if there are too few readings."""
    from dataclasses import asdict

    from app.extras.quality.parts_data import make_measured_feature
    from core.extras.quality.control_charts import QualityError, calculate_capability

    row = next(each for each in data.features if each.id == number)
    values = [each.value for each in data.select_readings(number)]
    try:
        return asdict(calculate_capability(values, *make_measured_feature(row).limits, row.sample))
    except QualityError:
        return None


# --- text and CSV output ---------------------------------------------------------------------------------


def _write_csv(store: Store, names: Sequence[str]) -> None:
    from app.extras.quality.parts_data import CSV_COLUMNS, make_csv_rows

    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(("program", *CSV_COLUMNS))
    for name in names:
        table.writerows((name, *line) for line in make_csv_rows(_data(store, name)))


def _lines(store: Store, names: Sequence[str]) -> Iterator[str]:
    """Yield one line per program and one line per feature."""
    if not names:
        yield "no parts are known yet\n"
    for name in names:
        data = _data(store, name)
        times = [row.seconds for row in data.complete_cycles]
        mean = (
            Message(
                ", mean cycle time {times} s (cycles: {times_count})",
                times=f"{sum(times) / len(times):.1f}",
                times_count=len(times),
            )
            if times
            else ""
        )
        yield f"{name}: parts {store.runs.read_part_count(name)}{mean}\n"
        for row in data.features:
            taken = data.select_readings(row.id)
            found = _capability(data, row.id)
            cpk = (
                Message(", Cpk {value}", value=f"{found['cpk']:.2f}")
                if found is not None and found["cpk"] is not None
                else ""
            )
            last = (
                Message(
                    ", last reading {taken} mm (part {part})",
                    taken=f"{taken[-1].value:.4f}",
                    part=taken[-1].part,
                )
                if taken
                else ""
            )
            yield f"  {row.name} {row.nominal:.4f} mm: readings {len(taken)}{last}{cpk}\n"
