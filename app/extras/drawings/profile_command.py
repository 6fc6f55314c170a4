"""Command ``turndesk profile DRAWING``, which makes a turning program from a drawing's contour.

The module also declares the JSON keys of the command.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.change_author import add_author_option
from app.cli.program_options import parse_output_path
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, convert_to_command_error
from app.extras.shapes.shapes_command import authorize_writing, save_generated_program
from core.extras.drawings.unit_check import UNIT_SIZES_MM
from core.extras.shapes.cutting_data import CUTTING_DATA
from core.json_keys import JsonOutput, declare_keys
from core.language.source import Dialect, guess_dialect
from core.message import Message

if TYPE_CHECKING:
    from collections.abc import Mapping

    from app.cli.outputs.units import Json
    from app.cli.program_options import SubParsers
    from app.extras.drawings.profile_trial import TrialResult
    from core.extras.drawings.contour_tracing import ElementGroup
    from core.extras.drawings.drawing import Drawing
    from core.extras.drawings.drawing_placement import ContourProfile, DrawingPlacement
    from core.extras.drawings.profile_program import ProfileProgram
    from core.extras.shapes.shape_fields import FieldValue
    from core.machine.machine_model import Machine
    from core.part.tool_shape import ToolShape


def add_parser(subparsers: SubParsers) -> None:
    """Declare the options of the command."""
    parser = subparsers.add_parser("profile")
    parser.add_argument("file", metavar="DRAWING")
    parser.add_argument(
        "--list", action="store_true", help="list the layers, axes and contours of the drawing"
    )
    _add_drawing_options(parser)
    _add_part_options(parser)
    _add_tool_options(parser)
    parser.add_argument(
        "--out",
        type=parse_output_path,
        metavar="FILE",
        help="program file to write: .nc is OmniTurn, .mpf is SINUMERIK (default: stdout)",
    )
    add_author_option(parser)
    parser.add_argument("--json", action="store_true", help="print only JSON on stdout")


def _add_drawing_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--unit",
        choices=tuple(map(str.lower, UNIT_SIZES_MM)),
        help="unit of the drawing, used instead of the unit in the file",
    )
    parser.add_argument(
        "--layer", default="", metavar="NAME", help="layer of the contour (default: all layers)"
    )
    parser.add_argument(
        "--axis", default="", metavar="NAME", help="name of the axis in the drawing, as shown by --list"
    )
    parser.add_argument(
        "--contour",
        type=int,
        default=1,
        metavar="N",
        help="number of the contour in the drawing, as shown by --list",
    )
    parser.add_argument(
        "--front",
        choices=("right", "left"),
        default="right",
        help="end of the drawing at which the front face of the part is located",
    )
    parser.add_argument(
        "--zero", choices=("face", "back", "origin"), default="face", help="location of Z0 in the drawing"
    )
    parser.add_argument(
        "--shift",
        type=float,
        default=0.0,
        metavar="Z",
        help="Z value of the location that --zero selects (default: 0)",
    )
    parser.add_argument(
        "--side", choices=("outside", "bore"), default="outside", help="surface of the part to cut"
    )
    parser.add_argument(
        "--gap",
        type=float,
        metavar="MM",
        help="join contour ends that are closer together than this distance, in mm",
    )


def _add_part_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--metric",
        action="store_true",
        help="use mm instead of inches, both in the program and in the length options",
    )
    parser.add_argument("--material", choices=tuple(CUTTING_DATA), default="STEEL", help="default: STEEL")
    parser.add_argument("--bar", type=float, metavar="D", help="bar diameter")
    parser.add_argument("--face", type=float, metavar="L", help="stock to remove from the face; 0: no facing")
    parser.add_argument("--hole", type=float, metavar="D", help="diameter of the starting hole before boring")
    parser.add_argument(
        "--rough", type=float, metavar="L", help="depth of a roughing pass; 0: finishing only"
    )


def _add_tool_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--tool", type=int, metavar="T", help="number of the turning tool (default: the first tool that fits)"
    )
    parser.add_argument(
        "--groove-tool",
        type=int,
        metavar="T",
        help="number of the grooving tool (default: the first grooving tool)",
    )
    parser.add_argument(
        "--comp",
        type=int,
        metavar="D",
        help="number of the tool offset or cutting edge for nose radius compensation; 0: no G41",
    )
    parser.add_argument(
        "--tools", metavar="FILE", help="file with tool shapes to use instead of the stored shapes"
    )
    parser.add_argument("--machine", metavar="FILE", help="machine file (default: the simulated lathe)")


def run(args: argparse.Namespace) -> int:
    """Write the program and report the sections of the drawing that remain uncut.

    Returns exit status 1 if the program has errors.
    """
    from core.extras.drawings.drawing import DrawingError, limit_processor_time

    with convert_to_command_error(DrawingError), limit_processor_time(lambda _seconds: None):
        return _run(args)


def _run(args: argparse.Namespace) -> int:
    from app.cli.proofs.progress_bar import ProgressBar
    from app.compose.machine.machine_setup import read_machine
    from core.extras.drawings.drawing_process import read_drawing_in_process

    machine = read_machine(args.machine)
    if not args.list:
        args.who = authorize_writing(args)
    if args.side == "bore" and args.hole is None and not args.list:
        raise CommandError(
            "boring requires a starting hole; specify the diameter of the hole with --hole", "no-hole"
        )
    args.metric = args.metric or not machine.is_inch
    args.dialect = _language(args, machine)
    with ProgressBar(Message("time to read {file}, in seconds", file=args.file)) as progress:
        drawing = read_drawing_in_process(Path(args.file), progress.report_progress)
    if args.layer and args.layer not in drawing.layers:
        raise CommandError(
            Message(
                "{drawing} has no layer {layer}; use one of {layers}",
                drawing=drawing.name,
                layer=args.layer,
                layers=", ".join(drawing.layers),
            ),
            "no-layer",
        )
    if not args.list and not args.axis:
        from core.extras.drawings.drawing_placement import require_clear_axis

        require_clear_axis(drawing, args.layer)
    view = _view(drawing, args)
    found = _contours(drawing, view, args)
    if args.list:
        _list(drawing, view, found, as_json=args.json)
        return EXIT_OK
    if not 1 <= args.contour <= len(found):
        raise CommandError(
            Message(
                "{drawing} has {found_count} contours; use --contour 1 to {found_count2}",
                drawing=drawing.name,
                found_count=len(found),
                found_count2=len(found),
            ),
            "which-contour",
        )
    net = found[args.contour - 1]
    if args.unit is None:
        _check_unit(drawing, view, net, machine)
    return _make(drawing, view, net, args, machine)


def _check_unit(drawing: Drawing, view: DrawingPlacement, net: ElementGroup, machine: Machine) -> None:
    """Raise CommandError if the size of the contour suggests a unit other than that of its file."""
    from app.extras.shapes.shapes_setup import make_shop_data
    from core.extras.drawings.unit_check import detect_wrong_unit

    if (wrong := detect_wrong_unit(net, view.unit, make_shop_data(machine, {}).travel_mm)) is not None:
        name = wrong.unit_name.lower()
        template = (
            "{drawing} is {size}, which is too large for this machine; with {name} as the "
            "unit, the drawing would fit, so use --unit {name2}"
            if wrong.is_too_large
            else "{drawing} is only {size}; its unit may be {name}, so use --unit mm or --unit {name2}"
        )
        words = Message(template, drawing=drawing.name, size=wrong.size, name=name, name2=name)
        raise CommandError(words, "wrong-unit")


def _language(args: argparse.Namespace, machine: Machine) -> Dialect:
    """Return the program language, which depends on the output file name or else on the machine.

    Raises CommandError if the language is Klartext.
    """
    if args.out is None:
        return Dialect.SINUMERIK if machine.mdi_language == Dialect.SINUMERIK else Dialect.OMNITURN
    said = guess_dialect(Path(args.out).name)
    if said is Dialect.KLARTEXT:
        raise CommandError(
            Message(
                "{file}: a turning profile can be written only for OmniTurn or SINUMERIK; use a name "
                "that ends in .nc or .mpf",
                file=args.out,
            ),
            "wrong-language",
        )
    return said


def _view(drawing: Drawing, args: argparse.Namespace) -> DrawingPlacement:
    from core.extras.drawings.contour_tracing import DEFAULT_GAP_MM
    from core.extras.drawings.drawing_placement import DrawingPlacement, FaceEnd, ZeroPosition, select_axis

    unit = UNIT_SIZES_MM[args.unit.upper()] if args.unit else drawing.unit_mm
    if not unit:
        raise CommandError(
            Message(
                "{drawing} does not specify its unit; use --unit mm or --unit inch", drawing=drawing.name
            ),
            "no-unit",
        )
    gap = DEFAULT_GAP_MM if args.gap is None else args.gap
    if not 0.0 < gap <= 1.0:
        raise CommandError(
            Message(
                "--gap {gap} is out of range, because only gaps up to 1 mm are closed; use .001 to 1",
                gap=f"{gap:g}",
            ),
            "gap",
        )
    shift = args.shift * (1.0 if args.metric else 25.4)
    front, zero = FaceEnd(args.front.upper()), ZeroPosition(args.zero.upper())
    return DrawingPlacement(select_axis(drawing, args.axis, args.layer), unit, front, zero, shift, gap)


def _contours(drawing: Drawing, view: DrawingPlacement, args: argparse.Namespace) -> list[ElementGroup]:
    from core.extras.drawings.drawing_placement import find_contours

    found = find_contours(drawing, view, args.layer)
    if not found:
        where = (
            Message("on layer {layer}", layer=args.layer)
            if args.layer
            else ("on either side of the selected axis")
        )
        raise CommandError(
            Message(
                "{drawing} has no contour {place}; use a different --layer or --axis",
                drawing=drawing.name,
                place=where,
            ),
            "no-contour",
        )
    return found


def _list(drawing: Drawing, view: DrawingPlacement, found: list[ElementGroup], *, as_json: bool) -> None:
    from core.extras.drawings.drawing_placement import find_axes

    names = [axis.name for axis in find_axes(drawing)]
    result: Json = {
        "file": drawing.name,
        "unit_mm": drawing.unit_mm or None,
        "layers": list(drawing.layers),
        "axes": names,
        "axis": view.axis.name,
        "contours": [
            {"elements": len(net.elements), "length_mm": round(high - low, 4), "diameter_mm": round(2 * r, 4)}
            for net in found
            for low, high, r in (net.extent_mm,)
        ],
        "left_out": dict(drawing.omitted_object_counts),
    }
    if as_json:
        sys.stdout.write(json.dumps(result) + "\n")
        return
    unit = Message("{unit} mm", unit=f"{drawing.unit_mm:g}") if drawing.unit_mm else "not specified"
    lines = [
        Message("{drawing}: unit {unit}", drawing=drawing.name, unit=unit),
        f"  layers: {', '.join(each or '(none)' for each in drawing.layers)}",
    ]
    lines.append(f"  axes: {', '.join(names)}")
    for number, net in enumerate(found, 1):
        low, high, r = net.extent_mm
        words = Message(
            "length {high} mm, diameter {radius} mm, made up of {elements_count} lines",
            elements_count=len(net.elements),
            high=f"{high - low:.4g}",
            radius=f"{2 * r:.4g}",
        )
        lines.append(
            Message(
                "  contour {number}, axis {axis}: {words}", number=number, axis=view.axis.name, words=words
            )
        )
    if drawing.omitted_object_counts:
        lines.append(
            Message(
                "  ignored: {number}",
                number=", ".join((f"{n} {kind}" for kind, n in drawing.omitted_object_counts.items())),
            )
        )
    sys.stdout.write("\n".join(lines) + "\n")


def _make(
    drawing: Drawing, view: DrawingPlacement, net: ElementGroup, args: argparse.Namespace, machine: Machine
) -> int:
    from app.extras.drawings.profile_trial import TrialStock, run_profile_trial
    from core.extras.drawings.drawing_placement import ContourSide, extract_profile

    shapes = _shapes(args)
    chosen = extract_profile(drawing, view, net, ContourSide(args.side.upper()))
    mm = 1.0 if args.metric else 25.4
    typed = _typed(chosen, args, shapes)
    made = _program(chosen, typed, args, machine, shapes)
    if made.errors:
        raise CommandError(f"{drawing.name}: {made.errors[0].message}", "refused-shape")
    text = "\n".join([*made.lines, "M30"]) + "\n"
    bar = float(typed["BAR"]) * mm
    stock = TrialStock(bar, float(typed.get("STOCK", 0.0)) * mm, (args.hole or 0.0) * mm)
    trial = run_profile_trial(text, chosen, stock, made.nose_offset, machine, shapes, dialect=args.dialect)
    if args.out is not None:
        save_generated_program(args, text, args.who)
    elif not args.json:
        sys.stdout.write(text)
    _tell(made, trial, chosen, text, args)
    return EXIT_ERRORS if trial.errors else EXIT_OK


def _shapes(args: argparse.Namespace) -> Mapping[int, ToolShape]:
    from app.compose.stored_offsets import read_stored_shapes
    from app.offsets.offsets_file import read_tool_shapes

    return read_stored_shapes() if args.tools is None else read_tool_shapes(Path(args.tools))


def _typed(
    chosen: ContourProfile, args: argparse.Namespace, shapes: Mapping[int, ToolShape]
) -> dict[str, FieldValue]:
    """Return the command's options as field values of the shape forms.

    Lengths are in the length unit of the program.
    """
    from core.extras.drawings.profile_description import propose_program_fields

    said: dict[str, FieldValue | None] = {
        "BAR": args.bar,
        "STOCK": args.face,
        "HOLE": args.hole,
        "ROUGH": args.rough,
        "T": args.tool,
        "BLADE": args.groove_tool,
        "COMP": args.comp,
        "MATERIAL": args.material,
    }
    given = {word: value for word, value in said.items() if value is not None}
    return propose_program_fields(chosen, given, shapes, is_metric=args.metric, dialect=args.dialect)


def _program(
    chosen: ContourProfile,
    typed: dict[str, FieldValue],
    args: argparse.Namespace,
    machine: Machine,
    shapes: Mapping[int, ToolShape],
) -> ProfileProgram:
    from app.extras.shapes.shapes_setup import make_shop_data
    from core.extras.drawings.profile_program import make_profile_program
    from core.extras.shapes.shape_fields import ProgramSettings

    setting = ProgramSettings(metric=args.metric, shop=make_shop_data(machine, shapes), dialect=args.dialect)
    return make_profile_program(chosen, typed, [], setting)


def _tell(
    made: ProfileProgram, trial: TrialResult, chosen: ContourProfile, text: str, args: argparse.Namespace
) -> None:
    from core.extras.drawings.profile_description import convert_to_json, describe_program

    if args.json:
        result = {
            "file": args.file,
            "out": args.out,
            "program": text,
            **convert_to_json(made, trial.comparison, chosen),
        }
        sys.stdout.write(json.dumps({**result, "errors": list(trial.errors)}) + "\n")
        return
    for line in (*describe_program(made, trial.comparison, chosen, is_metric=args.metric), *trial.errors):
        sys.stderr.write(f"turndesk: {line}\n")


PROFILE_OUTPUT = JsonOutput(
    "profile DRAWING --json",
    "One object. Lengths are in millimeters.",
    declare_keys(
        """
file | string | | The drawing.
out | string or null | | File of --out.
program | string | | Text of the program.
side | string | | OUTSIDE or BORE.
closed_gap_mm | number | mm | Largest gap in the contour that was closed.
secondary_offset | object or null | | OmniTurn: secondary offset that G41 needs; null without it.
secondary_offset.number | integer | | Number of the secondary offset.
secondary_offset.x | number | mm | X, a radius.
secondary_offset.z | number | mm | Z.
secondary_offset.r | number | mm | Nose radius.
cutting_edge | object | | SINUMERIK: cutting edge that G41 needs; the key is missing without it.
cutting_edge.tool | integer | | Number of the tool.
cutting_edge.edge | integer | | Number of the cutting edge.
cutting_edge.r | number | mm | Nose radius.
cutting_edge.quadrant | integer | | Tip quadrant.
left | list | | Parts of the contour that are not cut.
left[].back_mm | number | mm | Z at which the uncut part ends toward the chuck.
left[].front_mm | number | mm | Z at which the uncut part ends toward the face.
left[].why | string | | Why it is not cut.
worst_mm | number or null | mm | Largest deviation of the part from the drawing; null if it was not compared.
deviations | list | | Deviations from the drawing.
deviations[].back_mm | number | mm | Z of the end of the deviation toward the chuck.
deviations[].front_mm | number | mm | Z of the end of the deviation toward the face.
deviations[].most_mm | number | mm | Largest deviation there.
errors | list | | Errors of the program; the exit status is then 1.
"""
    ),
)
PROFILE_LIST_OUTPUT = JsonOutput(
    "profile DRAWING --list --json",
    "One object.",
    declare_keys(
        """
file | string | | The drawing.
unit_mm | number or null | mm | Length of one unit of the drawing; null if the drawing does not specify it.
layers | list | | Names of the layers.
axes | list | | Names of the axes.
axis | string | | The axis that is used.
contours | list | | Contours, numbered from 1.
contours[].elements | integer | | Number of lines and arcs.
contours[].length_mm | number | mm | Length.
contours[].diameter_mm | number | mm | Largest diameter.
left_out | object | | Objects of the drawing that are ignored.
left_out.* | integer | | Number, by kind.
"""
    ),
)
OUTPUTS = (PROFILE_OUTPUT, PROFILE_LIST_OUTPUT)
