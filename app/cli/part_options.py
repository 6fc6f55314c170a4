"""What the options say about the part of a proof: its stock, and the shapes of the tools."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.figures import MM_PER_INCH
from app.cli.program_options import circumstances, read_source
from app.desk.command_errors import CommandError

if TYPE_CHECKING:
    from app.cli.program_options import Circumstances
    from core.machine.machine_model import Machine
    from core.part.stock import Stock
    from core.part.stock_spec import StockSpec
    from core.part.tool_shape import ToolShape
    from core.proving.part_proof import PartSetting


_LONGEST = 1016.0  # mm


def part_setting(args: argparse.Namespace, around: Circumstances) -> PartSetting:
    """Stock and tools as the options have them. Raises CommandError with what is wrong in them."""
    from app.compose.known_part import known_part

    stick_out = _stick_out(args, around.machine)
    setting = known_part(around.machine, around.setup.tools, _shapes(args), stick_out)
    if args.stock is None:
        if args.keep_stock:
            raise CommandError("--keep-stock needs --stock, which says what is to be kept")
        return setting
    return replace(setting, stock=_said(args.stock, args, around, setting))


def with_kept_stock(setting: PartSetting, program: str, args: argparse.Namespace) -> PartSetting:
    """Without --stock that of the store; with --keep-stock the store remembers it. Raises CommandError."""
    from app.compose.kept_stock import keep_stock, kept_stock

    if args.keep_stock:
        keep_stock(program, _lasting(args.stock))
    if args.stock is not None or not (text := kept_stock(program)):
        return setting
    try:
        return replace(setting, stock=_said(text, args, circumstances(args), setting))
    except CommandError as error:
        way = "say another with --stock and --keep-stock"
        raise CommandError(f"the stock that is kept with {program} cannot be used: {error}; {way}") from error


def _lasting(text: str) -> str:
    """The same from every folder: a file by its whole path."""
    kind, _, rest = text.partition(":")
    return f"{kind}:{Path(rest).resolve()}" if kind in {"profile", "after"} else text


def _said(
    text: str, args: argparse.Namespace, around: Circumstances, setting: PartSetting
) -> Stock | StockSpec:
    from core.part.stock_spec import StockError

    try:
        return _stock(text, args, around, setting)
    except StockError as error:
        raise CommandError(f"--stock {error}") from error


def _shapes(args: argparse.Namespace) -> Mapping[int, ToolShape]:
    """Those of --tools, else of the offsets file, else of the store."""
    from app.compose.stored_offsets import stored_shapes
    from app.offsets.offsets_file import read_tool_shapes

    file = args.tools or args.offsets
    return stored_shapes() if file is None else read_tool_shapes(Path(file))


def _stick_out(args: argparse.Namespace, machine: Machine) -> float | None:
    """mm, as the job says it. Raises CommandError."""
    if args.stick_out is None:
        return None
    stick_out = float(args.stick_out) * MM_PER_INCH
    if not machine.clamping.diameter:
        raise CommandError(f"--stick-out {args.stick_out:g} needs [clamping] diameter in the machine file")
    if not 0.0 < stick_out <= _LONGEST:
        raise CommandError(f"--stick-out {args.stick_out:g} is not between 0 and 40 in")
    return stick_out


def _stock(
    text: str, args: argparse.Namespace, around: Circumstances, setting: PartSetting
) -> Stock | StockSpec:
    from core.part.stock_spec import profile_stock, stock_spec

    spec = stock_spec(text)
    if spec.after:
        return _left_by(Path(spec.after), args, around, setting, spec)
    if spec.profile:
        path = Path(spec.profile)
        try:
            points = path.read_text(encoding="utf-8")
        except OSError as error:
            raise CommandError(f"{path} cannot be read ({error.strerror}); check name and rights") from error
        except UnicodeDecodeError as error:
            raise CommandError(f"{path} is no text; a profile is a CSV file of z, r") from error
        return profile_stock(spec.given, points, 25.4, spec.allowance)
    return spec


def _left_by(
    path: Path, args: argparse.Namespace, around: Circumstances, setting: PartSetting, spec: StockSpec
) -> Stock:
    """What the program before leaves: its last part."""
    from core.part.stock import Stock
    from core.proving.part_proof import prove_with_part

    report, part = prove_with_part(read_source(path, args), around.setup, around.machine, setting)
    if report.errors or part is None or part.last is None:
        first = f": {report.errors[0].text}" if report.errors else ""
        raise CommandError(f"--stock {spec.given}: {path} leaves no part{first}")
    outside = tuple((z + spec.allowance, r) for z, r in reversed(part.last.outside))
    bore = tuple((z + spec.allowance, r) for z, r in reversed(part.last.bore or ()))
    return Stock(spec.given, outside, bore)
