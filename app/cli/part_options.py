"""Command-line options for the stock and the tool shapes of a proof."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.outputs.units import MM_PER_INCH
from app.cli.program_options import STDIN_NAME, read_command_context, read_source
from app.desk.command_errors import CommandError
from app.desk.stored_part import make_stock_path_absolute
from core.message import Message, get_error_code
from core.part.stock_forms import SPECIFICATION_FORMS

if TYPE_CHECKING:
    from app.cli.program_options import CommandContext
    from app.desk.stored_part import StoredPart
    from core.language.source import ProgramSource
    from core.machine.machine_model import Machine
    from core.part.stock import Stock
    from core.part.stock_spec import StockSpec
    from core.part.tool_shape import ToolShape
    from core.proving.program_tools import PartSettings


_MAX_LENGTH_MM = 1016.0  # mm


def add_part_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for stock, tools and clamping."""
    parser.add_argument(
        "--tools", metavar="FILE", help="file with tool shapes to use instead of the stored shapes"
    )
    parser.add_argument(
        "--stick-out",
        type=float,
        metavar="IN",
        help="distance from the front of the chuck or collet to Z0, in inches",
    )
    parser.add_argument(
        "--stock", metavar="SPEC", help=Message("stock for the part: {forms}", forms=SPECIFICATION_FORMS)
    )
    parser.add_argument(
        "--keep-stock",
        action="store_true",
        help="save the --stock setting in the data store, together with the program name",
    )
    parser.add_argument(
        "--as", dest="as_name", metavar="NAME", help="user who saves the stock (only with --keep-stock)"
    )


def read_part_settings(args: argparse.Namespace, context: CommandContext) -> PartSettings:
    """Return the part settings from the options.

    Raises CommandError if an option is invalid, or if the stored tool shapes cannot be read or are invalid.
    """
    from app.compose.part_data import make_part_settings

    stick_out = _read_stickout(args, context.machine)
    setting = make_part_settings(context.machine, context.setup.tools, _read_shapes(args), stick_out)
    if args.stock is None:
        if args.keep_stock:
            raise CommandError(
                "--keep-stock needs --stock, which specifies the stock to save", "nothing-to-keep"
            )
        return setting
    return replace(setting, stock=_said(args.stock, args, context, setting))


def apply_stored_stock(part_settings: PartSettings, program: str, args: argparse.Namespace) -> PartSettings:
    """Return the part settings with the stored stock, unless --stock specifies a stock.

    With --keep-stock, the specified stock is also saved. Raises CommandError if the stock is invalid or
    cannot be saved, or if the user may not save it.
    """
    from app.compose.part_data import read_stored_part, save_stock

    if args.keep_stock:
        if program == STDIN_NAME:
            raise CommandError(
                "--keep-stock saves the stock under the name of the program, but - (stdin) has no name",
                "stdin-has-no-name",
            )
        from app.cli.change_author import get_change_author
        from app.cli.store_command import open_store
        from core.access.access_table import ProtectedChange

        around = read_command_context(args)
        with open_store() as store:
            get_change_author(store, args, ProtectedChange.STOCK)
        save_stock(program, make_stock_path_absolute(args.stock), _read_stickout(args, around.machine))
    return apply_stored_part(part_settings, program, read_stored_part(program), args)


def apply_stored_part(
    part_settings: PartSettings, program: str, stored_part: StoredPart, args: argparse.Namespace
) -> PartSettings:
    """Return the part settings, completed with stored values that no option specifies.

    Raises CommandError if the stored stock or an option is invalid.
    """
    from app.compose.part_data import apply_stored_clamping

    around = read_command_context(args)
    part_settings = apply_stored_clamping(
        part_settings, around.machine, stored_part, is_explicit=args.stick_out is not None
    )
    if args.stock is not None or not stored_part.stock_text:
        return part_settings
    try:
        return replace(part_settings, stock=_said(stored_part.stock_text, args, around, part_settings))
    except CommandError as error:
        remedy = "specify the stock again with --stock and --keep-stock"
        raise CommandError(
            Message(
                "the stock saved with {program} cannot be used: {error}; {details}",
                program=program,
                error=error,
                details=remedy,
            ),
            "kept-stock",
        ) from error


def _said(
    text: str, args: argparse.Namespace, around: CommandContext, setting: PartSettings
) -> Stock | StockSpec:
    from app.compose.part_data import read_stored_part
    from app.compose.specified_stock import StockContext, read_stock
    from core.part.stock_spec import StockError

    def read_program_source(path: Path) -> ProgramSource:
        return read_source(path, args)

    try:
        return read_stock(
            text,
            StockContext(
                read_program_source, around.setup, around.machine, setting, read_stored_part=read_stored_part
            ),
        )
    except StockError as error:
        raise CommandError(f"--stock {error}", get_error_code(error)) from error


def _read_shapes(args: argparse.Namespace) -> Mapping[int, ToolShape]:
    """Return the tool shapes of --tools, or the stored shapes completed with those of the offsets file."""
    from app.compose.stored_offsets import read_stored_shapes
    from app.offsets.offsets_file import read_tool_shapes

    if args.tools is not None:
        return read_tool_shapes(Path(args.tools))
    described = read_tool_shapes(Path(args.offsets)) if args.offsets is not None else {}
    return {**read_stored_shapes(), **described}


def _read_stickout(args: argparse.Namespace, machine: Machine) -> float | None:
    """Return the stick-out of the stock in mm, or None if the option does not specify it.

    Raises CommandError if the stick-out is invalid.
    """
    if args.stick_out is None:
        return None
    stick_out = float(args.stick_out) * MM_PER_INCH
    if not machine.clamping.diameter:
        raise CommandError(
            Message(
                "--stick-out {stick_out} needs [clamping] diameter in the machine file",
                stick_out=f"{args.stick_out:g}",
            ),
            "no-clamping",
        )
    if not 0.0 < stick_out <= _MAX_LENGTH_MM:
        raise CommandError(
            Message("--stick-out {stick_out} is not between 0 and 40 in", stick_out=f"{args.stick_out:g}"),
            "stick-out",
        )
    return stick_out
