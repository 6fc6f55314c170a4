"""What a job needs on the gang plate, and what of it is missing: offsets, tool life, the right tip."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.status.formats import local_time
from app.desk.translation import tr
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.production.tool_life import LifeState, ToolLife
from core.store.store_rows import ToolRow
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from app.special.setup_sheet import SetupSheet, SheetTool

_SAME = 1e-4  # mm: nose radii that differ by less are one
_TOLD = 3  # findings of the proof that are named


@dataclass(frozen=True, slots=True)
class ProvedJob:
    """A program of the queue as it was proved with the offsets of that moment.

    ``before``: its tools as they were set when it was started last, ``ran`` (UTC); empty: it never was.
    """

    sheet: SetupSheet
    ran: str = ""
    before: Mapping[int, ToolRow] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Station:
    """One tool that a job needs; ``lacks``: in words what is to be done about it, empty: nothing."""

    tool: SheetTool
    lacks: tuple[str, ...] = ()


def stations(job: ProvedJob, lives: Mapping[int, ToolLife], parts: int) -> tuple[Station, ...]:
    """The tools of a job that is to make so many parts still, in the order of the plate."""
    return tuple(
        Station(tool, tuple(_lacks(tool, job, lives.get(tool.number), parts))) for tool in job.sheet.tools
    )


def missing(job: ProvedJob, lives: Mapping[int, ToolLife], parts: int) -> int:
    """How many things are to be seen to before it can be started: tools, and errors of its proof."""
    return sum(len(each.lacks) for each in stations(job, lives, parts)) + job.sheet.errors


def findings(sheet: SetupSheet) -> tuple[Diagnostic, ...]:
    """The first errors of the proof, and behind them its first warnings."""
    worth = [each for each in sheet.found if each.severity is not Severity.NOTE]
    return tuple(sorted(worth, key=lambda each: (each.severity is not Severity.ERROR, each.line))[:_TOLD])


def _lacks(tool: SheetTool, job: ProvedJob, life: ToolLife | None, parts: int) -> Iterator[str]:
    if tool.offset is None:
        yield tr("no offset set: touch off the tool")
        return
    yield from _of_life(tool, life, parts)
    yield from _of_tip(tool, job)


def _of_life(tool: SheetTool, life: ToolLife | None, parts: int) -> Iterator[str]:
    if life is None or life.state is LifeState.NO_LIMIT:
        return
    if life.state is LifeState.SPENT:
        yield tr(Message("tool life used up, {words}: change the insert", words=tr(life.words)))
        return
    left = _parts_left(life, tool.time.cutting)
    if left is not None and left < parts:
        yield tr(Message("remaining tool life covers {left} of {parts} parts", left=left, parts=parts))


def _parts_left(life: ToolLife, seconds: float) -> int | None:
    """By what a part of this job takes of it, which may be less or more than the parts before have taken."""
    left = [life.limit_parts - life.parts] if life.limit_parts else []
    if life.limit_seconds and seconds > 0.0:
        left.append(int((life.limit_seconds - life.seconds) / seconds + 1e-9))
    return max(0, min(left)) if left else None


def _of_tip(tool: SheetTool, job: ProvedJob) -> Iterator[str]:
    """Another tip than that with which the program was started last: other inserts are on the plate now."""
    then, now = job.before.get(tool.number), tool.offset
    if then is None or now is None:
        return
    if then.quadrant == now.quadrant and abs(then.nose_radius - now.nose_radius) < _SAME:
        return
    words = tr(
        "since the last run ({when}), the tool tip has changed from R {was}, {was_tip}, to R {radius}, {tip}"
    )
    length = job.sheet.length
    yield tr(
        Message(
            words,
            radius=length(now.nose_radius),
            tip=_tip(now.quadrant),
            when=local_time(job.ran, seconds=False),
            was=length(then.nose_radius),
            was_tip=_tip(then.quadrant),
        )
    )


def _tip(quadrant: int) -> str:
    return tr(Message("tip quadrant {quadrant}", quadrant=quadrant))


def tool_name(number: int) -> str:
    """``T3``, ``T1D2``."""
    return edge_name(number)
