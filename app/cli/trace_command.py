"""The command ``turndesk trace FILE --out FILE.csv``, which writes time-stamped drive setpoints."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.expand_command import print_diagnostics
from app.cli.program_options import add_program_options, parse_output_path, read_command_context, read_source
from app.cli.proofs.progress_bar import ProgressBar
from app.desk.command_errors import CommandError, make_write_error
from core.file_replacement import replace_atomically
from core.language.source import Dialect, ProgramSource
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.machine.machine_model import Machine
    from core.proving.program_timeline import Timeline
    from core.proving.setpoint_trace import SetpointRows


def _parse_interval(text: str) -> float:
    """Return a setpoint interval of 0.0001 s to 1 s. Raises ArgumentTypeError if it is invalid."""
    try:
        dt = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            Message("{text} is not a number of seconds", text=f"{text!r}")
        ) from None
    if not 1e-4 <= dt <= 1.0:
        raise argparse.ArgumentTypeError(
            Message("{text} s is out of range; use an interval from 0.0001 to 1 s", text=text)
        )
    return dt


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``trace``."""
    parser = subparsers.add_parser("trace")
    parser.add_argument("file", metavar="FILE")
    parser.add_argument(
        "--dt",
        type=_parse_interval,
        default=0.001,
        metavar="S",
        help="sampling interval in s (default: 0.001)",
    )
    parser.add_argument(
        "--out", type=parse_output_path, metavar="FILE.csv", help="output file (default: stdout)"
    )
    add_program_options(parser)


def run(args: argparse.Namespace) -> int:
    """Write the setpoints as CSV, and return 1 if the program has errors.

    Positions of linear axes are in inches for OmniTurn programs (X as a radius), and otherwise in mm.
    Positions of rotary axes are in degrees.
    """
    from core.proving.program_timeline import Timeline

    path = Path(args.file)
    if args.json and args.out is None:
        raise CommandError(
            "--json needs --out FILE, because the setpoints and the JSON cannot both go to stdout",
            "json-needs-file",
        )
    around = read_command_context(args)
    source = read_source(path, args)
    timeline = Timeline.from_program(source, around.setup, around.machine)
    table = _SetpointTable(around.machine, inch=source.dialect is Dialect.OMNITURN)
    if args.out is None:
        _write(timeline, table, args.dt, sys.stdout.write, source)
    else:
        _write_file(timeline, table, args, source)
    if args.json:
        _write_json(timeline, args, path)
    return print_diagnostics(path, timeline)


def _write_json(timeline: Timeline, args: argparse.Namespace, path: Path) -> None:
    """Print the result as one JSON object."""
    from app.cli.outputs.proof_output import make_diagnostic_json
    from app.cli.outputs.units import round_seconds

    result = {
        "file": str(path),
        "out": None if timeline.has_errors else args.out,
        "dt": args.dt,
        "cycle_time_s": round_seconds(timeline.time_s),
        "diagnostics": [make_diagnostic_json(each) for each in timeline.diagnostics],
    }
    sys.stdout.write(json.dumps(result) + "\n")


class _SetpointTable:
    """Layout of the CSV file of a machine: time, axes in order, spindle angle and program line."""

    def __init__(self, machine: Machine, *, inch: bool) -> None:
        from app.cli.outputs.units import MM_PER_INCH

        names = ",".join(axis.name.lower() for axis in machine.axes)
        self.header = f"t,{names},spindle_deg,line\n"
        self._scales = [1.0 if axis.is_rotary or not inch else MM_PER_INCH for axis in machine.axes]
        places = (5 if axis.is_rotary else 7 if inch else 6 for axis in machine.axes)
        self._row = ",".join(("%.6f", *(f"%.{count}f" for count in places), "%.4f", "%d")) + "\n"

    def format_lines(self, rows: SetpointRows) -> str:
        """Return the setpoints as lines of text, one line per setpoint."""
        columns = (
            rows.times_s,
            *(rows.positions / self._scales).T,
            rows.spindle_angles_deg,
            rows.line_numbers,
        )
        return "".join([self._row % row for row in zip(*(c.tolist() for c in columns), strict=True)])


def _write_file(
    timeline: Timeline, table: _SetpointTable, args: argparse.Namespace, source: ProgramSource
) -> None:
    """Write the complete CSV file, or no file after a program error, a full disk or Ctrl+C.

    An existing file is replaced only by a complete file.
    """
    out = Path(args.out)
    partial = out.with_name(out.name + ".part")
    try:
        with partial.open("w", encoding="ascii", newline="") as file:
            _write(timeline, table, args.dt, file.write, source)
        if not timeline.has_errors:
            replace_atomically(partial, out)
    except OSError as error:
        raise make_write_error(out, error) from error
    finally:  # also on Ctrl+C
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)


def _write(
    timeline: Timeline,
    table: _SetpointTable,
    dt: float,
    write: Callable[[str], object],
    source: ProgramSource,
) -> None:
    """Write the setpoints.

    Progress is shown in program lines, because the duration is not known in advance.
    """
    from core.proving.setpoint_trace import iter_setpoints

    write(table.header)
    furthest = 0
    with ProgressBar(f"tracing {source.name}", len(source.lines)) as progress:
        for chunk in iter_setpoints(timeline, dt):
            write(table.format_lines(chunk))
            furthest = max(
                furthest, int(chunk.line_numbers.max(initial=0))
            )  # a loop returns to earlier lines
            progress.report_progress(furthest)
