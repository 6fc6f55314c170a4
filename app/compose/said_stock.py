"""The stock that somebody has said: a bar or tube, the profile of a file, or what another program leaves."""

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

_LARGEST = 16 * MB  # of a profile


class ProgramBefore(NamedTuple):
    """What a program before is proved with: how it is read, and its circumstances.

    ``read`` may raise what its caller takes; ``go_on`` is told how far that proof has come. ``kept`` is what
    the store has for it, by its name: stock and stick-out. ``behind`` are the programs that wait for it.
    """

    read: Callable[[Path], Source]
    setup: Setup
    machine: Machine
    setting: PartSetting
    go_on: Progress | None = None
    kept: Callable[[str], KeptPart] = lambda _name: NOTHING_KEPT
    behind: tuple[str, ...] = ()


def said_stock(text: str, around: ProgramBefore) -> Stock | StockSpec:
    """What the words mean. Raises StockError with what is wrong in them."""
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
    profile_stock(spec.given, points, 1.0, spec.allowance)  # refuses what is wrong in it
    return replace(spec, points=points)


def _left_by(path: Path, around: ProgramBefore, spec: StockSpec) -> Stock:
    """What the program before leaves: its last part."""
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
    """The setting of the program before, with the stock and the stick-out that the store has for it."""
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
