"""The command ``turndesk run FILE --headless``, which runs a program without a screen.

The run uses the real executor and drivers.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.part_options import add_part_options
from app.cli.program_options import (
    CommandContext,
    add_program_options,
    read_command_context,
    read_input_states,
    read_source,
)
from app.cli.proofs.progress_bar import ProgressBar
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError
from core.message import Message
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.desk.headless_run import RunOutcome
    from core.executor.job import Job
    from core.language.source import Dialect
    from core.proving.proof_report import ProofReport


_EXTRA_RECORD_S = 30.0  # s of the scope record in addition to the duration of the program
_ALARM_COLUMNS = ("number", "code", "text", "cause", "remedy", "line")


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``run``."""
    parser = subparsers.add_parser("run")
    parser.add_argument("file", metavar="FILE")
    parser.add_argument(
        "--headless", action="store_true", help="run without a screen (to open the screen, use: turndesk)"
    )
    parser.add_argument(
        "--realtime",
        action="store_true",
        help="run at the speed of the machine instead of as fast as possible",
    )
    parser.add_argument(
        "--anew", action="store_true", help="start at the first line even if a job was interrupted"
    )
    add_program_options(parser)
    add_part_options(parser)


def run(args: argparse.Namespace) -> int:
    """Prove the program and run one cycle. Return 1 if the proof or the run has errors."""
    from core.executor.job import make_job

    path = Path(args.file)
    if not args.headless:
        raise CommandError(
            Message(
                "to run without the screen, add --headless; to open the screen, run: turndesk "
                "--program {path}",
                path=path,
            ),
            "needs-headless",
        )
    around = read_command_context(args)
    job = make_job(read_source(path, args), around.setup)
    report = _prove_program(args, around, job)
    sys.stderr.write("".join(f"{d.format_one_line(str(path))}\n" for d in report.diagnostics))
    if report.errors:
        return _refused(
            args,
            Message(
                "{path} has {errors_count} errors and will not run",
                path=path,
                errors_count=len(report.errors),
            ),
            report,
        )
    if report.missing_tool_numbers:
        names = ", ".join(format_edge_name(key) for key in report.missing_tool_numbers)
        why = Message(
            "{path}: no offset has been set for {names}; set the offset with turndesk "
            "offsets set, or use --offsets",
            path=path,
            names=names,
        )
        return _refused(args, why, report)
    unanswered = [need for need in report.required_functions if need.missing_m_code]
    if unanswered:
        why = Message(
            "{path} line {line}: this machine does not define {unanswered}",
            path=path,
            line=unanswered[0].first_line,
            unanswered=unanswered[0].description,
        )
        return _refused(args, why, report)
    return _run(args, around, job, report)


def _prove_program(args: argparse.Namespace, circumstances: CommandContext, job: Job) -> ProofReport:
    """Prove the program and the part that it makes, and return the proof report."""
    from app.cli.part_options import apply_stored_stock, read_part_settings
    from core.proving.part_proof import prove_program_and_part

    setting = apply_stored_stock(read_part_settings(args, circumstances), job.source.name, args)
    report, _part = prove_program_and_part(
        job.shared_program, circumstances.setup, circumstances.machine, setting
    )
    return report


def _run(args: argparse.Namespace, around: CommandContext, job: Job, report: ProofReport) -> int:
    from app.cli.machine_command import require_accepted_file
    from app.compose.program_proving import create_proof
    from app.compose.runs.headless_run import run_headless
    from app.compose.runs.run_log import EventLog

    require_accepted_file(around.machine)
    inputs = read_input_states(args.inputs, around.machine.inputs)
    path = Path(args.file)
    with (
        EventLog.create(path.name) as log,
        ProgressBar(f"running {path.name}", report.program_times.cycle_time_s) as progress,
        run_headless(
            around.machine,
            input_states=inputs,
            is_real_time=args.realtime,
            discard_interrupted=args.anew,
            event_log=log,
            print_line=lambda text: _say(path, text),
            report_progress=progress.report_progress,
            duration_s=report.program_times.cycle_time_s + _EXTRA_RECORD_S,
        ) as play,
    ):
        outcome = play.run_job(job, create_proof(job, report), optional_stop=args.optional_stop)
    if log.error_text:
        _say(path, Message("{problem}; the log of this run is incomplete", problem=log.error_text))
    if outcome.failure_reason:
        sys.stderr.write(f"turndesk: {path}: {outcome.final_state}: {outcome.failure_reason}\n")
    _write(args, path, outcome, report, str(log.path))
    return EXIT_OK if outcome.final_state == "complete" else EXIT_ERRORS


def _say(path: Path, text: str) -> None:
    sys.stderr.write(f"{path}: {text}\n")


def _refused(args: argparse.Namespace, why: str, report: ProofReport) -> int:
    sys.stderr.write(f"turndesk: {why}\n")
    if args.json:
        run_values = _figures(None, report.dialect)
        _write_line({"state": "refused", "final": _final_position(report, None), **run_values, "events": ""})
    return EXIT_ERRORS


def _write(
    args: argparse.Namespace, path: Path, outcome: RunOutcome, report: ProofReport, events: str
) -> None:
    final = _final_position(report, outcome)
    run_values = _figures(outcome, report.dialect)
    if args.json:
        _write_line({"state": outcome.final_state, "final": final, **run_values, "events": events})
        return
    unit = "in" if report.dialect == "omniturn" else "mm"
    sys.stdout.write(
        f"{path}: {outcome.final_state} after {outcome.elapsed_s:.2f} s (proved: "
        f"{report.program_times.cycle_time_s:.2f} s)\n"
        f"  at {_shown_place(final, mill=report.mill_results is not None)} {unit};"
        f" following error at most {run_values['max_following_error']:.5f} {unit},"
        f" {run_values['underruns']} underruns; log {events}\n"
    )


def _write_line(line: dict[str, object]) -> None:
    sys.stdout.write(json.dumps(line) + "\n")


def _shown_place(final: dict[str, float], *, mill: bool) -> str:
    if mill:
        return "  ".join(f"{name[-1].upper()} {at:.3f}" for name, at in final.items() if name[0] in "mabc")
    return Message("X radius {final}  Z {final2}", final=f"{final['x']:.5f}", final2=f"{final['z']:.5f}")


def _final_position(report: ProofReport, outcome: RunOutcome | None) -> dict[str, float]:
    """Return the final tool tip position in the coordinate system of the last move.

    X is a radius. Lengths are in inches for OmniTurn programs, and otherwise in mm.
    """
    from app.cli.outputs.units import get_length_converter, round_degrees
    from core.language.source import Dialect

    if report.mill_results is not None:
        from app.cli.outputs.klartext_output import get_final_position

        complete = outcome is not None and outcome.final_state == "complete"
        return get_final_position(
            report.mill_results, outcome.snapshot.demand if outcome else (), is_complete=complete
        )
    if outcome is None:
        return {"x": 0.0, "z": 0.0, "c": 0.0}
    demand = outcome.snapshot.demand
    x, z, c = demand[0], demand[1], demand[-1]
    shift_x = report.machine_final_position[0] - report.final_position[0]
    shift_z = report.machine_final_position[1] - report.final_position[1]
    if report.dialect is Dialect.SINUMERIK:
        c -= report.machine_final_position[2] - report.final_position[2]
    length = get_length_converter(report.dialect)
    return {"x": length(x - shift_x), "z": length(z - shift_z), "c": round_degrees(c)}


def _figures(outcome: RunOutcome | None, dialect: Dialect) -> dict[str, object]:
    from app.cli.outputs.units import get_length_converter, round_seconds

    if outcome is None:
        return {"elapsed_s": 0.0, "alarms": [], "underruns": 0, "max_following_error": 0.0}
    snapshot = outcome.snapshot
    return {
        "elapsed_s": round_seconds(outcome.elapsed_s),
        "alarms": [{name: getattr(alarm, name) for name in _ALARM_COLUMNS} for alarm in snapshot.alarms],
        "underruns": snapshot.underruns,
        "max_following_error": get_length_converter(dialect)(snapshot.max_following_error),
    }
