"""``turndesk shapes FORM.toml --out part.nc``: the forms of the editor as a file; keys of its JSON.

The file has steps with the fields of the forms, one behind the other, as the page writes them.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.program_options import out_file
from app.cli.store_command import opened_store
from app.cli.who_changes import add_as_option, note_change, who_may
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, as_command_error
from app.extras.shapes.shape_form import COLUMNS, ShapeForm
from core.access.access_table import Act
from core.extras.shapes.lines.code_lines import plain
from core.extras.shapes.pieces import begun, setting_at, with_shape
from core.extras.shapes.shape import Shape
from core.extras.shapes.shape_fields import WORDS, Kind, Setting
from core.extras.shapes.shape_table import SHAPES_OF
from core.extras.shapes.templates import HEAD
from core.json_key import Output, keys
from core.language.source import Dialect, Source, dialect_of
from core.message import Message, nearest

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
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
    """Declare the command."""
    parser = subparsers.add_parser(
        "shapes",
        help="make a program from the shapes that a file defines",
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
    """Write the program and prove it; 1 when it would have errors. Raises CommandError."""
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
    """By the name of the program, without one that of the machine."""
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


# --- what a command has made


def may_write(args: argparse.Namespace) -> str:
    """Return who may write ``--out``, empty without one. Raises CommandError."""
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
    """Write ``--out``, which must not exist yet. Raises CommandError."""
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


KIND, POINTS = "kind", "points"
_KEYS = {"KIND": "edge_kind"}  # the field of EDGE TURN that would be called as the step's own

Step = Mapping[str, object]


class StepError(Exception):
    """Steps that make no program; each mistake names its step and its key."""

    def __init__(self, mistakes: Sequence[str]) -> None:
        super().__init__("; ".join(mistakes))


@dataclass(frozen=True, slots=True)
class Written:
    """The program; ``kinds`` are the steps, ``words`` what is to be said of their lines."""

    lines: tuple[str, ...]
    kinds: tuple[str, ...]
    words: tuple[str, ...]


def kinds_of(dialect: Dialect) -> dict[str, Shape]:
    """The shapes by the name that a step has for them."""
    return {shape.name.lower(): shape for shape in SHAPES_OF[dialect].values()}


def keys_of(shape: Shape) -> dict[str, str]:
    """By the keys of a step the words of its fields; a contour has points besides."""
    return {_KEYS.get(each.word, each.word.lower()): each.word for each in shape.fields}


def written(steps: Sequence[Step], new: Setting) -> Written:
    """The program of these steps, as the forms write them. Raises StepError."""
    shapes = [_shape(number, step, new.dialect) for number, step in enumerate(steps, 1)]
    mistakes = [text for number, step in enumerate(steps, 1) for text in _strange(number, step, shapes)]
    if mistakes := [*(each for each in shapes if isinstance(each, str)), *mistakes]:
        raise StepError(mistakes)
    lines: list[str] = []
    at, said = 0, list[str]()
    for number, (step, shape) in enumerate(zip(steps, shapes, strict=True), 1):
        assert isinstance(shape, Shape)
        if shape.name != HEAD.name and not begun(lines, new.dialect):
            raise StepError(
                [
                    Message(
                        "step {number}: a program must begin with a head; put a step with kind = "
                        '"head" first',
                        number=number,
                    )
                ]
            )
        form = _form(number, step, shape, setting_at(lines, at, new.shop, new))
        lines, at = with_shape(lines, at, form.one, form.setting)
        said += [
            Message("step {number}, {shape}: {word}", number=number, shape=shape.name.lower(), word=word)
            for word in form.words
        ]
    return Written(
        tuple(lines), tuple(each.name.lower() for each in shapes if isinstance(each, Shape)), tuple(said)
    )


def _shape(number: int, step: Step, dialect: Dialect) -> Shape | str:
    """The shape of a step, else what is wrong with its kind."""
    kinds = kinds_of(dialect)
    kind = step.get(KIND)
    if not isinstance(kind, str):
        return Message("step {number} has no kind; use one of {kinds}", number=number, kinds=", ".join(kinds))
    name = " ".join(kind.lower().replace("-", " ").replace("_", " ").split())
    if name in kinds:
        return kinds[name]
    near = nearest(name, kinds)
    return Message(
        "step {number}: kind {kind} does not exist; {nearest}",
        number=number,
        kind=kind,
        nearest=f"did you mean {near}?" if near else f"use one of {', '.join(kinds)}",
    )


def _strange(number: int, step: Step, shapes: Sequence[Shape | str]) -> list[str]:
    """Keys that its shape has not, and values that are neither figures nor words."""
    shape = shapes[number - 1]
    if isinstance(shape, str):
        return []
    keys = {KIND, *keys_of(shape), *((POINTS,) if shape.contour else ())}
    found: list[str] = []
    for key, value in step.items():
        where = Message("step {number}, {shape}", number=number, shape=shape.name.lower())
        if key not in keys:
            near = nearest(key, keys)
            found.append(
                Message(
                    "{place}: {key} is unknown; {nearest}",
                    place=where,
                    key=key,
                    nearest=f"did you mean {near}?" if near else f"known: {', '.join(sorted(keys))}",
                )
            )
        elif key != POINTS and (isinstance(value, bool) or not isinstance(value, int | float | str)):
            found.append(Message("{place}: {key} must be a number or a word", place=where, key=key))
    return found


def _form(number: int, step: Step, shape: Shape, setting: Setting) -> ShapeForm:
    """The form with what the step says typed into it. Raises StepError with what the form refuses."""
    form = ShapeForm(shape, setting)
    where = Message("step {number}, {shape}", number=number, shape=shape.name.lower())
    for key, word in keys_of(shape).items():
        if key in step:
            known = shape.field(word)
            assert known is not None
            said = _text(step[key])
            form.typed[word] = said.upper() if known.kind in WORDS else said
            if known.kind is Kind.CHOICE and known.choices and form.typed[word] not in known.choices:
                raise StepError(
                    [
                        Message(
                            "{place}: {key} cannot be {text}; use one of {choices}",
                            place=where,
                            key=key,
                            text=said,
                            choices=", ".join(known.choices).lower(),
                        )
                    ]
                )
    if POINTS in step:
        form.rows = _rows(where, step[POINTS])
    form.work()
    if form.troubles:
        raise StepError([f"{where}: {_key(shape, word)}: {text}" for word, text in form.troubles.items()])
    return form


def _rows(where: str, points: object) -> list[dict[str, str]]:
    """Points as the form has them: x, z, and chamfer c, radius r or arc a."""
    if not isinstance(points, list) or not all(isinstance(each, dict) for each in points):
        raise StepError(
            [
                Message(
                    "{place}: points must be a list, such as [{{x = .5, z = 0}}, {{z = -1, r = .1}}]",
                    place=where,
                )
            ]
        )
    for count, point in enumerate(points, 1):
        for key in point:
            if key.upper() not in COLUMNS:
                raise StepError(
                    [
                        Message(
                            "{place}: point {count}: key {key} is unknown; use one of {columns}",
                            place=where,
                            count=count,
                            key=key,
                            columns=", ".join(COLUMNS).lower(),
                        )
                    ]
                )
    return [{key.upper(): _text(value) for key, value in point.items()} for point in points]


def _text(value: object) -> str:
    return plain(float(value), 6) if isinstance(value, int | float) else str(value)


def _key(shape: Shape, word: str) -> str:
    """A field as a step calls it; a row of points keeps its number."""
    return next((key for key, own in keys_of(shape).items() if own == word), f"point {word.lstrip('#')}")
