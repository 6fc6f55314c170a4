"""The command ``turndesk prove FILE…``, which proves programs without moving the machine."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.part_options import add_part_options
from app.cli.program_options import (
    add_ideal_times_option,
    add_program_options,
    read_command_context,
    read_source,
)
from app.cli.proofs.progress_bar import ProgressBar
from app.compose.optional_features import find_worker_class_name
from app.desk import command_errors
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError
from core.message import Message
from core.tool_edges import format_edge_name

MAX_JOBS = 256

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.cli.proofs.proof_job import ComparisonOffsets, ProofJob, ProofJobsByMachine
    from app.cli.proofs.proof_work import ProofResult
    from app.cli.proofs.report_file import ReportFile
    from core.interpreter.shared.job_setup import InterpreterSetup
    from core.language.source import ProgramSource
    from core.proving.proof_report import PartReport, ProofReport


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``prove``."""
    parser = subparsers.add_parser("prove")
    parser.add_argument(
        "files", nargs="+", metavar="FILE", help="programs, or folders with programs (including subfolders)"
    )
    add_program_options(parser)
    add_ideal_times_option(parser)
    add_part_options(parser)
    parser.add_argument(
        "--compare",
        metavar="OFFSETS",
        help="show how another offsets file would change the part, the times and the check results",
    )
    parser.add_argument(
        "--report",
        metavar="FILE",
        help="write an HTML or PDF report with drawings, check results, tools, times, stops and offsets",
    )
    parser.add_argument(
        "--paper",
        choices=("a4", "letter"),
        help="paper size of a PDF report (default: the computer's setting)",
    )
    add_folder_options(parser)


def add_folder_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for proving many programs."""
    parser.add_argument(
        "--jobs", metavar="N", type=_parse_count, help="number of worker processes (default: one per core)"
    )
    parser.set_defaults(scheduler=None)
    if find_worker_class_name():
        parser.add_argument(
            "--scheduler",
            metavar="HOST:PORT",
            help="prove with the worker processes of a dask.distributed scheduler",
        )
    parser.add_argument(
        "--no-cache", action="store_true", help="prove all programs again, including those proved before"
    )


def _parse_count(word: str) -> int:
    """Return the number of workers from an option. Raises ArgumentTypeError if the number is invalid."""
    if not word.isdecimal() or not 1 <= int(word) <= MAX_JOBS:
        raise argparse.ArgumentTypeError(
            Message(
                "{word} is not a valid number of worker processes; use 1 to {most_jobs}",
                word=f"{word!r}",
                most_jobs=MAX_JOBS,
            )
        )
    return int(word)


def run(args: argparse.Namespace) -> int:
    """Prove each file. Return 1 if a program has errors, or 2 if a program cannot be read."""
    many = _uses_workers(args)
    from app.cli.proofs.proof_job import ProofJobsByMachine

    jobs = ProofJobsByMachine(args, _create_job)
    jobs.get_job("")  # reports errors in the options before anything is proved
    if many:
        from app.cli.proofs.folder_proofs import prove_programs

        return prove_programs(args, jobs)
    from app.cli.proofs.report_file import open_report

    with open_report(args) as report:
        return max(_prove_and_print(Path(name), jobs, args, report) for name in args.files)


def _uses_workers(args: argparse.Namespace) -> bool:
    """Return whether the programs are proved by workers and the results printed as a table.

    This applies to folders and to the options that specify workers. Raises CommandError for invalid
    combinations.
    """
    given = args.jobs is not None or args.scheduler is not None
    many = given or any(Path(name).is_dir() for name in args.files)
    if "-" in args.files and (many or len(args.files) > 1):
        raise CommandError(
            "the file name - means one program from stdin, which is proved on this computer; do "
            "not combine - with other files, folders or --jobs",
            "stdin-alone",
        )
    if args.no_cache and not many:
        raise CommandError(
            "--no-cache is only for folders and --jobs; a single program is always proved again", "no-cache"
        )
    if args.keep_stock and many:
        raise CommandError(
            "--keep-stock works only with program files, not with folders and --jobs; name each program",
            "keep-stock-of-many",
        )
    if args.jobs is not None and args.scheduler is not None:
        raise CommandError(
            "--jobs and --scheduler cannot be used together, because the scheduler has its "
            "own worker processes",
            "jobs-and-scheduler",
        )
    return many


def _create_job(args: argparse.Namespace) -> ProofJob:
    """Return the common job from the options. Raises CommandError if an option is invalid."""
    from app.cli.part_options import read_part_settings
    from app.cli.proofs.proof_job import ProofJob

    around = read_command_context(args)
    setting = read_part_settings(args, around)
    reported, other = args.report is not None, _other_offsets(args, around.setup)
    if other is not None:
        from core.proving.offset_comparison import FINE_COLUMN_WIDTH_MM

        setting = replace(setting, step=FINE_COLUMN_WIDTH_MM)
    return ProofJob(around.machine, around.setup, setting, args.ideal, args.optional_stop, reported, other)


def _other_offsets(args: argparse.Namespace, setup: InterpreterSetup) -> ComparisonOffsets | None:
    """Return the offsets of --compare, or None if the option is not used.

    Raises CommandError, which lists every error, if the offsets are invalid.
    """
    if args.compare is None:
        return None
    from app.cli.proofs.proof_job import ComparisonOffsets
    from app.compose.stored_offsets import read_offsets_file

    tools, secondary, zero, *_ = read_offsets_file(Path(args.compare))
    return ComparisonOffsets(args.compare, replace(setup, tools=tools, secondary=secondary, zero=zero))


def _prove_and_print(
    path: Path, jobs: ProofJobsByMachine, args: argparse.Namespace, report: ReportFile | None
) -> int:
    """Prove one file and return its exit status.

    A file that cannot be read does not stop the other proofs.
    """
    from app.cli.part_options import apply_stored_stock
    from app.cli.proofs.proof_job import describe_machine_choice
    from app.cli.proofs.proof_work import Proof

    try:
        source = read_source(path, args)
        name = jobs.select_machine_name(source)
        if name:
            sys.stderr.write(describe_machine_choice(path.name, name))
        job = jobs.get_job(name)
        job = replace(job, part_settings=apply_stored_stock(job.part_settings, source.name, args))
    except CommandError as error:
        if report is not None:
            report.add_proof(path, Proof({}, failure_reason=str(error)))
        return command_errors.report_command_error(error)
    found = _prove(path, source, job, args)
    if report is not None:
        report.add_proof(path, Proof({}, found.report_section))
    return EXIT_ERRORS if found.report.errors else EXIT_OK


def _prove(path: Path, source: ProgramSource, job: ProofJob, args: argparse.Namespace) -> ProofResult:
    from app.cli.outputs.proof_output import count_operator_stops, make_report_json
    from app.cli.proofs.proof_work import prove_with_comparison

    with ProgressBar(f"proving {path.name}", len(source.lines)) as progress:
        found = prove_with_comparison(job, source, progress.report_progress)
    report, part, _, compare = found
    if args.json:
        report_json = make_report_json(str(path), report, part, optional_stop=args.optional_stop)
        report_json |= {"compare": compare} if compare is not None else {}
        sys.stdout.write(json.dumps(report_json) + "\n")
    else:
        sys.stdout.write(_proof_text(path, report, part))
        stops = count_operator_stops(report, optional_stop=args.optional_stop)
        sys.stdout.write(f"  stops {stops} times for the operator\n" if stops else "")
        sys.stdout.write(_silenced_text(report))
        if compare is not None:
            from app.cli.outputs.comparison_output import format_comparison

            sys.stdout.write(format_comparison(compare, is_metric=report.is_metric, dialect=report.dialect))
    return found


def _silenced_text(report: ProofReport) -> str:
    """Return the number of suppressed findings and the names of their checks, as text."""
    found = [each.check_name for each in report.diagnostics if each.downgrade_reason]
    return f"  silenced {len(found)} findings of {', '.join(sorted(set(found)))}\n" if found else ""


def _limits_text(report: ProofReport, length: Callable[[float], float], unit: str) -> str:
    """Return the travel limits of the program as text, for X and Z on a lathe or all axes on a mill."""
    if report.mill_results is not None:
        from app.cli.outputs.klartext_output import format_machine_limits

        return format_machine_limits(report.mill_results)
    (x0, x1), (z0, z1) = report.program_ranges.x_range, report.program_ranges.z_range
    return f"  X radius {length(x0):.5f} … {length(x1):.5f}   Z {length(z0):.5f} … {length(z1):.5f} {unit}\n"


def _eased_text(report: ProofReport, length: Callable[[float], float], unit: str) -> str:
    """Return the corner tolerance as text, or an empty string if the machine file defines none."""
    if not report.corner_tolerance_mm:
        return ""
    return f"  joints of short chords within {length(report.corner_tolerance_mm):.5f} {unit} of their words\n"


def _paths_text(report: ProofReport) -> str:
    """Return the number and cycle times of the program's possible execution paths, as text.

    The execution paths depend on inputs and block delete.
    """
    ways = report.branch_summary
    if ways.proved_count + ways.unproved_count <= 1:
        return ""
    left = Message(", {unproved} not proved", unproved=ways.unproved_count) if ways.unproved_count else ""
    low, high = ways.cycle_time_range
    return (
        f"  {ways.proved_count} ways proved{left}: cycle {low:.2f} … {high:.2f} s by inputs and "
        f"block delete\n"
    )


def _proof_text(path: Path, report: ProofReport, part: PartReport | None) -> str:
    """Return the proof as text for the terminal."""
    from app.cli.outputs.proof_output import format_stock
    from app.cli.outputs.units import MM_PER_INCH, round_millimeters, to_inches, to_inches_per_minute
    from core.language.source import Dialect

    inch = report.dialect is Dialect.OMNITURN
    length, unit, scale = (to_inches, "in", 1.0) if inch else (round_millimeters, "mm", MM_PER_INCH)

    findings = "".join(f"{d.format_one_line(str(path))}\n" for d in report.diagnostics)
    times, reach = report.program_times, report.program_ranges
    slow, fast = (to_inches_per_minute(speed) * scale for speed in reach.feed_range)
    tools = " ".join(format_edge_name(n) for n in report.tool_numbers) or "no tool"
    count = len(report.errors)
    verdict = (
        Message("{count} error{value}: the program will not run", count=count, value="s" * (count > 1))
        if count
        else "proved"
    )
    return findings + (
        f"{path}: {verdict}; {report.block_count} blocks, {report.elementary_block_count} elementary, "
        f"{tools}\n"
        f"  cycle {times.cycle_time_s:.2f} s = cutting {times.cutting_time_s:.2f} + rapid "
        f"{times.rapid_time_s:.2f}"
        f" + dwell {times.dwell_time_s:.2f} + waiting {times.wait_time_s:.2f}\n"
        f"{_paths_text(report)}"
        f"  path {length(report.cutting_length_mm):.4f} {unit} cutting,"
        f" {length(report.rapid_length_mm):.4f} {unit} rapid\n"
        f"{_eased_text(report, length, unit)}"
        f"{_limits_text(report, length, unit)}"
        f"  spindle {reach.rpm_range[0]:.0f} … {reach.rpm_range[1]:.0f} rpm"
        f"   feed {slow:.3f} … {fast:.3f} {unit}/min\n"
        f"{format_stock(part, report.dialect) if part is not None else ''}"
    )
