"""Command ``turndesk shift``, which writes the shift report as text, JSON or HTML.

The report contains parts, stops and stop reasons.
"""

from __future__ import annotations

import argparse
import json
import sys
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_OK, CommandError, convert_to_command_error
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.extras.quality.shift_results import Shift, ShiftResults
    from core.store.store import Store


def add_parser(subparsers: SubParsers) -> None:
    """Declare the options of the command."""
    parser = subparsers.add_parser("shift")
    parser.add_argument(
        "--back",
        type=int,
        default=0,
        metavar="N",
        help="number of shifts to go back (default: the current shift or, between shifts, the "
        "last shift that ended)",
    )
    parser.add_argument(
        "--from", dest="since", metavar="TIME", help='start time in local time, such as "2026-11-23 06:00"'
    )
    parser.add_argument("--to", dest="until", metavar="TIME")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--report", metavar="FILE", help="write the report as one HTML page")
    form.add_argument("--json", action="store_true", help="print only JSON on stdout")
    parser.add_argument(
        "--metric", action="store_true", help="show lengths on the HTML page in mm (default: inches)"
    )


def run(args: argparse.Namespace) -> int:
    """Write the shift report.

    Raises CommandError if the options are invalid or the report cannot be written.
    """
    from app.extras.quality.shift_results import calculate_shift_results

    if args.metric and not args.report:
        raise CommandError("--metric is only for the HTML page; add --report FILE", "metric-needs-report")
    with open_store(read_only=True) as store:
        found = calculate_shift_results(store, _shift(store, args), datetime.now().timestamp())
    if args.report:
        _write(found, Path(args.report), metric=args.metric)
    elif args.json:
        sys.stdout.write(json.dumps(_make_json(found), indent=1) + "\n")
    else:
        sys.stdout.write(_text(found))
    return EXIT_OK


def _shift(store: Store, args: argparse.Namespace) -> Shift:
    from app.extras.quality.shift_results import (
        SHIFT_HOURS_SETTING,
        find_shift,
        get_shift_hours,
        make_report_period,
    )

    if (args.since is None) != (args.until is None):
        raise CommandError("--from and --to must be used together; specify both", "from-and-to")
    if args.since is not None:
        if args.back:
            raise CommandError(
                "--back counts shifts, but --from and --to specify times; use one or the other",
                "back-and-times",
            )
        with convert_to_command_error(ValueError):
            return make_report_period(args.since, args.until)
    if not 0 <= args.back <= 10_000:
        raise CommandError(
            Message("--back {back} is out of range; use 0 to 10000 shifts", back=args.back), "back"
        )
    return find_shift(
        get_shift_hours(store.settings.read_setting(SHIFT_HOURS_SETTING)),
        datetime.now().astimezone(),
        args.back,
    )


def _write(found: ShiftResults, path: Path, *, metric: bool) -> None:
    from app.extras.quality.shift_page import make_shift_html
    from app.programs.atomic_files import FileOperationError, copy_to_medium

    made = datetime.now().strftime("%Y-%m-%d %H:%M")
    with convert_to_command_error(FileOperationError, OSError):
        copy_to_medium(
            path, make_shift_html(found, "", made, is_metric=metric).encode("utf-8", "backslashreplace")
        )
    sys.stdout.write(f"report saved to {path}: {found.part_count} parts\n")


def _text(found: ShiftResults) -> str:
    from app.desk.status.formats import format_duration
    from app.extras.quality.shift_page import make_summary_rows, make_title

    lines = [
        make_title(found, ""),
        *found.notes,
        *(f"{name}: {words}" for name, words in make_summary_rows(found)),
    ]
    for each in found.program_results:
        mean = (
            Message(
                ", mean cycle time {times} s",
                times=f"{sum(each.cycle_times_s) / len(each.cycle_times_s):.1f}",
            )
            if each.cycle_times_s
            else ""
        )
        lines.append(
            Message(
                "{program}: {parts} parts{mean}", program=each.program_name, parts=each.part_count, mean=mean
            )
        )
    lines += [
        Message(
            "{reason}: stopped {times} times, {seconds} in total",
            reason=each.reason,
            times=each.times,
            seconds=format_duration(each.seconds),
        )
        for each in found.stop_reasons
    ]
    return "\n".join(lines) + "\n"


def _make_json(results: ShiftResults) -> dict[str, object]:
    """Return the shift report as a JSON object.

    Lengths are in mm, durations are in seconds and times are in UTC. X of offsets is a radius.
    """
    first, last = results.shift.utc_time_texts
    share = results.availability
    return {
        "from": first,
        "to": last,
        "notes": list(results.notes),
        "parts": results.part_count,
        "programs": [
            {
                "program": p.program_name,
                "parts": p.part_count,
                "no_part": dict(p.incomplete_cycles),
                "cycle_times": list(p.cycle_times_s),
            }
            for p in results.program_results
        ],
        "planned": share.planned_s if share is not None else 0.0,
        "producing": share.producing_s if share is not None else 0.0,
        "stopped": results.total_stop_time_s,
        "not_recorded": results.unrecorded_time_s,
        "stops": [row._asdict() for row in results.stop_rows],
        "reasons": [row._asdict() for row in results.stop_reasons],
        "alarms": [row._asdict() for row in results.alarms],
        "tool_lives": [row._asdict() for row in results.tool_lives],
        "insert_changes": [row._asdict() for row in results.insert_changes],
        "offset_changes": [
            {
                "at": c.at,
                "kind": c.kind.value,
                "number": c.number,
                "why": c.why,
                "who": c.who,
                "old": c.old._asdict() if c.old is not None else None,
                "new": c.new._asdict() if c.new is not None else None,
            }
            for c in results.offset_changes
        ],
        "readings": results.reading_count,
        "out_of_tolerance": [
            {"program": f.program, "feature": f.name, "part": r.part, "value": r.value, "at": r.at}
            for f, r in results.bad_readings
        ],
    }
