"""The command ``turndesk scope FILE``, which prints the contents of a scope record.

The command also writes the samples of the record as CSV.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.command_errors import EXIT_OK, CommandError, convert_to_command_error
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.records.record import Channel, ScopeRecord

_STDOUT = "-"


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``scope``."""
    parser = subparsers.add_parser("scope")
    parser.add_argument(
        "file",
        metavar="FILE",
        help="scope record file (.scope), or the file now.ring, before.ring or run.ring in the "
        "records folder",
    )
    parser.add_argument(
        "--csv", metavar="OUT", nargs="?", const=_STDOUT, help="write the samples as CSV (default: to stdout)"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object on stdout")


def run(args: argparse.Namespace) -> int:
    """Print the contents of the record, and write its samples if ``--csv`` is used."""
    from core.records.record import RecordError
    from core.records.record_file import open_record, save_csv, write_csv_lines

    if args.json and args.csv == _STDOUT:
        raise CommandError(
            "--json needs --csv OUT, because the samples and the JSON cannot both go to stdout",
            "json-needs-file",
        )
    path = Path(args.file)
    with convert_to_command_error(RecordError):
        record = open_record(path)
        if args.csv == _STDOUT:
            write_csv_lines(record, sys.stdout.write)
            return EXIT_OK
        if args.csv is not None:
            save_csv(record, Path(args.csv))
    output_text = json.dumps(_object(path, record, args.csv)) if args.json else _text(path, record, args.csv)
    sys.stdout.write(output_text + "\n")
    return EXIT_OK


def _seconds(record: ScopeRecord) -> float:
    return float(record.times_s[-1] - record.times_s[0]) if len(record.times_s) else 0.0


def _object(path: Path, record: ScopeRecord, out: str | None) -> dict[str, object]:
    return {
        "file": str(path),
        "csv": out,
        "started": record.start_time_utc_s,
        "seconds": round(_seconds(record), 6),
        "samples": len(record.times_s),
        "rate": record.sampling_rate_hz,
        "about": dict(record.about),
        "channels": [_channel(record, each) for each in record.channels],
    }


def _channel(record: ScopeRecord, channel: Channel) -> dict[str, object]:
    least, most = _channel_range(record, channel)
    return {**channel._asdict(), "min": least, "max": most}


def _channel_range(record: ScopeRecord, channel: Channel) -> tuple[float, float] | tuple[None, None]:
    """Return the smallest and largest known value of a channel, or None for both if no value is known."""
    import numpy as np

    column = record.values_by_channel[channel.name]
    known = column[~np.isnan(column)]
    return (float(known.min()), float(known.max())) if len(known) else (None, None)


def _text(path: Path, record: ScopeRecord, out: str | None) -> str:
    began = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(record.start_time_utc_s))
    lines: list[str] = [
        Message(
            "{path}: {times_count} samples in {record} s, starting at {began}; {rate} samples "
            "per second during motion",
            path=path,
            times_count=len(record.times_s),
            record=f"{_seconds(record):.3f}",
            began=began,
            rate=f"{record.sampling_rate_hz:g}",
        )
    ]
    lines += [f"  {name}: {words}" for name, words in record.about.items() if name != "states" and words]
    for channel in record.channels:
        least, most = _channel_range(record, channel)
        if least is not None:
            lines.append(f"  {channel.name:24} {least:12.5g} … {most:<12.5g} {channel.unit}".rstrip())
    if out is not None:
        lines.append(f"  samples: {out}")
    return "\n".join(lines)
