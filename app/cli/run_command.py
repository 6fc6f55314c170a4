"""The command ``turndesk run FILE --headless``: run a program without a screen.

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
    Circumstances,
    add_program_options,
    circumstances,
    input_states,
    read_source,
)
from app.cli.proofs.progress_bar import Progress
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError
from core.message import Message
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.desk.run_without_screen import Outcome
    from core.executor.job import Job
    from core.language.source import Dialect
    from core.proving.proof_report import Report


_AROUND = 30.0  # s of the scope record in addition to the duration of the program
_OF_ALARMS = ("number", "code", "text", "cause", "remedy", "line")


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command."""
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
    """Prove the program and run one cycle; return 1 if the program or the run has errors."""
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
    around = circumstances(args)
    job = make_job(read_source(path, args), around.setup)
    report = _proved(args, around, job)
    sys.stderr.write("".join(f"{d.in_one_line(str(path))}\n" for d in report.diagnostics))
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
    if report.missing_tools:
        names = ", ".join(edge_name(key) for key in report.missing_tools)
        why = Message(
            "{path}: no offset has been set for {names}; set the offset with turndesk "
            "offsets set, or use --offsets",
            path=path,
            names=names,
        )
        return _refused(args, why, report)
    unanswered = [need for need in report.needs if need.builders_m]
    if unanswered:
        why = Message(
            "{path} line {line}: this machine does not define {unanswered}",
            path=path,
            line=unanswered[0].line,
            unanswered=unanswered[0].words,
        )
        return _refused(args, why, report)
    return _run(args, around, job, report)


def _proved(args: argparse.Namespace, around: Circumstances, job: Job) -> Report:
    """Return the proof of the program and its part."""
    from app.cli.part_options import part_setting, with_kept_stock
    from core.proving.part_proof import prove_with_part

    setting = with_kept_stock(part_setting(args, around), job.source.name, args)
    report, _part = prove_with_part(job.reading, around.setup, around.machine, setting)
    return report


def _run(args: argparse.Namespace, around: Circumstances, job: Job, report: Report) -> int:
    from app.cli.machine_command import demand_accepted
    from app.compose.runs.headless_run import headless
    from app.compose.runs.run_log import EventLog
    from app.compose.workshop import proof_of

    demand_accepted(around.machine)
    inputs = input_states(args.inputs, around.machine.inputs)
    path = Path(args.file)
    with (
        EventLog.new(path.name) as log,
        Progress(f"running {path.name}", report.times.cycle) as progress,
        headless(
            around.machine,
            inputs=inputs,
            realtime=args.realtime,
            anew=args.anew,
            log=log,
            say=lambda text: _say(path, text),
            progress=progress.reach,
            lasts=report.times.cycle + _AROUND,
        ) as play,
    ):
        outcome = play.run(job, proof_of(job, report), optional_stop=args.optional_stop)
    if log.trouble:
        _say(path, Message("{problem}; the log of this run is incomplete", problem=log.trouble))
    if outcome.why:
        sys.stderr.write(f"turndesk: {path}: {outcome.state}: {outcome.why}\n")
    _write(args, path, outcome, report, str(log.path))
    return EXIT_OK if outcome.state == "complete" else EXIT_ERRORS


def _say(path: Path, text: str) -> None:
    sys.stderr.write(f"{path}: {text}\n")


def _refused(args: argparse.Namespace, why: str, report: Report) -> int:
    sys.stderr.write(f"turndesk: {why}\n")
    if args.json:
        figures = _figures(None, report.dialect)
        _write_line({"state": "refused", "final": _place(report, None), **figures, "events": ""})
    return EXIT_ERRORS


def _write(args: argparse.Namespace, path: Path, outcome: Outcome, report: Report, events: str) -> None:
    final = _place(report, outcome)
    figures = _figures(outcome, report.dialect)
    if args.json:
        _write_line({"state": outcome.state, "final": final, **figures, "events": events})
        return
    unit = "in" if report.dialect == "omniturn" else "mm"
    sys.stdout.write(
        f"{path}: {outcome.state} after {outcome.elapsed:.2f} s (proved: {report.times.cycle:.2f} s)\n"
        f"  at {_shown_place(final, mill=report.mill is not None)} {unit};"
        f" following error at most {figures['max_following_error']:.5f} {unit},"
        f" {figures['underruns']} underruns; log {events}\n"
    )


def _write_line(line: dict[str, object]) -> None:
    sys.stdout.write(json.dumps(line) + "\n")


def _shown_place(final: dict[str, float], *, mill: bool) -> str:
    if mill:
        return "  ".join(f"{name[-1].upper()} {at:.3f}" for name, at in final.items() if name[0] in "mabc")
    return Message("X radius {final}  Z {final2}", final=f"{final['x']:.5f}", final2=f"{final['z']:.5f}")


def _place(report: Report, outcome: Outcome | None) -> dict[str, float]:
    """Return the position of the tip in the frame of the last move.

    X is a radius. Lengths are inches or mm, depending on the language.
    """
    from app.cli.figures.units import degrees, length_of
    from core.language.source import Dialect

    if report.mill is not None:
        from app.cli.figures.klartext_figures import place

        complete = outcome is not None and outcome.state == "complete"
        return place(report.mill, outcome.snapshot.demand if outcome else (), complete=complete)
    if outcome is None:
        return {"x": 0.0, "z": 0.0, "c": 0.0}
    demand = outcome.snapshot.demand
    x, z, c = demand[0], demand[1], demand[-1]
    shift_x = report.machine_final[0] - report.final[0]
    shift_z = report.machine_final[1] - report.final[1]
    if report.dialect is Dialect.SINUMERIK:
        c -= report.machine_final[2] - report.final[2]
    length = length_of(report.dialect)
    return {"x": length(x - shift_x), "z": length(z - shift_z), "c": degrees(c)}


def _figures(outcome: Outcome | None, dialect: Dialect) -> dict[str, object]:
    from app.cli.figures.units import length_of, seconds

    if outcome is None:
        return {"elapsed_s": 0.0, "alarms": [], "underruns": 0, "max_following_error": 0.0}
    snapshot = outcome.snapshot
    return {
        "elapsed_s": seconds(outcome.elapsed),
        "alarms": [{name: getattr(alarm, name) for name in _OF_ALARMS} for alarm in snapshot.alarms],
        "underruns": snapshot.underruns,
        "max_following_error": length_of(dialect)(snapshot.max_following_error),
    }
