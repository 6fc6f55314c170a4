"""Reading of the stock that the operator specified for a program.

The stock is a bar, a tube, a profile from a file, or the part that another program makes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.compose.part_data import apply_stored_clamping
from app.desk.stored_part import EMPTY_STORED_PART, StoredPart
from core.input_file import BYTES_PER_MB, read_input_text
from core.message import Message
from core.part.stock_spec import StockError, parse_stock_profile, parse_stock_specification

if TYPE_CHECKING:
    from core.interpreter.shared.job_setup import InterpreterSetup
    from core.language.source import ProgramSource
    from core.machine.machine_model import Machine
    from core.part.stock import Stock
    from core.part.stock_spec import StockSpec
    from core.proving.program_tools import PartSettings
    from core.proving.prove_program import ReportProgress

_MAX_PROFILE_BYTES = 16 * BYTES_PER_MB  # largest profile file


class StockContext(NamedTuple):
    """Context for proving the preceding program, which makes the part that is used as stock.

    - ``read_source`` reads that program. The caller handles any exception that it raises.
    - ``report_progress`` receives the progress of the proof.
    - ``read_stored_part`` returns the stored stock and stick-out of a program by name.
    - ``preceding_programs`` are the names of the programs whose proofs depend on this program.
    """

    read_source: Callable[[Path], ProgramSource]
    setup: InterpreterSetup
    machine: Machine
    part_settings: PartSettings
    report_progress: ReportProgress | None = None
    read_stored_part: Callable[[str], StoredPart] = lambda _name: EMPTY_STORED_PART
    preceding_programs: tuple[str, ...] = ()


def read_stock(text: str, context: StockContext) -> Stock | StockSpec:
    """Return the stock that the text specifies.

    Raises StockError if the text is invalid, if the profile file cannot be read or is invalid, or if the
    preceding program does not produce a part. Exceptions of ``context.read_source`` and
    ``context.read_stored_part`` are passed on.
    """
    spec = parse_stock_specification(text)
    if spec.after:
        return _stock_from_program(Path(spec.after), context, spec)
    if not spec.profile:
        return spec
    path = Path(spec.profile)
    try:
        points = read_input_text(path, _MAX_PROFILE_BYTES)
    except OSError as error:
        raise StockError(
            Message(
                "{path} cannot be read ({cause}); check the name and the permissions",
                path=path,
                cause=error.strerror,
            ),
            "unreadable",
        ) from error
    except UnicodeDecodeError as error:
        raise StockError(
            Message(
                "{path} is not a text file; a profile must be a CSV file with the columns z, r", path=path
            ),
            "not-text",
        ) from error
    parse_stock_profile(spec.given, points, 1.0, spec.allowance)  # checks the profile
    return replace(spec, points=points)


def _stock_from_program(path: Path, context: StockContext, spec: StockSpec) -> Stock:
    """Return the last part that the preceding program makes. This part is the stock."""
    from core.part.stock import Stock
    from core.proving.part_proof import prove_program_and_part

    source = context.read_source(path)
    setting = _initial_setting(source.name, spec, context)
    report, part = prove_program_and_part(
        source, context.setup, context.machine, setting, context.report_progress
    )
    if report.errors or part is None or part.last_piece is None:
        first = Message(": {errors}", errors=report.errors[0].text) if report.errors else ""
        raise StockError(
            Message(
                "{given}: program {path} does not produce a part{first}",
                given=spec.given,
                path=path,
                first=first,
            ),
            "no-part-left",
        )
    outside = tuple((z + spec.allowance, r) for z, r in reversed(part.last_piece.outside_profile))
    bore = tuple((z + spec.allowance, r) for z, r in reversed(part.last_piece.bore_profile or ()))
    return Stock(spec.given, outside, bore)


def _initial_setting(name: str, spec: StockSpec, context: StockContext) -> PartSettings:
    """Return the part settings of the preceding program with its stored stock and stick-out."""
    kept = context.read_stored_part(name)
    setting = apply_stored_clamping(context.part_settings, context.machine, kept)
    if not kept.stock_text:
        return setting
    if name in context.preceding_programs:
        raise StockError(
            Message(
                "{given}: program {name} would use its own finished part as stock",
                given=spec.given,
                name=name,
            ),
            "stock-circle",
        )
    return replace(
        setting,
        stock=read_stock(
            kept.stock_text, context._replace(preceding_programs=(*context.preceding_programs, name))
        ),
    )
