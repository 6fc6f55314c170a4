"""Command ``turndesk shapes FORM.toml --out part.nc``, which generates a program from form steps.

The module also declares the JSON keys of the command.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.change_author import add_author_option, get_permitted_user, log_user_change
from app.cli.program_options import parse_output_path
from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, convert_to_command_error
from core.access.access_table import ProtectedChange
from core.json_keys import JsonOutput, declare_keys
from core.language.source import Dialect, ProgramSource, guess_dialect
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.extras.shapes.shape_steps import GeneratedProgram, ShapeStep
    from core.machine.machine_model import Machine


_ABOUT = """\
Each [[step]] is a form of the editor, with its fields as keys; what is not said is proposed, as there:

  [[step]]
  kind = "head"
  bar = 1.0
  [[step]]
  kind = "face"
  t = 1
  [[step]]
  kind = "turn"
  points = [{x = .5, z = 0}, {z = -.5}, {x = .7, r = .1}, {z = -1.1}]

The depth of a rough pass is proposed by material, insert and machine (key rough), with what is left in X
and Z for finishing (key leave). A pass that is deeper than the insert takes is refused.

turndesk shapes --list names all kinds and their keys.
"""


def add_parser(subparsers: SubParsers) -> None:
    """Declare the options of the command."""
    parser = subparsers.add_parser(
        "shapes",
        description=_ABOUT,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "file",
        metavar="FORM.toml",
        nargs="?",
        help="file with the steps of the program; - reads the steps from stdin",
    )
    parser.add_argument("--list", action="store_true", help="list the kinds of steps and their keys")
    parser.add_argument(
        "--out",
        type=parse_output_path,
        metavar="FILE",
        help="program file to write: .nc is OmniTurn, .mpf is SINUMERIK (default: stdout)",
    )
    parser.add_argument(
        "--tools", metavar="FILE", help="file with tool shapes to use instead of the stored shapes"
    )
    parser.add_argument("--machine", metavar="FILE", help="machine file (default: the simulated lathe)")
    add_author_option(parser)
    parser.add_argument("--json", action="store_true", help="print only JSON on stdout")


def run(args: argparse.Namespace) -> int:
    """Write the program and prove it.

    Returns exit status 1 if the program has errors. Raises CommandError if no program can be written.
    """
    from app.compose.machine.machine_setup import read_machine

    machine = read_machine(args.machine)
    dialect = _language(args.out, machine)
    if args.list:
        return _list(dialect, as_json=args.json)
    if args.file is None:
        raise CommandError(
            "specify the file with the steps; --list shows what the file can contain", "no-file"
        )
    who = authorize_writing(args)
    made = _written(args, machine, dialect)
    text = "\n".join(made.program_lines) + "\n"
    errors, cycle = _proved(args, machine, ProgramSource(_name(args, dialect), text, dialect))
    if args.out is not None:
        save_generated_program(args, text, who)
    _tell(args, made, text, errors, cycle)
    return EXIT_ERRORS if errors else EXIT_OK


def _language(out: str | None, machine: Machine) -> Dialect:
    """Return the program language, which depends on the output file name or else on the machine.

    Raises CommandError if the language is Klartext.
    """
    said = Dialect(machine.mdi_language) if out is None else guess_dialect(Path(out).name)
    if said is Dialect.KLARTEXT:
        raise CommandError(
            Message(
                "{file}: shapes can be written only for OmniTurn or SINUMERIK; use a name that ends "
                "in .nc or .mpf",
                file=out or machine.source,
            ),
            "wrong-language",
        )
    return said


def _name(args: argparse.Namespace, dialect: Dialect) -> str:
    from core.language.source import get_default_extension

    return Path(args.out).name if args.out is not None else f"shapes{get_default_extension(dialect)}"


def _written(args: argparse.Namespace, machine: Machine, dialect: Dialect) -> GeneratedProgram:
    from app.compose.stored_offsets import read_stored_shapes
    from app.extras.shapes.shape_steps import InvalidStepError, generate_program
    from app.extras.shapes.shapes_setup import make_shop_data
    from app.offsets.offsets_file import read_tool_shapes
    from core.extras.shapes.shape_fields import ProgramSettings

    steps = _steps(Path(args.file))
    shapes = read_stored_shapes() if args.tools is None else read_tool_shapes(Path(args.tools))
    new = ProgramSettings(metric=not machine.is_inch, shop=make_shop_data(machine, shapes), dialect=dialect)
    try:
        return generate_program(steps, new)
    except InvalidStepError as error:
        raise CommandError(f"{args.file}: {error}", "invalid-step") from error


def _steps(path: Path) -> list[ShapeStep]:
    from app.desk.toml_file import make_unknown_key_error, raise_mistakes, read_toml

    data = read_toml(path)
    raise_mistakes(path, [make_unknown_key_error(key, ["step"]) for key in data if key != "step"])
    steps = data.get("step")
    if not isinstance(steps, list) or not steps or not all(isinstance(each, dict) for each in steps):
        raise CommandError(
            Message(
                '{path} has no steps; write each step as a table [[step]] with a kind, such as kind = "head"',
                path=path,
            ),
            "no-steps",
        )
    return steps


def _proved(
    args: argparse.Namespace, machine: Machine, source: ProgramSource
) -> tuple[tuple[str, ...], float]:
    from app.compose.program_proving import create_loading_steps
    from app.compose.program_transfer import create_program_checker
    from app.compose.stored_offsets import make_offsets_reader

    return create_program_checker(
        create_loading_steps(machine, make_offsets_reader(args.tools), draw_pictures=False)
    )(source)


def _tell(
    args: argparse.Namespace, made: GeneratedProgram, text: str, errors: tuple[str, ...], cycle: float
) -> None:
    if args.json:
        result = {"file": args.file, "out": args.out, "program": text, "steps": list(made.step_kinds)}
        more = {"words": list(made.remarks), "errors": list(errors), "cycle_time_s": round(cycle, 3)}
        sys.stdout.write(json.dumps({**result, **more}) + "\n")
        return
    if args.out is None:
        sys.stdout.write(text)
    else:
        sys.stdout.write(
            f"{args.out}: {len(made.program_lines)} lines, steps: {len(made.step_kinds)}, cycle "
            f"{cycle:.1f} s\n"
        )
    for line in (*made.remarks, *errors):
        sys.stderr.write(f"turndesk: {line}\n")


def _list(dialect: Dialect, *, as_json: bool) -> int:
    from app.extras.shapes.shape_steps import POINTS, get_shapes_by_kind, map_keys_to_fields

    found = {
        kind: [*map_keys_to_fields(shape), *((POINTS,) if shape.has_point_table else ())]
        for kind, shape in get_shapes_by_kind(dialect).items()
    }
    if as_json:
        sys.stdout.write(json.dumps(found) + "\n")
        return EXIT_OK
    for kind, shape in get_shapes_by_kind(dialect).items():
        sys.stdout.write(f"{kind}: {shape.summary}\n")
        for key, word in map_keys_to_fields(shape).items():
            known = shape.find_field(word)
            choices = f": {', '.join(known.choices).lower()}" if known is not None and known.choices else ""
            label = known.label.lower() if known is not None else ""
            sys.stdout.write(f"  {key:<10} {label}{choices}\n")
        if shape.has_point_table:
            sys.stdout.write(f"  {POINTS:<10} a list of x, z, and chamfer c, radius r or arc a\n")
    return EXIT_OK


# --- output ----------------


def authorize_writing(args: argparse.Namespace) -> str:
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


def save_generated_program(args: argparse.Namespace, text: str, author: str) -> None:
    """Write the new file ``--out``. Raises CommandError if the file exists or cannot be written."""
    from app.programs.atomic_files import FileOperationError, write_new_file

    with convert_to_command_error(FileOperationError):
        write_new_file(Path(args.out), text.encode("ascii"))
    log_user_change(
        open_store,
        author,
        Message("program {out} made from {file}", out=Path(args.out).name, file=Path(args.file).name),
    )


SHAPES_OUTPUT = JsonOutput(
    "shapes FORM.toml --json",
    "One object.",
    declare_keys(
        """
file | string | | The file with the steps.
out | string or null | | File of --out.
program | string | | Text of the program.
steps | list | | Kinds of the steps.
words | list | | Choices and observations of TurnDesk, as sentences.
errors | list | | Errors of the program; the exit status is then 1.
cycle_time_s | number | s | Cycle time.
"""
    ),
)
SHAPES_LIST_OUTPUT = JsonOutput(
    "shapes --list --json",
    "One object.",
    declare_keys("* | list | | Keys that a step of this kind can have."),
)
OUTPUTS = (SHAPES_OUTPUT, SHAPES_LIST_OUTPUT)
