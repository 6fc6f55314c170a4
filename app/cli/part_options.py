"""Options for the part of a proof: its stock and the tool shapes."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.figures.units import MM_PER_INCH
from app.cli.program_options import STDIN, circumstances, read_source
from app.desk.command_errors import CommandError
from app.desk.kept_part import lasting
from core.message import Message, error_code
from core.part.stock_forms import FORMS

if TYPE_CHECKING:
    from app.cli.program_options import Circumstances
    from app.desk.kept_part import KeptPart
    from core.language.source import Source
    from core.machine.machine_model import Machine
    from core.part.stock import Stock
    from core.part.stock_spec import StockSpec
    from core.part.tool_shape import ToolShape
    from core.proving.program_tools import PartSetting


_LONGEST = 1016.0  # mm


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
    parser.add_argument("--stock", metavar="SPEC", help=Message("stock for the part: {forms}", forms=FORMS))
    parser.add_argument(
        "--keep-stock",
        action="store_true",
        help="save the --stock setting in the data store, together with the program name",
    )
    parser.add_argument(
        "--as", dest="as_name", metavar="NAME", help="user who saves the stock (only with --keep-stock)"
    )


def part_setting(args: argparse.Namespace, around: Circumstances) -> PartSetting:
    """Return the part data from the options. Raises CommandError if an option is invalid."""
    from app.compose.known_part import known_part

    stick_out = _stick_out(args, around.machine)
    setting = known_part(around.machine, around.setup.tools, _shapes(args), stick_out)
    if args.stock is None:
        if args.keep_stock:
            raise CommandError(
                "--keep-stock needs --stock, which specifies the stock to save", "nothing-to-keep"
            )
        return setting
    return replace(setting, stock=_said(args.stock, args, around, setting))


def with_kept_stock(setting: PartSetting, program: str, args: argparse.Namespace) -> PartSetting:
    """Return the part data with the stored stock, unless --stock specifies one.

    With --keep-stock, the stock is also saved. Raises CommandError.
    """
    from app.compose.known_part import keep_stock, kept_with

    if args.keep_stock:
        if program == STDIN:
            raise CommandError(
                "--keep-stock saves the stock under the name of the program, but - (stdin) has no name",
                "stdin-has-no-name",
            )
        from app.cli.store_command import opened_store
        from app.cli.who_changes import who_changes
        from core.access.access_table import Act

        around = circumstances(args)
        with opened_store() as store:
            who_changes(store, args, Act.STOCK)
        keep_stock(program, lasting(args.stock), _stick_out(args, around.machine))
    return with_kept(setting, program, kept_with(program), args)


def with_kept(setting: PartSetting, program: str, kept: KeptPart, args: argparse.Namespace) -> PartSetting:
    """Return the part data with the stored values that no option specifies. Raises CommandError."""
    from app.compose.known_part import with_kept_clamping

    around = circumstances(args)
    setting = with_kept_clamping(setting, around.machine, kept, said=args.stick_out is not None)
    if args.stock is not None or not kept.stock:
        return setting
    try:
        return replace(setting, stock=_said(kept.stock, args, around, setting))
    except CommandError as error:
        way = "specify the stock again with --stock and --keep-stock"
        raise CommandError(
            Message(
                "the stock saved with {program} cannot be used: {error}; {details}",
                program=program,
                error=error,
                details=way,
            ),
            "kept-stock",
        ) from error


def _said(
    text: str, args: argparse.Namespace, around: Circumstances, setting: PartSetting
) -> Stock | StockSpec:
    from app.compose.known_part import kept_with
    from app.compose.said_stock import ProgramBefore, said_stock
    from core.part.stock_spec import StockError

    def read(path: Path) -> Source:
        return read_source(path, args)

    try:
        return said_stock(text, ProgramBefore(read, around.setup, around.machine, setting, kept=kept_with))
    except StockError as error:
        raise CommandError(f"--stock {error}", error_code(error)) from error


def _shapes(args: argparse.Namespace) -> Mapping[int, ToolShape]:
    """Return the shapes of --tools, or those of the store and of the offsets file."""
    from app.compose.stored_offsets import stored_shapes
    from app.offsets.offsets_file import read_tool_shapes

    if args.tools is not None:
        return read_tool_shapes(Path(args.tools))
    described = read_tool_shapes(Path(args.offsets)) if args.offsets is not None else {}
    return {**stored_shapes(), **described}


def _stick_out(args: argparse.Namespace, machine: Machine) -> float | None:
    """Return the stick-out of the job in mm, or None. Raises CommandError if it is invalid."""
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
    if not 0.0 < stick_out <= _LONGEST:
        raise CommandError(
            Message("--stick-out {stick_out} is not between 0 and 40 in", stick_out=f"{args.stick_out:g}"),
            "stick-out",
        )
    return stick_out
