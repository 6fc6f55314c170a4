"""The specified stock: a bar or tube, a profile from a file, or the part that another program makes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.compose.known_part import with_kept_clamping
from app.desk.kept_part import NOTHING_KEPT, KeptPart
from core.input_file import MB, input_text
from core.message import Message
from core.part.stock_spec import StockError, profile_stock, stock_spec

if TYPE_CHECKING:
    from core.interpreter.shared.job_setup import Setup
    from core.language.source import Source
    from core.machine.machine_model import Machine
    from core.part.stock import Stock
    from core.part.stock_spec import StockSpec
    from core.proving.program_tools import PartSetting
    from core.proving.prove_program import Progress

_LARGEST = 16 * MB  # largest profile file


class ProgramBefore(NamedTuple):
    """Context in which the preceding program is proved, whose part is the stock.

    ``read`` reads the program and may raise any exception that the caller handles. ``go_on`` receives the
    progress of the proof. The context also has a function that returns the stored stock and stick-out of a
    program by name, and the names of the programs that depend on this one.
    """

    read: Callable[[Path], Source]
    setup: Setup
    machine: Machine
    setting: PartSetting
    go_on: Progress | None = None
    kept: Callable[[str], KeptPart] = lambda _name: NOTHING_KEPT
    behind: tuple[str, ...] = ()


def said_stock(text: str, around: ProgramBefore) -> Stock | StockSpec:
    """Return the stock that the text specifies. Raises StockError with the error in the text."""
    spec = stock_spec(text)
    if spec.after:
        return _left_by(Path(spec.after), around, spec)
    if not spec.profile:
        return spec
    path = Path(spec.profile)
    try:
        points = input_text(path, _LARGEST)
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
    profile_stock(spec.given, points, 1.0, spec.allowance)  # checks the profile
    return replace(spec, points=points)


def _left_by(path: Path, around: ProgramBefore, spec: StockSpec) -> Stock:
    """Return the last part of the preceding program as stock."""
    from core.part.stock import Stock
    from core.proving.part_proof import prove_with_part

    source = around.read(path)
    setting = _first_setting(source.name, spec, around)
    report, part = prove_with_part(source, around.setup, around.machine, setting, around.go_on)
    if report.errors or part is None or part.last is None:
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
    outside = tuple((z + spec.allowance, r) for z, r in reversed(part.last.outside))
    bore = tuple((z + spec.allowance, r) for z, r in reversed(part.last.bore or ()))
    return Stock(spec.given, outside, bore)


def _first_setting(name: str, spec: StockSpec, around: ProgramBefore) -> PartSetting:
    """Return the context of the preceding program with its stored stock and stick-out."""
    kept = around.kept(name)
    setting = with_kept_clamping(around.setting, around.machine, kept)
    if not kept.stock:
        return setting
    if name in around.behind:
        raise StockError(
            Message(
                "{given}: program {name} would use its own finished part as stock",
                given=spec.given,
                name=name,
            ),
            "stock-circle",
        )
    return replace(setting, stock=said_stock(kept.stock, around._replace(behind=(*around.behind, name))))
