"""Command ``turndesk shapes FORM.toml --out part.nc``: forms of the editor as a file; keys of its JSON."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.program_options import out_file
from app.cli.store_command import opened_store
from app.cli.who_changes import add_as_option, note_change, who_may
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, as_command_error
from core.access.access_table import Act
from core.json_key import Output, keys
from core.language.source import Dialect, Source, dialect_of
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.extras.shapes.shape_steps import Step, Written
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
        type=out_file,
        metavar="FILE",
        help="program file to write: .nc is OmniTurn, .mpf is SINUMERIK (default: stdout)",
    )
    parser.add_argument(
        "--tools", metavar="FILE", help="file with tool shapes to use instead of the stored shapes"
    )
    parser.add_argument("--machine", metavar="FILE", help="machine file (default: the simulated lathe)")
    add_as_option(parser)
    parser.add_argument("--json", action="store_true", help="print only JSON on stdout")


def run(args: argparse.Namespace) -> int:
    """Write the program and prove it. Return 1 if it has errors. Raises CommandError."""
    from app.compose.machine.machine_setup import read_machine

    machine = read_machine(args.machine)
    dialect = _language(args.out, machine)
    if args.list:
        return _list(dialect, as_json=args.json)
    if args.file is None:
        raise CommandError(
            "specify the file with the steps; --list shows what the file can contain", "no-file"
        )
    who = may_write(args)
    made = _written(args, machine, dialect)
    text = "\n".join(made.lines) + "\n"
    errors, cycle = _proved(args, machine, Source(_name(args, dialect), text, dialect))
    if args.out is not None:
        write_made(args, text, who)
    _tell(args, made, text, errors, cycle)
    return EXIT_ERRORS if errors else EXIT_OK


def _language(out: str | None, machine: Machine) -> Dialect:
    """Return the language of the output file name, or else of the machine.

    Raises CommandError for Klartext.
    """
    said = Dialect(machine.language) if out is None else dialect_of(Path(out).name)
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
    from core.language.source import usual_ending

    return Path(args.out).name if args.out is not None else f"shapes{usual_ending(dialect)}"


def _written(args: argparse.Namespace, machine: Machine, dialect: Dialect) -> Written:
    from app.compose.stored_offsets import stored_shapes
    from app.extras.shapes.shape_steps import StepError, written
    from app.extras.shapes.shapes_desk import shop_of
    from app.offsets.offsets_file import read_tool_shapes
    from core.extras.shapes.shape_fields import Setting

    steps = _steps(Path(args.file))
    shapes = stored_shapes() if args.tools is None else read_tool_shapes(Path(args.tools))
    new = Setting(metric=not machine.inch, shop=shop_of(machine, shapes), dialect=dialect)
    try:
        return written(steps, new)
    except StepError as error:
        raise CommandError(f"{args.file}: {error}", "invalid-step") from error


def _steps(path: Path) -> list[Step]:
    from app.desk.toml_file import read_toml, refuse, unknown_key

    data = read_toml(path)
    refuse(path, [unknown_key(key, ["step"]) for key in data if key != "step"])
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


def _proved(args: argparse.Namespace, machine: Machine, source: Source) -> tuple[tuple[str, ...], float]:
    from app.compose.program_transfer import proving
    from app.compose.stored_offsets import chosen_offsets
    from app.compose.workshop import workshop

    return proving(workshop(machine, chosen_offsets(args.tools), pictures=False))(source)


def _tell(args: argparse.Namespace, made: Written, text: str, errors: tuple[str, ...], cycle: float) -> None:
    if args.json:
        told = {"file": args.file, "out": args.out, "program": text, "steps": list(made.kinds)}
        more = {"words": list(made.words), "errors": list(errors), "cycle_time_s": round(cycle, 3)}
        sys.stdout.write(json.dumps({**told, **more}) + "\n")
        return
    if args.out is None:
        sys.stdout.write(text)
    else:
        sys.stdout.write(
            f"{args.out}: {len(made.lines)} lines, steps: {len(made.kinds)}, cycle {cycle:.1f} s\n"
        )
    for line in (*made.words, *errors):
        sys.stderr.write(f"turndesk: {line}\n")


def _list(dialect: Dialect, *, as_json: bool) -> int:
    from app.extras.shapes.shape_steps import POINTS, keys_of, kinds_of

    found = {
        kind: [*keys_of(shape), *((POINTS,) if shape.contour else ())]
        for kind, shape in kinds_of(dialect).items()
    }
    if as_json:
        sys.stdout.write(json.dumps(found) + "\n")
        return EXIT_OK
    for kind, shape in kinds_of(dialect).items():
        sys.stdout.write(f"{kind}: {shape.use}\n")
        for key, word in keys_of(shape).items():
            known = shape.field(word)
            choices = f": {', '.join(known.choices).lower()}" if known is not None and known.choices else ""
            label = known.label.lower() if known is not None else ""
            sys.stdout.write(f"  {key:<10} {label}{choices}\n")
        if shape.contour:
            sys.stdout.write(f"  {POINTS:<10} a list of x, z, and chamfer c, radius r or arc a\n")
    return EXIT_OK


# --- output ----------------


def may_write(args: argparse.Namespace) -> str:
    """Return the user who may write ``--out``, or an empty string without it. Raises CommandError."""
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
    return who_may(opened_store, args, Act.PROGRAMS)


def write_made(args: argparse.Namespace, text: str, who: str) -> None:
    """Write ``--out``, which must not exist. Raises CommandError."""
    from app.programs.whole_file import FileError, write_new

    with as_command_error(FileError):
        write_new(Path(args.out), text.encode("ascii"))
    note_change(
        opened_store,
        who,
        Message("program {out} made from {file}", out=Path(args.out).name, file=Path(args.file).name),
    )


SHAPES = Output(
    "shapes FORM.toml --json",
    "One object.",
    keys(
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
SHAPES_LIST = Output(
    "shapes --list --json", "One object.", keys("* | list | | Keys that a step of this kind can have.")
)
OUTPUTS = (SHAPES, SHAPES_LIST)
