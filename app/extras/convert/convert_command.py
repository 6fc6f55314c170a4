"""Command ``turndesk convert FILE``, which converts a turning program from or to another control.

The command also proves the converted program.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.change_author import add_author_option, get_permitted_user, log_user_change
from app.cli.program_options import parse_output_path
from app.cli.proofs.progress_bar import ProgressBar
from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, convert_to_command_error
from app.extras.convert.conversion_settings import ConversionSettings, make_options
from core.access.access_table import ProtectedChange
from core.extras.convert.source_options import ConversionOptions, SourceControl, TargetControl
from core.json_keys import JsonOutput, declare_keys
from core.language.source import Dialect, ProgramSource, SourceError, load_source
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.extras.convert.conversion import Conversion
    from core.interpreter.shared.job_setup import ControlLimits
    from core.machine.machine_model import Machine

_MM_PER_INCH = 25.4
_OMNITURN = str(Dialect.OMNITURN)


def add_parser(subparsers: SubParsers) -> None:
    """Declare the options of the command."""
    parser = subparsers.add_parser("convert")
    parser.add_argument("file", metavar="FILE", help="program to convert")
    parser.add_argument(
        "--from",
        dest="control",
        choices=[*(str(each) for each in SourceControl), _OMNITURN],
        help="control of the program; fanuc-a and fanuc-b are G-code systems A and B (default: recognized)",
    )
    parser.add_argument(
        "--to",
        choices=[str(each) for each in TargetControl],
        default=_OMNITURN,
        help="control to convert to; linuxcnc and fanuc need an OmniTurn program",
    )
    parser.add_argument(
        "--no-point",
        choices=("1", "0.001"),
        help="value of X1000 without a decimal point: 1 means 1000 units, 0.001 means 1 mm or .1 in",
    )
    parser.add_argument(
        "--unit", choices=("inch", "mm"), help="unit of a program without G20 and G21 (G70 and G71)"
    )
    parser.add_argument(
        "--x", choices=("diameter", "radius"), help="meaning of X at the start (default: of the control)"
    )
    parser.add_argument(
        "--tool-post",
        choices=("rear", "front"),
        default="rear",
        help="front: G02, G03, G41 and G42 are seen with X+ toward the operator",
    )
    parser.add_argument(
        "--skip-m", type=_m_codes, default=frozenset(), metavar="N,N", help="M codes to leave out"
    )
    parser.add_argument("--no-comments", action="store_true", help="write no comments with source lines")
    parser.add_argument("--machine", metavar="FILE", help="machine file (default: the simulated lathe)")
    parser.add_argument(
        "--out", type=parse_output_path, metavar="FILE", help="program file to write (default: stdout)"
    )
    add_author_option(parser)
    parser.add_argument("--json", action="store_true", help="print only JSON on stdout")


def _m_codes(text: str) -> frozenset[int]:
    """Return the M-code numbers in a comma-separated list such as 41,42.

    Raises ArgumentTypeError if the text is not a list of M codes.
    """
    parts = [each.strip().upper().removeprefix("M") for each in text.split(",")]
    if not all(each.isdecimal() for each in parts):
        raise argparse.ArgumentTypeError(
            Message("{text} is not a list of M codes; write --skip-m 41,42", text=f"{text!r}")
        )
    return frozenset(map(int, parts))


def run(args: argparse.Namespace) -> int:
    """Convert and prove the program, and write the result only if it has no errors.

    Returns exit status 1 if there are errors.
    """
    from app.compose.machine.machine_setup import get_control_limits, read_machine
    from core.extras.convert.conversion import convert_program

    machine = read_machine(args.machine)
    who = _may_write(args)
    with convert_to_command_error(SourceError):
        source = load_source(Path(args.file))
    limits = get_control_limits(machine)
    control: str = _OMNITURN
    with ProgressBar(f"converting {args.file}", len(source.lines)) as progress:
        report = progress.report_progress
        if args.to == TargetControl.OMNITURN:
            control = _find_control(args, source)
            options = _options(args, SourceControl(control), machine)
            done = convert_program(source.lines, options, limits, report)
        elif args.to == TargetControl.SINUMERIK:
            control, done = _convert_to_sinumerik(args, source, machine, limits, report)
        else:
            done = _convert_from_omniturn(args, source, machine, limits, report)
    if args.out is not None and not done.errors:
        _write(args, done.text, who)
    _print(args, control, done)
    return EXIT_ERRORS if done.errors else EXIT_OK


def _find_control(args: argparse.Namespace, source: ProgramSource) -> SourceControl | Dialect:
    """Return the control of a program, or ``Dialect.OMNITURN``.

    Raises CommandError if the control is unknown, or if the program already is a program of the target.
    """
    from core.extras.convert.recognition import recognize_language

    if args.control is None and source.dialect is not Dialect.OMNITURN:
        text = (
            "{file} has the file name extension of a {language} program; "
            "name the control of the program with --from"
        )
        raise CommandError(Message(text, file=args.file, language=source.dialect), "unsupported-source")
    control: SourceControl | Dialect | None
    if args.control == _OMNITURN:
        control = Dialect.OMNITURN
    else:
        control = SourceControl(args.control) if args.control else recognize_language(source.lines)
    if control is None:
        raise CommandError(
            Message("{file} is not recognized; name its control with --from", file=args.file),
            "control-unknown",
        )
    if control is Dialect.OMNITURN and args.to == TargetControl.OMNITURN:
        raise CommandError(
            Message("{file} is an OmniTurn program already; name another control with --to", file=args.file),
            "same-control",
        )
    return control


def _convert_to_sinumerik(
    args: argparse.Namespace,
    source: ProgramSource,
    machine: Machine,
    limits: ControlLimits,
    report_line: Callable[[int], None],
) -> tuple[str, Conversion]:
    """Convert a program to SINUMERIK; return the control of the source too.

    Raises CommandError if the control is unknown, and for an option that has no effect.
    """
    from core.extras.convert.targets.target_conversion import convert_to_sinumerik

    control = _find_control(args, source)
    is_omniturn = control is Dialect.OMNITURN
    if is_omniturn:
        _reject_idle_options(args)
    own_control = SourceControl.LINUXCNC if is_omniturn else SourceControl(control)
    options, title = _options(args, own_control, machine), Path(args.file).name
    done = convert_to_sinumerik(
        source.lines, options, limits, title, is_omniturn=is_omniturn, report_line=report_line
    )
    return control, done


def _convert_from_omniturn(
    args: argparse.Namespace,
    source: ProgramSource,
    machine: Machine,
    limits: ControlLimits,
    report_line: Callable[[int], None],
) -> Conversion:
    """Convert an OmniTurn program to another control.

    Raises CommandError for a program of another control, and for an option that has no effect.
    """
    from core.extras.convert.targets.target_conversion import convert_from_omniturn

    is_other_file = args.control is None and source.dialect is not Dialect.OMNITURN
    if is_other_file or _find_control(args, source) is not Dialect.OMNITURN:
        text = "--to {target} needs an OmniTurn program; convert {file} to OmniTurn first"
        raise CommandError(Message(text, target=args.to, file=args.file), "not-omniturn")
    _reject_idle_options(args)
    options = _options(args, SourceControl.LINUXCNC, machine)
    title = Path(args.file).name
    return convert_from_omniturn(source.lines, TargetControl(args.to), options, limits, title, report_line)


def _reject_idle_options(args: argparse.Namespace) -> None:
    """Raise CommandError for an option that has no effect on an OmniTurn program."""
    for option, value in (("--no-point", args.no_point), ("--unit", args.unit), ("--x", args.x)):
        if value is not None:
            text = "{option} has no effect on an OmniTurn program; leave it out"
            raise CommandError(Message(text, option=option), "option-without-effect")
    if args.tool_post == "front":
        text = (
            "{target} calculates G02, G03, G41 and G42 in Z and X, whatever side the tool post is on; "
            "leave out --tool-post front"
        )
        raise CommandError(Message(text, target=args.to), "option-without-effect")


def _options(args: argparse.Namespace, control: SourceControl, machine: Machine) -> ConversionOptions:
    settings = ConversionSettings(
        no_point=float(args.no_point or 0),
        is_metric=None if args.unit is None else args.unit == "mm",
        is_diameter=None if args.x is None else args.x == "diameter",
        has_front_tool_post=args.tool_post == "front",
        skipped_m_codes=args.skip_m,
        has_comments=not args.no_comments,
    )
    return make_options(control, settings, machine)


def _may_write(args: argparse.Namespace) -> str:
    """Return the user who may write the ``--out`` file, or an empty string without this option.

    Raises CommandError if the file exists, has no folder, or may not be written.
    """
    if args.out is None:
        return ""
    if Path(args.out).exists():
        raise CommandError(
            Message("{file} already exists and will not be overwritten; use a different name", file=args.out),
            "file-exists",
        )
    if not Path(args.out).parent.is_dir():
        raise CommandError(
            Message("{file} cannot be written: its folder does not exist", file=args.out), "no-folder"
        )
    return get_permitted_user(open_store, args, ProtectedChange.PROGRAMS)


def _write(args: argparse.Namespace, text: str, who: str) -> None:
    from app.programs.atomic_files import FileOperationError, write_new_file

    with convert_to_command_error(FileOperationError):
        write_new_file(Path(args.out), text.encode("ascii", "replace"))
    log_user_change(
        open_store,
        who,
        Message("program {out} converted from {file}", out=Path(args.out).name, file=Path(args.file).name),
    )


def _print(args: argparse.Namespace, control: str, done: Conversion) -> None:
    from core.extras.convert.conversion import group_findings

    if args.json:
        sys.stdout.write(json.dumps(_in_json(args, control, done)) + "\n")
        return
    if args.out is None and not done.errors:
        sys.stdout.write(done.text)
    for finding, further_lines in group_findings(done.findings):
        also = Message(" (also in {lines})", lines=further_lines) if further_lines else ""
        sys.stderr.write(f"{finding.format_one_line(args.file)}{also}\n")
    sys.stderr.write(f"{_summary(args, control, done)}\n")


def _summary(args: argparse.Namespace, control: str, done: Conversion) -> str:
    if done.errors:
        text = "{file}: not converted from {control} to {target}"
        return Message(text, file=args.file, control=control, target=args.to)
    proof = done.proof
    return Message(
        "{file}: converted from {control} to {target}, {lines} lines, {compared} steps proved equal, "
        "{rounded} values rounded by at most {most} in",
        file=args.file,
        control=control,
        target=args.to,
        lines=len(done.lines),
        compared=proof.compared_step_count,
        rounded=proof.rounded_move_count,
        most=f"{proof.max_rounding_mm / _MM_PER_INCH:.6f}",
    )


def _in_json(args: argparse.Namespace, control: str, done: Conversion) -> dict[str, object]:
    return {
        "file": args.file,
        "from": str(control),
        "to": args.to,
        "out": args.out if not done.errors else None,
        "program": done.text,
        "source_lines": [each.source_line_number for each in done.lines],
        "steps_compared": done.proof.compared_step_count,
        "values_rounded": done.proof.rounded_move_count,
        "largest_rounding_mm": done.proof.max_rounding_mm,
        "findings": [
            {
                "line": each.line,
                "column": each.column,
                "severity": str(each.severity),
                "code": each.code,
                "message": str(each.message),
                "hint": str(each.hint),
            }
            for each in done.findings
        ],
    }


CONVERT_OUTPUT = JsonOutput(
    "convert FILE --json",
    "One object. If a finding is an error, the exit status is 1, and the program must not be used.",
    declare_keys(
        """
file | string | | The source program.
from | string | | Control of the source program.
to | string | | Language of the converted program.
out | string or null | | File of --out, if it was written.
program | string | | Text of the converted program.
source_lines | list | | Line of the source for each line of the converted program.
steps_compared | integer | | Moves and actions of the source that the proof compared.
values_rounded | integer | | Coordinates that differ from the source because of the resolution of the control.
largest_rounding_mm | number | mm | Largest difference of these coordinates, with X as a radius.
findings | list | | Differences and errors.
findings[].line | integer | | Line of the source; 0 means the whole file.
findings[].column | integer | | Column of the source; 0 means the whole line.
findings[].severity | string | | error, warning or note.
findings[].code | string | | Code of the finding.
findings[].message | string | | What is different or wrong.
findings[].hint | string | | What to do.
"""
    ),
)
OUTPUTS = (CONVERT_OUTPUT,)
